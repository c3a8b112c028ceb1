// The surface of a model in its present position, of which only what is near is looked at.
#pragma once
#include <vector>

#include "geometry/vec.h"
#include "model/model.h"

namespace pliant {

class PresentSurface {
 public:
  /// u: displacements, [slots][4] [m]. Both must outlive the object.
  PresentSurface(const Model& model, const std::vector<double>& u);
  /// Calls visit(triangle, its present corners, their box [m]) for the triangles whose boxes overlap `near`, in ascending
  /// order.
  template <class Visit>
  void within(const vec::Box& near, Visit&& visit) {
    const std::vector<ModelBody>& bodies = model_.bodies;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!near.overlaps(all_[b])) continue;
      const vec::Box from = at_rest(near, b);
      const auto first = static_cast<std::size_t>(bodies[b].first_triangle),
                 end = first + static_cast<std::size_t>(bodies[b].triangles);
      for (std::size_t t = first; t < end; ++t) {
        const std::array<std::int32_t, 3>& corner = model_.surface.triangles[t];
        if (!at_rest(corner).overlaps(from)) continue;
        const std::array<Vec3d, 3> now{at(corner[0]), at(corner[1]), at(corner[2])};
        vec::Box own;
        for (const Vec3d& p : now) own.extend(p);
        if (own.overlaps(near)) visit(t, now, own);
      }
    }
  }

 private:
  /// Where what may be in `near` now was at rest.
  [[nodiscard]] vec::Box at_rest(const vec::Box& near, std::size_t body) const;
  [[nodiscard]] vec::Box at_rest(const std::array<std::int32_t, 3>& corner) const {
    vec::Box box;
    for (const std::int32_t v : corner) box.extend(model_.surface.rest[static_cast<std::size_t>(v)]);
    return box;
  }
  [[nodiscard]] Vec3d moved(const ModelBody& body, std::size_t node) const;
  [[nodiscard]] const Vec3d& at(std::int32_t vertex);

  const Model& model_;
  const std::vector<double>& u_;
  std::vector<vec::Box> all_;  ///< of each body: around its surface [m]
  std::vector<Vec3d> x_;       ///< present positions of the vertices, where `known_` [m]
  std::vector<char> known_;
};

}  // namespace pliant
