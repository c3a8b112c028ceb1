// Linked lattices of several shapes, and what the ordered sums reach in them, by walking.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "model/matching/flsm_regions.h"

namespace pliant::test {

using Index = std::array<std::int32_t, 3>;

inline void join(LinkedLattice& lattice, std::int32_t from, std::int32_t to, int axis) {
  lattice.link[from][2 * axis + 1] = to;
  lattice.link[to][2 * axis] = from;
}

inline void unlink(LinkedLattice& lattice, std::int32_t node, int side) {
  const std::int32_t n = lattice.link[node][side];
  if (n >= 0) lattice.link[n][side ^ 1] = -1;
  lattice.link[node][side] = -1;
}

// The grid points of [0, size) that `inside` chooses, linked to their neighbours.
template <class Inside>
LinkedLattice shape(const Index& size, const Inside& inside) {
  LinkedLattice lattice;
  std::map<Index, std::int32_t> at;
  for (std::int32_t k = 0; k < size[2]; ++k) {
    for (std::int32_t j = 0; j < size[1]; ++j) {
      for (std::int32_t i = 0; i < size[0]; ++i) {
        if (!inside(i, j, k)) continue;
        at[{i, j, k}] = static_cast<std::int32_t>(lattice.index.size());
        lattice.index.push_back({i, j, k});
      }
    }
  }
  lattice.link.assign(lattice.index.size(), {-1, -1, -1, -1, -1, -1});
  for (const auto& [p, n] : at) {
    for (int a = 0; a < 3; ++a) {
      Index q = p;
      ++q[a];
      if (at.contains(q)) join(lattice, n, at[q], a);
    }
  }
  return lattice;
}

inline LinkedLattice ball(int radius) {
  const int d = 2 * radius + 1;
  return shape({d, d, d}, [=](int i, int j, int k) {
    const int x = i - radius, y = j - radius, z = k - radius;
    return x * x + y * y + z * z <= radius * radius;
  });
}

inline LinkedLattice torus() {
  return shape({15, 15, 7}, [](int i, int j, int k) {
    const double ring = std::hypot(i - 7.0, j - 7.0) - 4.6;
    return std::hypot(ring, k - 3.0) < 2.4;
  });
}

// The same L lies another way round in each plane: the order of the sums matters.
inline LinkedLattice el(int turn) {
  return shape({8, 8, 8}, [turn](int i, int j, int k) {
    const std::array<int, 3> p{i, j, k};
    return p[turn] < 3 || p[(turn + 1) % 3] < 3;
  });
}

inline LinkedLattice u_bend() {
  return shape({7, 8, 4}, [](int i, int j, int) { return i < 3 || i > 3 || j < 2; });
}

inline LinkedLattice cut_ball() {
  LinkedLattice lattice = ball(6);
  const auto side = [](const Index& p) { return 3 * p[0] + 2 * p[1] + p[2] > 37; };
  for (std::size_t n = 0; n < lattice.index.size(); ++n) {
    const auto i = static_cast<std::int32_t>(n);
    for (int d = 0; d < 6; ++d) {
      const std::int32_t other = lattice.link[i][d];
      // The cut ends inside the ball.
      if (other >= 0 && lattice.index[i][2] > 4 && side(lattice.index[i]) != side(lattice.index[other])) unlink(lattice, i, d);
    }
  }
  return lattice;
}

inline LinkedLattice torn_ball(double share) {
  LinkedLattice lattice = ball(6);
  std::mt19937 random(7);
  for (std::size_t n = 0; n < lattice.index.size(); ++n) {
    for (int d = 1; d < 6; d += 2) {
      if (static_cast<double>(random()) < share * 4294967296.0) unlink(lattice, static_cast<std::int32_t>(n), d);
    }
  }
  return lattice;
}

// A box whose part x >= 3 exists twice at the same grid points. One sheet is joined to the rest below y = 4, the other above.
inline LinkedLattice two_sheets() {
  LinkedLattice lattice = shape({7, 8, 5}, [](int, int, int) { return true; });
  std::map<Index, std::int32_t> first, second;
  for (std::size_t n = 0; n < lattice.index.size(); ++n) first[lattice.index[n]] = static_cast<std::int32_t>(n);
  for (const auto& [p, n] : first) {
    if (p[0] < 3) continue;
    second[p] = static_cast<std::int32_t>(lattice.index.size());
    lattice.index.push_back(p);
    lattice.link.push_back({-1, -1, -1, -1, -1, -1});
  }
  for (const auto& [p, n] : second) {
    for (int a = 0; a < 3; ++a) {
      Index q = p;
      ++q[a];
      if (second.contains(q)) join(lattice, n, second[q], a);
    }
    if (p[0] == 3 && p[1] >= 4) {
      unlink(lattice, first[p], 0);
      join(lattice, first[{2, p[1], p[2]}], n, 0);
    }
  }
  return lattice;
}

// The same lattice with its nodes numbered in another order.
inline LinkedLattice shuffled(const LinkedLattice& lattice) {
  std::vector<std::int32_t> number(lattice.index.size());
  std::iota(number.begin(), number.end(), 0);
  std::mt19937 random(3);
  for (std::size_t n = number.size() - 1; n > 0; --n) std::swap(number[n], number[random() % (n + 1)]);
  LinkedLattice out = lattice;
  for (std::size_t n = 0; n < number.size(); ++n) {
    out.index[number[n]] = lattice.index[n];
    for (int d = 0; d < 6; ++d) out.link[number[n]][d] = lattice.link[n][d] < 0 ? -1 : number[lattice.link[n][d]];
  }
  return out;
}

// The nodes that one reaches from `centre` along z, then y, then x links.
inline std::set<std::int32_t> ordered_set(const LinkedLattice& lattice, std::int32_t centre, int width) {
  std::vector<std::int32_t> all{centre};
  for (int axis = 2; axis >= 0; --axis) {
    const auto starts = all;
    for (const std::int32_t start : starts) {
      for (const int side : {2 * axis, 2 * axis + 1}) {
        std::int32_t n = start;
        for (int k = 0; k < width; ++k) {
          n = lattice.link[n][side];
          if (n < 0) break;
          all.push_back(n);
        }
      }
    }
  }
  std::set<std::int32_t> set(all.begin(), all.end());
  EXPECT_EQ(set.size(), all.size()) << "a node is reached twice from " << centre;
  return set;
}

}  // namespace pliant::test
