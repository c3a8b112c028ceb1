// A body and its cut: from the filled body to what can be cut, and back to a filled body with virtual nodes.
#pragma once
#include <memory>

#include "cutting/surface/cut_surface.h"
#include "cutting/topology/cut_topology.h"
#include "model/solid.h"

namespace pliant {

/// What a blade can cut of a filled body. Throws Error for a volume mesh of hexahedra: their faces have no diagonals in common.
/// `name` is the body's, for messages.
std::shared_ptr<const CutMesh> cut_mesh(const Solid& solid, const std::string& name);

/// The body with its cut elements, their fill and the virtual nodes, and with the split and capped surface if there is one.
/// Without, vertices hang in the copy that holds their place at rest, and triangles stay as they are.
Solid cut_solid(const Solid& uncut, const CutTopology& cut, const CutSurface* surface = nullptr);

/// The same where `solid` is what an earlier state of the same cut gave, or the uncut body: only elements that
/// changed are written, and the whole surface.
void update_solid(const Solid& uncut, const CutTopology& cut, const CutSurface* surface, Solid& solid);

/// Its two halves, which may run beside each other.
void update_solid_elements(const Solid& uncut, const CutTopology& cut, SolidElements& solid);
void update_solid_surface(const Solid& uncut, const CutTopology& cut, const CutSurface* surface, SolidSurface& solid);
/// The same from what `surface` changed since `solid` had all of it (CutSurface::take_changes); solid.changes says what that
/// was.
void patch_solid_surface(const Solid& uncut, const CutTopology& cut, const CutSurface& surface, SurfaceChanges changes,
                         SolidSurface& solid);

}  // namespace pliant
