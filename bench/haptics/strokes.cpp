// The buffer model against the full model, over strokes of a hand.
#include <fmt/format.h>

#include <cmath>

#include "bench/haptics/parts.h"
#include "bench/haptics/spectrum.h"

namespace pliant::bench::haptics {
namespace {

/// Asked of a buffer of this many rings, at 60 frames a second: largest and root mean square difference, as shares of the
/// largest force (Kim and Lee 2020 report the largest).
constexpr std::int32_t kAsked = 4;
constexpr double kMost = 0.10, kRms = 0.02;

std::string size_of(std::int32_t rings) {
  return rings < 0 ? "the whole body" : rings == 1 ? "1 ring" : fmt::format("{} rings", rings);
}

struct Result {
  ForceError error;
  SessionReport report;
};

Result measure(PartRun& run, const HandScene& scene, const ForceTrace& full, double frames, std::int32_t rings) {
  SessionOptions options;
  options.frame_rate = frames;
  options.haptic_rate = kTickRate;
  options.seconds = scene.seconds;
  options.rings = rings;
  Result out{{}, with_buffer(scene.scene, scene.tool, scene.stroke, options)};
  out.error = compare(out.report.felt, full);
  const std::string name = fmt::format("{}, {}, {} frames a second", scene.name, size_of(rings), frames);
  const double largest = out.error.largest, most = out.error.most / largest, rms = out.error.rms / largest;
  const std::string of_most = "largest difference from the full model, over the largest force";
  const std::string of_rms = "root mean square difference from the full model, over the largest force";
  if (frames == 60 && rings == kAsked) {
    run.at_most(of_most, name, most, kMost);
    run.at_most(of_rms, name, rms, kRms);
  } else if (rings < 0) {
    run.at_most(of_rms + ", whole body", name, rms, 0.005);
  } else {
    run.told(of_most, name, most);
    run.told(of_rms, name, rms);
  }
  run.at_most("buffers that blew up", name, static_cast<double>(out.report.resets), 0);
  run.told("work of a tick [us]", name, 1e6 * out.report.tick_seconds / static_cast<double>(out.report.ticks));
  run.told("elements of the buffer, at most", name, static_cast<double>(out.report.elements));
  return out;
}

}  // namespace

void measure_strokes(PartRun& run) {
  const std::vector<HandScene> scenes = hand_scenes(run.options);
  const std::vector<std::int32_t> sizes = run.options.quick ? std::vector<std::int32_t>{1, 4} : std::vector{1, 2, 3, 4, 5, -1};
  const std::vector<double> rates = run.options.quick ? std::vector{60.0} : std::vector{30.0, 60.0};
  double done = 0;
  for (const HandScene& scene : scenes) {
    const ForceTrace full = full_model(scene.scene, scene.tool, scene.stroke, scene.seconds, kTickRate);
    run.trace(scene.name, "full", full);
    for (const double frames : rates) {
      double first = 0, last = 0;
      for (const std::int32_t rings : sizes) {
        run.show(done / static_cast<double>(scenes.size() * rates.size() * sizes.size()), scene.name + ", " + size_of(rings));
        const Result result = measure(run, scene, full, frames, rings);
        if (rings == 1) first = result.error.rms;
        if (rings > 1) last = result.error.rms;
        if (rings == kAsked) {
          run.trace(scene.name, fmt::format("{} rings, {} frames a second", rings, frames), result.report.felt);
          run.told("largest change from tick to tick, over that of the full model",
                   fmt::format("{}, {} frames a second", scene.name, frames),
                   largest_jump(result.report.felt) / largest_jump(full));
        }
        ++done;
      }
      run.at_most("difference with the most rings over that with one",
                  fmt::format("{}, {} frames a second", scene.name, frames), last / first, 1);
    }
  }
}

}  // namespace pliant::bench::haptics
