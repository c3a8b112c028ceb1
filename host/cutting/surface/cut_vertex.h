// Vertices of the surface of a cut body and the triangles between them, as the overlay reports them.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "cutting/surface/cell_interface.h"

namespace pliant::overlay {

/// Identity of a vertex of the result: (kind, source, sector).
struct VertexKey {
  /// The last four are middles of sides: of an edge of the cut surface, of a segment, of a side between two triangles of a
  /// cap or of a piece.
  enum Kind : std::int64_t { edge_face, triangle_edge, point, edge_middle, segment_middle, cap_middle, piece_middle };
  static std::int64_t of(Kind kind, std::int64_t source) { return source << 3 | kind; }
  std::int64_t a = 0, b = 0;
  friend bool operator==(const VertexKey&, const VertexKey&) = default;
};
struct VertexKeyHash {
  std::size_t operator()(const VertexKey& key) const {
    std::uint64_t h = static_cast<std::uint64_t>(key.a) * 0x9e3779b97f4a7c15U ^ static_cast<std::uint64_t>(key.b);
    h ^= h >> 29;
    h *= 0xbf58476d1ce4e5b9U;
    return h ^ h >> 32;
  }
};

struct CutVertex {
  VertexKey key{};
  Vec3d x{};
  Carrier carrier{};
};

/// Triangles that replace an original triangle or close a cut face; corners are original vertices (>= 0) or ~index into
/// `vertices`.
struct Patch {
  std::vector<CutVertex> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

}  // namespace pliant::overlay
