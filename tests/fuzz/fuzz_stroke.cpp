// Any bytes may stand in a recorded stroke. One that is read comes back with the same bits after it was written.
#include <string>

#include "devices/stroke.h"
#include "pliant/error.h"
#include "sound_sample.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pliant::devices;
  std::vector<pliant::DeviceSample> samples;
  try {
    samples = parse_stroke({reinterpret_cast<const char*>(data), size}, "stroke.csv");
  } catch (const pliant::Error&) {
    return 0;
  }
  for (const pliant::DeviceSample& sample : samples) expect_sound(sample);
  const std::string written = stroke_text(samples);
  const std::vector<pliant::DeviceSample> again = parse_stroke(written, "stroke.csv");
  if (again.size() != samples.size() || stroke_text(again) != written) std::abort();
  for (std::size_t i = 0; i < again.size(); ++i) {
    if (again[i].position != samples[i].position || again[i].turn != samples[i].turn || again[i].time != samples[i].time)
      std::abort();
  }
  return 0;
}
