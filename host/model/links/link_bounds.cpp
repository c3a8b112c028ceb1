// What links add to the highest frequency of a model.
#include <algorithm>
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

/// As the scene begins: a spring of a list may be longer or shorter than at rest.
double first_stiffness(const LinkPoints& points, const SpringBatch& b, std::size_t s) {
  const double e = elongation(points, b, s, [](std::int32_t) { return Vec3d{}; }), length = b.length[s] + e;
  const double rest = rest_stiffness(b, s);
  if (b.law.law != SpringLaw::curve && std::abs(e) <= 1e-9 * length) return rest;
  const SpringState state = spring_state(b.law, b.parameters[s], e);
  return std::max({rest, state.slope, state.force / length});
}

SlotStiffness slot_stiffness(const Model& model) {
  SlotStiffness out{std::vector<double>(static_cast<std::size_t>(model.slots)),
                    std::vector<const std::string*>(static_cast<std::size_t>(model.slots))};
  const LinkPoints& points = model.links.points;
  for (const SpringBatch& b : model.links.springs) {
    for (std::size_t s = 0; s < b.size(); ++s) {
      const double k = first_stiffness(points, b, s);
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

/// Slots that springs of a batch join.
std::vector<char> slots_of(const Model& model, const SpringBatch& b) {
  std::vector<char> out(static_cast<std::size_t>(model.slots));
  for (const auto& ends : b.points) {
    for (const std::int32_t p : ends) {
      for (std::size_t a = 0; a < 8; ++a) {
        if (model.links.points.weights[p][a] != 0) out[model.links.points.slots[p][a]] = 1;
      }
    }
  }
  return out;
}

/// Slots of all networks, and what the stiffest of them is called.
struct Networks {
  std::vector<char> slots;
  std::string label;
};

/// The networks, nodes that springs and nothing else hold: the largest sum of 2 k over mass at a node, or where that is less
/// the bound of the tetrahedra plus the largest such sum of all other links there.
Networks note_networks(const std::vector<double>& all, const std::vector<char>& elements, Model& model) {
  Networks out{std::vector<char>(all.size()), {}};
  model.network_bound = 0;
  for (SpringBatch& b : model.links.springs) {
    if (b.body < 0 || b.bars) continue;
    const std::vector<char> slots = slots_of(model, b);
    std::vector<double> own(slots.size());
    for (std::size_t s = 0; s < b.size(); ++s) {
      const double k = first_stiffness(model.links.points, b, s);
      for_each_share(model.links.points, b, s, [&](std::int32_t slot, double share) { own[slot] += share * k; });
    }
    double most = 0, others = 0;
    bool bare = true;
    for (std::size_t s = 0; s < slots.size(); ++s) {
      if (slots[s] == 0 || !(model.mass[s] > 0)) continue;
      bare = bare && elements[s] == 0;
      most = std::max(most, all[s] / model.mass[s]);
      others = std::max(others, (all[s] - own[s]) / model.mass[s]);
    }
    if (!bare || !(most > 0)) continue;
    b.network = true;
    const double omega2 = b.omega2 > 0 ? std::min(most, b.omega2 + others) : most, bound = 2 / std::sqrt(omega2);
    for (std::size_t s = 0; s < slots.size(); ++s) out.slots[s] |= slots[s];
    if (model.network_bound > 0 && bound >= model.network_bound) continue;
    model.network_bound = bound;
    out.label = b.label;
  }
  return out;
}

void take_bound(double omega2, const std::string& label, Model& model) {
  const double bound = 2 / std::sqrt(omega2);
  if (model.element_bound > 0 && bound >= model.element_bound) return;
  model.element_bound = bound;
  model.bound_element = label;
}

}  // namespace

void note_link_bounds(Model& model) {
  if (model.links.empty()) return;
  for (const SpringBatch& b : model.links.springs) {
    if (b.join >= 0 || b.bars) continue;  // nodes of two bodies may rest at almost one place
    for (std::size_t s = 0; s < b.size(); ++s) {
      // Of listed ones the length at rest may be any.
      const std::vector<Vec3d>& at = model.links.points.rest;
      const double length = b.listed ? vec::norm(vec::sub(at[b.points[s][1]], at[b.points[s][0]])) : b.length[s];
      if (length > 0 && (model.shortest == 0 || length < model.shortest)) model.shortest = length;
    }
  }
  const SlotStiffness stiffness = slot_stiffness(model);
  const std::vector<char> elements = with_elements(model);
  const Networks networks = note_networks(stiffness.sum, elements, model);
  const double of_elements = model.element_bound > 0 ? 4 / (model.element_bound * model.element_bound) : 0;
  for (std::size_t s = 0; s < stiffness.sum.size(); ++s) {
    if (networks.slots[s] != 0 || !(stiffness.sum[s] > 0) || !(model.mass[s] > 0)) continue;
    take_bound(stiffness.sum[s] / model.mass[s] + (elements[s] != 0 ? of_elements : 0), label_of(model, stiffness, s), model);
  }
  if (model.network_bound > 0) take_bound(4 / (model.network_bound * model.network_bound), networks.label, model);
}

}  // namespace pliant
