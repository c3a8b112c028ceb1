#include "simulation/state/run_context.h"

#include <algorithm>
#include <numeric>

#include "schedule/program_layout.h"

namespace pliant {

std::int32_t substeps_of(const Model& model, std::size_t slot) {
  for (const FlsmBatch& b : model.flsm) {
    if (static_cast<std::int64_t>(slot) >= b.first_slot && static_cast<std::int64_t>(slot) < b.first_slot + b.slots)
      return b.settings.substeps;
  }
  return 1;
}

std::int64_t RunContext::period() const {
  std::int64_t period = 1;
  for (const FlsmBatch& b : model().flsm) period = std::lcm(period, std::int64_t{b.settings.substeps});
  return period;
}

bool RunContext::begins_after(std::int64_t step, std::int64_t every) const {
  const std::int64_t p = period();
  return step % p == 0 && step % every < p;
}

bool RunContext::reached(double time, std::int64_t step) const {
  constexpr double kRounding = 1e-6;  // of a step: times are sums of steps
  return state.clock.time_at(step) >= time - kRounding * state.clock.dt;
}

double RunContext::decay(const Model& of, std::size_t slot) const {
  const double k = 0.5 * substeps_of(of, slot) * state.clock.dt * (of.damping[slot] + state.relaxation.damping);
  return integrator_info(scene.integrator).decay(k);
}

std::vector<double> RunContext::increments() const {
  std::vector<double> w = loaded.w();
  const IntegratorInfo& info = integrator_info(scene.integrator);
  if (info.keeps_increment) return w;
  const std::vector<double> u = loaded.u();
  for (std::size_t i = 0; i < w.size(); ++i) w[i] = info.increment(u[i], w[i]);
  return w;
}

std::vector<Vec3d> RunContext::velocities(const std::vector<double>& increments, std::size_t body) const {
  std::vector<Vec3d> v = loaded.pick(increments, body, 1 / state.clock.dt);
  for (std::size_t n = 0; n < v.size() && !model().flsm.empty(); ++n) {
    const auto slot = static_cast<std::size_t>(model().bodies[body].slot[n]);
    for (std::size_t c = 0; c < 3; ++c) {
      if (loaded.free()[3 * slot + c]) v[n][c] /= substeps_of(model(), slot);  // prescribed components move in every substep
    }
  }
  return v;
}

std::vector<double> RunContext::u() const {
  std::vector<double> u = loaded.u();
  for (std::size_t i = 0; i < state.offset.size(); ++i) u[i / 3 * 4 + i % 3] += state.offset[i];
  return u;
}

void RunContext::write_u(std::vector<double> u) const {
  for (std::size_t i = 0; i < state.offset.size(); ++i) u[i / 3 * 4 + i % 3] -= state.offset[i];
  loaded.write_u(u);
}

void RunContext::place_surface() const {
  const ModelSurface& s = model().surface;
  if (state.offset.empty() || s.rest.empty()) return;
  place_contact();
  const BufferId id = loaded.surface_rest();
  std::vector<double> rest = backend().read_reals(id);
  for (std::size_t v = 0; v < s.rest.size(); ++v) {
    const auto node = static_cast<std::size_t>(s.nodes[v][0]);  // the others belong to the same piece
    for (std::size_t c = 0; c < 3; ++c) rest[4 * v + c] = s.rest[v][c] + state.offset[3 * node + c];
  }
  backend().write_reals(id, rest);
}

void RunContext::place_contact() const {
  if (model().contact == nullptr || model().contact->size() == 0) return;
  const ContactPoints& points = *model().contact;
  const BufferId id = loaded.program().find("contact_rest");
  std::vector<double> rest = backend().read_reals(id);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto node = static_cast<std::size_t>(points.nodes[i][0]);
    for (std::size_t c = 0; c < 3; ++c)
      rest[tile_base(i, 4) + c * PLIANT_TILE] = points.rest[i][c] + state.offset[3 * node + c];
  }
  backend().write_reals(id, rest);
  place_held_nodes();
}

/// The same for the part of contact points that depends on held nodes, where tools need it (contact_held).
void RunContext::place_held_nodes() const {
  if (model().tools->empty()) return;
  const ContactPoints& points = *model().contact;
  const BufferId id = loaded.program().find("contact_held");
  std::vector<double> held = backend().read_reals(id);
  const std::vector<double> share = backend().read_reals(loaded.program().find("contact_share"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(held[tile_base(i, 4) + std::size_t{3} * PLIANT_TILE] > 0)) continue;
    Vec3d sum{};
    for (std::size_t a = 0; a < 8; ++a) {
      if (share[tile_base(i, 8) + a * PLIANT_TILE] > 0) continue;
      const auto slot = static_cast<std::size_t>(points.nodes[i][a]);
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += double(points.weights[i][a]) / contact_weight_unit * (model().rest[slot][c] + state.offset[3 * slot + c]);
    }
    for (std::size_t c = 0; c < 3; ++c) held[tile_base(i, 4) + c * PLIANT_TILE] = sum[c];
  }
  backend().write_reals(id, held);
}

void RunContext::upload_params() const {
  const Vec3d& g = scene.gravity;
  loaded.write_params({state.clock.dt, g[0], g[1], g[2], settings.increment_floor, settings.displacement_grid,
                       static_cast<double>(phase()), 0});
}

void RunContext::upload_curves(std::int32_t steps) const {
  std::vector<double> values;
  const std::size_t rows = static_cast<std::size_t>(settings.batch_steps) + 1;
  values.reserve(rows * model().curves.size());
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = state.clock.time_at(state.clock.step + std::min<std::int64_t>(static_cast<std::int64_t>(row), steps));
    for (const Curve& curve : model().curves) values.push_back(curve.value(t));
  }
  loaded.write_curves(values);
}

void RunContext::upload_decay() const {
  std::vector<double> w = loaded.w();
  for (std::size_t s = 0; s < model().mass.size(); ++s) w[4 * s + 3] = decay(model(), s);
  loaded.write_w(w);
}

std::vector<double> RunContext::forces_now() const {
  upload_params();
  upload_curves(0);
  backend().run(loaded.program().force, 0, 1);
  return loaded.force();
}

}  // namespace pliant
