// The model of a cut scene: built aside from the bodies as they are cut, then swapped in.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <utility>

#include "edits/cut_state.h"
#include "edits/model_swap.h"
#include "pliant/error.h"
#include "simulation/simulation.h"

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

/// Cut these edges of each body. `u`: what node_u holds.
void Simulation::cut_now(const std::vector<CutEdges>& edges, std::vector<double> u, CutReport& report) {
  Clock::time_point start = Clock::now();
  std::vector<CutEdit> edits(edges.size());
  std::size_t done = 0;
  try {
    for (; done < edges.size(); ++done) {
      if (!edges[done].empty()) edits[done] = cuts_->body(scene_, done).cut(edges[done], cuts_->helper);
      report.changed = report.changed || edits[done].changed_elements();
    }
    report.topology += lap(start);
    if (report.changed) {
      std::future<void> surfaces = cuts_->helper.run([&] {
        for (std::size_t b = 0; b < edits.size(); ++b) {
          if (edits[b].changed_elements()) cuts_->bodies[b]->update_surface();
        }
      });
      const WaitFor end(surfaces);
      ModelSwap swap(*this, std::move(u), report);
      std::vector<NodeOrigins> origins(edits.size());
      for (std::size_t b = 0; b < edits.size(); ++b) {
        if (!edits[b].changed_elements()) continue;
        cuts_->bodies[b]->update_elements();
        origins[b] = {edits[b].node_from, flux_masses(scene_.bodies[b], cuts_->bodies[b]->solid(), edits[b])};
      }
      swap.run(cuts_->solids(), std::move(origins), [&] { get_soon(surfaces); });
      keep_solids();
      if (scene_.bodies.size() == 1) cuts_->surface_copy.make(model_, cuts_->helper);
    }
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

/// For operational regions that follow the tool.
void Simulation::keep_solids() {
  const auto& bodies = scene_.bodies;
  solids_ = nullptr;
  if (std::none_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.model.follow; })) return;
  const auto kept = std::make_shared<std::vector<Solid>>();
  for (const Solid* solid : cuts_->solids()) kept->push_back(*solid);
  solids_ = kept;
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
  const auto damaged = [] {
    return Error(ErrorCode::bad_input, "the checkpoint's list of cuts does not belong to this scene, or is damaged");
  };
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
    const CutEdit edit = cuts_->body(scene_, body).cut(edges, cuts_->helper);
    if (!edit.changed_elements()) continue;
    cuts_->body(scene_, body).update_surface();
    ++topology_version_;
  }
  for (const auto& body : cuts_->bodies) {
    if (body != nullptr) body->update_elements();
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
