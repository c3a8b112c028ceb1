// Random contact: points on nodes of a made-up body, tools of every shape among them.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "kernels/random_data.h"
#include "layout.h"

namespace pliant::kernel_test {

/// Everything that the passes of contact read. The numbers are of a body of about 1 m whose nodes weigh about 1 kg.
struct ContactData {
  static constexpr std::size_t tools = 5, rows = test_step + 2, frames = 3, pose_numbers = 15, edges = 24;
  std::size_t points, slots = 96;
  Reals node_u, node_w, rest, weight, share, held, yield, anchor, left_deep, node_sum, data, grid, pose, params, step_params;
  Ints node, near, force, change, tool_force, sum, kind;
  Reals gap;
  Ints node_list, slot, free, tiles_offset, tiles, entry_offset, entry, gather_offset, gather, units, turns, moment;
  Reals edge, surface, patch, corner_weight;
  Ints corner_force, corner;

  static std::size_t base(std::size_t i, std::size_t planes) { return i / 16 * planes * 16 + i % 16; }

  explicit ContactData(std::uint32_t seed, Data kind_of_data = Data::large, std::size_t count = 64) : points(count) {
    Random random(seed);
    node_u = random.reals(4 * (slots + 1), kind_of_data, 0.02);
    node_w = random.reals(4 * (slots + 1), kind_of_data, 1e-3);
    for (std::size_t s = 0; s < slots; ++s) {
      node_u[4 * s + 3] = random.uniform(0.5, 2);
      node_w[4 * s + 3] = random.uniform(0.9, 1);
    }
    make_points(random);
    make_tools(random);
    make_gather();
    make_patches(random);
  }

 private:
  Ints turn;  // [points][2][8] units of the gradients along both tangents

  void make_points(Random& random) {
    rest.resize(4 * points);
    weight.resize(8 * points);
    share.resize(8 * points);
    held.assign(4 * points, 0.0);
    node.resize(8 * points);
    anchor.assign(4 * points, 0.0);
    left_deep.assign(2 * points, 0.0);
    for (std::size_t i = 0; i < points; ++i) {
      for (std::size_t c = 0; c < 3; ++c) rest[base(i, 4) + 16 * c] = random.uniform(-0.6, 0.6);
      rest[base(i, 4) + 48] = random.chance(0.1) ? 0 : random.uniform(0.001, 0.01);
      const Ints own = random.distinct(8, slots);
      std::array<int, 8> parts{};
      for (int k = 0; k < 4096; k += 64) parts[static_cast<std::size_t>(random.integer(0, 7))] += 64;
      for (std::size_t a = 0; a < 8; ++a) {
        node[base(i, 8) + 16 * a] = own[a];
        weight[base(i, 8) + 16 * a] = parts[a] / 4096.0;
        share[base(i, 8) + 16 * a] = random.chance(0.1) ? 0 : parts[a] / 4096.0 * random.uniform(0.01, 0.05);
        if (share[base(i, 8) + 16 * a] == 0) held[base(i, 4) + 48] += parts[a] / 4096.0;
      }
      for (std::size_t c = 0; c < 3; ++c) {  // of what is held, which lies anywhere near the point
        held[base(i, 4) + 16 * c] = held[base(i, 4) + 48] * (rest[base(i, 4) + 16 * c] + 0.2 * std::sin(double(3 * i + c)));
      }
      if (random.chance(0.5)) {
        for (std::size_t c = 0; c < 3; ++c) anchor[base(i, 4) + 16 * c] = random.uniform(-0.1, 0.1);
        anchor[base(i, 4) + 48] = random.integer(1, static_cast<int>(tools));
      }
    }
    yield.resize(points);
    for (double& y : yield) y = random.chance(0.5) ? 0 : random.uniform(1e-6, 1e-5);
    near = random.ints(points / 16, 0, 31);
    near[0] = 31;
    gap.assign(points / 16 * tools, 0.0);
    force = random.ints(4 * points, -1000000, 1000000);
    change = force;
    for (std::size_t i = 0; i < points; ++i) {
      const int ready = random.chance(0.5) ? PLIANT_READY_BIT : 0;
      force[base(i, 4) + 48] = change[base(i, 4) + 48] = random.integer(0, 31) | ready;
    }
    tool_force = random.ints(8 * points * tools, -2000000, 2000000);
    for (std::size_t t = 0; t < tools; ++t) {
      for (std::size_t i = 0; i < points; ++i) {
        const std::size_t at = 8 * points * t + base(i, 8);
        tool_force[at + 96] = std::bit_cast<std::int32_t>(static_cast<float>(random.uniform(0, 0.01)));
        tool_force[at + 112] = force[base(i, 4) + 48] >> t & 1;
      }
    }
    node_sum = random.positive(4 * (slots + 1), 0.001, 0.05);
    moment = random.ints(PLIANT_TOUCH_MOMENT * points, -1000000, 1000000);
    turn.resize(16 * points);
    for (std::size_t i = 0; i < points; ++i) {
      for (std::size_t k = 0; k < 16; k += 8) {  // they sum to zero
        for (std::size_t a = 1; a < 8; ++a) {
          turn[16 * i + k + a] = random.integer(-3000, 3000);
          turn[16 * i + k] -= turn[16 * i + k + a];
        }
      }
    }
  }

  /// Patches about as large as the points are apart; half of them move as in a cell.
  void make_patches(Random& random) {
    surface = random.reals(PLIANT_TOUCH_SURFACE * points, Data::large, 3);
    patch.assign(PLIANT_PATCH * points, 0.0);
    corner_weight = random.positive(9 * points, 0.01, 1);
    corner_force = random.ints(24 * points, -1000000, 1000000);
    for (std::size_t i = 0; i < points; ++i) {
      const double angle = random.uniform(0, 6), c = std::cos(angle), s = std::sin(angle);
      const Reals tangents{c, s, 0, -s, c, 0}, along{3 * c, 3 * s, 0, -3 * s, 3 * c, 0};
      for (std::size_t k = 0; k < 6; ++k) surface[base(i, PLIANT_TOUCH_SURFACE) + 16 * (16 + k)] = tangents[k];
      surface[base(i, PLIANT_TOUCH_SURFACE) + 16 * 22] = random.uniform(0.2, 0.5);
      surface[base(i, PLIANT_TOUCH_SURFACE) + 16 * 23] = random.uniform(0.1, 0.3);
      double* own = &patch[base(i, PLIANT_PATCH)];
      for (std::size_t k = 0; k < 6; ++k) {
        const double way = static_cast<double>(k) + random.uniform(-0.2, 0.2);
        own[16 * (4 * k)] = std::cos(way);
        own[16 * (4 * k + 1)] = std::sin(way);
        own[16 * (4 * k + 2)] = random.uniform(0.1, 0.3);
        own[16 * (4 * k + 3)] = random.uniform(0.02, 0.2);
      }
      for (std::size_t k = 0; k < 3; ++k) own[16 * (24 + k)] = random.uniform(0, 1);
      for (std::size_t k = 0; k < 6; ++k) own[16 * (27 + k)] = along[k];
      own[16 * 33] = random.chance(0.5) ? 1 : 0;
    }
    for (std::size_t e = 0; e < edges; ++e) {
      for (int k = 0; k < 3; ++k) edge.push_back(random.uniform(-0.5, 0.5));
      edge.push_back(random.uniform(0, 0.1));
    }
  }

  void make_tools(Random& random) {
    grid = random.reals(frames * 6 * 5 * 4, Data::large, 0.2);
    for (std::size_t t = 0; t < tools; ++t) {
      // The last tool is a mesh, or a sequence.
      const std::int32_t of_sequence = t == 4 && random.chance(0.5) ? static_cast<std::int32_t>(frames) : 0;
      kind.insert(kind.end(), {static_cast<std::int32_t>(t), 0, 6, 5, 4, of_sequence, 0, 0});
      if (t != 3 && of_sequence == 0) {
        kind[8 * t + 6] = static_cast<std::int32_t>(4 * t);
        kind[8 * t + 7] = t == 1 ? 0 : static_cast<std::int32_t>(4 + t);
      }
      Reals d{random.uniform(0.2, 0.5)};
      for (int k = 0; k < 3; ++k) d.push_back(random.uniform(-0.3, 0));
      if (t == 3) {
        d.insert(d.end(), {0.6, 0, 0.8});
      } else {
        for (int k = 0; k < 3; ++k) d.push_back(random.uniform(0.1, 0.4));
      }
      d.insert(d.end(), {-0.5, -0.4, -0.3, 5, 0.2});
      d.insert(d.end(), {t % 2 == 0 ? 0.0 : 1e4, 0.3, t == 0 ? 0.0 : 0.4, t % 2 == 0 ? 0.0 : 0.01, t == 3 ? 1.0 : 0.0});
      d.resize(20, 0.0);
      data.insert(data.end(), d.begin(), d.end());
    }
    sum.assign(rows * tools * 16 * 18, 7);  // what was there does not stay
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t t = 0; t < tools; ++t) {
        const double angle = 0.1 * static_cast<double>(row) + static_cast<double>(t), c = std::cos(angle), s = std::sin(angle);
        pose.insert(pose.end(), {c, -s, 0, s, c, 0, 0, 0, 1});
        for (int k = 0; k < 3; ++k) pose.push_back(0.001 * static_cast<double>(row) + random.uniform(-1e-4, 1e-4));
        pose.push_back(static_cast<double>(row % (frames - 1)));
        pose.push_back(random.chance(0.3) ? 0 : random.uniform(0, 1));
        pose.push_back(0);
      }
    }
    const double unit = std::ldexp(1.0, -10);
    params = {unit, 1 / unit, unit / 4096, 1 / (2 * unit), std::ldexp(1.0, 20), 0.05, 16, 0, 0};
    step_params = {1e-3, 0, 0, -9.81, 0, 0, 0, 0};
  }

  /// The nodes in order; a last tile is filled up with a slot that is none.
  void make_gather() {
    std::vector<std::vector<std::array<std::int32_t, 5>>> at(slots + 16);
    for (std::size_t i = 0; i < points; ++i) {
      for (std::size_t a = 0; a < 8; ++a) {
        const int parts = static_cast<int>(weight[base(i, 8) + 16 * a] * 4096);
        at[static_cast<std::size_t>(node[base(i, 8) + 16 * a])].push_back(
            {static_cast<int>(base(i, 4)), parts, turn[16 * i + a], turn[16 * i + 8 + a], static_cast<int>(a)});
      }
    }
    gather_offset = tiles_offset = entry_offset = {0};
    for (std::size_t first = 0; first < at.size(); first += 16) {
      std::size_t most = 0;
      for (std::size_t n = first; n < first + 16; ++n) {
        slot.push_back(n < slots ? static_cast<std::int32_t>(n) : -1);
        free.push_back(n < slots ? static_cast<std::int32_t>(n % 8) : 0);
        most = std::max(most, at[n].size());
        for (const auto& own : at[n]) tiles.push_back(own[0] / 64);
      }
      std::sort(tiles.begin() + tiles_offset.back(), tiles.end());
      tiles.erase(std::unique(tiles.begin() + tiles_offset.back(), tiles.end()), tiles.end());
      tiles_offset.push_back(static_cast<std::int32_t>(tiles.size()));
      for (std::size_t row = 0; row < most; ++row) {
        for (std::size_t n = first; n < first + 16; ++n) {
          gather.push_back(row < at[n].size() ? at[n][row][0] : 0);
          units.push_back(row < at[n].size() ? at[n][row][1] : 0);
          corner.push_back(row < at[n].size() ? at[n][row][4] : -1);
        }
        for (std::size_t k = 2; k < 4; ++k) {
          for (std::size_t n = first; n < first + 16; ++n) turns.push_back(row < at[n].size() ? at[n][row][k] : 0);
        }
      }
      for (std::size_t t = entry_offset.size() - 1; t < tiles.size(); ++t) {
        for (std::size_t row = 0; row < most; ++row) {
          for (std::size_t l = 0; l < 16; ++l) {
            const std::size_t position = 16 * (static_cast<std::size_t>(gather_offset.back()) + row) + l;
            if (row >= at[first + l].size() || gather[position] / 64 != tiles[t]) continue;
            const auto& own = at[first + l][row];
            entry.insert(entry.end(), {static_cast<int>(l) + 16 * (own[0] % 16) + 256 * own[4], own[1], own[2], own[3]});
          }
        }
        entry_offset.push_back(static_cast<int>(entry.size() / 4));
      }
      node_list.push_back(static_cast<std::int32_t>(first / 16));
      gather_offset.push_back(gather_offset.back() + static_cast<std::int32_t>(most));
    }
  }
};

/// The tiles that are near something, as the host lists them, and entries that are none up to the number of all tiles and more.
inline Ints listed(const ContactData& d) {
  Ints list;
  for (std::size_t tile = 0; tile < d.near.size(); ++tile) {
    if (d.near[tile] != 0) list.push_back(static_cast<std::int32_t>(tile));
  }
  list.resize(d.near.size() + 16, -1);
  return list;
}

/// The points of these tiles.
inline std::size_t near_points(const ContactData& d) {
  return d.points - 16 * static_cast<std::size_t>(std::count(d.near.begin(), d.near.end(), 0));
}

inline KernelCase& add_tools(KernelCase& test, const ContactData& d) {
  return test.ints("tool_kind", d.kind)
      .reals("tool_data", d.data)
      .reals("tool_grid", d.grid)
      .reals("tool_edge", d.edge)
      .reals("tool_pose", d.pose)
      .reals("touch_surface", d.surface)
      .reals("contact_patch", d.patch)
      .reals("contact_corner_weight", d.corner_weight)
      .ints("contact_corner_force", d.corner_force)
      .reals("contact_params", d.params);
}

inline KernelCase& add_points(KernelCase& test, const ContactData& d) {
  return test.reals("node_u", d.node_u)
      .reals("node_w", d.node_w)
      .reals("contact_rest", d.rest)
      .ints("contact_node", d.node)
      .reals("contact_weight", d.weight);
}

/// `edges`: 1 where some tools are met along their edges.
inline KernelCase near_case(const ContactData& d, int edges = 0) {
  KernelCase test("contact_near", {{"EDGES", edges}}, Shape::items, d.points / 16);
  add_points(test, d)
      .ints("contact_near", d.near)
      .reals("contact_gap", d.gap)
      .reals("contact_yield", d.yield)
      .reals("contact_anchor", d.anchor);
  test.ints("tool_kind", d.kind)
      .reals("tool_data", d.data)
      .reals("tool_grid", d.grid)
      .reals("tool_pose", d.pose)
      .reals("touch_surface", d.surface)
      .reals("contact_params", d.params)
      .integer(static_cast<int>(ContactData::tools))
      .step();
  return test;
}

/// What press and settle begin with.
inline KernelCase& add_touching(KernelCase& test, const ContactData& d) {
  return add_points(test, d)
      .reals("contact_share", d.share)
      .reals("contact_held", d.held)
      .ints("contact_list", listed(d))
      .ints("contact_near", d.near)
      .reals("contact_yield", d.yield)
      .reals("contact_anchor", d.anchor)
      .reals("contact_start", d.left_deep)
      .ints("contact_force", d.force);
}

/// What press, settle and tool_sum end with.
inline KernelCase& add_counts(KernelCase& test, const ContactData& d) {
  return test.integer(static_cast<int>(d.points)).integer(static_cast<int>(ContactData::tools)).step();
}

/// The same with tools that grip, against some force or any, and let go, and points that they hold.
inline ContactData with_grips(ContactData d) {
  for (std::size_t row = 0; row < ContactData::rows; ++row) {
    for (std::size_t t = 0; t < ContactData::tools; ++t) {
      const double strength = (t + row) % 4 == 0 ? 0 : t == 1 ? 1e15 : 2e4 * static_cast<double>(t + 1);
      d.pose[ContactData::pose_numbers * (row * ContactData::tools + t) + 14] = strength;
    }
  }
  for (std::size_t i = 0; i < d.points; i += 2) d.anchor[ContactData::base(i, 4) + 48] *= -1;
  return d;
}

/// The same with points that an edit has just left where they are, or has left deep in a tool before.
inline ContactData with_starts(ContactData d) {
  for (std::size_t i = 0; i < d.points; ++i) {
    d.left_deep[ContactData::base(i, 2)] = i % 3 == 0 ? -1 : 0.02 * static_cast<double>(i % 7);
    d.left_deep[ContactData::base(i, 2) + 16] = i % 3 == 0 ? 0 : static_cast<double>(i % (ContactData::tools + 1));
  }
  return d;
}

/// The same with both faces of a blade as tools 1 and 2; in some rows it is not in the scene.
inline ContactData with_faces(ContactData d) {
  for (const std::size_t t : {1U, 2U}) {
    d.kind[8 * t] = 6;
    d.kind[8 * t + 7] = 0;
    const Reals shape{t == 1 ? 1.0 : -1.0, 0.6, 0.4, 0.15, 0.4, 0.5, 0.08};  // side, two slopes, half size, from the edge
    std::copy(shape.begin(), shape.end(), d.data.begin() + static_cast<std::ptrdiff_t>(20 * t + 1));
    for (std::size_t row = 0; row < ContactData::rows; ++row) {
      d.pose[ContactData::pose_numbers * (row * ContactData::tools + t) + 12] = row == test_step + 1 || row % 2 == 0 ? 1 : 0;
    }
  }
  d.params[8] = 0.04;
  return with_starts(d);
}

/// `grips`: 1 where some tools can hold tissue.
inline KernelCase press_case(const ContactData& d, int edges = 0, int grips = 0) {
  KernelCase test("contact_press", {{"EDGES", edges}, {"GRIPS", grips}}, Shape::lanes, near_points(d));
  add_touching(test, d).ints("contact_tool_force", d.tool_force);
  add_counts(add_tools(test, d).reals("step_params", d.step_params), d);
  return test;
}

inline KernelCase settle_case(const ContactData& d, int edges = 0, int grips = 0) {
  KernelCase test("contact_settle", {{"EDGES", edges}, {"GRIPS", grips}}, Shape::lanes, near_points(d));
  add_touching(test, d)
      .ints("contact_change", d.change)
      .reals("contact_node_sum", d.node_sum)
      .ints("contact_tool_force", d.tool_force);
  add_counts(add_tools(test, d).reals("step_params", d.step_params), d);
  return test;
}

inline KernelCase tool_sum_case(const ContactData& d) {
  KernelCase test("contact_tool_sum", {}, Shape::items, ContactData::tools * 16);
  test.ints("contact_tool_force", d.tool_force)
      .reals("contact_rest", d.rest)
      .ints("contact_list", listed(d))
      .ints("contact_near", d.near)
      .ints("tool_sum", d.sum)
      .reals("contact_params", d.params);
  add_counts(test, d);
  return test;
}

/// `moment`: with what turns the tangents of points that touch tissue.
inline KernelCase apply_case(const ContactData& d, int moment = 0, int edges = 0) {
  KernelCase test("contact_apply", {{"MOMENT", moment}, {"EDGES", edges}}, Shape::lanes, d.slot.size());
  test.reals("node_u", d.node_u)
      .reals("node_w", d.node_w)
      .ints("contact_slot", d.slot)
      .ints("contact_free", d.free)
      .ints("contact_node_list", d.node_list)
      .ints("contact_tiles_offset", d.tiles_offset)
      .ints("contact_tiles", d.tiles)
      .ints("contact_entry_offset", d.entry_offset)
      .ints("contact_entry", d.entry)
      .ints("contact_gather_offset", d.gather_offset)
      .ints("contact_gather", d.gather)
      .ints("contact_gather_units", d.units)
      .ints("contact_gather_turns", d.turns)
      .ints("contact_near", d.near)
      .ints("contact_force", d.force)
      .ints("touch_moment", d.moment)
      .ints("contact_gather_corner", d.corner)
      .ints("contact_corner_force", d.corner_force)
      .reals("contact_corner_weight", d.corner_weight)
      .reals("contact_rest", d.rest)
      .reals("contact_node_sum", d.node_sum)
      .reals("contact_params", d.params)
      .reals("step_params", d.step_params);
  return test;
}

/// Integers after the pass, in double.
inline Reals ints_in_double(const KernelCase& test, const std::string& name) {
  RefOptions options;
  options.double_precision = true;
  options.threads = 1;
  const auto backend = make_ref_backend(options);
  backend->load(test.program());
  backend->run(test.pass(), test_step);
  backend->finish();
  const Ints values = backend->read_ints(test.program().find(name));
  return {values.begin(), values.end()};
}

/// Bodies of every kind of numbers.
template <class Compare>
void for_contact_data(std::uint32_t seed, Compare compare) {
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Data data = all_data[i % std::size(all_data)];
    compare(ContactData(seed + i, data), std::string(name_of(data)) + ", seed " + std::to_string(seed + i));
  }
}

/// Of contact_tool_force: a component of a tool's sum over what touches it, in quanta.
inline double on_tool(const ContactData& d, const Reals& tool_force, std::size_t tool, std::size_t component) {
  double sum = 0;
  for (std::size_t i = 0; i < d.points; ++i) {
    const std::size_t at = 8 * d.points * tool + ContactData::base(i, 8);
    if ((d.near[i / 16] >> tool & 1) != 0 && tool_force[at + 112] != 0) sum += tool_force[at + 16 * component];
  }
  return sum;
}

/// What points get in the buffer `name`, and with `edges` their nodes, tools give, to the last quantum; `tools_before`:
/// contact_tool_force before the pass, if the pass adds to it.
inline void expect_action_is_reaction(const ContactData& d, const KernelCase& test, const char* name, const Reals& tools_before,
                                      int edges = 0) {
  const Reals corners = ints_in_double(test, "contact_corner_force");
  const Reals force = ints_in_double(test, name), tool_force = ints_in_double(test, "contact_tool_force");
  for (std::size_t c = 0; c < 3; ++c) {
    double points = 0, tools = 0;
    for (std::size_t i = 0; i < d.points; ++i) {
      if (d.near[i / 16] == 0) continue;
      points += force[ContactData::base(i, 4) + 16 * c];
      for (std::size_t a = 0; a < 8 && edges != 0; ++a) points += corners[ContactData::base(i, 24) + 16 * (3 * a + c)];
    }
    for (std::size_t t = 0; t < ContactData::tools; ++t) {
      tools += on_tool(d, tool_force, t, c) - (tools_before.empty() ? 0 : on_tool(d, tools_before, t, c));
    }
    EXPECT_EQ(points, -tools);
    EXPECT_NE(points, 0);
  }
}

}  // namespace pliant::kernel_test
