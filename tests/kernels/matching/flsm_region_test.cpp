// flsm_region: kernel and twin give the same bits; in double, T of the nodes in a window from their positions; the rotation in
// float against a singular value decomposition in double, over classes of moments.
#include <limits>

#include "kernels/matching/flsm_oracle.h"

namespace pliant::kernel_test {
namespace {

class FlsmRegion : public FlsmTwinTest {};

TEST_F(FlsmRegion, TwinGivesTheSameBits) {
  for (const int elastic : {0, 1}) {
    compare([elastic](const FlsmData& d, int width) { return flsm_region_case(d, width, elastic); },
            4800 + 100 * static_cast<std::uint32_t>(elastic));
  }
}

/// T X = R (X - C) + c by positions; the record says it as X + t + h D o.
void expect_region(const FlsmLattice& lattice, const Reals& records, int i) {
  double mass = 0;
  Vector3d rest_center = Vector3d::Zero(), center = Vector3d::Zero();
  Matrix3d a = Matrix3d::Zero();
  const auto for_nodes = [&](const auto& visit) {
    lattice.for_window(true, true, true, [&](const Offset& o) {
      if (!lattice.holds(i, o)) return;
      const int node = lattice.at(i, o);
      visit(lattice.mass(node), lattice.rest(node), lattice.rest(node) + lattice.u(node));
    });
  };
  for_nodes([&](double m, const Vector3d& rest, const Vector3d& x) {
    mass += m;
    rest_center += m * rest;
    center += m * x;
  });
  rest_center /= mass;
  center /= mass;
  for_nodes(
      [&](double m, const Vector3d& rest, const Vector3d& x) { a += m * (x - center) * (rest - rest_center).transpose(); });
  const Eigen::JacobiSVD<Matrix3d> svd(a);
  const Vector3d s = svd.singularValues();
  const double gap = (s[1] + (a.determinant() > 0 ? s[2] : -s[2])) / s[0];
  if (gap < 1e-2) return;  // a region of few nodes, whose rotation is not determined
  const Matrix3d r = nearest_rotation(a);
  const Vector3d t = r * (lattice.rest(i) - rest_center) + center - lattice.rest(i);
  const std::size_t at = PLIANT_FLSM_RECORD * static_cast<std::size_t>(i);
  const std::string what = "region " + std::to_string(i);
  expect_near(t, records, at, 1e-10, what + ", t");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Matrix3d hd = FlsmLattice::spacing * (r - Matrix3d::Identity());
    expect_near(hd.col(static_cast<Eigen::Index>(axis)), records, at + 4 * axis + 4, 1e-10, what + ", h D");
  }
}

TEST(FlsmRegionOracle, IsTheRigidMotionOfTheNodesInsideTheWindow) {
  Random random(13);
  for (const FlsmLattice& lattice : lattices(random)) {
    FlsmData d = lattice.data();
    ASSERT_EQ(lattice.has_holes(), d.missing.size() > 100) << "holes without a list, or a list without holes";
    d.plates = lattice.moments(true, PLIANT_FLSM_RECORD);
    d.reference = {2, -3, 1, 0, 9, 9, 9, 9};  // plates are relative to it already
    for (int i = 0; i < lattice.nodes(); ++i) {
      put(d.node_u, 4 * static_cast<std::size_t>(d.slot[static_cast<std::size_t>(i)]),
          lattice.u(i) + vector_at(d.reference, 0));
    }
    const Reals records = run_in_double(flsm_region_case(d, lattice.width()), "flsm_regions");
    for (int i = 0; i < lattice.nodes(); ++i) expect_region(lattice, records, i);
    for (std::size_t k = PLIANT_FLSM_RECORD * static_cast<std::size_t>(lattice.nodes()); k < records.size(); ++k) {
      EXPECT_EQ(records[k], 0) << "the region that stands for absent ones moved";
    }
  }
}

void put_elastic(Reals& planes, std::size_t region, const Matrix3d& inverse, double q) {
  const double plane[PLIANT_FLSM_ELASTIC_PLANES] = {
      inverse(0, 0), inverse(1, 1), inverse(2, 2), inverse(0, 1), inverse(0, 2), inverse(1, 2), q};
  const std::size_t base = region / PLIANT_TILE * PLIANT_FLSM_ELASTIC_PLANES * PLIANT_TILE + region % PLIANT_TILE;
  for (std::size_t p = 0; p < PLIANT_FLSM_ELASTIC_PLANES; ++p) planes[base + p * PLIANT_TILE] = plane[p];
}

/// From positions: F the best affine fit, F - q P(F) A^-1 with the stress that is the slope of psi(U - 1), F = R U; the rigid
/// motion beside it is that of F. Every third region stays rigid. Small strains and large ones.
TEST(FlsmRegionOracle, PullsLikeAnElasticBody) {
  Random random(15);
  constexpr double h = FlsmLattice::spacing;
  int checked = 0, large = 0;
  std::vector<FlsmLattice> all = lattices(random);
  for (FlsmLattice lattice : lattices(random)) {
    const Matrix3d by = Matrix3d::NullaryExpr([&] { return random.uniform(-4, 4); });
    lattice.set_u([&](const Vector3d& x) { return Vector3d(by * x); });
    all.push_back(lattice);
  }
  for (const FlsmLattice& lattice : all) {
    FlsmData d = lattice.data();
    d.plates = lattice.moments(true, PLIANT_FLSM_RECORD);
    d.pulls = d.regions;
    d.elastic.assign(PLIANT_FLSM_ELASTIC_PLANES * d.count, 0.0);
    d.shear = 0.8;
    d.bulk = 0.4;
    const auto q = [](int i) { return i % 3 == 0 ? 0.0 : 1.0 + 0.1 * (i % 7); };
    for (int i = 0; i < lattice.nodes(); ++i) {
      const RegionSums s = sums_of(lattice, i);
      const auto r = static_cast<std::size_t>(i);
      put_elastic(d.elastic, r, q(i) > 0 ? Matrix3d(h * h * s.at_rest.inverse()) : Matrix3d::Identity(), q(i));
      if (q(i) > 0) put_rest(d.rest, r, h / s.mass, (s.rest - lattice.rest(i)) / h, Matrix3d::Identity());
      put(d.node_u, 4 * static_cast<std::size_t>(d.slot[r]), lattice.u(i));
    }
    const KernelCase test = flsm_region_case(d, lattice.width(), 1);
    const Reals rigid = run_in_double(test, "flsm_regions"), pulls = run_in_double(test, "flsm_pulls");
    for (int i = 0; i < lattice.nodes(); ++i) {
      const RegionSums s = sums_of(lattice, i);
      const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(s.at_rest, Eigen::EigenvaluesOnly);
      if (solver.eigenvalues()[0] < 1e-2 * solver.eigenvalues()[2]) continue;  // few nodes: F is hardly determined
      const Matrix3d fit = s.moved * s.at_rest.inverse(), f = q(i) > 0 ? fit : s.moved / (h * h);
      const Vector3d sigma = f.jacobiSvd().singularValues();
      if (sigma[1] + (f.determinant() > 0 ? sigma[2] : -sigma[2]) < 1e-2 * sigma[0]) continue;
      const Matrix3d r = nearest_rotation(f), one = Matrix3d::Identity();
      const Matrix3d s2 = r.transpose() * f - one, law = d.shear * slope_of(s2);
      large += s2.squaredNorm() > PLIANT_FLSM_STRAIN ? 1 : 0;
      const Matrix3d stress = r * (law + d.bulk * s2.trace() * one);
      const Matrix3d g = q(i) > 0 ? Matrix3d(f - q(i) * h * h * stress * s.at_rest.inverse()) : r;
      const std::size_t at = PLIANT_FLSM_RECORD * static_cast<std::size_t>(i);
      const std::string what = "region " + std::to_string(i);
      const double scale = 1 + g.norm();
      expect_near(s.now + g * (lattice.rest(i) - s.rest) - lattice.rest(i), pulls, at, 1e-9 * scale, what + ", t");
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const std::size_t block = at + 4 * static_cast<std::size_t>(axis) + 4;
        expect_near(h * (g - one).col(axis), pulls, block, 1e-9 * scale, what + ", pull");
        expect_near(h * (r - one).col(axis), rigid, block, 1e-9 * scale, what + ", rotation");
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 3000);
  EXPECT_GT(large, 1000);
}

TEST(FlsmRegionOracle, IsExactlyZeroAtRest) {
  Random random(14);
  for (const Offset& size : {Offset{6, 5, 4}, Offset{6, 5, 1}, Offset{1, 9, 1}, Offset{1, 1, 1}}) {
    FlsmData d = FlsmLattice(random, size, size[2] > 1 ? 0.2 : 0, 2).data();
    d.exact = false;
    d.node_u.assign(d.node_u.size(), 0);
    d.regions.assign(d.regions.size(), 0);
    for (const bool in_double : {false, true}) {
      for (const double r : run_in_twin(flsm_region_case(d, 2), "flsm_regions", in_double)) EXPECT_EQ(r, 0);
    }
  }
}

/// Moments of one region: at rest, and what the displacements add.
struct Moments {
  Matrix3d rest, added;
};

float rounded(double x) { return static_cast<float>(x); }

Matrix3d rounded(const Matrix3d& m) {
  return m.unaryExpr([](double x) { return static_cast<double>(rounded(x)); });
}

/// A launch whose regions have these moments, the sum of m u being zero. The z moment comes from a helper region at +z; the sum
/// of m u that the helper brings is taken back exactly.
FlsmData moments_data(const std::vector<Moments>& moments) {
  const std::size_t n = moments.size();
  FlsmData d;
  d.count = (n + PLIANT_TILE - 1) / PLIANT_TILE * PLIANT_TILE;
  const std::size_t regions = d.count + n + 1;
  d.spacing = 1;
  d.node_u.assign(4, 0);
  d.plates.assign(PLIANT_FLSM_RECORD * regions, 0);
  d.regions.assign(PLIANT_FLSM_RECORD * regions, 0);
  d.rest.assign(PLIANT_FLSM_REST_PLANES * d.count, 0);
  d.link[2].assign(2 * regions, static_cast<int>(regions) - 1);
  d.missing_offset.assign(regions + 1, 0);
  d.missing.assign(1, 0);
  d.missing_factor.assign(4, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Matrix3d e = rounded(moments[i].added);
    const std::size_t helper = d.count + i;
    put(d.plates, PLIANT_FLSM_RECORD * i, -e.col(2));
    put(d.plates, PLIANT_FLSM_RECORD * i + 4, e.col(0));
    put(d.plates, PLIANT_FLSM_RECORD * i + 8, e.col(1));
    put(d.plates, PLIANT_FLSM_RECORD * helper, e.col(2));
    d.link[2][2 * i + 1] = static_cast<int>(helper);
    put_rest(d.rest, i, 0.1, Vector3d::Zero(), moments[i].rest);
  }
  return d;
}

Matrix3d difference_at(const Reals& records, std::size_t i) {
  Matrix3d d;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    d.col(static_cast<Eigen::Index>(axis)) = vector_at(records, PLIANT_FLSM_RECORD * i + 4 * axis + 4);
  }
  return d;
}

Matrix3d random_matrix(Random& random) {
  return Matrix3d::NullaryExpr([&] { return random.uniform(-1, 1); });
}

Matrix3d random_rotation(Random& random) { return nearest_rotation(random_matrix(random)); }

/// Second moments at rest of a full region, not quite the same along all axes.
Matrix3d random_rest_moments(Random& random) {
  const Matrix3d b = random_matrix(random);
  Matrix3d a = 0.1 * (b + b.transpose());
  for (int k = 0; k < 3; ++k) a(k, k) = random.uniform(0.7, 1.3);
  return a;
}

/// Sum of the two smaller singular values over the norm, the smallest counted negative in a reflection: how well the rotation
/// is determined.
double gap_of(const Matrix3d& a) {
  const Vector3d s = Eigen::JacobiSVD<Matrix3d>(a).singularValues();
  return (s[1] + (a.determinant() > 0 ? s[2] : -s[2])) / a.norm();
}

struct RotationError {
  double angle = 0;  ///< largest error [rad]
  double unit = 0;   ///< largest |R^T R - 1|
};

/// The worst of 4000 regions whose moments become `moved` (given the moments at rest), in the float or double twin.
RotationError worst(std::uint32_t seed, bool in_double, const std::function<Matrix3d(Random&, const Matrix3d&)>& moved) {
  Random random(seed);
  std::vector<Moments> moments;
  for (int i = 0; i < 4000; ++i) {
    const Matrix3d rest = rounded(random_rest_moments(random));
    moments.push_back({rest, moved(random, rest) - rest});
  }
  const Reals records = run_in_twin(flsm_region_case(moments_data(moments), 1), "flsm_regions", in_double);
  RotationError error;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Matrix3d expected = nearest_rotation(moments[i].rest + rounded(moments[i].added));
    const Matrix3d d = difference_at(records, i), r = d + Matrix3d::Identity();
    const double distance = (r - expected).norm();
    if (!(distance / std::sqrt(2.0) <= error.angle)) error.angle = distance / std::sqrt(2.0);  // a NaN stays
    error.unit = std::max(error.unit, (r.transpose() * r - Matrix3d::Identity()).norm());
    EXPECT_GT(r.determinant(), 0.999);
  }
  return error;
}

/// Bounds near those measured for this method before it was built (largest of 5000 matrices per class).
void expect_rotation(const char* what, double float_bound, double double_bound,
                     const std::function<Matrix3d(Random&, const Matrix3d&)>& moved) {
  const RotationError single = worst(21, false, moved), twice = worst(21, true, moved);
  std::printf("             %-24s float: %.1e rad (bound %.0e), double: %.1e rad (bound %.0e)\n", what, single.angle,
              float_bound, twice.angle, double_bound);
  EXPECT_LE(single.angle, float_bound) << what;
  EXPECT_LE(twice.angle, double_bound) << what << ", double";
  EXPECT_LE(single.unit, 2e-6) << what;
}

Matrix3d with_singular_values(Random& random, const Vector3d& s) {
  return random_rotation(random) * s.asDiagonal() * random_rotation(random).transpose();
}

TEST(FlsmRotation, RandomMoments) {
  expect_rotation("random", 5e-6, 1e-13, [](Random& random, const Matrix3d&) {
    for (;;) {
      const Matrix3d a = random_matrix(random);
      if (gap_of(a) > 0.05) return a;
    }
  });
}

TEST(FlsmRotation, LargeRotationsOfRestMoments) {
  expect_rotation("rotated and stretched", 2e-6, 1e-13, [](Random& random, const Matrix3d& rest) -> Matrix3d {
    return random_rotation(random) * (Matrix3d::Identity() + 0.2 * random_matrix(random)) * rest;
  });
}

TEST(FlsmRotation, PlanarMoments) {
  expect_rotation("planar", 2e-6, 1e-13, [](Random& random, const Matrix3d&) {
    return with_singular_values(random, {1, random.uniform(0.3, 1), 0});
  });
}

TEST(FlsmRotation, InvertedMoments) {
  expect_rotation("inverted", 2e-6, 1e-13, [](Random& random, const Matrix3d&) {
    return with_singular_values(random, {random.uniform(0.8, 1), random.uniform(0.6, 0.8), -random.uniform(0.1, 0.4)});
  });
}

TEST(FlsmRotation, NearlyLinearMoments) {
  expect_rotation("s2 = s3 = 1e-3", 2e-4, 1e-11, [](Random& random, const Matrix3d&) {
    return with_singular_values(random, {1, 1e-3, 1e-3});
  });
}

TEST(FlsmRotation, ScaleDoesNotMatter) {
  for (const double scale : {1e-3, 1e3}) {
    expect_rotation(
        scale < 1 ? "shrunk to 1e-3" : "grown by 1e3", 2e-6, 1e-13,
        [scale](Random& random, const Matrix3d& rest) -> Matrix3d { return scale * random_rotation(random) * rest; });
  }
}

/// Antisymmetric parts come from the displacements alone, so that D has digits where R has none: what is lost is the grid of
/// the iteration (2^-31, half a unit of it in the quaternion up to eight times), 3e-9 rad at any angle.
TEST(FlsmRotation, SmallRotationsKeepTheirDigits) {
  for (const double angle : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const auto moved = [angle](Random& random, const Matrix3d& rest) -> Matrix3d {
      const Vector3d axis = Vector3d::NullaryExpr([&] { return random.uniform(-1, 1); }).normalized();
      return Eigen::AngleAxisd(angle, axis) * (Matrix3d::Identity() + angle * random_matrix(random)) * rest;
    };
    const double single = worst(22, false, moved).angle, twice = worst(22, true, moved).angle;
    const double bound = 4e-9 + 3e-6 * angle;
    std::printf("             rotations of %.0e rad  float: %.1e rad (bound %.0e), double: %.1e rad\n", angle, single, bound,
                twice);
    EXPECT_LE(single, bound) << angle;
    EXPECT_LE(twice, 1e-13) << angle;
  }
}

/// Along a line the rotation about it is free, but the line goes where it should.
TEST(FlsmRotation, LinesTurnIntoTheirNewDirection) {
  Random random(23);
  std::vector<Moments> moments;
  for (int i = 0; i < 400; ++i) {
    Matrix3d rest = Matrix3d::Zero(), moved = Matrix3d::Zero();
    rest(i % 3, i % 3) = 2;
    moved.col(i % 3) = 2 * random_rotation(random).col(0);
    moments.push_back({rest, moved - rest});
  }
  const Reals records = run_in_float(flsm_region_case(moments_data(moments), 1), "flsm_regions");
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Matrix3d r = difference_at(records, i) + Matrix3d::Identity();
    const auto axis = static_cast<Eigen::Index>(i % 3);
    const Vector3d to = (moments[i].rest + moments[i].added).col(axis).normalized();
    EXPECT_LE((r.col(axis) - to).norm(), 2e-6) << i;
    EXPECT_NEAR(r.determinant(), 1, 2e-6) << i;
  }
}

/// A region that settles late, such as a line, does not change the bits of the others in its tile, nor does the number of
/// lanes.
TEST(FlsmRotation, RegionsStopByThemselves) {
  Random random(25);
  std::vector<Moments> alone;
  for (int i = 0; i < PLIANT_TILE; ++i) {
    const Matrix3d rest = rounded(random_rest_moments(random));
    alone.push_back({rest, random_rotation(random) * (Matrix3d::Identity() + 0.3 * random_matrix(random)) * rest - rest});
  }
  const Reals expected = run_in_float(flsm_region_case(moments_data(alone), 1), "flsm_regions");
  std::vector<Moments> mixed = alone;
  mixed[3].rest = Vector3d(1, 0, 0).asDiagonal();
  mixed[3].added = random_rotation(random) * mixed[3].rest - mixed[3].rest;
  const Reals records = run_in_float(flsm_region_case(moments_data(mixed), 1), "flsm_regions");
  for (std::size_t i = 0; i < alone.size(); ++i) {
    if (i == 3) continue;
    EXPECT_EQ(difference_at(records, i), difference_at(expected, i)) << i;
  }
}

/// Where the moments vanish or are not finite, D stays, and t follows the centroid with it.
TEST(FlsmRotation, CollapsedMomentsKeepTheRotationBefore) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  Random random(24);
  std::vector<Moments> moments;
  const Matrix3d rest = rounded(random_rest_moments(random));
  moments.push_back({rest, -rest});
  moments.push_back({rest, (1e-13 - 1) * rest});  // rounds to nothing
  moments.push_back({rest, -rest});
  moments.back().added(1, 0) = nan;
  moments.push_back({rest, -rest});
  moments.back().added(2, 1) = infinite;
  moments.push_back({rest, Matrix3d::Constant(1e30)});  // its square is infinite
  moments.push_back({Matrix3d::Zero(), Matrix3d::Zero()});
  moments.push_back({rest, Matrix3d::Zero()});  // this one does not collapse
  FlsmData d = moments_data(moments);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    put_rest(d.rest, i, 0.1, {0.5, -0.25, 0.125}, moments[i].rest);
    for (std::size_t block = 0; block < 4; ++block) {
      put(d.regions, PLIANT_FLSM_RECORD * i + 4 * block, Vector3d(random.integer(-8, 8), random.integer(-8, 8), 1) / 8);
    }
  }
  const Reals records = run_in_float(flsm_region_case(d, 1), "flsm_regions");
  d.elastic.assign(PLIANT_FLSM_ELASTIC_PLANES * d.count, 0.0);
  for (std::size_t i = 0; i < moments.size(); ++i) put_elastic(d.elastic, i, Matrix3d::Identity(), 1);
  d.pulls.assign(d.regions.size(), 9.0);
  const Reals pulls = run_in_float(flsm_region_case(d, 1, 1), "flsm_pulls");
  for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
    EXPECT_EQ(difference_at(pulls, i), difference_at(d.regions, i)) << "the pull of " << i;
  }
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Matrix3d kept = i + 1 < moments.size() ? difference_at(d.regions, i) : Matrix3d::Zero();
    EXPECT_EQ(difference_at(records, i), kept) << i;
    expect_near(-(kept * Vector3d(0.5, -0.25, 0.125)), records, PLIANT_FLSM_RECORD * i, 1e-7, "t of " + std::to_string(i));
  }
}

}  // namespace
}  // namespace pliant::kernel_test
