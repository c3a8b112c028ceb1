#include "cutting/surface/overlay.h"

#include <algorithm>

#include "cutting/surface/overlay_caps.h"
#include "cutting/surface/overlay_pieces.h"

namespace pliant::overlay {
namespace {

void make_unique(std::vector<std::int32_t>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

void Overlay::update(const std::vector<CutGridCell>& cells) {
  dirty_faces_.clear();
  dirty_triangles_.clear();
  moved_vertices.clear();
  std::vector<std::int64_t> changed;
  for (const CutGridCell& cell : cells) {
    const std::int64_t number = source_.grid().number(cell.index);
    CellState& state = cells_[number];
    if (state.cell == cell) continue;
    remove_faces(state);
    state.cell = cell;
    changed.push_back(number);
  }
  for (const std::int64_t number : changed) add_faces(cells_[number], number);
  for (const std::int64_t number : changed) {
    const CellState& state = cells_[number];
    for (const std::int32_t f : state.faces) crossings_.make_segments(f);
    for (const std::int32_t f : state.faces) make_cap(source_, faces_, crossings_, f, state.cell.index);
  }
  collect_dirty();
  for (const std::int64_t number : changed) locate_vertices(cells_[number]);
}

void Overlay::remove_faces(CellState& state) {
  for (const std::int32_t f : state.faces) {
    for (const Segment& s : faces_.face(f).segments) dirty_triangles_.push_back(s.triangle);
    crossings_.remove(f);
    faces_.remove(f);
    dirty_faces_.push_back(f);
  }
  state.faces.clear();
}

void Overlay::add_faces(CellState& state, std::int64_t number) {
  const CutGridCell& cell = state.cell;
  state.shape = interface_of(source_.grid(), cell);
  std::vector<std::int32_t> points;
  for (const InterfacePoint& p : state.shape.points) points.push_back(faces_.find_point(p));
  for (const InterfaceFace& shape : state.shape.faces) {
    const std::int32_t f = faces_.add({points[shape.point[0]], points[shape.point[1]], points[shape.point[2]]}, number,
                                      {cell.carrier[shape.back], cell.carrier[shape.front]}, cell.air);
    crossings_.cross_face_edges(f, cell.index);
    state.faces.push_back(f);
  }
  crossings_.cross_source_edges(state.faces, cell.index);
}

void Overlay::collect_dirty() {
  const std::vector<std::int32_t> points = faces_.take_marked();
  for (const std::int32_t p : points) {
    for (const std::int32_t f : faces_.point(p).faces) dirty_faces_.push_back(f);
  }
  make_unique(dirty_faces_);
  for (const std::int32_t f : dirty_faces_) {
    if (faces_.face(f).cell < 0) continue;
    sectors_.sort_edges_of(f);
    for (const Segment& s : faces_.face(f).segments) dirty_triangles_.push_back(s.triangle);
  }
  for (const std::int32_t p : points) sectors_.find_around(p);
  make_unique(dirty_triangles_);
  crossings_.sort_changed();
}

void Overlay::locate_vertices(const CellState& state) {
  std::vector<std::int32_t> near;
  for (const std::int32_t t : source_.triangles_at(state.cell.index)) {
    for (const std::int32_t v : source_.mesh().triangles[t]) near.push_back(v);
  }
  make_unique(near);
  const CutGrid& grid = source_.grid();
  if (state.faces.empty()) {  // not divided: how its vertices are embedded is not decided here
    for (const std::int32_t v : near) {
      const auto found = vertex_cell_.find(v);
      if (found != vertex_cell_.end() && found->second == grid.number(state.cell.index)) vertex_cell_.erase(found);
    }
    return;
  }
  const vec::Box box =
      box_of(kSnapMargin * grid.spacing, grid.position(state.cell.index), grid.position(corner_index(state.cell.index, 7)));
  for (const std::int32_t v : near) {
    const Vec3d& x = source_.mesh().vertices[v];
    if (box.distance2(x) > 0) continue;
    const int component = component_at(source_, state.cell, state.shape, source_.exact(v));
    if (component < 0) continue;
    vertex_cell_[v] = grid.number(state.cell.index);
    moved_vertices[v] = state.cell.carrier[component];
  }
}

Patch Overlay::pieces_of(std::int32_t triangle) {
  return overlay::pieces_of({source_, faces_, crossings_, sectors_, vertex_cell_}, triangle, moved_vertices);
}

Patch Overlay::caps_of(std::int32_t face) const { return overlay::caps_of(faces_, sectors_, face); }

}  // namespace pliant::overlay
