#include "simulation/edits/front_point.h"

#include <algorithm>

#include "geometry/vec.h"

namespace pliant {

std::vector<FrontCarrier> front_carriers(const CutTopology& body, const MaterialPoint& point) {
  const auto& corners = body.mesh().shape->tets[static_cast<std::size_t>(point.tet)];
  std::vector<std::int32_t> elements{point.cell};
  const auto cut = body.cells().find(point.cell);
  if (cut != body.cells().end() && cut->second.components > 1) {
    elements.clear();
    for (const std::int32_t e : cut->second.element) {
      if (e >= 0 && elements.size() < 2) elements.push_back(e);
    }
  }
  std::vector<FrontCarrier> out;
  for (const std::int32_t e : elements) {
    for (std::size_t a = 0; a < 4; ++a) {
      const std::int32_t node = body.elements().nodes[static_cast<std::size_t>(e)][static_cast<std::size_t>(corners[a])];
      const double weight = point.weight[a] / static_cast<double>(elements.size());
      const auto same = std::find_if(out.begin(), out.end(), [&](const FrontCarrier& c) { return c.node == node; });
      if (same != out.end()) {
        same->weight += weight;
      } else {
        out.push_back({node, weight});
      }
    }
  }
  return out;
}

Vec3d front_place(const CutTopology& body, const std::vector<Vec3d>& x, const MaterialPoint& point) {
  Vec3d p{};
  for (const FrontCarrier& c : front_carriers(body, point))
    p = vec::add(p, vec::mul(x[static_cast<std::size_t>(c.node)], c.weight));
  return p;
}

}  // namespace pliant
