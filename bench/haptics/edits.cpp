// A cut that a hand feels: the tissue under a pressed ball is cut away from its side.
#include <fmt/format.h>

#include <cmath>

#include "bench/contact/scenes.h"
#include "bench/haptics/parts.h"

namespace pliant::bench::haptics {
namespace {

constexpr double kFrames = 60, kFirst = 0.6, kLast = 0.9;

/// A blade goes down beside the ball, from above the block through two thirds of it.
void cut(Simulation& s, double time) {
  if (time < kFirst || time > kLast) return;
  const double share = (time - kFirst) / (kLast - kFirst), height = 0.045 - 0.03 * share, x = 0.0123;
  s.move_blade("scalpel", {Vec3d{x, height, -0.04}, Vec3d{x, height, 0.04}});
}

HandScene pressed() {
  HandScene scene;
  scene.name = "block";
  scene.tool = "ball";
  scene.scene.bodies = {contact::body_of("block", contact::cells_surface({16, 8, 12}, 0.005, {-0.04, 0, -0.03}), 0.005,
                                         ElementKind::hex8, contact::tissue(5000, 0.45, 30))};
  scene.scene.bodies[0].fixed = {{contact::face(1, 0)}};
  ContactTool ball;
  ball.name = "ball";
  ball.radius = 0.01;
  scene.scene.tools = {ball};
  scene.stroke = [](double t) {
    const double s = std::min(1.0, t / 0.4), share = s * s * s * (10 + s * (6 * s - 15));
    return Pose{{0, 0.054 - 0.012 * share, 0}, {0, 0, 0, 1}};
  };
  scene.seconds = 1.4;
  return scene;
}

double force_at(const ForceTrace& trace, double time) {
  return trace.wrench.at(static_cast<std::size_t>(std::lround(time / trace.period)) - 1).force[1];
}

}  // namespace

void measure_edits(PartRun& run) {
  const HandScene scene = pressed();
  run.show(0, "full model");
  const ForceTrace full = full_model(scene.scene, scene.tool, scene.stroke, scene.seconds, kTickRate, cut, 1 / kFrames);
  SessionOptions options;
  options.frame_rate = kFrames;
  options.haptic_rate = kTickRate;
  options.seconds = scene.seconds;
  options.rings = 4;
  run.show(0.5, "buffer");
  const SessionReport felt = with_buffer(scene.scene, scene.tool, scene.stroke, options, cut);
  run.trace("block, cut", "full", full);
  run.trace("block, cut", "4 rings", felt.felt);
  const ForceError error = compare(felt.felt, full);
  const double before = force_at(full, kFirst - 0.05), after = force_at(full, scene.seconds - 0.02);
  run.told("force before the cut [N]", "full model", before);
  run.told("force after the cut over the force before", "full model", after / before);
  run.close_to("force after the cut [N]", "4 rings", force_at(felt.felt, scene.seconds - 0.02), after, 0.05);
  run.at_most("root mean square difference from the full model, over the largest force", "4 rings", error.rms / error.largest,
              0.05);
  run.told("largest difference from the full model, over the largest force", "4 rings", error.most / error.largest);
  run.told("buffers built", "4 rings", static_cast<double>(felt.built));
  run.at_most("buffers that blew up", "4 rings", static_cast<double>(felt.resets), 0);
}

}  // namespace pliant::bench::haptics
