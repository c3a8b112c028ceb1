#include "bench/cutting/cutting.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "backends/choice/backends.h"
#include "backends/interface/timing.h"
#include "bench/common/shipped_scenes.h"
#include "bench/cutting/parts.h"
#include "bench/deformation/parts.h"
#include "bench/kernels/kernels.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

const std::vector<std::string> kParts{"scenes", "methods", "live", "steps", "strokes"};

CuttingOptions completed(CuttingOptions o) {
  if (o.parts.empty()) o.parts = kParts;
  for (const std::string& part : o.parts) {
    if (std::find(kParts.begin(), kParts.end(), part) == kParts.end()) {
      throw Error(ErrorCode::bad_input, fmt::format("--parts: got \"{}\", expected {}", part, fmt::join(kParts, ", ")));
    }
  }
  if (o.cuts < 0 || o.cuts > 10'000'000)
    throw Error(ErrorCode::bad_input, fmt::format("--cuts: got {}, expected 1 to 10000000", o.cuts));
  if (o.trial < -1 || o.trial > 10'000'000)
    throw Error(ErrorCode::bad_input, fmt::format("--trial: got {}, expected 0 to 10000000", o.trial));
  o.scenes = find_shipped_scenes(o.scenes, "cut_liver.json");
  return o;
}

std::int64_t usual_cuts(const std::string& part, bool quick) {
  if (part == "strokes") return quick ? 20 : 1000;
  return quick ? 200 : 10'000;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

}  // namespace

BodyFigures figures_of(const Model& model) {
  BodyFigures f;
  f.elements = model.elements();
  f.nodes = model.nodes();
  for (const ModelBody& body : model.bodies) f.mass += body.mass;
  f.volume = signed_volume({model.surface.rest, model.surface.triangles});
  f.dt = model.element_bound;
  f.closed = singular_edges(model.surface.triangles) == 0;
  return f;
}

json cutting_row(const std::string& part, const std::string& scene, const std::string& method, const std::string& element,
                 std::int64_t cuts, const BodyFigures& before, const BodyFigures& after, const std::vector<CutTimes>& times) {
  const auto ms = [&](double (*stage)(const CutTimes&)) {
    std::vector<double> all;
    for (const CutTimes& t : times) all.push_back(1e3 * stage(t));
    return times.empty() ? json() : json(median(all));
  };
  return {{"part", part},
          {"scene", scene},
          {"method", method},
          {"element", element},
          {"cuts", cuts},
          {"ms_per_cut", ms([](const CutTimes& t) { return t.total(); })},
          {"ms_search", ms([](const CutTimes& t) { return t.search; })},
          {"ms_topology", ms([](const CutTimes& t) { return t.topology; })},
          {"ms_surface", ms([](const CutTimes& t) { return t.surface; })},
          {"ms_model", ms([](const CutTimes& t) { return t.model; })},
          {"ms_upload", ms([](const CutTimes& t) { return t.upload; })},
          {"ms_step", ms([](const CutTimes& t) { return t.step; })},
          {"mass_error", (after.mass - before.mass) / before.mass},
          {"volume_error", (after.volume - before.volume) / before.volume},
          {"dt_before", before.dt},
          {"dt_after", after.dt},
          {"closed", after.closed},
          {"elements_before", before.elements},
          {"elements_after", after.elements},
          {"nodes_before", before.nodes},
          {"nodes_after", after.nodes},
          {"ms_per_step_before", nullptr},
          {"ms_per_step_after", nullptr}};
}

std::string method_name(BladeMethod method) {
  return method == BladeMethod::virtual_nodes ? "virtual nodes" : word_of(blade_method_words(), method);
}

double ms_per_step(Simulation& simulation, bool quick) { return 1e3 * time_steps(simulation, quick).median; }

std::vector<SweepTriangle> plane_sweep(const Vec3d& point, const Vec3d& normal, double reach) {
  const Vec3d helper = std::abs(normal[0]) < 0.6 * vec::norm(normal) ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  Vec3d u = vec::cross(normal, helper);
  u = vec::mul(u, reach / vec::norm(u));
  Vec3d v = vec::cross(normal, u);
  v = vec::mul(v, reach / vec::norm(v));
  return sweep({vec::add(vec::sub(point, u), v), vec::sub(vec::sub(point, u), v)},
               {vec::add(vec::add(point, u), v), vec::sub(vec::add(point, u), v)});
}

std::vector<SweepTriangle> wavy_sweep(const Vec3d& point, double reach, double swing) {
  std::vector<SweepTriangle> all;
  constexpr int kPlaces = 24;
  const auto place = [&](int k) {
    const double y = reach * (2.0 * k / kPlaces - 1);
    const double x = point[0] + swing * std::sin(2 * std::numbers::pi * y / reach);
    return BladeSegment{Vec3d{x, point[1] + y, point[2] - reach}, Vec3d{x, point[1] + y, point[2] + reach}};
  };
  for (int k = 0; k < kPlaces; ++k) {
    const auto part = sweep(place(k), place(k + 1));
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

json bench_cutting(const CuttingOptions& asked) {
  const CuttingOptions options = completed(asked);
  json result;
  result["machine"] = machine_and_backends();
  result["rows"] = json::array();
  double done = 0;
  const double total = static_cast<double>(options.parts.size());
  for (const std::string& part : options.parts) {
    const auto progress = [&](double share, const std::string& what) {
      if (options.progress) options.progress((done + share) / total, part + ": " + what);
    };
    CuttingRun run{options, result["rows"], [&](const std::string& what) { progress(0, what); }, progress};
    if (options.cuts == 0) run.options.cuts = usual_cuts(part, options.quick);
    if (part == "scenes") measure_cut_scenes(run);
    if (part == "methods") measure_cut_methods(run);
    if (part == "live") measure_live_methods(run);
    if (part == "steps") measure_stable_steps(run);
    if (part == "strokes") measure_strokes(run);
    ++done;
  }
  if (options.progress) options.progress(1, "done");
  return result;
}

}  // namespace pliant::bench
