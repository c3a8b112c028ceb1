#include "statics/cholesky.h"

#include <algorithm>
#include <atomic>

#include "geometry/parallel.h"
#include "statics/dense.h"

namespace pliant::statics {
namespace {

/// Nodes that have unknowns, numbered; `first` unknown of each, and one behind the last.
struct Nodes {
  std::vector<int> first;
  std::vector<Vec3d> position;
  std::vector<std::vector<int>> neighbors;
};

Nodes nodes_of(const SparseMatrix& pattern, const std::vector<int>& node, const std::vector<Vec3d>& rest) {
  Nodes out;
  std::vector<int> number(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    if (i == 0 || node[i] != node[i - 1]) {
      out.first.push_back(static_cast<int>(i));
      out.position.push_back(rest[node[i]]);
    }
    number[i] = static_cast<int>(out.first.size()) - 1;
  }
  out.neighbors.resize(out.first.size());
  for (int column = 0; column < pattern.cols(); ++column) {
    for (SparseMatrix::InnerIterator it(pattern, column); it; ++it) {
      const int i = number[column], j = number[it.row()];
      if (i == j) continue;
      out.neighbors[i].push_back(j);
      out.neighbors[j].push_back(i);
    }
  }
  for (auto& list : out.neighbors) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  out.first.push_back(static_cast<int>(node.size()));
  return out;
}

}  // namespace

void Cholesky::analyze(const SparseMatrix& pattern, const std::vector<int>& node, const std::vector<Vec3d>& rest) {
  const Nodes nodes = nodes_of(pattern, node, rest);
  const Dissection dissection = dissect(nodes.neighbors, nodes.position);
  place_.assign(node.size(), -1);
  fronts_.clear();
  by_depth_.clear();
  int next = 0;
  for (const Dissection::Group& group : dissection.groups) {
    Front front;
    front.depth = group.depth;
    front.children = group.children;
    for (const int n : group.nodes) {
      for (int i = nodes.first[n]; i < nodes.first[n + 1]; ++i) {
        front.rows.push_back(next);
        place_[i] = next++;
      }
    }
    front.own = static_cast<int>(front.rows.size());
    if (by_depth_.size() <= static_cast<std::size_t>(front.depth)) by_depth_.resize(front.depth + 1);
    by_depth_[front.depth].push_back(static_cast<int>(fronts_.size()));
    fronts_.push_back(std::move(front));
  }
  // The lower triangle in elimination order, and where each value goes.
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < pattern.cols(); ++column) {
    for (SparseMatrix::InnerIterator it(pattern, column); it; ++it) {
      const int i = place_[column], j = place_[it.row()];
      entries.emplace_back(std::max(i, j), std::min(i, j), static_cast<double>(entries.size() + 1));
    }
  }
  permuted_.resize(pattern.rows(), pattern.cols());
  permuted_.setFromTriplets(entries.begin(), entries.end());
  value_place_.resize(entries.size());
  for (int k = 0; k < permuted_.nonZeros(); ++k) value_place_[static_cast<std::size_t>(permuted_.valuePtr()[k]) - 1] = k;
  // Boundaries: what the own columns and the children's boundaries reach beyond the own rows.
  for (Front& front : fronts_) {
    if (front.own == 0 && front.children.empty()) continue;
    std::vector<int> boundary;
    const int end = front.own > 0 ? front.rows.back() : -1;
    for (int r = 0; r < front.own; ++r) {
      for (SparseMatrix::InnerIterator it(permuted_, front.rows[r]); it; ++it) {
        if (it.row() > end) boundary.push_back(static_cast<int>(it.row()));
      }
    }
    for (const int c : front.children) {
      const Front& child = fronts_[c];
      for (std::size_t r = child.own; r < child.rows.size(); ++r) {
        if (front.own == 0 || child.rows[r] > end) boundary.push_back(child.rows[r]);
      }
    }
    std::sort(boundary.begin(), boundary.end());
    boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
    front.rows.insert(front.rows.end(), boundary.begin(), boundary.end());
  }
}

bool Cholesky::eliminate(Front& front, const SparseMatrix& permuted, double shift) {
  const auto size = static_cast<Eigen::Index>(front.rows.size());
  const Eigen::Index own = front.own, rest = size - own;
  front.factor.setZero(size, own);
  front.update.setZero(rest, rest);
  const auto row_of = [&](int place) {
    return std::lower_bound(front.rows.begin(), front.rows.end(), place) - front.rows.begin();
  };
  for (Eigen::Index c = 0; c < own; ++c) {
    auto row = front.rows.begin() + c;
    for (SparseMatrix::InnerIterator it(permuted, front.rows[c]); it; ++it) {
      row = std::lower_bound(row, front.rows.end(), static_cast<int>(it.row()));
      front.factor(row - front.rows.begin(), c) += it.value();
    }
    front.factor(c, c) += shift;
  }
  for (const int number : front.children) {
    Front& child = fronts_[number];
    const Eigen::Index count = child.update.rows();
    std::vector<Eigen::Index> at(count);
    for (Eigen::Index i = 0; i < count; ++i) at[i] = row_of(child.rows[child.own + i]);
    for (Eigen::Index j = 0; j < count; ++j) {
      double* const column = at[j] < own ? front.factor.col(at[j]).data() : front.update.col(at[j] - own).data() - own;
      const double* const from = child.update.col(j).data();
      for (Eigen::Index i = j; i < count; ++i) column[at[i]] += from[i];
    }
    child.update.resize(0, 0);
  }
  if (own == 0) return true;
  return eliminate_dense(front.factor.data(), size, own, front.update.data());
}

bool Cholesky::factorize(const SparseMatrix& matrix, double shift) {
  for (std::size_t k = 0; k < value_place_.size(); ++k) permuted_.valuePtr()[value_place_[k]] = matrix.valuePtr()[k];
  std::atomic<bool> positive{true};
  for (auto level = by_depth_.rbegin(); level != by_depth_.rend(); ++level) {
    parallel_for(static_cast<std::int64_t>(level->size()), [&](std::int64_t i) {
      if (positive && !eliminate(fronts_[(*level)[i]], permuted_, shift)) positive = false;
    });
    if (!positive) break;
  }
  if (!positive) {
    for (Front& front : fronts_) front.update.resize(0, 0);
  }
  return positive;
}

VectorXd Cholesky::solve(const VectorXd& right) const {
  VectorXd x(right.size());
  for (Eigen::Index i = 0; i < right.size(); ++i) x[place_[i]] = right[i];
  for (const Front& front : fronts_) {
    if (front.own == 0) continue;
    auto own = x.segment(front.rows[0], front.own);
    front.factor.topRows(front.own).triangularView<Eigen::Lower>().solveInPlace(own);
    const auto rest = static_cast<Eigen::Index>(front.rows.size()) - front.own;
    const VectorXd change = front.factor.bottomRows(rest) * own;
    for (Eigen::Index r = 0; r < rest; ++r) x[front.rows[front.own + r]] -= change[r];
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    if (front->own == 0) continue;
    const auto rest = static_cast<Eigen::Index>(front->rows.size()) - front->own;
    VectorXd above(rest);
    for (Eigen::Index r = 0; r < rest; ++r) above[r] = x[front->rows[front->own + r]];
    auto own = x.segment(front->rows[0], front->own);
    own -= front->factor.bottomRows(rest).transpose() * above;
    front->factor.topRows(front->own).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  VectorXd out(right.size());
  for (Eigen::Index i = 0; i < right.size(); ++i) out[i] = x[place_[i]];
  return out;
}

std::int64_t Cholesky::entries() const {
  std::int64_t sum = 0;
  for (const Front& front : fronts_) sum += static_cast<std::int64_t>(front.rows.size()) * front.own;
  return sum;
}

}  // namespace pliant::statics
