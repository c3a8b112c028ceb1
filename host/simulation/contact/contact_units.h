// Fixed-point units of contact forces, and what contact_tool_sum leaves per tool and step.
#pragma once
#include <array>
#include <cstdint>

#include "model/model.h"

namespace pliant {

/// One quantum of force [N], torque [N m] and area [m^2]. Powers of two, so that only the conversion to quanta rounds.
struct ContactUnits {
  double force = 0, torque = 0, area = 0;
};
/// What the units of a model with contact points depend on: its heaviest node at a point [kg], their spacing [m], the area of
/// its surface [m^2], and its largest extent, or that of a tool [m].
struct ContactExtent {
  double heaviest = 0, spacing = 0, area = 0, longest = 0;
};
ContactExtent contact_extent(const Model& model);
/// For steps of `dt` [s].
ContactUnits contact_units(const ContactExtent& extent, double dt);

/// The values of the buffer contact_params. `friction` of tissue on tissue; `ease`: fraction of a spacing by which the initial
/// offset of a pair is reduced in each search.
std::array<double, 9> contact_numbers(const Model& model, const ContactUnits& units, double friction, double ease);

/// Sums of a step and a tool: force, torque and area in quanta, largest depth [m], and of a face of a blade the work by which
/// it spreads what the edge has opened, in quanta of force times parts of the margin (contact_spread_parts).
struct ContactSum {
  std::array<double, 7> quanta{};
  double depth = 0, spread = 0;
  std::int64_t points = 0;
};
/// Adds up the parts of one tool in tool_sum, contact_sum_parts x contact_sum_numbers.
ContactSum contact_sum(const std::int32_t* parts);

}  // namespace pliant
