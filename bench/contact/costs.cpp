// The step with contact over the step without, in turn in one run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "bench/contact/parts.h"
#include "bench/contact/scenes.h"
#include "geometry/stopwatch.h"
#include "pliant/error.h"

namespace pliant::bench::contact {
namespace {

constexpr double kCostCell = 0.005;  // [m]

struct Variant {
  const char* words;  ///< nullptr: without contact, the reference of the variants after it
  bool driven = false;
  std::unique_ptr<Simulation> simulation;
  std::vector<double> seconds{};  ///< of each repetition
};

Scene block(std::int64_t nodes) {
  const int n = std::max(2, static_cast<int>(std::lround(std::cbrt(static_cast<double>(nodes)))) - 1);
  const double half = 0.5 * n * kCostCell;
  Scene scene;
  scene.bodies = {body_of("block", cells_surface({n, n, n}, kCostCell, {-half, -half, 0}), kCostCell, ElementKind::hex8,
                          tissue(8000, 0.45, 10))};
  scene.bodies[0].fixed = {{face(2, 0)}};
  return scene;
}

/// A rod of two cells' radius at a height [m].
ContactTool rod(double reach, double height) {
  ContactTool tool;
  tool.name = "rod";
  tool.shape = ToolShape::capsule;
  tool.radius = 2 * kCostCell;
  tool.first = {-reach, 0, 0};
  tool.second = {reach, 0, 0};
  tool.path = {{0, 0, 0, height, 0, 0, 0, 1}};
  return tool;
}

/// The block in two halves, the upper pressed onto the lower by a twentieth of its height in the first 0.1 s, before anything
/// is timed.
Scene halves(std::int64_t nodes) {
  const int n = std::max(2, static_cast<int>(std::lround(std::cbrt(static_cast<double>(nodes)))) - 1), low = n / 2;
  const double half = 0.5 * n * kCostCell, middle = low * kCostCell, top = n * kCostCell;
  const Material material = tissue(8000, 0.45, 40);
  const auto body = [&](const char* name, int layers, double from) {
    return body_of(name, cells_surface({n, n, layers}, kCostCell, {-half, -half, from}), kCostCell, ElementKind::hex8,
                   material);
  };
  Scene scene;
  scene.bodies = {body("low", low, 0), body("high", n - low, middle)};
  scene.bodies[0].fixed = {{face(2, 0)}};
  Prescribed down;
  down.where = face(2, top);
  down.displacement = {0.0, 0.0, -0.05 * (top - middle)};
  down.curve.kind = Curve::Kind::smooth;
  down.curve.duration = 0.1;
  scene.bodies[1].prescribed = {down};
  return scene;
}

void repeat(Variant& v, std::int64_t steps, int repetition) {
  Simulation& s = *v.simulation;
  if (v.driven) {
    Pose to = s.contact().pose(0, s.time());
    to.position[0] += repetition % 2 == 0 ? 0.01 : -0.01;
    s.tools().drive("rod", to, static_cast<double>(steps) * s.dt());
  }
  const Stopwatch clock;
  s.advance(steps);
  v.seconds.push_back(clock.seconds() / static_cast<double>(steps));
  if (s.divergence()) throw Error(ErrorCode::diverged, s.divergence()->message());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void measure(PartRun& run, const std::string& backend, std::int64_t nodes) {
  const Scene alone = block(nodes);
  const auto n = static_cast<double>(std::lround(std::cbrt(static_cast<double>(nodes))) - 1);
  const double top = n * kCostCell, reach = 0.6 * top;
  Scene far = alone, rests = alone, tissue_on = alone;
  far.tools = {rod(reach, top + 0.3)};
  rests.tools = {rod(reach, top + 2 * kCostCell - 0.2 * kCostCell)};
  tissue_on.contact = TissueContact{};
  const Scene through = halves(nodes);
  Scene pressed = through;
  pressed.contact = TissueContact{0.3};
  Variant all[] = {{nullptr, false, simulate(alone, backend)},
                   {"a tool that stands far away", false, simulate(far, backend)},
                   {"a tool that is driven far away", true, simulate(far, backend)},
                   {"a tool that rests on it", false, simulate(rests, backend)},
                   {"contact of tissue, nothing near", false, simulate(tissue_on, backend)},
                   {nullptr, false, simulate(through, backend)},
                   {"two halves pressed on each other", false, simulate(pressed, backend)}};
  const std::int64_t steps = run.options.quick ? 32 : 128;
  for (Variant& v : all) {
    while (v.simulation->time() < 0.1) repeat(v, steps, 0);  // the first may wait for a compiler, and halves are being pressed
    v.seconds.clear();
  }
  const int repetitions = run.options.quick ? 5 : 7;
  for (int r = 1; r <= repetitions; ++r) {
    for (Variant& v : all) repeat(v, steps, r);
  }
  double without = 0;
  std::string scene;
  for (const Variant& v : all) {
    if (v.words != nullptr) {
      run.told(fmt::format("step over that without contact: {}", v.words), scene, median(v.seconds) / without);
      continue;
    }
    scene = fmt::format("{} nodes, {}", v.simulation->model().nodes(), backend);
    without = median(v.seconds);
    run.told("ms per step without contact", scene, 1e3 * without);
  }
}

}  // namespace

void measure_costs(PartRun& run) {
  std::vector<std::string> backends = run.options.backends;
  if (backends.empty()) {
    backends = {"cpu"};
    const std::vector<BackendInfo> known = list_backends();
    if (std::any_of(known.begin(), known.end(), [](const BackendInfo& b) { return b.name == "opencl:0"; }))
      backends.emplace_back("opencl:0");
  }
  double done = 0;
  for (const std::string& backend : backends) {
    for (const std::int64_t nodes : run.options.sizes) {
      run.show(done++ / static_cast<double>(backends.size() * run.options.sizes.size()),
               fmt::format("{} nodes, {}", nodes, backend));
      measure(run, backend, nodes);
    }
  }
}

}  // namespace pliant::bench::contact
