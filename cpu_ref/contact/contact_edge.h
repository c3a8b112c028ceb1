// Twin of contact_edge.cl and edge_touch.cl, which describe the computation (kernels/contact).
#pragma once
#include "cpu_ref/contact/contact_face.h"

namespace pliant::ref::contact {

template <class Scalar>
struct EdgeNumbers {
  static constexpr auto ease = Scalar(0.5), loose = Scalar(1.5), inside = Scalar(1), narrow = Scalar(0.5), close = Scalar(0.1),
                        alike = Scalar(0.7), stretch = Scalar(3), soon = Scalar(0.25), drag = Scalar(0.1), far = Scalar(1e30);
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

/// An edge point and a patch; `distance` is far if the point is not over the patch.
template <class Scalar>
struct EdgeTouch {
  Scalar distance = EdgeNumbers<Scalar>::far, opening = 0, share = 0;
  Vec<Scalar> normal{};
  PatchPlace<Scalar> at{};
};

template <class Scalar, int EDGES>
struct PatchMeeting {
  Meeting<Scalar> m;
  Vec<Scalar> place{};                              ///< place where the force acts, after the trial step
  std::array<Scalar, EDGES != 0 ? 8 : 0> weight{};  ///< weights of the nodes there
  std::array<Scalar, EDGES != 0 ? 8 : 0> spread{};  ///< for W: of all edge points that touch or soon may
  Scalar share = 1, ease = 1, spread_share = 1;
  bool edged = false;
};

/// The tools of a step; with EDGES, some of them have edges.
template <class Scalar, int EDGES>
struct EdgedTools : Tools<Scalar> {
  const Scalar* edge;
  Patches<Scalar> patches;

  [[nodiscard]] bool has_edges(std::int32_t t) const { return EDGES != 0 && this->kind[tool_integers * t + 7] > 0; }
  [[nodiscard]] bool is_face(std::int32_t t) const { return EDGES != 0 && this->kind[tool_integers * t] == face_of_blade; }

  [[nodiscard]] PatchMeeting<Scalar, EDGES> meet_patch(std::int32_t t, std::int64_t i, const Place<Scalar>& x) const {
    PatchMeeting<Scalar, EDGES> out{this->meet(t, x), x.now};
    if constexpr (EDGES != 0) {
      if (is_face(t) && (out.m.distance > face_near<Scalar> * patches.spacing(i) || patches.joined(i))) {
        out.m.distance = EdgeNumbers<Scalar>::far;
        out.m.opening = 0;
      } else if (is_face(t)) {
        meet_face(this->law(t), this->next(t), plane_of(patches.at(i, Scalar(0), Scalar(0)), this->now(t)), out.m);
      }
    }
    if (!has_edges(t)) return out;
    if constexpr (EDGES != 0) meet_parts(t, i, out);
    return out;
  }

  /// By how much the depth that an edit has left a point in tool t gets less in a step.
  [[nodiscard]] Scalar given_back(std::int32_t t, const Scalar* params) const {
    return is_face(t) ? ((Scalar(2) * params[8]) * params[5]) / params[6] : Scalar(0);
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

  /// `base`: the tangent plane at the point.
  [[nodiscard]] EdgeTouch<Scalar> touch(std::int32_t t, std::int64_t i, const PatchPlane<Scalar>& base,
                                        const Scalar* point) const {
    using Numbers = EdgeNumbers<Scalar>;
    const Scalar *now = this->now(t), *next = this->next(t), *region = patches.region(i);
    const Scalar deepest = Numbers::inside * patches.spacing(i);
    const Vec<Scalar> center{point[0], point[1], point[2]};
    EdgeTouch<Scalar> out;
    PatchPlane<Scalar> plane = base;
    Scalar a = 0, b = 0, beyond = 0;
    for (int round = 0; round < 2; ++round) {
      const Vec<Scalar> start = difference(center, plane.y);
      const Scalar gap = dot(plane.normal, start) - point[3];
      if (!plane.flat || !(gap > -deepest) || !(gap < deepest)) return out;
      a = a + dot(plane.dual[0], start);
      b = b + dot(plane.dual[1], start);
      beyond = beyond_region(region, a, b);
      if (!(beyond < (round == 0 ? Numbers::loose : Scalar(1)))) return out;
      out.at = patches.at(i, a, b);
      plane = plane_of(out.at, now);
    }
    const Vec<Scalar> toward = difference(Vec<Scalar>{}, plane.normal);
    const Scalar depth = dot(toward, difference(center, plane.y)) + point[3];
    out.opening = dot(toward, difference(turned_back(next, difference(out.at.now, origin_of(next))), plane.y));
    out.distance = out.opening - depth;
    out.normal = turned(next, toward);
    out.share = beyond > Scalar(0) ? Scalar(1) - beyond : Scalar(1);
    return out;
  }

  /// All edge points that push on a patch as one: at their mean place, weighted by their pushes. `base`: the tangent plane at
  /// the point. Returns false if no edge point lies over the patch.
  bool meet_edge(std::int32_t t, std::int64_t i, const PatchPlane<Scalar>& base, PatchMeeting<Scalar, EDGES>& out) const {
    using Numbers = EdgeNumbers<Scalar>;
    const std::int32_t* own = this->kind + tool_integers * t;
    const Scalar soon = Numbers::soon * patches.spacing(i);
    EdgeTouch<Scalar> nearest, sum;
    sum.opening = 0;
    std::array<Scalar, 8> spread{};
    Scalar pushes = 0, share = 0, spread_share = 0;
    for (std::int32_t k = 0; k < own[7]; ++k) {
      const EdgeTouch<Scalar> one = touch(t, i, base, edge + std::int64_t{4} * (own[6] + k));
      if (one.distance < nearest.distance) nearest = one;
      if (one.distance < soon) {
        spread_share = spread_share + one.share;
        for (std::size_t c = 0; c < 8; ++c) spread[c] = std::fma(one.share, one.at.weight[c], spread[c]);
      }
      if (!(one.distance < Scalar(0))) continue;
      const Scalar push = one.share * -one.distance;
      share = share + one.share;
      pushes = pushes + push;
      sum.opening = std::fma(push, one.opening, sum.opening);
      sum.normal = scaled_sum(push, one.normal, sum.normal);
      sum.at.now = scaled_sum(push, one.at.now, sum.at.now);
      for (std::size_t c = 0; c < 8; ++c) sum.at.weight[c] = std::fma(push, one.at.weight[c], sum.at.weight[c]);
    }
    if (!(nearest.distance < Numbers::far)) return false;
    if (pushes > Scalar(0)) {
      const Scalar inverse = Scalar(1) / pushes;
      sum.distance = -(pushes / share);
      sum.opening = sum.opening * inverse;
      sum.normal = normalised(sum.normal, std::sqrt(dot(sum.normal, sum.normal)));
      sum.at.now = times(sum.at.now, inverse);
      for (Scalar& w : sum.at.weight) w = w * inverse;
      sum.share = share;
    }
    take(pushes > Scalar(0) ? sum : nearest, out);
    out.spread_share = spread_share > Scalar(0) ? spread_share : nearest.share;
    for (std::size_t c = 0; c < 8; ++c)
      out.spread[c] = spread_share > Scalar(0) ? spread[c] / spread_share : nearest.at.weight[c];
    return true;
  }

  static void take(const EdgeTouch<Scalar>& from, PatchMeeting<Scalar, EDGES>& out) {
    out.m.distance = from.distance;
    out.m.opening = from.opening;
    out.m.normal = from.normal;
    out.place = from.at.now;
    out.weight = from.at.weight;
    out.share = from.share;
    out.ease = EdgeNumbers<Scalar>::ease;
    out.edged = true;
  }
};

}  // namespace pliant::ref::contact
