// Shape functions and quadrature of the elements. Local coordinates: tets (l1, l2, l3) = weights of corners 1..3, hexes [0,
// 1]^3.
#pragma once
#include <Eigen/Dense>
#include <vector>

#include "statics/statics.h"

namespace pliant::statics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostCorners = 10;
/// Column a: the gradient of shape function a.
using Gradients = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostCorners>;
using ShapeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostCorners, 1>;

ShapeValues shape_values(Element element, const Vector3d& local);
Gradients shape_gradients(Element element, const Vector3d& local);  ///< in local coordinates

/// A point of a rule over the reference element; weights sum to its volume, 1/6 or 1.
struct LocalPoint {
  Vector3d at;
  double weight = 0;
};
const std::vector<LocalPoint>& quadrature(Element element);           ///< of the element's forces
const std::vector<LocalPoint>& accurate_quadrature(Element element);  ///< exact for degree 5

/// A point of a rule over the triangle r, s >= 0, r + s <= 1; weights sum to its area, 1/2.
struct FacePoint {
  double r = 0, s = 0, weight = 0;
};
/// Exact for n x_r cross x_s on a face or half a face of the element: degree 1 (tet4), 4 (tet10; hex8full wants 3).
const std::vector<FacePoint>& triangle_rule(Element element);

/// Column a: rest position of corner a.
Gradients corners_at(const Mesh& mesh, std::int64_t element);

/// The faces of an element by local corners, outward; for tet10 the three corners, then the middles of 01, 12, 20.
const std::vector<std::vector<int>>& faces_of(Element element);

inline Vector3d eigen(const Vec3d& v) { return {v[0], v[1], v[2]}; }
inline Vec3d plain(const Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace pliant::statics
