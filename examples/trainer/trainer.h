// A surgical trainer: an organ on a table, a probe that presses and slides, a scalpel, a hand that lifts the flap, save, load
// and reset, all while the World runs freely and a program draws sixty frames a second. It uses include/pliant only.
#pragma once
#include <pliant/pliant.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace trainer {

struct Organ {
  std::string mesh;  ///< an OBJ file, closed
  double scale = 1;  ///< factor on its coordinates, for metres
  std::int64_t nodes = 2886;
  bool hybrid = false;  ///< finite elements near the probe only, shape matching elsewhere
  int copies = 1;       ///< one above the other
};

/// Least and greatest height of the vertices of an OBJ file.
inline std::array<double, 2> heights(const std::string& file) {
  std::ifstream in(file);
  std::array<double, 2> range{1e30, -1e30};
  std::string word;
  for (std::string line; std::getline(in, line);) {
    double x = 0, y = 0;
    std::istringstream text(line);
    if (!(text >> word >> x >> y) || word != "v") continue;
    range = {std::min(range[0], y), std::max(range[1], y)};
  }
  return range;
}

/// The scene: the organs just above a table, and a probe above them.
inline pliant::SceneSpec scene_of(const Organ& organ) {
  const auto [low, high] = heights(organ.mesh);
  const double bottom = low * organ.scale, height = (high - low) * organ.scale;
  pliant::SceneSpec scene;
  scene.name = "trainer";
  scene.gravity = {0, -9.81, 0};
  scene.contact = pliant::ContactSpec{0.3};
  for (int i = 0; i < organ.copies; ++i) {
    pliant::BodySpec body;
    body.name = "organ" + std::to_string(i);
    body.surface_file = organ.mesh;
    body.scale = organ.scale;
    body.translate = {0, (height + 0.005) * i - bottom + 0.005, 0};
    body.lattice_nodes = organ.nodes;
    body.material.young = 9000;
    body.material.poisson = 0.45;
    body.material.density = 1060;
    body.material.damping = 15;
    if (organ.hybrid) {
      body.model.type = "hybrid";
      body.model.ratio = 0.4;
      body.model.follow = "probe";
    }
    scene.bodies.push_back(body);
  }
  pliant::ToolSpec table, probe;
  table.name = "table";
  table.shape = "half_space";
  table.friction = 0.5;
  probe.name = "probe";
  probe.shape = "capsule";
  probe.radius = 0.008;
  probe.second = {0, 0.12, 0};
  probe.friction = 0.2;
  probe.path = {{0, 0, (height + 0.005) * organ.copies + 0.08, 0, 0, 0, 0, 1}};
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
  std::int64_t nodes = 0;
  [[nodiscard]] double real_time() const { return wall > 0 ? simulated / wall : 0; }
  [[nodiscard]] double stale_share() const { return frames > 0 ? static_cast<double>(stale) / static_cast<double>(frames) : 0; }
};

class Session {
 public:
  Session(const pliant::SceneSpec& scene, const std::string& backend, std::string checkpoint)
      : world_(scene, {backend, 0, true, true, true}), file_(std::move(checkpoint)) {}

  /// Draws `seconds` at `rate` pictures per second; `draw` receives every frame. `ahead`: pliant::LiveOptions
  template <class Draw>
  Report run(double seconds, double rate, int ahead, Draw&& draw) {
    using Clock = std::chrono::steady_clock;
    timed("run_live", [&] { world_.run_live({rate, 1, ahead}); });
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
    report_.nodes = world_.info().nodes;
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
      const bool refused = event.kind == "refused" && event.subject == file_;
      if (refused || event.kind == "saved" || event.kind == "loaded" || event.kind == "reset") --waiting_, seen_ = -1;
      report_.events.push_back(std::move(event));
    }
  }

  /// What the trainee does at a time of the session, which has 20 parts.
  void act(double t, double period, const pliant::Frame& frame) {
    const auto once = [&](int part) { return t >= part && std::exchange(done_, std::max(done_, part)) < part; };
    const auto at = [&](std::size_t c, double share) { return low_[c] + share * (high_[c] - low_[c]); };
    if (t <= 2 || (t > 8 && t < 9)) measure(frame);
    if (t > 2 && t < 8) {  // down, along, up again
      const double down = std::min({1.0, (t - 2) / 2, 8 - t}), along = std::clamp((t - 4) / 3, 0.0, 1.0);
      drive({at(0, 0.6 - 0.25 * along), high_[1] + 0.06 - 0.078 * down, at(2, 0.5)}, period);
    }
    if (t > 9 && t < 11) {  // a slice, from the side into the middle
      const double x = at(0, 1.05 - 0.4 * (t - 9) / 2), y = high_[1] - 0.025;
      timed("move_blade", [&] { world_.move_blade("scalpel", {x, y, low_[2] - 0.03}, {x, y, high_[2] + 0.03}); });
    }
    if (once(11)) timed("lift_blade", [&] { world_.lift_blade("scalpel"); });
    if (once(12)) hold({at(0, 0.84), high_[1] + 0.5, at(2, 0.5)});
    if (grab_ != 0 && t < 15) lift(std::min(1.0, (t - 12) / 2));
    if (once(15) && grab_ != 0) timed("release", [&] { world_.release(std::exchange(grab_, 0)); });
    if (once(16)) ++waiting_, timed("save", [&] { world_.save(file_); });
    if (once(17)) ++waiting_, timed("load", [&] { world_.load(file_); });
    if (once(18)) ++waiting_, timed("reset", [&] { world_.reset(); });
  }

  /// Measures the organ that reaches highest.
  void measure(const pliant::Frame& frame) {
    double top = -1e30;
    for (const pliant::IndexRange& body : frame.body_vertices) {
      pliant::Vec3d low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
      for (std::size_t v = body.first; v < body.first + body.count; ++v) {
        for (std::size_t c = 0; c < 3; ++c) {
          low[c] = std::min(low[c], static_cast<double>(frame.positions[v][c]));
          high[c] = std::max(high[c], static_cast<double>(frame.positions[v][c]));
        }
      }
      if (high[1] > top) top = high[1], low_ = low, high_ = high;
    }
  }

  void drive(const pliant::Vec3d& to, double period) {
    timed("drive_tool", [&] { world_.drive_tool("probe", to, {0, 0, 0, 1}, period); });
    timed("tool_forces", [&] { return world_.tool_forces(); });
  }

  void hold(const pliant::Vec3d& above) {
    const auto hit = timed("pick", [&] { return world_.pick(above, {0, -1, 0}); });
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

  pliant::World world_;
  std::string file_;
  Report report_;
  std::int64_t seen_ = -1;
  double shown_ = 0;
  pliant::Vec3d low_{}, high_{};  ///< of the organ that reaches highest
  int done_ = 0, waiting_ = 0;
  pliant::GrabId grab_ = 0;
  pliant::Vec3d from_{};
};

}  // namespace trainer
