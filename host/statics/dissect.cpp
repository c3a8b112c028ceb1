// Nested dissection of a graph whose nodes have positions.
#include <algorithm>
#include <numeric>

#include "statics/cholesky.h"

namespace pliant::statics {
namespace {

constexpr std::size_t kLeaf = 48;  ///< nodes that are not divided further

class Dissector {
 public:
  Dissector(const std::vector<std::vector<int>>& neighbors, const std::vector<Vec3d>& position)
      : neighbors_(neighbors),
        position_(position),
        side_(neighbors.size(), 0),
        match_(neighbors.size(), -1),
        visited_(neighbors.size(), 0) {}

  Dissection operator()() {
    std::vector<int> all(neighbors_.size());
    std::iota(all.begin(), all.end(), 0);
    if (!all.empty()) divide(std::move(all), 0);
    return std::move(out_);
  }

 private:
  struct Cut {
    std::vector<int> left, right, separator;
  };

  int divide(std::vector<int> nodes, int depth) {
    Dissection::Group group;
    group.depth = depth;
    if (nodes.size() > kLeaf) {
      Cut best;
      double cost = HUGE_VAL;
      for (int axis = 0; axis < 3; ++axis) {
        Cut cut = halve(nodes, axis);
        // A cut that leaves one side small is worth less.
        const double uneven =
            static_cast<double>(std::max(cut.left.size(), cut.right.size())) / static_cast<double>(nodes.size());
        const double now = static_cast<double>(cut.separator.size()) * (0.5 + uneven);
        if (now < cost) {
          cost = now;
          best = std::move(cut);
        }
      }
      if (!best.left.empty() && !best.right.empty()) {
        nodes.clear();
        nodes.shrink_to_fit();
        group.children.push_back(divide(std::move(best.left), depth + 1));
        group.children.push_back(divide(std::move(best.right), depth + 1));
        nodes = std::move(best.separator);
      }
    }
    std::sort(nodes.begin(), nodes.end());
    group.nodes = std::move(nodes);
    out_.groups.push_back(std::move(group));
    return static_cast<int>(out_.groups.size()) - 1;
  }

  /// Halves by the coordinate; the separator is a smallest vertex cover of the edges between the halves (Koenig 1931).
  Cut halve(std::vector<int> nodes, int axis) {
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) {
      return position_[a][axis] != position_[b][axis] ? position_[a][axis] < position_[b][axis] : a < b;
    });
    const std::size_t half = nodes.size() / 2;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      side_[nodes[i]] = i < half ? kLeft : kRight;
      match_[nodes[i]] = -1;
    }
    std::vector<int> rim;
    for (std::size_t i = 0; i < half; ++i) {
      if (std::any_of(neighbors_[nodes[i]].begin(), neighbors_[nodes[i]].end(), [&](int n) { return side_[n] == kRight; }))
        rim.push_back(nodes[i]);
    }
    for (const int n : rim) augment(n, ++round_);
    // From unmatched rim nodes along alternating paths: the cover is what is not reached on the left, and reached on the right.
    const int reach = ++round_;
    std::vector<int> open;
    for (const int n : rim) {
      if (match_[n] < 0) open.push_back(n);
    }
    for (const int n : open) visited_[n] = reach;
    while (!open.empty()) {
      const int n = open.back();
      open.pop_back();
      for (const int m : neighbors_[n]) {
        if (side_[m] != kRight || visited_[m] == reach) continue;
        visited_[m] = reach;
        if (const int back = match_[m]; back >= 0 && visited_[back] != reach) {
          visited_[back] = reach;
          open.push_back(back);
        }
      }
    }
    Cut cut;
    for (const int n : rim) {
      if (visited_[n] != reach) side_[n] = kSeparator;
    }
    for (const int n : nodes) {
      if (side_[n] == kRight && visited_[n] == reach) side_[n] = kSeparator;
      (side_[n] == kLeft ? cut.left : side_[n] == kRight ? cut.right : cut.separator).push_back(n);
      side_[n] = 0;
    }
    return cut;
  }

  /// Kuhn's augmenting path from a node on the left; recursion depth is bounded by the rim.
  bool augment(int n, int round) {
    for (const int m : neighbors_[n]) {
      if (side_[m] == kRight && match_[m] < 0) {
        match_[m] = n;
        match_[n] = m;
        return true;
      }
    }
    for (const int m : neighbors_[n]) {
      if (side_[m] != kRight || visited_[m] == round) continue;
      visited_[m] = round;
      if (augment(match_[m], round)) {
        match_[m] = n;
        match_[n] = m;
        return true;
      }
    }
    return false;
  }

  static constexpr char kLeft = 1, kRight = 2, kSeparator = 3;
  const std::vector<std::vector<int>>& neighbors_;
  const std::vector<Vec3d>& position_;
  std::vector<char> side_;  ///< 0: not among the nodes being halved
  std::vector<int> match_, visited_;
  int round_ = 0;  ///< marks in visited_ below this one are old
  Dissection out_;
};

}  // namespace

Dissection dissect(const std::vector<std::vector<int>>& neighbors, const std::vector<Vec3d>& position) {
  return Dissector(neighbors, position)();
}

}  // namespace pliant::statics
