// Scenes with blades that divide or remove the elements of running bodies, and what an edit must keep.
#pragma once
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cutting/block_scenes.h"
#include "io/save.h"
#include "model/pieces.h"
#include "simulation/measure/energy.h"
#include "simulation/measure/probing.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "tearing/method.h"

namespace pliant::remade_test {

using namespace cut_test;
using test::error_of;

struct Remade : BlockScenes {};

inline Energies energies_of(const Simulation& s) {
  const Model& m = s.model();
  std::vector<std::vector<Vec3d>> u, v;
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    u.push_back(s.displacements(b));
    v.push_back(s.velocities(b));
  }
  return energies(m, by_slot(m, u), by_slot(m, v));
}

}  // namespace pliant::remade_test
