// Forces of contact on the contact points, for measures of pressure and for the account of energy.
#include "geometry/vec.h"
#include "schedule/program_layout.h"
#include "simulation/contact/tool_contact.h"

namespace pliant {
namespace {

/// Sums of rows of integers, shape [tiles][planes][PLIANT_TILE], whose first three planes are a force in quanta.
class PointSums {
 public:
  explicit PointSums(std::size_t points) : sum(points) {}
  /// `base`: index of the first plane of a point.
  void add(std::size_t point, const std::vector<std::int32_t>& values, std::size_t base, double factor) {
    for (std::size_t c = 0; c < 3; ++c) sum[point][c] += factor * values[base + c * PLIANT_TILE];
  }
  std::vector<Vec3d> sum;
};

}  // namespace

std::vector<Vec3d> ToolContact::point_forces() const {
  if (!active() || known_at_ != run_.state.clock.step || known_changes_ != run_.loaded.changes()) return {};
  const Program& program = run_.loaded.program();
  const auto ints = [&](const char* name) { return run_.backend().read_ints(program.find(name)); };
  const std::size_t points = run_.model().contact->size(), tools = tools_.size();
  const std::vector<std::int32_t> near = ints("contact_near");
  PointSums forces(points);
  if (tools > 0) {
    const std::vector<std::int32_t> on_tool = ints("contact_tool_force");
    const std::size_t per_tool = on_tool.size() / tools;
    for (std::size_t i = 0; i < points; ++i) {
      for (std::size_t t = 0; t < tools; ++t) {
        const std::size_t base = t * per_tool + tile_base(i, 8);
        const bool touches = on_tool[base + std::size_t{7} * PLIANT_TILE] != 0;  // otherwise they are forces of an earlier step
        if ((near[i / PLIANT_TILE] >> t & 1) != 0 && touches) forces.add(i, on_tool, base, -units_.force);
      }
    }
  }
  if (run_.scene.contact) {
    const std::vector<std::int32_t> pair = ints("touch_force"), partner = ints("touch_partner");
    for (std::size_t i = 0; i < points; ++i) {
      if ((near[i / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) continue;
      for (std::size_t s = 0; s < PLIANT_TOUCH_SLOTS; ++s) {
        if (partner[tile_base(i, PLIANT_TOUCH_SLOTS) + s * PLIANT_TILE] == 0) break;
        const std::size_t base = tile_base(i, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_FORCE) + s * PLIANT_TOUCH_FORCE * PLIANT_TILE;
        if (pair[base + 3 * PLIANT_TILE] != 0) forces.add(i, pair, base, units_.force);
      }
    }
  }
  return std::move(forces.sum);
}

std::vector<Vec3d> ToolContact::node_forces() const {
  const std::vector<Vec3d> force = point_forces();
  if (force.empty()) return {};
  const ContactPoints& points = *run_.model().contact;
  std::vector<Vec3d> out(run_.model().mass.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 8; ++a) {
      Vec3d& sum = out[static_cast<std::size_t>(points.nodes[i][a])];
      sum = vec::add(sum, vec::mul(force[i], double(points.weights[i][a]) / contact_weight_unit));
    }
  }
  return out;
}

double ToolContact::held_energy() const {
  const BufferId id = active() ? run_.loaded.program().find("contact_anchor") : -1;
  const std::vector<Vec3d> force = id < 0 ? std::vector<Vec3d>() : point_forces();
  if (force.empty()) return 0;
  const ContactPoints& points = *run_.model().contact;
  const std::vector<double> anchor = run_.backend().read_reals(id), u = run_.u();
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t base = tile_base(i, 4);
    const double by = anchor[base + 3 * PLIANT_TILE];
    if (!(by < 0) || -by > static_cast<double>(tools_.size())) continue;  // not gripped, or slipped out
    Vec3d x = points.rest[i];
    for (std::size_t a = 0; a < 8; ++a) {
      const double weight = double(points.weights[i][a]) / contact_weight_unit;
      const std::size_t at = 4 * static_cast<std::size_t>(points.nodes[i][a]);
      x = vec::add(x, vec::mul(Vec3d{u[at], u[at + 1], u[at + 2]}, weight));
    }
    const Pose at = pose(static_cast<std::size_t>(-by) - 1, run_.state.clock.time());
    const Vec3d held = place(at, {anchor[base], anchor[base + PLIANT_TILE], anchor[base + 2 * PLIANT_TILE]});
    sum += vec::norm(force[i]) * vec::norm(vec::sub(held, x));
  }
  return sum;
}

}  // namespace pliant
