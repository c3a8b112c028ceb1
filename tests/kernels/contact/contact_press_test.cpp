// contact_press: kernel and twin give the same bits; in double, points inside a tool touch, and what points get, tools give.
#include <Eigen/Dense>

#include "kernels/contact/contact_case.h"

namespace pliant::kernel_test {
namespace {

using Eigen::Vector3d;

class ContactPress : public TwinTest {};

TEST_F(ContactPress, TwinGivesTheSameBits) {
  for_contact_data(200, [&](const ContactData& d, const std::string& label) {
    expect_same_bits(press_case(d), label);
    expect_same_bits(press_case(d, 1), label + ", with edges");
    expect_same_bits(press_case(with_grips(d), 0, 1), label + ", with grips");
    expect_same_bits(press_case(with_grips(d), 1, 1), label + ", with edges and grips");
    expect_same_bits(press_case(with_starts(d)), label + ", after an edit");
    expect_same_bits(press_case(with_starts(d), 1), label + ", after an edit, with edges");
    expect_same_bits(press_case(with_faces(d), 1), label + ", with faces of a blade");
  });
}

/// Signed distance by the book; of the grid by its eight weights.
double distance_of(const ContactData& d, std::size_t t, const Vector3d& y) {
  const double* n = &d.data[20 * t];
  const Vector3d first(n[1], n[2], n[3]), second(n[4], n[5], n[6]), origin(n[7], n[8], n[9]);
  if (t == 0) return y.norm() - n[0];
  if (t == 1) {
    double nearest = 1e9;
    for (int k = 0; k <= 100000; ++k) nearest = std::min(nearest, (y - first - 1e-5 * k * (second - first)).norm());
    return nearest - n[0];
  }
  if (t == 2) {
    const Vector3d q = y.cwiseAbs() - second;
    return q.maxCoeff() < 0 ? q.maxCoeff() : q.cwiseMax(0).norm();
  }
  if (t == 3) return (y - first).dot(second);
  const double* moment = &d.pose[ContactData::pose_numbers * ((test_step + 1) * ContactData::tools + t) + 12];
  const bool sequence = d.kind[8 * t + 5] > 1;
  const int size[3] = {6, 5, 4};
  const Vector3d g = (y - origin) / n[11];
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    if (g[k] < 0 || g[k] > size[k] - 1) return 1;
  }
  for (int z = 0; z < 4; ++z) {
    for (int v = 0; v < 5; ++v) {
      for (int x = 0; x < 6; ++x) {
        const Vector3d away = (g - Vector3d(x, v, z)).cwiseAbs();
        if (away.maxCoeff() >= 1) continue;
        const auto at = static_cast<std::size_t>((z * 5 + v) * 6 + x), frame = at + 120 * static_cast<std::size_t>(moment[0]);
        const double value = sequence ? (1 - moment[1]) * d.grid[frame] + moment[1] * d.grid[frame + 120] : d.grid[at];
        sum += (1 - away[0]) * (1 - away[1]) * (1 - away[2]) * value;
      }
    }
  }
  return sum;
}

/// After the trial step, or at its start.
Vector3d place_of(const ContactData& d, std::size_t i, bool at_start = false) {
  Vector3d x;
  for (std::size_t c = 0; c < 3; ++c) {
    x[static_cast<int>(c)] = d.rest[ContactData::base(i, 4) + 16 * c];
    for (std::size_t a = 0; a < 8; ++a) {
      const std::size_t entry = ContactData::base(i, 8) + 16 * a;
      x[static_cast<int>(c)] += d.weight[entry] * (d.node_u[4 * static_cast<std::size_t>(d.node[entry]) + c] -
                                                   (at_start ? d.node_w[4 * static_cast<std::size_t>(d.node[entry]) + c] : 0));
    }
  }
  return x;
}

/// In the frame of tool t at a row of poses.
Vector3d in_frame(const ContactData& d, std::size_t t, std::size_t row, const Vector3d& x) {
  const double* pose = &d.pose[ContactData::pose_numbers * (row * ContactData::tools + t)];
  Vector3d y = Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 3; ++k) y[c] += pose[3 * k + c] * (x[k] - pose[9 + k]);
  }
  return y;
}

/// Points that contact_press finds inside a tool are those behind the plane that touches it nearest to where they started.
TEST(ContactPressOracle, TouchesWhatIsInside) {
  int inside = 0, outside = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    ContactData d(300 + seed);
    std::fill(d.near.begin(), d.near.end(), 31);
    const Reals force = ints_in_double(press_case(d), "contact_force");
    for (std::size_t i = 0; i < d.points; ++i) {
      const std::size_t at = ContactData::base(i, 4);
      for (std::size_t t = 0; t < ContactData::tools; ++t) {
        const Vector3d start = in_frame(d, t, test_step, place_of(d, i, true)),
                       way = in_frame(d, t, test_step + 1, place_of(d, i)) - start;
        Vector3d slope;
        for (int c = 0; c < 3; ++c)
          slope[c] =
              (distance_of(d, t, start + 1e-5 * Vector3d::Unit(c)) - distance_of(d, t, start - 1e-5 * Vector3d::Unit(c))) /
              2e-5;
        if (std::abs(slope.norm() - 1) > 1e-3 && t < 4) continue;  // on an edge
        const double distance = distance_of(d, t, start) + way.dot(slope.normalized());
        if (std::abs(distance) < 1e-4) continue;  // the case is rounded to float
        const bool touches = (static_cast<int>(force[at + 48]) >> t & 1) != 0;
        EXPECT_EQ(touches, distance < 0 && d.rest[at + 48] > 0) << "tool " << t << ", point " << i << ", " << distance;
        (touches ? inside : outside) += 1;
      }
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

/// What an edit has left deep in a tool is known as deep after the first step, never deeper than it was, and forgotten outside;
/// where nothing was left, nothing is.
TEST(ContactPressOracle, RemembersWhatAnEditLeftDeep) {
  int seen = 0, kept = 0, forgotten = 0;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    ContactData d(700 + seed);
    std::fill(d.near.begin(), d.near.end(), 31);
    std::fill(d.held.begin(), d.held.end(), 0.0);
    const Reals none = run_in_double(press_case(d), "contact_start");
    EXPECT_EQ(none, Reals(none.size(), 0.0));
    const ContactData left = with_starts(d);
    const Reals after = run_in_double(press_case(left), "contact_start");
    const std::vector<std::int32_t> bits = [&] {
      const Reals force = ints_in_double(press_case(left), "contact_force");
      std::vector<std::int32_t> out;
      for (std::size_t i = 0; i < d.points; ++i) out.push_back(static_cast<std::int32_t>(force[ContactData::base(i, 4) + 48]));
      return out;
    }();
    for (std::size_t i = 0; i < d.points; ++i) {
      const std::size_t at = ContactData::base(i, 2);
      const double had = left.left_deep[at], in = left.left_deep[at + 16], has = after[at], now_in = after[at + 16];
      EXPECT_GE(has, 0) << i;
      EXPECT_EQ(has > 0, now_in > 0) << i;
      EXPECT_TRUE(has == 0 || (bits[i] >> (static_cast<int>(now_in) - 1) & 1) != 0) << i;
      EXPECT_TRUE(had <= 0 || has == 0 || now_in == in) << i;
      EXPECT_TRUE(had < 0 || has <= had + 1e-8) << i;
      seen += had < 0 && has > 0;
      kept += had > 0 && std::abs(has - had) < 1e-8;  // the case is rounded to float
      forgotten += had > 0 && has == 0;
    }
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(kept, 20);
  EXPECT_GT(forgotten, 20);
}

TEST(ContactPressOracle, ActionIsReactionInFixedPoint) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const ContactData d(500 + seed);
    expect_action_is_reaction(d, press_case(d), "contact_force", {});
    expect_action_is_reaction(d, press_case(d, 1), "contact_force", {}, 1);
  }
}

/// Without friction a sphere pushes along the line from its centre, however it is turned, and nothing else does.
TEST(ContactPressOracle, ASphereWithoutFrictionPushesAwayFromItsCentre) {
  int pushed = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    ContactData d(700 + seed);
    std::fill(d.near.begin(), d.near.end(), 1);  // tool 0
    const Reals force = ints_in_double(press_case(d), "contact_force");
    const double* pose = &d.pose[ContactData::pose_numbers * (test_step + 1) * ContactData::tools];
    for (std::size_t i = 0; i < d.points; ++i) {
      const std::size_t at = ContactData::base(i, 4);
      const Vector3d f(force[at], force[at + 16], force[at + 32]), start = in_frame(d, 0, test_step, place_of(d, i, true));
      Vector3d away;
      for (int k = 0; k < 3; ++k) away[k] = Vector3d(pose[3 * k], pose[3 * k + 1], pose[3 * k + 2]).dot(start);
      if (force[at + 48] == 0 || f.norm() < 1e4) continue;  // rounded to whole quanta
      if (f.cwiseAbs().maxCoeff() == 67108864.0) continue;  // the most that a point gets
      EXPECT_GT(f.normalized().dot(away.normalized()), 1 - 1e-6) << "point " << i;
      ++pushed;
    }
  }
  EXPECT_GT(pushed, 20);
}

/// Of a point with held nodes inside a sphere, only the depth beyond theirs is taken back: a node that is held does not move.
TEST(ContactPressOracle, TheDepthOfHeldNodesStays) {
  int less = 0, none = 0;
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    ContactData d(800 + seed);
    std::fill(d.near.begin(), d.near.end(), 1);  // tool 0
    std::fill(d.yield.begin(), d.yield.end(), 1e-4);
    const Reals force = ints_in_double(press_case(d), "contact_force");
    const double* pose = &d.pose[ContactData::pose_numbers * (test_step + 1) * ContactData::tools];
    for (std::size_t i = 0; i < d.points; ++i) {
      const std::size_t at = ContactData::base(i, 4);
      const double part = d.held[at + 48];
      if (force[at + 48] == 0 || d.rest[at + 48] == 0 || part == 0) continue;
      Vector3d held;
      for (std::size_t c = 0; c < 3; ++c) {
        held[static_cast<int>(c)] = d.held[at + 16 * c];
        for (std::size_t a = 0; a < 8; ++a) {
          const std::size_t entry = ContactData::base(i, 8) + 16 * a;
          if (d.share[entry] == 0)
            held[static_cast<int>(c)] += d.weight[entry] * d.node_u[4 * static_cast<std::size_t>(d.node[entry]) + c];
        }
      }
      const Vector3d start = in_frame(d, 0, test_step, place_of(d, i, true)), n = start.normalized();
      Vector3d normal;
      for (int k = 0; k < 3; ++k) normal[k] = Vector3d(pose[3 * k], pose[3 * k + 1], pose[3 * k + 2]).dot(n);
      const double depth = -distance_of(d, 0, start) - n.dot(in_frame(d, 0, test_step + 1, place_of(d, i)) - start);
      const double of_held = std::max(0.0, part * depth - normal.dot(held - part * place_of(d, i)));
      const Vector3d f(force[at], force[at + 16], force[at + 32]);
      const double push = d.rest[at + 48] / 1e-4 * std::max(0.0, depth - of_held);
      EXPECT_NEAR(d.params[0] * f.norm(), push, 1e-3 * push + 1e-2) << "point " << i;
      (push == 0 ? none : less) += of_held > 0;
    }
  }
  EXPECT_GT(less, 20);
  EXPECT_GT(none, 5);
}

}  // namespace
}  // namespace pliant::kernel_test
