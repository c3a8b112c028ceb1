#include "devices/mouse_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "devices/check_sample.h"
#include "pliant/error.h"

namespace pliant::devices {

void move_pose(DeviceSample& pose, const CapAxes& cap, double dt, const MouseSpeeds& speeds) {
  const double step = std::clamp(dt, 0.0, 0.1);
  std::array<double, 6> share{};
  for (std::size_t i = 0; i < 6; ++i) share[i] = std::clamp(cap[i] / kFullDeflection, -1.0, 1.0) * (i % 3 == 2 ? -1 : 1);
  for (int a = 0; a < 3; ++a) {
    pose.position[a] = std::clamp(pose.position[a] + speeds.linear * share[a] * step, -kFarthest, kFarthest);
  }
  const std::array<double, 3> rate{share[3], share[4], share[5]};
  const double length = std::hypot(rate[0], rate[1], rate[2]);
  if (length == 0) return;
  const double half = 0.5 * speeds.turn * length * step, s = std::sin(half) / length;
  const double px = rate[0] * s, py = rate[1] * s, pz = rate[2] * s, pw = std::cos(half);
  const auto [x, y, z, w] = pose.turn;
  pose.turn = {pw * x + px * w + py * z - pz * y, pw * y - px * z + py * w + pz * x, pw * z + px * y - py * x + pz * w,
               pw * w - px * x - py * y - pz * z};
  double square = 0;
  for (const double q : pose.turn) square += q * q;
  for (double& q : pose.turn) q /= std::sqrt(square);
}

void press_button(DeviceSample& pose, int number, bool down) {
  if (number < 0 || number > 31) return;
  const std::uint32_t bit = 1U << number;
  pose.buttons = down ? pose.buttons | bit : pose.buttons & ~bit;
}

MouseSpeeds parse_speeds(const std::string& rest, const std::string& text) {
  MouseSpeeds speeds;
  for (std::size_t from = 0; from < rest.size();) {
    const std::size_t end = std::min(rest.find(',', from), rest.size());
    const std::string option = rest.substr(from, end - from);
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string name = option.substr(0, equals);
    double value = 0;
    const char* last = option.data() + option.size();
    const char* first = std::min(option.data() + equals + 1, last);
    const auto [after, error] = std::from_chars(first, last, value);
    const double least = name == "linear" ? 0.001 : 0.01, most = name == "linear" ? 10 : 100;
    if ((name != "linear" && name != "turn") || error != std::errc() || after != last || !(value >= least && value <= most)) {
      throw Error(ErrorCode::usage,
                  fmt::format("haptic device \"{}\": got \"{}\", expected linear=0.001 to 10 [m/s] or turn=0.01 to 100 "
                              "[rad/s], for example spacenav:linear=0.05,turn=1",
                              text, option));
    }
    (name == "linear" ? speeds.linear : speeds.turn) = value;
    from = end + 1;
  }
  return speeds;
}

}  // namespace pliant::devices
