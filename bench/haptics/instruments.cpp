// A scalpel and forceps in the hand: the buffer model against the full model, where tissue gives way and is held.
#include <fmt/format.h>

#include <algorithm>

#include "bench/contact/scenes.h"
#include "bench/haptics/parts.h"
#include "haptics/driven_part.h"

namespace pliant::bench::haptics {
namespace {

constexpr double kSkin = 0.04, kFramesOf = 60;

/// Share of a way of least jerk (Flash and Hogan 1985), from 0 at `from` to 1 at `to` [s].
double eased(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

Scene soft_block() {
  Scene scene;
  scene.bodies = {contact::body_of("block", contact::cells_surface({16, 8, 12}, 0.005, {-0.04, 0, -0.03}), 0.005,
                                   ElementKind::hex8, contact::tissue(5000, 0.45, 30))};
  scene.bodies[0].fixed = {{contact::face(1, 0)}};
  return scene;
}

/// Down by 15 mm in a second, along its edge and up again.
HandScene scalpel() {
  HandScene hand{"scalpel, block", soft_block(), "scalpel", {}, 2.4};
  hand.scene.bodies[0].material.toughness = 8000;
  Blade blade;
  blade.name = hand.tool;
  blade.cuts = BladeCuts::by_force;
  blade.edge = 0.0005;
  blade.friction = 0.1;
  blade.path = {{0, 0.001, kSkin + 0.001, -0.04, 0.001, kSkin + 0.001, 0.04}};
  hand.scene.blades = {blade};
  hand.stroke = [](double t) {
    const double y = kSkin + 0.001 - 0.016 * eased(t, 0.1, 1.1) + 0.02 * eased(t, 1.6, 2.3), z = 0.004 * eased(t, 1.1, 1.5);
    return pliant::haptics::blade_pose({Vec3d{0.001, y, -0.04 + z}, Vec3d{0.001, y, 0.04 + z}});
  };
  return hand;
}

/// They take hold 3 mm deep and pull up by 8 mm.
HandScene forceps() {
  HandScene hand{"forceps, block", soft_block(), "forceps", {}, 1.4};
  ContactTool tool;
  tool.name = hand.tool;
  tool.radius = 0.01;
  tool.grip = GripSpec{0, {{0.4, 10}}};
  hand.scene.tools = {tool};
  hand.stroke = [](double t) {
    const double down = 0.004 * eased(t, 0, 0.35), up = 0.011 * eased(t, 0.45, 1);
    return Pose{{0, kSkin + 0.011 - down + up, 0}, {0, 0, 0, 1}};
  };
  return hand;
}

}  // namespace

void measure_instruments(PartRun& run) {
  double done = 0;
  for (const HandScene& hand : {scalpel(), forceps()}) {
    run.show(done, hand.name);
    const ForceTrace full = full_model(hand.scene, hand.tool, hand.stroke, hand.seconds, kTickRate);
    run.trace(hand.name, "full", full);
    for (const std::int32_t rings : {2, 4}) {
      run.show(done += 0.25, hand.name);
      SessionOptions options;
      options.frame_rate = kFramesOf;
      options.haptic_rate = kTickRate;
      options.seconds = hand.seconds;
      options.rings = rings;
      const SessionReport report = with_buffer(hand.scene, hand.tool, hand.stroke, options);
      const ForceError error = compare(report.felt, full);
      const std::string name = fmt::format("{}, {} rings", hand.name, rings);
      run.trace(hand.name, fmt::format("{} rings", rings), report.felt);
      run.told("largest force [N]", name, error.largest);
      run.at_most("root mean square difference from the full model, over the largest force", name, error.rms / error.largest,
                  rings == 4 ? 0.02 : 0.05);
      run.told("largest difference from the full model, over the largest force", name, error.most / error.largest);
      run.at_most("buffers that blew up", name, static_cast<double>(report.resets), 0);
      run.told("buffers built", name, static_cast<double>(report.built));
      run.told("work of a tick [us]", name, 1e6 * report.tick_seconds / static_cast<double>(report.ticks));
      run.told("elements of the buffer, at most", name, static_cast<double>(report.elements));
    }
  }
}

}  // namespace pliant::bench::haptics
