// Random tissue on tissue: patches of two rough sheets that face each other, and whatever partners they have.
#pragma once
#include <Eigen/Dense>
#include <algorithm>

#include "kernels/contact/contact_case.h"
#include "layout.h"

namespace pliant::kernel_test {

struct TouchData : ContactData {
  static constexpr std::size_t slots_per_point = PLIANT_TOUCH_SLOTS;
  Reals surface, touch_rest, place, box, weights, pair, depth;
  Ints tree, partner, pair_force;

  static std::size_t pair_at(std::size_t i, std::size_t slot) {
    return base(i, slots_per_point * PLIANT_TOUCH_PAIR) + slot * PLIANT_TOUCH_PAIR * 16;
  }
  static std::size_t force_at(std::size_t i, std::size_t slot) {
    return base(i, slots_per_point * PLIANT_TOUCH_FORCE) + slot * PLIANT_TOUCH_FORCE * 16;
  }
  [[nodiscard]] Eigen::Vector3d three(const Reals& values, std::size_t i, std::size_t planes, std::size_t plane) const {
    const std::size_t at = base(i, planes) + 16 * plane;
    return {values[at], values[at + 16], values[at + 32]};
  }
  /// Of touch_place: 0 place, 1 increment, 2 normal, 3 tangent, 4 turn of the normal.
  [[nodiscard]] Eigen::Vector3d row(std::size_t i, std::size_t number) const {
    return Eigen::Vector3d(&place[PLIANT_TOUCH_PLACE * i + 4 * number]);
  }
  [[nodiscard]] double& yielding(std::size_t i) { return place[PLIANT_TOUCH_PLACE * i + 3]; }
  [[nodiscard]] Eigen::Vector3d x(std::size_t i) const { return row(i, 0); }
  [[nodiscard]] Eigen::Vector3d moved(std::size_t i) const { return row(i, 1); }
  [[nodiscard]] Eigen::Vector3d normal(std::size_t i) const { return row(i, 2); }
  /// How the gap of two points follows the upper normal: their distance along the surface at the start of the step, over the
  /// length of the difference of their normals; beyond one spacing, as much shorter as it was longer.
  [[nodiscard]] Eigen::Vector3d arm(std::size_t lower, std::size_t upper) const {
    const Eigen::Vector3d facing = normal(upper) - normal(lower), n = facing.normalized();
    const Eigen::Vector3d start = x(lower) - moved(lower) - x(upper) + moved(upper);
    const Eigen::Vector3d along = (start - start.dot(n) * n) / facing.norm();
    const double far = along.norm() / std::max(spacing(lower), spacing(upper));
    return far > 1 && spacing(lower) > 0 && spacing(upper) > 0 ? Eigen::Vector3d(along / (far * far)) : along;
  }
  [[nodiscard]] double gap(std::size_t lower, std::size_t upper) const {
    return (x(lower) - x(upper)).dot((normal(upper) - normal(lower)).normalized()) +
           arm(lower, upper).dot(row(upper, 4) - row(lower, 4));
  }
  /// How far two points are in front of each other after the next step, times the length of the difference of their normals.
  [[nodiscard]] double front(std::size_t lower, std::size_t upper) const {
    const Eigen::Vector3d facing = normal(upper) - normal(lower);
    return (x(lower) - x(upper)).dot(facing) - std::max(0.0, -(moved(lower) - moved(upper)).dot(facing));
  }
  [[nodiscard]] double spacing(std::size_t i) const { return surface[base(i, PLIANT_TOUCH_SURFACE) + 352]; }
  [[nodiscard]] double area(std::size_t i) const { return rest[base(i, 4) + 48]; }

  /// `numbers`: what places and increments are.
  explicit TouchData(std::uint32_t seed, Data numbers = Data::large, std::size_t count = 64)
      : ContactData(seed, numbers, count) {
    Random random(seed + 5000);
    params[5] = 0.02;
    params[7] = seed % 3 == 0 ? 0 : 0.4;
    params[8] = seed % 2 == 0 ? 0.04 : 0.002;
    make_points(random, numbers);
    make_tree();
    make_pairs(random);
  }

  /// Boxes around the places.
  void make_boxes() {
    const std::size_t tile_count = points / 16;
    box.assign(PLIANT_TOUCH_BOX * (tile_count + 1), 0.0);
    for (std::size_t tile = 0; tile <= tile_count; ++tile) {
      double* out = &box[PLIANT_TOUCH_BOX * tile];
      for (std::size_t k = 0; k < 9; ++k) {
        out[2 * k] = 1e30;
        out[2 * k + 1] = -1e30;
      }
      const std::size_t first = tile < tile_count ? 16 * tile : 0, last = tile < tile_count ? first + 16 : points;
      for (std::size_t i = first; i < last; ++i) {
        if (!(spacing(i) > 0)) continue;
        out[18] = std::max(out[18], spacing(i));
        for (std::size_t k = 0; k < 9; ++k) {
          const double v = place[PLIANT_TOUCH_PLACE * i + k + k / 3];
          out[2 * k] = std::min(out[2 * k], v);
          out[2 * k + 1] = std::max(out[2 * k + 1], v);
        }
      }
    }
  }

 private:
  void make_points(Random& random, Data numbers) {
    surface = random.reals(PLIANT_TOUCH_SURFACE * points, Data::large, 2);
    touch_rest.resize(4 * points);
    place.assign(PLIANT_TOUCH_PLACE * points, 0.0);
    for (std::size_t i = 0; i < points; ++i) {
      const bool high = random.chance(0.5);
      const Eigen::Vector3d up(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), high ? -1 : 1), n = up.normalized();
      const Eigen::Vector3d t = n.cross(Eigen::Vector3d(0.3, 1, 0.2)).normalized();
      const Eigen::Vector3d at(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.02, 0.02));
      // A third lies near its place at rest, the others have come from elsewhere.
      Eigen::Vector3d start = at;
      if (i % 3 != 0) start = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto k = static_cast<int>(c);
        double* own = &place[PLIANT_TOUCH_PLACE * i];
        own[c] = numbers == Data::large ? at[k] : random.draw(numbers, 0.2);
        own[4 + c] = random.draw(numbers, 1e-3);
        own[8 + c] = n[k];
        own[12 + c] = t[k];
        own[16 + c] = random.draw(numbers, 1e-2);
        own[7 + 4 * c] = c == 1 ? random.uniform(-0.3, 0.3) : random.uniform(0.8, 1.2);
        surface[base(i, PLIANT_TOUCH_SURFACE) + 16 * (16 + c)] = t[k];
        surface[base(i, PLIANT_TOUCH_SURFACE) + 16 * (19 + c)] = n.cross(t)[k];
        touch_rest[base(i, 4) + 16 * c] = start[k];
      }
      yielding(i) = random.chance(0.1) ? 0 : random.uniform(1e-6, 1e-5);
      surface[base(i, PLIANT_TOUCH_SURFACE) + 352] = rest[base(i, 4) + 48] > 0 ? random.uniform(0.03, 0.06) : 0;
      place[PLIANT_TOUCH_PLACE * i + 19] = spacing(i) > 0 ? 1 / spacing(i) : 0;
      touch_rest[base(i, 4) + 48] = random.integer(0, 1);
      if (random.chance(0.2)) {
        for (std::size_t a = 0; a < 8; ++a) node[base(i, 8) + 16 * a] = static_cast<std::int32_t>(a);
      }
    }
    make_boxes();
  }

  void make_tree() {
    const auto end = static_cast<std::int32_t>(points / 16);
    tree = {end, end + 1, 0, end};
    for (std::int32_t t = 0; t < end; ++t) tree.insert(tree.end(), {t, t + 2, t, t + 1});
  }

  /// Both have each other, but for a few.
  void make_pairs(Random& random) {
    partner.assign(slots_per_point * points, 0);
    weights.assign((slots_per_point + 1) * points, 0.0);
    pair.assign(slots_per_point * PLIANT_TOUCH_PAIR * points, 0.0);
    pair_force.assign(slots_per_point * PLIANT_TOUCH_FORCE * points, 0);
    std::vector<std::size_t> filled(points, 0);
    const auto add = [&](std::size_t i, std::size_t j, const std::array<double, 7>& numbers, const std::array<int, 4>& push) {
      const std::size_t at = filled[i]++;
      partner[base(i, slots_per_point) + 16 * at] = static_cast<std::int32_t>(j + 1);
      weights[base(i, slots_per_point + 1) + 16 * at] = numbers[6];
      for (std::size_t k = 0; k < 6; ++k) pair[pair_at(i, at) + 16 * k] = numbers[k];
      for (std::size_t k = 0; k < 4; ++k) pair_force[force_at(i, at) + 16 * k] = (k < 3 && i > j ? -1 : 1) * push[k];
    };
    for (std::size_t k = 0; k < 6 * points; ++k) {
      const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(points) - 1));
      const auto j = static_cast<std::size_t>(random.integer(0, static_cast<int>(points) - 1));
      bool known = i == j || filled[i] >= slots_per_point || filled[j] >= slots_per_point;
      for (std::size_t s = 0; s < slots_per_point; ++s) {
        known = known || partner[base(i, slots_per_point) + 16 * s] == static_cast<std::int32_t>(j + 1) ||
                partner[base(j, slots_per_point) + 16 * s] == static_cast<std::int32_t>(i + 1);
      }
      if (known) continue;
      std::array<double, 7> numbers{random.uniform(1e-4, 1e-3), random.chance(0.5) ? 0 : random.uniform(-1e-3, 0)};
      for (std::size_t c = 2; c < 5; ++c) numbers[c] = random.uniform(-0.1, 0.1);
      numbers[5] = random.chance(0.5) ? 1 : 0;
      numbers[6] = random.uniform(0.01, 1);
      std::array<int, 4> push{};
      for (std::size_t c = 0; c < 3; ++c) push[c] = random.integer(-1000000, 1000000);
      push[3] = random.chance(0.7) ? 1 : 0;
      add(i, j, numbers, push);
      if (!random.chance(0.05)) {
        add(j, i, numbers, push);
      } else {
        pair[pair_at(i, filled[i] - 1)] = 0;  // as touch_share leaves what is not mutual
        pair[pair_at(i, filled[i] - 1) + 80] = 0;
        pair_force[force_at(i, filled[i] - 1) + 48] = 0;
      }
    }
    for (std::size_t i = 0; i < points; ++i) {
      double whole = 0;
      for (std::size_t s = 0; s < filled[i]; ++s) {
        const auto j = static_cast<std::size_t>(partner[base(i, slots_per_point) + 16 * s] - 1);
        whole += area(j) * weights[base(i, slots_per_point + 1) + 16 * s];
      }
      weights[base(i, slots_per_point + 1) + 16 * slots_per_point] = whole;
    }
    for (std::int32_t& n : near) n |= PLIANT_TOUCH_BIT;
    if (points > 48) near[2] = 0;
    if (near.size() > 1) near[1] &= ~PLIANT_TOUCH_BIT;
    depth = random.positive(points, 0, 1e-3);
  }
};

inline KernelCase touch_box_case(const TouchData& d) {
  KernelCase test("touch_box", {}, Shape::tiles, d.points / 16);
  add_points(test, d).reals("touch_surface", d.surface).reals("touch_place", d.place).reals("touch_box", d.box);
  return test;
}

inline KernelCase touch_tree_case(const TouchData& d) {
  KernelCase test("touch_tree", {}, Shape::items, d.tree.size() / PLIANT_TOUCH_TREE);
  test.ints("touch_node", d.tree).reals("touch_box", d.box);
  return test;
}

inline KernelCase touch_pair_case(const TouchData& d) {
  KernelCase test("touch_pair", {}, Shape::tiles, d.points / 16);
  test.reals("touch_place", d.place)
      .reals("touch_box", d.box)
      .ints("touch_node", d.tree)
      .reals("touch_surface", d.surface)
      .reals("touch_rest", d.touch_rest)
      .reals("contact_rest", d.rest)
      .ints("contact_node", d.node)
      .ints("touch_partner", d.partner)
      .reals("touch_pair", d.pair)
      .reals("touch_weight", d.weights)
      .ints("contact_near", d.near)
      .reals("contact_yield", d.yield)
      .reals("contact_params", d.params)
      .integer(static_cast<std::int32_t>(d.tree.size() / PLIANT_TOUCH_TREE));
  return test;
}

inline KernelCase touch_share_case(const TouchData& d) {
  KernelCase test("touch_share", {}, Shape::lanes, d.points);
  test.reals("contact_rest", d.rest)
      .ints("contact_near", d.near)
      .ints("touch_partner", d.partner)
      .reals("touch_weight", d.weights)
      .reals("touch_pair", d.pair);
  return test;
}

inline KernelCase touch_place_case(const TouchData& d, int again) {
  KernelCase test("touch_place", {}, Shape::lanes, near_points(d));
  add_points(test, d)
      .reals("contact_share", d.share)
      .ints("contact_list", listed(d))
      .ints("contact_near", d.near)
      .reals("contact_yield", d.yield)
      .ints("contact_change", d.change)
      .reals("contact_node_sum", d.node_sum)
      .reals("touch_surface", d.surface)
      .reals("touch_place", d.place)
      .reals("step_params", d.step_params)
      .integer(again);
  return test;
}

inline KernelCase touch_press_case(const TouchData& d) {
  KernelCase test("touch_press", {}, Shape::lanes, near_points(d));
  test.reals("touch_place", d.place)
      .ints("contact_list", listed(d))
      .ints("contact_near", d.near)
      .reals("contact_yield", d.yield)
      .ints("contact_force", d.force)
      .ints("contact_change", d.change)
      .ints("touch_partner", d.partner)
      .reals("touch_pair", d.pair)
      .ints("touch_force", d.pair_force)
      .ints("touch_moment", d.moment)
      .reals("touch_depth", d.depth)
      .reals("contact_params", d.params);
  return test;
}

inline KernelCase touch_settle_case(const TouchData& d) {
  KernelCase test("touch_settle", {}, Shape::lanes, near_points(d));
  test.reals("touch_place", d.place)
      .ints("contact_list", listed(d))
      .ints("contact_near", d.near)
      .ints("contact_change", d.change)
      .ints("touch_partner", d.partner)
      .reals("touch_pair", d.pair)
      .ints("touch_force", d.pair_force)
      .ints("touch_moment", d.moment)
      .reals("contact_params", d.params);
  return test;
}

template <class Compare>
void for_touch_data(std::uint32_t seed, Compare compare) {
  for (std::uint32_t i = 0; i < 16; ++i) {
    const Data data = all_data[i % std::size(all_data)];
    compare(TouchData(seed + i, data, i % 2 == 0 ? 64 : 256),
            std::string(name_of(data)) + ", seed " + std::to_string(seed + i));
  }
}

/// All points are near others, and no tool is.
inline TouchData tissue_alone(std::uint32_t seed) {
  TouchData d(seed);
  std::fill(d.near.begin(), d.near.end(), PLIANT_TOUCH_BIT);
  return d;
}

/// The forces of all pairs on all points cancel, to the last quantum.
inline void expect_no_force_on_the_whole(const TouchData& d, const KernelCase& test) {
  const Reals change = ints_in_double(test, "contact_change");
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double size = 0;
  for (std::size_t i = 0; i < d.points; ++i) {
    sum += d.three(change, i, 4, 0);
    size += d.three(change, i, 4, 0).norm();
  }
  EXPECT_EQ(sum.norm(), 0);
  EXPECT_GT(size, 1e4);
}

}  // namespace pliant::kernel_test
