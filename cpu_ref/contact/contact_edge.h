// Twin of contact_edge.cl and corner_lanes.cl, which describe the computation (kernels/contact).
#pragma once
#include "cpu_ref/contact/contact_patch.h"

namespace pliant::ref::contact {

template <class Scalar>
struct EdgeNumbers {
  static constexpr auto ease = Scalar(0.5), loose = Scalar(1.5), inside = Scalar(1), narrow = Scalar(0.5), close = Scalar(0.1),
                        alike = Scalar(0.7), stretch = Scalar(3), far = Scalar(1e30);
};

/// Returns whether a point lies over the face of a box that faces it most directly.
template <class Scalar>
inline bool on_box_face(const Scalar* data, const Vec<Scalar>& normal, const Vec<Scalar>& y, Scalar spacing,
                        Surface<Scalar>& face) {
  const Scalar nx = std::abs(normal[0]), ny = std::abs(normal[1]), nz = std::abs(normal[2]);
  const std::size_t axis = nx >= ny && nx >= nz ? 0 : ny >= nz ? 1 : 2;
  const Scalar side = normal[axis] > Scalar(0) ? Scalar(-1) : Scalar(1);
  face.normal = {};
  face.normal[axis] = side;
  face.distance = side * y[axis] - data[4 + axis];
  const auto over = [&](std::size_t c) {
    return std::abs(y[c]) < data[4 + c] && data[4 + c] > EdgeNumbers<Scalar>::narrow * spacing;
  };
  return over((axis + 1) % 3) && over((axis + 2) % 3);
}

template <class Scalar>
struct EdgeGap {
  Vec<Scalar> at{};  ///< position of the edge point
  Scalar radius = 0, gap = EdgeNumbers<Scalar>::far, a = 0, b = 0;
  [[nodiscard]] bool found() const { return gap < EdgeNumbers<Scalar>::far; }
};

/// The edge point with the least gap to the tangent plane of a patch at (at_a, at_b).
template <class Scalar>
inline EdgeGap<Scalar> nearest_edge(const Scalar* edge, std::int32_t count, const PatchPlane<Scalar>& p, const Scalar* region,
                                    Scalar spacing, Scalar wide, Scalar at_a, Scalar at_b) {
  EdgeGap<Scalar> found;
  for (std::int32_t e = 0; e < count; ++e, edge += 4) {
    const Vec<Scalar> at{edge[0], edge[1], edge[2]}, start = difference(at, p.y);
    const Scalar gap = dot(p.normal, start) - edge[3];
    if (!(gap < found.gap) || !(gap > -EdgeNumbers<Scalar>::inside * spacing)) continue;
    const Scalar a = at_a + dot(p.dual[0], start), b = at_b + dot(p.dual[1], start);
    if (beyond_region(region, a, b) < wide) found = {at, edge[3], gap, a, b};
  }
  return found;
}

template <class Scalar, int EDGES>
struct PatchMeeting {
  Meeting<Scalar> m;
  Vec<Scalar> place{};                              ///< place where the force acts, after the trial step
  std::array<Scalar, EDGES != 0 ? 8 : 0> weight{};  ///< weights of the nodes there
  Scalar share = 1, ease = 1;
  bool edged = false;
};

/// The tools of a step; with EDGES, some of them have edges.
template <class Scalar, int EDGES>
struct EdgedTools : Tools<Scalar> {
  const Scalar* edge;
  Patches<Scalar> patches;

  [[nodiscard]] bool has_edges(std::int32_t t) const { return EDGES != 0 && this->kind[tool_integers * t + 7] > 0; }

  [[nodiscard]] PatchMeeting<Scalar, EDGES> meet_patch(std::int32_t t, std::int64_t i, const Place<Scalar>& x) const {
    PatchMeeting<Scalar, EDGES> out{this->meet(t, x), x.now};
    if (!has_edges(t)) return out;
    if constexpr (EDGES != 0) meet_parts(t, i, out);
    return out;
  }

 private:
  /// Contact with an edge, or with a face of a box or a mesh that lies on the patch.
  void meet_parts(std::int32_t t, std::int64_t i, PatchMeeting<Scalar, EDGES>& out) const {
    using Numbers = EdgeNumbers<Scalar>;
    const std::int32_t* own = this->kind + tool_integers * t;
    const Scalar *now = this->now(t), *next = this->next(t), spacing = patches.spacing(i);
    const PatchPlane<Scalar> plane = plane_of(patches.at(i, Scalar(0), Scalar(0)), now);
    const Vec<Scalar> outward = difference(Vec<Scalar>{}, plane.normal);
    const bool mesh = own[0] == 4;
    if (mesh && out.m.distance - out.m.opening < Scalar(0) && dot(out.m.normal, turned(next, outward)) > Numbers::alike) return;
    Surface<Scalar> face;
    const bool on_face = own[0] == 2 && on_box_face(this->law(t), plane.normal, plane.y, spacing, face) &&
                         face.distance > -Numbers::inside * spacing && dot(face.normal, outward) > Numbers::alike;
    if (!(on_face && face.distance < Numbers::close * spacing)) {
      if (meet_edge(t, i, plane, out) || mesh) return;
    }
    if (on_face) {
      out.m.opening = dot(face.normal, difference(out.m.inside, plane.y));
      out.m.distance = face.distance + out.m.opening;
      out.m.normal = turned(next, face.normal);
      return;
    }
    out.m.distance = Numbers::far;
    out.m.opening = 0;
  }

  /// `base`: the tangent plane at the point. Returns false if no edge lies over the patch.
  bool meet_edge(std::int32_t t, std::int64_t i, const PatchPlane<Scalar>& base, PatchMeeting<Scalar, EDGES>& out) const {
    using Numbers = EdgeNumbers<Scalar>;
    const std::int32_t* own = this->kind + tool_integers * t;
    const Scalar *now = this->now(t), *next = this->next(t), *region = patches.region(i), spacing = patches.spacing(i);
    const auto nearest = [&](const PatchPlane<Scalar>& p, Scalar wide, Scalar a, Scalar b) {
      return nearest_edge(edge + std::int64_t{4} * own[6], p.flat ? own[7] : 0, p, region, spacing, wide, a, b);
    };
    EdgeGap<Scalar> found = nearest(base, Numbers::loose, Scalar(0), Scalar(0));
    if (!found.found()) return false;
    found = nearest(plane_of(patches.at(i, found.a, found.b), now), Scalar(1), found.a, found.b);
    if (!found.found()) return false;
    const PatchPlace<Scalar> at = patches.at(i, found.a, found.b);
    const PatchPlane<Scalar> plane = plane_of(at, now);
    out.place = at.now;
    out.weight = at.weight;
    const Vec<Scalar> toward = difference(Vec<Scalar>{}, plane.normal);
    const Scalar depth = dot(toward, difference(found.at, plane.y)) + found.radius;
    out.m.opening = dot(toward, difference(turned_back(next, difference(out.place, origin_of(next))), plane.y));
    out.m.distance = out.m.opening - depth;
    out.m.normal = turned(next, toward);
    const Scalar beyond = beyond_region(region, found.a, found.b);
    out.share = beyond > Scalar(0) ? Scalar(1) - beyond : Scalar(1);
    out.ease = Numbers::ease;
    out.edged = true;
    return true;
  }
};

/// Forces of edges on the nodes of points, and the weights for the compliance W.
template <class Scalar, int EDGES>
struct Corners {
  std::int32_t* force;
  Scalar* weight;

  void write_weights(const Scalar* contact_weight, std::int64_t i, const PatchMeeting<Scalar, EDGES>& met) const {
    Scalar* out = weight + tile_base(i, 9);
    for (std::int64_t k = 0; k < 8; ++k) {
      const Scalar at_point = contact_weight[tile_base(i, 8) + k * PLIANT_TILE];
      out[k * PLIANT_TILE] = met.edged ? met.weight[static_cast<std::size_t>(k)] : at_point;
    }
    out[std::int64_t{8} * PLIANT_TILE] = met.share;
  }
  void clear(std::int64_t i) const {
    if (EDGES == 0) return;
    for (std::int64_t k = 0; k < 24; ++k) force[tile_base(i, 24) + k * PLIANT_TILE] = 0;
  }
  /// Adds a force to `sum` if it acts at the point itself, otherwise to the nodes at the edge.
  void add(std::int64_t i, const PatchMeeting<Scalar, EDGES>& met, const Quanta& f, Quanta& sum) const {
    if (!met.edged) {
      sum = sum_of(sum, f);
    } else if constexpr (EDGES != 0) {
      share_out(i, met, f);
    }
  }

 private:
  /// Distributes a force over the nodes; the rounding remainder goes to the node with the largest weight.
  void share_out(std::int64_t i, const PatchMeeting<Scalar, EDGES>& met, const Quanta& f) const {
    std::int32_t* out = force + tile_base(i, 24);
    Quanta left = f;
    std::size_t largest = 0;
    const auto give = [&](std::size_t k, const Quanta& part) {
      for (std::size_t c = 0; c < 3; ++c) out[static_cast<std::int64_t>(3 * k + c) * PLIANT_TILE] += part[c];
      left = difference(left, part);
    };
    for (std::size_t k = 0; k < 8; ++k) {
      const Scalar w = met.weight[k];
      give(k, {quanta(w * static_cast<Scalar>(f[0])), quanta(w * static_cast<Scalar>(f[1])),
               quanta(w * static_cast<Scalar>(f[2]))});
      largest = w > met.weight[largest] ? k : largest;
    }
    give(largest, Quanta(left));
  }
};

}  // namespace pliant::ref::contact
