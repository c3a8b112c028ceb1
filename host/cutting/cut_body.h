// Converts a body to a cuttable mesh, and the cut mesh back to a body with virtual nodes.
#pragma once
#include <memory>

#include "cutting/surface/cut_surface.h"
#include "cutting/topology/cut_topology.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// Returns the cuttable mesh of a body. Throws Error for a volume mesh of hexahedra, whose faces have no common diagonals.
/// `name`: the body's name for messages.
std::shared_ptr<const CutMesh> cut_mesh(const BodyMesh& solid, const std::string& name);

/// Returns the body with its cut elements, their fill and the virtual nodes, and with the split and capped surface if given.
/// Otherwise vertices are embedded in the copy that contains their rest position, and triangles do not change.
BodyMesh cut_body_mesh(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface = nullptr);

/// The same, updating `solid`, the result of an earlier state of the same cut or the uncut body: only changed elements are
/// written, and the whole surface.
void update_body_mesh(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface, BodyMesh& solid);

/// The two halves of it, which may run concurrently.
void update_body_elements(const BodyMesh& uncut, const CutTopology& cut, BodyElements& solid);
void update_body_surface(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface, BodySurface& solid);
/// The same for the changes of `surface` since the last update of `solid` (CutSurface::take_changes), which are also stored
/// in solid.changes.
void patch_body_surface(const BodyMesh& uncut, const CutTopology& cut, const CutSurface& surface, SurfaceChanges changes,
                        BodySurface& solid);

}  // namespace pliant
