// Bodies that a hand presses: a block in memory, the shipped liver and bunny.
#include "bench/contact/scenes.h"

#include <algorithm>
#include <cmath>

#include "bench/common/shipped_scenes.h"
#include "bench/haptics/parts.h"
#include "model/model.h"
#include "scene/blade_face.h"

namespace pliant::bench::haptics {
namespace {

constexpr double kFriction = 0.2;

/// A place of the tool and when it is there.
struct Waypoint {
  double time;  ///< [s]
  Vec3d position;
};

/// Between two waypoints the jerk is least (Flash and Hogan 1985): x(s) = 10 s^3 - 15 s^4 + 6 s^5.
Stroke minimum_jerk(std::vector<Waypoint> way) {
  return [way = std::move(way)](double t) {
    const auto after = std::find_if(way.begin(), way.end(), [&](const Waypoint& w) { return w.time > t; });
    if (after == way.begin()) return Pose{way.front().position, {0, 0, 0, 1}};
    if (after == way.end()) return Pose{way.back().position, {0, 0, 0, 1}};
    const Waypoint& from = *(after - 1);
    const double s = (t - from.time) / (after->time - from.time), share = s * s * s * (10 + s * (6 * s - 15));
    Pose pose;
    for (std::size_t c = 0; c < 3; ++c) pose.position[c] = from.position[c] + share * (after->position[c] - from.position[c]);
    return pose;
  };
}

/// What is done to a body: pressed at `place`, from above, then drawn along `along`.
struct Palpation {
  double radius, depth;  ///< of the ball, and how far it is pressed [m]
  Vec3d place, along;    ///< where the surface is pressed; the way along it [m]
};

/// About 0.1 m/s at most, as a surgeon's hand (Brown et al. 2003).
HandScene palpated(const std::string& name, Scene scene, const Palpation& p) {
  HandScene out;
  out.name = name;
  ContactTool ball;
  ball.name = out.tool = "ball";
  ball.radius = p.radius;
  ball.friction = kFriction;
  scene.tools = {ball};
  drop_blades(scene);
  const Vec3d above{p.place[0], p.place[1] + p.radius + 0.004, p.place[2]};
  const Vec3d pressed{above[0], above[1] - 0.004 - p.depth, above[2]};
  const Vec3d drawn{pressed[0] + p.along[0], pressed[1] + p.along[1], pressed[2] + p.along[2]};
  const Vec3d lifted{drawn[0], drawn[1] + 0.008 + p.depth, drawn[2]};
  out.stroke = minimum_jerk({{0, above}, {0.45, pressed}, {0.65, pressed}, {1.25, drawn}, {1.4, drawn}, {1.85, lifted}});
  out.seconds = 2;
  out.scene = std::move(scene);
  return out;
}

HandScene block() {
  Scene scene;
  scene.bodies = {contact::body_of("block", contact::cells_surface({16, 8, 12}, 0.005, {-0.04, 0, -0.03}), 0.005,
                                   ElementKind::hex8, contact::tissue(5000, 0.45, 30))};
  scene.bodies[0].fixed = {{contact::face(1, 0)}};
  return palpated("block", std::move(scene), {0.01, 0.008, {-0.012, 0.04, 0}, {0.024, 0, 0.006}});
}

/// The highest vertex within a centimetre of a vertical line.
Vec3d top_at(const Scene& scene, double x, double z) {
  const Model model = build_model(scene);
  Vec3d top{x, -1e30, z};
  for (const Vec3d& v : model.surface.rest) {
    if (std::hypot(v[0] - x, v[2] - z) < 0.01) top[1] = std::max(top[1], v[1]);
  }
  return top;
}

Scene shipped(const HapticsOptions& options, const std::string& file) {
  Scene scene = load_scene(find_shipped_scenes(options.scenes, file) / file);
  for (Body& body : scene.bodies) body.prescribed.clear();
  return scene;
}

}  // namespace

std::vector<HandScene> hand_scenes(const HapticsOptions& options) {
  std::vector<HandScene> all{block()};
  if (options.quick) return all;
  Scene liver = shipped(options, "liver.json");
  const Vec3d lobe = top_at(liver, -0.02, 0);
  all.push_back(palpated("liver", std::move(liver), {0.012, 0.012, lobe, {0.02, 0, 0.008}}));
  try {  // its mesh is in a package that need not be there
    Scene bunny = shipped(options, "bunny.json");
    bunny.gravity = {};
    const Vec3d back = top_at(bunny, 0.02, 0);
    all.push_back(palpated("bunny", std::move(bunny), {0.01, 0.008, back, {0.015, 0, 0}}));
  } catch (const std::exception&) {
  }
  return all;
}

}  // namespace pliant::bench::haptics
