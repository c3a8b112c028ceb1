// Removal ("destruction" in Mendoza et al.): what the blade touches goes, and its mass with it.
#include <algorithm>

#include "geometry/vec.h"
#include "tearing/method.h"
#include "tearing/sweep_probe.h"

namespace pliant {

MethodResult remove_crossed(const ElementMesh& mesh, std::span<const SweepTriangle> sweep) {
  MethodResult out;
  out.mesh.nodes = mesh.nodes;
  const ElementMesh parts = kuhn_tetrahedra(mesh);
  const std::size_t per = mesh.hexes.empty() ? 1 : kKuhnTets.size();
  vec::Box box;
  for (const Vec3d& x : mesh.nodes) box.extend(x);
  SweepProbe probe(box, mean_edge(parts), sweep);
  const std::size_t count = mesh.tets.size() + mesh.hexes.size();
  std::vector<char> gone(count, 0);
  for (std::size_t t = 0; t < parts.tets.size(); ++t) {
    if (gone[t / per] != 0) continue;
    std::array<ExactPoint, 4> p;
    std::array<Vec3d, 4> x;
    for (std::size_t a = 0; a < 4; ++a) {
      x[a] = mesh.nodes[parts.tets[t][a]];
      p[a] = probe.point(x[a], parts.tets[t][a]);
    }
    gone[t / per] = probe.touches(p, x) ? 1 : 0;
  }
  std::vector<std::int32_t> touched;
  for (std::size_t e = 0; e < count; ++e) {
    if (gone[e] != 0) {
      ++out.crossed;
      if (mesh.hexes.empty()) touched.insert(touched.end(), mesh.tets[e].begin(), mesh.tets[e].end());
      continue;
    }
    out.element_from.push_back(static_cast<std::int32_t>(e));
    if (mesh.hexes.empty()) {
      out.mesh.tets.push_back(mesh.tets[e]);
    } else {
      out.mesh.hexes.push_back(mesh.hexes[e]);
    }
    out.mesh.fill.push_back(mesh.fill[e]);
  }
  // Separates elements that are connected only by a point or an edge, as the other methods do.
  std::vector<std::uint8_t> none(out.mesh.tets.size(), 0);
  out.node_from = part_at_faces(out.mesh.tets, mesh.nodes.size(), none, touched);
  for (std::size_t n = mesh.nodes.size(); n < out.node_from.size(); ++n) out.mesh.nodes.push_back(mesh.nodes[out.node_from[n]]);
  return out;
}

}  // namespace pliant
