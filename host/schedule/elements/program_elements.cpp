// Buffers and passes of the internal forces: bricks, tetrahedra, averaged tetrahedra, hexahedra.
#include <fmt/format.h>

#include <algorithm>

#include "elements/elements.h"
#include "schedule/kernel_cost.h"
#include "schedule/program_builder.h"

namespace pliant {
BufferId ProgramBuilder::add_law(const Material& material) {
  std::vector<double> constants = law_constants(material);
  const std::size_t count = constants.size();
  return add(make_reals(fmt::format("law_parameters/{}", laws_++), BufferType::real, count, BufferRole::constant,
                        "[parameters]", "Pa", "model", std::move(constants)));
}

BufferId ProgramBuilder::add_viscosity(const Material& material, BufferId other) {
  if (!material.viscous()) return other;
  return add(make_reals(fmt::format("viscosity/{}", laws_), BufferType::real, 2, BufferRole::constant, "[2]", "Pa s", "model",
                        {2 * material.eta(), material.zeta() - 2 * material.eta() / 3}));
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
      {element_info(BrickBatch::kind()).brick,
       {{"LAW", static_cast<int>(b.material.law)}},
       {buffer_arg(node_u_), buffer_arg(brick_neighbor_), buffer_arg(brick_rows_), buffer_arg(brick_fill_),
        buffer_arg(brick_force_), buffer_arg(fault_), buffer_arg(add_law(b.material)), real_arg(1 / (4 * d)),
        real_arg(d * d / 4), real_arg(hourglass_stiffness(b.material, d * d * d)), int_arg(b.first), int_arg(0), step_arg()},
       Shape::bricks,
       b.count,
       fmt::format("{}: {} bricks {}", model_.bodies[b.body].name, to_string(BrickBatch::kind()), to_string(b.material.law)),
       cells,
       brick_force_bytes() * slots_per_cell,
       brick_force_flops(b.material.law)});
}

/// "tet_nodes/2" for the third batch with the same buffer names.
std::string ProgramBuilder::buffer_name(std::size_t index, const std::string& what) const {
  const auto family = [&](const ElementBatch& b) { return std::string_view(b.info().buffers); };
  const auto like = [&](const ElementBatch& b) { return family(b) == family(model_.batches[index]); };
  const auto number = std::count_if(model_.batches.begin(), model_.batches.begin() + static_cast<std::ptrdiff_t>(index), like);
  return fmt::format("{}/{}", what, number);
}

BufferId ProgramBuilder::add_element_nodes(std::size_t index, std::size_t count) {
  const ElementBatch& b = model_.batches[index];
  const auto corners = static_cast<std::size_t>(b.info().corners);
  // Padding of the last tile reads a slot of a list.
  std::vector<std::int32_t> nodes(corners * count, corners == 4 ? model_.list_base : 0);
  for (std::size_t e = 0; e < b.size(); ++e) {
    for (std::size_t a = 0; a < corners; ++a) nodes[tile_base(e, corners) + a * PLIANT_TILE] = b.nodes_of(e)[a];
  }
  return add(make_ints(buffer_name(index, fmt::format("{}_nodes", b.info().buffers)), BufferRole::constant,
                       fmt::format("[tiles][{}][16]", corners), std::move(nodes)));
}

BufferId ProgramBuilder::add_element_data(std::size_t index, std::size_t count) {
  const ElementBatch& b = model_.batches[index];
  const auto planes = static_cast<std::size_t>(b.info().record);
  std::vector<double> data;
  if (b.uniform) {
    data.assign(b.records.begin(), b.records.end());
  } else {
    data.assign(planes * count, 0.0);
    for (std::size_t e = 0; e < b.size(); ++e) {
      const auto record = b.record_of(e);
      for (std::size_t k = 0; k < planes; ++k) data[tile_base(e, planes) + k * PLIANT_TILE] = record[k];
      if (b.info().weighted >= 0) data[tile_base(e, planes) + b.info().weighted * PLIANT_TILE] *= b.share[e];
    }
  }
  const std::size_t numbers = data.size();
  return add(make_reals(buffer_name(index, fmt::format("{}_data", b.info().buffers)), BufferType::real, numbers,
                        BufferRole::constant, b.uniform ? "[record]" : fmt::format("[tiles][{}][16]", planes),
                        "1/m, m, m^3, N/m", "model", std::move(data)));
}

void ProgramBuilder::add_batch(std::size_t index) {
  const ElementBatch& b = model_.batches[index];
  const ElementInfo& info = b.info();
  const auto count = static_cast<std::size_t>(padded(b.size()));
  const std::string label = fmt::format("{}: {} {}", model_.bodies[b.body].name, info.word, to_string(b.material.law));
  const BufferId nodes_id = add_element_nodes(index, count), data_id = add_element_data(index, count);
  BufferId beside = node_u_;  // the fourth argument: shares, nodal pressures, or unused
  std::vector<std::pair<std::string, int>> defines{{"LAW", static_cast<int>(b.material.law)}};
  if (info.weighted < 0) {
    std::vector<double> share(count, 0.0);
    std::copy(b.share.begin(), b.share.end(), share.begin());
    beside = add(make_reals(buffer_name(index, fmt::format("{}_fill", b.info().buffers)), BufferType::real, count,
                            BufferRole::constant, "[elements]", "1", "model", std::move(share)));
    defines.emplace_back("UNIFORM", b.uniform ? 1 : 0);
  } else {
    defines.emplace_back("AVERAGED", info.averaged ? 1 : 0);
  }
  const BufferId law_id = add_law(b.material);
  if (info.averaged) beside = add_averaging(index, nodes_id, data_id, law_id, count, label);
  const BufferId viscosity_id = add_viscosity(b.material, law_id);
  defines.emplace_back("VISCOUS", b.material.viscous() ? 1 : 0);
  const BatchOffsets& place = layout_.batches[index];
  const ElementCost cost = element_cost(b.kind, law_flops(b.material.law), b.uniform);
  const double texels = 16.0 * (model_.list_end - model_.list_base) / double(b.size());
  program_.step.push_back(
      {info.kernel,
       std::move(defines),
       {buffer_arg(node_u_), buffer_arg(nodes_id), buffer_arg(data_id), buffer_arg(beside), buffer_arg(corner_),
        buffer_arg(fault_), buffer_arg(law_id), buffer_arg(viscosity_id), buffer_arg(node_w_), buffer_arg(params_),
        int_arg(place.corner_base), int_arg(place.fault_base), step_arg()},
       Shape::lanes,
       static_cast<std::int64_t>(count),
       label,
       static_cast<std::int64_t>(b.size()),
       cost.bytes + cost.texels * texels,
       cost.flops});
}

BufferId ProgramBuilder::add_averaging(std::size_t index, BufferId nodes_id, BufferId data_id, BufferId law_id,
                                       std::size_t count, const std::string& label) {
  const ElementBatch& b = model_.batches[index];
  const std::int32_t nodes = model_.list_end - model_.list_base;
  std::vector<std::vector<std::int32_t>> elements(nodes);
  std::vector<double> volume(nodes, 0.0), dilation(count + PLIANT_TILE, 0.0);
  std::fill(dilation.end() - PLIANT_TILE, dilation.end(), -0.0);
  for (std::size_t e = 0; e < b.size(); ++e) {
    for (const std::int32_t n : b.nodes_of(e)) {
      elements[n - model_.list_base].push_back(static_cast<std::int32_t>(e));
      volume[n - model_.list_base] += element_volume(b.kind, b.record_of(e)) * b.share[e];
    }
  }
  for (double& v : volume) v = v > 0 ? 1 / v : 0;
  GatherList list = pack_rows(elements, static_cast<std::int32_t>(count));
  const double rows = double(list.index.size());
  const auto name = [&](const char* stem) { return buffer_name(index, stem); };
  const auto dilation_id = add(make_reals(name("anp_dilation"), BufferType::real, count + PLIANT_TILE, BufferRole::scratch,
                                          "[elements + 16]", "m^3", "tled_tet4_dilation", std::move(dilation)));
  program_.buffers[dilation_id].fixed = PLIANT_TILE;  // padding of anp_index for nodes with fewer elements than others
  const auto offset_id = add(make_ints(name("anp_offset"), BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
  const auto index_id = add(make_ints(name("anp_index"), BufferRole::constant, "[rows][16]", std::move(list.index)));
  const auto volume_id = add(make_reals(name("anp_inverse_volume"), BufferType::real, nodes, BufferRole::constant,
                                        "[list nodes]", "1/m^3", "model", std::move(volume)));
  const auto pressure_id = add(make_reals(name("anp_pressure"), BufferType::real, model_.slots, BufferRole::scratch, "[slots]",
                                          "Pa", "anp_node_pressure"));
  const auto elements_count = static_cast<std::int64_t>(b.size());
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

}  // namespace pliant
