// The surface of all bodies at one step, for renderers, in immutable memory.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "pliant/export.h"
#include "pliant/scene.h"

namespace pliant {

/// A non-owning pointer and length.
template <class T>
class View {
 public:
  /// An empty view.
  View() = default;
  /// A view of `size` elements starting at `data`. The caller keeps the memory alive.
  View(const T* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] const T* data() const { return data_; }         ///< null if empty
  [[nodiscard]] std::size_t size() const { return size_; }      ///< number of elements
  [[nodiscard]] bool empty() const { return size_ == 0; }       ///< true if there are no elements
  [[nodiscard]] const T* begin() const { return data_; }        ///< for range-based for loops
  [[nodiscard]] const T* end() const { return data_ + size_; }  ///< for range-based for loops

  /// Element i; the index is not checked.
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  const T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// x, y, z and w = 0: 16 bytes, a stride that graphics and ray-tracing APIs accept directly.
using Vec4f = std::array<float, 4>;

/// The indices first .. first + count - 1. A count of 0 is the empty range.
struct IndexRange {
  std::size_t first = 0;  ///< first index
  std::size_t count = 0;  ///< number of indices
};

/// The surface of all bodies at one step. A frame is immutable and stays valid as long as a FramePtr to it exists, even after
/// its World is destroyed. The arrays list the bodies one after another.
///
/// A cut appends vertices and triangles to its body's part and closes the body along the cut. Vertex k of a body, counted
/// from the body's first vertex, is the same vertex in all frames; vertices away from the cut keep their numbers. Vertices
/// that no triangle uses any more stay in the array.
struct Frame {
  std::int64_t step = 0;     ///< steps since the start
  double time = 0;           ///< [s]
  View<Vec4f> positions;     ///< [m], shape [vertices]
  View<Vec4f> normals;       ///< unit length, shape [vertices]; where the skin meets a cut, the skin's normal; empty without
                             ///< WorldOptions::normals
  View<Vec4f> rest;          ///< undeformed positions [m], shape [vertices]
  View<Triangle> triangles;  ///< vertex numbers, shape [triangles]
  View<std::uint8_t> cut_faces;     ///< 1 if the triangle lies on a cut, shape [triangles]; empty if there are none
  View<IndexRange> body_vertices;   ///< vertices of each body, shape [bodies]
  View<IndexRange> body_triangles;  ///< triangles of each body, shape [bodies]
  std::uint64_t topology_version =
      0;  ///< incremented whenever the vertex or triangle list changes; motion alone does not count

  /// Vertices whose position or normal may differ from that of the same vertex in the previous frame returned by
  /// World::frame(). Changes in frames that were never fetched are included. The first frame contains all vertices. Empty in
  /// frames from World::frame_since(), which returns the ranges in FrameChange instead.
  IndexRange dirty_vertices;
  /// The same for triangles and cut_faces; empty unless the topology changed.
  IndexRange dirty_triangles;
};

/// Shared ownership of a frame; may be kept indefinitely.
using FramePtr = std::shared_ptr<const Frame>;

/// The newest frame for one of several consumers, and the ranges that are new to this consumer.
struct FrameChange {
  FramePtr frame;              ///< the newest frame; `seen` itself if there is no newer one
  IndexRange dirty_vertices;   ///< vertices whose position or normal differs from that of the same vertex in `seen`
  IndexRange dirty_triangles;  ///< the same for triangles and cut_faces; empty unless the topology changed
};

}  // namespace pliant
