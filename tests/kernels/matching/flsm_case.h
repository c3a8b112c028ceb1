// Launches of the shape matching kernels: one place that knows the order of their arguments, and random data for them.
#pragma once
#include "kernels/nodes/update_case.h"
#include "layout.h"

namespace pliant::kernel_test {

/// Buffers of all shape matching kernels; a case takes those of its kernel. `exact`: not rounded to float before the double
/// twin.
struct FlsmData {
  std::size_t count = 0;  ///< regions in the launch, nodes of flsm_update, interface nodes of flsm_goal and flsm_interface
  Ints slot, link[3], missing_offset, missing, missing_of_offset, missing_of, fault;
  Reals node_u, node_w, node_load, weight, bars, plates, rest, regions, inverse_holders, goals, beta, alpha, step_params;
  Reals missing_factor, missing_of_factor, spin, rates, excess, elastic = Reals(16, 0.0), pulls = Reals(16, 0.0),
                                                                reference = Reals(8, 0.0);
  double spacing = 0.01, damping = 0, shear = 1, bulk = 0;
  int region_base = 0, node_base = 0, fault_base = 0, batch = 0, substeps = 1;
  int interface_base = 0;  ///< of flsm_damp_update: the first region of the interface
  bool exact = false;
};

/// Adds buffers under the kernel's names.
class FlsmArguments {
 public:
  FlsmArguments(const FlsmData& data, const char* stem, Defines defines)
      : data_(data), test_(stem, std::move(defines), Shape::lanes, data.count) {}
  FlsmArguments& reals(const char* name, const Reals& values) {
    data_.exact ? test_.exact(name, values) : test_.reals(name, values);
    return *this;
  }
  FlsmArguments& ints(const char* name, const Ints& values) {
    test_.ints(name, values);
    return *this;
  }
  FlsmArguments& number(double value) {
    data_.exact ? test_.exact(value) : test_.real(value);
    return *this;
  }
  FlsmArguments& integer(int value) {
    test_.integer(value);
    return *this;
  }
  FlsmArguments& step() {
    test_.step();
    return *this;
  }
  /// What every kernel that ends a sum of goals begins with.
  FlsmArguments& goal_sum() {
    return reals("flsm_bars", data_.bars)
        .ints("flsm_link_x", data_.link[0])
        .reals("flsm_regions", data_.regions)
        .ints("flsm_missing_of_offset", data_.missing_of_offset)
        .ints("flsm_missing_of", data_.missing_of)
        .reals("flsm_missing_of_factor", data_.missing_of_factor)
        .reals("flsm_inverse_holders", data_.inverse_holders);
  }
  [[nodiscard]] const KernelCase& test() const { return test_; }

 private:
  const FlsmData& data_;
  KernelCase test_;
};

inline KernelCase flsm_bar_case(const FlsmData& d, int width, int relative) {
  FlsmArguments a(d, "flsm_bar", {{"WIDTH", width}, {"RELATIVE", relative}});
  a.reals("node_u", d.node_u).ints("flsm_slot", d.slot).reals("flsm_weight", d.weight).ints("flsm_link_x", d.link[0]);
  return a.reals("flsm_reference", d.reference).reals("flsm_bars", d.bars).test();
}

inline KernelCase flsm_plate_case(const FlsmData& d, int width) {
  FlsmArguments a(d, "flsm_plate", {{"WIDTH", width}});
  return a.reals("flsm_bars", d.bars).ints("flsm_link_y", d.link[1]).reals("flsm_plates", d.plates).test();
}

inline KernelCase flsm_region_case(const FlsmData& d, int width, int elastic = 0) {
  FlsmArguments a(d, "flsm_region", {{"WIDTH", width}, {"ELASTIC", elastic}});
  a.reals("node_u", d.node_u).reals("flsm_plates", d.plates).ints("flsm_link_z", d.link[2]);
  a.ints("flsm_missing_offset", d.missing_offset)
      .ints("flsm_missing", d.missing)
      .reals("flsm_missing_factor", d.missing_factor);
  a.reals("flsm_reference", d.reference).reals("flsm_rest", d.rest).reals("flsm_regions", d.regions);
  a.reals("flsm_elastic", d.elastic).reals("flsm_pulls", d.pulls);
  return a.number(d.spacing).number(d.shear).number(d.bulk).test();
}

inline KernelCase flsm_goal_plate_case(const FlsmData& d, int width) {
  FlsmArguments a(d, "flsm_goal_plate", {{"WIDTH", width}});
  return a.reals("flsm_regions", d.regions).ints("flsm_link_z", d.link[2]).reals("flsm_plates", d.plates).test();
}

inline KernelCase flsm_goal_bar_case(const FlsmData& d, int width) {
  FlsmArguments a(d, "flsm_goal_bar", {{"WIDTH", width}});
  return a.reals("flsm_plates", d.plates).ints("flsm_link_y", d.link[1]).reals("flsm_bars", d.bars).test();
}

inline KernelCase flsm_goal_case(const FlsmData& d, int width) {
  FlsmArguments a(d, "flsm_goal", {{"WIDTH", width}});
  return a.goal_sum().reals("flsm_reference", d.reference).reals("flsm_goals", d.goals).integer(d.region_base).test();
}

inline KernelCase flsm_update_case(const FlsmData& d, int width, int has_load) {
  FlsmArguments a(d, "flsm_update", {{"WIDTH", width}, {"HAS_LOAD", has_load}});
  a.reals("node_u", d.node_u).reals("node_w", d.node_w).reals("node_load", d.node_load).goal_sum();
  a.reals("flsm_reference", d.reference)
      .reals("step_params", d.step_params)
      .reals("flsm_alpha", d.alpha)
      .ints("fault", d.fault);
  return a.integer(d.batch).integer(d.substeps).integer(d.node_base).integer(d.fault_base).step().test();
}

inline KernelCase flsm_interface_case(const FlsmData& d, int extrapolated) {
  FlsmArguments a(d, "flsm_interface", {{"EXTRAPOLATED", extrapolated}});
  a.reals("node_u", d.node_u).reals("node_load", d.node_load).ints("flsm_slot", d.slot);
  a.reals("flsm_reference", d.reference).reals("flsm_goals", d.goals);
  a.reals("flsm_beta", d.beta).reals("step_params", d.step_params).integer(d.substeps).integer(d.region_base);
  return a.step().test();
}

inline KernelCase flsm_damp_region_case(const FlsmData& d, int width) {
  FlsmArguments a(d, "flsm_damp_region", {{"WIDTH", width}});
  a.reals("node_w", d.node_w).reals("flsm_plates", d.plates).ints("flsm_link_z", d.link[2]);
  a.ints("flsm_missing_offset", d.missing_offset)
      .ints("flsm_missing", d.missing)
      .reals("flsm_missing_factor", d.missing_factor);
  a.reals("flsm_rest", d.rest).reals("flsm_spin", d.spin).reals("flsm_regions", d.regions).reals("flsm_rates", d.rates);
  return a.number(1 / d.spacing).test();
}

inline KernelCase flsm_damp_update_case(const FlsmData& d, int width, int reaction) {
  FlsmArguments a(d, "flsm_damp_update", {{"WIDTH", width}, {"REACTION", reaction}});
  a.reals("node_u", d.node_u).reals("node_w", d.node_w).ints("flsm_slot", d.slot);
  a.reals("flsm_bars", d.bars).ints("flsm_link_x", d.link[0]).reals("flsm_rates", d.rates);
  a.ints("flsm_missing_of_offset", d.missing_of_offset)
      .ints("flsm_missing_of", d.missing_of)
      .reals("flsm_missing_of_factor", d.missing_of_factor)
      .reals("flsm_inverse_holders", d.inverse_holders);
  return a.number(d.damping).integer(d.substeps).integer(d.interface_base).test();
}

inline KernelCase flsm_excess_case(const FlsmData& d) {
  FlsmArguments a(d, "flsm_excess", {});
  a.reals("node_u", d.node_u).ints("flsm_slot", d.slot).reals("flsm_reference", d.reference);
  a.reals("flsm_goals", d.goals).reals("flsm_beta", d.beta);
  a.reals("flsm_alpha", d.alpha).reals("step_params", d.step_params).reals("flsm_excess", d.excess);
  return a.integer(d.batch).integer(d.substeps).integer(d.region_base).test();
}

/// Lists of 0 to 6 entries per region: any of `range` numbers, any four factors.
inline void random_missing(Random& random, std::size_t regions, std::size_t range, Data data, Ints& offset, Ints& entries,
                           Reals& factor) {
  offset = {0};
  for (std::size_t r = 0; r < regions; ++r) offset.push_back(offset.back() + (random.chance(0.5) ? random.integer(0, 6) : 0));
  const auto n = static_cast<std::size_t>(offset.back()) + 1;  // never empty
  entries = random.ints(n, 0, static_cast<int>(range) - 1);
  factor = random.reals(4 * n, data, 5);
}

/// Links of a lattice 4 x 3 x n that end in the last region, or (`any`) to any region.
inline void random_links(Random& random, std::size_t regions, bool any, Ints (&link)[3]) {
  const int last = static_cast<int>(regions) - 1;
  constexpr int stride[3] = {1, 4, 12}, period[3] = {4, 12, 1 << 20};
  for (int axis = 0; axis < 3; ++axis) {
    for (int r = 0; r <= last; ++r) {
      for (const int sign : {-1, 1}) {
        const int next = r + sign * stride[axis];
        const bool inside = r < last && next >= 0 && next < last && next / period[axis] == r / period[axis];
        link[axis].push_back(any ? random.integer(0, last) : inside ? next : last);
      }
    }
  }
}

/// Rest data in tiles: of the class throughout, or those of a region (so that the rotation is of ordinary moments).
inline Reals random_rest(Random& random, std::size_t regions, Data data, bool of_class) {
  Reals rest = random.reals(PLIANT_FLSM_REST_PLANES * regions, data, 5);
  if (of_class) return rest;
  constexpr double lo[PLIANT_FLSM_REST_PLANES] = {1e-3, -1, -1, -1, 1, 1, 1, -0.4, -0.4, -0.4};
  constexpr double hi[PLIANT_FLSM_REST_PLANES] = {1, 1, 1, 1, 40, 40, 40, 0.4, 0.4, 0.4};
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const std::size_t plane = k / PLIANT_TILE % PLIANT_FLSM_REST_PLANES;
    rest[k] = random.uniform(lo[plane], hi[plane]);
  }
  return rest;
}

/// Any data for a launch over `count` regions.
inline FlsmData random_flsm(std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  FlsmData d;
  const std::size_t regions = count + 32, slots = regions + 48;
  const Data constant = data_for_constants(data);
  d.count = count;
  d.slot = random.distinct(regions, slots);
  random_links(random, regions, seed % 2 == 0, d.link);
  random_missing(random, regions, slots, constant, d.missing_offset, d.missing, d.missing_factor);
  random_missing(random, regions, regions, constant, d.missing_of_offset, d.missing_of, d.missing_of_factor);
  d.node_u = node_u_texels(random, slots, data);
  d.node_w = node_w_texels(random, slots, data);
  d.node_load = random.reals(4 * slots, data, 1);
  d.weight = random.reals(regions, constant, 100);
  d.bars = random.reals(8 * regions, data, 1);
  d.plates = random.reals(PLIANT_FLSM_RECORD * regions, data, 20);
  d.rest = random_rest(random, regions, data, seed % 3 == 0);
  d.regions = random.reals(PLIANT_FLSM_RECORD * regions, data, 0.01);
  d.inverse_holders = random.reals(regions, constant, 1);
  d.goals = random.reals(8 * count, data, 0.01);
  d.beta = random.reals(count, constant, 100);
  d.alpha = random.positive(3, 0.1, 1);
  d.step_params = step_parameters(seed);
  d.step_params[6] = random.integer(0, 11);
  d.fault = random.faults(count + 16);
  d.region_base = 16;
  d.node_base = 32;
  d.fault_base = 16;
  d.batch = 1;
  d.substeps = random.integer(1, 4);
  d.reference = random.reals(8, data, 0.01);
  d.spin = random.reals(PLIANT_FLSM_SPIN_PLANES * regions, constant, 1e-3);
  d.rates = random.reals(PLIANT_FLSM_RECORD * regions, data, 1e-4);
  d.excess = random.reals(4 * slots, Data::large, 1e-4);
  d.damping = random.uniform(0, 1);
  d.elastic = random.reals(PLIANT_FLSM_ELASTIC_PLANES * regions, data, 1);
  d.pulls = random.reals(PLIANT_FLSM_RECORD * regions, data, 0.01);
  d.shear = random.uniform(0.7, 1);
  d.bulk = random.uniform(0, 0.6);
  d.interface_base = random.integer(0, static_cast<int>(count));
  return d;
}

/// Bits over all widths and classes of data; the two largest widths over two classes.
class FlsmTwinTest : public TwinTest {
 protected:
  template <class Make>
  void compare(Make make, std::uint32_t seed) {
    for (int width = 1; width <= 5; ++width) {
      for (const Data data : all_data) {
        if (width > 3 && data != Data::large && data != Data::special) continue;
        for (const std::size_t count : {16U, 80U, 528U}) {
          expect_same_bits(make(random_flsm(count, data, seed++), width), name_of(data));
        }
      }
    }
  }
};

}  // namespace pliant::kernel_test
