// Buffers and passes of links: displacements of their points, forces of each kind, and the sums at the nodes.
#include <fmt/format.h>

#include <algorithm>
#include <map>

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

/// Slots that the pass node_load writes.
std::vector<std::int32_t> written_loads(const Program& program) {
  const BufferId id = program.find("load_node");
  return id < 0 ? std::vector<std::int32_t>{} : program.at(id).ints;
}

bool moves(const Links& links) {
  return std::any_of(links.springs.begin(), links.springs.end(), [](const SpringBatch& b) { return b.damped(); });
}

std::vector<double> spring_numbers(const SpringBatch& b, const LinkPoints& points, std::size_t count) {
  std::vector<double> data(PLIANT_SPRING_PLANES * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t s = std::min(i, b.size() - 1);  // padding repeats the last one, whose copies nobody gathers
    const Vec3d d = vec::sub(points.rest[b.points[s][1]], points.rest[b.points[s][0]]);
    const double l = b.length[s];
    const std::array<double, PLIANT_SPRING_PLANES> record{
        d[0], d[1], d[2], l, vec::dot(d, d) - l * l, b.parameters[s][0], b.parameters[s][1], b.damper[s]};
    for (std::size_t k = 0; k < record.size(); ++k) data[tile_base(i, record.size()) + k * PLIANT_TILE] = record[k];
  }
  return data;
}

/// [segments][3] e, F and slope of each line of a curve; one row of zeros for the other laws.
std::vector<double> curve_numbers(const Spring& law) {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < law.curve.size(); ++k) {
    const auto &from = law.curve[k], &to = law.curve[k + 1];
    out.insert(out.end(), {from[0], from[1], (to[1] - from[1]) / (to[0] - from[0])});
  }
  if (out.empty()) out.assign(3, 0.0);
  return out;
}

}  // namespace

void ProgramBuilder::add_links() {
  const Links& links = model_.links;
  if (links.empty()) return;
  std::vector<std::int32_t> base;  // of each batch in link_force
  std::int32_t numbers = 0;
  std::vector<SpringBatch> whole;
  for (const SpringBatch& b : links.springs) {
    base.push_back(numbers);
    whole.push_back(b.without_broken());
    numbers += 3 * padded(whole.back().size());
  }
  for (const MembraneBatch& b : links.membranes) {
    base.push_back(numbers);
    numbers += PLIANT_MEMBRANE_FORCE_PLANES * padded(b.size());
  }
  link_force_ = add(make_reals("link_force", BufferType::real, static_cast<std::size_t>(numbers) + 3 * PLIANT_TILE,
                               BufferRole::scratch, "[tiles][points][3][16]", "N", "spring_force, membrane_force"));
  program_.buffers[link_force_].fixed = 3 * PLIANT_TILE;  // zeros that pad the lists of link_gather
  add_link_points();
  LinkForces forces(links.points.size());
  for (std::size_t b = 0; b < whole.size(); ++b) {
    if (whole[b].size() > 0) add_springs(whole[b], b, base[b], forces);
  }
  for (std::size_t m = 0; m < links.membranes.size(); ++m) add_membrane(m, base[whole.size() + m], forces);
  add_link_gather(forces, numbers);
}

void ProgramBuilder::add_link_points() {
  const LinkPoints& points = model_.links.points;
  const auto count = static_cast<std::size_t>(padded(points.size()));
  PointRows rows = point_rows(points);
  const bool moving = moves(model_.links);
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

void ProgramBuilder::add_springs(const SpringBatch& b, std::size_t index, std::int32_t base, LinkForces& forces) {
  const auto count = static_cast<std::size_t>(padded(b.size()));
  std::vector<std::int32_t> ends(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 2; ++k) ends[tile_base(i, 2) + k * PLIANT_TILE] = b.points[std::min(i, b.size() - 1)][k];
  }
  for (std::size_t s = 0; s < b.size(); ++s) {
    const std::int32_t position = base + static_cast<std::int32_t>(tile_base(s, 3));
    forces[b.points[s][0]].push_back({position, 1});
    forces[b.points[s][1]].push_back({position, -1});
  }
  const auto ends_id = add(make_ints(fmt::format("spring_points/{}", index), BufferRole::constant, "[tiles][2][16]", ends));
  const auto data_id =
      add(make_reals(fmt::format("spring_data/{}", index), BufferType::real, PLIANT_SPRING_PLANES * count, BufferRole::constant,
                     "[tiles][8][16]", "m, N/m", "model", spring_numbers(b, model_.links.points, count)));
  std::vector<double> curve = curve_numbers(b.law);
  const std::size_t curve_size = curve.size();
  const auto segments = static_cast<std::int32_t>(curve_size / 3);
  const auto curve_id = add(make_reals(fmt::format("spring_curve/{}", index), BufferType::real, curve_size,
                                       BufferRole::constant, "[segments][3]", "m, N, N/m", "model", std::move(curve)));
  program_.step.push_back(
      {"spring_force",
       {{"LAW", static_cast<int>(b.law.law)}, {"SLACK", b.law.slack ? 1 : 0}, {"VISCOUS", b.damped() ? 1 : 0}},
       {buffer_arg(link_u_), buffer_arg(link_w_), buffer_arg(ends_id), buffer_arg(data_id), buffer_arg(curve_id),
        buffer_arg(link_force_), buffer_arg(params_), int_arg(segments), int_arg(base)},
       Shape::lanes,
       static_cast<std::int64_t>(count),
       b.label,
       static_cast<std::int64_t>(b.size()),
       8 + 4.0 * PLIANT_SPRING_PLANES + 12 + 16.0 * double(model_.links.points.size()) / double(b.size()),
       b.damped() ? 42.0 : 31.0});
}

void ProgramBuilder::add_link_gather(const LinkForces& forces, std::int32_t zero) {
  const LinkPoints& points = model_.links.points;
  struct Entry {
    std::int32_t position;
    double weight;
  };
  std::map<std::int32_t, std::vector<Entry>> at;  // by slot
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t a = 0; a < 8; ++a) {
      if (points.weights[p][a] == 0) continue;
      std::vector<Entry>& of = at[points.slots[p][a]];
      for (const PointForce& f : forces[p]) of.push_back({f.position, f.sign * points.weights[p][a]});
    }
  }
  const std::vector<std::int32_t> written = written_loads(program_);
  const auto count = static_cast<std::size_t>(padded(at.size()));
  std::vector<std::int32_t> node;
  std::vector<Entry> entries;
  std::vector<std::vector<std::int32_t>> rows(count);
  for (auto& [slot, of] : at) {
    std::stable_sort(of.begin(), of.end(), [](const Entry& x, const Entry& y) { return x.position < y.position; });
    for (const Entry& e : of) {
      rows[node.size()].push_back(static_cast<std::int32_t>(entries.size()));
      entries.push_back(e);
    }
    node.push_back(2 * slot + (std::binary_search(written.begin(), written.end(), slot) ? 1 : 0));
  }
  node.resize(count, -1);
  GatherList list = pack_rows(rows, -1);
  std::vector<double> weight;
  for (std::int32_t& entry : list.index) {
    weight.push_back(entry < 0 ? 0 : entries[entry].weight);
    entry = entry < 0 ? zero : entries[entry].position;
  }
  const std::size_t length = weight.size();
  const double each = double(entries.size()) / double(at.size());
  const auto node_id = add(make_ints("link_node", BufferRole::constant, "[nodes]", std::move(node)));
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
                           20 * each + 20,
                           6 * each});
}

}  // namespace pliant
