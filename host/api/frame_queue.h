// Frames on their way from the stepping thread to the display. Private to host/api and its tests.
#pragma once
#include <deque>
#include <memory>

#include "api/frame_pool.h"

namespace pliant::api {

/// Not thread-safe.
class FrameQueue {
 public:
  using Shared = std::shared_ptr<FrameData>;

  /// Adds a frame that may be shown from the wall time `due` on [s]. `vertices`, `triangles`: what may differ from the frame
  /// that was added before.
  void add(Shared frame, const IndexRange& vertices, const IndexRange& triangles, double due);
  /// Makes the last frame that is due at this wall time [s] the newest. Returns the number of frames that nobody has seen or
  /// will see. Those before it are due as well.
  int show(double now) noexcept;

  [[nodiscard]] const Shared& newest() const { return newest_; }
  /// The frame that the caller has seen last: numbers of vertices refer to it. Null at first.
  [[nodiscard]] const Shared& seen() const { return seen_; }
  /// True if poll() has something to tell.
  [[nodiscard]] bool has_more_than_given() const { return newest_ != given_; }
  /// Returns the newest frame, with the ranges that differ from the one that give() returned before. It counts as seen.
  const Shared& give();
  /// The same without a change of these ranges.
  const Shared& see() { return seen_ = newest_; }

 private:
  struct Waiting {
    Shared frame;
    IndexRange vertices, triangles;
    double due = 0;
  };
  std::deque<Waiting> waiting_;
  Shared newest_, given_, seen_;
  IndexRange vertices_, triangles_;  ///< from `given_` to `newest_`
};

}  // namespace pliant::api
