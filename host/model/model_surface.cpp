// Puts the surfaces of the bodies into the model with slots as nodes, either all or the parts that an edit changed.
#include "model/elements/body_mesh.h"

namespace pliant {
namespace {

/// Sets the part of the model's surface that belongs to a body.
void place_surface(const BodySurface& solid, std::int32_t first_vertex, std::int32_t first_triangle, ModelBody& body) {
  body.triangle_middle = solid.triangle_middle;
  body.texture = solid.texture;
  body.triangle_source = solid.triangle_source;
  body.first_vertex = first_vertex;
  body.vertices = static_cast<std::int32_t>(solid.surface.size());
  body.first_triangle = first_triangle;
  body.triangles = static_cast<std::int32_t>(solid.triangles.size());
}

void embed_vertex(const BodySurface& solid, std::size_t v, const ModelBody& body, ModelSurface& surface) {
  auto& slots = surface.nodes[static_cast<std::size_t>(body.first_vertex) + v];
  for (std::size_t a = 0; a < 8; ++a) slots[a] = body.slot[solid.surface_nodes[v][a]];
}

/// Appends the vertices and triangles of a body.
void embed_body(const BodySurface& solid, std::int32_t b, Model& model) {
  ModelSurface& surface = model.surface;
  ModelBody& body = model.bodies[b];
  place_surface(solid, static_cast<std::int32_t>(surface.rest.size()), static_cast<std::int32_t>(surface.triangles.size()),
                body);
  surface.rest.insert(surface.rest.end(), solid.surface.begin(), solid.surface.end());
  surface.weights.insert(surface.weights.end(), solid.surface_weights.begin(), solid.surface_weights.end());
  surface.nodes.resize(surface.rest.size());
  for (std::size_t v = 0; v < solid.surface.size(); ++v) embed_vertex(solid, v, body, surface);
  surface.triangles.insert(surface.triangles.end(), solid.triangles.begin(), solid.triangles.end());
  for (std::size_t t = static_cast<std::size_t>(body.first_triangle); t < surface.triangles.size() && b > 0; ++t) {
    for (std::int32_t& v : surface.triangles[t]) v += body.first_vertex;
  }
  surface.triangle_body.resize(surface.triangles.size(), b);
  if (!solid.triangle_cut.empty() || !surface.triangle_cut.empty()) {
    surface.triangle_cut.resize(body.first_triangle, 0);
    surface.triangle_cut.insert(surface.triangle_cut.end(), solid.triangle_cut.begin(), solid.triangle_cut.end());
    surface.triangle_cut.resize(surface.triangles.size(), 0);
  }
}

void patch_surface(const BodySurface& solid, const SurfaceChanges& changes, Model& model) {
  ModelSurface& surface = model.surface;
  place_surface(solid, 0, 0, model.bodies[0]);
  surface.rest.resize(solid.surface.size());
  surface.weights.resize(solid.surface.size());
  surface.nodes.resize(solid.surface.size());
  for (const std::int32_t v : changes.vertices) {
    surface.rest[v] = solid.surface[v];
    surface.weights[v] = solid.surface_weights[v];
  }
  for (const std::int32_t v : changes.reembedded) embed_vertex(solid, static_cast<std::size_t>(v), model.bodies[0], surface);
  surface.triangles.resize(solid.triangles.size());
  surface.triangle_body.resize(solid.triangles.size(), 0);
  surface.triangle_cut.resize(solid.triangle_cut.size(), 0);
  for (const std::int32_t t : changes.triangles) {
    surface.triangles[t] = solid.triangles[t];
    surface.triangle_cut[t] = solid.triangle_cut[t];
  }
}

}  // namespace

void add_surfaces(std::span<const BodyMesh* const> solids, Model& model, const SurfaceChanges* changes) {
  if (changes != nullptr) return patch_surface(*solids[0], *changes, model);
  model.surface = {};
  for (std::size_t b = 0; b < solids.size(); ++b) embed_body(*solids[b], static_cast<std::int32_t>(b), model);
}

}  // namespace pliant
