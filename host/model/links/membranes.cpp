#include "model/links/membranes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/vec.h"
#include "model/links/build_links.h"
#include "model/matching/flsm.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Height over the longest edge below which a triangle is left out: its strain would be rounding.
constexpr double kSliver = 0.01;

double sliver_ratio(const Membrane::Corners& x) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, vec::norm(vec::sub(x[(a + 1) % 3], x[a])));
  return longest > 0 ? vec::norm(vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0]))) / (longest * longest) : 0;
}

[[noreturn]] void fail_edge(const Scene& scene, const Body& body, const Vec3d& at) {
  throw Error(
      ErrorCode::bad_input,
      fmt::format("{}: {}/membrane: got a surface with more than two triangles at the edge near [{:.4g}, {:.4g}, {:.4g}] "
                  "m, expected a surface whose edges have one or two",
                  scene.file.string(), body.pointer, at[0], at[1], at[2]));
}

void check_edges(const Scene& scene, const Body& body, const ModelSurface& surface, std::int32_t first, std::int32_t end) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> triangles;
  for (std::int32_t t = first; t < end; ++t) {
    const auto& v = surface.triangles[static_cast<std::size_t>(t)];
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t from = v[a], to = v[(a + 1) % 3];
      if (++triangles[std::minmax(from, to)] > 2) fail_edge(scene, body, surface.rest[static_cast<std::size_t>(from)]);
    }
  }
}

/// One body's membrane, from the triangles of its surface.
class Skin {
 public:
  Skin(const Scene& scene, std::size_t body, Model& model) : model_(model) {
    out_.law = *scene.bodies[body].membrane;
    out_.body = static_cast<std::int32_t>(body);
    out_.label = model.bodies[body].name + ": membrane";
    const ModelBody& own = model.bodies[body];
    if (own.triangles == 0 && !own.remade) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: {}/membrane: got a body without a surface, expected one with triangles", scene.file.string(),
                              scene.bodies[body].pointer));
    }
    point_.assign(model.surface.rest.size(), -1);
    if (model.surface.triangle_cut.empty())
      check_edges(scene, scene.bodies[body], model.surface, own.first_triangle, own.first_triangle + own.triangles);
    for (std::int32_t t = own.first_triangle; t < own.first_triangle + own.triangles; ++t) add(static_cast<std::size_t>(t));
  }
  MembraneBatch take() { return std::move(out_); }

 private:
  void add(std::size_t t) {
    const ModelSurface& surface = model_.surface;
    if (!surface.triangle_cut.empty() && surface.triangle_cut[t] != 0) return;
    Membrane::Corners x{};
    for (std::size_t a = 0; a < 3; ++a) x[a] = surface.rest[static_cast<std::size_t>(surface.triangles[t][a])];
    if (sliver_ratio(x) < kSliver) return;
    out_.records.push_back(out_.law.record(x, out_.label));
    out_.points.push_back({point(surface.triangles[t][0]), point(surface.triangles[t][1]), point(surface.triangles[t][2])});
    const double mass = out_.law.density * out_.records.back().back();
    model_.bodies[static_cast<std::size_t>(out_.body)].mass += mass;
    for (const std::int32_t p : out_.points.back()) weigh(static_cast<std::size_t>(p), mass / 3);
  }

  void weigh(std::size_t p, double mass) {
    const LinkPoints& points = model_.links.points;
    for (std::size_t a = 0; a < 8; ++a)
      model_.mass[static_cast<std::size_t>(points.slots[p][a])] += points.weights[p][a] * mass;
  }

  std::int32_t point(std::int32_t vertex) {
    std::int32_t& number = point_[static_cast<std::size_t>(vertex)];
    if (number < 0) {
      LinkPoints& points = model_.links.points;
      const auto v = static_cast<std::size_t>(vertex);
      number = static_cast<std::int32_t>(points.size());
      points.rest.push_back(model_.surface.rest[v]);
      points.slots.push_back(model_.surface.nodes[v]);
      points.weights.push_back(model_.surface.weights[v]);
    }
    return number;
  }

  Model& model_;
  MembraneBatch out_;
  std::vector<std::int32_t> point_;  ///< [vertices of the surface] of LinkPoints, -1: not yet
};

}  // namespace

bool has_membranes(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.membrane.has_value(); });
}

void add_membranes(const Scene& scene, Model& model) {
  if (!has_membranes(scene)) return;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (!scene.bodies[b].membrane) continue;
    MembraneBatch batch = Skin(scene, b, model).take();
    if (batch.size() > 0) model.links.membranes.push_back(std::move(batch));
  }
  for (FlsmBatch& batch : model.flsm) weigh(batch, model.mass);
  note_link_bounds(model);
}

void add_membrane_stiffness(const Model& model, const std::vector<double>* u, std::vector<double>& sum) {
  const auto moved = [&](std::int32_t slot) {
    const double* at = u->data() + 4 * static_cast<std::size_t>(slot);
    return Vec3d{at[0], at[1], at[2]};
  };
  std::vector<std::pair<std::int32_t, std::array<double, 2>>> gradients;
  for (const MembraneBatch& b : model.links.membranes) {
    for (std::size_t t = 0; t < b.size(); ++t) {
      double modulus = b.law.young / (1 - b.law.poisson);
      if (u != nullptr) {
        Membrane::Corners corners{};
        for (std::size_t a = 0; a < 3; ++a) corners[a] = model.links.points.value(b.points[t][a], moved);
        modulus = b.law.tangent_bound(b.records[t], corners);
      }
      const double scale = b.records[t].back() * modulus;
      gradients.clear();  // each meets each: gathered once
      for_each_gradient(model.links.points, b, t, [&](std::int32_t i, const auto& g) { gradients.emplace_back(i, g); });
      for (const auto& [i, g] : gradients) {
        double& own = sum[static_cast<std::size_t>(i)];
        for (const auto& [j, h] : gradients) own += scale * std::abs(g[0] * h[0] + g[1] * h[1]);
      }
    }
  }
}

}  // namespace pliant
