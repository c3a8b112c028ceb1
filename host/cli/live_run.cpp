#include "cli/live_run.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "devices/open_device.h"
#include "haptics/driven_part.h"
#include "io/atomic_file.h"
#include "pliant/error.h"
#include "program/hash.h"
#include "scene/blade_face.h"
#include "scene/keys.h"

namespace pliant::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kRate = 1000, kPatience = 5;

void refuse_live(const std::string& text) { throw Error(ErrorCode::bad_input, text); }

/// The tool of each device: the names of --tool in the same order, or the only tool there is, or the only blade.
std::vector<std::string> chosen_tools(const LiveArguments& o, const Simulation& simulation) {
  const std::vector<std::string> names = haptics::DrivenPart::names(simulation);
  std::string all;
  for (const std::string& name : names) all += fmt::format("{}\"{}\"", all.empty() ? "" : ", ", name);
  if (names.empty()) {
    refuse_live(
        "--live: the scene has no tools, and no blades that cut by force; expected one for each device (docs/scene.md, "
        "\"tools\", \"blades\")");
  }
  const std::vector<ContactTool>& tools = simulation.contact().tools();
  const bool only =
      names.size() == 1 || std::count_if(tools.begin(), tools.end(), [](const ContactTool& t) { return !is_face(t); }) == 1;
  const std::vector<std::string> chosen =
      o.tools.empty() && only && o.live.size() == 1 ? std::vector<std::string>{names.front()} : o.tools;
  if (chosen.size() != o.live.size()) {
    refuse_live(fmt::format("{} --live and {} --tool are given; expected as many, in the same order; the scene has {}",
                            o.live.size(), chosen.size(), all));
  }
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (std::find(names.begin(), names.end(), chosen[i]) == names.end()) {
      refuse_live(fmt::format("--tool is \"{}\"; the scene has {}{}", chosen[i], all, did_you_mean(chosen[i], names)));
    }
    if (!haptics::DrivenPart::find(simulation, chosen[i])) {
      refuse_live(fmt::format(
          "--tool is \"{}\", a blade that is nowhere when the run begins; expected one whose \"path\" and \"start\" have begun",
          chosen[i]));
    }
    if (std::count(chosen.begin(), chosen.end(), chosen[i]) > 1)
      refuse_live(fmt::format("--tool \"{}\" is given twice; expected one device for each tool", chosen[i]));
  }
  return chosen;
}

}  // namespace

void LiveArguments::add_to(CLI::App& app) {
  app.add_option("--live", live, "A device drives a tool while the scene runs (docs/haptic_devices.md); may be given again")
      ->type_name("DEVICE")
      ->allow_extra_args(false);
  app.add_option("--tool", tools, "The tool or blade of each --live, in the same order; not needed where there is one of both")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_flag("--lockstep", lockstep, "The scene's clock is that of the devices' samples; default: it is that of the wall");
  app.add_option("--rate", rate,
                 "Ticks per second of the force; with --lockstep, samples per second of a device that dates none; default 1000")
      ->type_name("HZ");
  app.add_option("--patience", patience, "With --lockstep: a device that says nothing for longer has ended [s]; default 5");
  app.add_option("--log", log, "Write all drives that reached the simulation")->type_name("FILE");
  app.add_option("--replay", replay, "Apply the drives of such a log at the same steps, without any device")->type_name("FILE");
}

std::string LiveArguments::given() const { return !live.empty() ? "--live" : !replay.empty() ? "--replay" : ""; }

void LiveArguments::check() const {
  if (!live.empty() && !replay.empty())
    refuse_live("--replay applies the drives of a log, --live those of a device: expected one of both");
  for (const auto& [there, option] : {std::pair{!tools.empty(), "--tool"},
                                      {lockstep, "--lockstep"},
                                      {rate.has_value(), "--rate"},
                                      {patience.has_value(), "--patience"},
                                      {!log.empty(), "--log"}}) {
    if (there && live.empty()) refuse_live(fmt::format("{} is for devices that drive tools; it needs --live DEVICE", option));
  }
  if (patience && !lockstep) refuse_live("--patience is for samples that are waited for; it needs --lockstep");
  if (rate && !(*rate >= (lockstep ? 1 : 300) && *rate <= (lockstep ? 1e6 : 1e4))) {
    refuse_live(fmt::format("--rate is {}; expected {}", *rate,
                            lockstep ? "1 to 1000000 samples per second" : "300 to 10000 ticks per second"));
  }
  if (patience && !(*patience > 0 && *patience <= 1e6))
    refuse_live(fmt::format("--patience is {} s; expected more than 0, at most 1000000 s", *patience));
  if (!log.empty()) check_writable(log);
}

LiveRun::LiveRun(const LiveArguments& arguments, const Common& common, const Simulation& simulation, bool own_end)
    : o_(arguments), common_(common), simulation_(simulation) {
  if (simulation.scene().relaxation.enabled)
    refuse_live(fmt::format("{}: the scene uses \"relaxation\", whose steps are not in the time of a hand", o_.given()));
  if (!o_.replay.empty()) {
    replay_.emplace(haptics::read_drive_log(o_.replay), simulation, !own_end);
    return;
  }
  open();
  const auto remark = [this](const std::string& text) { common_.remark(text); };
  if (o_.lockstep) {
    lockstep_.emplace(simulation, held_,
                      haptics::LockstepOptions{o_.rate.value_or(kRate), o_.patience.value_or(kPatience), interrupted, remark},
                      log_);
  } else {
    paced_.emplace(simulation, held_, o_.rate.value_or(kRate), interrupted, remark, log_);
  }
}

void LiveRun::open() {
  const std::vector<std::string> tools = chosen_tools(o_, simulation_);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].find_first_of("\r\n") != std::string::npos)
      refuse_live("--live: the name of the tool has a line break, which the log of drives cannot hold");
    held_.push_back({tools[i], devices::open_device(o_.live[i])});
    const int port = held_.back().device->port();
    const char* kind = haptics::DrivenPart::find(simulation_, tools[i])->is_blade() ? "blade" : "tool";
    common_.note(fmt::format("{} {} is driven by {}{}", kind, tools[i], o_.live[i],
                             port > 0 ? fmt::format(", which listens on port {}", port) : ""));
  }
}

haptics::RunGuide& LiveRun::guide() {
  if (replay_) return *replay_;
  if (lockstep_) return *lockstep_;
  return *paced_;
}

void LiveRun::finish() {
  if (replay_) return;
  if (lockstep_) lockstep_->release();
  if (paced_) paced_->release();
  // A run that diverged, or stopped where steps had just been taken back, is behind its last drives: a replay goes on to its
  // divergence, or to the scene's duration.
  const bool behind = !log_.drives.empty() && simulation_.step() < log_.drives.back().at.step;
  if (!behind && !simulation_.divergence()) log_.end = haptics::LoggedMoment{simulation_.step(), simulation_.time(), 0};
  log_.again = simulation_.report().made_again;
  if (!o_.log.empty()) write_file(o_.log, haptics::drive_log_text(log_));
}

Json LiveRun::device_json(std::size_t i) {
  const DeviceCounts counts = held_[i].device->counts();
  Json json{{"device", o_.live[i]},
            {"tool", held_[i].tool},
            {"samples", counts.received},
            {"refused", counts.refused},
            {"last_refusal", counts.last_refusal}};
  if (lockstep_) {
    const haptics::LockstepCounts& c = lockstep_->counts(i);
    json.update({{"used", c.samples},
                 {"falling", c.falling},
                 {"missed", c.missed},
                 {"poses_limited", c.limited},
                 {"poses_refused", c.refused},
                 {"largest_force", c.largest_force}});
    return json;
  }
  const HapticState s = paced_->state(i);
  json.update({{"poses_refused", s.refused},
               {"frames", s.frames},
               {"ticks", s.ticks},
               {"late", s.late},
               {"work_mean", s.work_mean},
               {"work_p999", s.work_p999},
               {"work_most", s.work_most},
               {"corrections", s.corrections},
               {"limited", s.limited},
               {"not_finite", s.not_finite},
               {"stale", s.stale},
               {"least_energy", s.least_energy},
               {"largest_force", paced_->largest_force(i)}});
  return json;
}

Json LiveRun::json() {
  const haptics::DriveLog& log = replay_ ? replay_->log() : log_;
  Json json{{"time", replay_     ? "replay"
                     : lockstep_ ? "lockstep"
                                 : "paced"},
            {"drives", replay_ ? replay_->applied() : log.drives.size()},
            {"log_hash", hash_text(hash_bytes(haptics::drive_log_text(log)))},
            {"devices", Json::array()}};
  for (std::size_t i = 0; i < held_.size(); ++i) json["devices"].push_back(device_json(i));
  return json;
}

std::vector<std::string> LiveRun::lines() {
  const Json all = json();
  std::vector<std::string> lines;
  for (const Json& d : all["devices"]) {
    std::string text = fmt::format("{} drove {}: {} samples, {} messages and {} poses refused, at most {:.4g} N on the hand",
                                   d["device"].get<std::string>(), d["tool"].get<std::string>(),
                                   d["samples"].get<std::uint64_t>(), d["refused"].get<std::uint64_t>(),
                                   d["poses_refused"].get<std::int64_t>(), d["largest_force"].get<double>());
    if (paced_) {
      text +=
          fmt::format("; {} frames, {} ticks of {:.3g} us, at most {:.3g} us", d["frames"].get<std::int64_t>(),
                      d["ticks"].get<std::int64_t>(), 1e6 * d["work_mean"].get<double>(), 1e6 * d["work_most"].get<double>());
    }
    lines.push_back(std::move(text));
  }
  lines.push_back(fmt::format("{} drives {}, log hash {}", all["drives"].get<std::size_t>(), replay_ ? "replayed" : "by hand",
                              all["log_hash"].get<std::string>()));
  return lines;
}

}  // namespace pliant::cli
