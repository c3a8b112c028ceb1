// Regions of shape matching that deform like a material.
//
// The residual of a rigid fit to a uniform deformation F of a region has the energy |(F - R) A^1/2|^2 / 2, with the second
// moments A of its weights. Inside a body A is that of a full window, and the sum over regions is the energy of a material. A
// window that ends at a clamp, at the interface or at a cut has a smaller A across that face: there the body is too soft, as
// if it were longer by several cells. So the residual of the best affine fit x = c + F o is kept, which resists short waves,
// and the energy of F itself is that of the material in the region:
//   V = beta sum_r [sum_i p_i |x_i - c - F o_i|^2 / 2 + s_r psi(F)],   F = R U, e = U - I,
//   psi(F) = tr(e^2 / 2 - e^3 / 6 + e^4 / 32) / (1 + nu) + nu / (2 (1 + nu) (1 - 2 nu)) (tr e)^2,
// with s_r the second moment of a full window with the same amount of material as the region. The first term is that of U -
// U^-1 for small e, so it stiffens in compression like neo-Hookean tissue, and is convex and finite for every e. A quartic
// would stiffen without limit in fragments with few nodes after a cut or tear, beyond the stability of any step. So beyond e
// : e = s = PLIANT_FLSM_STRAIN the cubic term is multiplied by k and the quartic one by k^2, k = y (2 - y) with y = s / (e :
// e), and psi grows like e^2. The gradient pulls node i towards c + (F - s_r P(F) A^-1) o_i, P = d psi / d F, which is again
// an affine transformation: kernels/matching/flsm_region.cl.
#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "model/matching/flsm.h"

namespace pliant {
namespace {

/// Weight of a held node over its mass, by half-width. A held node carries the traction of a face; with the mass of half a
/// cell alone, a region would be attached to it by a weak spring. The weight is no inertia, so it does not require shorter
/// steps.
constexpr double kHeldWeight[] = {1, 2.5, 4, 6, 8};

/// At this ratio of the material's moment to the region's own, a region stays rigid: its nodes on a plane or line do not
/// determine F.
constexpr double kThinRegion = 5;

/// The inverse of the moments, and the ratio of `share` to each principal moment.
std::pair<std::array<double, 6>, Eigen::Vector3d> inverted(const RestMoments& m, double share) {
  Eigen::Matrix3d upper;
  upper << m[4] - m[1] * m[1] / m[0], m[7] - m[1] * m[2] / m[0], m[8] - m[1] * m[3] / m[0], 0, m[5] - m[2] * m[2] / m[0],
      m[9] - m[2] * m[3] / m[0], 0, 0, m[6] - m[3] * m[3] / m[0];
  const Eigen::Matrix3d a = upper.selfadjointView<Eigen::Upper>();
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(a, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(principal[0] * kThinRegion > share)) return {{}, Eigen::Vector3d::Zero()};
  const Eigen::Matrix3d i = a.inverse();
  return {{i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)}, share * principal.cwiseInverse()};
}

}  // namespace

std::vector<double> region_sums(const FlsmBatch& batch, const std::vector<double>& values, bool back) {
  std::vector<double> sum = values;
  sum.resize(batch.link.size(), 0.0);
  for (int pass = 0; pass < 3; ++pass) {
    const int axis = back ? 2 - pass : pass;
    const std::vector<double> in = sum;
    for (std::size_t i = 0; i < in.size(); ++i) {
      for (const int side : {0, 1}) {
        auto n = static_cast<std::int32_t>(i);
        for (int o = 1; o <= batch.settings.width; ++o) {
          n = batch.link[n][2 * axis + side];
          if (n < 0) break;
          sum[i] += in[n];
        }
      }
    }
  }
  sum.resize(values.size());
  const FlsmRegions& r = batch.regions;
  const auto& offset = back ? r.missing_of_offset : r.missing_offset;
  const auto& missing = back ? r.missing_of : r.missing;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    for (std::int32_t e = offset[i]; e < offset[i + 1]; ++e) sum[i] += missing[e].sign * values[missing[e].other];
  }
  return sum;
}

void make_elastic(FlsmBatch& batch, const Model& model) {
  if (batch.settings.young <= 0) return;
  const std::size_t nodes = batch.slot.size();
  const int w = batch.settings.width;
  weigh(batch, model.mass);
  std::vector<double> material(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    material[i] = model.own_mass(batch.slot[i]) * batch.matter[i] / batch.regions.holders[i];
    const auto c = std::lower_bound(model.constraints.begin(), model.constraints.end(), batch.slot[i],
                                    [](const Constraint& a, std::int32_t slot) { return a.slot < slot; });
    if (c != model.constraints.end() && c->slot == batch.slot[i] && c->axes == 7) {
      batch.weight[i] *= kHeldWeight[w - 1];
    } else if (batch.matter[i] < 1) {
      batch.weight[i] *= batch.matter[i];  // otherwise the traction along an interface would pull at its inner side
    }
  }
  const std::vector<double> held = region_sums(batch, material, false);
  const std::vector<RestMoments> moments = rest_moments(batch);
  const double nu = batch.poisson, shear = 1 / (1 + nu), bulk = nu / ((1 + nu) * (1 - 2 * nu));
  batch.elastic.assign(nodes, {});
  // The energy of a region is at most that of a spring to each of its nodes, so that of all regions is at most the mean over
  // the regions that contain a node.
  std::vector<double> stiffest(nodes, 1.0);
  for (std::size_t r = 0; r < nodes; ++r) {
    const double share = w * (w + 1) / 3.0 * held[r];
    const auto [inverse, ratio] = inverted(moments[r], share);
    if (ratio[0] == 0) continue;
    batch.elastic[r] = {inverse, share};
    stiffest[r] = std::max(1.0, shear * ratio.maxCoeff() + bulk * ratio.sum());
  }
  const std::vector<double> sum = region_sums(batch, stiffest, true);
  batch.stiffest = batch.stiffest_interface = 1;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double mean = sum[i] / batch.regions.holders[i];
    batch.stiffest = std::max(batch.stiffest, mean);
    if (static_cast<std::int32_t>(i) >= batch.own) batch.stiffest_interface = std::max(batch.stiffest_interface, mean);
  }
}

}  // namespace pliant
