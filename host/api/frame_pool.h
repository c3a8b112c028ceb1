// Frames whose memory goes round: a frame that nobody holds any more is filled again.
#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "model/model.h"
#include "pliant/frame.h"

namespace pliant::api {

/// What all frames of one topology share.
struct Topology {
  std::uint64_t version = 0;
  std::shared_ptr<const Model> model;   ///< owns the triangles
  std::vector<Vec4f> rest;              ///< [vertices] [m]
  std::vector<std::uint8_t> cut_faces;  ///< [triangles] or empty
  std::vector<IndexRange> body_vertices, body_triangles;
};

/// A frame and what it points to.
struct FrameData {
  Frame frame;                            ///< without dirty ranges: for all who ask by World::frame_since
  Frame polled;                           ///< the same with them: for the one who asks by World::frame
  std::vector<Vec4f> positions, normals;  ///< padded as the backend pads them
  std::shared_ptr<const Topology> topology;
};

class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  /// A frame to fill. When its last holder lets go it comes back here, or is freed if the pool is gone.
  std::shared_ptr<FrameData> take();

 private:
  void give_back(std::unique_ptr<FrameData> data);
  std::mutex mutex_;
  std::vector<std::unique_ptr<FrameData>> free_;
};

/// Unit normals of all vertices, the mean of their triangles weighted by area, where skin meets a cut those of the skin; zero
/// where there is none. `count` vertices.
void vertex_normals(const std::vector<Vec4f>& positions, std::size_t count, View<Triangle> triangles,
                    View<std::uint8_t> cut_faces, std::vector<Vec4f>& normals);

/// The smallest range of `to` outside of which both hold the same bits.
IndexRange changed_range(View<Vec4f> from, View<Vec4f> to);

/// Positions and normals.
IndexRange changed_vertices(const Frame& from, const Frame& to);

/// Triangles and the flags that say which of them lie on a cut.
IndexRange changed_triangles(const Frame& from, const Frame& to);

/// World::frame_since: `seen` may be null.
FrameChange change_since(const Frame* seen, FramePtr now);

/// The smallest range that holds both.
IndexRange joined(const IndexRange& a, const IndexRange& b);

}  // namespace pliant::api
