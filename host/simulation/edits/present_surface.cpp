#include "simulation/edits/present_surface.h"

#include <algorithm>

namespace pliant {
namespace {

/// Vertices are means of nodes, with weights that may be a little negative: boxes around nodes are widened by this share.
constexpr double kWider = 0.5;

vec::Box wider(const vec::Box& box) {
  vec::Box out = box;
  for (std::size_t c = 0; c < 3; ++c) {
    const double more = kWider * (box.upper[c] - box.lower[c]);
    out.lower[c] -= more;
    out.upper[c] += more;
  }
  return out;
}

}  // namespace

PresentSurface::PresentSurface(const Model& model, const std::vector<double>& u)
    : model_(model), u_(u), x_(model.surface.rest.size()), known_(x_.size()) {
  for (const ModelBody& body : model.bodies) {
    vec::Box all;
    for (std::size_t n = 0; n < body.slot.size(); ++n) all.extend(vec::add(body.rest[n], moved(body, n)));
    all_.push_back(wider(all));
  }
}

Vec3d PresentSurface::moved(const ModelBody& body, std::size_t node) const {
  const double* own = &u_[4 * static_cast<std::size_t>(body.slot[node])];
  return {own[0], own[1], own[2]};
}

vec::Box PresentSurface::at_rest(const vec::Box& near, std::size_t body) const {
  const ModelBody& own = model_.bodies[body];
  vec::Box by;
  for (std::size_t n = 0; n < own.slot.size(); ++n) by.extend(moved(own, n));
  by = wider(by);
  vec::Box from;
  from.lower = vec::sub(near.lower, by.upper);
  from.upper = vec::sub(near.upper, by.lower);
  return from;
}

const Vec3d& PresentSurface::at(std::int32_t vertex) {
  const auto v = static_cast<std::size_t>(vertex);
  if (known_[v] != 0) return x_[v];
  known_[v] = 1;
  const ModelSurface& s = model_.surface;
  x_[v] = s.rest[v];
  for (std::size_t a = 0; a < 8; ++a) {
    if (s.weights[v][a] == 0) continue;
    const double* moved = &u_[4 * static_cast<std::size_t>(s.nodes[v][a])];
    for (std::size_t c = 0; c < 3; ++c) x_[v][c] += s.weights[v][a] * moved[c];
  }
  return x_[v];
}

}  // namespace pliant
