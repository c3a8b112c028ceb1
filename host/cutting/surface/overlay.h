// The overlay of a closed surface with the cut surface of all completely cut cells: which triangle is crossed where, the pieces
// that triangles fall into, and the caps that close the cut. Only combinatorial decisions, all exact, connect
// them; coordinates are rounded once, at the end. Every edge of the result is therefore used twice, once in each direction.
//
// A vertex of the result is an original vertex, an original edge x a cut face, an original triangle x a cut edge, or a point of
// the cut surface inside the body; all but the first come once per *sector* (cut_sectors.h). At the front of a cut its sides
// meet; a side of a triangle with both ends there would be used by both sides of the cut, so it gets a middle, which comes once
// per sector again.
//
// Overlay updates these parts for changed cells, each of which has a file: CutFaces, the cut surface as a mesh;
// SurfaceCrossings, where it crosses the body's surface; Sectors; overlay_caps.h and overlay_pieces.h, the triangles of the
// result.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cutting/surface/cut_faces.h"
#include "cutting/surface/cut_sectors.h"
#include "cutting/surface/cut_vertex.h"
#include "cutting/surface/surface_crossings.h"
#include "cutting/surface/surface_source.h"

namespace pliant::overlay {

class Overlay {
 public:
  Overlay(TriangleMesh mesh, const CutGrid& grid)
      : source_(std::move(mesh), grid), faces_(source_.frame()), crossings_(source_, faces_), sectors_(faces_) {}
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;
  [[nodiscard]] const SurfaceSource& source() const { return source_; }

  /// Replaces the cut surface inside these cells (removes it for those with one component). Afterwards dirty_triangles and
  /// dirty_faces list the triangles and faces to recompute.
  void update(const std::vector<CutGridCell>& cells);

  [[nodiscard]] const std::vector<std::int32_t>& dirty_triangles() const { return dirty_triangles_; }
  /// Cut faces, including removed ones.
  [[nodiscard]] const std::vector<std::int32_t>& dirty_faces() const { return dirty_faces_; }
  /// Original vertices whose carrier changed; also filled by pieces_of for vertices next to the cut.
  std::unordered_map<std::int32_t, Carrier> moved_vertices;

  /// The pieces of an original triangle; empty if it is whole.
  [[nodiscard]] Patch pieces_of(std::int32_t triangle);
  /// Both caps of a cut face, the back's first; empty if it is gone or outside the body.
  [[nodiscard]] Patch caps_of(std::int32_t face) const;
  /// Whether an original vertex lies in a cell that is or was cut.
  [[nodiscard]] bool holds(std::int32_t vertex) const { return vertex_cell_.contains(vertex); }

 private:
  struct CellState {
    CutGridCell cell;
    CellInterface shape;
    std::vector<std::int32_t> faces;
  };

  void remove_faces(CellState& state);
  void add_faces(CellState& state, std::int64_t number);
  void collect_dirty();
  void locate_vertices(const CellState& state);

  SurfaceSource source_;
  CutFaces faces_;
  SurfaceCrossings crossings_;
  Sectors sectors_;
  std::unordered_map<std::int64_t, CellState> cells_;
  std::unordered_map<std::int32_t, std::int64_t> vertex_cell_;  ///< cut cell that holds an original vertex
  std::vector<std::int32_t> dirty_faces_, dirty_triangles_;
};

}  // namespace pliant::overlay
