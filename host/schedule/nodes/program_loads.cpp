// Buffers and passes of the external forces: pressure, nodal forces, corners on brick nodes.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "schedule/program_builder.h"
#include "schedule/surface_program.h"

namespace pliant {

void ProgramBuilder::add_surface() {
  if (model_.pressures.empty()) return;  // no step needs it
  Program surface = surface_program(model_.surface, program_);
  for (Buffer& buffer : surface.buffers) add(std::move(buffer));
  program_.step = std::move(surface.step);
  surface_x_ = program_.find("surface_x");
}

void ProgramBuilder::add_pressure_passes() {
  if (model_.pressures.empty()) {
    pressure_ =
        add(make_reals("pressure_force", BufferType::real4, 1, BufferRole::scratch, "[triangles]", "N", "pressure_force"));
    return;
  }
  std::vector<std::int32_t> triangle, curve;
  std::vector<double> value;
  for (const TrianglePressure& p : model_.pressures) {
    for (const std::int32_t v : model_.surface.triangles[p.triangle]) triangle.push_back(v);
    value.push_back(p.pressure);
    curve.push_back(p.curve);
  }
  const std::size_t count = value.size();
  const auto triangle_id = add(make_ints("pressure_triangle", BufferRole::constant, "[triangles][3]", std::move(triangle)));
  const auto value_id = add(make_reals("pressure_value", BufferType::real, count, BufferRole::constant, "[triangles]", "Pa",
                                       "model", std::move(value)));
  const auto curve_id = add(make_ints("pressure_curve", BufferRole::constant, "[triangles]", std::move(curve)));
  pressure_ =
      add(make_reals("pressure_force", BufferType::real4, count, BufferRole::scratch, "[triangles]", "N", "pressure_force"));
  program_.step.push_back({"pressure_force",
                           {},
                           {buffer_arg(surface_x_), buffer_arg(triangle_id), buffer_arg(value_id), buffer_arg(curve_id),
                            buffer_arg(pressure_), buffer_arg(curves_), int_arg(curve_count()), step_arg()},
                           Shape::items,
                           static_cast<std::int64_t>(count),
                           "pressure",
                           static_cast<std::int64_t>(count),
                           84,
                           22});
}

std::vector<std::pair<std::int32_t, std::int32_t>> ProgramBuilder::brick_corners() const {
  // Counting sort: a cut body has thousands of them, few at each slot.
  std::vector<std::int32_t> next(static_cast<std::size_t>(model_.list_base) + 1, 0);
  const auto for_corners = [&](auto&& visit) {
    for (std::size_t b = 0; b < model_.batches.size(); ++b) {
      for (std::size_t e = 0; e < model_.batches[b].size(); ++e) {
        const auto slots = model_.batches[b].nodes_of(e);
        for (std::size_t a = 0; a < slots.size(); ++a) {
          if (slots[a] < model_.list_base) visit(slots[a], b, e, static_cast<int>(a));
        }
      }
    }
  };
  for_corners([&](std::int32_t slot, std::size_t, std::size_t, int) { ++next[slot + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::pair<std::int32_t, std::int32_t>> found(static_cast<std::size_t>(next.back()));
  for_corners([&](std::int32_t slot, std::size_t b, std::size_t e, int a) {
    found[next[slot]++] = {slot, corner_position(layout_.batches[b], e, a, model_.batches[b].info().force)};
  });
  for (std::size_t i = 1; i < found.size(); ++i) {
    for (std::size_t k = i; k > 0 && found[k] < found[k - 1]; --k) std::swap(found[k], found[k - 1]);
  }
  return found;
}

void ProgramBuilder::add_loads() {
  if (!needs_load()) return;
  // Shares of triangles: a third of each corner's embedding weights.
  std::vector<std::tuple<std::int32_t, std::int32_t, double>> shares;
  for (std::size_t t = 0; t < model_.pressures.size(); ++t) {
    for (const std::int32_t v : model_.surface.triangles[model_.pressures[t].triangle]) {
      for (int a = 0; a < 8; ++a) {
        const double weight = model_.surface.weights[v][a] / 3;
        if (weight != 0) shares.emplace_back(model_.surface.nodes[v][a], static_cast<std::int32_t>(t), weight);
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  std::vector<std::int32_t> slots;
  for (const NodeForce& f : model_.forces) slots.push_back(f.slot);
  for (const auto& s : shares) slots.push_back(std::get<0>(s));
  for (const auto& c : brick_corners_) slots.push_back(c.first);
  // flsm_interface adds to these, so node_load rewrites them in every step.
  for (const FlsmBatch& b : model_.flsm) slots.insert(slots.end(), b.slot.begin() + b.own, b.slot.end());
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  if (slots.empty()) return;  // links alone, which write what they load
  std::vector<std::int32_t> offset, curve, triangle, corner;
  std::vector<double> force, weight;
  std::size_t f = 0, s = 0, c = 0;
  const auto mark = [&] {
    offset.push_back(static_cast<std::int32_t>(f));
    offset.push_back(static_cast<std::int32_t>(s));
    offset.push_back(static_cast<std::int32_t>(c));
  };
  mark();
  for (const std::int32_t slot : slots) {
    for (; f < model_.forces.size() && model_.forces[f].slot == slot; ++f) {
      const Vec3d& v = model_.forces[f].force;
      force.insert(force.end(), {v[0], v[1], v[2], 0.0});
      curve.push_back(model_.forces[f].curve);
    }
    for (; s < shares.size() && std::get<0>(shares[s]) == slot; ++s) {
      triangle.push_back(std::get<1>(shares[s]));
      weight.push_back(std::get<2>(shares[s]));
    }
    for (; c < brick_corners_.size() && brick_corners_[c].first == slot; ++c) corner.push_back(brick_corners_[c].second);
    mark();
  }
  emit_loads(slots, std::move(offset), std::move(force), std::move(curve), std::move(triangle), std::move(weight),
             std::move(corner));
}

void ProgramBuilder::emit_loads(const std::vector<std::int32_t>& slots, std::vector<std::int32_t> offset,
                                std::vector<double> force, std::vector<std::int32_t> curve, std::vector<std::int32_t> triangle,
                                std::vector<double> weight, std::vector<std::int32_t> corner) {
  const std::size_t forces = curve.size(), weights = weight.size();
  const double entries = double(forces + weights + corner.size());
  const auto count = static_cast<std::int64_t>(slots.size());
  const auto node_id = add(make_ints("load_node", BufferRole::constant, "[loaded]", slots));
  const auto offset_id = add(make_ints("load_offset", BufferRole::constant, "[loaded + 1][3]", std::move(offset)));
  const auto force_id = add(make_reals("load_force", BufferType::real4, std::max<std::size_t>(forces, 1), BufferRole::constant,
                                       "[forces]", "N", "model", std::move(force)));
  const auto curve_id = add(make_ints("load_curve", BufferRole::constant, "[forces]", std::move(curve), 1));
  const auto triangle_id = add(make_ints("load_triangle", BufferRole::constant, "[shares]", std::move(triangle), 1));
  const auto weight_id = add(make_reals("load_weight", BufferType::real, std::max<std::size_t>(weights, 1),
                                        BufferRole::constant, "[shares]", "1", "model", std::move(weight)));
  const auto corner_id = add(make_ints("load_corner", BufferRole::constant, "[corners]", std::move(corner), 1));
  program_.step.push_back(
      {"node_load",
       {},
       {buffer_arg(node_load_), buffer_arg(node_id), buffer_arg(offset_id), buffer_arg(force_id), buffer_arg(curve_id),
        buffer_arg(triangle_id), buffer_arg(weight_id), buffer_arg(corner_id), buffer_arg(pressure_),
        buffer_arg(corner_ >= 0 ? corner_ : pressure_), buffer_arg(curves_), int_arg(curve_count()), step_arg()},
       Shape::items,
       count,
       "external loads",
       count,
       28 + 24 * entries / double(count),
       6 * entries / double(count)});
}

}  // namespace pliant
