// Buffers and passes of contact of tissue with tissue.
#include <algorithm>

#include "schedule/contact/contact_data.h"
#include "schedule/program_builder.h"

namespace pliant {
namespace {

constexpr std::size_t kFanOut = 16;  // tiles per group, groups per larger group

/// Two levels of groups over the tiles, which are in the order of a space-filling curve, stored in depth-first order
/// (touch_tree.cl).
std::vector<std::int32_t> tree_over(std::size_t tiles) {
  std::vector<std::int32_t> tree;
  auto boxes = static_cast<std::int32_t>(tiles);
  const auto begin_group = [&](std::size_t first, std::size_t size) {
    const std::size_t at = tree.size(), end = std::min(tiles, first + size);
    const bool one = end - first == 1;
    tree.insert(tree.end(), {one ? static_cast<std::int32_t>(first) : boxes++, 0, static_cast<std::int32_t>(first),
                             static_cast<std::int32_t>(end)});
    return at;
  };
  const auto end_group = [&](std::size_t at) { tree[at + 1] = static_cast<std::int32_t>(tree.size() / PLIANT_TOUCH_TREE); };
  for (std::size_t large = 0; large < tiles; large += kFanOut * kFanOut) {
    const std::size_t outer = begin_group(large, kFanOut * kFanOut), outer_end = std::min(tiles, large + kFanOut * kFanOut);
    for (std::size_t small = large; small < outer_end && outer_end - large > 1; small += kFanOut) {
      const std::size_t inner = begin_group(small, kFanOut), inner_end = std::min(outer_end, small + kFanOut);
      for (std::size_t tile = small; tile < inner_end && inner_end - small > 1; ++tile) end_group(begin_group(tile, 1));
      end_group(inner);
    }
    end_group(outer);
  }
  return tree;
}

}  // namespace

/// Adds the derivatives of the surface at points with respect to the nodes.
void ProgramBuilder::add_contact_surface() {
  const ContactPoints& points = *model_.contact;
  const auto count = static_cast<std::size_t>(padded(points.size()));
  std::vector<double> surface(PLIANT_TOUCH_SURFACE * count, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactTangents t = contact_tangents(points, i, model_.rest);
    double* own = &surface[tile_base(i, PLIANT_TOUCH_SURFACE)];
    for (std::size_t a = 0; a < 8; ++a) {
      own[a * PLIANT_TILE] = t.first[a];
      own[(8 + a) * PLIANT_TILE] = t.second[a];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      own[(16 + c) * PLIANT_TILE] = t.t1[c];
      own[(19 + c) * PLIANT_TILE] = t.t2[c];
    }
    own[std::size_t{22} * PLIANT_TILE] = points.apart[i];
    own[std::size_t{23} * PLIANT_TILE] = points.reach(i);
  }
  add(make_reals("touch_surface", BufferType::real, PLIANT_TOUCH_SURFACE * count, BufferRole::constant, "[tiles][24][16]",
                 "see touch_point.cl", "model", std::move(surface)));
}

/// Adds the patches for contact with tool edges, and the forces on their nodes.
void ProgramBuilder::add_contact_patches() {
  const ContactPoints& points = *model_.contact;
  const auto count = static_cast<std::size_t>(padded(points.size()));
  std::vector<double> patch(PLIANT_PATCH * count, 0.0);
  std::vector<char> held(static_cast<std::size_t>(model_.slots), 0);
  for (const Constraint& c : model_.constraints) held[static_cast<std::size_t>(c.slot)] = static_cast<char>(c.axes == 7);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::int32_t on_held = 0;
    for (std::size_t a = 0; a < 8; ++a) {
      if (held[static_cast<std::size_t>(points.nodes[i][a])] != 0) on_held += points.weights[i][a];
    }
    const bool joined = points.joined[i] != 0 || 2 * on_held > contact_weight_unit;
    const std::vector<double> own = contact_patch(points, i, model_.rest, joined);
    for (std::size_t k = 0; k < own.size(); ++k) patch[tile_base(i, PLIANT_PATCH) + k * PLIANT_TILE] = own[k];
  }
  add(make_reals("contact_patch", BufferType::real, PLIANT_PATCH * count, BufferRole::constant, "[tiles][34][16]",
                 "see contact_edge.cl", "model", std::move(patch)));
  add(make_reals("contact_corner_weight", BufferType::real, 9 * count, BufferRole::scratch, "[tiles][9][16]", "1",
                 "contact_press"));
  program_.buffers.back().carried = Carried::all;
  add(make_ints("contact_corner_force", BufferRole::scratch, "[tiles][8][3][16]", {}, 24 * count,
                "contact_press, contact_settle"));
  program_.buffers.back().carried = Carried::all;
}

void ProgramBuilder::add_touch() {
  const ContactPoints& points = *model_.contact;
  const auto count = static_cast<std::size_t>(padded(points.size())), tiles = count / PLIANT_TILE;
  std::vector<double> rest(4 * count, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) rest[tile_base(i, 4) + c * PLIANT_TILE] = points.rest[i][c];
    rest[tile_base(i, 4) + std::size_t{3} * PLIANT_TILE] = points.body[i];
  }
  std::vector<std::int32_t> tree = tree_over(tiles);
  const std::size_t nodes = tree.size() / PLIANT_TOUCH_TREE;
  const auto reals = [&](const char* name, std::size_t planes, BufferRole role, const char* shape, const char* unit,
                         const char* producer, std::vector<double> values = {}) {
    add(make_reals(name, BufferType::real, planes * count, role, shape, unit, producer, std::move(values)));
  };
  reals("touch_rest", 4, BufferRole::constant, "[tiles][4][16]", "m, m, m, 1", "model", std::move(rest));
  add(make_ints("touch_node", BufferRole::constant, "[tree][4]", std::move(tree)));
  add_contact_state(
      make_ints("touch_partner", BufferRole::state, "[tiles][16 slots][16]", {}, PLIANT_TOUCH_SLOTS * count, "touch_pair"));
  add_contact_state(make_reals("touch_pair", BufferType::real, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_PAIR * count,
                               BufferRole::state, "[tiles][16 slots][6][16]", "see kernels/layout.h",
                               "touch_pair, touch_press, touch_settle"));
  add_contact_state(make_reals("touch_depth", BufferType::real, count, BufferRole::state, "[points]", "m", "touch_press"));
  reals("touch_place", PLIANT_TOUCH_PLACE, BufferRole::scratch, "[points][20]", "see touch_point.cl", "touch_place");
  program_.buffers.back().carried = Carried::all;  // points near nothing keep the values of the last search
  reals("touch_weight", PLIANT_TOUCH_SLOTS + 1, BufferRole::scratch, "[tiles][17][16]", "1 (16), m^2", "touch_pair");
  program_.buffers.back().carried = Carried::all;
  add(make_reals("touch_box", BufferType::real, PLIANT_TOUCH_BOX * (nodes + tiles), BufferRole::scratch, "[boxes][19]",
                 "m (12), 1 (6), m", "touch_box, touch_tree"));
  program_.buffers.back().carried = Carried::all;
  add(make_ints("touch_force", BufferRole::scratch, "[tiles][16 slots][4][16]", {},
                PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_FORCE * count, "touch_press, touch_settle"));
  program_.buffers.back().carried = Carried::all;
  add(make_ints("touch_moment", BufferRole::scratch, "[points][8]", {}, PLIANT_TOUCH_MOMENT * count,
                "touch_press, touch_settle"));
  program_.buffers.back().carried = Carried::all;
}

void ProgramBuilder::add_touch_look() {
  const auto points = static_cast<std::int64_t>(padded(model_.contact->size()));
  const std::int64_t tiles = points / PLIANT_TILE;
  const auto nodes = static_cast<std::int64_t>(program_.at(program_.find("touch_node")).count) / PLIANT_TOUCH_TREE;
  const auto pass = [&](const char* kernel, std::vector<Arg> list, Shape shape, std::int64_t count, const char* label,
                        double bytes) {
    program_.look.push_back({kernel, {}, std::move(list), shape, count, label, count, bytes, 0});
    program_.look.back().uneven = true;
  };
  pass("touch_box",
       named(
           {"node_u", "node_w", "contact_rest", "contact_node", "contact_weight", "touch_surface", "touch_place", "touch_box"}),
       Shape::tiles, tiles, "boxes of contact points", 16 * 350.0);
  pass("touch_tree", named({"touch_node", "touch_box"}), Shape::items, nodes, "boxes of tiles", 100);
  std::vector<Arg> pair =
      named({"touch_place", "touch_box", "touch_node", "touch_surface", "touch_rest", "contact_rest", "contact_node",
             "touch_partner", "touch_pair", "touch_weight", "contact_near", "contact_yield", "contact_params"});
  pair.push_back(int_arg(static_cast<std::int32_t>(nodes)));
  pass("touch_pair", std::move(pair), Shape::tiles, tiles, "partners", 16 * 200.0);
  pass("touch_share", named({"contact_rest", "contact_near", "touch_partner", "touch_weight", "touch_pair"}), Shape::lanes,
       points, "areas of pairs", 0.25);
}

void ProgramBuilder::add_touch_pass(const char* kernel) {
  const auto points = static_cast<std::int64_t>(padded(model_.contact->size()));
  const bool first = std::string(kernel) == "touch_press";
  std::vector<Arg> list =
      first ? named({"touch_place", "contact_list", "contact_near", "contact_yield", "contact_force", "contact_change",
                     "touch_partner", "touch_pair", "touch_force", "touch_moment", "touch_depth", "contact_params"})
            : named({"touch_place", "contact_list", "contact_near", "contact_change", "touch_partner", "touch_pair",
                     "touch_force", "touch_moment", "contact_params"});
  std::vector<Arg> place = named({"node_u", "node_w", "contact_rest", "contact_node", "contact_weight", "contact_share",
                                  "contact_list", "contact_near", "contact_yield", "contact_change", "contact_node_sum",
                                  "touch_surface", "touch_place", "step_params"});
  place.push_back(int_arg(first ? 0 : 1));
  const auto pass = [&](const char* name, std::vector<Arg> args, const char* label) {
    program_.step.push_back({name, {}, std::move(args), Shape::lanes, points, label, points, 0, 0});
    program_.step.back().uneven = true;
    program_.step.back().active = program_.near_points;
  };
  pass("touch_place", std::move(place), "near points");
  pass(kernel, std::move(list), "pairs");
}

}  // namespace pliant
