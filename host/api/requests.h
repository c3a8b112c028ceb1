// Requests of the caller that the stepping thread executes between two batches.
#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace pliant::api {

/// A queue. A call of save() leaves a save point in it: what stands before is taken before the save, what stands behind only
/// afterwards. Not synchronised.
template <class T>
class Requests {
 public:
  [[nodiscard]] const std::vector<T>& all() const { return all_; }
  void push(T request) { all_.push_back(std::move(request)); }

  /// Takes those that may be executed now.
  [[nodiscard]] std::vector<T> take() {
    const std::size_t count = held_ && before_ == 0 ? 0 : points_.empty() ? all_.size() : points_.front();
    const auto end = all_.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<T> taken(std::make_move_iterator(all_.begin()), std::make_move_iterator(end));
    all_.erase(all_.begin(), end);
    for (std::size_t& p : points_) p -= count;
    return taken;
  }
  /// Puts some that were taken back to where they were, unless they have become void since.
  template <class Iterator>
  void put_back(Iterator first, Iterator last) {
    if (held_ && before_ == 0) return;
    all_.insert(all_.begin(), first, last);
    for (std::size_t& p : points_) p += static_cast<std::size_t>(last - first);
  }
  /// The newest one that `matches`, if nothing keeps it from being replaced by a newer one; nullptr: none.
  template <class Matches>
  [[nodiscard]] T* newest(const Matches& matches) {
    for (std::size_t i = all_.size(); i > behind_last(); --i) {
      if (matches(all_[i - 1])) return &all_[i - 1];
    }
    return nullptr;
  }
  template <class Matches>
  void discard_if(const Matches& matches) {
    all_.erase(std::remove_if(all_.begin() + static_cast<std::ptrdiff_t>(behind_last()), all_.end(), matches), all_.end());
  }

  void add_save_point() { points_.push_back(all_.size()); }
  /// The first save is done.
  void remove_save_point() {
    if (points_.empty()) return;
    points_.erase(points_.begin());
    before_ -= std::min<std::size_t>(before_, 1);
  }
  /// The simulation will be replaced: discards what stands behind the last save point, and lets nothing be taken that comes
  /// from now on until go_on().
  void hold_back() {
    if (!held_) before_ = points_.size();
    held_ = true;
    all_.resize(behind_last());
  }
  void go_on() { held_ = false; }
  void clear() {
    all_.clear();
    points_.clear();
    before_ = 0;
  }

 private:
  [[nodiscard]] std::size_t behind_last() const { return points_.empty() ? 0 : points_.back(); }

  std::vector<T> all_;
  std::vector<std::size_t> points_;  ///< number of requests before each save that is still to come
  std::size_t before_ = 0;           ///< saves to come before the simulation is replaced
  bool held_ = false;
};

}  // namespace pliant::api
