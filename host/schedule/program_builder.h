// The builder behind build_program: buffer table and passes by topic. Private to host/schedule.
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "schedule/build_program.h"
#include "schedule/program_layout.h"

namespace pliant {

/// A buffer of `count` elements of a real type, initialized with `reals`, or zero without.
inline Buffer make_reals(std::string name, BufferType type, std::size_t count, BufferRole role, std::string shape,
                         std::string unit, std::string producer, std::vector<double> reals = {}) {
  return {std::move(name), type, count, role, std::move(shape), std::move(unit), std::move(producer), std::move(reals), {}};
}

/// A buffer of integers, with the length of `ints`, or `count` zeros if `ints` is empty.
inline Buffer make_ints(std::string name, BufferRole role, std::string shape, std::vector<std::int32_t> ints,
                        std::size_t count = 0, std::string producer = "model") {
  const std::size_t n = ints.empty() ? count : ints.size();
  return {std::move(name), BufferType::int32, n, role, std::move(shape), "1", std::move(producer), {}, std::move(ints)};
}

/// A buffer whose values pass from step to step, and what edits do to them.
inline Buffer declare_state(Buffer buffer, Carry carry, ToolNumbers tools = ToolNumbers::none) {
  buffer.role = BufferRole::state;
  buffer.carry = carry;
  buffer.tools = tools;
  return buffer;
}

/// Adds the backup of a state buffer, which keeps its last good values for rollback. An edit drops those.
inline BufferId add_last_good(Program& program, BufferId of) {
  const Buffer& live = program.at(of);
  const std::size_t stem = live.name.starts_with("node_") ? 5 : 0;
  Buffer copy;
  copy.name = "last_" + live.name.substr(stem);
  copy.type = live.type, copy.count = live.count;
  copy.shape = live.shape, copy.unit = live.unit, copy.producer = "host";
  if (live.type == BufferType::int32) copy.ints = live.ints;
  copy.copy_of = of;
  return program.add(declare_state(std::move(copy), Carry::drop, live.tools));
}

/// A gather list in rows of 16: each tile of owners has as many rows as its longest list, padded with `padding`.
struct GatherList {
  std::vector<std::int32_t> offset{0};
  std::vector<std::int32_t> index;
};

/// Packs one list of entries per owner. The number of owners is a multiple of the tile size.
inline GatherList pack_rows(const std::vector<std::vector<std::int32_t>>& entries, std::int32_t padding) {
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

/// Position in corner_force of the x component of a corner of element e of a batch.
inline std::int32_t corner_position(const BatchOffsets& place, std::size_t e, int corner, int planes) {
  return place.corner_base + static_cast<std::int32_t>(tile_base(e, static_cast<std::size_t>(planes))) +
         3 * corner * PLIANT_TILE;
}

/// Builds one Program: construct it, then call build() once. The calls in build() determine the order of buffers and passes.
class ProgramBuilder {
 public:
  /// Both must outlive the builder.
  ProgramBuilder(const Model& model, const ProgramOptions& options);
  Program build();

 private:
  /// Defined in build_program.cpp: parts shared by all batches.
  void add_shared_buffers();
  void add_gravity();
  void add_updates();
  void add_update(int force_only, const Pass& pass);
  void add_list_update();
  void add_constraints();
  void add_rotations();
  void add_status();
  [[nodiscard]] std::vector<std::pair<std::string, int>> update_defines(int force_only) const;

  /// Defined in program_elements.cpp: internal forces, one call per batch.
  /// Adds the parameters of a batch's law, a constant buffer of any length. (A law with parameters that vary within a batch
  /// would need planes per element, like other element data.)
  BufferId add_law(const Material& material);
  /// Adds the buffer for viscous.cl; without viscosity returns `other`, which the kernel then does not read.
  BufferId add_viscosity(const Material& material, BufferId other);
  void add_bricks(const BrickBatch& b);
  /// Elements in lists: nodes, records and, unless part of the record, shares. `count` includes padding to whole tiles.
  void add_batch(std::size_t index);
  [[nodiscard]] std::string buffer_name(std::size_t index, const std::string& what) const;
  BufferId add_element_nodes(std::size_t index, std::size_t count);
  BufferId add_element_data(std::size_t index, std::size_t count);
  /// Adds the two passes before the force of elements with averaged dilation; returns the buffer of nodal pressures.
  BufferId add_averaging(std::size_t index, BufferId nodes_id, BufferId data_id, BufferId law_id, std::size_t count,
                         const std::string& label);

  /// Defined in program_flsm.cpp: shape matching of one body, and its interface force.
  void add_flsm(std::size_t index);

  /// Defined in program_contact.cpp: contact with tools, after everything else that moves nodes.
  void add_contact();
  void add_contact_points();
  void add_tools();
  void add_contact_gather();
  void add_contact_passes();
  [[nodiscard]] std::vector<Arg> tool_pass_args(const std::string& kernel) const;
  [[nodiscard]] std::vector<Arg> apply_args(const char* force) const;
  void add_contact_look();
  [[nodiscard]] std::vector<Arg> named(std::initializer_list<const char*> buffers) const;

  /// Defined in program_touch.cpp: contact of tissue with tissue.
  void add_contact_surface();
  void add_contact_patches();
  void add_touch();
  void add_touch_look();
  void add_touch_pass(const char* kernel);

  /// Defined in program_blades.cpp: blades that cut by force, after contact.
  void add_blades();

  /// Defined in program_loads.cpp: external forces, and the embedded surface if a pressure acts on it.
  void add_surface();
  void add_pressure_passes();
  void add_loads();
  void emit_loads(const std::vector<std::int32_t>& slots, std::vector<std::int32_t> offset, std::vector<double> force,
                  std::vector<std::int32_t> curve, std::vector<std::int32_t> triangle, std::vector<double> weight,
                  std::vector<std::int32_t> corner);
  /// Defined in links/: forces of links, added to those loads.
  struct PointForce {
    std::int32_t texel = 0;  ///< in link_force
    double sign = 1;         ///< -1: the opposite force stands there
  };
  using LinkForces = std::vector<std::vector<PointForce>>;  ///< per point the forces on it
  void add_links();
  /// Adds the springs of bodies, which are between nodes; returns the other links, without broken springs, and their points.
  Links add_networks();
  void add_network(const SpringBatch& b, std::size_t index);
  /// Fills link_place_, and adds a pass for the displacements of the points, unless all are nodes.
  void add_link_points(const Links& links);
  void add_springs(const Links& links, std::size_t index, std::int32_t base, LinkForces& forces);
  void add_membrane(const Links& links, std::size_t index, std::int32_t base, LinkForces& forces);
  void add_link_gather(const LinkPoints& points, const LinkForces& forces, std::int32_t zero);
  /// The law of springs as a polygon; returns its number of segments, too.
  std::pair<BufferId, std::int32_t> add_spring_curve(const Spring& law, std::string name);
  /// [tiles][2][16] slots and whether their loads are there (kernels/links/node_sum.cl); from now on they are.
  std::vector<std::int32_t> load_nodes(const std::vector<std::int32_t>& slots);
  /// (slot, position in corner_force) for the corners of list elements at brick nodes, ascending.
  [[nodiscard]] std::vector<std::pair<std::int32_t, std::int32_t>> brick_corners() const;

  BufferId add(Buffer buffer) { return program_.add(std::move(buffer)); }
  /// Adds a state buffer of contact, whose points an edit samples anew, and its backup for rollback.
  void add_contact_state(Buffer buffer, ToolNumbers tools = ToolNumbers::none) {
    add_last_good(program_, add(declare_state(std::move(buffer), Carry::drop, tools)));
  }
  [[nodiscard]] bool has_list_nodes() const { return model_.list_end > model_.list_base; }
  [[nodiscard]] bool has_list_elements() const { return !model_.batches.empty(); }
  [[nodiscard]] bool needs_load() const {
    return !model_.forces.empty() || !model_.pressures.empty() || !brick_corners_.empty() || has_interface() ||
           !model_.links.empty();
  }
  [[nodiscard]] bool has_interface() const {
    return std::any_of(model_.flsm.begin(), model_.flsm.end(), [](const FlsmBatch& b) { return b.interface > 0; });
  }
  [[nodiscard]] int integrator() const { return static_cast<int>(options_.integrator); }
  [[nodiscard]] std::int32_t curve_count() const { return static_cast<std::int32_t>(model_.curves.size()); }

  const Model& model_;
  const ProgramOptions& options_;
  ProgramLayout layout_;
  std::vector<std::pair<std::int32_t, std::int32_t>>
      brick_corners_;  ///< requires layout_; computed once, since it visits all hexahedra
  Program program_;
  BufferId node_u_ = -1, node_w_ = -1, node_force_ = -1, node_load_ = -1, corner_ = -1, fault_ = -1, summary_ = -1,
           fastest_ = -1, params_ = -1, now_ = -1, curves_ = -1, surface_x_ = -1, pressure_ = -1, brick_neighbor_ = -1,
           link_u_ = -1, link_w_ = -1, link_force_ = -1, brick_rows_ = -1, brick_fill_ = -1, brick_force_ = -1,
           flsm_alpha_ = -1;
  std::int32_t edged_tools_ = 0;  ///< one bit per tool with edges (kernels/contact/contact_edge.cl)
  /// Returns `buffer` if a tool has edges, otherwise `other` as a placeholder that no kernel reads.
  [[nodiscard]] const char* of_edges(const char* buffer, const char* other) const { return edged_tools_ != 0 ? buffer : other; }
  int laws_ = 0;                          ///< number of batches whose law was added
  std::vector<std::int32_t> link_place_;  ///< [points] texel of link_u
  std::vector<char> loaded_;              ///< [slots] whether a pass has written node_load; of links
};

}  // namespace pliant
