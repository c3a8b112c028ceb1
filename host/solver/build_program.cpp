#include "solver/build_program.h"

#include <fmt/format.h>

#include <algorithm>

#include "solver/kernel_cost.h"
#include "solver/program_layout.h"

namespace pliant {
namespace {

int law_index(Law law) {
  switch (law) {
    case Law::neo_hookean: return PLIANT_LAW_NEO_HOOKEAN;
    case Law::saint_venant_kirchhoff: return PLIANT_LAW_SAINT_VENANT_KIRCHHOFF;
    case Law::isochoric_neo_hookean: return PLIANT_LAW_ISOCHORIC_NEO_HOOKEAN;
  }
  return -1;
}

double second_parameter(const Material& m) { return m.law == Law::isochoric_neo_hookean ? m.kappa : m.lambda; }

Buffer make_reals(std::string name, BufferType type, std::size_t count, BufferRole role, std::string shape, std::string unit,
                  std::string producer, std::vector<double> reals = {}) {
  return {std::move(name), type, count, role, std::move(shape), std::move(unit), std::move(producer), std::move(reals), {}};
}

Buffer make_ints(std::string name, BufferRole role, std::string shape, std::vector<std::int32_t> ints, std::size_t count = 0,
                 std::string producer = "model") {
  const std::size_t n = ints.empty() ? count : ints.size();
  return {std::move(name), BufferType::int32, n, role, std::move(shape), "1", std::move(producer), {}, std::move(ints)};
}

/// A gather list in rows of 16: for each tile of owners, as many rows as its fullest owner has entries, padded with `padding`.
struct GatherList {
  std::vector<std::int32_t> offset{0};
  std::vector<std::int32_t> index;
};

GatherList pack_rows(const std::vector<std::vector<std::int32_t>>& entries, std::int32_t padding) {
  GatherList list;
  for (std::size_t tile = 0; tile < entries.size() / PLIANT_TILE; ++tile) {
    const auto* own = &entries[tile * PLIANT_TILE];
    std::size_t rows = 0;
    for (int l = 0; l < PLIANT_TILE; ++l) rows = std::max(rows, own[l].size());
    for (std::size_t r = 0; r < rows; ++r) {
      for (int l = 0; l < PLIANT_TILE; ++l) list.index.push_back(r < own[l].size() ? own[l][r] : padding);
    }
    list.offset.push_back(list.offset.back() + static_cast<std::int32_t>(rows));
  }
  return list;
}

class Builder {
 public:
  Builder(const Model& model, const ProgramOptions& options) : model_(model), options_(options), layout_(lay_out(model)) {}

  Program build() {
    add_shared_buffers();
    add_surface();
    add_pressure_passes();
    for (std::size_t b = 0; b < model_.brick_batches.size(); ++b) add_bricks(model_.brick_batches[b]);
    for (std::size_t b = 0; b < model_.tets.size(); ++b) add_tets(b);
    for (std::size_t b = 0; b < model_.hexes.size(); ++b) add_hexes(b);
    add_loads();
    program_.force = program_.step;
    add_updates();
    add_constraints();
    program_.status.push_back({"fault_reduce", {}, {buffer_arg(fault_), buffer_arg(summary_), int_arg(layout_.faults)}, Shape::items,
                               256, "first fault", 0, 0, 0});
    return std::move(program_);
  }

 private:
  [[nodiscard]] bool has_list_nodes() const { return model_.slots > model_.list_base; }
  [[nodiscard]] bool has_list_elements() const { return !model_.tets.empty() || !model_.hexes.empty(); }
  [[nodiscard]] int textbook() const { return options_.integrator == Integrator::textbook ? 1 : 0; }

  BufferId add(Buffer buffer) { return program_.add(std::move(buffer)); }

  void add_shared_buffers() {
    const auto slots = static_cast<std::size_t>(model_.slots);
    std::vector<double> u(4 * slots), w(4 * slots);
    for (std::size_t s = 0; s < slots; ++s) {
      u[4 * s + 3] = model_.mass[s] > 0 ? 1 / model_.mass[s] : 0;
      w[4 * s + 3] = 1;  // the decay per step: the host writes it once the step is known
    }
    node_u_ = add(make_reals("node_u", BufferType::real4, slots, BufferRole::state, "[slots]", "m, m, m, 1/kg",
                             "node_update, brick_update, node_prescribe", std::move(u)));
    node_w_ = add(make_reals("node_w", BufferType::real4, slots, BufferRole::state, "[slots]", "m, m, m, 1",
                             "node_update, brick_update, node_prescribe", std::move(w)));
    node_force_ = add(make_reals("node_force", BufferType::real4, slots, BufferRole::scratch, "[slots]", "N",
                                 "node_update, brick_update (FORCE_ONLY)"));
    node_load_ = add(make_reals("node_load", BufferType::real4, needs_load() ? slots : 1, BufferRole::scratch, "[slots]", "N", "node_load"));
    if (has_list_elements()) {
      std::vector<double> corner(static_cast<std::size_t>(layout_.corner_numbers) + 3 * PLIANT_TILE, 0.0);
      std::fill(corner.end() - 3 * PLIANT_TILE, corner.end(), -0.0);
      const std::size_t numbers = corner.size();
      corner_ = add(make_reals("corner_force", BufferType::real, numbers, BufferRole::scratch, "[tiles][corners][3][16]", "N",
                               "element kernels", std::move(corner)));
    }
    // The state to go back to when an element fails.
    add(make_reals("last_u", BufferType::real4, slots, BufferRole::state, "[slots]", "m, m, m, 1/kg", "host"));
    add(make_reals("last_w", BufferType::real4, slots, BufferRole::state, "[slots]", "m, m, m, 1", "host"));
    fault_ = add(make_ints("fault", BufferRole::scratch, "[elements]", {}, std::max(layout_.faults, 1), "element kernels"));
    summary_ = add(make_ints("fault_summary", BufferRole::scratch, "[256][2]", {}, 512, "fault_reduce"));
    params_ = add(make_reals("step_params", BufferType::real, 8, BufferRole::control, "[8]", "s, m/s^2 (3), m", "host"));
    curves_ = add(make_reals("curve_value", BufferType::real, (static_cast<std::size_t>(options_.batch_steps) + 1) * model_.curves.size(),
                             BufferRole::control, "[steps + 1][curves]", "1", "host"));
  }

  [[nodiscard]] bool needs_load() const { return !model_.forces.empty() || !model_.pressures.empty() || !brick_corners().empty(); }
  [[nodiscard]] std::int32_t curve_count() const { return static_cast<std::int32_t>(model_.curves.size()); }

  /// (slot, position in corner_force) of list hexahedra that touch brick nodes.
  [[nodiscard]] std::vector<std::pair<std::int32_t, std::int32_t>> brick_corners() const {
    std::vector<std::pair<std::int32_t, std::int32_t>> found;
    for (std::size_t b = 0; b < model_.hexes.size(); ++b) {
      for (std::size_t e = 0; e < model_.hexes[b].nodes.size(); ++e) {
        for (int a = 0; a < 8; ++a) {
          const std::int32_t slot = model_.hexes[b].nodes[e][a];
          if (slot < model_.list_base) found.emplace_back(slot, corner_position(layout_.hexes[b], e, a, PLIANT_HEX_FORCE_PLANES));
        }
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  static std::int32_t corner_position(const BatchPlace& place, std::size_t e, int corner, int planes) {
    return place.corner_base + static_cast<std::int32_t>(tile_base(e, static_cast<std::size_t>(planes))) + 3 * corner * PLIANT_TILE;
  }

  void add_surface() {
    const ModelSurface& s = model_.surface;
    const std::size_t count = padded(s.rest.size());
    if (count == 0) return;
    bool single = true;
    for (const auto& w : s.weights) single = single && w[0] == 1 && w[1] == 0;
    const std::size_t width = single ? 1 : 8;
    std::vector<double> rest(4 * count), weight(width * count);
    std::vector<std::int32_t> node(width * count, 0);
    for (std::size_t v = 0; v < s.rest.size(); ++v) {
      for (int c = 0; c < 3; ++c) rest[4 * v + c] = s.rest[v][c];
      for (std::size_t a = 0; a < width; ++a) {
        node[tile_base(v, width) + a * PLIANT_TILE] = s.nodes[v][a];
        weight[tile_base(v, width) + a * PLIANT_TILE] = s.weights[v][a];
      }
    }
    const auto rest_id = add(make_reals("surface_rest", BufferType::real4, count, BufferRole::constant, "[vertices]", "m", "model", std::move(rest)));
    const auto node_id = add(make_ints("surface_node", BufferRole::constant, "[tiles][8][16]", std::move(node)));
    const auto weight_id = add(make_reals("surface_weight", BufferType::real, width * count, BufferRole::constant, "[tiles][8][16]", "1",
                                          "model", std::move(weight)));
    surface_x_ = add(make_reals("surface_x", BufferType::real4, count, BufferRole::scratch, "[vertices]", "m", "surface_position"));
    program_.surface.push_back({"surface_position",
                                {{"WIDTH", static_cast<int>(width)}},
                                {buffer_arg(node_u_), buffer_arg(rest_id), buffer_arg(node_id), buffer_arg(weight_id), buffer_arg(surface_x_)},
                                Shape::lanes,
                                static_cast<std::int64_t>(count),
                                "surface",
                                static_cast<std::int64_t>(s.rest.size()),
                                static_cast<double>(32 + width * 24),
                                static_cast<double>(6 * width + 3)});
  }

  void add_pressure_passes() {
    if (model_.pressures.empty()) {
      pressure_ = add(make_reals("pressure_force", BufferType::real4, 1, BufferRole::scratch, "[triangles]", "N", "pressure_force"));
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
    const auto value_id = add(make_reals("pressure_value", BufferType::real, count, BufferRole::constant, "[triangles]", "Pa", "model", std::move(value)));
    const auto curve_id = add(make_ints("pressure_curve", BufferRole::constant, "[triangles]", std::move(curve)));
    pressure_ = add(make_reals("pressure_force", BufferType::real4, count, BufferRole::scratch, "[triangles]", "N", "pressure_force"));
    program_.step.push_back(program_.surface.front());
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

  void add_bricks(const BrickBatch& b) {
    if (brick_neighbor_ < 0) {
      const auto bricks = static_cast<std::size_t>(model_.bricks) + 1;
      brick_neighbor_ = add(make_ints("brick_neighbor", BufferRole::constant, "[bricks + 1][16]", model_.brick_neighbor));
      brick_rows_ = add(make_ints("brick_rows", BufferRole::constant, "[bricks + 1][2]", model_.brick_rows));
      brick_fill_ = add(make_reals("brick_fill", BufferType::real, model_.brick_fill.size(), BufferRole::constant, "[bricks + 1][256]", "1",
                                   "model", model_.brick_fill));
      brick_force_ = add(make_reals("brick_force", BufferType::real, bricks * PLIANT_BRICK_FORCE, BufferRole::scratch, "[bricks + 1][1280]",
                                    "N", "tled_hex8_brick_force", std::vector<double>(bricks * PLIANT_BRICK_FORCE, -0.0)));
    }
    const double d = b.spacing;
    std::int64_t cells = 0;
    for (std::int32_t i = b.first * PLIANT_BRICK_NODES; i < (b.first + b.count) * PLIANT_BRICK_NODES; ++i) cells += model_.brick_cell[i] >= 0;
    const double slots_per_cell = cells == 0 ? 0 : double(b.count) * PLIANT_BRICK_NODES / double(cells);
    program_.step.push_back({"tled_hex8_brick_force",
                             {{"LAW", law_index(b.material.law)}},
                             {buffer_arg(node_u_), buffer_arg(brick_neighbor_), buffer_arg(brick_rows_), buffer_arg(brick_fill_), buffer_arg(brick_force_),
                              buffer_arg(fault_), real_arg(b.material.mu), real_arg(second_parameter(b.material)), real_arg(1 / (4 * d)),
                              real_arg(d * d / 4), real_arg(hourglass_stiffness(b.material, d * d * d)), int_arg(b.first), int_arg(0),
                              step_arg()},
                             Shape::bricks,
                             b.count,
                             fmt::format("{}: hex8 bricks {}", model_.bodies[b.body].name, to_string(b.material.law)),
                             cells,
                             brick_force_bytes() * slots_per_cell,
                             brick_force_flops(b.material.law)});
  }

  void add_tets(std::size_t index) {
    const TetBatch& b = model_.tets[index];
    const auto count = static_cast<std::size_t>(padded(b.nodes.size()));
    std::vector<std::int32_t> nodes(4 * count, model_.list_base);
    std::vector<double> data(PLIANT_TET_DATA_PLANES * count, 0.0);
    for (std::size_t e = 0; e < b.nodes.size(); ++e) {
      for (int a = 0; a < 4; ++a) nodes[tile_base(e, 4) + a * PLIANT_TILE] = b.nodes[e][a];
      for (int k = 0; k < 9; ++k) data[tile_base(e, PLIANT_TET_DATA_PLANES) + k * PLIANT_TILE] = b.gradients[e][k];
      data[tile_base(e, PLIANT_TET_DATA_PLANES) + 9 * PLIANT_TILE] = b.volume[e];
    }
    const auto nodes_id = add(make_ints(fmt::format("tet_nodes/{}", index), BufferRole::constant, "[tiles][4][16]", std::move(nodes)));
    const auto data_id = add(make_reals(fmt::format("tet_data/{}", index), BufferType::real, PLIANT_TET_DATA_PLANES * count,
                                        BufferRole::constant, "[tiles][10][16]", "1/m, m^3", "model", std::move(data)));
    const std::string label = fmt::format("{}: {} {}", model_.bodies[b.body].name, b.averaged ? "tet4anp" : "tet4", to_string(b.material.law));
    const double texels = 16.0 * (model_.slots - model_.list_base) / double(b.nodes.size());
    BufferId pressure = node_u_;  // not read
    if (b.averaged) pressure = add_averaging(index, nodes_id, data_id, count, label);
    const BatchPlace& place = layout_.tets[index];
    program_.step.push_back({"tled_tet4_force",
                             {{"LAW", law_index(b.material.law)}, {"AVERAGED", b.averaged ? 1 : 0}},
                             {buffer_arg(node_u_), buffer_arg(nodes_id), buffer_arg(data_id), buffer_arg(pressure), buffer_arg(corner_),
                              buffer_arg(fault_), real_arg(b.material.mu), real_arg(second_parameter(b.material)),
                              int_arg(place.corner_base), int_arg(place.fault_base), step_arg()},
                             Shape::lanes,
                             static_cast<std::int64_t>(count),
                             label,
                             static_cast<std::int64_t>(b.nodes.size()),
                             tet_force_bytes(b.averaged) + texels * (b.averaged ? 1.25 : 1),
                             tet_force_flops(b.material.law)});
  }

  /// The two passes before the force of tet4anp; returns the buffer of nodal pressures.
  BufferId add_averaging(std::size_t index, BufferId nodes_id, BufferId data_id, std::size_t count, const std::string& label) {
    const TetBatch& b = model_.tets[index];
    const std::int32_t nodes = model_.slots - model_.list_base;
    std::vector<std::vector<std::int32_t>> elements(nodes);
    std::vector<double> volume(nodes, 0.0), dilation(count + PLIANT_TILE, 0.0);
    std::fill(dilation.end() - PLIANT_TILE, dilation.end(), -0.0);
    for (std::size_t e = 0; e < b.nodes.size(); ++e) {
      for (const std::int32_t n : b.nodes[e]) {
        elements[n - model_.list_base].push_back(static_cast<std::int32_t>(e));
        volume[n - model_.list_base] += b.volume[e];
      }
    }
    for (double& v : volume) v = v > 0 ? 1 / v : 0;
    GatherList list = pack_rows(elements, static_cast<std::int32_t>(count));
    const double rows = double(list.index.size());
    const auto name = [&](const char* stem) { return fmt::format("{}/{}", stem, index); };
    const auto dilation_id = add(make_reals(name("anp_dilation"), BufferType::real, count + PLIANT_TILE, BufferRole::scratch, "[elements + 16]",
                                            "m^3", "tled_tet4_dilation", std::move(dilation)));
    const auto offset_id = add(make_ints(name("anp_offset"), BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
    const auto index_id = add(make_ints(name("anp_index"), BufferRole::constant, "[rows][16]", std::move(list.index)));
    const auto volume_id = add(make_reals(name("anp_inverse_volume"), BufferType::real, nodes, BufferRole::constant, "[list nodes]", "1/m^3",
                                          "model", std::move(volume)));
    const auto pressure_id = add(make_reals(name("anp_pressure"), BufferType::real, model_.slots, BufferRole::scratch, "[slots]", "Pa",
                                            "anp_node_pressure"));
    const auto elements_count = static_cast<std::int64_t>(b.nodes.size());
    program_.step.push_back({"tled_tet4_dilation",
                             {},
                             {buffer_arg(node_u_), buffer_arg(nodes_id), buffer_arg(data_id), buffer_arg(dilation_id)},
                             Shape::lanes,
                             static_cast<std::int64_t>(count),
                             label + " dilation",
                             elements_count,
                             60 + 16.0 * nodes / double(elements_count),
                             93});
    program_.step.push_back({"anp_node_pressure",
                             {},
                             {buffer_arg(dilation_id), buffer_arg(offset_id), buffer_arg(index_id), buffer_arg(volume_id),
                              buffer_arg(pressure_id), real_arg(second_parameter(b.material)), int_arg(model_.list_base)},
                             Shape::lanes,
                             nodes,
                             label + " nodal pressure",
                             nodes,
                             (8 * rows + 8.0 * nodes) / nodes,
                             rows / nodes + 2});
    return pressure_id;
  }

  void add_hexes(std::size_t index) {
    const HexBatch& b = model_.hexes[index];
    const auto count = static_cast<std::size_t>(padded(b.nodes.size()));
    const std::size_t planes = b.full ? PLIANT_HEXFULL_DATA_PLANES : PLIANT_HEX_DATA_PLANES;
    std::vector<std::int32_t> nodes(8 * count, 0);
    std::vector<double> fill(count, 0.0), data;
    for (std::size_t e = 0; e < b.nodes.size(); ++e) {
      for (int a = 0; a < 8; ++a) nodes[tile_base(e, 8) + a * PLIANT_TILE] = b.nodes[e][a];
      fill[e] = b.fill[e];
    }
    if (b.uniform) {
      data = b.records[0];
    } else {
      data.assign(planes * count, 0.0);
      for (std::size_t e = 0; e < b.nodes.size(); ++e) {
        for (std::size_t k = 0; k < planes; ++k) data[tile_base(e, planes) + k * PLIANT_TILE] = b.records[e][k];
      }
    }
    const auto nodes_id = add(make_ints(fmt::format("hex_nodes/{}", index), BufferRole::constant, "[tiles][8][16]", std::move(nodes)));
    const std::size_t numbers = data.size();
    const auto data_id = add(make_reals(fmt::format("hex_data/{}", index), BufferType::real, numbers, BufferRole::constant,
                                        b.uniform ? "[record]" : "[tiles][record][16]", "1/m, m^3, N/m", "model", std::move(data)));
    const auto fill_id = add(make_reals(fmt::format("hex_fill/{}", index), BufferType::real, count, BufferRole::constant, "[elements]", "1",
                                        "model", std::move(fill)));
    const BatchPlace& place = layout_.hexes[index];
    program_.step.push_back({b.full ? "tled_hex8full_force" : "tled_hex8_force",
                             {{"LAW", law_index(b.material.law)}, {"UNIFORM", b.uniform ? 1 : 0}},
                             {buffer_arg(node_u_), buffer_arg(nodes_id), buffer_arg(data_id), buffer_arg(fill_id), buffer_arg(corner_),
                              buffer_arg(fault_), real_arg(b.material.mu), real_arg(second_parameter(b.material)),
                              int_arg(place.corner_base), int_arg(place.fault_base), step_arg()},
                             Shape::lanes,
                             static_cast<std::int64_t>(count),
                             fmt::format("{}: {} {}", model_.bodies[b.body].name, b.full ? "hex8full" : "hex8", to_string(b.material.law)),
                             static_cast<std::int64_t>(b.nodes.size()),
                             hex_force_bytes(b.full, b.uniform) + 16,
                             hex_force_flops(b.material.law, b.full)});
  }

  void add_loads() {
    if (!needs_load()) return;
    const auto corners = brick_corners();
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
    for (const auto& c : corners) slots.push_back(c.first);
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
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
      for (; c < corners.size() && corners[c].first == slot; ++c) corner.push_back(corners[c].second);
      mark();
    }
    emit_loads(slots, std::move(offset), std::move(force), std::move(curve), std::move(triangle), std::move(weight), std::move(corner));
  }

  void emit_loads(const std::vector<std::int32_t>& slots, std::vector<std::int32_t> offset, std::vector<double> force,
                  std::vector<std::int32_t> curve, std::vector<std::int32_t> triangle, std::vector<double> weight,
                  std::vector<std::int32_t> corner) {
    const std::size_t forces = curve.size(), weights = weight.size();
    const double entries = double(forces + weights + corner.size());
    const auto count = static_cast<std::int64_t>(slots.size());
    const auto node_id = add(make_ints("load_node", BufferRole::constant, "[loaded]", slots));
    const auto offset_id = add(make_ints("load_offset", BufferRole::constant, "[loaded + 1][3]", std::move(offset)));
    const auto force_id = add(make_reals("load_force", BufferType::real4, std::max<std::size_t>(forces, 1), BufferRole::constant, "[forces]", "N",
                                         "model", std::move(force)));
    const auto curve_id = add(make_ints("load_curve", BufferRole::constant, "[forces]", std::move(curve), 1));
    const auto triangle_id = add(make_ints("load_triangle", BufferRole::constant, "[shares]", std::move(triangle), 1));
    const auto weight_id = add(make_reals("load_weight", BufferType::real, std::max<std::size_t>(weights, 1), BufferRole::constant, "[shares]",
                                          "1", "model", std::move(weight)));
    const auto corner_id = add(make_ints("load_corner", BufferRole::constant, "[corners]", std::move(corner), 1));
    program_.step.push_back({"node_load",
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

  void add_updates() {
    const int load = needs_load() ? 1 : 0;
    const auto defines = [&](int force_only) {
      return std::vector<std::pair<std::string, int>>{{"FORCE_ONLY", force_only}, {"HAS_LOAD", load}, {"TEXTBOOK", textbook()}};
    };
    if (model_.bricks > 0) {
      const std::int64_t count = std::int64_t{model_.bricks} * PLIANT_BRICK_NODES;
      for (const int force_only : {0, 1}) {
        Pass pass{"brick_update",
                  defines(force_only),
                  {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(brick_neighbor_), buffer_arg(brick_rows_), buffer_arg(brick_force_), buffer_arg(node_load_),
                   buffer_arg(node_force_), buffer_arg(params_)},
                  Shape::lanes,
                  count,
                  "brick nodes",
                  count,
                  brick_update_bytes(load != 0),
                  24};
        (force_only ? program_.force : program_.step).push_back(std::move(pass));
      }
    }
    if (has_list_nodes()) add_list_update(defines, load);
  }

  template <class Defines>
  void add_list_update(const Defines& defines, int load) {
    const std::int32_t nodes = model_.slots - model_.list_base;
    std::vector<std::vector<std::int32_t>> corners(nodes);
    const auto collect = [&](const auto& batches, const std::vector<BatchPlace>& places, int planes) {
      for (std::size_t b = 0; b < batches.size(); ++b) {
        for (std::size_t e = 0; e < batches[b].nodes.size(); ++e) {
          for (std::size_t a = 0; a < batches[b].nodes[e].size(); ++a) {
            const std::int32_t node = batches[b].nodes[e][a] - model_.list_base;
            if (node >= 0) corners[node].push_back(corner_position(places[b], e, static_cast<int>(a), planes));
          }
        }
      }
    };
    collect(model_.tets, layout_.tets, PLIANT_TET_FORCE_PLANES);
    collect(model_.hexes, layout_.hexes, PLIANT_HEX_FORCE_PLANES);
    GatherList list = pack_rows(corners, layout_.corner_numbers);
    const double entries = double(list.index.size()) / nodes;
    const auto offset_id = add(make_ints("gather_offset", BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
    const auto index_id = add(make_ints("gather_index", BufferRole::constant, "[rows][16]", std::move(list.index)));
    for (const int force_only : {0, 1}) {
      Pass pass{"node_update",
                defines(force_only),
                {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(offset_id), buffer_arg(index_id), buffer_arg(corner_),
                 buffer_arg(node_load_), buffer_arg(node_force_), buffer_arg(params_), int_arg(model_.list_base)},
                Shape::lanes,
                nodes,
                "list nodes",
                nodes,
                16 * entries + 64 + (load ? 16 : 0),
                3 * entries + 21};
      (force_only ? program_.force : program_.step).push_back(std::move(pass));
    }
  }

  void add_constraints() {
    if (model_.constraints.empty()) return;
    std::vector<std::int32_t> node, axes, curve;
    std::vector<double> target;
    for (const Constraint& c : model_.constraints) {
      node.push_back(c.slot);
      axes.push_back(c.axes);
      curve.insert(curve.end(), c.curve.begin(), c.curve.end());
      target.insert(target.end(), {c.target[0], c.target[1], c.target[2], 0.0});
    }
    // Whole work-groups: what fills them up holds no component.
    const std::size_t real_count = node.size(), count = (node.size() + 63) / 64 * 64;
    node.resize(count, node.back());
    axes.resize(count, 0);
    curve.resize(3 * count, 0);
    target.resize(4 * count, 0.0);
    const auto node_id = add(make_ints("prescribed_node", BufferRole::constant, "[prescribed]", std::move(node)));
    const auto axes_id = add(make_ints("prescribed_axes", BufferRole::constant, "[prescribed]", std::move(axes)));
    const auto curve_id = add(make_ints("prescribed_curve", BufferRole::constant, "[prescribed][3]", std::move(curve)));
    const auto target_id = add(make_reals("prescribed_target", BufferType::real4, count, BufferRole::constant, "[prescribed]", "m", "model",
                                          std::move(target)));
    program_.step.push_back({"node_prescribe",
                             {{"TEXTBOOK", textbook()}},
                             {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(node_id), buffer_arg(axes_id), buffer_arg(curve_id),
                              buffer_arg(target_id), buffer_arg(curves_), int_arg(curve_count()), step_arg()},
                             Shape::items,
                             static_cast<std::int64_t>(count),
                             "prescribed nodes",
                             static_cast<std::int64_t>(real_count),
                             60,
                             9});
  }

  const Model& model_;
  const ProgramOptions& options_;
  ProgramLayout layout_;
  Program program_;
  BufferId node_u_ = -1, node_w_ = -1, node_force_ = -1, node_load_ = -1, corner_ = -1, fault_ = -1, summary_ = -1, params_ = -1,
           curves_ = -1, surface_x_ = -1, pressure_ = -1, brick_neighbor_ = -1, brick_rows_ = -1, brick_fill_ = -1, brick_force_ = -1;
};

}  // namespace

Program build_program(const Model& model, const ProgramOptions& options) { return Builder(model, options).build(); }

}  // namespace pliant
