// Tools that are sequences of meshes: against the shapes and paths that they are sampled from.
#include <numbers>
#include <random>

#include "model/contact/tool_sequence.h"
#include "physics/harness.h"
#include "support/error_of.h"
#include "support/unit_ball.h"

namespace pliant::physics {
namespace {

class SequencePhysics : public OnBackend {};

constexpr double kRadius = 0.02;

/// An ellipsoid of `around` meridians, turned by `turn`, whose volume is exact.
TriangleMesh ellipsoid(int around, const Vec3d& radii, const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
  TriangleMesh mesh = test::unit_ball(around);
  for (Vec3d& v : mesh.vertices) v = plain(turn * eigen(v).cwiseProduct(eigen(radii)));
  return mesh;
}

void move(TriangleMesh& mesh, const Vector3d& by) {
  for (Vec3d& v : mesh.vertices) v = plain(eigen(v) + by);
}

/// A folder of frames. Names do not sort as text.
std::filesystem::path folder_of(const std::vector<TriangleMesh>& frames, const std::string& name) {
  static const test::TempFolder all;
  static int number = 0;
  const std::filesystem::path folder = all.path() / std::to_string(number++) / name;
  std::filesystem::create_directories(folder);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::ofstream out(folder / ("frame" + std::to_string(f) + ".obj"));
    out.precision(12);
    for (const Vec3d& v : frames[f].vertices) out << "v " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
    for (const auto& t : frames[f].triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  return folder;
}

ContactTool sequence_tool(const std::vector<TriangleMesh>& frames, const std::string& name, double rate) {
  ContactTool tool;
  tool.name = name;
  tool.pointer = "/tools/0";
  tool.shape = ToolShape::sequence;
  tool.mesh = folder_of(frames, name);
  tool.frames_per_second = rate;
  return tool;
}

Scene block_under(const ContactTool& tool) {
  Body body = box_body({{12, 12, 6}, 0.005}, Discretization::hex8_bricks, material_young(Law::neo_hookean, 1e4, 0.45));
  body.material.damping = 100;
  body.fixed = {{face(2, 0)}};
  Scene scene;
  scene.bodies = {std::move(body)};
  scene.tools = {tool};
  return scene;
}

struct Felt {
  Vector3d force, torque;
};

/// Means over the 30 ms before each time.
std::vector<Felt> felt_at(const Scene& scene, const char* backend, const std::vector<double>& times) {
  auto sim = simulate(scene, backend);
  std::vector<Felt> all;
  for (const double time : times) {
    while (sim->time() < time - 0.03) sim->advance(1);
    Felt sum{Vector3d::Zero(), Vector3d::Zero()};
    int steps = 0;
    for (; sim->time() < time; ++steps) {
      sim->advance(1);
      const ToolLoad& now = sim->report().tools[0].now;
      sum.force += eigen(now.force);
      sum.torque += eigen(now.torque);
    }
    all.push_back({sum.force / steps, sum.torque / steps});
  }
  return all;
}

/// A sphere that goes down into tissue and along it, turning as it likes, seen by a camera: every frame has other triangles.
TEST_P(SequencePhysics, ASphereFeelsWhatTheSphereFeels) {
  const auto place = [](double t) { return Vector3d(0.025 + 0.03 * t, 0.03, 0.03 + kRadius - 0.006 * std::min(1.0, t / 0.2)); };
  const std::vector<double> times{0.1, 0.16, 0.23};
  ContactTool ball;
  ball.name = "ball";
  ball.radius = kRadius;
  std::vector<TriangleMesh> frames;
  std::mt19937 random(3);
  for (int f = 0; f <= 7; ++f) {
    const Vector3d at = place(f / 30.0);
    ball.path.push_back({f / 30.0, at[0], at[1], at[2], 0, 0, 0, 1});
    std::normal_distribution<double> number;
    const Eigen::Quaterniond turned =
        Eigen::Quaterniond(number(random), number(random), number(random), number(random)).normalized();
    frames.push_back(ellipsoid(112 + 2 * (f % 5), {kRadius, kRadius, kRadius}, turned));
    move(frames.back(), at);
  }
  ContactTool seen = sequence_tool(frames, "ball", 30);
  ball.friction = seen.friction = 0.3;
  const std::vector<Felt> exact = felt_at(block_under(ball), GetParam(), times);
  const std::vector<Felt> got = felt_at(block_under(seen), GetParam(), times);
  const double largest = exact.back().force.norm();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string when = "at " + std::to_string(times[i]) + " s";
    check("force " + when, (got[i].force - exact[i].force).norm() / largest, 1e-3);
    // The origin of `ball` moves with it; that of `seen` stays.
    const Vector3d arm = place(times[i] - 0.015);
    check("torque " + when, (got[i].torque - exact[i].torque - arm.cross(exact[i].force)).norm() / (largest * arm.norm()),
          2e-3);
  }
}

/// A box whose lower face alone moves is, for what it meets, a box that moves: also to a law that feels its speed.
TEST_P(SequencePhysics, AGrowingBoxPushesLikeAMovingOne) {
  const double rate = 25, speed = 0.05, edge = 0.1;
  const auto box = [&](double bottom, double top) {
    TriangleMesh mesh = box_surface({{4, 4, 4}, edge / 4});
    for (Vec3d& v : mesh.vertices) v = {v[0] - 0.02, v[1] - 0.02, bottom + v[2] / edge * (top - bottom)};
    return mesh;
  };
  std::vector<TriangleMesh> frames;
  ContactTool moving;
  moving.name = "moving";
  moving.shape = ToolShape::mesh;
  const double start = 0.0302, top = start + edge;
  moving.mesh = folder_of({box(0, edge)}, "moving") / "frame0.obj";
  for (int f = 0; f <= 6; ++f) {
    const double bottom = start - speed * f / rate;
    frames.push_back(box(bottom, top));
    moving.path.push_back({f / rate, 0, 0, bottom, 0, 0, 0, 1});
  }
  ContactTool growing = sequence_tool(frames, "growing", rate);
  for (ContactTool* tool : {&moving, &growing}) {
    tool->stiffness = 5e6;
    tool->alpha = 10;
  }
  const std::vector<double> times{0.03, 0.06, 0.1};
  const std::vector<Felt> exact = felt_at(block_under(moving), GetParam(), times);
  const std::vector<Felt> got = felt_at(block_under(growing), GetParam(), times);
  for (std::size_t i = 0; i < times.size(); ++i)
    check_relative("force at " + std::to_string(times[i]) + " s", got[i].force[2], exact[i].force[2], 5e-5);
}

/// Nothing jumps where one frame hands over to the next.
TEST_P(SequencePhysics, ForcesAreSmoothBetweenFrames) {
  std::vector<TriangleMesh> frames;
  for (int f = 0; f <= 8; ++f) {
    const double s = f / 8.0;
    frames.push_back(ellipsoid(60 + 2 * (f % 3), {kRadius, kRadius * (1 + s), kRadius * (0.8 + 0.2 * s)}));
    move(frames.back(), {0.03, 0.03, 0.03 + 0.8 * kRadius + 1e-4});
  }
  const Scene scene = block_under(sequence_tool(frames, "swelling", 30));
  auto sim = simulate(scene, GetParam());
  std::vector<double> force;
  while (sim->time() < 0.26) {
    sim->advance(1);
    force.push_back(sim->report().tools[0].now.force[2]);
  }
  const double largest = *std::max_element(force.begin(), force.end());
  double jump = 0;
  for (std::size_t i = 1; i < force.size(); ++i) jump = std::max(jump, std::abs(force[i] - force[i - 1]));
  EXPECT_GT(largest, 0.2);
  check("largest change of the force in a step, of all of it", jump / largest, 0.02);
}

PLIANT_ON_BACKENDS(SequencePhysics);

TEST(ToolSequence, FollowsTheTurnOfAShape) {
  const Vec3d radii{0.03, 0.02, 0.012};
  std::vector<TriangleMesh> frames;
  const double step = 0.12;
  for (int f = 0; f <= 5; ++f) {
    frames.push_back(ellipsoid(112 + 2 * f, radii, Eigen::Quaterniond(Eigen::AngleAxisd(step * f, Vector3d(1, 2, 2) / 3))));
    move(frames.back(), {0.01 * f, 0, 0.1});
  }
  const ToolForm form = tool_form(sequence_tool(frames, "turning", 10));
  ASSERT_EQ(form.frames.size(), 6u);
  for (std::size_t f = 0; f < 6; ++f) {
    const Pose& pose = form.frames[f].pose;
    check("place of frame " + std::to_string(f),
          (eigen(pose.position) - Vector3d(0.01 * static_cast<double>(f), 0, 0.1)).norm(), 5e-5);
    const double angle = 2 * std::acos(std::min(1.0, std::abs(pose.turn[3])));
    check("turn of frame " + std::to_string(f), angle - step * static_cast<double>(f), 0.01);
  }
  const ToolMoment half = tool_moment(form, 0.25);
  EXPECT_EQ(half.frame, 2);
  EXPECT_NEAR(half.share, 0.5, 1e-12);
  EXPECT_NEAR(half.pose.position[0], 0.025, 5e-5);
  EXPECT_EQ(tool_moment(form, -1).share, 0);
  EXPECT_EQ(tool_moment(form, 7).frame, 5);
}

/// Signs are found near the surface alone; everywhere they are those of the winding number.
TEST(ToolSequence, SignsOfTheGridAreThoseOfTheMesh) {
  const TriangleMesh mesh = ellipsoid(24, {0.03, 0.004, 0.012});
  ContactTool tool = sequence_tool({mesh}, "flat", 30);
  const ToolForm form = tool_form(tool);
  const SurfaceDistance surface(form.frames[0].surface);
  std::size_t at = 0, inside = 0;
  for (int k = 0; k < form.grid.size[2]; ++k) {
    for (int j = 0; j < form.grid.size[1]; ++j) {
      for (int i = 0; i < form.grid.size[0]; ++i, ++at) {
        const Vec3d x{form.grid.origin[0] + i * form.grid.spacing, form.grid.origin[1] + j * form.grid.spacing,
                      form.grid.origin[2] + k * form.grid.spacing};
        inside += form.distance[at] < 0 ? 1 : 0;
        if (surface.closest(x).distance < 0.3 * form.grid.spacing) continue;  // the grid is right in the mean, not at its nodes
        ASSERT_EQ(form.distance[at] < 0, surface.inside(x)) << i << ' ' << j << ' ' << k;
      }
    }
  }
  EXPECT_EQ(at, form.distance.size());
  const double cell = form.grid.spacing * form.grid.spacing * form.grid.spacing;
  check_relative("volume inside", static_cast<double>(inside) * cell, signed_volume(mesh), 0.05);
}

TEST(ToolSequence, FramesAreInTheOrderOfTheirNumbers) {
  std::vector<TriangleMesh> frames;
  for (int f = 0; f < 12; ++f) {
    frames.push_back(ellipsoid(12, {0.01, 0.01, 0.01}));
    move(frames.back(), {0.001 * f, 0, 0});
  }
  const ToolForm form = tool_form(sequence_tool(frames, "twelve", 30));
  for (std::size_t f = 0; f < 12; ++f) EXPECT_NEAR(form.frames[f].pose.position[0], 0.001 * static_cast<double>(f), 1e-6);
}

TEST(ToolSequence, BadFoldersAreRefused) {
  ContactTool tool = sequence_tool({}, "empty", 30);
  const auto error = [&] { return test::error_of([&] { (void)tool_form(tool); }); };
  EXPECT_NE(error().find("/tools/0: tool 'empty': the folder"), std::string::npos);
  EXPECT_NE(error().find("empty has no surface, expected a folder with a closed surface per frame"), std::string::npos);
  tool.mesh = tool.mesh / "nothing";
  EXPECT_NE(error().find("nothing cannot be read"), std::string::npos);
  TriangleMesh open = ellipsoid(12, {0.01, 0.01, 0.01});
  open.triangles.pop_back();
  tool = sequence_tool({ellipsoid(12, {0.01, 0.01, 0.01}), open}, "open", 30);
  EXPECT_NE(error().find("frame1.obj has 3 open edges, expected a closed surface"), std::string::npos) << error();
}

}  // namespace
}  // namespace pliant::physics
