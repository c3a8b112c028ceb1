// Buffers and passes of networks: the springs of bodies, whose ends are nodes (kernels/links/spring_node.cl).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "schedule/links/spring_numbers.h"
#include "schedule/program_builder.h"

namespace pliant {
namespace {

bool between_nodes(const LinkPoints& points, const SpringBatch& b) {
  const auto is_node = [&](std::int32_t p) { return points.weights[p][0] == 1; };
  return b.body >= 0 && !b.bars &&
         std::all_of(b.points.begin(), b.points.end(), [&](const auto& ends) { return is_node(ends[0]) && is_node(ends[1]); });
}

/// Moves points that the remaining links use into a list of their own.
class KeptPoints {
 public:
  KeptPoints(const LinkPoints& from, LinkPoints& to) : from_(from), to_(to), number_(from.size(), -1) {}
  template <std::size_t N>
  void renumber(std::vector<std::array<std::int32_t, N>>& points) {
    for (auto& ends : points) {
      for (std::int32_t& p : ends) p = kept(p);
    }
  }

 private:
  std::int32_t kept(std::int32_t p) {
    if (number_[p] < 0) {
      number_[p] = static_cast<std::int32_t>(to_.size());
      to_.rest.push_back(from_.rest[p]);
      to_.slots.push_back(from_.slots[p]);
      to_.weights.push_back(from_.weights[p]);
    }
    return number_[p];
  }
  const LinkPoints& from_;
  LinkPoints& to_;
  std::vector<std::int32_t> number_;
};

/// The springs at each node of a batch, 2 spring + which of its ends the node is, in the order of the batch.
struct NodeSprings {
  std::vector<std::int32_t> node;                  ///< points
  std::vector<std::vector<std::int32_t>> springs;  ///< per node, padded with empty lists to whole tiles
};

/// Nodes with as many springs stand together, so that the rows of a tile are full, but not far from their neighbours.
NodeSprings springs_at_nodes(const SpringBatch& b, std::size_t points) {
  constexpr std::size_t window = 512;
  std::vector<std::vector<std::int32_t>> at(points);
  for (std::size_t s = 0; s < b.size(); ++s) {
    for (std::size_t k = 0; k < 2; ++k) at[b.points[s][k]].push_back(static_cast<std::int32_t>(2 * s + k));
  }
  NodeSprings out;
  for (std::size_t p = 0; p < points; ++p) {
    if (!at[p].empty()) out.node.push_back(static_cast<std::int32_t>(p));
  }
  for (std::size_t first = 0; first < out.node.size(); first += window) {
    const auto begin = out.node.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = out.node.begin() + static_cast<std::ptrdiff_t>(std::min(first + window, out.node.size()));
    std::stable_sort(begin, end, [&](std::int32_t p, std::int32_t q) { return at[p].size() > at[q].size(); });
  }
  for (const std::int32_t p : out.node) out.springs.push_back(std::move(at[p]));
  out.springs.resize(static_cast<std::size_t>(padded(out.node.size())));
  return out;
}

bool has_first(const SpringBatch& b) { return b.law.law == SpringLaw::cubic || b.law.law == SpringLaw::measured; }

std::size_t planes_of(const SpringBatch& b) { return 6 + (has_first(b) ? 1 : 0) + (b.damped() ? 1 : 0); }

/// Slot of the other end. `entry`: 2 spring + end.
std::int32_t other_end(const LinkPoints& points, const SpringBatch& b, std::int32_t entry) {
  return points.slots[b.points[static_cast<std::size_t>(entry / 2)][entry % 2 > 0 ? 0 : 1]][0];
}

/// Numbers of the kernel for one end of a spring. -1: of a spring without a length from a node to itself.
std::vector<double> node_record(const LinkPoints& points, const SpringBatch& b, std::int32_t entry) {
  SpringRecord r;
  r.second = 1;
  if (entry >= 0) r = spring_record(points, b, static_cast<std::size_t>(entry / 2));
  if (entry % 2 > 0) r.rest = vec::mul(r.rest, -1);
  std::vector<double> out{r.rest[0], r.rest[1], r.rest[2], r.length, r.squares, r.second};
  if (has_first(b)) out.push_back(r.first);
  if (b.damped()) out.push_back(r.damper);
  return out;
}

}  // namespace

SpringRecord spring_record(const LinkPoints& points, const SpringBatch& b, std::size_t s) {
  const Vec3d d = vec::sub(points.rest[b.points[s][1]], points.rest[b.points[s][0]]);
  const double l = b.length[s];
  return {d, l, vec::dot(d, d) - l * l, b.parameters[s][0], b.parameters[s][1], b.damper[s]};
}

std::vector<std::pair<std::string, int>> spring_defines(const SpringBatch& b) {
  return {{"LAW", static_cast<int>(b.law.law)}, {"SLACK", b.law.slack ? 1 : 0}, {"VISCOUS", b.damped() ? 1 : 0}};
}

std::pair<BufferId, std::int32_t> ProgramBuilder::add_spring_curve(const Spring& law, std::string name) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k + 1 < law.curve.size(); ++k) {
    const auto &from = law.curve[k], &to = law.curve[k + 1];
    numbers.insert(numbers.end(), {from[0], from[1], (to[1] - from[1]) / (to[0] - from[0])});
  }
  if (numbers.empty()) numbers.assign(3, 0.0);  // of the laws without one
  const std::size_t size = numbers.size();
  return {add(make_reals(std::move(name), BufferType::real, size, BufferRole::constant, "[segments][3]", "m, N, N/m", "model",
                         std::move(numbers))),
          static_cast<std::int32_t>(size / 3)};
}

std::vector<std::int32_t> ProgramBuilder::load_nodes(const std::vector<std::int32_t>& slots) {
  const auto count = static_cast<std::size_t>(padded(slots.size()));
  std::vector<std::int32_t> out(2 * count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t slot = slots[std::min(i, slots.size() - 1)];
    out[tile_base(i, 2)] = slot;
    if (i < slots.size()) out[tile_base(i, 2) + PLIANT_TILE] = loaded_[slot] != 0 ? 1 : 0;
  }
  for (const std::int32_t slot : slots) loaded_[slot] = 1;
  return out;
}

Links ProgramBuilder::add_networks() {
  const Links& all = model_.links;
  Links rest;
  for (std::size_t i = 0; i < all.springs.size(); ++i) {
    const SpringBatch whole = all.springs[i].without_broken();
    if (whole.size() == 0) continue;
    if (between_nodes(all.points, whole)) {
      add_network(whole, i);
    } else {
      rest.springs.push_back(whole);
    }
  }
  rest.membranes = all.membranes;
  KeptPoints kept(all.points, rest.points);
  for (SpringBatch& b : rest.springs) kept.renumber(b.points);
  for (MembraneBatch& b : rest.membranes) kept.renumber(b.points);
  return rest;
}

void ProgramBuilder::add_network(const SpringBatch& b, std::size_t index) {
  const LinkPoints& points = model_.links.points;
  const NodeSprings nodes = springs_at_nodes(b, points.size());
  std::vector<std::int32_t> slots;
  for (const std::int32_t p : nodes.node) slots.push_back(points.slots[p][0]);
  GatherList list = pack_rows(nodes.springs, -1);
  const std::size_t entries = list.index.size(), planes = planes_of(b);
  std::vector<std::int32_t> lists = load_nodes(slots), end(entries);
  std::vector<double> data(planes * entries);
  for (std::size_t tile = 0; tile + 1 < list.offset.size(); ++tile) {
    const std::int32_t* own = &lists[2 * PLIANT_TILE * tile];
    for (std::int32_t i = list.offset[tile] * PLIANT_TILE; i < list.offset[tile + 1] * PLIANT_TILE; ++i) {
      end[i] = list.index[i] < 0 ? own[i % PLIANT_TILE] : other_end(points, b, list.index[i]);
      const std::vector<double> record = node_record(points, b, list.index[i]);
      for (std::size_t k = 0; k < planes; ++k) {
        data[tile_base(static_cast<std::size_t>(i), planes) + k * PLIANT_TILE] = record[k];
      }
    }
  }
  const double each = double(entries) / double(b.size());  // about two
  const auto name = [&](const char* stem) { return fmt::format("{}/{}", stem, index); };
  const auto node_id = add(make_ints(name("network_node"), BufferRole::constant, "[tiles][2][16]", std::move(lists)));
  const auto offset_id = add(make_ints(name("network_offset"), BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
  const auto end_id = add(make_ints(name("network_end"), BufferRole::constant, "[rows][16]", std::move(end)));
  const auto data_id = add(make_reals(name("network_data"), BufferType::real, planes * entries, BufferRole::constant,
                                      "[rows][planes][16]", "m, N/m", "model", std::move(data)));
  const auto [curve_id, segments] = add_spring_curve(b.law, name("network_curve"));
  program_.step.push_back({"spring_node",
                           spring_defines(b),
                           {buffer_arg(node_load_), buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(node_id),
                            buffer_arg(offset_id), buffer_arg(end_id), buffer_arg(data_id), buffer_arg(curve_id),
                            buffer_arg(params_), int_arg(segments), int_arg(static_cast<std::int32_t>(planes))},
                           Shape::lanes,
                           static_cast<std::int64_t>(nodes.springs.size()),
                           b.label,
                           static_cast<std::int64_t>(b.size()),
                           each * (4 + 4.0 * double(planes)) + 40 * double(slots.size()) / double(b.size()),
                           each * (b.damped() ? 48.0 : 37.0)});
}

}  // namespace pliant
