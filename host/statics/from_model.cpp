// A body of a model as a static problem.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/elements/body_mesh.h"
#include "model/elements/each_element.h"
#include "pliant/error.h"
#include "statics/shape.h"

namespace pliant::statics {
namespace {

/// Value of a load curve after everything has happened.
double final_value(const Curve& curve) { return curve.value(HUGE_VAL); }

constexpr double kHalfTurn = 180;  ///< [degrees] rotation beyond which the end position no longer determines the path

class FromModel {
 public:
  FromModel(const Scene& scene, const Model& model, std::size_t body)
      : scene_(scene), model_(model), number_(static_cast<std::int32_t>(body)), body_(model.bodies[body]) {}

  Problem operator()(bool quadratic) {
    if (scene_.bodies[number_].model.type != ModelType::tled) {
      throw Error(ErrorCode::bad_input, fmt::format("body '{}': the model is {}, the static solver takes tled only", body_.name,
                                                    pliant::to_string(scene_.bodies[number_].model.type)));
    }
    if (!element_info(body_.element).statics && !quadratic) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("body '{}': the static solver has no {}; take tet4 or hex8full, or quadratic tetrahedra",
                              body_.name, pliant::to_string(body_.element)));
    }
    out_.mesh.element = body_.tets.empty() ? Element::hex8full : Element::tet4;
    quadratic_ = quadratic && out_.mesh.element == Element::tet4;
    out_.mesh.nodes = body_.rest;
    node_of_.assign(model_.slots, -1);
    for (std::size_t n = 0; n < body_.slot.size(); ++n) node_of_[body_.slot[n]] = static_cast<std::int32_t>(n);
    corners();
    materials();
    loads();
    surface();
    if (!quadratic_) return std::move(out_);
    Problem quadratic_problem = to_quadratic(out_);
    if (body_.spacing > 0) embed_again(quadratic_problem);
    return quadratic_problem;
  }

 private:
  void corners() {
    for (const auto& tet : body_.tets) out_.mesh.corners.insert(out_.mesh.corners.end(), tet.begin(), tet.end());
    for (const auto& hex : body_.hexes) {
      for (const int a : kVtkFromBits) out_.mesh.corners.push_back(hex[a]);
    }
  }

  void materials() {
    out_.mesh.material.assign(body_.elements(), 0);
    out_.mesh.fill.assign(body_.elements(), 0);
    const Material* last = nullptr;
    for_each_element(model_, [&](const ElementView& e) {
      if (e.body != number_) return;
      if (&e.material != last || e.modulus != 1) {
        last = e.modulus == 1 ? &e.material : nullptr;
        out_.materials.push_back(e.modulus == 1 ? e.material : e.material.scaled(e.modulus));
        out_.materials.back().low = 0;  // equilibrium of an inverted element is no answer
      }
      out_.mesh.material[e.id] = static_cast<std::int32_t>(out_.materials.size()) - 1;
      out_.mesh.fill[e.id] = e.share / e.modulus;
    });
    for (std::size_t e = 0; e < out_.mesh.fill.size(); ++e) {
      if (!(out_.mesh.fill[e] > 0))
        throw Error(ErrorCode::internal, fmt::format("body '{}': element {} is in no batch of the model", body_.name, e));
    }
  }

  void loads() {
    const Vec3d gravity = scene_.gravity_at(HUGE_VAL);
    for (const Constraint& c : model_.constraints) {
      const std::int32_t node = node_of_[c.slot];
      if (node < 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        if ((c.axes >> axis & 1) != 0) {
          out_.prescribed.push_back({node, axis, final_displacement(c, axis), set_of(node, axis)});
        }
      }
    }
    for (const NodeForce& f : model_.forces) {
      if (node_of_[f.slot] >= 0)
        out_.forces.push_back({node_of_[f.slot], vec::mul(f.force, final_value(model_.curves[f.curve]))});
    }
    if (quadratic_) {
      out_.gravity = gravity;
    } else if (vec::norm(gravity) > 0) {
      for (std::size_t n = 0; n < body_.slot.size(); ++n)
        out_.forces.push_back({static_cast<std::int32_t>(n), vec::mul(gravity, model_.mass[body_.slot[n]])});
    }
  }

  [[nodiscard]] double final_displacement(const Constraint& c, int axis) const {
    const Curve& curve = model_.curves[c.curve[axis]];
    const double displacement = c.target[axis] * final_value(curve);
    if ((c.turned >> axis & 1) == 0) return displacement;
    const double angle = std::fabs(curve.angle * curve.factor(HUGE_VAL));
    if (angle >= kHalfTurn) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("body '{}': a rotation ends at {:.6g} degrees; the static solver moves nodes straight to where they "
                      "end, so that only angles below {:g} degrees are allowed. \"relaxation\" follows any rotation",
                      body_.name, angle, kHalfTurn));
    }
    return displacement + c.sine[axis] * final_value(model_.curves[c.curve[axis] + 1]);
  }

  /// The entry that holds a component: the last of `fixed`, then of `prescribed`, that names it.
  [[nodiscard]] std::int32_t set_of(std::int32_t node, int axis) const {
    const Body& body = scene_.bodies[number_];
    const auto names = [&](const Selection& where) { return where.contains(body_.rest[node], node); };
    for (std::size_t i = body.prescribed.size(); i-- > 0;) {
      if (body.prescribed[i].moves(axis) && names(body.prescribed[i].where))
        return static_cast<std::int32_t>(body.fixed.size() + i);
    }
    for (std::size_t i = body.fixed.size(); i-- > 0;) {
      if (body.fixed[i].axes[axis] && names(body.fixed[i].where)) return static_cast<std::int32_t>(i);
    }
    throw Error(ErrorCode::internal, fmt::format("body '{}': node {} is held by no entry of the scene", body_.name, node));
  }

  void surface() {
    for (std::int32_t v = body_.first_vertex; v < body_.first_vertex + body_.vertices; ++v) {
      SurfacePoint point{model_.surface.rest[v], {}, {}};
      for (int a = 0; a < 8; ++a) {
        point.nodes[a] = node_of_[model_.surface.nodes[v][a]];
        point.weights[a] = model_.surface.weights[v][a];
      }
      out_.surface.push_back(point);
    }
    for (const TrianglePressure& p : model_.pressures) {
      if (model_.surface.triangle_body[p.triangle] != number_) continue;
      std::array<std::int32_t, 3> points = model_.surface.triangles[p.triangle];
      for (std::int32_t& v : points) v -= body_.first_vertex;
      const double pressure = p.pressure * final_value(model_.curves[p.curve]);
      if (body_.spacing > 0) {
        out_.pressures.push_back({points, pressure});
      } else {
        out_.face_pressures.push_back(face_of(points, pressure));
      }
    }
  }

  /// The triangle of a volume mesh as a face, or half a face, of its element.
  FacePressure face_of(const std::array<std::int32_t, 3>& points, double pressure) {
    const Mesh& mesh = out_.mesh;
    if (elements_at_.empty()) {
      elements_at_.resize(mesh.nodes.size());
      for (std::int64_t e = 0; e < mesh.elements(); ++e) {
        for (int a = 0; a < corners_of(mesh.element); ++a) elements_at_[mesh.nodes_of(e)[a]].push_back(e);
      }
    }
    for (const std::int64_t e : elements_at_[out_.surface[points[0]].nodes[0]]) {
      FacePressure face{e, {}, pressure};
      const std::int32_t *const first = mesh.nodes_of(e), *const last = first + corners_of(mesh.element);
      int found = 0;
      for (int v = 0; v < 3; ++v) {
        face.corners[v] = static_cast<int>(std::find(first, last, out_.surface[points[v]].nodes[0]) - first);
        found += first + face.corners[v] != last ? 1 : 0;
      }
      if (found == 3) return face;
    }
    throw Error(ErrorCode::internal, fmt::format("body '{}': a triangle of its surface is no face of an element", body_.name));
  }

  /// The surface in the nodes of quadratic elements, which move what lies between the corners of a cell otherwise than these
  /// do.
  static void embed_again(Problem& problem) {
    const Field field(problem.mesh);
    for (SurfacePoint& point : problem.surface) {
      const Place place = field.locate(point.rest);
      const ShapeValues n = shape_values(problem.mesh.element, eigen(place.local));
      for (int a = 0; a < n.size(); ++a) {
        point.nodes[a] = problem.mesh.nodes_of(place.element)[a];
        point.weights[a] = n[a];
      }
    }
  }

  const Scene& scene_;
  const Model& model_;
  std::int32_t number_;
  const ModelBody& body_;
  bool quadratic_ = false;
  std::vector<std::int32_t> node_of_;
  std::vector<std::vector<std::int64_t>> elements_at_;  ///< of each node; filled on first use
  Problem out_;
};

}  // namespace

Problem problem_of(const Scene& scene, const Model& model, std::size_t body, bool quadratic) {
  if (body >= model.bodies.size())
    throw Error(ErrorCode::bad_input, fmt::format("static problem: body {} of {}", body, model.bodies.size()));
  return FromModel(scene, model, body)(quadratic);
}

}  // namespace pliant::statics
