// How surfaces become points of contact: what the samplers of lattices and of volume meshes share.
#pragma once
#include "model/contact/contact.h"

namespace pliant {

using PatchSides = std::array<PatchSide, 6>;

/// The place with these weights of the corners [m].
Vec3d between(const std::array<Vec3d, 3>& x, const Vec3d& weight);

/// `area` [m^2], `normal` of any length, `apart` [m].
void add_contact_point(ContactPoints& points, const Vec3d& x, const std::array<std::int32_t, 8>& nodes,
                       const std::array<double, 8>& weights, double area, std::int32_t body, const Vec3d& normal, double apart);

/// `patches`: with sides. The body of a volume mesh: three points per face, one for a face that is small. Returns the mean edge
/// of its surface [m].
double sample_faces(const Model& model, std::int32_t body, bool patches, ContactPoints& points);

}  // namespace pliant
