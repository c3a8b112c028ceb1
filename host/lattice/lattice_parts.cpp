// Which cells of the grid hold material: coarse to fine, by distance to the surface; cells near it are sampled.
#include "lattice/lattice_parts.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "geometry/parallel.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using Index = std::array<std::int32_t, 3>;

struct BlockFiller {
  const SurfaceDistance& surface;
  const Grid& grid;
  std::vector<CellPart> parts;
  CellSampler sampler;

  BlockFiller(const SurfaceDistance& s, const Grid& g) : surface(s), grid(g), sampler(s, g.origin, g.spacing) {}

  void fill(const Index& low, int edge) {
    for (int a = 0; a < 3; ++a) {
      if (low[a] >= grid.size[a]) return;
    }
    if (edge == 1) {
      sampler.sample(low, parts);
      return;
    }
    const double half = 0.5 * edge * grid.spacing, reach = std::sqrt(3.0) * half * (1 + 1e-9);
    const Vec3d centre =
        vec::add(vec::add(grid.origin, vec::mul({1.0 * low[0], 1.0 * low[1], 1.0 * low[2]}, grid.spacing)), {half, half, half});
    // Near and inside a hole the side changes without a surface: skip only where the winding number is settled.
    if (surface.closest(centre).distance > reach) {
      const double w = std::abs(surface.winding(centre));
      if (surface.orientation().closed() || (std::abs(w - 0.5) > 0.3 && surface.rim_distance(centre) > 2 * reach)) {
        if (w > 0.5) solid(low, edge);
        return;
      }
    }
    const int e = edge / 2;
    for (int c = 0; c < 8; ++c) fill({low[0] + e * (c & 1), low[1] + e * ((c >> 1) & 1), low[2] + e * (c >> 2)}, e);
  }

  void solid(const Index& low, int edge) {
    Index high = low;
    for (int a = 0; a < 3; ++a) high[a] = std::min(low[a] + edge, grid.size[a]);
    for (std::int32_t k = low[2]; k < high[2]; ++k) {
      for (std::int32_t j = low[1]; j < high[1]; ++j) {
        for (std::int32_t i = low[0]; i < high[0]; ++i) parts.push_back(CellPart::full({i, j, k}));
      }
    }
  }
};

bool before(const CellPart& x, const CellPart& y) {
  return std::array{x.index[2], x.index[1], x.index[0]} < std::array{y.index[2], y.index[1], y.index[0]};
}

// A body thinner than the samples everywhere, or smaller than a quarter of a cell: keep every cell that its surface meets.
void keep_touched(const SurfaceDistance& surface, const Grid& grid, std::vector<CellPart>& list) {
  std::vector<Index> touched;
  for (const Vec3d& v : surface.mesh().vertices) {
    Index cell{};
    for (int a = 0; a < 3; ++a) {
      const double x = std::floor((v[a] - grid.origin[a]) / grid.spacing);
      cell[a] = static_cast<std::int32_t>(std::clamp(x, 0.0, grid.size[a] - 1.0));
    }
    touched.push_back(cell);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const double cells = std::pow(grid.spacing, 3) * static_cast<double>(touched.size());
  for (const Index& cell : touched) {
    list.push_back(CellPart::full(cell));
    list.back().thin = true;
    list.back().fill = std::clamp(std::abs(signed_volume(surface.mesh())) / cells, kFillFloor, 1.0);
  }
  std::sort(list.begin(), list.end(), before);
}

}  // namespace

Grid::Grid(const vec::Box& box, double edge) : spacing(edge) {
  for (int a = 0; a < 3; ++a) {
    const double extent = box.upper[a] - box.lower[a];
    const double count = std::max(1.0, std::ceil(extent / edge * (1 - 1e-6)));
    if (count > 1e6) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("lattice spacing {} m would need {:.3g} cells along {}; at most 1000000 are allowed", edge, count,
                              "xyz"[a]));
    }
    size[a] = static_cast<std::int32_t>(count);
    origin[a] = 0.5 * (box.lower[a] + box.upper[a]) - 0.5 * count * edge;
  }
}

bool Grid::contains(const Index& cell) const {
  for (int a = 0; a < 3; ++a) {
    if (cell[a] < 0 || cell[a] >= size[a]) return false;
  }
  return true;
}

Parts::Parts(const SurfaceDistance& surface, const Grid& grid, std::int64_t max_cells) : grid_(grid) {
  for (int a = 0; a < 3; ++a) blocks_[a] = (grid.size[a] + kBlock - 1) / kBlock;
  const std::int64_t count = blocks_[0] * blocks_[1] * blocks_[2];
  // Every cell counts its volume; those on the surface are about half empty.
  double area = 0;
  for (const auto& t : surface.mesh().triangles) {
    const auto& v = surface.mesh().vertices;
    area += vec::norm(vec::cross(vec::sub(v[t[1]], v[t[0]]), vec::sub(v[t[2]], v[t[0]]))) / 2;
  }
  const double d = grid.spacing;
  const double least = std::abs(signed_volume(surface.mesh())) / (d * d * d), most = static_cast<double>(max_cells);
  const double needed = std::max(1.0, least + 0.75 * area / (d * d));
  const auto too_many = [&](double cells, const char* about) {
    return Error(ErrorCode::bad_input,
                 fmt::format("lattice spacing {} m needs {}{:.0f} cells; at most {} are allowed (choose a larger spacing)", d,
                             about, cells, max_cells));
  };
  // Before anything is filled: full cells alone are too many, or the estimate is far off what is allowed.
  if (least > most * (1 + 1e-6)) throw too_many(least, "at least ");
  if (needed > 1.5 * most || count > 100'000'000) throw too_many(needed, "about ");
  std::vector<std::vector<CellPart>> filled(static_cast<std::size_t>(count));
  std::atomic<std::int64_t> total{0}, windings{0};
  parallel_for(count, [&](std::int64_t b) {
    if (total > 2 * max_cells + 1000) return;  // hopeless: do not fill the memory first
    BlockFiller filler(surface, grid);
    filler.fill(
        {static_cast<std::int32_t>(b % blocks_[0] * kBlock), static_cast<std::int32_t>(b / blocks_[0] % blocks_[1] * kBlock),
         static_cast<std::int32_t>(b / (blocks_[0] * blocks_[1]) * kBlock)},
        kBlock);
    std::stable_sort(filler.parts.begin(), filler.parts.end(), before);
    total += static_cast<std::int64_t>(filler.parts.size());
    windings += filler.sampler.work();
    filled[b] = std::move(filler.parts);
  });
  if (total > 2 * max_cells + 1000) throw too_many(std::max(needed, static_cast<double>(total)), "about ");
  if (total > max_cells) throw too_many(static_cast<double>(total), "");
  work = total + windings;
  list.reserve(static_cast<std::size_t>(total));
  std::vector<std::size_t> cursor(filled.size(), 0);
  for (std::int32_t k = 0; k < grid.size[2]; ++k) {
    for (std::int32_t j = 0; j < grid.size[1]; ++j) {
      for (std::int32_t bi = 0; bi < blocks_[0]; ++bi) {
        const std::int64_t b = block_of({bi * kBlock, j, k});
        std::vector<CellPart>& block = filled[b];
        for (std::size_t& c = cursor[b]; c < block.size() && block[c].index[2] == k && block[c].index[1] == j; ++c) {
          list.push_back(block[c]);
        }
        if (cursor[b] == block.size()) std::vector<CellPart>().swap(block);
      }
    }
  }
  if (list.empty()) keep_touched(surface, grid, list);
  index_cells();
}

std::int64_t Parts::block_of(const Index& cell) const {
  return cell[0] / kBlock + blocks_[0] * (cell[1] / kBlock + blocks_[1] * static_cast<std::int64_t>(cell[2] / kBlock));
}

void Parts::index_cells() {
  first_.assign(static_cast<std::size_t>(blocks_[0] * blocks_[1] * blocks_[2]), {});
  for (std::size_t p = list.size(); p-- > 0;) {
    const Index& c = list[p].index;
    auto& block = first_[block_of(c)];
    if (block.empty()) block.assign(kBlock * kBlock * kBlock, -1);
    block[c[0] % kBlock + kBlock * (c[1] % kBlock + kBlock * (c[2] % kBlock))] = static_cast<std::int32_t>(p);
  }
}

std::pair<std::int32_t, std::int32_t> Parts::of(const Index& cell) const {
  if (!grid_.contains(cell)) return {0, 0};
  const auto& block = first_[block_of(cell)];
  if (block.empty()) return {0, 0};
  const std::int32_t first = block[cell[0] % kBlock + kBlock * (cell[1] % kBlock + kBlock * (cell[2] % kBlock))];
  if (first < 0) return {0, 0};
  std::int32_t last = first + 1;
  while (last < static_cast<std::int32_t>(list.size()) && list[last].index == cell) ++last;
  return {first, last};
}

void Parts::remove(const std::vector<char>& drop) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < list.size(); ++p) {
    if (drop[p] == 0) list[kept++] = list[p];
  }
  if (kept == 0 || kept == list.size()) return;  // never drop the last of it
  list.resize(kept);
  index_cells();
}

}  // namespace pliant
