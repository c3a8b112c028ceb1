// What a run reports at its end: the JSON object, a summary for people, remarks.
#include "cli/run_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cli/run_events.h"
#include "cli/tool_report.h"
#include "program/hash.h"
#include "scene/blade_face.h"
#include "scene/keys.h"
#include "simulation/measure/run_remarks.h"

namespace pliant::cli {
namespace {

using Json = nlohmann::ordered_json;

double total_mass(const Model& model) {
  double mass = 0;
  for (const ModelBody& body : model.bodies) mass += body.mass;
  return mass;
}

class Report {
 public:
  explicit Report(const FinishedRun& report)
      : r_(report),
        s_(report.simulation),
        out_(report.common),
        result_(report.result),
        events_(run_events(report.simulation)) {}

  void operator()() {
    const std::string hash = hash_text(s_.hash()), deep_hash = hash_text(s_.deep_hash());
    Json json = figures(hash, deep_hash);
    add_events(json);
    add_mass(json);
    add_inversions(json);
    add_tools(s_, json);
    add_blades(s_, json);
    const std::vector<std::string> inside = add_interpenetrations(s_, json);
    if (const auto created = r_.energy.created()) json["contact"]["energy_created"] = *created;
    if (const auto parted = r_.energy.parted()) json["contact"]["energy_parted"] = *parted;
    if (!result_.diverged.empty()) json["diverged_step"] = result_.diverged_step;
    print_summary();
    for (std::size_t t = 0; t < s_.contact().tools().size(); ++t) {
      if (!is_face(s_.contact().tools()[t])) out_.print(tool_line(s_, t));
    }
    for (std::size_t b = 0; b < s_.press().names().size(); ++b) out_.print(blade_line(s_, b));
    if (s_.scene().contact && s_.model().contact != nullptr) out_.print(tissue_line(s_));
    for (const std::string& line : inside) out_.print(line);
    if (r_.live != nullptr) {
      json["instruments"] = r_.live->json();
      for (const std::string& line : r_.live->lines()) out_.print(line);
    }
    for (const std::string& remark : run_remarks(s_)) out_.remark(remark);
    for (const std::string& remark : r_.energy.remarks()) out_.remark(remark);
    if (!r_.probes.empty() || !r_.scene_probes.empty()) {
      json["probes"] = Json::array();
      add_probes(r_.probes, json["probes"]);
      add_probes(r_.scene_probes, json["probes"]);
    }
    if (r_.profile) json["profile"] = profile();
    json["remarks"] = *out_.remarks;
    if (r_.hash && out_.quiet && out_.json != "-") std::puts(hash.c_str());
    out_.print("hash " + hash);
    if (r_.deep_hash) out_.print("deep hash " + deep_hash);
    out_.write(json);
  }

 private:
  [[nodiscard]] std::size_t broken_joins() const {
    std::size_t sum = 0;
    for (const auto& join : s_.state().broken) sum += join.size();
    return sum;
  }
  [[nodiscard]] bool relaxes() const { return s_.scene().relaxation.enabled; }
  [[nodiscard]] double simulated() const { return s_.time() - r_.first_time; }

  [[nodiscard]] Json figures(const std::string& hash, const std::string& deep_hash) const {
    const BackendInfo& info = s_.backend().info();
    Json json{{"scene", r_.stem},
              {"backend", info.name},
              {"device", info.device},
              {"bit_exact", info.bit_exact},
              {"nodes", s_.model().nodes()},
              {"elements", s_.model().elements()},
              {"steps", result_.steps},
              {"dt", s_.dt()},
              {"stable_dt", s_.stable_dt()},
              {"simulated_seconds", simulated()},
              {"ms_per_step", result_.ms_per_step},
              {"hash", hash},
              {"deep_hash", deep_hash},
              {"diverged", !result_.diverged.empty()},
              {"step", s_.step()},
              {"time", s_.time()},
              {"wall_seconds", result_.seconds},
              {"frames", r_.frames != nullptr ? r_.frames->frames() : 0},
              {"interrupted", result_.interrupted},
              {"warnings", r_.warnings}};
    if (relaxes()) {
      json["converged"] = s_.at_equilibrium();
      json["residual"] = s_.residual();
    }
    return json;
  }

  void add_events(Json& json) const {
    json["max_displacement"] = events_.max_displacement;
    json["cut_edges"] = events_.cut_edges;
    json["removed_elements"] = events_.removed_elements;
    json["removed_mass"] = s_.state().remade.mass;
    json["cut_in_part"] = events_.cut_in_part;
    json["broken_faces"] = events_.broken_faces;
    json["pieces"] = events_.pieces;
    json["blades_without_contact"] = blades_without_contact(s_, false);
    json["blades_to_come"] = Json::array();
    for (const Blade* blade : blades_to_come(s_)) {
      json["blades_to_come"].push_back(blade->name);
      out_.remark(fmt::format("blade '{}' has not cut yet: it begins at {:.4g} s, and the run ended at {:.4g} s", blade->name,
                              blade->begins(), s_.time()));
    }
    for (const std::string& name : blades_without_effect(s_)) {
      out_.remark(
          fmt::format("blade '{}' met tissue and divided no edge of an element: its way through it is too short for "
                      "elements of this size, or the tissue had moved away from most of its path",
                      name));
    }
    for (const std::string& sentence : parts_far_away(s_)) out_.remark(sentence);
    std::int32_t substeps = 1;
    for (const FlsmBatch& b : s_.model().flsm) substeps = std::max(substeps, b.settings.substeps);
    json["substeps"] = substeps;
    json["most_substeps"] = s_.state().most_substeps;
    json["opened_edges"] = s_.state().opened;
    if (!s_.scene().joins.empty()) json["broken_joins"] = broken_joins();
  }

  void add_probes(const Probes& probes, Json& rows) const {
    const std::vector<ProbeState> now = probes.states(s_);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const SceneProbe& probe = probes.probe(i);
      const ProbeState& state = now[i];
      Json row{{"name", probe.name}};
      if (probe.between.empty()) row["body"] = s_.model().bodies[probes.body(i)].name;
      if (!probe.between.empty()) row["between"] = probe.between;
      if (probe.point) row["rest"] = *probe.point;
      std::string text;
      for (const Quantity q : probe.quantities) {
        const std::string& word = word_of(quantity_words(), q);
        row[word] = state.numbers(q);
        const auto print = [&](const char* unit) {
          text += fmt::format(", {} [{:.6g}] {}", word, fmt::join(state.numbers(q), ", "), unit);
        };
        switch (q) {
          case Quantity::position:
          case Quantity::velocity:
            break;  // in the table and in the JSON
          case Quantity::displacement:
            print("m");
            break;
          case Quantity::stress:
            print("Pa");
            break;
          case Quantity::green_strain:
          case Quantity::almansi_strain:
            text += fmt::format(", {} [{:.6g}]", word, fmt::join(state.numbers(q), ", "));
            break;
          case Quantity::force:
          case Quantity::reaction:
            print("N");
            break;
          case Quantity::energy:
            row[word] = {{"kinetic", state.energy->kinetic}, {"strain", state.energy->strain}};
            text += fmt::format(", energy {:.6g} J kinetic, {:.6g} J of strain", state.energy->kinetic, state.energy->strain);
            break;
          case Quantity::interpenetration:
            row[word] = interpenetration_json(*state.interpenetration);
            text += fmt::format(", interpenetration {:.6g} m^3, {:.6g} m deep", state.interpenetration->volume,
                                state.interpenetration->depth);
        }
      }
      rows.push_back(std::move(row));
      if (!text.empty()) out_.print(fmt::format("probe {}:{}", probe.name, text.substr(1)));
    }
  }

  void add_mass(Json& json) const {
    const double mass = total_mass(s_.model());
    double added = 0;
    for (const ModelBody& body : s_.model().bodies) added += body.added_mass;
    json["mass"] = mass;
    json["added_mass"] = added;
    const BallastReport& ballast = s_.report().ballast;
    json["ballast"] = {{"nodes", ballast.nodes}, {"mass", ballast.mass}, {"most", ballast.most}};
  }

  void add_inversions(Json& json) const {
    const Inversions& inverted = s_.report().inversions;
    json["inverted"] = {{"batches", inverted.batches}, {"most", inverted.most}, {"now", inverted.last}};
    json["calmed_elements"] = inverted.calmed;
    json["batches_made_again"] = s_.report().made_again;
    if (inverted.batches == 0) return;
    json["inverted"]["first"] = {
        {"step", inverted.first_step}, {"time", inverted.first_time}, {"body", inverted.body}, {"element", inverted.element}};
  }

  void print_summary() const {
    const BackendInfo& info = s_.backend().info();
    out_.print(fmt::format("{}: {} nodes, {} elements on {} ({}), {}", r_.stem, s_.model().nodes(), s_.model().elements(),
                           info.name, info.device, info.bit_exact ? "bit-exact" : "tolerance"));
    out_.print((result_.interrupted ? "interrupted after " : "") + steps_text());
    if (result_.interrupted && !r_.checkpoint.empty()) out_.print(fmt::format("go on with --resume {}", r_.checkpoint));
    if (relaxes()) {
      out_.print(fmt::format("{}: residual {:.3g}, tolerance {:.3g}",
                             s_.at_equilibrium() ? "at equilibrium" : "not at equilibrium", s_.residual(),
                             s_.scene().relaxation.tolerance));
    }
    out_.print(fmt::format("simulated {:.6g} s in {:.3g} s: {:.4g} ms per step (median), {:.3g} times real time", simulated(),
                           result_.seconds, result_.ms_per_step, result_.seconds > 0 ? simulated() / result_.seconds : 0.0));
    if (r_.frames != nullptr) out_.print(fmt::format("{} frames in {}", r_.frames->frames(), r_.frames->folder().string()));
    out_.print(events_text());
  }

  /// A step size that changed is printed as a range, since the last one times the number of steps is not the time.
  [[nodiscard]] std::string steps_text() const {
    const std::string share =
        s_.stable_dt() > 0 ? fmt::format(", {:.3g} of the stable {:.6g} s", s_.dt() / s_.stable_dt(), s_.stable_dt()) : "";
    if (result_.shortest_dt < result_.longest_dt) {
      return fmt::format("{} steps of {:.6g} to {:.6g} s to t = {:.6g} s, the last{}", result_.steps, result_.shortest_dt,
                         result_.longest_dt, s_.time(), share.empty() ? fmt::format(" of {:.6g} s", s_.dt()) : share.substr(1));
    }
    return fmt::format("{} steps of {:.6g} s{}", result_.steps, s_.dt(), share);
  }

  [[nodiscard]] std::string events_text() const {
    std::string text = fmt::format("largest displacement {:.4g} m", events_.max_displacement);
    const bool cuts = !s_.scene().blades.empty() || events_.cut_edges > 0;
    const bool parts = parts_along_faces(s_.scene());
    const bool removes = blade_method(s_.scene()) == BladeMethod::removal;
    if (cuts && removes) text += fmt::format(", {} elements removed", events_.removed_elements);
    if (cuts && !parts && !removes) text += fmt::format(", {} edges cut", events_.cut_edges);
    if (broken_joins() > 0) text += fmt::format(", {} springs of joins broken", broken_joins());
    if (parts || events_.broken_faces > 0)
      text += fmt::format(", {} faces {}", events_.broken_faces, parts ? "opened" : "broken by tears");
    if (cuts || events_.broken_faces > 0)
      text += fmt::format(", {} {}", events_.pieces, events_.pieces == 1 ? "piece" : "pieces");
    if (cuts && events_.cut_in_part > 0) text += fmt::format(", {} elements cut in part and still whole", events_.cut_in_part);
    return text;
  }

  Json profile() const {
    Json rows = Json::array();
    const auto times = s_.backend().take_profile();
    double total = 0;
    for (const PassTime& t : times) total += t.seconds;
    for (const PassTime& t : times) {
      rows.push_back({{"kernel", t.kernel}, {"label", t.label}, {"seconds", t.seconds}, {"launches", t.launches}});
      out_.print(fmt::format("  {:<22} {:<36} {:>8} launches {:>9.3f} us each {:>5.1f} %", t.kernel, t.label, t.launches,
                             1e6 * t.seconds / static_cast<double>(t.launches), total > 0 ? 100 * t.seconds / total : 0));
    }
    return rows;
  }

  const FinishedRun& r_;
  Simulation& s_;
  const Common& out_;
  const RunResult& result_;
  const RunEvents events_;
};

}  // namespace

void report_run(const FinishedRun& report) { Report{report}(); }

}  // namespace pliant::cli
