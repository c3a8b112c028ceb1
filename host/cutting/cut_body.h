// A body and its cut: from the filled body to what can be cut, and back to a filled body with virtual nodes.
#pragma once
#include <memory>

#include "cutting/surface/cut_surface.h"
#include "cutting/topology/cut_topology.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// What a blade can cut of a filled body. Throws Error for a volume mesh of hexahedra: their faces have no diagonals in common.
/// `name` is the body's, for messages.
std::shared_ptr<const CutMesh> cut_mesh(const BodyMesh& solid, const std::string& name);

/// The body with its cut elements, their fill and the virtual nodes, and with the split and capped surface if there is one.
/// Without, vertices are embedded in the copy that holds their place at rest, and triangles stay as they are.
BodyMesh cut_body_mesh(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface = nullptr);

/// The same where `solid` is what an earlier state of the same cut gave, or the uncut body: only elements that
/// changed are written, and the whole surface.
void update_body_mesh(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface, BodyMesh& solid);

/// Its two halves, which may run beside each other.
void update_body_elements(const BodyMesh& uncut, const CutTopology& cut, BodyElements& solid);
void update_body_surface(const BodyMesh& uncut, const CutTopology& cut, const CutSurface* surface, BodySurface& solid);
/// The same from what `surface` changed since `solid` had all of it (CutSurface::take_changes); solid.changes says what that
/// was.
void patch_body_surface(const BodyMesh& uncut, const CutTopology& cut, const CutSurface& surface, SurfaceChanges changes,
                        BodySurface& solid);

}  // namespace pliant
