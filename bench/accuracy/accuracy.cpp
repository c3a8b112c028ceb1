#include "bench/accuracy/accuracy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>

#include "backends/choice/backends.h"
#include "bench/accuracy/parts.h"
#include "bench/kernels/kernels.h"
#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace {

using namespace accuracy;
namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kSuite = 1;  ///< counts up when a kept point would no longer be what is measured now

constexpr double kNoisy = 0.15;  ///< a spread of times above this is worth another try

template <class Named>
void keep_only(const char* option, const std::vector<std::string>& wanted, std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& n : all) names.push_back(n.name);
  for (const std::string& word : wanted) {
    if (std::find(names.begin(), names.end(), word) == names.end())
      throw Error(ErrorCode::bad_input, fmt::format("{}: got \"{}\", expected {}", option, word, fmt::join(names, ", ")));
  }
  if (wanted.empty()) return;
  std::erase_if(all, [&](const Named& n) { return std::find(wanted.begin(), wanted.end(), n.name) == wanted.end(); });
}

/// The folder with the shipped scenes: here, or beside the program where it was built or installed.
fs::path find_scenes(const fs::path& asked) {
  const auto file = [](const fs::path& folder) { return folder / "meshes" / "liver.obj"; };
  std::error_code ignored;
  if (!asked.empty()) {
    if (!fs::exists(file(asked), ignored))
      throw Error(ErrorCode::bad_input, fmt::format("--scenes: folder \"{}\" holds no meshes/liver.obj", asked.string()));
    return asked;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {fs::path("scenes"), program / "scenes", program / "../scenes", program / "../../scenes",
                                 program / "../share/pliant/scenes"}) {
    if (fs::exists(file(folder), ignored)) return folder;
  }
  throw Error(ErrorCode::bad_input,
              "--scenes: the shipped scenes are neither in ./scenes nor near the program; name their folder");
}

/// Finished points and references in the output folder.
class Kept {
 public:
  explicit Kept(const AccuracyOptions& o) {
    if (o.out.empty()) return;
    file_ = o.out / (o.quick ? "accuracy-quick.points.json" : "accuracy.points.json");
    data_ = {{"suite", kSuite}, {"cpu", machine_facts()["cpu"]}, {"references", json::object()}, {"points", json::object()}};
    if (o.again || !fs::exists(file_)) return;
    std::ifstream in(file_);
    json old = json::parse(in, nullptr, false);
    if (!old.is_object() || !old.contains("points") || !old.contains("references"))
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: is not a file of finished points; remove it or use --again", file_.string()));
    if (old["suite"] != data_["suite"] || old["cpu"] != data_["cpu"]) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: was made by suite {} on {}, this is suite {} on {}; use --again or another folder",
                              file_.string(), old["suite"].dump(), old["cpu"].dump(), kSuite, data_["cpu"].dump()));
    }
    data_ = old;
    found_ = data_["points"].size();
  }
  ~Kept() {
    try {
      write();
    } catch (const std::exception&) {  // the destructor runs when another error is on its way
    }
  }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

  [[nodiscard]] const json* find(const char* kind, const std::string& key) const {
    if (file_.empty() || !data_[kind].contains(key)) return nullptr;
    return &data_[kind][key];
  }
  void add(const char* kind, const std::string& key, const json& value) {
    if (file_.empty()) return;
    data_[kind][key] = value;
    changed_ = true;
    const auto now = std::chrono::steady_clock::now();
    if (now - written_ > std::chrono::seconds(1)) write();
  }
  [[nodiscard]] std::size_t found() const { return found_; }
  [[nodiscard]] const fs::path& file() const { return file_; }
  void write() {
    if (file_.empty() || !changed_) return;
    write_file(file_, data_.dump() + "\n");
    changed_ = false;
    written_ = std::chrono::steady_clock::now();
  }

 private:
  fs::path file_;
  json data_;
  std::size_t found_ = 0;
  bool changed_ = false;
  std::chrono::steady_clock::time_point written_{};
};

Reference reference_of(const Problem& p, const fs::path& scenes, Kept& kept) {
  if (const json* old = kept.find("references", p.name)) {
    return {(*old)["u"].get<std::vector<Vec3d>>(), (*old)["text"], (*old)["error"], (*old)["nodes"], (*old)["seconds"]};
  }
  const Reference r = make_reference(p, scenes);
  if (!p.exact) {
    kept.add("references", p.name,
             {{"u", r.u}, {"text", r.text}, {"error", r.error}, {"nodes", r.nodes}, {"seconds", r.seconds}});
  }
  return r;
}

/// A kept point, or one that is measured now.
json point_of(const Case& c, const Reference& reference, const AccuracyOptions& o, const fs::path& scenes, Kept& kept) {
  const auto spread = [](const json& row) { return row["spread"].is_null() ? 0.0 : row["spread"].get<double>(); };
  const json* found = kept.find("points", c.key());
  if (found != nullptr && !(o.noisy && spread(*found) > kNoisy)) return *found;
  const json row = measure(c, reference, scenes, o.quick);
  if (found != nullptr) {
    const json old = *found;
    if (old["error_l2"] != row["error_l2"] || old["error_max"] != row["error_max"]) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("accuracy: {}: the error was {} and is now {}; the kept points are of another version, use --again",
                      c.text(), old["error_l2"].dump(), row["error_l2"].dump()));
    }
    if (spread(old) <= spread(row)) return old;
  }
  kept.add("points", c.key(), row);
  return row;
}

/// Every resolution at nine tenths of the stable step, shape matching also at the step of a screen; at the second resolution
/// half the step and the other backends too (quick: the other backends at the first one).
std::vector<Case> cases_of(const Problem& p, const std::vector<Method>& methods, const AccuracyOptions& o) {
  std::vector<Case> all;
  for (const Method& m : methods) {
    const bool matching = m.type == ModelType::flsm;
    for (const int refine : p.refine) {
      const bool second = refine == p.refine[o.quick ? 0 : 1];
      all.push_back({&p, &m, refine, "0.9", o.backends[0]});
      if (matching) all.push_back({&p, &m, refine, "1/60", o.backends[0]});
      if (!second) continue;
      if (!o.quick) all.push_back({&p, &m, refine, "0.45", o.backends[0]});
      for (std::size_t b = 1; b < o.backends.size(); ++b) all.push_back({&p, &m, refine, "0.9", o.backends[b]});
    }
  }
  return all;
}

AccuracyOptions completed(AccuracyOptions o) {
  if (o.backends.empty()) o.backends = {"auto"};
  for (const std::string& b : o.backends) open_backend(b);  // a message now, not after minutes
  if (!o.out.empty()) fs::create_directories(o.out);
  return o;
}

/// What the front says about each method.
json findings_of(const json& rows, const std::vector<Method>& methods) {
  json findings = json::array();
  for (const Method& m : methods) {
    std::vector<std::string> where;
    for (const json& r : rows) {
      if (r["method"] != m.name || !r["pareto"].get<bool>()) continue;
      if (where.empty() || where.back() != r["problem"]) where.push_back(r["problem"]);
    }
    findings.push_back({{"method", m.name}, {"on_front", where}});
  }
  return findings;
}

}  // namespace

json bench_accuracy(const AccuracyOptions& asked) {
  const AccuracyOptions o = completed(asked);
  const fs::path scenes = find_scenes(o.scenes);
  std::vector<Problem> all = problems(scenes, o.quick);
  std::vector<Method> by = methods(o.quick);
  keep_only("--problems", o.problems, all);
  keep_only("--methods", o.methods, by);
  Kept kept(o);
  if (kept.found() > 0 && o.note)
    o.note(fmt::format("{} finished points are in {} and are not measured again", kept.found(), kept.file().string()));
  json result;
  result["machine"] = machine_and_backends();
  result["quick"] = o.quick;
  result["problems"] = json::array();
  result["rows"] = json::array();
  double total = 0, done = 0;
  for (const Problem& p : all) total += static_cast<double>(cases_of(p, by, o).size() + 1);
  for (const Problem& p : all) {
    if (o.progress) o.progress(done++ / total, p.name + ": reference");
    const Reference reference = reference_of(p, scenes, kept);
    result["problems"].push_back({{"name", p.name},
                                  {"title", p.title},
                                  {"lead", p.lead},
                                  {"young", p.young},
                                  {"poisson", p.poisson},
                                  {"size", p.size},
                                  {"characteristic", p.characteristic},
                                  {"samples", p.samples.size()},
                                  {"reference", reference.text},
                                  {"reference_error", reference.error},
                                  {"reference_nodes", reference.nodes},
                                  {"reference_seconds", reference.seconds},
                                  {"floor", std::max(reference.error, 2e-5)}});
    for (const Case& c : cases_of(p, by, o)) {
      if (o.progress) o.progress(done++ / total, c.text());
      result["rows"].push_back(point_of(c, reference, o, scenes, kept));
    }
  }
  kept.write();
  add_order(result["rows"], result["problems"]);
  add_pareto(result["rows"], result["problems"]);
  result["findings"] = findings_of(result["rows"], by);
  if (o.progress) o.progress(1, "done");
  return result;
}

}  // namespace pliant::bench
