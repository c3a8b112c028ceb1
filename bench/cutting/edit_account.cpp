#include "bench/cutting/edit_account.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bench/cutting/parts.h"
#include "geometry/orient.h"
#include "geometry/vec.h"
#include "model/pieces.h"
#include "simulation/measure/energy.h"

namespace pliant::bench {
namespace {

double determinant(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return vec::dot(vec::cross(a, b), c); }

/// J > 0 there; of a hexahedron, in VTK order, in its middle.
double volume_of(const std::vector<Vec3d>& x, const std::array<std::int32_t, 4>& tet) {
  const auto at = [&](std::size_t a) { return x[static_cast<std::size_t>(tet[a])]; };
  return determinant(vec::sub(at(1), at(0)), vec::sub(at(2), at(0)), vec::sub(at(3), at(0)));
}
double volume_of(const std::vector<Vec3d>& x, const std::array<std::int32_t, 8>& hex) {
  const auto between = [&](std::array<std::size_t, 4> low, std::array<std::size_t, 4> high) {
    Vec3d sum{};
    for (std::size_t i = 0; i < 4; ++i) {
      sum = vec::add(sum, vec::sub(x[static_cast<std::size_t>(hex[high[i]])], x[static_cast<std::size_t>(hex[low[i]])]));
    }
    return sum;
  };
  return determinant(between({0, 3, 4, 7}, {1, 2, 5, 6}), between({0, 1, 4, 5}, {3, 2, 7, 6}),
                     between({0, 1, 2, 3}, {4, 5, 6, 7}));
}

template <class Element>
void find_inverted(const ModelBody& body, const std::vector<Vec3d>& x, const std::vector<Element>& elements,
                   std::array<std::size_t, 4> corners, ElementPlaces& out) {
  for (const Element& e : elements) {
    if (volume_of(x, e) > 0) continue;
    std::array<double, 12> place{};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d& rest = body.rest[static_cast<std::size_t>(e[corners[i]])];
      for (std::size_t a = 0; a < 3; ++a) place[3 * i + a] = rest[a];
    }
    out.insert(place);
  }
}

Vec3d corner(const std::array<double, 12>& place, std::size_t i) { return {place[3 * i], place[3 * i + 1], place[3 * i + 2]}; }

bool is_finite(const Vec3d& v) { return std::isfinite(v[0] + v[1] + v[2]); }

}  // namespace

bool lies_in(const std::array<double, 12>& element, const ElementPlaces& others) {
  constexpr double kSlack = 1e-9;
  if (others.contains(element)) return true;
  Vec3d middle{};
  for (std::size_t i = 0; i < 4; ++i) middle = vec::add(middle, vec::mul(corner(element, i), 0.25));
  return std::any_of(others.begin(), others.end(), [&](const std::array<double, 12>& other) {
    const Vec3d o = corner(other, 0), a = vec::sub(corner(other, 1), o), b = vec::sub(corner(other, 2), o),
                c = vec::sub(corner(other, 3), o), p = vec::sub(middle, o);
    const double all = determinant(a, b, c);
    const std::array<double, 3> w{determinant(p, b, c) / all, determinant(a, p, c) / all, determinant(a, b, p) / all};
    return std::min({w[0], w[1], w[2], 1 - w[0] - w[1] - w[2]}) > -kSlack;
  });
}

EditFigures edit_figures(const Simulation& simulation) {
  const Model& model = simulation.model();
  const BodyFigures all = figures_of(model);
  EditFigures out;
  out.elements = all.elements;
  out.mass = all.mass;
  out.volume = all.volume;
  out.bound = all.dt;
  out.open_edges = singular_edges(model.surface.triangles);
  std::vector<std::vector<Vec3d>> us, vs;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    us.push_back(simulation.displacements(b));
    vs.push_back(simulation.velocities(b));
    std::vector<Vec3d> x(body.rest.size());
    for (std::size_t n = 0; n < x.size(); ++n) {
      x[n] = vec::add(body.rest[n], us[b][n]);
      out.finite = out.finite && is_finite(x[n]) && is_finite(vs[b][n]);
      const Vec3d p = vec::mul(vs[b][n], model.own_mass(static_cast<std::size_t>(body.slot[n])));
      out.momentum = vec::add(out.momentum, p);
      out.motion += vec::norm(p);
    }
    find_inverted(body, x, body.tets, {0, 1, 2, 3}, out.inverted);
    find_inverted(body, x, body.hexes, {0, 1, 3, 4}, out.inverted);
  }
  out.energy = std::numeric_limits<double>::quiet_NaN();
  if (!out.finite || !out.inverted.empty()) return out;
  const Energies e = energies(model, by_slot(model, us), by_slot(model, vs));
  out.kinetic = e.kinetic;
  out.energy = e.kinetic + e.strain + e.hourglass;
  return out;
}

PieceFigures piece_figures(const Model& model, double density, double cell) {
  const ModelBody& body = model.bodies[0];
  const std::vector<std::int32_t> at = pieces_of_slots(body, model.slots);
  struct Sums {
    double mass = 0, volume = 0;
  };
  std::map<std::int32_t, Sums> pieces;
  for (const std::int32_t slot : body.slot) {
    const auto n = static_cast<std::size_t>(slot);
    if (at[n] >= 0) pieces[at[n]].mass += model.own_mass(n);
  }
  PieceFigures out;
  const auto piece_of = [&](std::int32_t vertex) {
    return at[static_cast<std::size_t>(model.surface.nodes[static_cast<std::size_t>(vertex)][0])];
  };
  for (const auto& [a, b, c] : model.surface.triangles) {
    const std::int32_t piece = piece_of(a);
    if (piece_of(b) != piece || piece_of(c) != piece) ++out.strays;
    const auto& x = model.surface.rest;
    pieces[piece].volume +=
        determinant(x[static_cast<std::size_t>(a)], x[static_cast<std::size_t>(b)], x[static_cast<std::size_t>(c)]) / 6;
  }
  out.pieces = static_cast<std::int64_t>(pieces.size());
  for (const auto& [piece, sum] : pieces) {
    const double wrong = std::abs(sum.mass - density * sum.volume);
    out.cells = std::max(out.cells, wrong / (density * cell));
    if (sum.volume >= cell) out.share = std::max(out.share, wrong / (density * sum.volume));
  }
  return out;
}

}  // namespace pliant::bench
