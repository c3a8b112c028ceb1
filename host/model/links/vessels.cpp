// Bars along vessels that lie in the elements of a body.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/vec.h"
#include "model/links/build_links.h"
#include "model/links/element_finder.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// The bars of one entry of `vessels`.
class Bars {
 public:
  Bars(const Body& body, const Vessel& vessel, const NodeNumbering& draft, ElementFinder& finder, Model& model)
      : body_(body), vessel_(vessel), draft_(draft), finder_(finder), model_(model) {
    out_.law.stiffness = vessel.young * vessel.area();  // k of a bar is this over its length
    out_.bars = true;
  }

  SpringBatch take() {
    for (const auto& [from, to] : vessel_.segments) {
      const Vec3d &a = vessel_.points[static_cast<std::size_t>(from)], &b = vessel_.points[static_cast<std::size_t>(to)];
      divide(a, find(a, from), b, find(b, to), 0);
    }
    return std::move(out_);
  }
  [[nodiscard]] double mass() const { return mass_; }

 private:
  Held find(const Vec3d& x, std::int32_t number) {
    Held held = finder_.find(x);
    if (held.element >= 0 || !uncut()) return held;
    throw Error(ErrorCode::bad_input, fmt::format("{}: got point {} at [{:.4g}, {:.4g}, {:.4g}] m, outside the elements of {}, "
                                                  "expected points inside",
                                                  vessel_.pointer, number, x[0], x[1], x[2], body_.name));
  }

  [[noreturn]] void fail_outside(const Vec3d& a, const Vec3d& b) const {
    const Vec3d x = vec::mul(vec::add(a, b), 0.5);
    throw Error(ErrorCode::bad_input, fmt::format("{}/segments: got one that leaves the elements of {} near [{:.4g}, {:.4g}, "
                                                  "{:.4g}] m, expected segments inside",
                                                  vessel_.pointer, body_.name, x[0], x[1], x[2]));
  }

  [[nodiscard]] bool uncut() const { return draft_.solid().virtual_nodes.first < 0 && draft_.solid().copy_of.empty(); }

  /// Halves a segment until the elements of both ends touch.
  void divide(const Vec3d& a, const Held& at_a, const Vec3d& b, const Held& at_b, int depth) {
    if (at_a.element >= 0 && at_b.element >= 0 && finder_.common_places(at_a.element, at_b.element) > 0) {
      weigh(vec::norm(vec::sub(b, a)), at_a, at_b);
      // A cut between them leaves both without a common node.
      if (finder_.common_nodes(at_a.element, at_b.element) > 0) add(a, at_a, b, at_b);
      return;
    }
    if (depth >= ElementFinder::kHalvings) {  // in a gap, or where a cut has removed the element
      if (uncut()) fail_outside(a, b);
      return;
    }
    const Vec3d middle = vec::mul(vec::add(a, b), 0.5);
    const Held at = finder_.find(middle);
    divide(a, at_a, middle, at, depth + 1);
    divide(middle, at, b, at_b, depth + 1);
  }

  void add(const Vec3d& a, const Held& at_a, const Vec3d& b, const Held& at_b) {
    const double length = vec::norm(vec::sub(b, a));
    if (!(length > 0)) return;
    out_.points.push_back({point(a, at_a), point(b, at_b)});
    out_.length.push_back(length);
    out_.parameters.push_back(spring_parameters(out_.law, length, 1, out_.law.stiffness / length));
    out_.damper.push_back(0);
  }

  void weigh(double length, const Held& at_a, const Held& at_b) {
    const double mass = vessel_.density * vessel_.area() * length;
    mass_ += mass;
    for (const Held& held : {at_a, at_b}) {
      for (std::size_t k = 0; k < 4; ++k) model_.mass[slot(held, k)] += held.weights[k] * mass / 2;
    }
  }

  [[nodiscard]] std::size_t slot(const Held& held, std::size_t k) const {
    return static_cast<std::size_t>(draft_.slot[static_cast<std::size_t>(held.nodes[k])]);
  }

  std::int32_t point(const Vec3d& x, const Held& held) {
    LinkPoints& points = model_.links.points;
    if (last_ >= 0 && points.rest.back() == x) return last_;  // the end of the bar before
    points.rest.push_back(x);
    std::array<std::int32_t, 8> slots{};
    std::array<double, 8> weights{};
    slots.fill(static_cast<std::int32_t>(slot(held, 0)));
    for (std::size_t k = 0; k < 4; ++k) {
      slots[k] = static_cast<std::int32_t>(slot(held, k));
      weights[k] = held.weights[k];
    }
    points.slots.push_back(slots);
    points.weights.push_back(weights);
    return last_ = static_cast<std::int32_t>(points.size()) - 1;
  }

  const Body& body_;
  const Vessel& vessel_;
  const NodeNumbering& draft_;
  ElementFinder& finder_;
  Model& model_;
  SpringBatch out_;
  double mass_ = 0;
  std::int32_t last_ = -1;
};

}  // namespace

void add_vessels(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model) {
  if (body.vessels.empty() || draft.solid().size() == 0) return;
  ElementFinder finder(draft.solid());
  for (std::size_t v = 0; v < body.vessels.size(); ++v) {
    Bars bars(body, body.vessels[v], draft, finder, model);
    SpringBatch batch = bars.take();
    batch.body = b;
    batch.radius = body.vessels[v].radius;
    batch.label = fmt::format("{}: vessel {}", body.name, v);
    model.bodies[static_cast<std::size_t>(b)].mass += bars.mass();
    if (batch.size() > 0) model.links.springs.push_back(std::move(batch));
  }
}

}  // namespace pliant
