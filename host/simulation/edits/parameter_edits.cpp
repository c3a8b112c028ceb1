#include "simulation/edits/parameter_edits.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pliant/error.h"
#include "scene/change.h"
#include "simulation/step/initial_motion.h"
#include "simulation/step/stable_step.h"

namespace pliant {
namespace {

/// Returns true if the model stays as it is: a constant gravity is uploaded with each batch, unless added inertia has to be
/// kept from falling.
bool fits(const Model& model, const Scene& scene, const Scene& next) {
  return scene.gravity_curve.always() && next.gravity_curve.always() && model.added.empty();
}

}  // namespace

Scene ParameterEdits::scene_of(const RunState& state) const {
  const ChangedParameters& changed = state.changed;
  if (changed.done < 0 || changed.done > static_cast<std::int64_t>(first_.changes.size()))
    throw Error(ErrorCode::bad_input, "its changes of parameters do not belong to this scene, or are damaged");
  if (!changed.empty()) check_takes_changes(first_);
  return with_parameters(first_, changed.parameters);
}

bool ParameterEdits::may_load(const Scene& next) const {
  std::int64_t cycle = run_.period();
  for (const Body& body : next.bodies) {
    if (body.model.type == ModelType::hybrid) cycle = std::lcm(cycle, std::int64_t{body.model.substeps});
  }
  return run_.state.clock.step % cycle == 0;
}

void ParameterEdits::load(const Scene& next) {
  std::vector<std::size_t> remodelled;
  for (std::size_t b = 0; b < next.bodies.size(); ++b) {
    const DeformationModel &now = scene_.bodies[b].model, &then = next.bodies[b].model;
    if (now.ratio != then.ratio || now.seed != then.seed) remodelled.push_back(b);
  }
  const double before = run_.model().element_bound > 0 ? bound_step(run_, run_.model().element_bound) : 0;
  Scene old = std::exchange(scene_, next);
  try {
    topology_.load_scene(remodelled);
  } catch (...) {
    scene_ = std::move(old);
    throw;
  }
  step_.follow_parameters(before);
}

bool ParameterEdits::make(const std::string& change, const std::string& where) {
  topology_.settle();
  ChangedParameters& changed = run_.state.changed;
  std::string parameters = changed_parameters(first_, changed.parameters, change, where);
  const Scene next = with_parameters(first_, parameters);
  if (differ_in_gravity_alone(changed.parameters, parameters) && fits(run_.model(), scene_, next)) {
    scene_ = next;
  } else {
    if (!may_load(next)) return false;
    load(next);
  }
  changed.parameters = std::move(parameters);
  changed.step = run_.state.clock.step;
  // What a change does to the energy is the host's work.
  reports_.now.energy.least.reset();
  run_.state.relaxation.equilibrium = false;
  if (run_.state.clock.step == 0) set_initial_motion(run_);  // as if the scene had had them from the start
  return true;
}

void ParameterEdits::update() {
  ChangedParameters& changed = run_.state.changed;
  while (!changed.waiting.empty()) {
    const std::string next = changed.waiting.front();
    try {
      if (!make(next, "change")) return;
    } catch (...) {
      changed.waiting.erase(changed.waiting.begin());
      throw;
    }
    changed.waiting.erase(changed.waiting.begin());
  }
  while (changed.done < static_cast<std::int64_t>(first_.changes.size())) {
    const SceneChange& next = first_.changes[static_cast<std::size_t>(changed.done)];
    if (!run_.reached(next.time) || !make(next.text, next.pointer)) return;
    ++changed.done;
  }
}

void ParameterEdits::change(const std::string& change) {
  ChangedParameters& changed = run_.state.changed;
  std::string parameters = changed.parameters;
  for (const std::string& before : changed.waiting) parameters = changed_parameters(first_, parameters, before, "change");
  static_cast<void>(changed_parameters(first_, parameters, change, "change"));
  if (!changed.waiting.empty() || !make(change, "change")) changed.waiting.push_back(change);
}

}  // namespace pliant
