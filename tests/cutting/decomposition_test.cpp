// Blades whose method is decomposition: the tetrahedra of running bodies that they cross are divided, and feel nothing of it.
#include "cutting/remade_scenes.h"

namespace pliant::remade_test {
namespace {

constexpr BladeMethod kDivides = BladeMethod::decomposition;

/// What no edit may change: mass and volume, and that the surface is closed.
void expect_kept(const Simulation& s, double mass, double volume) {
  EXPECT_NEAR(mass_of(s) / mass, 1, 1e-12);
  EXPECT_NEAR(volume_of(s) / volume, 1, 1e-12);
  EXPECT_EQ(singular_edges(s.model().surface.triangles), 0);
}

TEST_F(Remade, ABlockIsDividedAndFallsApart) {
  Simulation s(cut_through(kDivides), open_backend("cpu"));
  const std::int64_t elements = s.model().bodies[0].elements();
  const double mass = mass_of(s), volume = volume_of(s), step = s.dt();
  std::int64_t edits = 0;
  while (s.time() < 0.22 && !s.divergence()) {
    const std::int64_t before = s.topology_version();
    s.advance(s.next_batch(16));
    if (s.topology_version() == before) continue;
    ++edits;
    expect_kept(s, mass, volume);
  }
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  EXPECT_GE(edits, 4);
  EXPECT_EQ(pieces_of(s.model().bodies[0]), 2);
  EXPECT_GT(s.model().bodies[0].elements(), elements + 200);
  EXPECT_EQ(s.cut_in_part(0), 0);
  EXPECT_LT(s.dt(), step);
  EXPECT_GT(s.dt(), 0.02 * step) << "what is cut off is not thinner than a tenth of an element";
}

/// H = F - I of the tetrahedra, or of the element's part of the whole body they belong to.
Eigen::Matrix3d gradient(const ModelBody& body, const std::array<std::int32_t, 4>& tet, const std::vector<Vec3d>& u) {
  Eigen::Matrix3d rest, moved;
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < 3; ++c) {
      rest(c, a) = body.rest[tet[a + 1]][c] - body.rest[tet[0]][c];
      moved(c, a) = u[tet[a + 1]][c] - u[tet[0]][c];
    }
  }
  return moved * rest.inverse();
}

/// The element that holds a place at rest, in a list of tetrahedra of another mesh of the same body.
std::size_t element_around(const ModelBody& body, const Vec3d& x) {
  double most = -HUGE_VAL;
  std::size_t best = 0;
  for (std::size_t e = 0; e < body.tets.size(); ++e) {
    std::array<Vec3d, 4> c;
    for (std::size_t a = 0; a < 4; ++a) c[a] = body.rest[body.tets[e][a]];
    const auto volume = [](const std::array<Vec3d, 4>& t) {
      return vec::dot(vec::cross(vec::sub(t[1], t[0]), vec::sub(t[2], t[0])), vec::sub(t[3], t[0]));
    };
    double least = HUGE_VAL;
    for (std::size_t a = 0; a < 4; ++a) {
      std::array<Vec3d, 4> part = c;
      part[a] = x;
      least = std::min(least, volume(part) / volume(c));
    }
    if (least > most) most = least, best = e;
  }
  return best;
}

/// A body that moves and is deformed, cut at once and then again and again: no element feels it.
TEST_F(Remade, DividingKeepsGradientsMomentumAndEnergy) {
  Scene scene = pulled(block(kDivides));
  scene.bodies[0].fixed.clear();
  scene.bodies[0].prescribed.clear();
  scene.bodies[0].initial.emplace_back();
  scene.bodies[0].initial[0].velocity = {{1, -2, 0.5}, {{{0, 3, -6}, {-4, 0, 2}, {5, -1, 0}}}};
  scene.least_step = 0;
  Simulation s(scene, open_backend("cpu:double"));
  for (int k = 0; k < 6; ++k) {
    s.advance(s.next_batch(16));
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    const ModelBody before = s.model().bodies[0];
    const std::vector<Vec3d> u = s.displacements(0);
    const Vec3d momentum = momentum_of(s);
    const Energies energy = energies_of(s);
    const double mass = mass_of(s);
    Vec3d at{0.007 * k - 0.018, 0, 0};
    for (std::size_t n = 0; n < u.size(); ++n)
      at = vec::add(at, vec::mul(vec::add(u[n], before.rest[n]), 1 / static_cast<double>(u.size())));
    const CutReport report = s.cut(plane_cut(at, {1, 0.3 * k - 0.9, 0.5 - 0.2 * k}, 0.06));
    ASSERT_TRUE(report.changed);
    EXPECT_GT(report.elements, 20) << "cut " << k;
    EXPECT_LE(report.step_after, report.step_before);
    EXPECT_NEAR(mass_of(s) / mass, 1, 1e-12);
    const Vec3d now = momentum_of(s);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(now[c], momentum[c], 1e-12 * vec::norm(momentum));
    EXPECT_NEAR(energies_of(s).strain / energy.strain, 1, 1e-6);
    // Mass that moves from the corners of an element to points between them moves at the mean of their velocities.
    EXPECT_LE(energies_of(s).kinetic, energy.kinetic);
    EXPECT_NEAR(energies_of(s).kinetic / energy.kinetic, 1, 1e-4);
    const ModelBody& body = s.model().bodies[0];
    const std::vector<Vec3d> moved = s.displacements(0);
    double worst = 0;
    for (std::size_t e = 0; e < body.tets.size(); e += 7) {
      Vec3d middle{};
      for (const std::int32_t n : body.tets[e]) middle = vec::add(middle, vec::mul(body.rest[n], 0.25));
      const Eigen::Matrix3d h = gradient(before, before.tets[element_around(before, middle)], u);
      worst = std::max(worst, (gradient(body, body.tets[e], moved) - h).norm());
    }
    EXPECT_LT(worst, 1e-10) << "cut " << k;
  }
  EXPECT_GE(pieces_of(s.model().bodies[0]), 5);
}

/// Only the order in which forces are summed may change.
TEST_F(Remade, ForcesOfUntouchedElementsAreTheSame) {
  Scene scene = pulled(block(kDivides));
  Simulation s(scene, open_backend("cpu:double"));
  while (s.time() < 0.2) s.advance(16);
  const std::vector<Vec3d> before = s.residual_forces(0), u = s.displacements(0);
  ASSERT_TRUE(s.cut(wall(0.033, 0.3)).changed);
  const std::vector<Vec3d> after = s.residual_forces(0), now = s.displacements(0);
  std::int64_t same = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    EXPECT_EQ(u[n], now[n]);
    if (std::abs(s.model().bodies[0].rest[n][0] - 0.033) < 0.022) continue;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(before[n][c], after[n][c], 1e-14);
    ++same;
  }
  EXPECT_GT(same, 40);
}

TEST_F(Remade, ABladeThatMovesDividesAsTheWholeSweepDoes) {
  Simulation moved(block(kDivides), open_backend("cpu")), once(block(kDivides), open_backend("cpu"));
  const auto at = [](double y) {
    return std::vector<BladePose>{
        {"scalpel", {{{0.033 + 0.27 * (y - 0.0193), y, -0.01}, {0.033 + 0.27 * (y - 0.0193), y, 0.05}}}}};
  };
  for (int k = 0; k <= 12; ++k) moved.move_blades(at(-0.01 + 0.005 * k));
  once.move_blades(at(-0.01));
  once.move_blades(at(0.05));
  EXPECT_EQ(pieces_of(moved.model().bodies[0]), 2);
  EXPECT_EQ(moved.model().bodies[0].elements(), once.model().bodies[0].elements());
  EXPECT_EQ(moved.model().nodes(), once.model().nodes());
  for (int k = 12; k >= 0; --k) moved.move_blades(at(-0.01 + 0.005 * k));  // back through its own cut
  EXPECT_EQ(moved.model().bodies[0].elements(), once.model().bodies[0].elements());
}

TEST_F(Remade, DividedBodiesResumeAndBackendsAgree) {
  Scene scene = pulled(cut_through(kDivides));
  Simulation whole(scene, open_backend("cpu"));
  while (whole.topology_version() < 3 && whole.step() < 4000) whole.advance(16);
  ASSERT_GE(whole.topology_version(), 3);
  whole.advance(5);
  const Checkpoint saved = take_checkpoint(whole);
  ASSERT_FALSE(whole.state().blades.traces.empty());
  whole.advance(700);
  ASSERT_GE(whole.topology_version(), 5);
  Simulation resumed(scene, open_backend("cpu"));
  restore_checkpoint(resumed, saved, "saved");
  resumed.advance(700);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(resumed.state()));
  Scene other = scene;
  other.blades[0].method = BladeMethod::removal;
  Simulation removes(other, open_backend("cpu")), divides(scene, open_backend("cpu"));
  const Checkpoint foreign = take_checkpoint(removes);
  EXPECT_NE(error_of([&] { restore_checkpoint(divides, foreign, "saved"); }).find("blades"), std::string::npos);
  if (!testing::has_opencl()) return;
  Simulation device(scene, open_backend("opencl:0"));
  device.advance(whole.step());
  EXPECT_EQ(whole.hash(), device.hash());
  EXPECT_EQ(write_state(whole.state()), write_state(device.state()));
}

TEST_F(Remade, RandomStrokesUnderLoadLeaveClosedSurfacesOfDividedBodies) {
  std::mt19937 dice(17);
  std::uniform_real_distribution<double> any(0, 1);
  std::int64_t edits = 0;
  for (int run = 0; run < 4; ++run) {
    Scene scene = pulled(block(kDivides, run % 3 == 2 ? ElementKind::tet4anp : ElementKind::tet4));
    scene.gravity = {0, -9.81, 0};
    Simulation s(scene, open_backend("cpu"));
    const double mass = mass_of(s), volume = volume_of(s);
    for (int stroke = 0; stroke < 8; ++stroke) {
      random_stroke(s, "stroke" + std::to_string(stroke), [&] { return any(dice); });
      expect_kept(s, mass, volume);
    }
    EXPECT_LT(s.model().bodies[0].elements(), 12 * 576);
    edits += s.topology_version();
  }
  EXPECT_GT(edits, 30);
}

/// A bar that is cut half through and pulled: both methods cut the same edges, and what is left bears alike. Smaller elements
/// at the end of the cut make it softer: by 6 % with cells of 10 and of 5 mm, by 4 % with cells of 3.3 mm.
TEST_F(Remade, APartlyCutBarBearsLikeOneWithVirtualNodes) {
  std::array<double, 2> pull{};
  for (const BladeMethod method : {kDivides, BladeMethod::virtual_nodes}) {
    Scene scene = block(method);
    scene.bodies[0].material.damping = 60;
    scene = pulled(scene);
    scene.bodies[0].prescribed[0].displacement[0] = 0.003;
    Simulation s(scene, open_backend("cpu"));
    ASSERT_TRUE(
        s.cut(sweep({{{0.033, -0.02, -0.02}, {0.033, -0.02, 0.06}}}, {{{0.033, 0.023, -0.02}, {0.033, 0.023, 0.06}}})).changed);
    EXPECT_EQ(pieces_of(s.model().bodies[0]), 1);
    while (s.time() < 1 && !s.divergence()) s.advance(s.next_batch(64));
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    const std::vector<Vec3d> residual = s.residual_forces(0);
    for (std::size_t n = 0; n < residual.size(); ++n) {
      if (s.model().bodies[0].rest[n][0] < 1e-6) pull[method == kDivides ? 0 : 1] += residual[n][0];
    }
  }
  EXPECT_GT(std::abs(pull[1]), 0.05);
  EXPECT_LT(pull[0] / pull[1], 1);
  EXPECT_GT(pull[0] / pull[1], 0.93);
}

TEST_F(Remade, ABladeThatPressesDividesWhereTissueGivesWay) {
  Scene scene = block(kDivides);
  scene.bodies[0].fixed.clear();
  hold(scene.bodies[0], {0, 0.0001, 0}, {0, -1, 0});
  scene.bodies[0].material.toughness = 4000;
  Blade scalpel = with_method(kDivides, "scalpel",
                              {{0, 0.033, 0.041, -0.01, 0.033, 0.041, 0.05}, {0.3, 0.033, 0.015, -0.01, 0.033, 0.015, 0.05}});
  scalpel.cuts = BladeCuts::by_force;
  scalpel.edge = 0.0005;
  scene.blades = {scalpel};
  Simulation s(scene, open_backend("cpu"));
  const double mass = mass_of(s), volume = volume_of(s);
  while (s.time() < 0.2 && !s.divergence()) s.advance(16);
  const Checkpoint saved = take_checkpoint(s);
  Simulation resumed(scene, open_backend("cpu"));
  restore_checkpoint(resumed, saved, "saved");
  while (s.time() < 0.3 && !s.divergence()) s.advance(16);
  ASSERT_FALSE(s.divergence()) << s.divergence()->message();
  expect_kept(s, mass, volume);
  const PressedBlade& pressed = s.state().pressed.at("scalpel");
  EXPECT_GT(pressed.first, 0) << "it pressed before anything gave way";
  EXPECT_GT(pressed.fracture, 0);
  EXPECT_GT(s.state().remade.elements, 50);
  resumed.advance(s.step() - resumed.step());
  EXPECT_EQ(s.hash(), resumed.hash());
}

/// The front of a blade is carried by the parts of the elements that carried it.
TEST_F(Remade, TheFrontOfABladeStaysWhereTheBladeIs) {
  Simulation s(block(kDivides), open_backend("cpu"));
  std::int64_t carried = 0;
  for (int k = 0; k <= 9; ++k) {
    const double y = -0.01 + 0.005 * k;
    const BladeSegment at{{{0.033 + 0.27 * (y - 0.0193), y, -0.01}, {0.033 + 0.27 * (y - 0.0193), y, 0.05}}};
    s.move_blades(std::vector<BladePose>{{"scalpel", at}});
    const auto found = s.state().blades.traces.find("host/scalpel");
    if (found == s.state().blades.traces.end()) continue;
    const ModelBody& body = s.model().bodies[0];
    for (const TracePoint& p : found->second.at(0).points) {
      if (p.node >= 0) continue;
      ++carried;
      Vec3d x{};
      for (std::size_t a = 0; a < 4; ++a) {
        const std::int32_t n = body.tets[static_cast<std::size_t>(p.carried.cell)][a];
        x = vec::add(x, vec::mul(body.rest[static_cast<std::size_t>(n)], p.carried.weight[a]));
      }
      EXPECT_NEAR(x[0], at[0][0], 1e-12);
      EXPECT_NEAR(x[1], at[0][1], 1e-12);
    }
  }
  EXPECT_GT(carried, 50);
}

/// In the gap of a cut, a blade that moves divides nothing more.
TEST_F(Remade, ABladeInTheGapDividesNothing) {
  for (const double gap : {0.012, 0.02, 0.03}) {
    Scene scene = block(kDivides);
    pull(scene.bodies[0], {0.06, 0, 0}, {1, 0, 0}, {gap, 0, 0}, 0.2);
    Simulation s(scene, open_backend("cpu"));
    ASSERT_TRUE(s.cut(wall(0.027, 0.3)).changed);
    ASSERT_EQ(pieces_of(s.model().bodies[0]), 2);
    while (s.time() < 0.5 && !s.divergence()) s.advance(16);
    ASSERT_FALSE(s.divergence()) << s.divergence()->message();
    const std::int64_t elements = s.model().elements();
    const auto place = [&](double y) {  // in its middle
      const double x = 0.027 + 0.3 * y + 0.5 * gap;
      return std::vector<BladePose>{{"scalpel", {{{x, y, -0.01}, {x, y, 0.05}}}}};
    };
    for (int k = 0; k <= 40; ++k) s.move_blades(place(-0.02 + 0.002 * k));
    EXPECT_EQ(s.model().elements(), elements) << "a gap of " << gap << " m";
  }
}

/// A part of an element has the material of the element, wherever its own middle lies.
TEST_F(Remade, PartsKeepTheMaterialOfTheirElement) {
  Scene scene = block(kDivides);
  Inclusion stiff;
  stiff.where = {Selection::Kind::box, {0.02, 0.005, 0.005}, {0.04, 0.035, 0.035}, 0, {}, ""};
  stiff.material = scene.bodies[0].material;
  stiff.material.set_moduli(Law::neo_hookean, Moduli::from_lame(40000, 10000));
  stiff.material.density = 3000;
  scene.bodies[0].inclusions.push_back(stiff);
  Simulation s(scene, open_backend("cpu"));
  const ModelBody whole = s.model().bodies[0];
  const double mass = mass_of(s);
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(s.cut(wall(0.021 + 0.009 * k, 0.4 - 0.3 * k)).changed);
  EXPECT_NEAR(mass_of(s) / mass, 1, 1e-12);
  const ModelBody& body = s.model().bodies[0];
  std::array<std::int64_t, 2> found{};
  for (std::size_t e = 0; e < body.tets.size(); ++e) {
    Vec3d middle{};
    for (const std::int32_t n : body.tets[e]) middle = vec::add(middle, vec::mul(body.rest[n], 0.25));
    EXPECT_EQ(body.materials.index[e], whole.materials.index[element_around(whole, middle)]);
    ++found[static_cast<std::size_t>(body.materials.index[e])];
  }
  EXPECT_GT(std::min(found[0], found[1]), 100);
}

/// A probe goes with the part that has its place.
TEST_F(Remade, AProbeStaysInItsPart) {
  Scene scene = pulled(block(kDivides));
  SceneProbe probe;
  probe.name = "here";
  probe.point = Vec3d{0.0331, 0.0207, 0.0203};
  probe.quantities = {Quantity::position, Quantity::stress};
  Simulation s(scene, open_backend("cpu"));
  const PlacedProbes probes({probe}, s.model());
  while (s.time() < 0.1) s.advance(s.next_batch(16));
  const ProbeState before = probes.states(s)[0];
  ASSERT_TRUE(s.cut(wall(0.0375)).changed);
  const ProbeState now = probes.states(s)[0];
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR((*now.position)[c], (*before.position)[c], 1e-8);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR((*now.stress)[c], (*before.stress)[c], 1e-3 * std::abs((*before.stress)[0]));
}

TEST_F(Remade, ABodyOfHexahedraIsNotDivided) {
  Scene lattice = scene_with(box_body("box", {0.04, 0.03, 0.03}));
  lattice.blades.push_back(with_method(kDivides, "a", {{0, 0, 0, 0, 0, 0, 1}, {1, 1, 0, 0, 1, 0, 1}}));
  EXPECT_NE(error_of([&] { Simulation(lattice, open_backend("cpu")); }).find("is a lattice"), std::string::npos);
  lattice.bodies[0].plain = true;
  EXPECT_NE(error_of([&] { Simulation(lattice, open_backend("cpu")); }).find("is of hexahedra"), std::string::npos);
}

}  // namespace
}  // namespace pliant::remade_test
