// What the embedding API costs over the bare schedule: the same steps through Simulation's batches and through World, in turns.
// With --calls: how long a renderer waits in its calls while it cuts.
// Usage: bench_api SCENE [BACKEND] [--calls [FRAMES]]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "api/world_impl.h"
#include "backends/choice/backends.h"
#include "calls.h"

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
    s.run_steps(0, n);
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
  std::vector<std::string> words(argv + 1, argv + argc);
  const auto option = std::find(words.begin(), words.end(), "--calls");
  const bool calls = option != words.end();
  const int frames = calls && option + 1 != words.end() ? std::atoi((option + 1)->c_str()) : 1000;
  words.erase(option, words.end());
  if (words.empty() || words.size() > 2 || frames < 1) {
    fmt::print(stderr, "usage: bench_api SCENE [BACKEND] [--calls [FRAMES]]\n");
    return 2;
  }
  const std::string backend = words.size() > 1 ? words[1] : "auto";
  try {
    return calls ? pliant::bench_api::measure_calls(words[0], backend, frames) : run(words[0], backend);
  } catch (const pliant::Error& error) {
    fmt::print(stderr, "bench_api: {}\n", error.what());
    return 2;
  }
}
