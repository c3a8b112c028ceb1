// A bar under a load: stress at a point and the reaction of the clamp, compared with what a beam of that kind must give.
#include <pliant/pliant.h>

#include <cstdio>

int main() try {
  const double load = 0.2, side = 0.02, length = 0.1;  // [N], [m], [m]
  pliant::SceneSpec scene;
  scene.relaxation = pliant::RelaxationSpec{};  // to static equilibrium
  pliant::BodySpec bar;
  bar.surface = pliant::box_surface({0, 0, 0}, {length, side, side});
  bar.lattice_spacing = side / 4;
  bar.material.young = 50000;
  bar.material.poisson = 0.3;
  bar.fixed.push_back({pliant::RegionSpec::plane({0.0001, 0, 0}, {-1, 0, 0})});
  bar.forces.push_back({pliant::RegionSpec::plane({length - 0.0001, 0, 0}, {1, 0, 0}), {load, 0, 0}, {}});
  scene.bodies.push_back(bar);

  pliant::ProbeSpec middle;
  middle.name = "middle";
  middle.point = {length / 2, side / 2, side / 2};
  middle.quantities = {"displacement", "stress"};
  pliant::ProbeSpec clamp;
  clamp.name = "clamp";
  clamp.where = pliant::RegionSpec::plane({0.0001, 0, 0}, {-1, 0, 0});
  clamp.quantities = {"reaction"};
  scene.probes = {middle, clamp};

  pliant::World world(scene);
  pliant::StepReport report;
  while (!report.at_equilibrium && !report.diverged) report = world.step(1000);
  std::printf("at equilibrium after %lld steps\n", static_cast<long long>(report.step));
  for (const pliant::ProbeValue& value : world.probes()) {
    std::printf("%s, %s:", value.probe.c_str(), value.quantity.c_str());
    for (const double x : value.numbers) std::printf(" %.4g", x);
    std::printf("\n");
  }
  std::printf("load over area: %.4g Pa\n", load / (side * side));
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "probe: %s\n", error.what());
  return static_cast<int>(error.code());
}
