// touch_pair: kernel and twin give the same bits; in double, partners are those that a search through all pairs finds, whatever
// the boxes, and what was known of a pair goes on.
#include <set>

#include "kernels/contact/touch_case.h"

namespace pliant::kernel_test {
namespace {

using Eigen::Vector3d;

class TouchPair : public TwinTest {};

TEST_F(TouchPair, TwinGivesTheSameBits) {
  for_touch_data(1400, [&](const TouchData& d, const std::string& label) { expect_same_bits(touch_pair_case(d), label); });
  expect_same_bits(touch_pair_case(TouchData(1500, Data::large, 66 * 16)), "more tiles near than are listed");
}

/// The numbers of a pair that both points have had; null: none.
const double* known(const TouchData& d, std::size_t i, std::size_t j) {
  for (std::size_t s = 0; s < 16; ++s) {
    if (d.partner[ContactData::base(i, 16) + 16 * s] == static_cast<int>(j) + 1 && d.pair[TouchData::pair_at(i, s)] > 0)
      return &d.pair[TouchData::pair_at(i, s)];
  }
  return nullptr;
}

/// The weight of a pair by the book; 0: none. `close`: rounding may decide.
double weight(const TouchData& d, std::size_t i, std::size_t j, double& offset, bool& close) {
  const auto near_zero = [&](double v, double scale) { close = close || std::abs(v) < 1e-5 * scale; };
  const double large = std::max(d.spacing(i), d.spacing(j)), facing = -2 * d.normal(i).dot(d.normal(j)) - 1;
  const Vector3d apart = d.x(i) - d.x(j), n = (d.normal(j) - d.normal(i)).normalized();
  const double gap = d.gap(i, j), s = (apart - apart.dot(n) * n).norm() / (1.2 * large);
  const double closing = std::max(0.0, -(d.moved(i) - d.moved(j)).dot(n));
  near_zero(facing, 1);
  near_zero(1 - s, 1);
  near_zero(gap - d.params[5] - 32 * closing, large);
  near_zero(gap + large, large);
  near_zero(gap + 2 * large, large);
  offset = 0;
  if (facing <= 0 || s >= 1 || gap >= d.params[5] + 32 * closing) return 0;
  if (gap <= (known(d, i, j) ? -2 * large : -large)) return 0;
  const bool one_body = d.touch_rest[ContactData::base(i, 4) + 48] == d.touch_rest[ContactData::base(j, 4) + 48];
  bool same = true;
  for (std::size_t a = 0; a < 8; ++a)
    same = same && d.node[ContactData::base(i, 8) + 16 * a] == d.node[ContactData::base(j, 8) + 16 * a];
  if (one_body && same) return 0;
  if (one_body) {
    const Vector3d away = d.three(d.touch_rest, i, 4, 0) - d.three(d.touch_rest, j, 4, 0);
    const auto rest_normal = [&](std::size_t p) {
      return Vector3d(d.three(d.surface, p, PLIANT_TOUCH_SURFACE, 16).cross(d.three(d.surface, p, PLIANT_TOUCH_SURFACE, 19)));
    };
    near_zero(away.norm() - 4 * large, large);
    if (away.norm() < 4 * large) {
      near_zero(rest_normal(i).dot(rest_normal(j)) + 0.5, 1);
      const double rest = away.dot((rest_normal(j) - rest_normal(i)).normalized());
      near_zero(rest + 0.2 * large, large);
      if (rest_normal(i).dot(rest_normal(j)) >= -0.5 || rest < -0.2 * large) return 0;
      offset = std::min(0.0, rest);
    }
  }
  const double* before = known(d, i, j);
  offset = std::min(offset, before != nullptr ? before[16] + d.params[8] * large : gap);
  return (1 - s * s) * (1 - s * s) * facing;
}

TEST(TouchPairOracle, PartnersAreThoseOfASearchThroughAllPairs) {
  int pairs = 0, without = 0, offsets = 0, kept = 0;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    TouchData d(20000 + seed, Data::large, 32);
    const KernelCase test = touch_pair_case(d);
    const Reals found = ints_in_double(test, "touch_partner"), numbers = run_in_double(test, "touch_pair"),
                weights = run_in_double(test, "touch_weight"), near = ints_in_double(test, "contact_near");
    std::array<bool, 2> any{};
    for (std::size_t i = 0; i < d.points; ++i) {
      std::set<std::size_t> partners;
      double sum = 0;
      for (std::size_t s = 0; s < 16; ++s) {
        const double name = found[ContactData::base(i, 16) + 16 * s];
        if (name == 0) continue;
        const auto j = static_cast<std::size_t>(name) - 1;
        partners.insert(j);
        any[i / 16] = true;
        double offset = 0;
        bool close = false;
        const double exact = weight(d, std::min(i, j), std::max(i, j), offset, close);
        EXPECT_NEAR(weights[ContactData::base(i, 17) + 16 * s], exact, close ? 1 : 1e-5) << seed << ": " << i << ", " << j;
        EXPECT_NEAR(numbers[TouchData::pair_at(i, s) + 16], offset, close ? 1 : 1e-7);
        offsets += offset < 0;
        sum += d.area(j) * exact;
        for (std::size_t old = 0; old < 16; ++old) {
          if (d.partner[ContactData::base(i, 16) + 16 * old] != static_cast<int>(j) + 1) continue;
          if (d.pair[TouchData::pair_at(i, old)] == 0) continue;  // the other one did not have it
          ++kept;
          for (std::size_t k = 2; k < 6; ++k)
            EXPECT_NEAR(numbers[TouchData::pair_at(i, s) + 16 * k], d.pair[TouchData::pair_at(i, old) + 16 * k], 1e-7);
        }
      }
      EXPECT_NEAR(weights[ContactData::base(i, 17) + 256], sum, 1e-5);
      for (std::size_t j = 0; j < d.points && partners.size() < 16; ++j) {
        double offset = 0;
        bool close = false;
        if (i == j || d.spacing(i) == 0 || d.spacing(j) == 0) continue;
        const bool exact = weight(d, std::min(i, j), std::max(i, j), offset, close) > 0;
        if (close) continue;
        EXPECT_EQ(partners.count(j) == 1, exact) << "seed " << seed << ": " << i << " and " << j;
        (exact ? pairs : without) += 1;
      }
    }
    for (std::size_t tile = 0; tile < 2; ++tile) EXPECT_EQ((static_cast<int>(near[tile]) & PLIANT_TOUCH_BIT) != 0, any[tile]);
  }
  EXPECT_GT(pairs, 10000);
  EXPECT_GT(without, 100000);
  EXPECT_GT(offsets, 100);
  EXPECT_GT(kept, 100);
}

/// Points that each have seventeen others before them.
TouchData crowd() {
  TouchData d(1700, Data::large, 32);
  for (std::size_t i = 0; i < 32; ++i) {
    const bool high = i >= 16 || i == 0;
    for (std::size_t c = 0; c < 3; ++c) {
      d.place[PLIANT_TOUCH_PLACE * i + 8 + c] = c == 2 ? (high ? -1 : 1) : 0;
      d.place[PLIANT_TOUCH_PLACE * i + c] = c == 0 ? 0.001 * static_cast<double>(i) : c == 2 ? (high ? 0.001 : 0) : 0;
      d.place[PLIANT_TOUCH_PLACE * i + 4 + c] = 0;
    }
    d.rest[ContactData::base(i, 4) + 48] = 1e-3;
    d.surface[ContactData::base(i, PLIANT_TOUCH_SURFACE) + 352] = 0.03;
    d.touch_rest[ContactData::base(i, 4) + 48] = high ? 1 : 0;
  }
  d.make_boxes();
  return d;
}

TEST_F(TouchPair, TwinDropsTheSamePartners) { expect_same_bits(touch_pair_case(crowd()), "crowd"); }

/// Of more partners than there is room for those with the largest weights stay.
TEST(TouchPairOracle, TheWeakestGiveWay) {
  const TouchData d = crowd();
  const Reals found = ints_in_double(touch_pair_case(d), "touch_partner");
  std::set<int> partners;  // of point 1: 0 is nearest, 31 farthest; 17 points face it
  for (std::size_t s = 0; s < 16; ++s) partners.insert(static_cast<int>(found[ContactData::base(1, 16) + 16 * s]) - 1);
  std::set<int> expected{0};
  for (int j = 16; j < 31; ++j) expected.insert(j);
  EXPECT_EQ(partners, expected);
}

}  // namespace
}  // namespace pliant::kernel_test
