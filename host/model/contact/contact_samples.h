// Sampling of contact points on surfaces: shared by lattices and volume meshes.
#pragma once
#include "model/contact/contact.h"

namespace pliant {

using PatchSides = std::array<PatchSide, 6>;

/// Index 0 to 5 of the axis and sign closest to a normal.
int side_of(const Vec3d& normal);

/// The point with these barycentric weights [m].
Vec3d between(const std::array<Vec3d, 3>& x, const Vec3d& weight);

/// Adds a point. `area` [m^2], `normal` of any length, `apart` [m].
void add_contact_point(ContactPoints& points, const Vec3d& x, const std::array<std::int32_t, 8>& nodes,
                       const std::array<double, 8>& weights, double area, std::int32_t body, const Vec3d& normal, double apart);

/// Samples a lattice body: every triangle is divided into samples, and the samples in one half of a cell (in x, y and z) that
/// face the same way become one point. `patches`: with sides.
void sample_lattice(const Model& model, std::int32_t body, bool patches, ContactPoints& points);

/// Samples the body of a volume mesh: three points per face, one for a small face. `patches`: with sides. Returns the mean
/// edge length of its surface [m].
double sample_faces(const Model& model, std::int32_t body, bool patches, ContactPoints& points);

/// Returns ContactPoints::joined.
std::vector<char> joined_points(const ContactPoints& points);

}  // namespace pliant
