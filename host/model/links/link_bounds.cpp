// What links add to the highest frequency of a model.
#include <cmath>

#include "model/links/build_links.h"
#include "model/links/membranes.h"

namespace pliant {
namespace {

/// Shares of slots in the stiffness 2 k of springs [N/m], and the springs' label.
struct SlotStiffness {
  std::vector<double> sum;
  std::vector<const std::string*> label;
};

SlotStiffness slot_stiffness(const Model& model) {
  SlotStiffness out{std::vector<double>(static_cast<std::size_t>(model.slots)),
                    std::vector<const std::string*>(static_cast<std::size_t>(model.slots))};
  const LinkPoints& points = model.links.points;
  for (const SpringBatch& b : model.links.springs) {
    for (std::size_t s = 0; s < b.size(); ++s) {
      const double k = rest_stiffness(b, s);
      for_each_share(points, b, s, [&](std::int32_t slot, double share) {
        out.sum[slot] += k * share;
        out.label[slot] = &b.label;
      });
    }
  }
  add_membrane_stiffness(model, nullptr, out.sum);
  return out;
}

/// The label of whatever links a slot: springs, or else a membrane.
const std::string& label_of(const Model& model, const SlotStiffness& stiffness, std::size_t slot) {
  return stiffness.label[slot] != nullptr ? *stiffness.label[slot] : model.links.membranes.front().label;
}

/// Whether finite elements move each slot.
std::vector<char> with_elements(const Model& model) {
  std::vector<char> out(static_cast<std::size_t>(model.slots));
  for (std::size_t s = 0; s < static_cast<std::size_t>(model.list_base); ++s) out[s] = 1;
  for (const ElementBatch& b : model.batches) {
    for (const std::int32_t s : b.nodes) out[s] = 1;
  }
  return out;
}

}  // namespace

double rest_stiffness(const SpringBatch& b, std::size_t s) {
  Spring taut = b.law;
  taut.slack = false;  // stiff as soon as it is longer than at rest
  return spring_state(taut, b.parameters[s], 0).slope;
}

void note_link_bounds(Model& model) {
  if (model.links.empty()) return;
  for (const SpringBatch& b : model.links.springs) {
    if (b.join >= 0 || b.bars) continue;  // nodes of two bodies may rest at almost one place
    for (const double length : b.length) {
      if (length > 0 && (model.shortest == 0 || length < model.shortest)) model.shortest = length;
    }
  }
  const SlotStiffness stiffness = slot_stiffness(model);
  const std::vector<char> elements = with_elements(model);
  const double of_elements = model.element_bound > 0 ? 4 / (model.element_bound * model.element_bound) : 0;
  for (std::size_t s = 0; s < stiffness.sum.size(); ++s) {
    if (!(stiffness.sum[s] > 0) || !(model.mass[s] > 0)) continue;
    const double bound = 2 / std::sqrt(stiffness.sum[s] / model.mass[s] + (elements[s] != 0 ? of_elements : 0));
    if (model.element_bound > 0 && bound >= model.element_bound) continue;
    model.element_bound = bound;
    model.bound_element = label_of(model, stiffness, s);
  }
}

}  // namespace pliant
