// Contact points after a change of the model that leaves its bodies as they are.
#include "model/contact/contact.h"
#include "model/model.h"

namespace pliant {

std::shared_ptr<const ContactPoints> contact_of_same_bodies(const Model& before, const Model& now) {
  if (before.contact == nullptr) return nullptr;
  auto points = std::make_shared<ContactPoints>(*before.contact);
  std::vector<std::int32_t> to(static_cast<std::size_t>(before.slots), -1);
  for (std::size_t b = 0; b < now.bodies.size(); ++b) {
    const std::vector<std::int32_t>&from = before.bodies[b].slot, &next = now.bodies[b].slot;
    for (std::size_t n = 0; n < from.size(); ++n) to[static_cast<std::size_t>(from[n])] = next[n];
  }
  for (auto& nodes : points->nodes) {
    for (std::int32_t& n : nodes) n = to[static_cast<std::size_t>(n)];
  }
  return points;
}

}  // namespace pliant
