#include "simulation/edits/carried_grips.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "model/contact/contact.h"
#include "schedule/program_layout.h"

namespace pliant {

bool has_grips(const Model& model) {
  return model.contact != nullptr && model.tools != nullptr &&
         std::any_of(model.tools->begin(), model.tools->end(), [](const ToolForm& tool) { return tool.grips; });
}

void carry_grips(const RunContext& run, const Model& next, Program& program) {
  const Model& before = run.model();
  const BufferId from = run.loaded.program().find("contact_anchor"), to = program.find("contact_anchor");
  if (!has_grips(before) || !has_grips(next) || from < 0 || to < 0) return;
  const std::vector<double> held = run.backend().read_reals(from);
  using Anchor = std::array<double, 4>;
  std::map<std::pair<std::int32_t, Vec3d>, Anchor> at;  // by body and place at rest
  for (std::size_t i = 0; i < before.contact->size(); ++i) {
    Anchor a{};
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = held[tile_base(i, a.size()) + k * PLIANT_TILE];
    if (a[3] < 0) at.emplace(std::pair{before.contact->body[i], before.contact->rest[i]}, a);
  }
  if (at.empty()) return;
  std::vector<double>& anchors = program.at(to).reals;
  anchors.resize(program.at(to).values(), 0.0);
  for (std::size_t i = 0; i < next.contact->size(); ++i) {
    const auto found = at.find({next.contact->body[i], next.contact->rest[i]});
    if (found == at.end()) continue;
    for (std::size_t k = 0; k < found->second.size(); ++k) anchors[tile_base(i, 4) + k * PLIANT_TILE] = found->second[k];
  }
}

}  // namespace pliant
