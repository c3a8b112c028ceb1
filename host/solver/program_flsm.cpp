// Buffers and passes of fast lattice shape matching: nodes to regions, regions back to nodes, and the force on the interface.
#include <fmt/format.h>

#include <cmath>

#include "model/flsm.h"
#include "solver/program_builder.h"

namespace pliant {
namespace {

/// Where the regions of a batch stand in its buffers: own nodes, the one that stands for absent ones (number `own`), padding,
/// the interface from `interface_base` on, padding; these `nodes` have regions. Then come the fillers, which have sums only,
/// and padding.
struct RegionPlaces {
  std::int32_t own, interface, interface_base, nodes, count;
  explicit RegionPlaces(const FlsmBatch& b)
      : own(b.own),
        interface(b.interface),
        interface_base(b.slots - PLIANT_TILE),
        nodes(interface_base + padded(static_cast<std::size_t>(b.interface))),
        count(nodes + padded(static_cast<std::size_t>(b.fillers))) {}
  [[nodiscard]] std::int32_t of(std::int32_t node) const {
    if (node < 0) return own;
    if (node < own) return node;
    return node < own + interface ? interface_base + node - own : nodes + node - own - interface;
  }
};

/// What to add to the ordered sums (kernels/flsm_records.cl).
struct MissingList {
  std::vector<std::int32_t> offset, other;
  std::vector<double> factor;
};

/// What the buffers hold of the model, in the order of the regions.
struct RegionData {
  std::vector<std::int32_t> slot, link[3];
  MissingList missing, missing_of;
  std::vector<double> weight, rest, inverse_holders;
};

/// Offsets by region, and per entry a number and four factors. `scale` and `number` are functions of the entry's other end.
template <class Number, class Scale>
void add_missing(const RegionPlaces& places, const std::vector<std::int32_t>& offset, const std::vector<RegionEntry>& entries,
                 const Number& number, const Scale& scale, MissingList& out) {
  std::vector<std::int32_t> count(static_cast<std::size_t>(places.nodes) + 1, 0);
  for (std::size_t n = 0; n + 1 < offset.size(); ++n)
    count[places.of(static_cast<std::int32_t>(n)) + 1] = offset[n + 1] - offset[n];
  out.offset.assign(count.size(), 0);
  for (std::size_t r = 1; r < count.size(); ++r) out.offset[r] = out.offset[r - 1] + count[r];
  for (const RegionEntry& entry : entries) {
    out.other.push_back(number(entry.other));
    const double s = entry.sign * scale(entry.other);
    out.factor.insert(out.factor.end(), {s, s * entry.offset[0], s * entry.offset[1], s * entry.offset[2]});
  }
}

/// Sums run over displacements [m] with weights m / (mean m, spacing): the moments are plain numbers of moderate size.
RegionData region_data(const FlsmBatch& b, const RegionPlaces& places) {
  RegionData data;
  const std::size_t nodes = b.slot.size(), count = static_cast<std::size_t>(places.count);
  const auto with_region = static_cast<std::size_t>(places.nodes);
  data.slot.resize(count);
  for (std::int32_t r = 0; r < places.count; ++r) {
    // What is no node gets a slot without a node; the interface's padding each its own, for flsm_interface writes there.
    const std::int32_t last = places.interface_base + (r - places.interface_base) % PLIANT_TILE;
    data.slot[r] = b.first_slot + (r < places.interface_base ? r : r < places.nodes ? last : places.own);
  }
  for (auto& link : data.link) link.assign(2 * count, places.own);
  data.weight.assign(count, 0.0);
  data.inverse_holders.assign(with_region, 0.0);
  data.rest.assign(PLIANT_FLSM_REST_PLANES * with_region, 0.0);
  double mean = 0;
  for (const double w : b.weight) mean += w / static_cast<double>(nodes);
  const std::vector<RestMoments> moments = rest_moments(b);
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto r = static_cast<std::size_t>(places.of(static_cast<std::int32_t>(n)));
    data.slot[r] = b.slot[n];
    data.weight[r] = b.weight[n] / (mean * b.spacing);
    data.inverse_holders[r] = 1.0 / b.regions.holders[n];
    const RestMoments& m = moments[n];
    const double x = m[1] / m[0], y = m[2] / m[0], z = m[3] / m[0];
    const double plane[PLIANT_FLSM_REST_PLANES] = {mean * b.spacing / m[0],
                                                   x,
                                                   y,
                                                   z,
                                                   (m[4] - m[1] * x) / mean,
                                                   (m[5] - m[2] * y) / mean,
                                                   (m[6] - m[3] * z) / mean,
                                                   (m[7] - m[1] * y) / mean,
                                                   (m[8] - m[1] * z) / mean,
                                                   (m[9] - m[2] * z) / mean};
    for (int p = 0; p < PLIANT_FLSM_REST_PLANES; ++p) {
      data.rest[tile_base(r, PLIANT_FLSM_REST_PLANES) + p * PLIANT_TILE] = plane[p];
    }
  }
  for (std::size_t n = 0; n < b.link.size(); ++n) {
    const auto r = static_cast<std::size_t>(places.of(static_cast<std::int32_t>(n)));
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) data.link[axis][2 * r + side] = places.of(b.link[n][2 * axis + side]);
    }
  }
  const FlsmRegions& regions = b.regions;
  add_missing(
      places, regions.missing_offset, regions.missing, [&](std::int32_t n) { return b.slot[n]; },
      [&](std::int32_t n) { return b.weight[n] / (mean * b.spacing); }, data.missing);
  add_missing(
      places, regions.missing_of_offset, regions.missing_of, [&](std::int32_t r) { return places.of(r); },
      [](std::int32_t) { return 1.0; }, data.missing_of);
  return data;
}

}  // namespace

void ProgramBuilder::add_flsm(std::size_t index) {
  const FlsmBatch& b = model_.flsm[index];
  const RegionPlaces places(b);
  RegionData data = region_data(b, places);
  const auto count = static_cast<std::size_t>(places.count), with_region = static_cast<std::size_t>(places.nodes);
  const auto nodes = static_cast<std::int64_t>(b.slot.size());
  const double missing = double(data.missing.other.size()) / double(nodes),
               missing_of = double(data.missing_of.other.size()) / double(nodes);
  const auto name = [&](const char* stem) { return fmt::format("{}/{}", stem, index); };
  const auto constants = [&](const char* stem, const char* shape, std::vector<std::int32_t> values) {
    return add(make_ints(name(stem), BufferRole::constant, shape, std::move(values), 2));
  };
  const auto numbers = [&](const char* stem, std::size_t size, BufferRole role, const char* shape, const char* unit,
                           const char* producer, std::vector<double> values = {}) {
    return add(make_reals(name(stem), BufferType::real, size, role, shape, unit, producer, std::move(values)));
  };
  const auto slot = constants("flsm_slot", "[regions]", std::move(data.slot));
  const auto link_x = constants("flsm_link_x", "[regions][2]", std::move(data.link[0]));
  const auto link_y = constants("flsm_link_y", "[regions][2]", std::move(data.link[1]));
  const auto link_z = constants("flsm_link_z", "[regions][2]", std::move(data.link[2]));
  const auto list = [&](const char* stem, MissingList& from) {
    const std::string numbers_name = fmt::format("{}_factor", stem), offset_name = fmt::format("{}_offset", stem);
    const std::size_t entries = std::max<std::size_t>(from.other.size(), 1);
    const auto offset = constants(offset_name.c_str(), "[regions + 1]", std::move(from.offset));
    const auto other = constants(stem, "[entries]", std::move(from.other));
    const auto factor =
        numbers(numbers_name.c_str(), 4 * entries, BufferRole::constant, "[entries][4]", "1", "model", std::move(from.factor));
    return std::array<Arg, 3>{buffer_arg(offset), buffer_arg(other), buffer_arg(factor)};
  };
  const auto missing_args = list("flsm_missing", data.missing), missing_of_args = list("flsm_missing_of", data.missing_of);
  const auto weight = numbers("flsm_weight", count, BufferRole::constant, "[regions]", "1/m", "model", std::move(data.weight));
  const auto rest = numbers("flsm_rest", PLIANT_FLSM_REST_PLANES * with_region, BufferRole::constant, "[tiles][10][16]", "m, 1",
                            "model", std::move(data.rest));
  const auto holders = numbers("flsm_inverse_holders", with_region, BufferRole::constant, "[regions]", "1", "model",
                               std::move(data.inverse_holders));
  const auto bars = numbers("flsm_bars", 8 * count, BufferRole::scratch, "[regions][2][4]", "1", "flsm_bar, flsm_goal_bar");
  const auto plates = numbers("flsm_plates", PLIANT_FLSM_RECORD * count, BufferRole::scratch, "[regions][4][4]", "1",
                              "flsm_plate, flsm_goal_plate");
  const auto regions =
      numbers("flsm_regions", PLIANT_FLSM_RECORD * count, BufferRole::state, "[regions][4][4]", "m", "flsm_region");
  if (flsm_alpha_ < 0) {
    flsm_alpha_ =
        add(make_reals("flsm_alpha", BufferType::real, model_.flsm.size(), BufferRole::control, "[batches]", "1", "host"));
  }
  const int width = b.settings.width;
  const std::string label = fmt::format("{}: shape matching", model_.bodies[b.body].name);
  const auto pass = [&](const char* kernel, std::vector<std::pair<std::string, int>> defines, std::vector<Arg> args,
                        std::int64_t indices, std::int64_t elements, double bytes, double flops, int every) {
    program_.step.push_back(
        {kernel, std::move(defines), std::move(args), Shape::lanes, indices, label, elements, bytes, flops, every});
  };
  const Arg u = buffer_arg(node_u_);
  const int n = b.settings.substeps;
  const auto all = static_cast<std::int64_t>(count);
  pass("flsm_bar", {{"WIDTH", width}}, {u, buffer_arg(slot), buffer_arg(weight), buffer_arg(link_x), buffer_arg(bars)}, all,
       nodes, 64, 8 + 32.0 * width, n);
  pass("flsm_plate", {{"WIDTH", width}}, {buffer_arg(bars), buffer_arg(link_y), buffer_arg(plates)}, all, nodes, 104,
       28.0 * width, n);
  pass("flsm_region", {{"WIDTH", width}},
       {u, buffer_arg(plates), buffer_arg(link_z), missing_args[0], missing_args[1], missing_args[2], buffer_arg(rest),
        buffer_arg(regions), real_arg(b.spacing)},
       places.nodes, nodes, 184 + 8 * missing, 36.0 * width + 35 * missing + 1480, n);
  pass("flsm_goal_plate", {{"WIDTH", width}}, {buffer_arg(regions), buffer_arg(link_z), buffer_arg(plates)}, all, nodes, 136,
       36.0 * width, n);
  pass("flsm_goal_bar", {{"WIDTH", width}}, {buffer_arg(plates), buffer_arg(link_y), buffer_arg(bars)}, all, nodes, 104,
       28.0 * width, n);
  const double goal_bytes = 44 + 8 * missing_of, goal_flops = 20.0 * width + 4 + 28 * missing_of;
  const auto goals_of = [&](std::vector<Arg> first, std::vector<Arg> last) {
    first.insert(first.end(), {buffer_arg(bars), buffer_arg(link_x), buffer_arg(regions), missing_of_args[0],
                               missing_of_args[1], missing_of_args[2], buffer_arg(holders)});
    first.insert(first.end(), last.begin(), last.end());
    return first;
  };
  if (b.interface > 0) {
    const auto shared = static_cast<std::size_t>(places.nodes - places.interface_base);
    const auto goals = numbers("flsm_goals", 8 * shared, BufferRole::state, "[interface][2][4]", "m", "flsm_goal");
    if (n > 1) {  // held or extrapolated over several steps, so a part of the state to go back to
      add(make_reals(fmt::format("last_flsm_goals/{}", index), BufferType::real, 8 * shared, BufferRole::state,
                     "[interface][2][4]", "m", "host"));
    }
    const auto beta = numbers("flsm_beta", shared, BufferRole::control, "[interface]", "N/m", "host");
    pass("flsm_goal", {{"WIDTH", width}}, goals_of({}, {buffer_arg(goals), int_arg(places.interface_base)}),
         static_cast<std::int64_t>(shared), b.interface, goal_bytes + 64, goal_flops, n);
    // Held goals pull in the first substep alone, n times as hard, when both ends of the spring are where the regions saw them:
    // an impulse like that of shape matching's own nodes, so that momenta are kept. In later substeps they would drag at nodes
    // that have moved on.
    const int pulls = b.settings.extrapolate ? 1 : n;
    pass("flsm_interface", {{"EXTRAPOLATED", b.settings.extrapolate && n > 1 ? 1 : 0}},
         {u, buffer_arg(node_load_), buffer_arg(slot), buffer_arg(goals), buffer_arg(beta), buffer_arg(params_), int_arg(n),
          int_arg(places.interface_base), step_arg()},
         static_cast<std::int64_t>(shared), b.interface, 88, 12, pulls);
  }
  if (b.own > 0) {
    pass("flsm_update", {{"WIDTH", width}, {"HAS_LOAD", needs_load() ? 1 : 0}},
         goals_of({u, buffer_arg(node_w_), buffer_arg(node_load_)},
                  {buffer_arg(params_), buffer_arg(flsm_alpha_), buffer_arg(fault_), int_arg(static_cast<std::int32_t>(index)),
                   int_arg(n), int_arg(b.first_slot), int_arg(layout_.flsm[index].fault_base), step_arg()}),
         places.interface_base, b.own, goal_bytes + 64 + (needs_load() ? 16 : 0), goal_flops + 27, n);
  }
}

}  // namespace pliant
