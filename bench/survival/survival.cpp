#include "bench/survival/survival.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "backends/choice/backends.h"
#include "bench/common/shipped_scenes.h"
#include "bench/kernels/kernels.h"
#include "bench/survival/live_tools.h"
#include "geometry/stopwatch.h"
#include "geometry/vec.h"
#include "io/atomic_file.h"
#include "model/pieces.h"
#include "pliant/error.h"
#include "simulation/simulation.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr double kEnd = 2;          // [s]
constexpr double kShortStep = 0.1;  // of the first
constexpr double kEnergy = 0.01;
constexpr double kFrame = 1.0 / 60;  // [s]

/// Largest displacement over the largest extent of the body at rest; not a number if one of them is not.
double largest_displacement(const Simulation& s) {
  double most = 0, extent = 0;
  for (std::size_t b = 0; b < s.model().bodies.size(); ++b) {
    const std::vector<Vec3d>& rest = s.model().bodies[b].rest;
    for (const Vec3d& u : s.displacements(b)) most = std::isfinite(vec::norm(u)) ? std::max(most, vec::norm(u)) : vec::norm(u);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [low, high] =
          std::minmax_element(rest.begin(), rest.end(), [c](const Vec3d& p, const Vec3d& q) { return p[c] < q[c]; });
      extent = std::max(extent, (*high)[c] - (*low)[c]);
    }
  }
  return most / extent;
}

std::int64_t pieces_of(const Simulation& s) {
  std::int64_t pieces = 0;
  for (const ModelBody& body : s.model().bodies) pieces += pieces_of(body);
  return pieces;
}

const char* load_of(const Body& body) {
  if (!body.prescribed.empty()) return body.prescribed[0].rotate ? "twisted" : "moved";
  return body.forces.empty() ? "none" : "force";
}

json describe(const Scene& scene) {
  const Body& body = scene.bodies[0];
  return {{"body", body.name},
          {"element", to_string(body.element)},
          {"model", to_string(body.model.type)},
          {"law", to_string(body.material.law)},
          {"young", body.material.moduli.young()},
          {"poisson", body.material.moduli.poisson()},
          {"damping", body.material.damping},
          {"gravity", vec::norm(scene.gravity)},
          {"blades", scene.blades.size()},
          {"tears", body.material.toughness > 0},
          {"width", body.model.width},
          {"substeps", body.model.substeps > 0 ? json(body.model.substeps) : json("auto")},
          {"load", load_of(body)},
          {"tools", scene.tools.size()},
          {"contact", scene.contact.has_value()},
          {"bodies", scene.bodies.size()}};
}

/// What hands met in a scene.
void add_live(const LiveTools& live, json& row) {
  const LiveFindings& found = live.findings();
  row["live"] = live.count();
  if (live.count() == 0) return;
  row["hand_force"] = found.largest_force;
  row["hand_energy"] = found.least_energy;
  row["hand_buffers"] = found.buffers;
  row["poses_refused"] = found.poses_refused;
  if (row["outcome"] != "ended" || found.fault().empty()) return;
  row["outcome"] = "unsafe";
  row["message"] = found.fault();
}

/// One scene to its end.
json run_one(std::int64_t number, const SurvivalOptions& options) {
  const Scene scene = parse_scene(survival_scene(number, options.scenes), fmt::format("survival-{}.json", number));
  json row = describe(scene);
  row["number"] = number;
  try {
    const Stopwatch building;
    Simulation s(scene, open_backend(options.backend));
    row["nodes"] = s.model().nodes();
    const double first = s.dt(), end = options.quick ? kEnd / 4 : kEnd;
    double least = first;
    const Stopwatch clock;
    double watched = 0;
    LiveTools live(number, s, end);
    while (live.count() > 0 && s.time() + 1.5 * kFrame < end && !s.divergence()) {
      live.frame(s, kFrame);
      least = std::min(least, s.dt());
    }
    while (s.time() < end && !s.divergence()) {
      s.advance(64);
      least = std::min(least, s.dt());
      const Stopwatch watching;
      if (!s.divergence()) s.watch_energy();
      watched += watching.seconds();
    }
    const double wall = clock.seconds() - watched;
    double mass = 0, added = 0;
    for (const ModelBody& b : s.model().bodies) {
      mass += b.mass;
      added += b.added_mass;
    }
    const double largest = largest_displacement(s);
    row["outcome"] = s.divergence() ? "diverged" : std::isfinite(largest) ? "ended" : "not finite";
    row["message"] = s.divergence() ? s.divergence()->message() : "";
    add_live(live, row);
    row["time"] = s.time();
    row["first_dt"] = first;
    row["least_dt"] = least / first;
    row["last_dt"] = s.dt() / first;
    row["mean_dt"] = s.time() / static_cast<double>(std::max<std::int64_t>(1, s.step())) / first;
    row["inverted"] = s.report().inversions.most;
    row["inverted_now"] = s.report().inversions.last;
    row["added_mass"] = added / mass;
    row["opened"] = s.state().opened;
    row["ballast"] = s.report().ballast.most / mass;
    row["largest"] = std::isfinite(largest) ? json(largest) : json();
    row["pieces"] = pieces_of(s);
    row["edits"] = s.topology_version();
    const std::optional<double> created = s.report().energy.share();
    row["energy_created"] = created ? json(*created) : json();
    const std::optional<double> parted = s.report().energy.share_of(s.report().tissue.work);
    row["energy_parted"] = parted ? json(*parted) : json();
    row["ms_per_frame"] = 1e3 * wall / (std::max(s.time(), first) * 60);
  } catch (const Error& error) {
    row["outcome"] = "refused";
    row["message"] = error.what();
  }
  return row;
}

/// Whether the scene has a key or a word that is asked for.
bool is_asked_for(std::int64_t number, const SurvivalOptions& o) {
  if (o.having.empty()) return true;
  const std::string text = survival_scene(number, o.scenes);
  return std::any_of(o.having.begin(), o.having.end(),
                     [&](const std::string& word) { return text.find("\"" + word + "\"") != std::string::npos; });
}

bool is_much(const json& row, const char* energy) {
  return row.contains(energy) && row[energy].is_number() && row[energy] > kEnergy;
}
bool creates_energy(const json& row) { return is_much(row, "energy_created"); }

bool ends_well(const json& row) {
  return row["outcome"] == "ended" && row["least_dt"].get<double>() >= kShortStep && !creates_energy(row);
}

/// Finished scenes: a line each, so that an interrupted call loses at most one.
class Kept {
 public:
  explicit Kept(const SurvivalOptions& o) {
    if (o.out.empty()) return;
    std::filesystem::create_directories(o.out);
    file_ = o.out / (o.quick ? "survival-quick.rows.jsonl" : "survival.rows.jsonl");
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      const json row = json::parse(line, nullptr, false);
      if (row.is_object() && row.contains("number")) rows_[row["number"].get<std::int64_t>()] = row;
    }
  }
  [[nodiscard]] const json* find(std::int64_t number) const {
    const auto found = rows_.find(number);
    return found == rows_.end() ? nullptr : &found->second;
  }
  void add(const json& row) {
    if (!file_.empty()) std::ofstream(file_, std::ios::app) << row.dump() << "\n";
  }

 private:
  std::filesystem::path file_;
  std::map<std::int64_t, json> rows_;
};

json summary_of(const json& rows) {
  std::map<std::string, int> outcomes;
  int short_steps = 0, slow = 0, inverted = 0, left_inverted = 0, created = 0, parted = 0, live = 0;
  for (const json& row : rows) {
    ++outcomes[row["outcome"].get<std::string>()];
    short_steps += row.value("least_dt", 1.0) < kShortStep;
    slow += row.value("mean_dt", 1.0) < kShortStep;
    inverted += row.value("inverted", 0) > 0;
    left_inverted += row.value("inverted_now", 0) > 0;
    created += creates_energy(row);
    parted += is_much(row, "energy_parted");
    live += row.value("live", 0) > 0;
  }
  return {{"scenes", rows.size()},
          {"ended", outcomes["ended"]},
          {"diverged", outcomes["diverged"]},
          {"not_finite", outcomes["not finite"]},
          {"refused", outcomes["refused"]},
          {"live", live},
          {"unsafe", outcomes["unsafe"]},
          {"least_dt_below_a_tenth", short_steps},
          {"mean_dt_below_a_tenth", slow},
          {"inverted", inverted},
          {"left_inverted", left_inverted},
          {"energy_created_above_a_hundredth", created},
          {"energy_parted_above_a_hundredth", parted}};
}

}  // namespace

json bench_survival(const SurvivalOptions& asked) {
  SurvivalOptions options = asked;
  options.scenes = find_shipped_scenes(asked.scenes, "liver.json");
  if (options.quick) options.count = std::min<std::int64_t>(options.count, 50);
  if (options.count < 1 || options.first < 0) {
    throw Error(ErrorCode::bad_input,
                fmt::format("--count is {} and --first {}; at least 1 and 0 are allowed", options.count, options.first));
  }
  Kept kept(options);
  json rows = json::array();
  for (std::int64_t i = 0; i < options.count; ++i) {
    const std::int64_t number = options.first + i;
    if (options.progress) options.progress(double(i) / double(options.count), fmt::format("scene {}", number));
    if (const json* found = kept.find(number)) {
      rows.push_back(*found);
      continue;
    }
    if (!is_asked_for(number, options)) continue;
    // Written first, so that a scene that hangs is there, too.
    const std::filesystem::path file = options.out / fmt::format("survival-{}.json", number);
    if (!options.out.empty()) write_file(file, survival_scene(number, options.scenes));
    rows.push_back(run_one(number, options));
    kept.add(rows.back());
    const json& row = rows.back();
    if (!options.out.empty() && ends_well(row)) std::filesystem::remove(file);
  }
  return {{"machine", machine_facts()}, {"backend", options.backend}, {"summary", summary_of(rows)}, {"rows", rows}};
}

std::string survival_table(const json& result) {
  const json& s = result["summary"];
  std::string text =
      fmt::format("{} of {} scenes ended well; {} diverged, {} were not finite, {} were refused\n", s["ended"].get<int>(),
                  s["scenes"].get<int>(), s["diverged"].get<int>(), s["not_finite"].get<int>(), s["refused"].get<int>());
  text += fmt::format("{} took a step below a tenth of the first, {} on average; {} had inverted elements, {} at the end\n",
                      s["least_dt_below_a_tenth"].get<int>(), s["mean_dt_below_a_tenth"].get<int>(), s["inverted"].get<int>(),
                      s["left_inverted"].get<int>());
  text += fmt::format(
      "{} gained more than a hundredth of their energy beyond the work of tools and blades while all loads were constant\n",
      s["energy_created_above_a_hundredth"].get<int>());
  text += fmt::format("in {} of all, parting tissue that had come inside other tissue put in more than a hundredth\n",
                      s["energy_parted_above_a_hundredth"].get<int>());
  text += fmt::format("{} had tools in hands; in {} of them a force on the hand was not as it must be\n", s["live"].get<int>(),
                      s["unsafe"].get<int>());
  for (const json& row : result["rows"]) {
    if (creates_energy(row)) {
      text += fmt::format("  {:>4} {} {} {}, {} bodies, {} tools{}: gained {:.2g} of its energy\n",
                          row["number"].get<std::int64_t>(), row["body"].get<std::string>(), row["element"].get<std::string>(),
                          row["model"].get<std::string>(), row.value("bodies", 1), row.value("tools", 0),
                          row.value("contact", false) ? ", contact" : "", row["energy_created"].get<double>());
    }
    if (row["outcome"] == "ended") continue;
    text += fmt::format("  {:>4} {} {} {} {}: {}\n", row["number"].get<std::int64_t>(), row["body"].get<std::string>(),
                        row["element"].get<std::string>(), row["model"].get<std::string>(), row["outcome"].get<std::string>(),
                        row["message"].get<std::string>());
  }
  return text;
}

}  // namespace pliant::bench
