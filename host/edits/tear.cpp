// Tearing: bodies of tetrahedra come apart along faces where their stress breaks them, between two batches of a run.
#include <algorithm>
#include <cmath>
#include <limits>

#include "edits/model_swap.h"
#include "edits/tear_state.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "tearing/torn_body.h"

namespace pliant {
namespace {

bool tears(const Body& body) {
  return body.material.toughness > 0 || std::any_of(body.inclusions.begin(), body.inclusions.end(),
                                                    [](const Inclusion& i) { return i.material.toughness > 0; });
}

/// The material of each tetrahedron, as build_model gives it.
std::vector<Material> materials_of(const Body& body, const Solid& solid) {
  std::vector<Material> material(solid.tets.size(), body.material);
  for (std::size_t t = 0; t < solid.tets.size(); ++t) {
    Vec3d middle{};
    for (const std::int32_t n : solid.tets[t]) middle = vec::add(middle, vec::mul(solid.nodes[n], 0.25));
    for (const Inclusion& inclusion : body.inclusions) {
      if (inclusion.where.contains(middle, static_cast<std::int64_t>(t))) material[t] = inclusion.material;
    }
  }
  return material;
}

}  // namespace

TearState::TearState(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    solids.push_back(make_solid(body));
    bodies.emplace_back();
    if (!tears(body)) continue;
    if (!solids.back().lattice_nodes.empty() || solids.back().tets.empty()) {
      throw Error(ErrorCode::bad_input,
                  "body '" + body.name + "' has a material with a toughness; only volume meshes of tetrahedra (\"mesh\") tear");
    }
    const auto whole = std::make_shared<const Solid>(solids.back());
    bodies.back().emplace(whole, materials_of(body, *whole));
  }
}

bool TearState::wanted(const Scene& scene) {
  return !scene.solver.enabled && std::any_of(scene.bodies.begin(), scene.bodies.end(), tears);
}

void Simulation::prepare_tears() {
  if (!TearState::wanted(scene_)) return;
  if (scene_.integrator != Integrator::increment || scene_.relaxation.enabled || !scene_.blades.empty()) {
    throw Error(ErrorCode::bad_input,
                "a scene with \"integrator\": \"textbook\", with relaxation or with blades cannot tear: no material may have a "
                "toughness");
  }
  tears_ = std::make_shared<TearState>(scene_);
}

void Simulation::tear() {
  if (tears_ == nullptr || !begins_after(state_.step, kTearSteps)) return;
  const std::vector<double> u = backend_->read_reals(u_);
  std::vector<std::vector<TetFace>> faces(scene_.bodies.size());
  bool any = false;
  for (std::size_t b = 0; b < faces.size(); ++b) {
    if (!tears_->bodies[b]) continue;
    faces[b] = tears_->bodies[b]->breaking_faces(positions(u, b));
    any = any || !faces[b].empty();
  }
  if (!any) return;
  std::vector<std::vector<std::int32_t>> from(faces.size());
  for (std::size_t b = 0; b < faces.size(); ++b) {
    if (faces[b].empty()) continue;
    from[b] = tears_->bodies[b]->tear(faces[b]);
    tears_->solids[b] = tears_->bodies[b]->solid();
  }
  install_torn(from, u);
  std::vector<double>& list = state_.vectors["tears"];
  list.clear();
  for (std::size_t b = 0; b < faces.size(); ++b) {
    for (std::size_t t = 0; tears_->bodies[b] && t < tears_->bodies[b]->broken().size(); ++t) {
      const int bits = tears_->bodies[b]->broken()[t];
      if (bits != 0) list.insert(list.end(), {static_cast<double>(b), static_cast<double>(t), static_cast<double>(bits)});
    }
  }
  limit_to_element_bound();
}

/// The model of the torn bodies, every node with the displacement and velocity of the one it comes from: masses of copies add
/// up to that of their node, so momentum is kept.
void Simulation::install_torn(const std::vector<std::vector<std::int32_t>>& from, const std::vector<double>& u) {
  std::vector<NodeOrigins> origins;
  for (const std::vector<std::int32_t>& nodes : from) origins.push_back({nodes, {}});
  std::vector<const Solid*> solids;
  for (const Solid& solid : tears_->solids) solids.push_back(&solid);
  CutReport report;
  ModelSwap(*this, u, report).run(solids, std::move(origins), [] {});
}

/// Break what a checkpoint says is broken, and load the model that it gives.
void Simulation::replay_tears(const std::vector<double>& list) {
  const auto within = [](double value, std::size_t count) { return value >= 0 && value < static_cast<double>(count); };
  if (tears_ == nullptr || list.size() % 3 != 0)
    throw Error(ErrorCode::bad_input, "the checkpoint's list of tears does not belong to this scene");
  tears_ = std::make_shared<TearState>(scene_);
  std::vector<std::vector<TetFace>> faces(scene_.bodies.size());
  for (std::size_t i = 0; i < list.size(); i += 3) {
    const bool known = within(list[i], faces.size()) && tears_->bodies[static_cast<std::size_t>(list[i])] &&
                       within(list[i + 1], tears_->bodies[static_cast<std::size_t>(list[i])]->broken().size()) &&
                       within(list[i + 2], 16);
    if (!known)
      throw Error(ErrorCode::bad_input, "the checkpoint's list of tears does not belong to this scene, or is damaged");
    for (int f = 0; f < 4; ++f) {
      if (static_cast<int>(list[i + 2]) >> f & 1) {
        faces[static_cast<std::size_t>(list[i])].push_back(
            {static_cast<std::int32_t>(list[i + 1]), static_cast<std::int8_t>(f)});
      }
    }
  }
  for (std::size_t b = 0; b < faces.size(); ++b) {
    if (faces[b].empty()) continue;
    tears_->bodies[b]->tear(faces[b]);
    tears_->solids[b] = tears_->bodies[b]->solid();
  }
  topology_version_ = 1;
  backend_->finish();
  model_ = std::make_shared<const Model>(build_model(scene_, tears_->solids));
  load_program();
}

}  // namespace pliant
