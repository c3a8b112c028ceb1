#include "bench/trainer/trainer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "bench/common/shipped_scenes.h"
#include "bench/kernels/kernels.h"
#include "examples/trainer/trainer.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Asked {
  const char* name;
  trainer::Organ organ;
  double rate;  ///< pictures per second
};

std::vector<Asked> all_organs(const fs::path& scenes) {
  const std::string liver = (scenes / "meshes/liver.obj").string();
  const std::string bunny = "/usr/share/glmark2/models/bunny.obj";  // of scenes/bunny.json, too
  return {{"liver_hybrid", {liver, 1, 2886, true, 1}, 60},
          {"liver", {liver, 1, 2886, false, 1}, 60},
          {"two_livers", {liver, 1, 2886, false, 2}, 60},
          {"bunny", {bunny, 0.0756633, 2250, false, 1}, 30},
          {"liver_10k", {liver, 1, 10000, false, 1}, 30}};
}

/// Threads that compute all the time.
class Busy {
 public:
  explicit Busy(int count) {
    for (int i = 0; i < count; ++i)
      threads_.emplace_back([this] {
        for (volatile double x = 1; !stop_;) x = std::sqrt(x + 1);
      });
  }
  ~Busy() {
    stop_ = true;
    for (std::thread& t : threads_) t.join();
  }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

json row_of(const Asked& asked, const trainer::Report& report, std::size_t nodes) {
  const auto [call, worst] = *std::max_element(report.worst.begin(), report.worst.end(),
                                               [](const auto& a, const auto& b) { return a.second < b.second; });
  std::size_t cuts = 0, refused = 0;
  for (const Event& e : report.events) {
    cuts += e.kind == "cut" ? 1 : 0;
    refused += e.kind == "refused" ? 1 : 0;
  }
  json calls;
  for (const auto& [name, seconds] : report.worst) calls[name] = 1000 * seconds;
  return {{"organ", asked.name},
          {"backend", report.backend},
          {"nodes", nodes},
          {"rate", asked.rate},
          {"wall_seconds", report.wall},
          {"real_time", report.real_time()},
          {"pictures", report.frames},
          {"stale", report.stale_share()},
          {"load", report.live.load},
          {"lost_seconds", report.live.lost},
          {"cuts", cuts},
          {"refused", refused},
          {"probe_force", report.probe_force},
          {"force_samples", report.forces},
          {"grab_force", report.grab_force},
          {"grab_gap", report.grab_gap},
          {"worst_call", call},
          {"worst_call_ms", 1000 * worst},
          {"calls_ms", std::move(calls)}};
}

}  // namespace

json bench_trainer(const TrainerOptions& options) {
  if (!(options.seconds >= 1 && options.seconds <= 3600))
    throw Error(ErrorCode::usage, fmt::format("--seconds: got {}, expected 1 to 3600", options.seconds));
  if (options.busy < 0 || options.busy > 1024)
    throw Error(ErrorCode::usage, fmt::format("--busy: got {}, expected 0 to 1024", options.busy));
  if (options.ahead < 0 || options.ahead > 4)
    throw Error(ErrorCode::usage, fmt::format("--ahead: got {}, expected 0 to 4", options.ahead));
  std::vector<Asked> organs = all_organs(find_shipped_scenes(options.scenes, "meshes/liver.obj"));
  std::string names;
  for (const Asked& a : organs) names += fmt::format("{}{}", names.empty() ? "" : ", ", a.name);
  for (const std::string& name : options.organs) {
    if (std::none_of(organs.begin(), organs.end(), [&](const Asked& a) { return a.name == name; }))
      throw Error(ErrorCode::usage, fmt::format("--organs: got {}, expected some of {}", name, names));
  }
  if (!options.organs.empty()) {
    std::erase_if(organs, [&](const Asked& a) {
      return std::find(options.organs.begin(), options.organs.end(), a.name) == options.organs.end();
    });
  }
  if (options.quick) organs.resize(1);
  json result{{"machine", machine_facts()},
              {"seconds", options.quick ? 3 : options.seconds},
              {"busy", options.busy},
              {"ahead", options.ahead}};
  result["rows"] = json::array();
  const std::string file = (fs::temp_directory_path() / fmt::format("pliant-trainer-{}.pck", ::getpid())).string();
  for (std::size_t i = 0; i < organs.size(); ++i) {
    if (options.progress) options.progress(static_cast<double>(i) / static_cast<double>(organs.size()), organs[i].name);
    if (!fs::exists(organs[i].organ.mesh)) {
      result["rows"].push_back({{"organ", organs[i].name}, {"message", organs[i].organ.mesh + " is not there"}});
      continue;
    }
    trainer::Session session(trainer::scene_of(organs[i].organ), options.backend, file);
    const Busy busy(options.busy);
    const trainer::Report report = session.run(result["seconds"], organs[i].rate, options.ahead, [](const Frame&) {});
    result["rows"].push_back(row_of(organs[i], report, static_cast<std::size_t>(report.nodes)));
  }
  std::error_code ignored;
  fs::remove(file, ignored);
  return result;
}

std::string trainer_table(const json& result) {
  std::string text = fmt::format("{:<13} {:>6} {:>5} {:>10} {:>7} {:>6} {:>5} {:>9} {:>9} {:>10}  {}\n", "organ", "nodes", "Hz",
                                 "real time", "stale", "load", "cuts", "probe N", "grab N", "grab gap", "worst call");
  for (const json& r : result["rows"]) {
    if (r.contains("message")) {
      text += fmt::format("{:<13} {}\n", r["organ"].get<std::string>(), r["message"].get<std::string>());
      continue;
    }
    text +=
        fmt::format("{:<13} {:>6} {:>5} {:>10.3f} {:>5.1f} % {:>6.2f} {:>5} {:>9.2f} {:>9.2f} {:>7.1f} mm  {} {:.2f} ms\n",
                    r["organ"].get<std::string>(), r["nodes"].get<std::int64_t>(), r["rate"].get<double>(),
                    r["real_time"].get<double>(), 100 * r["stale"].get<double>(), r["load"].get<double>(), r["cuts"].get<int>(),
                    r["probe_force"].get<double>(), r["grab_force"].get<double>(), 1000 * r["grab_gap"].get<double>(),
                    r["worst_call"].get<std::string>(), r["worst_call_ms"].get<double>());
  }
  return text;
}

}  // namespace pliant::bench
