// Forces of contact on the contact points, for measures of pressure.
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
        if ((near[i / PLIANT_TILE] >> t & 1) != 0) forces.add(i, on_tool, t * per_tool + tile_base(i, 8), -units_.force);
      }
    }
  }
  if (run_.scene.contact) {
    const std::vector<std::int32_t> pair = ints("touch_force"), partner = ints("touch_partner"),
                                    change = ints("contact_change");
    for (std::size_t i = 0; i < points; ++i) {
      if ((near[i / PLIANT_TILE] & PLIANT_TOUCH_BIT) == 0) continue;
      for (std::size_t s = 0; s < PLIANT_TOUCH_SLOTS; ++s) {
        if (partner[tile_base(i, PLIANT_TOUCH_SLOTS) + s * PLIANT_TILE] == 0) break;
        const std::size_t base = tile_base(i, PLIANT_TOUCH_SLOTS * PLIANT_TOUCH_FORCE) + s * PLIANT_TOUCH_FORCE * PLIANT_TILE;
        if (pair[base + 3 * PLIANT_TILE] != 0) forces.add(i, pair, base, units_.force);
      }
      const std::size_t base = tile_base(i, 4);
      if (change[base + 3 * PLIANT_TILE] == PLIANT_TOUCH_BIT) forces.add(i, change, base, units_.force);
    }
  }
  return std::move(forces.sum);
}

}  // namespace pliant
