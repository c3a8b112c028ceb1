#include "simulation/remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "simulation/coupling.h"

namespace pliant {
namespace {

/// Shape matching and the material of one body are alike if their moduli are within this factor.
constexpr double kFarApart = 2;
/// Strain by its own weight that shape matching still carries like a material (docs/flsm_stiffness.md).
constexpr double kMostWeight = 0.02;

/// From this ratio of the longest to the shortest edge on, the error in bending may be several percent.
constexpr double kSlender = 1.25;

void add_matching(const Model& model, const Scene& scene, double dt, std::vector<std::string>& remarks) {
  for (const FlsmBatch& b : model.flsm) {
    const auto index = static_cast<std::size_t>(b.body);
    const Material& material = scene.bodies[index].material;
    const double modulus = matching_modulus(b, dt, material.damping), ratio = modulus / material.moduli.young();
    const std::string& name = model.bodies[index].name;
    if (b.interface > 0 && (ratio < 1 / kFarApart || ratio > kFarApart)) {
      remarks.push_back(
          fmt::format("body '{}': at this step its shape matching behaves like a modulus of {:.3g} Pa, {:.3g} times that "
                      "of its material; \"stiffness\": {{\"young\": {:.6g}}} would make both alike",
                      name, modulus, ratio, material.moduli.young()));
    }
    const double g = vec::norm(scene.gravity);
    if (g == 0) continue;
    double low = HUGE_VAL, high = -HUGE_VAL;  // along gravity
    for (const Vec3d& x : model.bodies[index].rest) {
      const double at = vec::dot(x, scene.gravity) / g;
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const double strain = material.density * g * (high - low) / modulus;
    if (strain > kMostWeight) {
      remarks.push_back(
          fmt::format("body '{}': its weight strains its shape matching (modulus {:.3g} Pa) by about {:.2g}; above {} it "
                      "sags further than the material would, and may buckle. Stiffer shape matching, or finite elements "
                      "(\"type\": \"tled\"), carry it",
                      name, modulus, strain, kMostWeight));
    }
  }
}

double longest_over_shortest(const Model& model, const std::array<std::int32_t, 8>& slots) {
  double shortest = HUGE_VAL, longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d edge{};  // the mean of four
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t c = 0; c < 3; ++c) edge[c] += ((a >> axis & 1) != 0 ? 1 : -1) * model.rest[slots[a]][c];
    }
    shortest = std::min(shortest, vec::norm(edge));
    longest = std::max(longest, vec::norm(edge));
  }
  return longest / shortest;
}

void add_slender(const Model& model, std::vector<std::string>& remarks) {
  std::vector<double> most(model.bodies.size());
  for (const HexBatch& batch : model.hexes) {
    if (batch.full || batch.uniform) continue;
    double& body = most[static_cast<std::size_t>(batch.body)];
    for (const auto& slots : batch.nodes) body = std::max(body, longest_over_shortest(model, slots));
  }
  for (std::size_t b = 0; b < most.size(); ++b) {
    if (most[b] < kSlender) continue;
    remarks.push_back(fmt::format(
        "body '{}' has hex8 elements up to {:.2g} times as long as wide; their hourglass stiffness is made for cubes. "
        "Where a part is few elements thick it bends too little (long along it: by 20 % at 2, 49 % at 4) or too much "
        "(short along it: 10 % at 1/2); \"element\": \"hex8full\" or more nearly cubic elements mend it",
        model.bodies[b].name, most[b]));
  }
}

}  // namespace

std::vector<std::string> remarks_on(const Model& model, const Scene& scene, double dt) {
  std::vector<std::string> remarks;
  add_matching(model, scene, dt, remarks);
  add_slender(model, remarks);
  return remarks;
}

}  // namespace pliant
