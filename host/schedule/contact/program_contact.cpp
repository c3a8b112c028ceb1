// Buffers of contact points and tools, and the passes of contact.
#include <algorithm>

#include "schedule/contact/contact_data.h"
#include "schedule/program_builder.h"

namespace pliant {
namespace {

/// Numbers per tool in tool_data (kernels/contact/contact_shape.cl).
constexpr std::size_t kToolNumbers = 20;
/// Numbers per edge point in tool_edge (kernels/contact/contact_edge.cl).
constexpr std::size_t kEdgeNumbers = 4;

std::vector<double> numbers_of(const ToolForm& form, const ContactLaw& law, double cell) {
  std::vector<double> n{form.radius};
  const Vec3d origin = form.shape == ToolShape::blade_face ? Vec3d{cell, 0, 0} : form.grid.origin;  // see contact_face.cl
  for (const Vec3d& v : {form.first, form.second, origin}) n.insert(n.end(), v.begin(), v.end());
  n.push_back(form.grid.spacing > 0 ? 1 / form.grid.spacing : 0);
  n.push_back(form.grid.spacing);
  n.insert(n.end(), {law.stiffness, 1.5 * law.alpha, law.friction, law.core, law.exponent == 1.5 ? 1.0 : 0.0});
  n.resize(kToolNumbers, 0.0);
  return n;
}

}  // namespace

void ProgramBuilder::add_contact() {
  if (model_.contact == nullptr || model_.contact->size() == 0) return;
  add_contact_points();
  if (!model_.tools->empty()) add_tools();
  if (model_.tissue_contact || edged_tools_ != 0) add_contact_surface();
  if (edged_tools_ != 0) add_contact_patches();
  if (model_.tissue_contact) add_touch();
  add_contact_gather();
  add_contact_passes();
}

void ProgramBuilder::add_contact_points() {
  const ContactPoints& points = *model_.contact;
  const std::size_t count = padded(points.size()), tiles = count / PLIANT_TILE;
  std::vector<double> rest(4 * count, 0.0), weight(8 * count, 0.0), share(8 * count, 0.0), of_held(4 * count, 0.0);
  std::vector<std::int32_t> node(8 * count, points.nodes[0][0]);
  std::vector<char> held(static_cast<std::size_t>(model_.slots), 0);
  for (const Constraint& c : model_.constraints) held[static_cast<std::size_t>(c.slot)] = static_cast<char>(c.axes == 7);
  std::vector<double> area(static_cast<std::size_t>(model_.slots), 0.0);  // of all points at a node, times their weights
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 8; ++a)
      area[static_cast<std::size_t>(points.nodes[i][a])] += points.area[i] * points.weights[i][a] / contact_weight_unit;
  }
  for (std::size_t i = 0; i < count; ++i) {  // padding has the last point's position and no area
    const std::size_t from = std::min(i, points.size() - 1);
    for (std::size_t c = 0; c < 3; ++c) rest[tile_base(i, 4) + c * PLIANT_TILE] = points.rest[from][c];
    if (i >= points.size()) continue;
    rest[tile_base(i, 4) + std::size_t{3} * PLIANT_TILE] = points.area[i];
    double whole = 0, moving = 0;
    for (std::size_t a = 0; a < 8; ++a) {
      const std::size_t at = tile_base(i, 8) + a * PLIANT_TILE;
      const auto slot = static_cast<std::size_t>(points.nodes[i][a]);
      node[at] = points.nodes[i][a];
      weight[at] = double(points.weights[i][a]) / contact_weight_unit;
      whole += weight[at] * area[slot];
      if (held[slot] != 0) {
        for (std::size_t c = 0; c < 3; ++c) of_held[tile_base(i, 4) + c * PLIANT_TILE] += weight[at] * model_.rest[slot][c];
        of_held[tile_base(i, 4) + std::size_t{3} * PLIANT_TILE] += weight[at];
        continue;
      }
      share[at] = weight[at] * area[slot];
      moving += share[at];
    }
    for (std::size_t a = 0; a < 8 && moving > 0; ++a) share[tile_base(i, 8) + a * PLIANT_TILE] *= whole / moving;
  }
  const auto constant = [&](const char* name, std::size_t planes, const char* shape, const char* unit,
                            std::vector<double> values) {
    add(make_reals(name, BufferType::real, planes * count, BufferRole::constant, shape, unit, "model", std::move(values)));
  };
  constant("contact_rest", 4, "[tiles][4][16]", "m, m, m, m^2", std::move(rest));
  add(make_ints("contact_node", BufferRole::constant, "[tiles][8][16]", std::move(node)));
  constant("contact_weight", 8, "[tiles][8][16]", "1", std::move(weight));
  constant("contact_share", 8, "[tiles][8][16]", "m^2", std::move(share));
  if (!model_.tools->empty()) constant("contact_held", 4, "[tiles][4][16]", "m, m, m, 1", std::move(of_held));
  const auto all = static_cast<std::int32_t>((std::int64_t{1} << model_.tools->size()) - 1);
  add_contact_state(
      make_ints("contact_near", BufferRole::state, "[tiles]", std::vector<std::int32_t>(tiles, all), 0, "contact_near"),
      ToolNumbers::bits);
  add_contact_state(make_reals("contact_yield", BufferType::real, count, BufferRole::state, "[points]", "m^3/N",
                               "contact_settle, touch_place"));
  // Written by the host after a search; they end with empty entries.
  add(make_ints("contact_list", BufferRole::control, "[tiles + 16]", std::vector<std::int32_t>(tiles + contact_list_end, -1), 0,
                "host"));
  add(make_ints("contact_force", BufferRole::scratch, "[tiles][4][16]", {}, 4 * count, "contact_press, contact_settle"));
  add(make_ints("contact_change", BufferRole::scratch, "[tiles][4][16]", {}, 4 * count, "contact_settle, touch_press"));
  add(make_reals("contact_params", BufferType::real, 9, BufferRole::control, "[9]", "see contact_near.cl", "host"));
  add(make_reals("contact_node_sum", BufferType::real4, static_cast<std::size_t>(model_.slots) + 1, BufferRole::scratch,
                 "[slots + 1]", "N, N, N, m^2", "contact_apply"));
}

void ProgramBuilder::add_tools() {
  const std::size_t tools = model_.tools->size(), count = static_cast<std::size_t>(padded(model_.contact->size()));
  add_contact_state(make_reals("contact_anchor", BufferType::real, 4 * count, BufferRole::state, "[tiles][4][16]", "m, m, m, 1",
                               "contact_press, contact_settle"),
                    ToolNumbers::fourth);
  add_contact_state(
      make_reals("contact_start", BufferType::real, 2 * count, BufferRole::state, "[tiles][2][16]", "m, 1", "contact_press"),
      ToolNumbers::second);
  add(make_reals("contact_gap", BufferType::real, count / PLIANT_TILE * tools, BufferRole::scratch, "[tiles][tools]", "m",
                 "contact_near"));
  program_.buffers.back().carried = Carried::all;
  add(make_ints("contact_tool_force", BufferRole::scratch, "[tools][tiles][8][16]", {}, 8 * count * tools,
                "contact_press, contact_settle"));
  std::vector<double> data, edge;
  std::size_t values = 0;
  std::vector<std::int32_t> kind;
  for (std::size_t t = 0; t < tools; ++t) {
    const ToolForm& form = (*model_.tools)[t];
    const std::vector<double> numbers = numbers_of(form, model_.contact_laws[t], model_.contact->spacing);
    data.insert(data.end(), numbers.begin(), numbers.end());
    const ToolShape shape = form.shape == ToolShape::sequence ? ToolShape::mesh : form.shape;
    kind.insert(kind.end(), {static_cast<std::int32_t>(shape), static_cast<std::int32_t>(values), form.grid.size[0],
                             form.grid.size[1], form.grid.size[2], static_cast<std::int32_t>(form.frames.size())});
    const std::vector<EdgePoint> edges = edge_points(form, *model_.contact);
    kind.insert(kind.end(), {static_cast<std::int32_t>(edge.size() / kEdgeNumbers), static_cast<std::int32_t>(edges.size())});
    for (const EdgePoint& e : edges) edge.insert(edge.end(), {e.place[0], e.place[1], e.place[2], e.radius});
    if (!edges.empty() || form.shape == ToolShape::blade_face) edged_tools_ |= 1 << t;
    values += form.distance.size();
  }
  if (edge.empty()) edge.resize(kEdgeNumbers, 0.0);
  add(make_ints("tool_kind", BufferRole::constant, "[tools][8]", std::move(kind)));
  std::vector<double> grid = tool_grid(*model_.tools);
  values = grid.size();
  const std::size_t numbers = data.size(), ends = edge.size();
  add(make_reals("tool_data", BufferType::real, numbers, BufferRole::constant, "[tools][20]", "see contact_shape.cl", "model",
                 std::move(data)));
  add(make_reals("tool_grid", BufferType::real, values, BufferRole::constant, "[grid nodes]", "m", "model", std::move(grid)));
  add(make_reals("tool_edge", BufferType::real, ends, BufferRole::constant, "[edge points][4]", "m", "model", std::move(edge)));
  const auto rows = static_cast<std::size_t>(options_.batch_steps);
  add(make_reals("tool_pose", BufferType::real, (rows + 1) * tools * contact_pose_numbers, BufferRole::control,
                 "[steps + 1][tools][15]", "1 (9), m (3), 1 (2), Pa", "host"));
  add(make_ints("tool_sum", BufferRole::scratch, "[steps][tools][16][18]", {},
                rows * tools * contact_sum_parts * contact_sum_numbers, "contact_tool_sum"));
  program_.buffers.back().carried = Carried::all;  // one row per step of the batch, until the host reads it
}

std::vector<Arg> ProgramBuilder::named(std::initializer_list<const char*> buffers) const {
  std::vector<Arg> list;
  for (const char* name : buffers) list.push_back(buffer_arg(program_.find(name)));
  return list;
}

/// Arguments of contact_press and contact_settle.
std::vector<Arg> ProgramBuilder::tool_pass_args(const std::string& kernel) const {
  std::vector<Arg> list =
      named({"node_u", "node_w", "contact_rest", "contact_node", "contact_weight", "contact_share", "contact_held",
             "contact_list", "contact_near", "contact_yield", "contact_anchor", "contact_start", "contact_force"});
  const bool settle = kernel == "contact_settle";
  const std::vector<Arg> results = settle ? named({"contact_change", "contact_node_sum"}) : std::vector<Arg>{};
  const std::vector<Arg> tools = named(
      {"contact_tool_force", "tool_kind", "tool_data", "tool_grid", "tool_edge", "tool_pose",
       of_edges("touch_surface", "contact_weight"), of_edges("contact_patch", "contact_weight"),
       of_edges("contact_corner_weight", "contact_node_sum"),
       of_edges("contact_corner_force", settle ? "contact_tool_force" : "contact_change"), "contact_params", "step_params"});
  list.insert(list.end(), results.begin(), results.end());
  list.insert(list.end(), tools.begin(), tools.end());
  return list;
}

/// Arguments of contact_apply. `force`: the buffer with the forces of the points.
std::vector<Arg> ProgramBuilder::apply_args(const char* force) const {
  const bool tissue = model_.tissue_contact.has_value();
  return named({"node_u",
                "node_w",
                "contact_slot",
                "contact_free",
                "contact_node_list",
                "contact_tiles_offset",
                "contact_tiles",
                "contact_entry_offset",
                "contact_entry",
                "contact_gather_offset",
                "contact_gather",
                "contact_gather_units",
                tissue ? "contact_gather_turns" : "contact_gather_units",
                "contact_near",
                force,
                tissue ? "touch_moment" : force,
                of_edges("contact_gather_corner", "contact_gather_units"),
                of_edges("contact_corner_force", force),
                of_edges("contact_corner_weight", "contact_rest"),
                "contact_rest",
                "contact_node_sum",
                "contact_params",
                "step_params"});
}

/// The contact passes of every step, over the points and nodes that the last search listed.
void ProgramBuilder::add_contact_passes() {
  const auto points = static_cast<std::int64_t>(padded(model_.contact->size()));
  const auto nodes = static_cast<std::int64_t>(program_.at(program_.find("contact_slot")).count);
  const auto tools = static_cast<std::int32_t>(model_.tools->size());
  const bool tissue = model_.tissue_contact.has_value();
  program_.near_points = std::make_shared<std::int64_t>(0);
  program_.near_nodes = std::make_shared<std::int64_t>(0);
  const auto with_step = [&](std::vector<Arg> list) {
    list.push_back(int_arg(static_cast<std::int32_t>(points)));
    list.push_back(int_arg(tools));
    list.push_back(step_arg());
    return list;
  };
  // Costs are counted as zero; the cost depends on the points near something (docs/contact.md).
  const auto pass = [&](const char* kernel, std::vector<Arg> list, Shape shape, std::int64_t count, const char* label) {
    program_.step.push_back({kernel, {}, std::move(list), shape, count, label, count, 0, 0});
    program_.step.back().uneven = true;
    program_.step.back().active = kernel == std::string("contact_apply") ? program_.near_nodes : program_.near_points;
  };
  const auto apply = [&](const char* force) {
    pass("contact_apply", apply_args(force), Shape::lanes, nodes, "contact nodes");
    program_.step.back().defines = {{"MOMENT", tissue ? 1 : 0}, {"EDGES", edged_tools_ != 0 ? 1 : 0}};
  };
  add_contact_look();
  const bool grips = std::any_of(model_.tools->begin(), model_.tools->end(), [](const ToolForm& t) { return t.grips; });
  const auto of_tools = [&](const char* kernel) {
    pass(kernel, with_step(tool_pass_args(kernel)), Shape::lanes, points, "contact points");
    program_.step.back().defines = {{"EDGES", edged_tools_ != 0 ? 1 : 0}, {"GRIPS", grips ? 1 : 0}};
  };
  if (tools > 0) of_tools("contact_press");
  if (tissue) add_touch_pass("touch_press");
  apply(tissue ? "contact_change" : "contact_force");
  if (tools > 0) {
    of_tools("contact_settle");
    pass("contact_tool_sum",
         with_step(named({"contact_tool_force", "contact_rest", "contact_list", "contact_near", "tool_sum", "contact_params"})),
         Shape::items, tools * static_cast<std::int64_t>(contact_sum_parts), "parts of tools");
  }
  if (tissue) add_touch_pass("touch_settle");
  apply("contact_change");
}

/// The broad-phase searches: contact_near for tools, touch_... for tissue.
void ProgramBuilder::add_contact_look() {
  const auto tools = static_cast<std::int32_t>(model_.tools->size());
  if (tools > 0) {
    const std::int64_t tiles = padded(model_.contact->size()) / PLIANT_TILE;
    std::vector<Arg> list = named({"node_u", "node_w", "contact_rest", "contact_node", "contact_weight", "contact_near",
                                   "contact_gap", "contact_yield", "contact_anchor", "tool_kind", "tool_data", "tool_grid",
                                   "tool_pose", of_edges("touch_surface", "contact_weight"), "contact_params"});
    list.push_back(int_arg(tools));
    list.push_back(step_arg());
    program_.look.push_back({"contact_near", {}, std::move(list), Shape::tiles, tiles, "near tools", tiles, 16 * 200.0, 0});
    program_.look.back().uneven = true;
    program_.look.back().defines = {{"EDGES", edged_tools_ != 0 ? 1 : 0}};
  }
  if (model_.tissue_contact) add_touch_look();
}

}  // namespace pliant
