#include "api/frame_queue.h"

#include <algorithm>
#include <utility>

namespace pliant::api {
namespace {

/// Clips a range to an array that may have become shorter.
IndexRange within(const IndexRange& range, std::size_t count) {
  if (range.first >= count) return {};
  return {range.first, std::min(range.count, count - range.first)};
}

}  // namespace

void FrameQueue::add(Shared frame, const IndexRange& vertices, const IndexRange& triangles, double due) {
  waiting_.push_back({std::move(frame), vertices, triangles, due});
}

int FrameQueue::show(double now) noexcept {
  std::size_t due = waiting_.size();
  while (due > 0 && waiting_[due - 1].due > now) --due;
  int unseen = 0;
  for (; due > 0; --due) {
    Waiting& next = waiting_.front();
    vertices_ = within(joined(vertices_, next.vertices), next.frame->frame.positions.size());
    triangles_ = within(joined(triangles_, next.triangles), next.frame->frame.triangles.size());
    unseen += newest_ != seen_ ? 1 : 0;
    newest_ = std::move(next.frame);
    waiting_.pop_front();
  }
  return unseen;
}

const FrameQueue::Shared& FrameQueue::give() {
  seen_ = newest_;
  if (given_ == newest_) return newest_;
  given_ = newest_;
  given_->polled = given_->frame;
  given_->polled.dirty_vertices = std::exchange(vertices_, {});
  given_->polled.dirty_triangles = std::exchange(triangles_, {});
  return newest_;
}

}  // namespace pliant::api
