#include "cutting/surface/cut_surface.h"

#include <algorithm>
#include <utility>

#include "cutting/surface/exterior_cells.h"

namespace pliant {

using overlay::Carrier;
using overlay::CutGridCell;
using overlay::GridIndex;
using overlay::Patch;

namespace {

void set_centres(const CellShape& shape, const CellCut& cut, CutGridCell& cell) {
  for (std::size_t t = 0; t < shape.tets.size(); ++t) {
    std::uint32_t& centre = cell.centre[overlay::path_of(shape.tets[t])];
    for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
      const int a = shape.tets[t][kTetEdges[e][0]], b = shape.tets[t][kTetEdges[e][1]];
      if ((cut.centre[t] >> e & 1) != 0) centre |= 1U << overlay::kuhn_edge(a, b);
    }
  }
}

}  // namespace

struct CutSurface::Base {
  Base(const TriangleMesh& surface, const Lattice& full)
      : lattice(full),
        overlay(surface, {full.origin, full.spacing, full.size}),
        cell_at(overlay.source().grid().numbers(), -1),
        air(overlay.source(), cell_at) {
    originals = static_cast<std::int32_t>(overlay.source().mesh().triangles.size());
    for (std::size_t c = 0; c < full.cells.size(); ++c) {
      const std::int64_t number = overlay.source().grid().number(full.cells[c].index);
      if (cell_at[number] >= 0) {
        shared.try_emplace(number);
      } else {
        cell_at[number] = static_cast<std::int32_t>(c);
      }
    }
    embedded_offset.assign(full.cells.size() + 1, 0);
    for (const Embedding& e : full.embedding) ++embedded_offset[e.cell + 1];
    for (std::size_t c = 0; c < full.cells.size(); ++c) embedded_offset[c + 1] += embedded_offset[c];
    embedded.resize(full.embedding.size());
    std::vector<std::int32_t> next(embedded_offset.begin(), embedded_offset.end() - 1);
    for (std::size_t v = 0; v < full.embedding.size(); ++v) {
      embedded[next[full.embedding[v].cell]++] = static_cast<std::int32_t>(v);
    }
  }
  Lattice lattice;
  overlay::Overlay overlay;
  std::int32_t originals = 0;         ///< triangles, fillers counted
  std::vector<std::int32_t> cell_at;  ///< by grid number
  overlay::ExteriorCells air;
  /// Grid cells that several cells of the lattice share, because parts of the body pass near each other: all of them as cut
  /// now. The surface is divided by the first that is cut.
  std::unordered_map<std::int64_t, std::vector<CutGridCell>> shared;

  std::vector<CutGridCell> one_per_place(const std::vector<CutGridCell>& cells) {
    std::vector<CutGridCell> out;
    for (const CutGridCell& cell : cells) {
      const auto place = shared.find(overlay.source().grid().number(cell.index));
      if (place == shared.end()) {
        out.push_back(cell);
        continue;
      }
      auto& all = place->second;
      std::erase_if(all, [&](const CutGridCell& other) { return other.carrier[0].cell == cell.carrier[0].cell; });
      all.push_back(cell);
      std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.carrier[0].cell < b.carrier[0].cell; });
      const auto divided = std::find_if(all.begin(), all.end(), [](const CutGridCell& c) {
        return std::any_of(c.label.begin(), c.label.end(), [](int label) { return label != 0; });
      });
      std::erase_if(out, [&](const CutGridCell& other) { return other.index == cell.index; });
      out.push_back(divided == all.end() ? all.front() : *divided);
    }
    return out;
  }

  std::vector<std::int32_t> embedded_offset, embedded;  ///< original vertices by the cell they are embedded in
};

CutSurface::~CutSurface() = default;

CutSurface::CutSurface(const TriangleMesh& surface, const Lattice& lattice) : base_(std::make_unique<Base>(surface, lattice)) {
  const TriangleMesh& closed = base_->overlay.source().mesh();
  for (std::size_t v = 0; v < closed.vertices.size(); ++v) {
    vertices_.push_back({closed.vertices[v], {lattice.embedding[v].cell, 0}, lattice.embedding[v].local});
  }
  const std::int32_t fillers = base_->overlay.source().fillers();
  for (std::int32_t t = 0; t < base_->originals; ++t) {
    triangles_.push_back(closed.triangles[t]);
    kinds_.push_back(t < base_->originals - fillers ? SurfaceKind::original : SurfaceKind::filler);
    owners_.push_back({false, t, 0});
    if (kinds_.back() == SurfaceKind::filler) changes_.triangles.push_back(t);
  }
}

void CutSurface::update(const CutTopology& topology, const std::vector<std::int32_t>& cells) {
  std::vector<CutGridCell> changed;
  const CutMesh& mesh = topology.mesh();
  for (const std::int32_t c : cells) {
    CutGridCell cell;
    cell.index = base_->lattice.cells[c].index;
    cell.crossing.fill(-1);
    cell.carrier.fill({c, 0});
    const auto found = topology.cells().find(c);
    if (found != topology.cells().end() && found->second.components > 1) {
      const CellCut& cut = found->second;
      cell.label = cut.label;
      for (int k = 0; k < cut.components; ++k) cell.carrier[k] = {c, k};
      for (std::size_t e = 0; e < overlay::kKuhnEdges.size(); ++e) {
        const auto [a, b] = overlay::kKuhnEdges[e];
        if ((cut.cut >> mesh.shape->edge_of[a][b] & 1) == 0) continue;
        const std::int32_t m = mesh.cells[c][a], n = mesh.cells[c][b];
        const double t = topology.edges().at(node_pair(m, n));
        cell.crossing[e] = m < n ? t : 1 - t;
        cell.when[e] = cut.when[mesh.shape->edge_of[a][b]];
      }
      set_centres(*mesh.shape, cut, cell);
    }
    changed.push_back(cell);
  }
  update(changed);
}

void CutSurface::update(const std::vector<CutGridCell>& cells) {
  overlay::Overlay& overlay = base_->overlay;
  const std::vector<CutGridCell> places = base_->one_per_place(cells);
  std::vector<CutGridCell> all = base_->air.update(places);
  all.insert(all.end(), places.begin(), places.end());
  overlay.update(all);
  for (const std::int32_t f : overlay.dirty_faces()) replace({true, f, 0}, overlay.caps_of(f), SurfaceKind::cut);
  for (const std::int32_t t : overlay.dirty_triangles()) {
    const bool filler = t >= base_->originals - overlay.source().fillers();
    Patch patch = overlay.pieces_of(t);
    if (patch.triangles.empty()) patch.triangles.push_back(overlay.source().mesh().triangles[t]);
    replace({false, t, 0}, patch, filler ? SurfaceKind::filler : SurfaceKind::original);
  }
  for (const auto& [v, carrier] : overlay.moved_vertices) embed(v, carrier);
  for (const CutGridCell& cell : cells) embed_outside(cell);
}

SurfaceChanges CutSurface::take_changes() {
  const auto tidy = [](std::vector<std::int32_t>& list, std::size_t count) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.erase(std::lower_bound(list.begin(), list.end(), static_cast<std::int32_t>(count)), list.end());
  };
  tidy(changes_.vertices, vertices_.size());
  tidy(changes_.triangles, triangles_.size());
  return std::exchange(changes_, {});
}

// Vertices embedded in a cell without lying in any cell that is cut: they go with its nearest corner.
void CutSurface::embed_outside(const CutGridCell& cell) {
  const std::int32_t own = cell.carrier[0].cell;
  for (std::int32_t i = base_->embedded_offset[own]; i < base_->embedded_offset[own + 1]; ++i) {
    const std::int32_t v = base_->embedded[i];
    if (base_->overlay.holds(v)) continue;
    int corner = 0;
    for (int a = 0; a < 3; ++a) corner |= vertices_[v].local[a] > 0.5 ? 1 << a : 0;
    embed(v, cell.carrier[cell.label[corner]]);
  }
}

std::vector<std::int32_t>& CutSurface::slots_of(const Owner& owner) {
  if (owner.cap) return cap_slots_[owner.what];
  auto& slots = piece_slots_[owner.what];
  if (slots.empty()) slots.push_back(owner.what);
  return slots;
}

void CutSurface::set(std::int32_t slot, const std::array<std::int32_t, 3>& triangle, SurfaceKind kind, const Owner& owner) {
  const Owner before = std::exchange(owners_[slot], owner);
  if (triangles_[slot] == triangle && kinds_[slot] == kind && before.cap == owner.cap && before.what == owner.what) return;
  triangles_[slot] = triangle;
  kinds_[slot] = kind;
  changes_.triangles.push_back(slot);
}

// Slots stay dense: the last one moves into the gap.
void CutSurface::remove_last_slot(std::vector<std::int32_t>& slots) {
  const std::int32_t gap = slots.back(), last = static_cast<std::int32_t>(triangles_.size()) - 1;
  slots.pop_back();
  if (gap != last) {
    const Owner owner = owners_[last];
    slots_of(owner)[owner.place] = gap;
    set(gap, triangles_[last], kinds_[last], owner);
  }
  triangles_.pop_back();
  kinds_.pop_back();
  owners_.pop_back();
  changes_.triangles.push_back(last);
}

void CutSurface::replace(const Owner& owner, const Patch& patch, SurfaceKind kind) {
  std::vector<std::int32_t> ids;
  for (const overlay::CutVertex& v : patch.vertices) ids.push_back(vertex(v));
  auto& slots = slots_of(owner);
  while (slots.size() > std::max<std::size_t>(patch.triangles.size(), owner.cap ? 0 : 1)) remove_last_slot(slots);
  while (slots.size() < patch.triangles.size()) {
    slots.push_back(static_cast<std::int32_t>(triangles_.size()));
    triangles_.push_back({-1, -1, -1});
    kinds_.push_back(kind);
    owners_.push_back(owner);
  }
  for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
    auto t = patch.triangles[i];
    for (auto& c : t) c = c < 0 ? ids[~c] : c;
    set(slots[i], t, kind, {owner.cap, owner.what, static_cast<std::int32_t>(i)});
  }
}

std::int32_t CutSurface::vertex(const overlay::CutVertex& v) {
  const auto [found, is_new] = vertex_of_.try_emplace(v.key, static_cast<std::int32_t>(vertices_.size()));
  if (is_new) vertices_.push_back({v.x, {}, {}});
  if (vertices_[found->second].rest != v.x) {
    vertices_[found->second].rest = v.x;
    vertices_[found->second].carrier = {};
  }
  embed(found->second, v.carrier);
  return found->second;
}

void CutSurface::embed(std::int32_t vertex, const Carrier& carrier) {
  CutSurfaceVertex& v = vertices_[vertex];
  if (v.carrier == carrier) return;
  v.carrier = carrier;
  const Lattice& lattice = base_->lattice;
  const Vec3d corner = lattice.position({lattice.cells[carrier.cell].index, 0});
  for (int a = 0; a < 3; ++a) v.local[a] = (v.rest[a] - corner[a]) / lattice.spacing;
  changes_.vertices.push_back(vertex);
}

void CutSurface::embedding(const CutTopology& topology, std::int32_t vertex, std::array<std::int32_t, 8>& nodes,
                           std::array<double, 8>& weights) const {
  const CutSurfaceVertex& v = vertices_[vertex];
  std::int32_t element = topology.element_of(v.carrier.cell, v.carrier.label);
  const auto found = topology.cells().find(v.carrier.cell);
  if (element < 0 && found != topology.cells().end()) {  // a component without material: nothing visible is embedded in it
    for (const std::int32_t other : found->second.element) element = std::max(element, other);
  }
  nodes = topology.elements().nodes[element < 0 ? v.carrier.cell : element];
  for (int a = 0; a < 8; ++a) {
    weights[a] = 1;
    for (int k = 0; k < 3; ++k) weights[a] *= (a >> k & 1) != 0 ? v.local[k] : 1 - v.local[k];
  }
}

}  // namespace pliant
