// What a renderer gets: the surface of one moment, in memory that nobody writes any more.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "pliant/export.h"
#include "pliant/scene.h"

namespace pliant {

/// A pointer and a length: an array that belongs to somebody else.
template <class T>
class View {
 public:
  /// Empty.
  View() = default;
  /// `size` elements from `data` on.
  View(const T* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] const T* data() const { return data_; }         ///< null if empty
  [[nodiscard]] std::size_t size() const { return size_; }      ///< elements
  [[nodiscard]] bool empty() const { return size_ == 0; }       ///< no element
  [[nodiscard]] const T* begin() const { return data_; }        ///< for loops
  [[nodiscard]] const T* end() const { return data_ + size_; }  ///< for loops

  /// Not checked.
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  const T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// x, y, z and a w that is 0: 16 bytes, the stride that graphics and ray tracing interfaces like.
using Vec4f = std::array<float, 4>;

/// Indices first .. first + count - 1; count 0: none.
struct IndexRange {
  std::size_t first = 0;  ///< the first one
  std::size_t count = 0;  ///< how many
};

/// The surface of all bodies at one step. A frame does not change once it is there, and it stays as long as somebody holds it,
/// also after its World is gone. Bodies follow one another.
///
/// A cut adds vertices and triangles at the end of its body's part and closes the body along the cut. Vertex k of a body is the
/// same one in all frames, counted from the first of that body: what lies beside the cut keeps its vertices. Those that no
/// triangle uses any more stay in the list.
struct Frame {
  std::int64_t step = 0;            ///< steps since the start
  double time = 0;                  ///< [s]
  View<Vec4f> positions;            ///< [m], shape [vertices]
  View<Vec4f> normals;              ///< unit length, shape [vertices], of the skin where that meets a cut; empty if not wanted
  View<Vec4f> rest;                 ///< positions at rest [m], shape [vertices]
  View<Triangle> triangles;         ///< vertex numbers, shape [triangles]
  View<std::uint8_t> cut_faces;     ///< 1: the triangle lies on a cut, shape [triangles]; empty: none does
  View<IndexRange> body_vertices;   ///< part of each body, shape [bodies]
  View<IndexRange> body_triangles;  ///< likewise
  std::uint64_t topology_version =
      0;  ///< changes when vertices or triangles are others than before; positions alone do not count

  /// The vertices whose position or normal may differ from the one of the same number in the frame that World::frame() gave
  /// before this one (frames that were never asked for count in). All of them in the first frame. Empty in
  /// frames from World::frame_since(), which returns the ranges of each of several consumers beside the frame.
  IndexRange dirty_vertices;
  /// The same for triangles and cut_faces: empty unless the topology changed.
  IndexRange dirty_triangles;
};

/// Keep it as long as you like.
using FramePtr = std::shared_ptr<const Frame>;

/// The newest frame for one of several consumers, and what of it is new to that consumer.
struct FrameChange {
  FramePtr frame;              ///< the one that was seen already if there is no newer one
  IndexRange dirty_vertices;   ///< vertices whose position or normal differs from that of the same number in what was seen
  IndexRange dirty_triangles;  ///< the same for triangles and cut_faces
};

}  // namespace pliant
