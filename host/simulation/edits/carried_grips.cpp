#include "simulation/edits/carried_grips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "model/contact/contact.h"
#include "schedule/program_layout.h"

namespace pliant {

bool has_grips(const Model& model) {
  return model.contact != nullptr && model.tools != nullptr &&
         std::any_of(model.tools->begin(), model.tools->end(), [](const ToolForm& tool) { return tool.grips; });
}

namespace {

/// Sum of the shares of a point's nodes over their masses: how far it gives way to a force, but for what touches beside it.
double ease_of(const Model& model, const Program& program, std::size_t i) {
  const std::vector<double>& share = program.at(program.find("contact_share")).reals;
  double sum = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    const double mass = model.mass[static_cast<std::size_t>(model.contact->nodes[i][a])];
    if (mass > 0) sum += share[tile_base(i, 8) + a * PLIANT_TILE] / mass;
  }
  return sum;
}

/// What a contact point that is held keeps.
struct HeldPoint {
  std::array<double, 4> anchor{};
  double ease = 0, yield = 0;  ///< contact_yield
};

std::map<std::pair<std::int32_t, Vec3d>, HeldPoint> held_points(const RunContext& run, BufferId anchors) {
  const Model& model = run.model();
  const Program& program = run.loaded.program();
  const std::vector<double> anchor = run.backend().read_reals(anchors);
  const std::vector<double> yield = run.backend().read_reals(program.find("contact_yield"));
  std::map<std::pair<std::int32_t, Vec3d>, HeldPoint> at;  // by body and place at rest
  for (std::size_t i = 0; i < model.contact->size(); ++i) {
    HeldPoint held;
    for (std::size_t k = 0; k < 4; ++k) held.anchor[k] = anchor[tile_base(i, 4) + k * PLIANT_TILE];
    if (!(held.anchor[3] < 0)) continue;
    held.ease = ease_of(model, program, i);
    held.yield = yield[i];
    at.emplace(std::pair{model.contact->body[i], model.contact->rest[i]}, held);
  }
  return at;
}

}  // namespace

void carry_grips(const RunContext& run, const Model& next, Program& program) {
  const BufferId from = run.loaded.program().find("contact_anchor"), to = program.find("contact_anchor");
  if (!has_grips(run.model()) || !has_grips(next) || from < 0 || to < 0) return;
  const auto at = held_points(run, from);
  if (at.empty()) return;
  Buffer &anchors = program.at(to), &yields = program.at(program.find("contact_yield"));
  for (Buffer* buffer : {&anchors, &yields}) buffer->reals.resize(buffer->values(), 0.0);
  for (std::size_t i = 0; i < next.contact->size(); ++i) {
    const auto found = at.find({next.contact->body[i], next.contact->rest[i]});
    if (found == at.end()) continue;
    for (std::size_t k = 0; k < 4; ++k) anchors.reals[tile_base(i, 4) + k * PLIANT_TILE] = found->second.anchor[k];
    // Otherwise the first step takes the compliance from all points around it and pulls less than it has to.
    const double ease = ease_of(next, program, i);
    if (std::abs(ease - found->second.ease) <= 1e-9 * ease) yields.reals[i] = found->second.yield;
  }
}

}  // namespace pliant
