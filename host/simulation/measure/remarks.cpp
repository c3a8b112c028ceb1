#include "simulation/measure/remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "model/matching/matching_step.h"
#include "simulation/step/coupling.h"

namespace pliant {
namespace {

/// Shape matching and the material of a body count as similar if their moduli are within this factor.
constexpr double kFarApart = 2;
/// Strain by its own weight up to which shape matching behaves like a material (docs/flsm_stiffness.md).
constexpr double kMostWeight = 0.1;

/// Taper or skew (Distortion) from which elements with hourglass control bend more than 10 % too little where a part is few
/// elements thick.
constexpr double kTapered = 0.25, kSkew = 0.7;

/// Of substeps that the scene gives.
void add_extrapolation(const FlsmBatch& b, const Material& material, const std::string& name, double dt,
                       std::vector<std::string>& remarks) {
  const int n = b.settings.substeps;
  if (!extrapolates(b)) return;
  const double most = automatic_matching_step(b, material.damping, true) / n, damping = least_damping(n * most);
  if (dt <= 1.00001 * most && material.damping >= 0.99 * damping) return;
  remarks.push_back(
      fmt::format("body '{}': with {} substeps and extrapolated goals its interface may gain energy and shake; safe are a "
                  "\"dt\" up to {:.4g} s "
                  "with a \"damping\" of at least {:.3g} 1/s, or \"substeps\": \"auto\"",
                  name, n, most, damping));
}

void add_matching(const Model& model, const Scene& scene, double dt, std::vector<std::string>& remarks) {
  for (const FlsmBatch& b : model.flsm) {
    const auto index = static_cast<std::size_t>(b.body);
    const Material& material = scene.bodies[index].material;
    const double modulus = matching_modulus(b, dt, material.damping), ratio = modulus / material.moduli.young();
    const std::string& name = model.bodies[index].name;
    add_extrapolation(b, material, name, dt, remarks);
    if (b.interface > 0 && (ratio < 1 / kFarApart || ratio > kFarApart)) {
      remarks.push_back(
          fmt::format("body '{}': at this step its shape matching behaves like a modulus of {:.3g} Pa, {:.3g} times that "
                      "of its material; \"stiffness\": {{\"young\": {:.6g}}} would make both alike",
                      name, modulus, ratio, material.moduli.young()));
    }
    const double g = vec::norm(scene.gravity), most = g * scene.gravity_curve.largest();
    if (most == 0) continue;
    double low = HUGE_VAL, high = -HUGE_VAL;  // along gravity
    for (const Vec3d& x : model.bodies[index].rest) {
      const double at = vec::dot(x, scene.gravity) / g;
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const double strain = material.density * most * (high - low) / modulus;
    if (strain > kMostWeight) {
      remarks.push_back(fmt::format(
          "body '{}': its weight strains its shape matching (modulus {:.3g} Pa) by about {:.2g}; above {} it "
          "sags otherwise than the material would (mostly further, by a tenth to a half at 0.3), and may buckle. Stiffer shape "
          "matching, or finite elements (\"type\": \"tled\"), carry it",
          name, modulus, strain, kMostWeight));
    }
  }
}

/// Deviation of a hexahedron from a parallelepiped.
struct Distortion {
  double taper = 0;  ///< difference of opposite edges over the sum of their lengths
  double skew = 0;   ///< largest cosine between its axes
};

Distortion distortion(const Model& model, std::span<const std::int32_t> slots) {
  const auto sum = [&](std::size_t mode) {  // sum over the corners, with the product of the signs selected by `mode`
    Vec3d v{};
    for (std::size_t a = 0; a < 8; ++a) {
      const bool minus = __builtin_popcount(static_cast<unsigned>(~a & mode)) % 2 != 0;
      for (std::size_t c = 0; c < 3; ++c) v[c] += (minus ? -1 : 1) * model.rest[slots[a]][c];
    }
    return v;
  };
  const std::array<Vec3d, 3> axes{sum(1), sum(2), sum(4)};
  Distortion d;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Vec3d both = sum((std::size_t{1} << i) | (std::size_t{1} << j));
    const double ni = vec::norm(axes[i]), nj = vec::norm(axes[j]);
    d.skew = std::max(d.skew, std::abs(vec::dot(axes[i], axes[j])) / (ni * nj));
    d.taper = std::max({d.taper, std::abs(vec::dot(both, axes[i])) / (ni * ni), std::abs(vec::dot(both, axes[j])) / (nj * nj)});
  }
  return d;
}

void add_distorted(const Model& model, std::vector<std::string>& remarks) {
  struct Found {
    const char* element = "";
    std::int64_t all = 0, distorted = 0;
    Distortion worst;
  };
  std::vector<Found> found(model.bodies.size());
  for (const ElementBatch& batch : model.batches) {
    if (!batch.info().hourglass || batch.uniform) continue;
    Found& body = found[static_cast<std::size_t>(batch.body)];
    body.element = batch.info().word;
    for (std::size_t e = 0; e < batch.size(); ++e) {
      const Distortion d = distortion(model, batch.nodes_of(e));
      body.worst = {std::max(body.worst.taper, d.taper), std::max(body.worst.skew, d.skew)};
      body.distorted += d.taper > kTapered || d.skew > kSkew;
      ++body.all;
    }
  }
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (10 * found[b].distorted <= found[b].all) continue;
    remarks.push_back(fmt::format(
        "body '{}': {} of {} {} elements are wedge-shaped (opposite edges differ by up to {:.2g} of their sum) or "
        "skewed (axes up to {:.0f} degrees from a right angle). Where a part is few elements thick these bend too little, "
        "wedges by 12 % at 0.25 and 35 % at 0.5, skewed ones by 10 to 20 % at 45 degrees",
        model.bodies[b].name, found[b].distorted, found[b].all, found[b].element, found[b].worst.taper,
        std::asin(std::min(1.0, found[b].worst.skew)) * 180 / 3.141592653589793));
  }
}

}  // namespace

std::vector<std::string> remarks_on(const Model& model, const Scene& scene, double dt) {
  std::vector<std::string> remarks;
  add_matching(model, scene, dt, remarks);
  add_distorted(model, remarks);
  return remarks;
}

}  // namespace pliant
