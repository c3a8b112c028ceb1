// Part strokes: random strokes through running bodies under load, by all methods of a scene's blades; what every edit keeps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "backends/choice/backends.h"
#include "backends/twins/ref_backend.h"
#include "bench/cutting/edit_account.h"
#include "bench/cutting/parts.h"
#include "bench/cutting/stroke_trial.h"
#include "geometry/vec.h"
#include "io/save.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

constexpr double kKept = 1e-12;             ///< what mass and volume may change by, relatively
constexpr double kRounded = 1e-7;           ///< momentum, where an edit changes the step: velocities are rounded to float
constexpr std::int64_t kCompareEvery = 50;  ///< trials that run on both backends, and from a checkpoint

/// The strokes of a trial through one Simulation, which may go on in another one.
class StrokeRun {
 public:
  explicit StrokeRun(const StrokeTrial& trial) : trial_(trial) {}
  [[nodiscard]] bool done() const { return next_ == trial_.places.size(); }
  [[nodiscard]] std::size_t next() const { return next_; }
  /// Steps to where the next place of a blade is due.
  void wait(Simulation& simulation) const { steps(simulation, trial_.places[next_].steps); }
  CutReport move(Simulation& simulation) {
    const BladePlace& place = trial_.places[next_++];
    if (place.first) box_ = box_of_body(simulation);
    const BladePose pose{place.blade, {in_box(place.at[0]), in_box(place.at[1])}};
    return simulation.move_blades(std::span(&pose, 1));
  }
  static void steps(Simulation& simulation, std::int64_t count) {
    const std::int64_t end = simulation.step() + count;
    while (simulation.step() < end && !simulation.divergence()) simulation.advance(end - simulation.step());
  }

 private:
  static vec::Box box_of_body(const Simulation& simulation) {
    vec::Box box;
    const ModelBody& body = simulation.model().bodies[0];
    const std::vector<Vec3d> u = simulation.displacements(0);
    for (std::size_t n = 0; n < u.size(); ++n) box.extend(vec::add(body.rest[n], u[n]));
    return box;
  }
  [[nodiscard]] Vec3d in_box(const Vec3d& share) const {
    Vec3d out{};
    for (std::size_t a = 0; a < 3; ++a) out[a] = box_.lower[a] + share[a] * (box_.upper[a] - box_.lower[a]);
    return out;
  }

  const StrokeTrial& trial_;
  std::size_t next_ = 0;
  vec::Box box_;
};

std::unique_ptr<Backend> one_thread() {
  RefOptions one;
  one.threads = 1;
  one.probe = false;
  return make_ref_backend(one);
}

/// What all trials of a method and an element have shown.
struct StrokeFindings {
  std::int64_t trials = 0, strokes = 0, edits = 0, elements_before = 0, elements_after = 0, most_pieces = 0;
  std::int64_t open_edits = 0, inverted = 0, new_elements = 0, strays = 0, lost = 0;
  std::int64_t compared = 0, differing = 0, resumed = 0, resumed_differing = 0;
  double mass = 0, volume = 0, momentum = 0, gain = 0, loss = 0, strain = 0, dt_ratio = 1, piece_share = 0, piece_cells = 0;
  std::int64_t worst_piece = -1, worst_energy = -1;
  std::optional<BodyFigures> before;
  std::vector<std::string> faults;

  void fault(std::int64_t trial, std::size_t place, const std::string& what) {
    faults.push_back(fmt::format("trial {}, place {}: {}", trial, place, what));
  }
};

class StrokeBench {
 public:
  StrokeBench(const CuttingRun& run, const StrokeKind& kind) : run_(run), kind_(kind) {}

  json row() {
    const std::int64_t wanted = run_.options.cuts;
    for (std::int64_t number = std::max<std::int64_t>(run_.options.trial, 0); found_.strokes < wanted; ++number) {
      measure(draw_stroke_trial(number, kind_));
      if (run_.options.trial >= 0) break;
      run_.show_progress(first_ + share_ * static_cast<double>(found_.strokes) / static_cast<double>(wanted), name());
    }
    return as_row();
  }
  void begins_at(double first, double share) {
    first_ = first;
    share_ = share;
  }

 private:
  [[nodiscard]] bool separates() const { return kind_.method == BladeMethod::separation; }
  [[nodiscard]] bool removes() const { return kind_.method == BladeMethod::removal; }
  [[nodiscard]] std::string name() const { return fmt::format("{}, {}", method_name(kind_.method), to_string(kind_.element)); }

  void measure(const StrokeTrial& trial) {
    const auto model = std::make_shared<const Model>(build_model(trial.scene));
    Simulation simulation(trial.scene, model, one_thread());
    StrokeRun run(trial);
    const BodyFigures start = figures_of(*model);
    if (!found_.before) found_.before = start;
    ++found_.trials;
    found_.strokes += trial.strokes;
    found_.elements_before += start.elements;
    while (!run.done() && !simulation.divergence()) {
      run.wait(simulation);
      edit(trial, run, simulation);
    }
    StrokeRun::steps(simulation, trial.steps_after);
    found_.elements_after += simulation.model().elements();
    if (simulation.divergence() || !edit_figures(simulation).finite) {
      ++found_.lost;
      found_.fault(trial.number, run.next(), "the motion is lost");
    }
    if (trial.number % kCompareEvery == 0 || run_.options.trial >= 0) {
      compare(trial, model, simulation.hash());
      resume(trial, model, simulation.deep_hash());
    }
  }

  void edit(const StrokeTrial& trial, StrokeRun& run, Simulation& simulation) {
    const EditFigures before = edit_figures(simulation);
    const std::size_t place = run.next();
    const CutReport report = run.move(simulation);
    if (!report.changed) return;
    ++found_.edits;
    const EditFigures now = edit_figures(simulation);
    const auto fault = [&](const std::string& what) { found_.fault(trial.number, place, what); };
    const auto kept = [&](const char* what, double error, double& worst, double most = kKept) {
      worst = std::max(worst, error);
      if (error > most) fault(fmt::format("{} changes by {:.2g}", what, error));
    };
    if (now.open_edges > before.open_edges) {
      ++found_.open_edits;
      fault(fmt::format("{} edges of the surface are open, {} before", now.open_edges, before.open_edges));
    }
    kept("mass", std::abs((now.mass + report.mass_lost) / before.mass - 1), found_.mass);
    if (!removes()) kept("volume", std::abs(now.volume / before.volume - 1), found_.volume);
    if (before.motion > 0 && is_free(trial) && !removes()) {
      kept("momentum", vec::norm(vec::sub(now.momentum, before.momentum)) / before.motion, found_.momentum, kRounded);
    }
    const bool more = separates() && now.elements != before.elements;
    if (more) fault(fmt::format("{} elements, {} before", now.elements, before.elements));
    found_.new_elements += now.elements - before.elements;
    look_at_elements(trial.number, before, now, fault);
    if (!trial.box) return;
    const PieceFigures pieces = piece_figures(simulation.model(), density(trial), cell_volume(trial));
    found_.most_pieces = std::max(found_.most_pieces, pieces.pieces);
    found_.strays += pieces.strays;
    if (pieces.strays > 0) fault(fmt::format("{} triangles of the surface span two pieces", pieces.strays));
    found_.piece_cells = std::max(found_.piece_cells, pieces.cells);
    if (pieces.share <= found_.piece_share) return;
    found_.piece_share = pieces.share;
    found_.worst_piece = trial.number;
  }

  template <class Fault>
  void look_at_elements(std::int64_t trial, const EditFigures& before, const EditFigures& now, const Fault& fault) {
    const auto fresh = std::count_if(now.inverted.begin(), now.inverted.end(),
                                     [&](const auto& place) { return !lies_in(place, before.inverted); });
    found_.inverted += fresh;
    if (fresh > 0) fault(fmt::format("{} elements are inverted that were not", fresh));
    found_.dt_ratio = std::min(found_.dt_ratio, now.bound / before.bound);
    if (!std::isfinite(before.energy + now.energy) || !(before.energy > 1e-12)) return;
    const double change = now.energy / before.energy - 1;
    if (change > found_.gain) found_.worst_energy = trial;
    found_.gain = std::max(found_.gain, change);
    found_.loss = std::max(found_.loss, -change);
    found_.strain = std::max(found_.strain, change - (now.kinetic - before.kinetic) / before.energy);
  }

  /// Nodes of copies that only held nodes go with stop, which takes momentum to where the body is held.
  static bool is_free(const StrokeTrial& trial) {
    return trial.scene.bodies[0].fixed.empty() && trial.scene.bodies[0].prescribed.empty();
  }
  static double density(const StrokeTrial& trial) { return trial.scene.bodies[0].material.density; }
  static double cell_volume(const StrokeTrial& trial) { return std::pow(trial.scene.bodies[0].lattice.spacing, 3); }

  /// The same trial on the backends that scenes run on.
  void compare(const StrokeTrial& trial, const std::shared_ptr<const Model>& model, std::uint64_t hash) {
    for (const char* spec : {"cpu", "opencl"}) {
      std::unique_ptr<Backend> backend;
      try {
        backend = open_backend(spec, nullptr, model->nodes());
      } catch (const Error&) {
        continue;  // this machine has none
      }
      Simulation simulation(trial.scene, model, std::move(backend));
      run_through(simulation, StrokeRun(trial), trial.places.size());
      StrokeRun::steps(simulation, trial.steps_after);
      ++found_.compared;
      if (simulation.hash() == hash) continue;
      ++found_.differing;
      found_.fault(trial.number, trial.places.size(), fmt::format("{} ends in another state", spec));
    }
  }

  static StrokeRun run_through(Simulation& simulation, StrokeRun run, std::size_t end) {
    while (run.next() < end && !simulation.divergence()) {
      run.wait(simulation);
      run.move(simulation);
    }
    return run;
  }

  /// The same trial from a checkpoint in the middle of a stroke.
  void resume(const StrokeTrial& trial, const std::shared_ptr<const Model>& model, std::uint64_t hash) {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("pliant-strokes-{:08x}", std::random_device{}());
    Simulation first(trial.scene, model, one_thread());
    const StrokeRun half = run_through(first, StrokeRun(trial), trial.places.size() / 2);
    write_checkpoint(file, take_checkpoint(first));
    Simulation second(trial.scene, model, one_thread());
    restore_checkpoint(second, read_checkpoint(file), file);
    std::filesystem::remove(file);
    run_through(second, half, trial.places.size());
    StrokeRun::steps(second, trial.steps_after);
    ++found_.resumed;
    if (second.deep_hash() == hash) return;
    ++found_.resumed_differing;
    found_.fault(trial.number, trial.places.size() / 2, "resumed there, it ends in another state");
  }

  json as_row() {
    BodyFigures before = found_.before.value_or(BodyFigures{}), after = before;
    after.elements = found_.elements_after;
    before.elements = found_.elements_before;
    after.dt = before.dt * found_.dt_ratio;
    after.closed = found_.open_edits == 0;
    json row = cutting_row("strokes", "blocks and the liver", method_name(kind_.method), to_string(kind_.element),
                           found_.strokes, before, after, {});
    row["mass_error"] = found_.mass;
    row["volume_error"] = found_.volume;
    row["trials"] = found_.trials;
    row["edits"] = found_.edits;
    row["pieces"] = found_.most_pieces;
    row["open_edits"] = found_.open_edits;
    row["inverted"] = found_.inverted;
    row["elements_new"] = kind_.method == BladeMethod::virtual_nodes ? json() : json(found_.new_elements);
    row["stray_triangles"] = found_.strays;
    row["lost"] = found_.lost;
    row["momentum_error"] = found_.momentum;
    row["energy_gain"] = found_.gain;
    row["strain_gain"] = found_.strain;
    row["energy_loss"] = found_.loss;
    row["piece_error"] = found_.piece_share;
    row["piece_error_cells"] = found_.piece_cells;
    row["worst_trial"] = found_.worst_piece;
    row["energy_trial"] = found_.worst_energy;
    row["compared"] = found_.compared;
    row["differing"] = found_.differing;
    row["resumed"] = found_.resumed;
    row["resumed_differing"] = found_.resumed_differing;
    row["faults"] = found_.faults;
    return row;
  }

  const CuttingRun& run_;
  StrokeKind kind_;
  StrokeFindings found_;
  double first_ = 0, share_ = 0;
};

}  // namespace

void measure_strokes(const CuttingRun& run) {
  const Scene organ = load_scene(run.options.scenes / "cut_liver.json");
  double first = 0;
  constexpr double kShare = 1.0 / 7;
  for (const BladeMethod method :
       {BladeMethod::virtual_nodes, BladeMethod::separation, BladeMethod::decomposition, BladeMethod::removal}) {
    for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
      if (method == BladeMethod::decomposition && element_info(element).corners != 4) continue;
      StrokeBench bench(run, {method, element, organ});
      bench.begins_at(first, kShare);
      run.rows.push_back(bench.row());
      first += kShare;
    }
  }
}

}  // namespace pliant::bench
