// pliant run: simulate a scene and write what comes out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "backends/backends.h"
#include "cli/cli.h"
#include "cli/frames.h"
#include "cli/picture_words.h"
#include "cli/run_loop.h"
#include "cli/run_static.h"
#include "io/save.h"
#include "pliant/error.h"
#include "program/hash.h"

namespace pliant::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
  Common common;
  std::string scene, backend = "auto", out, checkpoint, resume;
  std::vector<std::string> formats{"vtu"};
  PictureWords picture;
  std::optional<std::int64_t> steps, every;
  std::optional<double> seconds, dt;
  bool hash = false, deep_hash = false, profile = false;
};

void check(const Options& o) {
  if (o.steps) check_steps("--steps", *o.steps);
  if (o.seconds && !(*o.seconds >= 0 && std::isfinite(*o.seconds))) {
    throw Error(ErrorCode::bad_input, fmt::format("--seconds is {}; expected 0 or more", *o.seconds));
  }
  if (o.dt && !(*o.dt > 0 && std::isfinite(*o.dt)))
    throw Error(ErrorCode::bad_input, fmt::format("--dt is {} s; expected more than 0", *o.dt));
  if (o.every && *o.every < 1)
    throw Error(ErrorCode::bad_input, fmt::format("--every is {}; expected 1 or more steps", *o.every));
  if (o.every && o.out.empty())
    throw Error(ErrorCode::bad_input, "--every says how often to write into a folder; it needs --out DIR");
  const std::set<OutputFormat> formats = parse_formats(o.formats);
  if (!o.picture.given().empty() && formats.count(OutputFormat::png) == 0) {
    throw Error(ErrorCode::bad_input, fmt::format("{} is for pictures; it needs --format png", o.picture.given()));
  }
  (void)o.picture.options();  // refuses words that mean nothing
  o.common.check();
  if (!o.checkpoint.empty()) check_writable(o.checkpoint);
}

class Run {
 public:
  explicit Run(const Options& options) : o_(options), stem_(scene_stem(options.scene)) {}

  int operator()() {
    check(o_);
    Scene scene = load_scene(o_.scene);
    if (scene.solver.enabled) return solve(scene);
    open(std::move(scene));
    watch_interrupt();
    const std::int64_t every = write_first_frame();
    if (o_.profile) simulation_->backend().profile(true);
    Progress progress(!o_.common.quiet);
    RunLoop loop(*simulation_, end());
    const std::int64_t total = converged() ? 0 : loop.remaining();
    if (!converged()) {
      result_ = loop.run(
          every, [&] { frames_->write(*simulation_); },
          [&](std::int64_t done) { progress.show(done, total, fmt::format("t = {:.4g} s", simulation_->time())); });
    }
    progress.clear();
    if (!result_.diverged.empty()) return diverged();
    if (frames_) {
      frames_->write(*simulation_);
      frames_->finish();
    }
    if (!o_.checkpoint.empty()) write_checkpoint(o_.checkpoint, checkpoint());
    report();
    return result_.interrupted ? kInterrupted : 0;
  }

 private:
  int solve(const Scene& scene) {
    for (const auto& [given, option] : {std::pair{o_.steps.has_value(), "--steps"},
                                        {o_.seconds.has_value(), "--seconds"},
                                        {o_.dt.has_value(), "--dt"},
                                        {o_.every.has_value(), "--every"},
                                        {!o_.checkpoint.empty(), "--checkpoint"},
                                        {!o_.resume.empty(), "--resume"},
                                        {o_.profile, "--profile"}}) {
      if (given)
        throw Error(
            ErrorCode::bad_input,
            fmt::format("{} means nothing for {}, which asks for a static solver: there are no steps", option, o_.scene));
    }
    if (o_.backend != "auto" && o_.backend != "cpu:double") {
      throw Error(ErrorCode::bad_input,
                  fmt::format("--backend is \"{}\"; {} asks for a static solver, which runs in double on the processor alone",
                              o_.backend, o_.scene));
    }
    return run_static(scene, {o_.common, stem_, o_.out, parse_formats(o_.formats), o_.hash});
  }

  void open(Scene scene) {
    if (o_.dt) scene.dt = *o_.dt;  // from here on the step is a fixed one, and part of what a checkpoint belongs to
    std::optional<Checkpoint> saved;
    if (!o_.resume.empty()) saved = read_checkpoint(o_.resume);
    if (!o_.out.empty()) frames_.emplace(o_.out, stem_, parse_formats(o_.formats), o_.picture.options());
    std::string reason;
    const auto model = std::make_shared<const Model>(build_model(scene));
    auto backend = open_backend(o_.backend, &reason, model->nodes());
    o_.common.note("backend " + reason);
    if (!backend->info().bit_exact) o_.common.note("tolerance mode: " + backend->info().tolerance_reason);
    simulation_.emplace(std::move(scene), model, std::move(backend));
    if (saved) resume(*saved);
    if (simulation_->stable_dt() > 0 && simulation_->dt() > simulation_->stable_dt()) {
      o_.common.note(fmt::format("dt = {:.6g} s is {:.3g} times the stable step {:.6g} s: expect the simulation to diverge",
                                 simulation_->dt(), simulation_->dt() / simulation_->stable_dt(), simulation_->stable_dt()));
    }
    for (const std::string& remark : simulation_->remarks()) o_.common.note(remark);
    first_time_ = simulation_->time();
  }

  void resume(const Checkpoint& saved) {
    restore_checkpoint(*simulation_, saved, o_.resume);
    o_.common.note(
        fmt::format("resumed at step {} (t = {:.6g} s) from {}", simulation_->step(), simulation_->time(), o_.resume));
    if (converged()) o_.common.note("the checkpoint is at equilibrium: nothing is left to do");
  }

  [[nodiscard]] bool relaxes() const { return simulation_->scene().relaxation.enabled; }
  [[nodiscard]] bool converged() const { return simulation_->at_equilibrium(); }
  [[nodiscard]] double residual() const { return simulation_->residual(); }

  [[nodiscard]] RunEnd end() const {
    RunEnd end;
    if (o_.steps) end.step = simulation_->step() + *o_.steps;
    if (o_.seconds) end.time = first_time_ + *o_.seconds;
    if (o_.steps || o_.seconds) return end;
    if (relaxes()) {
      end.step = simulation_->scene().relaxation.max_steps;
    } else {
      end.time = simulation_->scene().duration;
    }
    return end;
  }

  /// Returns after how many steps the next one is due; 0: no frames.
  std::int64_t write_first_frame() {
    if (!frames_) return 0;
    frames_->write(*simulation_);
    if (o_.every) return *o_.every;
    return std::max<std::int64_t>(1, std::llround(1.0 / 60 / simulation_->dt()));  // a viewer then plays in real time
  }

  [[nodiscard]] Checkpoint checkpoint() const { return take_checkpoint(*simulation_); }

  /// Save the last good state, report, and leave with the divergence's exit code.
  int diverged() {
    const fs::path folder = o_.out.empty() ? fs::path(".") : fs::path(o_.out);
    const fs::path saved = folder / (stem_ + "-last-good.pckpt");
    write_checkpoint(saved, checkpoint());
    if (frames_) frames_->finish();
    if (frames_) write_vtu(folder / (stem_ + "-last-good.vtu"), volume_frame(*simulation_));
    report();
    throw Error(ErrorCode::diverged, fmt::format("{}; saved as {}", result_.diverged, saved.lexically_normal().string()));
  }

  void report() {
    const Simulation& s = *simulation_;
    const BackendInfo& info = s.backend().info();
    const std::string hash = hash_text(s.hash());
    const double simulated = s.time() - first_time_;
    Json json{{"scene", stem_},
              {"backend", info.name},
              {"device", info.device},
              {"bit_exact", info.bit_exact},
              {"nodes", s.model().nodes()},
              {"elements", s.model().elements()},
              {"steps", result_.steps},
              {"dt", s.dt()},
              {"stable_dt", s.stable_dt()},
              {"simulated_seconds", simulated},
              {"ms_per_step", result_.ms_per_step},
              {"hash", hash},
              {"deep_hash", hash_text(s.deep_hash())},
              {"diverged", !result_.diverged.empty()},
              {"step", s.step()},
              {"time", s.time()},
              {"wall_seconds", result_.seconds},
              {"frames", frames_ ? frames_->frames() : 0},
              {"interrupted", result_.interrupted}};
    if (relaxes()) {
      json["converged"] = converged();
      json["residual"] = residual();
    }
    double mass = 0, added = 0;
    for (const ModelBody& body : s.model().bodies) {
      mass += body.mass;
      added += body.added_mass;
    }
    json["mass"] = mass;
    json["added_mass"] = added;
    const Inversions& inverted = s.inversions();
    json["inverted"] = {{"batches", inverted.batches}, {"most", inverted.most}, {"now", inverted.last}};
    json["calmed_elements"] = inverted.calmed;
    if (inverted.calmed > 0) {
      o_.common.note(
          fmt::format("in {} elements, counted batch by batch, motion faster than sound was taken out", inverted.calmed));
    }
    if (inverted.batches > 0) {
      json["inverted"]["first"] = {
          {"step", inverted.first_step}, {"time", inverted.first_time}, {"body", inverted.body}, {"element", inverted.element}};
      o_.common.note(
          fmt::format("up to {} elements at a time were turned inside out and driven back, first in step {} (t = {:.4g} s), "
                      "element {} of body '{}'; {} in the last steps",
                      inverted.most, inverted.first_step, inverted.first_time, inverted.element, inverted.body, inverted.last));
    }
    const BallastReport& ballast = s.ballast();
    json["opened_edges"] = s.state().opened;
    if (s.state().opened > 0) {
      o_.common.note(fmt::format("{} edges were stretched beyond {:.3g} times their length and parted (\"break_stretch\")",
                                 s.state().opened, s.scene().break_stretch));
    }
    json["ballast"] = {{"nodes", ballast.nodes}, {"mass", ballast.mass}, {"most", ballast.most}};
    if (ballast.most > 0) {
      o_.common.note(fmt::format(
          "elements that asked for less than {:.3g} of the first step got inertia instead: at most {:.3g} of the mass, {:.3g} "
          "on {} nodes at the end",
          s.scene().least_step, ballast.most / mass, ballast.mass / mass, ballast.nodes));
    }
    if (!result_.diverged.empty()) json["diverged_step"] = result_.diverged_step;
    print_summary(info, simulated);
    if (o_.profile) json["profile"] = profile();
    if (o_.hash && o_.common.quiet && o_.common.json != "-") fmt::print("{}\n", hash);
    o_.common.print("hash " + hash);
    if (o_.deep_hash) o_.common.print("deep hash " + hash_text(s.deep_hash()));
    o_.common.write(json);
  }

  void print_summary(const BackendInfo& info, double simulated) const {
    const Simulation& s = *simulation_;
    const Common& out = o_.common;
    out.print(fmt::format("{}: {} nodes, {} elements on {} ({}), {}", stem_, s.model().nodes(), s.model().elements(), info.name,
                          info.device, info.bit_exact ? "bit-exact" : "tolerance"));
    const std::string share =
        s.stable_dt() > 0 ? fmt::format(", {:.3g} of the stable {:.6g} s", s.dt() / s.stable_dt(), s.stable_dt()) : "";
    out.print(fmt::format("{} steps of {:.6g} s{}", result_.steps, s.dt(), share));
    if (relaxes()) {
      out.print(fmt::format("{}: residual {:.3g}, tolerance {:.3g}", converged() ? "at equilibrium" : "not at equilibrium",
                            residual(), s.scene().relaxation.tolerance));
    }
    out.print(fmt::format("simulated {:.6g} s in {:.3g} s: {:.4g} ms per step (median), {:.3g} times real time", simulated,
                          result_.seconds, result_.ms_per_step, result_.seconds > 0 ? simulated / result_.seconds : 0.0));
    if (frames_) out.print(fmt::format("{} frames in {}", frames_->frames(), frames_->folder().string()));
  }

  Json profile() {
    Json rows = Json::array();
    const auto times = simulation_->backend().take_profile();
    double total = 0;
    for (const PassTime& t : times) total += t.seconds;
    for (const PassTime& t : times) {
      rows.push_back({{"kernel", t.kernel}, {"label", t.label}, {"seconds", t.seconds}, {"launches", t.launches}});
      o_.common.print(fmt::format("  {:<22} {:<36} {:>8} launches {:>9.3f} us each {:>5.1f} %", t.kernel, t.label, t.launches,
                                  1e6 * t.seconds / static_cast<double>(t.launches), total > 0 ? 100 * t.seconds / total : 0));
    }
    return rows;
  }

  const Options& o_;
  const std::string stem_;
  std::optional<Simulation> simulation_;
  std::optional<FrameWriter> frames_;
  RunResult result_;
  double first_time_ = 0;
};

}  // namespace

std::function<int()> setup_run(CLI::App& app) {
  auto o = std::make_shared<Options>();
  app.add_option("scene", o->scene, "Scene file")->required();
  app.add_option("--backend", o->backend, "auto, cpu, cpu:double, cpu:check, opencl or opencl:N")->capture_default_str();
  auto* steps = app.add_option("--steps", o->steps, "Steps of this run; default: to the scene's duration, or to equilibrium");
  app.add_option("--seconds", o->seconds, "Simulated time of this run [s]")->excludes(steps);
  app.add_option("--dt", o->dt, "Step [s] instead of the scene's");
  app.add_option("--out", o->out, "Folder for frames; made where missing")->type_name("DIR");
  app.add_option("--every", o->every, "Steps between two frames; default: 1/60 s");
  app.add_option("--format", o->formats, explained(format_words()))->delimiter(',')->capture_default_str();
  o->picture.add_to(app);
  app.add_option("--checkpoint", o->checkpoint, "Save the last state")->type_name("FILE");
  app.add_option("--resume", o->resume, "Go on from a saved state of the same scene")->type_name("FILE");
  app.add_flag("--deep-hash", o->deep_hash,
               "Also print the hash of all that decides what comes: model, state buffers and run state");
  app.add_flag("--hash", o->hash, "Print the hash of the last state, with --quiet as the only output");
  app.add_flag("--profile", o->profile, "Time every pass on the device; this slows a run down");
  o->common.add_to(app);
  return [o] { return Run(*o)(); };
}

}  // namespace pliant::cli
