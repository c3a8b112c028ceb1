#include "bench/contact/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "backends/choice/backends.h"
#include "geometry/stopwatch.h"
#include "pliant/error.h"
#include "simulation/measure/energy.h"

namespace pliant::bench::contact {
namespace {

constexpr double kPi = 3.14159265358979323846;

class CellSurface {
 public:
  CellSurface(double edge, const Vec3d& lower) : edge_(edge), lower_(lower) {}
  /// The side of a cell that faces along an axis, outward.
  void side(std::array<int, 3> cell, int axis, bool upper) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    if (upper) ++cell[axis];
    std::array<std::int32_t, 4> corner{};
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> at = cell;
      at[b] += i == 1 || i == 2;
      at[c] += i >= 2;
      corner[i] = vertex(at);
    }
    if (!upper) std::swap(corner[1], corner[3]);
    mesh.triangles.push_back({corner[0], corner[1], corner[2]});
    mesh.triangles.push_back({corner[0], corner[2], corner[3]});
  }
  TriangleMesh mesh;

 private:
  std::int32_t vertex(const std::array<int, 3>& at) {
    const auto [found, is_new] = number_.try_emplace(at, static_cast<std::int32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back({lower_[0] + at[0] * edge_, lower_[1] + at[1] * edge_, lower_[2] + at[2] * edge_});
    return found->second;
  }
  double edge_;
  Vec3d lower_;
  std::map<std::array<int, 3>, std::int32_t> number_;
};

/// Heights and reach of a tool as it is turned.
void measure(DrawnTool& drawn) {
  const ContactTool& tool = drawn.tool;
  std::vector<Vec3d> corners{tool.first, tool.second};
  if (tool.shape == ToolShape::sphere) corners = {{0, 0, 0}};
  if (tool.shape == ToolShape::box) {
    corners.clear();
    for (int a = 0; a < 8; ++a)
      corners.push_back(
          {(a & 1 ? 0.5 : -0.5) * tool.size[0], (a & 2 ? 0.5 : -0.5) * tool.size[1], (a & 4 ? 0.5 : -0.5) * tool.size[2]});
  }
  for (const Vec3d& corner : corners) {
    const Vec3d x = place({{}, drawn.turn}, corner);
    drawn.low = std::min(drawn.low, x[2] - tool.radius);
    drawn.aside = std::max(drawn.aside, std::hypot(x[0], x[1]) + tool.radius);
  }
}

}  // namespace

TriangleMesh cells_surface(const std::array<int, 3>& cells, double edge, const Vec3d& lower, int fine,
                           const std::function<bool(int, int, int)>& filled) {
  CellSurface surface(edge / fine, lower);
  const auto is_filled = [&](const std::array<int, 3>& at) {
    for (int a = 0; a < 3; ++a) {
      if (at[a] < 0 || at[a] >= fine * cells[a]) return false;
    }
    return !filled || filled(at[0] / fine, at[1] / fine, at[2] / fine);
  };
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] < fine * cells[2]; ++at[2]) {
    for (at[1] = 0; at[1] < fine * cells[1]; ++at[1]) {
      for (at[0] = 0; at[0] < fine * cells[0]; ++at[0]) {
        if (!is_filled(at)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (const bool upper : {false, true}) {
            std::array<int, 3> next = at;
            next[axis] += upper ? 1 : -1;
            if (!is_filled(next)) surface.side(at, axis, upper);
          }
        }
      }
    }
  }
  return std::move(surface.mesh);
}

TriangleMesh ball_surface(double radius, const Vec3d& centre, int cells) {
  TriangleMesh mesh = cells_surface({cells, cells, cells}, 2.0 / cells, {-1, -1, -1});
  for (Vec3d& x : mesh.vertices) {
    for (double& c : x) c = std::tan(kPi / 4 * c);  // squares of about the same size
    x = vec::add(centre, vec::mul(x, radius / vec::norm(x)));
  }
  return mesh;
}

Material tissue(double young, double poisson, double damping) {
  Material m = make_material(Law::neo_hookean, Moduli::from_young(young, poisson), 1000);
  m.damping = damping;
  return m;
}

Body body_of(const std::string& name, const TriangleMesh& surface, double spacing, ElementKind element,
             const Material& material) {
  Body body;
  body.name = name;
  body.surface = name;
  body.surface_in_memory = std::make_shared<const TriangleMesh>(surface);
  body.lattice.spacing = spacing;
  body.element = element;
  body.material = material;
  return body;
}

Selection face(int axis, double value) {
  Selection s;
  s.kind = Selection::Kind::box;
  s.a = {-10, -10, -10};
  s.b = {10, 10, 10};
  s.a[axis] = value - 1e-6;
  s.b[axis] = value + 1e-6;
  return s;
}

Selection beyond(int axis, double value, bool above) {
  Selection s;
  s.kind = Selection::Kind::plane;
  s.a[axis] = value + (above ? -1e-6 : 1e-6);
  s.b[axis] = above ? 1 : -1;
  return s;
}

std::unique_ptr<Simulation> simulate(const Scene& scene, const std::string& backend, double dt) {
  SimulationOptions options;
  options.dt = dt;
  return std::make_unique<Simulation>(scene, open_backend(backend), options);
}

void until(Simulation& s, double time, const std::function<void(double)>& after, std::int64_t batch) {
  while (s.time() < time) {
    const double before = s.time();
    s.advance(batch);
    if (s.divergence()) throw Error(ErrorCode::diverged, s.divergence()->message());
    if (after) after(s.time() - before);
  }
}

Energy energy_of(Simulation& s) {
  const Model& m = s.model();
  std::vector<std::vector<Vec3d>> u(m.bodies.size()), v(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    u[b] = s.displacements(b);
    v[b] = s.velocities(b);
  }
  const Energies e = energies(m, by_slot(m, u), by_slot(m, v), {s.scene().gravity_at(s.time()), s.time()});
  return {e.kinetic, e.strain + e.hourglass, e.external};
}

std::array<double, 4> turn_about(const Vec3d& axis, double angle) {
  const double s = std::sin(angle / 2);
  return {s * axis[0], s * axis[1], s * axis[2], std::cos(angle / 2)};
}

DrawnTool draw_blunt(Dice& dice, double cell) {
  DrawnTool d;
  d.tool.name = "tool";
  const Pose yaw{{}, turn_about({0, 0, 1}, dice.uniform(0, kPi))};
  const double size = dice.uniform(1, 3);
  switch (dice.below(3)) {
    case 0:
      d.tool.radius = size * cell;
      d.words = fmt::format("sphere of {:.2f} cells", size);
      break;
    case 1:
      d.tool.shape = ToolShape::capsule;
      d.tool.radius = size * cell;
      d.tool.first = {-20 * cell, 0, 0};
      d.tool.second = {20 * cell, 0, 0};
      d.turn = yaw.turn;
      d.words = fmt::format("rod of {:.2f} cells", size);
      break;
    default: {
      d.tool.shape = ToolShape::box;
      d.tool.size = {2 * size * cell, 2 * dice.uniform(1, 3) * cell, 2 * dice.uniform(1, 3) * cell};
      const double askew = dice.chance(0.5) ? 0 : dice.uniform(0.05, 0.5);
      d.turn = compose(yaw, {{}, turn_about({1, 0, 0}, askew)}).turn;
      d.words = fmt::format("box of {:.2f} x {:.2f} cells, {:.0f} degrees askew", d.tool.size[0] / cell, d.tool.size[1] / cell,
                            askew * 180 / kPi);
    }
  }
  measure(d);
  return d;
}

DrawnTool draw_thin(Dice& dice) {
  DrawnTool d;
  d.tool.name = "tool";
  d.turn = turn_about({0, 0, 1}, dice.uniform(0, kPi));
  if (dice.chance(0.6)) {
    const bool upright = dice.chance(0.5);
    d.tool.shape = ToolShape::capsule;
    d.tool.radius = 0.001;
    d.tool.first = upright ? Vec3d{0, 0, 0} : Vec3d{-0.06, 0, 0};
    d.tool.second = upright ? Vec3d{0, 0, 0.08} : Vec3d{0.06, 0, 0};
    d.words = upright ? "capsule of 1 mm, upright" : "capsule of 1 mm, lying";
  } else {
    d.tool.shape = ToolShape::box;
    d.tool.size = {0.06, 0.0005, 0.06};
    d.words = "edge of 0.5 mm";
  }
  measure(d);
  return d;
}

DrawnTool draw_edged(Dice& dice) {
  DrawnTool d;
  d.tool.name = "tool";
  d.tool.edges = true;
  d.turn = turn_about({0, 0, 1}, dice.uniform(0, kPi));
  const double radius = dice.uniform(0.0005, 0.0015), reach = dice.uniform(0.01, 0.03);
  const auto capsule = [&](const Vec3d& first, const Vec3d& second, const char* what) {
    d.tool.shape = ToolShape::capsule;
    d.tool.radius = radius;
    d.tool.first = first;
    d.tool.second = second;
    d.words = fmt::format("{} of {:.2f} mm", what, 1e3 * radius);
  };
  switch (dice.below(4)) {
    case 0:
      capsule({-reach, 0, 0}, {reach, 0, dice.chance(0.5) ? 0 : dice.uniform(-0.1, 0.1) * reach}, "rod");
      break;
    case 1: {
      const double lean = dice.uniform(0, 1);
      capsule({0, 0, 0}, {0.06 * std::sin(lean), 0, 0.06 * std::cos(lean)}, "needle");
      break;
    }
    case 2:
      d.tool.shape = ToolShape::box;
      d.tool.size = {2 * reach, 2 * radius, 0.06};
      d.words = fmt::format("plate of {:.2f} mm", 2e3 * radius);
      break;
    default:
      d.tool.radius = radius;
      d.words = fmt::format("ball of {:.2f} mm", 1e3 * radius);
  }
  measure(d);
  return d;
}

ContactTool moved(const DrawnTool& drawn, double start, const Vec3d& from, double end, const Vec3d& to) {
  ContactTool tool = drawn.tool;
  const auto row = [&](double time, const Vec3d& x) {
    return std::array<double, 8>{time, x[0], x[1], x[2], drawn.turn[0], drawn.turn[1], drawn.turn[2], drawn.turn[3]};
  };
  tool.path = {row(start, from), row(end, to)};
  return tool;
}

}  // namespace pliant::bench::contact
