#include "schedule/matching/flsm_data.h"

#include <Eigen/Dense>
#include <cmath>

#include "model/matching/flsm.h"

namespace pliant {
namespace {

/// Offsets by region, and per entry an index and four factors. `scale` and `number` are functions of the entry's other end.
template <class Number, class Scale>
void add_missing(const RegionLayout& places, const std::vector<std::int32_t>& offset, const std::vector<RegionEntry>& entries,
                 const Number& number, const Scale& scale, MissingList& out) {
  std::vector<std::int32_t> count(static_cast<std::size_t>(places.nodes) + 1, 0);
  for (std::size_t n = 0; n + 1 < offset.size(); ++n)
    count[places.of(static_cast<std::int32_t>(n)) + 1] = offset[n + 1] - offset[n];
  out.offset.assign(count.size(), 0);
  for (std::size_t r = 1; r < count.size(); ++r) out.offset[r] = out.offset[r - 1] + count[r];
  for (const RegionEntry& entry : entries) {
    out.other.push_back(number(entry.other));
    const double s = entry.sign * scale(entry.other);
    out.factor.insert(out.factor.end(), {s, s * entry.offset[0], s * entry.offset[1], s * entry.offset[2]});
  }
}

/// The inverse of a region's inertia about its centroid, times the spacing: xx yy zz xy xz yz. Zero for a region on a line.
void set_spin(const double (&plane)[PLIANT_FLSM_REST_PLANES], double spacing, std::size_t r, std::vector<double>& spin) {
  Eigen::Matrix3d a;
  a << plane[4], plane[7], plane[8], plane[7], plane[5], plane[9], plane[8], plane[9], plane[6];
  const Eigen::Matrix3d inertia = a.trace() * Eigen::Matrix3d::Identity() - a;
  if (!(inertia.determinant() > 1e-9 * std::pow(inertia.trace(), 3))) return;
  const Eigen::Matrix3d inverse = spacing * inertia.inverse();
  const double value[PLIANT_FLSM_SPIN_PLANES] = {inverse(0, 0), inverse(1, 1), inverse(2, 2),
                                                 inverse(0, 1), inverse(0, 2), inverse(1, 2)};
  for (int p = 0; p < PLIANT_FLSM_SPIN_PLANES; ++p) spin[tile_base(r, PLIANT_FLSM_SPIN_PLANES) + p * PLIANT_TILE] = value[p];
}

/// Planes of flsm_elastic, and the undeformed moments of its best affine fit. `mean`: unit of the weights in the sums [kg].
void set_elastic(const RegionElasticity& e, double mean, std::size_t r, RegionData& data) {
  double* const plane = data.elastic.data() + tile_base(r, PLIANT_FLSM_ELASTIC_PLANES);
  for (int p = 0; p < 6; ++p) plane[p * PLIANT_TILE] = e.share > 0 ? mean * e.inverse[p] : p < 3;
  plane[6 * PLIANT_TILE] = e.share / mean;
  if (e.share == 0) return;
  double* const rest = data.rest.data() + tile_base(r, PLIANT_FLSM_REST_PLANES);
  for (int p = 0; p < 6; ++p) rest[(4 + p) * PLIANT_TILE] = p < 3;
}

}  // namespace

/// Sums run over displacements [m] with weights m / (mean m, spacing): the moments are plain numbers of moderate size.
RegionData region_data(const FlsmBatch& b, const RegionLayout& places) {
  RegionData data;
  const std::size_t nodes = b.slot.size(), count = static_cast<std::size_t>(places.count);
  const auto with_region = static_cast<std::size_t>(places.nodes);
  data.slot.resize(count);
  for (std::int32_t r = 0; r < places.count; ++r) {
    // Padding uses a slot without a node, in the interface a separate one each, since flsm_interface writes to it.
    const std::int32_t last = places.interface_base + (r - places.interface_base) % PLIANT_TILE;
    data.slot[r] = b.first_slot + (r < places.interface_base ? r : r < places.nodes ? last : places.own);
  }
  for (auto& link : data.link) link.assign(2 * count, places.own);
  data.weight.assign(count, 0.0);
  data.inverse_holders.assign(with_region, 0.0);
  data.rest.assign(PLIANT_FLSM_REST_PLANES * with_region, 0.0);
  data.spin.assign(PLIANT_FLSM_SPIN_PLANES * with_region, 0.0);
  data.rate_weight.assign(count, 0.0);
  if (!b.elastic.empty()) data.elastic.assign(PLIANT_FLSM_ELASTIC_PLANES * with_region, 0.0);
  double mean = 0;
  for (const double w : b.weight) mean += w / static_cast<double>(nodes);
  const auto weight = [&](std::int32_t n) { return b.weight[n] / (mean * b.spacing); };
  const auto rate_weight = [&](std::int32_t n) { return weight(n) * (n < b.own ? 1 : b.settings.substeps); };
  const std::vector<RestMoments> moments = rest_moments(b);
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto r = static_cast<std::size_t>(places.of(static_cast<std::int32_t>(n)));
    data.slot[r] = b.slot[n];
    data.weight[r] = weight(static_cast<std::int32_t>(n));
    data.rate_weight[r] = rate_weight(static_cast<std::int32_t>(n));
    data.inverse_holders[r] = 1.0 / b.regions.holders[n];
    const RestMoments& m = moments[n];
    const double x = m[1] / m[0], y = m[2] / m[0], z = m[3] / m[0];
    const double plane[PLIANT_FLSM_REST_PLANES] = {mean * b.spacing / m[0],
                                                   x,
                                                   y,
                                                   z,
                                                   (m[4] - m[1] * x) / mean,
                                                   (m[5] - m[2] * y) / mean,
                                                   (m[6] - m[3] * z) / mean,
                                                   (m[7] - m[1] * y) / mean,
                                                   (m[8] - m[1] * z) / mean,
                                                   (m[9] - m[2] * z) / mean};
    for (int p = 0; p < PLIANT_FLSM_REST_PLANES; ++p) {
      data.rest[tile_base(r, PLIANT_FLSM_REST_PLANES) + p * PLIANT_TILE] = plane[p];
    }
    set_spin(plane, b.spacing, r, data.spin);
    if (!b.elastic.empty()) set_elastic(b.elastic[n], mean, r, data);
  }
  for (std::size_t n = 0; n < b.link.size(); ++n) {
    const auto r = static_cast<std::size_t>(places.of(static_cast<std::int32_t>(n)));
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) data.link[axis][2 * r + side] = places.of(b.link[n][2 * axis + side]);
    }
  }
  const auto slot_of = [&](std::int32_t n) { return b.slot[n]; };
  add_missing(places, b.regions.missing_offset, b.regions.missing, slot_of, weight, data.missing);
  add_missing(places, b.regions.missing_offset, b.regions.missing, slot_of, rate_weight, data.rate_missing);
  const auto region_of = [&](std::int32_t r) { return places.of(r); };
  add_missing(
      places, b.regions.missing_of_offset, b.regions.missing_of, region_of, [](std::int32_t) { return 1.0; }, data.missing_of);
  return data;
}

}  // namespace pliant
