#include "calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "pliant/world.h"

namespace pliant::bench_api {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFrame = 1.0 / 60;  ///< [s]
constexpr int kStroke = 125;         ///< frames that a blade takes through the body

struct Box {
  Vec3d low{}, high{};
};

Box box_of(const Frame& frame) {
  Box box{{1e30, 1e30, 1e30}, {-1e30, -1e30, -1e30}};
  for (const Vec4f& p : frame.positions) {
    for (std::size_t c = 0; c < 3; ++c) {
      box.low[c] = std::min<double>(box.low[c], p[c]);
      box.high[c] = std::max<double>(box.high[c], p[c]);
    }
  }
  return box;
}

/// Strokes along x, y and z in turn, each at another height, through seven tenths of the body.
std::array<Vec3d, 2> blade_at(const Box& box, int frame) {
  const int stroke = frame / kStroke;
  const auto along = static_cast<std::size_t>(stroke % 3), across = (along + 1) % 3, deep = (along + 2) % 3;
  const double way = -0.1 + 1.2 * (frame % kStroke) / (kStroke - 1), height = 0.2 + 0.6 * std::fmod(0.37 * stroke, 1);
  const auto at = [&](std::size_t axis, double share) { return box.low[axis] + share * (box.high[axis] - box.low[axis]); };
  std::array<Vec3d, 2> blade{};
  for (Vec3d& end : blade) {
    end[along] = at(along, way);
    end[across] = at(across, height);
  }
  blade[0][deep] = at(deep, -0.05);
  blade[1][deep] = at(deep, 0.65);
  return blade;
}

struct Call {
  const char* name;
  std::vector<double> ms;

  template <class F>
  void time(const F& call) {
    const auto start = Clock::now();
    call();
    ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  [[nodiscard]] double quantile(double share) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
  }
};

}  // namespace

int measure_calls(const std::string& scene, const std::string& backend, int frames) {
  WorldOptions options;
  options.backend = backend;
  options.cutting = true;
  World world = World::open(scene, options);
  const Box box = box_of(*world.frame());
  Call move{"move_blade", {}}, advance{"advance_async", {}}, take{"frame", {}};
  int busy = 0;
  const auto start = Clock::now();
  for (int f = 0; f < frames; ++f) {
    if (f > 0 && f % kStroke == 0) world.lift_blade("scalpel");
    const auto [a, b] = blade_at(box, f);
    move.time([&, a = a, b = b] { world.move_blade("scalpel", a, b); });
    advance.time([&] { busy += world.advance_async(kFrame) ? 0 : 1; });
    take.time([&] { (void)world.frame(); });
    std::this_thread::sleep_until(start +
                                  std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>((f + 1) * kFrame)));
  }
  const StepReport last = world.wait();
  fmt::print("{}, {}: {} frames at 60 Hz, {} pieces at the end\n", scene, world.info().backend, frames, world.pieces(0));
  fmt::print("{:14} {:>10} {:>10} {:>10}\n", "call", "median ms", "99 % ms", "worst ms");
  for (const Call* call : {&move, &advance, &take}) {
    fmt::print("{:14} {:10.3f} {:10.3f} {:10.3f}\n", call->name, call->quantile(0.5), call->quantile(0.99), call->quantile(1));
  }
  fmt::print("frames without a new state: {} ({:.1f} %), time {:.2f} s of {:.2f} s\n", busy, 100.0 * busy / frames, last.time,
             frames * kFrame);
  return last.diverged ? 4 : 0;
}

}  // namespace pliant::bench_api
