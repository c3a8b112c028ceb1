// Springs between nodes of two bodies that are near each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geometry/vec.h"
#include "model/links/build_links.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using Cell3 = std::array<std::int64_t, 3>;

Cell3 cell_at(const Vec3d& x, double edge) {
  return {std::llround(std::floor(x[0] / edge)), std::llround(std::floor(x[1] / edge)), std::llround(std::floor(x[2] / edge))};
}

/// Nodes that are no copies: those that cuts and tears add come later and rest where others do, so that joins keep their
/// springs.
std::vector<char> first_nodes(const ModelBody& body) {
  std::vector<char> first(body.rest.size(), 1);
  std::set<Vec3d> places;
  for (std::size_t n = 0; n < first.size(); ++n) first[n] = places.insert(body.rest[n]).second ? 1 : 0;
  return first;
}

std::size_t joined_body(const Scene& scene, const Join& join, std::size_t side) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].name == join.bodies[side]) return b;
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("{}/bodies/{}: got \"{}\", expected the name of a body", join.pointer, side, join.bodies[side]));
}

/// Pairs of nodes of `a` and `b` that are no further apart than the distance, ascending.
std::vector<std::array<std::int32_t, 2>> near_pairs(const ModelBody& a, const ModelBody& b, double distance) {
  const std::vector<char> first_a = first_nodes(a), first_b = first_nodes(b);
  std::map<Cell3, std::vector<std::int32_t>> cells;
  for (std::size_t n = 0; n < first_b.size(); ++n) {
    if (first_b[n] != 0) cells[cell_at(b.rest[n], distance)].push_back(static_cast<std::int32_t>(n));
  }
  std::vector<std::array<std::int32_t, 2>> out;
  for (std::size_t n = 0; n < first_a.size(); ++n) {
    if (first_a[n] == 0) continue;
    const Cell3 at = cell_at(a.rest[n], distance);
    for (int k = 0; k < 27; ++k) {
      const auto cell = cells.find({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
      if (cell == cells.end()) continue;
      for (const std::int32_t other : cell->second) {
        const Vec3d d = vec::sub(b.rest[other], a.rest[n]);
        if (vec::dot(d, d) <= distance * distance) out.push_back({static_cast<std::int32_t>(n), other});
      }
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

void check_length(const Scene& scene, const Join& join, double length, const std::array<std::int32_t, 2>& nodes) {
  if (length > 0 || (join.spring.law != SpringLaw::cubic && join.break_stretch == 0)) return;
  const bool cubic = join.spring.law == SpringLaw::cubic;
  throw Error(ErrorCode::bad_input,
              fmt::format("{}: {}{}: got a spring of length 0 between node {} of {} and node {} of {}, expected {}",
                          scene.file.string(), join.pointer, cubic ? "/spring/law" : "/break_stretch", nodes[0], join.bodies[0],
                          nodes[1], join.bodies[1],
                          cubic ? "another law than cubic, whose force is one over the length at rest"
                                : "break_force instead, because nothing is longer than a multiple of no length"));
}

void add_join(const Scene& scene, std::int32_t number, Model& model) {
  const Join& join = scene.joins[static_cast<std::size_t>(number)];
  const ModelBody& a = model.bodies[joined_body(scene, join, 0)];
  const ModelBody& b = model.bodies[joined_body(scene, join, 1)];
  const auto pairs = near_pairs(a, b, join.distance);
  if (pairs.empty()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: {}/distance: got {} m, within which {} has no node near one of {}", scene.file.string(),
                            join.pointer, join.distance, join.bodies[1], join.bodies[0]));
  }
  SpringBatch batch;
  batch.law = join.spring;
  batch.join = number;
  batch.label = fmt::format("{} and {}: joined", join.bodies[0], join.bodies[1]);
  std::map<std::int32_t, std::int32_t> points;  // by slot
  const auto point = [&](const ModelBody& body, std::int32_t node) {
    const auto [at, added] = points.try_emplace(body.slot[node], 0);
    if (added) at->second = model.links.points.add_node(body.slot[node], body.rest[node]);
    return at->second;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double length = vec::norm(vec::sub(b.rest[pairs[i][1]], a.rest[pairs[i][0]]));
    check_length(scene, join, length, pairs[i]);
    const std::int32_t from = point(a, pairs[i][0]), to = point(b, pairs[i][1]);
    batch.points.push_back({from, to});
    batch.length.push_back(length);
    batch.parameters.push_back(spring_parameters(join.spring, length, 1, join.spring.stiffness));
    batch.damper.push_back(join.spring.damping);
  }
  // After a cut a corner of a lattice may have no element left, which would hold its springs at a place in space.
  const auto gone = [&](std::size_t i) {
    return !(model.mass[static_cast<std::size_t>(a.slot[pairs[i][0]])] > 0) ||
           !(model.mass[static_cast<std::size_t>(b.slot[pairs[i][1]])] > 0);
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!gone(i)) continue;
    batch.broken.resize(batch.size(), 0);
    batch.broken[i] = 1;
  }
  if (!join.broken.empty()) batch.broken.resize(batch.size(), 0);
  for (const std::int32_t s : join.broken) {
    if (s >= 0 && static_cast<std::size_t>(s) < batch.size()) batch.broken[static_cast<std::size_t>(s)] = 1;
  }
  model.links.springs.push_back(std::move(batch));
}

}  // namespace

void add_joins(const Scene& scene, Model& model) {
  for (std::size_t j = 0; j < scene.joins.size(); ++j) add_join(scene, static_cast<std::int32_t>(j), model);
}

}  // namespace pliant
