// A surgical trainer: an organ on a table, a probe that presses and slides, a scalpel, a hand that lifts the flap, save, load and
// reset, all while the World runs freely and a program draws sixty frames a second. It uses include/pliant only.
#pragma once
#include <pliant/pliant.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace trainer {

/// Builds the scene: `organs` copies of a closed triangle mesh [m] above a table, and a probe above them.
inline pliant::SceneSpec scene_of(const std::string& mesh, double scale, std::int64_t nodes, bool hybrid, int organs) {
  pliant::SceneSpec scene;
  scene.name = "trainer";
  scene.gravity = {0, -9.81, 0};
  scene.contact = pliant::ContactSpec{0.3};
  for (int i = 0; i < organs; ++i) {
    pliant::BodySpec organ;
    organ.name = "organ" + std::to_string(i);
    organ.surface_file = mesh;
    organ.scale = scale;
    organ.translate = {0, 0.13 * i, 0};
    organ.lattice_nodes = nodes;
    organ.material.young = 9000;
    organ.material.poisson = 0.45;
    organ.material.density = 1060;
    organ.material.damping = 15;
    if (hybrid) organ.model.type = "hybrid", organ.model.ratio = 0.4, organ.model.follow = "probe", organ.model.seed = {0, 0.03, 0};
    scene.bodies.push_back(organ);
  }
  pliant::ToolSpec table, probe;
  table.name = "table";
  table.shape = "half_space";
  table.first = {0, -0.08, 0};
  table.second = {0, 1, 0};
  table.friction = 0.5;
  probe.name = "probe";
  probe.shape = "capsule";
  probe.first = {0, 0, 0};
  probe.second = {0, 0.12, 0};
  probe.radius = 0.008;
  probe.friction = 0.2;
  probe.path = {{0, 0.02, 0.13 * organs, 0, 0, 0, 0, 1}};
  scene.tools = {table, probe};
  return scene;
}

/// What a session was like.
struct Report {
  double wall = 0, simulated = 0;          ///< time outside of save, load and reset [s]
  std::int64_t frames = 0, stale = 0;      ///< pictures drawn, and those that showed nothing new
  std::int64_t forces = 0;                 ///< steps with a force on the probe or an update of the grab's
  double probe_force = 0, grab_force = 0;  ///< greatest [N]
  double grab_gap = 0;                     ///< from the held vertex to the hand, at the end of the lift [m]
  std::map<std::string, double> worst;     ///< longest duration of each call [s]
  std::vector<pliant::Event> events;
  pliant::LiveState live;
  std::string backend;
  [[nodiscard]] double real_time() const { return wall > 0 ? simulated / wall : 0; }
  [[nodiscard]] double stale_share() const { return frames > 0 ? static_cast<double>(stale) / static_cast<double>(frames) : 0; }
};

class Session {
 public:
  Session(const pliant::SceneSpec& scene, const std::string& backend, std::string checkpoint)
      : world_(scene, {backend, 0, true, true, true}), file_(std::move(checkpoint)) {}

  /// Draws `seconds` at `rate` pictures per second; `draw` receives every frame.
  template <class Draw>
  Report run(double seconds, double rate, Draw&& draw) {
    using Clock = std::chrono::steady_clock;
    timed("run_live", [&] { world_.run_live({rate, 1}); });
    const auto start = Clock::now();
    auto before = start;
    const auto pictures = static_cast<std::int64_t>(seconds * rate);
    for (std::int64_t picture = 1; picture <= pictures; ++picture) {
      std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(static_cast<double>(picture) / rate)));
      const auto now = Clock::now();
      const bool fresh = timed("poll", [&] { return world_.poll(); });
      const pliant::FramePtr frame = timed("frame", [&] { return world_.frame(); });
      look(*frame, fresh, std::chrono::duration<double>(now - before).count());
      before = now;
      act(20 * static_cast<double>(picture) / static_cast<double>(pictures), 1 / rate, *frame);
      draw(*frame);
    }
    report_.backend = world_.info().backend + " (" + world_.info().reason + ")";
    report_.live = timed("live_state", [&] { return world_.live_state(); });
    world_.stop_live();
    take_events();
    return report_;
  }

 private:
  template <class Call>
  auto timed(const char* name, Call&& call) {
    struct Watch {
      std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
      double& worst;
      ~Watch() { worst = std::max(worst, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()); }
    } const watch{.worst = report_.worst[name]};
    return call();
  }

  /// Counts a picture, unless a save, load or reset holds time up.
  void look(const pliant::Frame& frame, bool fresh, double wall) {
    take_events();
    if (waiting_ == 0) {
      ++report_.frames;
      report_.stale += fresh ? 0 : 1;
      report_.wall += wall;
      report_.simulated += std::max(0.0, frame.time - shown_);
    }
    shown_ = frame.time;
    const auto samples = timed("force_trace", [&] { return world_.force_trace("probe", seen_); });
    for (const pliant::ForceSample& s : samples) report_.probe_force = std::max(report_.probe_force, size(s.force));
    if (!samples.empty()) seen_ = samples.back().step;
    report_.forces += static_cast<std::int64_t>(samples.size());
  }

  void take_events() {
    for (pliant::Event& event : timed("events", [&] { return world_.events(); })) {
      if (event.kind == "saved" || event.kind == "loaded" || event.kind == "reset") --waiting_, seen_ = -1;
      report_.events.push_back(std::move(event));
    }
  }

  /// What the trainee does at a time of the session, which has 20 parts.
  void act(double t, double period, const pliant::Frame& frame) {
    const pliant::Vec3d above{0.02, 0.13, 0};
    const auto once = [&](int part) { return t >= part && std::exchange(done_, std::max(done_, part)) < part; };
    if (t > 2 && t < 8) {  // down, along, up again
      const double down = std::min({1.0, (t - 2) / 2, 8 - t}), along = std::clamp((t - 4) / 3, 0.0, 1.0);
      drive({above[0] - 0.05 * along, above[1] - (above[1] - top_ + 0.018) * down, 0}, period);
    } else if (t <= 2) {
      top_ = highest(frame);
    }
    if (t > 9 && t < 11) {  // a slice, from the side into the middle
      const double x = 0.12 - 0.08 * (t - 9) / 2;
      timed("move_blade", [&] { world_.move_blade("scalpel", {x, cut_height(), -0.15}, {x, cut_height(), 0.15}); });
    }
    if (once(11)) timed("lift_blade", [&] { world_.lift_blade("scalpel"); });
    if (once(12)) hold();
    if (grab_ != 0 && t < 15) lift(std::min(1.0, (t - 12) / 2));
    if (once(15) && grab_ != 0) timed("release", [&] { world_.release(std::exchange(grab_, 0)); });
    if (once(16)) ++waiting_, timed("save", [&] { world_.save(file_); });
    if (once(17)) ++waiting_, timed("load", [&] { world_.load(file_); });
    if (once(18)) ++waiting_, timed("reset", [&] { world_.reset(); });
  }

  void drive(const pliant::Vec3d& to, double period) {
    timed("drive_tool", [&] { world_.drive_tool("probe", to, {0, 0, 0, 1}, period); });
    timed("tool_forces", [&] { return world_.tool_forces(); });
  }

  void hold() {
    const auto hit = timed("pick", [&] { return world_.pick({0.075, 0.5, 0}, {0, -1, 0}); });
    if (!hit) return;
    from_ = hit->point;
    grab_ = timed("grab", [&] { return world_.grab(hit->vertex); });
  }

  void lift(double share) {
    timed("move_grab", [&] { world_.move_grab(grab_, {from_[0] - 0.02 * share, from_[1] + 0.03 * share, from_[2]}); });
    const pliant::GrabState felt = timed("grab_state", [&] { return world_.grab_state(grab_); });
    report_.grab_force = std::max(report_.grab_force, size(felt.force));
    report_.grab_gap = size(felt.gap);
  }

  static double size(const pliant::Vec3d& v) { return std::hypot(v[0], v[1], v[2]); }
  static double highest(const pliant::Frame& frame) {
    double y = -1;
    for (const pliant::Vec4f& x : frame.positions) y = std::max(y, static_cast<double>(x[1]));
    return y;
  }
  [[nodiscard]] double cut_height() const { return top_ - 0.025; }

  pliant::World world_;
  std::string file_;
  Report report_;
  std::int64_t seen_ = -1;
  double shown_ = 0, top_ = 0;
  int done_ = 0, waiting_ = 0;
  pliant::GrabId grab_ = 0;
  pliant::Vec3d from_{};
};

}  // namespace trainer
