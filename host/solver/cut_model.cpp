// The model of a cut scene: built aside from the bodies as they are cut, then swapped in with every node's displacement and
// velocity.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "pliant/error.h"
#include "solver/cut_state.h"
#include "solver/simulation.h"

namespace pliant {
namespace {

using Clock = std::chrono::steady_clock;

double lap(Clock::time_point& start) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - start).count();
  start = now;
  return seconds;
}

/// Mass that one unit of fill of an element puts on each of its corners [kg].
std::array<double, 8> corner_masses(const Solid& solid, const std::vector<double>& density, std::int32_t element) {
  std::array<double, 8> mass{};
  const bool lattice = !solid.lattice_nodes.empty();
  if (solid.tets.empty()) {
    mass.fill(density[element] * solid.spacing * solid.spacing * solid.spacing / 8);
    return mass;
  }
  const std::size_t parts = lattice ? kKuhnTets.size() : 1;
  for (std::size_t p = 0; p < parts; ++p) {
    const std::size_t t = parts * static_cast<std::size_t>(element) + p;
    std::array<Vec3d, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = solid.nodes[solid.tets[t][a]];
    const double quarter = density[t] * tet_geometry(x).volume / 4;
    for (std::size_t a = 0; a < 4; ++a) mass[lattice ? kKuhnTets[p][a] : a] += quarter;
  }
  return mass;
}

/// Mass that a node takes over from another one than its own origin.
struct FluxMass {
  std::int32_t node, from;
  double mass;
};

std::vector<FluxMass> flux_masses(const Body& body, const Solid& solid, const CutEdit& edit) {
  std::vector<FluxMass> all;
  if (edit.flux.empty()) return all;
  const std::vector<double> density = densities(body, solid);
  const bool lattice = !solid.lattice_nodes.empty();
  for (const FillFlux& f : edit.flux) {
    const std::array<double, 8> mass = corner_masses(solid, density, f.element);
    for (std::size_t a = 0; a < (lattice ? 8U : 4U); ++a) {
      std::int32_t node = -1;
      if (solid.tets.empty()) node = solid.hexes[f.element][a];
      if (!solid.tets.empty() && lattice) node = cell_corners(&solid.tets[kKuhnTets.size() * f.element])[a];
      if (!solid.tets.empty() && !lattice) node = solid.tets[f.element][a];
      all.push_back({node, f.from_nodes[a], f.fill * mass[a]});
    }
  }
  return all;
}

}  // namespace

/// Build and load the model of the bodies as they are cut now. Throws with the old model back in place.
void Simulation::rebuild(const std::vector<CutEdit>& edits, CutReport& report) {
  Clock::time_point start = Clock::now();
  backend_->finish();
  const std::vector<double> old_u = backend_->read_reals(u_), old_w = backend_->read_reals(w_);
  const std::shared_ptr<const Model> old_model = model_;
  std::vector<std::vector<Vec3d>> u, v;
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    u.push_back(pick(old_u, b, 1));
    v.push_back(velocities_from(old_w, b));
  }
  const std::vector<const Solid*> solids = cuts_->solids();
  std::vector<std::vector<FluxMass>> flux(edits.size());
  for (std::size_t b = 0; b < edits.size(); ++b) flux[b] = flux_masses(scene_.bodies[b], *solids[b], edits[b]);
  std::shared_ptr<std::vector<Solid>> kept;
  if (std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& b) { return b.model.follow; })) {
    kept = std::make_shared<std::vector<Solid>>();
    for (const Solid* solid : solids) kept->push_back(*solid);
  }
  auto model = std::make_shared<const Model>(build_model(scene_, solids, old_model.get()));
  report.model += lap(start);
  model_ = model;
  try {
    load_program(true);
  } catch (...) {
    model_ = old_model;
    load_program();
    backend_->write_reals(u_, old_u);
    backend_->write_reals(w_, old_w);
    upload_shape_matching();
    throw;
  }
  solids_ = kept;
  std::vector<double> new_u = program_.buffers[u_].reals, new_w = program_.buffers[w_].reals;
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const ModelBody& body = model_->bodies[b];
    const bool changed = edits[b].changed_elements();
    std::vector<Vec3d> velocity(body.slot.size());
    for (std::size_t n = 0; n < velocity.size(); ++n) velocity[n] = v[b][changed ? edits[b].node_from[n] : n];
    for (const FluxMass& f : flux[b]) {
      const double share = f.mass / model_->mass[body.slot[f.node]];
      for (std::size_t c = 0; c < 3; ++c)
        velocity[f.node][c] += share * (v[b][f.from][c] - v[b][edits[b].node_from[f.node]][c]);
    }
    for (std::size_t n = 0; n < velocity.size(); ++n) {
      const auto slot = static_cast<std::size_t>(body.slot[n]);
      const Vec3d& moved = u[b][changed ? edits[b].node_from[n] : n];
      for (std::size_t c = 0; c < 3; ++c) {
        new_u[4 * slot + c] = moved[c];
        new_w[4 * slot + c] = substeps_of(slot) * state_.dt * velocity[n][c];
      }
    }
  }
  for (std::size_t s = 0; s < model_->mass.size(); ++s) new_w[4 * s + 3] = decay(s);
  backend_->write_reals(u_, new_u);
  backend_->write_reals(w_, new_w);
  upload_shape_matching();
  state_.vectors.erase("kept");  // copies of the old model's buffers
  ++topology_version_;
  report.upload += lap(start);
}

/// Cut these edges of each body.
void Simulation::cut_now(const std::vector<CutEdges>& edges, CutReport& report) {
  Clock::time_point start = Clock::now();
  std::vector<CutEdit> edits(edges.size());
  std::size_t done = 0;
  try {
    for (; done < edges.size(); ++done) {
      if (!edges[done].empty()) edits[done] = cuts_->body(scene_, done).cut(edges[done], report.surface);
      report.changed = report.changed || edits[done].changed_elements();
    }
    report.topology = lap(start) - report.surface;
    if (report.changed) rebuild(edits, report);
  } catch (...) {
    for (std::size_t b = 0; b < done; ++b) {
      if (!edges[b].empty()) cuts_->body(scene_, b).undo();
    }
    throw;
  }
  std::vector<double>& cuts = state_.vectors["cuts"];
  for (std::size_t b = 0; b < edges.size(); ++b) {
    if (edges[b].empty()) continue;
    cuts.insert(cuts.end(), {static_cast<double>(b), static_cast<double>(edges[b].size())});
    for (const auto& [pair, t] : edges[b])
      cuts.insert(cuts.end(), {static_cast<double>(pair[0]), static_cast<double>(pair[1]), t});
  }
  if (report.changed) limit_to_element_bound();
}

/// A scene that nobody meant to cut may run at a step beyond what its elements allow when a cut frees them.
void Simulation::limit_to_element_bound() {
  if (!automatic_ || model_->element_bound <= 0) return;
  const double allowed = scene_.safety * coupled_step(model_->element_bound);
  first_dt_ = std::min(first_dt_, allowed);
  if (state_.dt > first_dt_) change_dt(first_dt_);
}

/// Make the cuts of a checkpoint again, edit by edit, and the model that they give.
void Simulation::replay_cuts(const std::vector<double>& cuts) {
  cuts_ = std::make_shared<CutState>(scene_);
  topology_version_ = 0;
  double surface = 0;
  const auto damaged = [] { return Error("the checkpoint's list of cuts does not belong to this scene, or is damaged"); };
  for (std::size_t i = 0; i < cuts.size();) {
    if (cuts.size() - i < 2 || !(cuts[i] >= 0 && cuts[i] < static_cast<double>(scene_.bodies.size())) ||
        !(cuts[i + 1] >= 1 && cuts[i + 1] <= static_cast<double>((cuts.size() - i - 2) / 3))) {
      throw damaged();
    }
    const auto body = static_cast<std::size_t>(cuts[i]), count = static_cast<std::size_t>(cuts[i + 1]);
    i += 2;
    CutEdges edges;
    for (std::size_t k = 0; k < count; ++k, i += 3) {
      if (!(std::abs(cuts[i]) < 2e9 && std::abs(cuts[i + 1]) < 2e9)) throw damaged();
      edges[{static_cast<std::int32_t>(cuts[i]), static_cast<std::int32_t>(cuts[i + 1])}] = cuts[i + 2];
    }
    topology_version_ += cuts_->body(scene_, body).cut(edges, surface).changed_elements() ? 1 : 0;
  }
  const std::vector<const Solid*> solids = cuts_->solids();
  auto kept = std::make_shared<std::vector<Solid>>();
  for (const Solid* solid : solids) kept->push_back(*solid);
  solids_ = kept;
  backend_->finish();
  model_ = std::make_shared<const Model>(build_model(scene_, *solids_));
  load_program();
}

const CutTopology* Simulation::cut_topology(std::size_t body) const {
  if (cuts_ == nullptr || cuts_->bodies.at(body) == nullptr) return nullptr;
  return &cuts_->bodies[body]->topology();
}

}  // namespace pliant
