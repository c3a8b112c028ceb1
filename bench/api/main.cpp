// What the embedding API costs over the bare schedule: the same steps through Simulation's batches and through World, in turns.
// Usage: bench_api SCENE [BACKEND]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "api/world_impl.h"
#include "backends/backends.h"

namespace {

using pliant::Simulation;
using pliant::World;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kSteps = 256;  ///< of one timed piece: whole batches, with one look at the automatic step
constexpr int kRounds = 24;           ///< the order of the ways turns from round to round

void schedule(Simulation& s, std::int64_t steps) {
  const std::int64_t end = s.step() + steps;
  while (s.step() < end) {
    const std::int32_t n = s.next_batch(end - s.step());
    s.begin_batch(n);
    s.backend().run(s.program().step, 0, n, s.step());
    s.end_batch(n);
  }
}

/// Steps frame by frame at 60 Hz, as a renderer does.
void frames(World& w, std::int64_t steps) {
  const auto per_frame = std::max<std::int64_t>(1, static_cast<std::int64_t>(1.0 / 60 / w.dt()));
  for (std::int64_t done = 0; done < steps; done += per_frame) {
    w.step(std::min(per_frame, steps - done));
    (void)w.frame();
  }
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

int run(const std::string& scene, const std::string& backend) {
  pliant::WorldOptions plain, bare_frames;
  plain.backend = bare_frames.backend = backend;
  bare_frames.normals = false;
  World world = World::open(scene, plain), reader = World::open(scene, bare_frames), renderer = World::open(scene, plain);
  Simulation simulation(pliant::load_scene(scene), pliant::open_backend(world.info().backend));
  struct Way {
    const char* name;
    std::function<void()> piece;
    std::vector<double> seconds;
  };
  std::vector<Way> ways{{"the schedule (batches of Simulation)", [&] { schedule(simulation, kSteps); }, {}},
                        {"World::step", [&] { world.step(kSteps); }, {}},
                        {"World::step and frame at 60 Hz, without normals", [&] { frames(reader, kSteps); }, {}},
                        {"World::step and frame at 60 Hz, with normals", [&] { frames(renderer, kSteps); }, {}}};
  for (int round = -2; round < kRounds; ++round) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      Way& way = ways[(i + static_cast<std::size_t>(round + 2)) % ways.size()];
      const auto start = Clock::now();
      way.piece();
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      if (round >= 0) way.seconds.push_back(seconds / kSteps);
    }
  }
  fmt::print("{}\n{} nodes, {} surface vertices\n", world.info().reason, world.info().nodes, world.info().vertices);
  const double base = median(ways[0].seconds);
  for (Way& way : ways) {
    const double ms = 1e3 * median(way.seconds);
    fmt::print("{:50} {:8.4f} ms per step, {:+6.2f} %\n", way.name, ms, 100 * (ms * 1e-3 / base - 1));
  }
  if (world.hash() != simulation.hash()) {
    fmt::print("the states differ\n");
    return 1;
  }
  fmt::print("hash {:016x} in both\n", world.hash());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_api SCENE [BACKEND]\n");
    return 2;
  }
  try {
    return run(argv[1], argc > 2 ? argv[2] : "auto");
  } catch (const pliant::Error& error) {
    fmt::print(stderr, "bench_api: {}\n", error.what());
    return 2;
  }
}
