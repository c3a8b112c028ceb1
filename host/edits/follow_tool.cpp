// The operational region that follows the tool: the model is partitioned anew around it, and every node keeps its position and
// momentum.
#include <algorithm>
#include <cmath>

#include "edits/cut_state.h"
#include "model/solid.h"
#include "simulation/simulation.h"

namespace pliant {
namespace {

double distance(const Vec3d& a, const Vec3d& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The rest position of the node that is nearest to a point now.
Vec3d nearest_at_rest(const ModelBody& body, const std::vector<Vec3d>& u, const Vec3d& point) {
  std::size_t best = 0;
  double least = -1;
  for (std::size_t n = 0; n < body.rest.size(); ++n) {
    const Vec3d& x = body.rest[n];
    const double d = distance({x[0] + u[n][0], x[1] + u[n][1], x[2] + u[n][2]}, point);
    if (least >= 0 && !(d < least)) continue;
    least = d;
    best = n;
  }
  return body.rest[best];
}

}  // namespace

/// Looks at the tool where batches begin however a run is cut into pieces, and only between steps of shape matching. A region
/// moves when the material under the tool is more than a cell from its seed.
void Simulation::follow_tool() {
  const auto& bodies = scene_.bodies;
  if (std::none_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.model.follow; }) || phase() != 0) return;
  const Vec3d tool = scene_.tool.position(time());
  std::vector<double> seeds;
  bool moved = false;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Vec3d seed = bodies[b].model.seed.value_or(Vec3d{});
    if (bodies[b].model.follow) {
      const Vec3d now = nearest_at_rest(model_->bodies[b], displacements(b), tool);
      if (!bodies[b].model.seed || distance(now, seed) > model_->bodies[b].spacing) {
        seed = now;
        moved = true;
      }
    }
    seeds.insert(seeds.end(), seed.begin(), seed.end());
  }
  if (!moved) return;
  state_.vectors["seeds"] = seeds;
  std::vector<std::vector<Vec3d>> u, w;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    u.push_back(displacements(b));
    w.push_back(velocities(b));
  }
  move_region(seeds);
  std::vector<double> new_u = backend_->read_reals(u_), new_w = backend_->read_reals(w_);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (std::size_t n = 0; n < u[b].size(); ++n) {
      const auto slot = static_cast<std::size_t>(model_->bodies[b].slot[n]);
      const double h = substeps_of(slot) * state_.dt;
      for (std::size_t c = 0; c < 3; ++c) {
        new_u[4 * slot + c] = u[b][n][c];
        new_w[4 * slot + c] = h * w[b][n][c];
      }
    }
  }
  for (std::size_t s = 0; s < model_->mass.size(); ++s) new_w[4 * s + 3] = decay(s);
  backend_->write_reals(u_, new_u);
  backend_->write_reals(w_, new_w);
  upload_shape_matching();
  if (automatic_) adapt_dt();
}

void Simulation::set_seeds(const std::vector<double>& seeds) {
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    DeformationModel& model = scene_.bodies[b].model;
    if (model.follow) model.seed = Vec3d{seeds[3 * b], seeds[3 * b + 1], seeds[3 * b + 2]};
  }
}

/// Build and load the model with the operational regions around `seeds`, three numbers per body.
void Simulation::move_region(const std::vector<double>& seeds) {
  set_seeds(seeds);
  if (solids_ == nullptr) {
    auto solids = std::make_shared<std::vector<Solid>>();
    if (cuts_ == nullptr) *solids = make_solids(scene_);
    if (cuts_ != nullptr) {
      for (const Solid* solid : cuts_->solids()) solids->push_back(*solid);
    }
    solids_ = solids;
  }
  backend_->finish();
  model_ = std::make_shared<const Model>(build_model(scene_, *solids_));
  load_program();
}

void Simulation::prepare_restore(const SimulationState& state) {
  const auto seeds = state.vectors.find("seeds");
  const bool moved = seeds != state.vectors.end() && seeds->second.size() == 3 * scene_.bodies.size();
  if (moved) set_seeds(seeds->second);
  const auto torn = state.vectors.find("tears");
  if (torn != state.vectors.end()) replay_tears(torn->second);
  const auto cuts = state.vectors.find("cuts");
  if (cuts != state.vectors.end()) {
    replay_cuts(cuts->second);
  } else if (moved) {
    move_region(seeds->second);
  }
  // An edit may have changed several bodies: the replay cannot count them.
  const auto version = state.vectors.find("topology_version");
  if (version != state.vectors.end() && version->second.size() == 1 && std::abs(version->second[0]) < 1e15) {
    topology_version_ = static_cast<std::int64_t>(version->second[0]);
  }
}

}  // namespace pliant
