// A cut: edges become split elements, and mass that changes hands takes its momentum along.
#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "edits/model_swap.h"
#include "edits/topology_edits.h"
#include "geometry/stopwatch.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Mass that one unit of fill of an element puts on each of its corners [kg].
std::array<double, 8> corner_masses(const BodyMesh& solid, const std::vector<double>& density, std::int32_t element) {
  std::array<double, 8> mass{};
  const bool lattice = !solid.lattice_nodes.empty();
  if (solid.tets.empty()) {
    mass.fill(density[element] * solid.spacing * solid.spacing * solid.spacing / 8);
    return mass;
  }
  const std::size_t parts = lattice ? kKuhnTets.size() : 1;
  for (std::size_t p = 0; p < parts; ++p) {
    const std::size_t t = parts * static_cast<std::size_t>(element) + p;
    std::array<Vec3d, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = solid.nodes[solid.tets[t][a]];
    const double quarter = density[t] * tet_geometry(x).volume / 4;
    for (std::size_t a = 0; a < 4; ++a) mass[lattice ? kKuhnTets[p][a] : a] += quarter;
  }
  return mass;
}

std::vector<FluxMass> flux_masses(const Body& body, const BodyMesh& solid, const CutEdit& edit) {
  std::vector<FluxMass> all;
  if (edit.flux.empty()) return all;
  const std::vector<double> density = densities(body, solid);
  const bool lattice = !solid.lattice_nodes.empty();
  for (const FillFlux& f : edit.flux) {
    const std::array<double, 8> mass = corner_masses(solid, density, f.element);
    for (std::size_t a = 0; a < (lattice ? 8U : 4U); ++a) {
      std::int32_t node = -1;
      if (solid.tets.empty()) node = solid.hexes[f.element][a];
      if (!solid.tets.empty() && lattice) node = cell_corners(&solid.tets[kKuhnTets.size() * f.element])[a];
      if (!solid.tets.empty() && !lattice) node = solid.tets[f.element][a];
      all.push_back({node, f.from_nodes[a], f.fill * mass[a]});
    }
  }
  return all;
}

}  // namespace

void TopologyEdits::make_cut(std::vector<CutEdges> edges, std::vector<double> u, CutReport& report) {
  Stopwatch clock;
  EditedBodies& all = bodies();
  std::vector<CutEdit> edits(edges.size());
  std::size_t done = 0;
  try {
    for (; done < edges.size(); ++done) {
      if (!edges[done].empty()) edits[done] = all.cut(done).cut(edges[done], all.helper);
      report.changed = report.changed || edits[done].changed_elements();
    }
    report.topology += clock.lap();
    if (report.changed) {
      std::future<void> surfaces = all.helper.run([&] {
        for (std::size_t b = 0; b < edits.size(); ++b) {
          if (edits[b].changed_elements()) all.cut(b).update_surface();
        }
      });
      const WaitFor end(surfaces);
      ModelSwap swap(run_, loads_, all, std::move(u), report);
      std::vector<NodeOrigins> origins(edits.size());
      for (std::size_t b = 0; b < edits.size(); ++b) {
        if (!edits[b].changed_elements()) continue;
        all.cut(b).update_elements();
        origins[b] = {edits[b].node_from, flux_masses(run_.scene.bodies[b], all.solid(b), edits[b])};
      }
      Scene scene = scene_at(run_.state);
      scene.cuttable = true;
      swap.run(scene, std::move(origins), [&] { get_soon(surfaces); });
    }
  } catch (...) {
    for (std::size_t b = 0; b < std::min(done + 1, edges.size()); ++b) {
      if (!edges[b].empty()) all.rebuild(b, run_.state);
    }
    throw;
  }
  for (std::size_t b = 0; b < edges.size(); ++b) {
    if (!edges[b].empty()) run_.state.cuts.push_back({static_cast<std::int32_t>(b), std::move(edges[b])});
  }
  if (!report.changed) return;
  ++run_.state.topology_version;
  if (all.size() == 1) all.surface_copy.make(run_.loaded.shared_model(), all.helper);
  step_.limit_after_edit();
}

}  // namespace pliant
