// Buffers and passes of links: displacements of their points, forces of each kind, and the sums at the nodes.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "schedule/links/spring_numbers.h"
#include "schedule/program_builder.h"

namespace pliant {
namespace {

/// Lists of all slots and weights of each point, in rows.
struct PointRows {
  GatherList slots;
  std::vector<double> weights;
};

PointRows point_rows(const LinkPoints& points) {
  const auto count = static_cast<std::size_t>(padded(points.size()));
  std::vector<std::vector<std::int32_t>> corner(count);  // 8 point + corner
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t a = 0; a < 8; ++a) {
      if (points.weights[p][a] != 0) corner[p].push_back(static_cast<std::int32_t>(8 * p + a));
    }
  }
  PointRows rows{pack_rows(corner, -1), {}};
  for (std::int32_t& entry : rows.slots.index) {
    const std::size_t p = entry < 0 ? 0 : entry / 8, a = entry < 0 ? 0 : entry % 8;
    rows.weights.push_back(entry < 0 ? 0 : points.weights[p][a]);
    entry = points.slots[p][a];
  }
  return rows;
}

/// [slots] whether the pass node_load writes them.
std::vector<char> written_loads(const Program& program, std::int32_t slots) {
  std::vector<char> out(static_cast<std::size_t>(slots));
  const BufferId id = program.find("load_node");
  if (id < 0) return out;
  for (const std::int32_t s : program.at(id).ints) {
    if (s >= 0) out[s] = 1;
  }
  return out;
}

bool moves(const Links& links) {
  return std::any_of(links.springs.begin(), links.springs.end(), [](const SpringBatch& b) { return b.damped(); });
}

}  // namespace

void ProgramBuilder::add_links() {
  if (model_.links.empty()) return;
  loaded_ = written_loads(program_, model_.slots);
  const Links links = add_networks();
  if (links.empty()) return;
  std::vector<std::int32_t> base;  // of each batch in link_force
  std::int32_t texels = 0;
  for (const SpringBatch& b : links.springs) {
    base.push_back(texels);
    texels += padded(b.size());
  }
  for (const MembraneBatch& b : links.membranes) {
    base.push_back(texels);
    texels += 3 * padded(b.size());
  }
  link_force_ = add(make_reals("link_force", BufferType::real4, static_cast<std::size_t>(texels) + 1, BufferRole::scratch,
                               "[tiles][points][16]", "N", "spring_force, membrane_force"));
  program_.buffers[link_force_].fixed = 4;  // zeros that pad the lists of link_gather
  add_link_points(links);
  LinkForces forces(links.points.size());
  for (std::size_t b = 0; b < links.springs.size(); ++b) add_springs(links, b, base[b], forces);
  for (std::size_t m = 0; m < links.membranes.size(); ++m) {
    add_membrane(links, m, base[links.springs.size() + m], forces);
  }
  add_link_gather(links.points, forces, texels);
}

void ProgramBuilder::add_link_points(const Links& links) {
  const LinkPoints& points = links.points;
  link_u_ = node_u_, link_w_ = node_w_;
  link_place_.clear();
  for (std::size_t p = 0; p < points.size(); ++p) link_place_.push_back(points.slots[p][0]);
  if (std::all_of(points.weights.begin(), points.weights.end(), [](const auto& w) { return w[0] == 1; })) return;
  std::iota(link_place_.begin(), link_place_.end(), 0);
  const auto count = static_cast<std::size_t>(padded(points.size()));
  PointRows rows = point_rows(points);
  const bool moving = moves(links);
  const std::size_t entries = rows.weights.size();
  const auto offset_id = add(make_ints("point_offset", BufferRole::constant, "[tiles + 1]", std::move(rows.slots.offset)));
  const auto slot_id = add(make_ints("point_slot", BufferRole::constant, "[rows][16]", std::move(rows.slots.index)));
  const auto weight_id = add(make_reals("point_weight", BufferType::real, entries, BufferRole::constant, "[rows][16]", "1",
                                        "model", std::move(rows.weights)));
  link_u_ = add(make_reals("link_u", BufferType::real4, count, BufferRole::scratch, "[points]", "m", "link_points"));
  link_w_ = moving ? add(make_reals("link_w", BufferType::real4, count, BufferRole::scratch, "[points]", "m", "link_points"))
                   : link_u_;
  const double each = double(entries) / double(count);
  program_.step.push_back({"link_points",
                           {{"VISCOUS", moving ? 1 : 0}},
                           {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(offset_id), buffer_arg(slot_id),
                            buffer_arg(weight_id), buffer_arg(link_u_), buffer_arg(link_w_)},
                           Shape::lanes,
                           static_cast<std::int64_t>(count),
                           "points of links",
                           static_cast<std::int64_t>(points.size()),
                           each * (moving ? 40 : 24) + (moving ? 32 : 16),
                           each * (moving ? 12 : 6)});
}

void ProgramBuilder::add_springs(const Links& links, std::size_t index, std::int32_t base, LinkForces& forces) {
  const SpringBatch& b = links.springs[index];
  const auto count = static_cast<std::size_t>(padded(b.size()));
  std::vector<std::int32_t> ends(2 * count);
  std::vector<double> data(PLIANT_SPRING_PLANES * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t s = std::min(i, b.size() - 1);  // padding repeats the last one, whose copies nobody gathers
    for (std::size_t k = 0; k < 2; ++k) ends[tile_base(i, 2) + k * PLIANT_TILE] = link_place_[b.points[s][k]];
    const SpringRecord r = spring_record(links.points, b, s);
    const std::array<double, PLIANT_SPRING_PLANES> record{r.rest[0], r.rest[1], r.rest[2], r.length,
                                                          r.squares, r.first,   r.second,  r.damper};
    for (std::size_t k = 0; k < record.size(); ++k) data[tile_base(i, record.size()) + k * PLIANT_TILE] = record[k];
  }
  for (std::size_t s = 0; s < b.size(); ++s) {
    const std::int32_t texel = base + static_cast<std::int32_t>(s);
    forces[b.points[s][0]].push_back({texel, 1});
    forces[b.points[s][1]].push_back({texel, -1});
  }
  const auto ends_id = add(make_ints(fmt::format("spring_points/{}", index), BufferRole::constant, "[tiles][2][16]", ends));
  const auto data_id = add(make_reals(fmt::format("spring_data/{}", index), BufferType::real, PLIANT_SPRING_PLANES * count,
                                      BufferRole::constant, "[tiles][8][16]", "m, N/m", "model", std::move(data)));
  const auto [curve_id, segments] = add_spring_curve(b.law, fmt::format("spring_curve/{}", index));
  program_.step.push_back(
      {"spring_force",
       spring_defines(b),
       {buffer_arg(link_u_), buffer_arg(link_w_), buffer_arg(ends_id), buffer_arg(data_id), buffer_arg(curve_id),
        buffer_arg(link_force_), buffer_arg(params_), int_arg(segments), int_arg(base)},
       Shape::lanes,
       static_cast<std::int64_t>(count),
       b.label,
       static_cast<std::int64_t>(b.size()),
       8 + 4.0 * PLIANT_SPRING_PLANES + 16 + 16.0 * double(links.points.size()) / double(b.size()),
       b.damped() ? 42.0 : 31.0});
}

void ProgramBuilder::add_link_gather(const LinkPoints& points, const LinkForces& forces, std::int32_t zero) {
  struct Entry {
    std::int32_t texel;
    double weight;
  };
  std::map<std::int32_t, std::vector<Entry>> at;  // by slot
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t a = 0; a < 8; ++a) {
      if (points.weights[p][a] == 0) continue;
      std::vector<Entry>& of = at[points.slots[p][a]];
      for (const PointForce& f : forces[p]) of.push_back({f.texel, f.sign * points.weights[p][a]});
    }
  }
  const auto count = static_cast<std::size_t>(padded(at.size()));
  std::vector<std::int32_t> slots;
  std::vector<Entry> entries;
  std::vector<std::vector<std::int32_t>> rows(count);
  for (auto& [slot, of] : at) {
    std::stable_sort(of.begin(), of.end(), [](const Entry& x, const Entry& y) { return x.texel < y.texel; });
    for (const Entry& e : of) {
      rows[slots.size()].push_back(static_cast<std::int32_t>(entries.size()));
      entries.push_back(e);
    }
    slots.push_back(slot);
  }
  GatherList list = pack_rows(rows, -1);
  std::vector<double> weight;
  for (std::int32_t& entry : list.index) {
    weight.push_back(entry < 0 ? 0 : entries[entry].weight);
    entry = entry < 0 ? zero : entries[entry].texel;
  }
  const std::size_t length = weight.size();
  const double each = double(entries.size()) / double(at.size());
  const auto node_id = add(make_ints("link_node", BufferRole::constant, "[tiles][2][16]", load_nodes(slots)));
  const auto offset_id = add(make_ints("link_offset", BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
  const auto index_id = add(make_ints("link_index", BufferRole::constant, "[rows][16]", std::move(list.index)));
  const auto weight_id = add(
      make_reals("link_weight", BufferType::real, length, BufferRole::constant, "[rows][16]", "1", "model", std::move(weight)));
  program_.step.push_back({"link_gather",
                           {},
                           {buffer_arg(node_load_), buffer_arg(node_id), buffer_arg(offset_id), buffer_arg(index_id),
                            buffer_arg(weight_id), buffer_arg(link_force_)},
                           Shape::lanes,
                           static_cast<std::int64_t>(count),
                           "links at nodes",
                           static_cast<std::int64_t>(at.size()),
                           24 * each + 40,
                           6 * each});
}

}  // namespace pliant
