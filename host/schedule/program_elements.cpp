// Buffers and passes of the internal forces: bricks, tetrahedra, averaged tetrahedra, hexahedra.
#include <fmt/format.h>

#include <algorithm>

#include "schedule/kernel_cost.h"
#include "schedule/program_builder.h"

namespace pliant {
BufferId ProgramBuilder::add_law(const Material& material) {
  std::vector<double> constants = law_constants(material);
  const std::size_t count = constants.size();
  return add(make_reals(fmt::format("law_parameters/{}", laws_++), BufferType::real, count, BufferRole::constant,
                        "[parameters]", "Pa", "model", std::move(constants)));
}

void ProgramBuilder::add_bricks(const BrickBatch& b) {
  if (brick_neighbor_ < 0) {
    const auto bricks = static_cast<std::size_t>(model_.bricks) + 1;
    brick_neighbor_ = add(make_ints("brick_neighbor", BufferRole::constant, "[bricks + 1][16]", model_.brick_neighbor));
    brick_rows_ = add(make_ints("brick_rows", BufferRole::constant, "[bricks + 1][2]", model_.brick_rows));
    brick_fill_ = add(make_reals("brick_fill", BufferType::real, model_.brick_fill.size(), BufferRole::constant,
                                 "[bricks + 1][256]", "1", "model", model_.brick_fill));
    brick_force_ = add(make_reals("brick_force", BufferType::real, bricks * PLIANT_BRICK_FORCE, BufferRole::scratch,
                                  "[bricks + 1][1280]", "N", "tled_hex8_brick_force"));
    program_.buffers[brick_force_].padding = -0.0;
    program_.buffers[brick_force_].fixed = PLIANT_BRICK_FORCE;  // the empty brick
  }
  const double d = b.spacing;
  std::int64_t cells = 0;
  for (std::int32_t i = b.first * PLIANT_BRICK_NODES; i < (b.first + b.count) * PLIANT_BRICK_NODES; ++i)
    cells += model_.brick_cell[i] >= 0;
  const double slots_per_cell = cells == 0 ? 0 : double(b.count) * PLIANT_BRICK_NODES / double(cells);
  program_.step.push_back(
      {"tled_hex8_brick_force",
       {{"LAW", static_cast<int>(b.material.law)}},
       {buffer_arg(node_u_), buffer_arg(brick_neighbor_), buffer_arg(brick_rows_), buffer_arg(brick_fill_),
        buffer_arg(brick_force_), buffer_arg(fault_), buffer_arg(add_law(b.material)), real_arg(1 / (4 * d)),
        real_arg(d * d / 4), real_arg(hourglass_stiffness(b.material, d * d * d)), int_arg(b.first), int_arg(0), step_arg()},
       Shape::bricks,
       b.count,
       fmt::format("{}: hex8 bricks {}", model_.bodies[b.body].name, to_string(b.material.law)),
       cells,
       brick_force_bytes() * slots_per_cell,
       brick_force_flops(b.material.law)});
}

void ProgramBuilder::add_tets(std::size_t index) {
  const TetBatch& b = model_.tets[index];
  const auto count = static_cast<std::size_t>(padded(b.nodes.size()));
  std::vector<std::int32_t> nodes(4 * count, model_.list_base);
  std::vector<double> data(PLIANT_TET_DATA_PLANES * count, 0.0);
  for (std::size_t e = 0; e < b.nodes.size(); ++e) {
    for (int a = 0; a < 4; ++a) nodes[tile_base(e, 4) + a * PLIANT_TILE] = b.nodes[e][a];
    for (int k = 0; k < 9; ++k) data[tile_base(e, PLIANT_TET_DATA_PLANES) + k * PLIANT_TILE] = b.gradients[e][k];
    data[tile_base(e, PLIANT_TET_DATA_PLANES) + 9 * PLIANT_TILE] = b.volume[e];
  }
  const auto nodes_id =
      add(make_ints(fmt::format("tet_nodes/{}", index), BufferRole::constant, "[tiles][4][16]", std::move(nodes)));
  const auto data_id = add(make_reals(fmt::format("tet_data/{}", index), BufferType::real, PLIANT_TET_DATA_PLANES * count,
                                      BufferRole::constant, "[tiles][10][16]", "1/m, m^3", "model", std::move(data)));
  const std::string label =
      fmt::format("{}: {} {}", model_.bodies[b.body].name, b.averaged ? "tet4anp" : "tet4", to_string(b.material.law));
  const double texels = 16.0 * (model_.list_end - model_.list_base) / double(b.nodes.size());
  BufferId pressure = node_u_;  // not read
  const BufferId law_id = add_law(b.material);
  if (b.averaged) pressure = add_averaging(index, nodes_id, data_id, law_id, count, label);
  const BatchOffsets& place = layout_.tets[index];
  program_.step.push_back(
      {"tled_tet4_force",
       {{"LAW", static_cast<int>(b.material.law)}, {"AVERAGED", b.averaged ? 1 : 0}},
       {buffer_arg(node_u_), buffer_arg(nodes_id), buffer_arg(data_id), buffer_arg(pressure), buffer_arg(corner_),
        buffer_arg(fault_), buffer_arg(law_id), int_arg(place.corner_base), int_arg(place.fault_base), step_arg()},
       Shape::lanes,
       static_cast<std::int64_t>(count),
       label,
       static_cast<std::int64_t>(b.nodes.size()),
       tet_force_bytes(b.averaged) + texels * (b.averaged ? 1.25 : 1),
       tet_force_flops(b.material.law)});
}

BufferId ProgramBuilder::add_averaging(std::size_t index, BufferId nodes_id, BufferId data_id, BufferId law_id,
                                       std::size_t count, const std::string& label) {
  const TetBatch& b = model_.tets[index];
  const std::int32_t nodes = model_.list_end - model_.list_base;
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
  const auto dilation_id = add(make_reals(name("anp_dilation"), BufferType::real, count + PLIANT_TILE, BufferRole::scratch,
                                          "[elements + 16]", "m^3", "tled_tet4_dilation", std::move(dilation)));
  program_.buffers[dilation_id].fixed = PLIANT_TILE;  // what anp_index points to where a node has fewer elements than others
  const auto offset_id = add(make_ints(name("anp_offset"), BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
  const auto index_id = add(make_ints(name("anp_index"), BufferRole::constant, "[rows][16]", std::move(list.index)));
  const auto volume_id = add(make_reals(name("anp_inverse_volume"), BufferType::real, nodes, BufferRole::constant,
                                        "[list nodes]", "1/m^3", "model", std::move(volume)));
  const auto pressure_id = add(make_reals(name("anp_pressure"), BufferType::real, model_.slots, BufferRole::scratch, "[slots]",
                                          "Pa", "anp_node_pressure"));
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
                           {{"LAW", static_cast<int>(b.material.law)}},
                           {buffer_arg(dilation_id), buffer_arg(offset_id), buffer_arg(index_id), buffer_arg(volume_id),
                            buffer_arg(pressure_id), buffer_arg(law_id), int_arg(model_.list_base)},
                           Shape::lanes,
                           nodes,
                           label + " nodal pressure",
                           nodes,
                           (8 * rows + 8.0 * nodes) / nodes,
                           rows / nodes + 2});
  return pressure_id;
}

void ProgramBuilder::add_hexes(std::size_t index) {
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
  const auto nodes_id =
      add(make_ints(fmt::format("hex_nodes/{}", index), BufferRole::constant, "[tiles][8][16]", std::move(nodes)));
  const std::size_t numbers = data.size();
  const auto data_id =
      add(make_reals(fmt::format("hex_data/{}", index), BufferType::real, numbers, BufferRole::constant,
                     b.uniform ? "[record]" : "[tiles][record][16]", "1/m, m, m^3, N/m", "model", std::move(data)));
  const auto fill_id = add(make_reals(fmt::format("hex_fill/{}", index), BufferType::real, count, BufferRole::constant,
                                      "[elements]", "1", "model", std::move(fill)));
  const BufferId law_id = add_law(b.material);
  const BatchOffsets& place = layout_.hexes[index];
  program_.step.push_back(
      {b.full ? "tled_hex8full_force" : "tled_hex8_force",
       {{"LAW", static_cast<int>(b.material.law)}, {"UNIFORM", b.uniform ? 1 : 0}},
       {buffer_arg(node_u_), buffer_arg(nodes_id), buffer_arg(data_id), buffer_arg(fill_id), buffer_arg(corner_),
        buffer_arg(fault_), buffer_arg(law_id), int_arg(place.corner_base), int_arg(place.fault_base), step_arg()},
       Shape::lanes,
       static_cast<std::int64_t>(count),
       fmt::format("{}: {} {}", model_.bodies[b.body].name, b.full ? "hex8full" : "hex8", to_string(b.material.law)),
       static_cast<std::int64_t>(b.nodes.size()),
       hex_force_bytes(b.full, b.uniform) + 16,
       hex_force_flops(b.material.law, b.full, b.uniform)});
}

}  // namespace pliant
