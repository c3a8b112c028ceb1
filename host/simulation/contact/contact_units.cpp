#include "simulation/contact/contact_units.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/vec.h"
#include "schedule/contact/contact_data.h"
#include "simulation/contact/contact_lists.h"

namespace pliant {
namespace {

/// The quantum of force is 2^-kForceBits of the force that moves the heaviest node one cell in a step.
constexpr int kForceBits = 26;
constexpr int kAreaBits = 26;

double power_of_two(double x) { return std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(x)))); }

}  // namespace

ContactExtent contact_extent(const Model& model) {
  ContactExtent e;
  e.spacing = model.contact->spacing;
  for (const auto& nodes : model.contact->nodes) {
    for (const std::int32_t n : nodes) e.heaviest = std::max(e.heaviest, model.mass[n]);
  }
  for (const double a : model.contact->area) e.area += a;
  vec::Box box;
  for (const Vec3d& x : model.contact->rest) box.extend(x);
  e.longest = vec::norm(vec::sub(box.upper, box.lower));
  for (const ToolForm& form : *model.tools) e.longest = std::max(e.longest, form.reach);
  return e;
}

ContactUnits contact_units(const ContactExtent& extent, double dt) {
  ContactUnits u;
  u.force = power_of_two(extent.heaviest * extent.spacing / (dt * dt)) * std::ldexp(1.0, -kForceBits);
  u.torque = u.force * power_of_two(extent.longest);
  u.area = power_of_two(extent.area) * std::ldexp(1.0, -kAreaBits);
  return u;
}

std::array<double, 9> contact_numbers(const Model& model, const ContactUnits& u, double friction, double ease) {
  return {u.force,    1 / u.force,           u.force / contact_weight_unit,           1 / u.torque,
          1 / u.area, contact_margin(model), static_cast<double>(contact_look_every), friction,
          ease};
}

ContactSum contact_sum(const std::int32_t* part) {
  ContactSum sum;
  for (std::size_t p = 0; p < contact_sum_parts; ++p, part += contact_sum_numbers) {
    for (std::size_t c = 0; c < 7; ++c) sum.quanta[c] += 32768.0 * part[2 * c] + part[2 * c + 1];  // exact below 2^53
    sum.depth = std::max(sum.depth, static_cast<double>(std::bit_cast<float>(part[14])));
    sum.points += part[15];
    sum.spread += 32768.0 * part[16] + part[17];
  }
  return sum;
}

}  // namespace pliant
