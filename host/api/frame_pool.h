// A pool that recycles the memory of frames.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "model/model.h"
#include "pliant/frame.h"

namespace pliant::api {

/// Data shared by all frames of one topology.
struct Topology {
  std::uint64_t version = 0;
  std::shared_ptr<const Model> model;   ///< owns the triangles
  std::vector<Vec4f> rest;              ///< [vertices] [m]
  std::vector<std::uint8_t> cut_faces;  ///< [triangles] or empty
  std::vector<IndexRange> body_vertices, body_triangles;
};

/// A frame and the memory that it points to.
struct FrameData {
  Frame frame;                            ///< without dirty ranges, for World::frame_since
  Frame polled;                           ///< with dirty ranges, for World::frame
  std::vector<Vec4f> positions, normals;  ///< padded like the backend's buffer
  std::shared_ptr<const Topology> topology;
};

class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  /// Returns a frame to fill. When its last owner releases it, it returns to the pool, or is freed if the pool is gone.
  std::shared_ptr<FrameData> take();

 private:
  static constexpr std::size_t kKept = 8;  ///< frames that are read, wait, and that two callers hold
  void give_back(std::unique_ptr<FrameData> data);
  std::mutex mutex_;
  std::vector<std::unique_ptr<FrameData>> free_;
};

/// Computes unit normals of `count` vertices: the area-weighted mean over their triangles, where the skin meets a cut over
/// those of the skin; zero without triangles.
void vertex_normals(const std::vector<Vec4f>& positions, std::size_t count, View<Triangle> triangles,
                    View<std::uint8_t> cut_faces, std::vector<Vec4f>& normals);

/// Returns the smallest range of `to` outside of which both have the same bits.
IndexRange changed_range(View<Vec4f> from, View<Vec4f> to);

/// The same for positions and normals.
IndexRange changed_vertices(const Frame& from, const Frame& to);

/// The same for triangles and their cut flags.
IndexRange changed_triangles(const Frame& from, const Frame& to);

/// Implements World::frame_since; `seen` may be null.
FrameChange change_since(const Frame* seen, FramePtr now);

/// Returns the smallest range that contains both.
IndexRange joined(const IndexRange& a, const IndexRange& b);

}  // namespace pliant::api
