// Grows the operational region of a hybrid body over faces of cells.
#include "model/matching/partition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "geometry/vec.h"
#include "model/nodes/whereabouts.h"
#include "pliant/error.h"

namespace pliant {
namespace {

// The corners of the face of a cell on each side (-x, +x, -y, +y, -z, +z). Corner a of a face meets corner a ^ (1 << axis) of
// the cell on the other side.
constexpr std::array<std::array<int, 4>, 6> kFace{
    {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

class CellFaces {
 public:
  explicit CellFaces(const Lattice& lattice) : cells_(lattice.cells), begin_(lattice.nodes.size() + 1, 0) {
    for (const Cell& c : cells_) {
      for (const std::int32_t n : c.nodes) ++begin_[n + 1];
    }
    for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
    list_.resize(begin_.back());
    std::vector<std::int64_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      for (const std::int32_t n : cells_[c].nodes) list_[next[n]++] = static_cast<std::int32_t>(c);
    }
  }

  // Calls work(other) for every cell that shares the four nodes of a face with `cell`.
  template <class Work>
  void for_neighbours(std::int32_t cell, const Work& work) const {
    const auto& mine = cells_[cell].nodes;
    for (int side = 0; side < 6; ++side) {
      const int across = 1 << (side / 2);
      const std::int32_t pivot = mine[kFace[side][0]];
      for (std::int64_t at = begin_[pivot]; at < begin_[pivot + 1]; ++at) {
        const auto& theirs = cells_[list_[at]].nodes;
        const auto meets = [&](int a) { return mine[a] == theirs[a ^ across]; };
        if (std::all_of(kFace[side].begin(), kFace[side].end(), meets)) work(list_[at]);
      }
    }
  }

 private:
  const std::vector<Cell>& cells_;
  std::vector<std::int64_t> begin_;  // per node, into list_
  std::vector<std::int32_t> list_;   // cells of each node
};

Vec3d centre_of(const Lattice& lattice, const Cell& cell) {
  Vec3d p{};
  for (int a = 0; a < 3; ++a) p[a] = lattice.origin[a] + lattice.spacing * (cell.index[a] + 0.5);
  return p;
}

// Bounding box of the cells.
vec::Box extent(const Lattice& lattice) {
  vec::Box box;
  for (const LatticeNode& n : lattice.nodes) box.extend(lattice.position(n));
  return box;
}

std::string range_text(const vec::Box& box) {
  return fmt::format("({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", box.lower[0], box.lower[1], box.lower[2], box.upper[0],
                     box.upper[1], box.upper[2]);
}

// Start of the growth: a point in units of cells from the origin of the lattice, and the nearest cell.
struct Start {
  Vec3d point{};
  std::int32_t cell = 0;
};

double distance2(const Cell& cell, const Vec3d& point) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += (cell.index[a] + 0.5 - point[a]) * (cell.index[a] + 0.5 - point[a]);
  return sum;
}

Start start_of(const DeformationModel& model, const Lattice& lattice) {
  Start start;
  if (model.seed) {
    for (int a = 0; a < 3; ++a) start.point[a] = ((*model.seed)[a] - lattice.origin[a]) / lattice.spacing;
  } else if (!lattice.embedding.empty()) {
    const Embedding& e = lattice.embedding[0];
    for (int a = 0; a < 3; ++a) start.point[a] = lattice.cells[e.cell].index[a] + e.local[a];
  }
  double nearest = HUGE_VAL;
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    const double d = distance2(lattice.cells[c], start.point);
    if (d < nearest) {
      nearest = d;
      start.cell = static_cast<std::int32_t>(c);
    }
  }
  // Of several copies of a cell, use the one that contains the vertex.
  if (!model.seed && !lattice.embedding.empty() &&
      distance2(lattice.cells[lattice.embedding[0].cell], start.point) <= nearest) {
    start.cell = lattice.embedding[0].cell;
  }
  const vec::Box box = extent(lattice);
  const double reach = vec::norm(vec::sub(box.upper, box.lower)), away = std::sqrt(nearest) * lattice.spacing;
  if (model.seed && !(away <= reach)) {
    const Vec3d& s = *model.seed;
    throw Error(
        ErrorCode::bad_input,
        fmt::format("{}/seed ({:g}, {:g}, {:g}) lies {:g} m from the body, which reaches from {} m; allowed is up to {:g} m",
                    model.pointer, s[0], s[1], s[2], away, range_text(box), reach));
  }
  return start;
}

void grow(const DeformationModel& model, const Lattice& lattice, const CellFaces& faces, std::vector<char>& operational) {
  const double target = model.ratio * static_cast<double>(lattice.nodes.size());
  const Start start = start_of(model, lattice);
  using Entry = std::pair<double, std::int32_t>;  // squared distance, cell
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::vector<char> queued(lattice.cells.size(), 0), counted(lattice.nodes.size(), 0);
  const auto push = [&](std::int32_t c) {
    if (queued[c] != 0) return;
    queued[c] = 1;
    front.emplace(distance2(lattice.cells[c], start.point), c);
  };
  push(start.cell);
  std::int64_t count = 0;
  while (!front.empty() && static_cast<double>(count) < target) {
    const std::int32_t c = front.top().second;
    front.pop();
    const auto& nodes = lattice.cells[c].nodes;
    const auto more = std::count_if(nodes.begin(), nodes.end(), [&](std::int32_t n) { return counted[n] == 0; });
    // Stop if one more cell would overshoot by more than the current deficit. The first cell is always added, so that a
    // requested operational region is not empty.
    if (count > 0 && static_cast<double>(count + more) - target > target - static_cast<double>(count)) break;
    for (const std::int32_t n : nodes) counted[n] = 1;
    count += more;
    operational[c] = 1;
    faces.for_neighbours(c, push);
  }
}

void choose_inside(const DeformationModel& model, const Lattice& lattice, std::vector<char>& operational) {
  const Selection& region = *model.region;
  bool any = false;
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    const bool inside = region.contains(centre_of(lattice, lattice.cells[c]), static_cast<std::int64_t>(c));
    operational[c] = inside ? 1 : 0;
    any = any || inside;
  }
  if (any) return;
  std::string given;
  if (region.kind == Selection::Kind::box) given = fmt::format("the box {} m ", range_text({region.a, region.b}));
  if (region.kind == Selection::Kind::sphere) {
    given = fmt::format("the sphere of radius {:g} m around ({:g}, {:g}, {:g}) ", region.radius, region.a[0], region.a[1],
                        region.a[2]);
  }
  NearestPoint nearest(region);
  for (const Cell& cell : lattice.cells) nearest.add(centre_of(lattice, cell));
  throw Error(ErrorCode::bad_input,
              fmt::format("{}: {}holds no centre of a cell; the body reaches from {} m in cells of {:g} m{}", region.pointer,
                          given, range_text(extent(lattice)), lattice.spacing, nearest.text("centre")));
}

void classify(const Lattice& lattice, Partition& partition) {
  std::vector<char> on(lattice.nodes.size(), 0);  // 1: on an operational cell, 2: on a shape-matching cell
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    const int bit = partition.operational[c] != 0 ? 1 : 2;
    for (const std::int32_t n : lattice.cells[c].nodes) on[n] = static_cast<char>(on[n] | bit);
  }
  partition.kind.resize(on.size());
  for (std::size_t n = 0; n < on.size(); ++n) {
    partition.kind[n] = on[n] == 1 ? NodeKind::operational : on[n] == 2 ? NodeKind::matching : NodeKind::interface;
  }
}

// Makes groups of shape-matching cells without a node of their own operational. One round suffices: such a group contains no
// node of kind `matching`, so it takes none from another group.
void absorb_isolated(const Lattice& lattice, const CellFaces& faces, Partition& partition) {
  std::vector<char> seen(partition.operational);
  std::vector<std::int32_t> group;
  for (std::size_t first = 0; first < lattice.cells.size(); ++first) {
    if (seen[first] != 0) continue;
    seen[first] = 1;
    group.assign(1, static_cast<std::int32_t>(first));
    bool isolated = true;
    for (std::size_t g = 0; g < group.size(); ++g) {
      const std::int32_t cell = group[g];
      for (const std::int32_t n : lattice.cells[cell].nodes) isolated = isolated && partition.kind[n] != NodeKind::matching;
      faces.for_neighbours(cell, [&](std::int32_t other) {
        if (seen[other] != 0) return;
        seen[other] = 1;
        group.push_back(other);
      });
    }
    if (!isolated) continue;
    for (const std::int32_t cell : group) partition.operational[cell] = 1;
  }
}

}  // namespace

Partition partition_lattice(const Body& body, const Lattice& lattice) {
  const DeformationModel& model = body.model;
  Partition partition;
  const bool all = model.type == ModelType::tled || (model.type == ModelType::hybrid && !model.region && model.ratio == 1);
  partition.operational.assign(lattice.cells.size(), all ? 1 : 0);
  if (model.type == ModelType::hybrid && !all) {
    if (!model.region && !(model.ratio >= 0 && model.ratio <= 1)) {
      throw Error(ErrorCode::bad_input, fmt::format("{}/ratio is {:g}; allowed is 0 to 1", model.pointer, model.ratio));
    }
    const CellFaces faces(lattice);
    if (model.cells) {
      for (const std::int32_t c : *model.cells) partition.operational[static_cast<std::size_t>(c)] = 1;
    } else if (model.region) {
      choose_inside(model, lattice, partition.operational);
    } else {
      grow(model, lattice, faces, partition.operational);
    }
    classify(lattice, partition);
    absorb_isolated(lattice, faces, partition);
  }
  classify(lattice, partition);
  for (const NodeKind kind : partition.kind) {
    ++(kind == NodeKind::operational ? partition.operational_nodes
       : kind == NodeKind::matching  ? partition.matching_nodes
                                     : partition.interface_nodes);
  }
  return partition;
}

}  // namespace pliant
