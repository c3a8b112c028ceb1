// A body of plain elements as a mesh in which nothing is cut: what blades are followed in where elements are not cut with
// virtual nodes.
#pragma once
#include <memory>

#include "cutting/topology/cut_mesh.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// The cells have the numbers of the elements, and no faces.
std::shared_ptr<const CutMesh> uncut_mesh(const BodyElements& solid);
/// Mean edge of an undeformed element [m], of the first thousand.
double mean_edge(const CutMesh& mesh);

}  // namespace pliant
