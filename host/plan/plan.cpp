#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/stopwatch.h"
#include "plan/plan_motion.h"
#include "plan/plan_trial.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using namespace planning;
using Json = nlohmann::ordered_json;

void check(const Scene& scene) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: {}; plan takes one body with a surface that comes to rest", scene.file.string(), what));
  };
  if (scene.bodies.size() != 1) fail(fmt::format("/bodies: {} bodies", scene.bodies.size()));
  if (!scene.bodies[0].has_lattice()) {
    fail(scene.bodies[0].mesh.empty() ? "/bodies/0/thickness: a sheet has no lattice to choose"
                                      : "/bodies/0/mesh: a volume mesh has no lattice to choose");
  }
  if (scene.bodies[0].model.follow.empty() == false) fail("/bodies/0/model/follow: a moving region");
  if (!scene.bodies[0].vessels.empty()) fail("/bodies/0/vessels: the static reference knows no vessels");
  if (scene.bodies[0].membrane) fail("/bodies/0/membrane: the static reference knows no membranes");
  const Vec3d &v = scene.bodies[0].velocity, &w = scene.bodies[0].angular_velocity;
  if (v != Vec3d{} || w != Vec3d{}) fail("/bodies/0: an initial velocity");
}

std::vector<ElementKind> in_order_of_trial() {
  std::vector<ElementKind> kinds(all_elements().begin(), all_elements().end());
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](ElementKind a, ElementKind b) { return element_info(a).trial < element_info(b).trial; });
  return kinds;
}

class Planner {
 public:
  Planner(const Scene& scene, const PlanOptions& options) : scene_(scene), o_(options) {}

  Plan run() {
    check(scene_);
    size_ = size_of(scene_);
    if (moves()) {
      say(fmt::format("reference: {}, up to {} nodes or more, with the tools", to_string(reference_element()),
                      o_.reference_nodes));
      course_ = course_of(scene_);
      reference_ = make_moving_reference(scene_, size_, o_, course_);
    } else {
      say(fmt::format("reference: {}, {} nodes or more, static", to_string(reference_element()), o_.reference_nodes));
      reference_ = make_reference(scene_, size_, o_);
    }
    for (const ElementKind element : in_order_of_trial()) {
      if (element_info(element).averaged && !law_info(scene_.bodies[0].material.law).volumetric) continue;
      climb(element);
    }
    try_hybrids();
    return conclude();
  }

 private:
  void say(const std::string& what) const {
    if (o_.progress) o_.progress(what);
  }

  /// Tools press and slide: there is no rest to compare.
  [[nodiscard]] bool moves() const { return !scene_.tools.empty(); }
  [[nodiscard]] double left() const { return o_.seconds - clock_.seconds(); }

  Trial& measure(Trial trial) {
    say(trial.what);
    try {
      if (!trials_.empty() && left() <= 0) {
        trial.remark = fmt::format("left out: {:.3g} s are over (--seconds)", o_.seconds);
      } else if (moves()) {
        measure_motion(trial, reference_, course_, std::max(1.0, left()), o_);
      } else {
        measure_time(trial, o_);
        if (trial.remark.empty()) measure_error(trial, reference_, o_);
      }
    } catch (const Error& error) {
      trial.remark = error.what();
    }
    trials_.push_back(std::move(trial));
    return trials_.back();
  }

  Trial finite_elements(ElementKind element, std::int64_t nodes) const {
    Trial t;
    t.scene = configured(scene_, size_, element, nodes);
    t.element = to_string(element);
    t.model = "tled";
    t.wanted_nodes = nodes;
    t.what = fmt::format("{}, about {} nodes", t.element, nodes);
    return t;
  }

  /// Finer and finer lattices until the tolerance is met, whatever the budget; then between the last two, where the error is
  /// expected to meet the tolerance.
  void climb(ElementKind element) {
    std::optional<Trial> coarse;
    for (std::int64_t nodes = o_.least_nodes; nodes <= o_.most_nodes; nodes *= 2) {
      if (2 * nodes > reference_.nodes) return;
      Trial trial = finite_elements(element, nodes);
      if (coarse && !worth_trying(*coarse, nodes)) return;
      const Trial now = measure(std::move(trial));
      if (!now.remark.empty()) return;
      if (now.error <= o_.tolerance) {
        if (coarse && now.error < coarse->error) between(element, *coarse, now);
        return;
      }
      coarse = now;
    }
  }

  /// Steps shorten with the spacing and there are more nodes: the time per frame grows at least with the nodes.
  [[nodiscard]] bool worth_trying(const Trial& coarse, std::int64_t nodes) const {
    const double least = coarse.ms_per_frame * static_cast<double>(nodes) / static_cast<double>(coarse.nodes);
    const Trial* const best = cheapest();
    return best == nullptr || least < 1.5 * best->ms_per_frame;
  }

  void between(ElementKind element, const Trial& coarse, const Trial& fine) {
    constexpr double kMargin = 0.85;  // errors of lattices that cut a surface differently scatter
    const double slope =
        std::log(fine.error / coarse.error) / std::log(static_cast<double>(fine.nodes) / static_cast<double>(coarse.nodes));
    const double nodes = static_cast<double>(fine.nodes) * std::pow(kMargin * o_.tolerance / fine.error, 1 / slope);
    if (!(nodes < 0.85 * static_cast<double>(fine.nodes) && nodes > 1.1 * static_cast<double>(coarse.nodes))) return;
    Trial t = finite_elements(element, std::llround(nodes));
    const double share = std::log(nodes / static_cast<double>(coarse.nodes)) /
                         std::log(static_cast<double>(fine.nodes) / static_cast<double>(coarse.nodes));
    t.predicted_error = kMargin * o_.tolerance;
    t.predicted_ms = coarse.ms_per_frame * std::pow(fine.ms_per_frame / coarse.ms_per_frame, share);
    measure(std::move(t));
  }

  /// Hybrids on the lattice of the cheapest usual element of cells that meets the tolerance: fewer finite elements, and
  /// substeps where they pay.
  void try_hybrids() {
    const ElementKind element = usual_element(8);
    const Trial* const base = cheapest(to_string(element));
    if (base == nullptr || !integrator_info(scene_.integrator).matching) return;
    const std::int64_t nodes = base->wanted_nodes;
    struct Choice {
      double ratio;
      int width, substeps;
      double alpha;  ///< 0: the one that has the material's Young's modulus
    };
    bool first = true;
    for (const Choice& c :
         {Choice{0.6, 2, 1, 0}, {0.6, 1, 1, 0}, {0.6, 3, 1, 0}, {0.6, 2, 2, 0}, {0.6, 2, 1, 0.5}, {0.3, 2, 1, 0}}) {
      if (moves() && c.substeps > 1) continue;  // contact needs every step
      Trial t = finite_elements(element, nodes);
      DeformationModel& m = t.scene.bodies[0].model;
      const DeformationModel& own = scene_.bodies[0].model;
      m.type = ModelType::hybrid;
      m.seed = own.seed;
      m.ratio = c.ratio;
      m.width = c.width;
      m.substeps = c.substeps;
      if (c.alpha > 0) {
        m.alpha = c.alpha;
      } else {
        m.young = scene_.bodies[0].material.moduli.young();
      }
      t.model = "hybrid";
      t.what = fmt::format("hybrid of {}, about {} nodes, ratio {}, w {}, {}, substeps {}", to_string(element), nodes, c.ratio,
                           c.width, c.alpha > 0 ? fmt::format("alpha {}", c.alpha) : "stiffness matched", c.substeps);
      const Trial now = measure(std::move(t));
      // Where most of the body is already far off, less of it in finite elements will not do.
      if (first && !(now.error >= 0 && now.error <= 10 * o_.tolerance)) return;
      first = false;
    }
  }

  /// Of those within the tolerance.
  [[nodiscard]] const Trial* cheapest(const std::string& element = "") const {
    const Trial* best = nullptr;
    for (const Trial& t : trials_) {
      if (t.error < 0 || t.error > o_.tolerance || (!element.empty() && t.element != element)) continue;
      if (best == nullptr || t.ms_per_frame < best->ms_per_frame) best = &t;
    }
    return best;
  }

  [[nodiscard]] const Trial* most_exact(double budget) const {
    const Trial* best = nullptr;
    for (const Trial& t : trials_) {
      if (t.error < 0 || t.ms_per_frame > budget) continue;
      if (best == nullptr || t.error < best->error) best = &t;
    }
    return best;
  }

  [[nodiscard]] static Json row(const Trial& t) {
    const DeformationModel& m = t.scene.bodies[0].model;
    const auto known = [](double x) { return x >= 0 ? Json(x) : Json(nullptr); };
    const bool hybrid = m.type == ModelType::hybrid;
    return {{"element", t.element},
            {"model", t.model},
            {"nodes", t.nodes},
            {"spacing", t.spacing},
            {"ratio", hybrid ? Json(m.ratio) : Json(nullptr)},
            {"width", hybrid ? Json(m.width) : Json(nullptr)},
            {"alpha", hybrid && m.young <= 0 ? Json(m.alpha) : Json(nullptr)},
            {"stiffness_young", hybrid && m.young > 0 ? Json(m.young) : Json(nullptr)},
            {"substeps", hybrid ? Json(m.substeps) : Json(nullptr)},
            {"dt", t.dt},
            {"ms_per_step", t.ms_per_step},
            {"ms_per_frame", t.ms_per_frame},
            {"error_l2", known(t.error)},
            {"error_max", known(t.error_max)},
            {"error_force", known(t.error_force)},
            {"predicted_error", known(t.predicted_error)},
            {"predicted_ms", known(t.predicted_ms)},
            {"remark", t.remark}};
  }

  [[nodiscard]] static std::string line(const Trial& t) {
    const std::string error = t.error >= 0 ? fmt::format("{:7.3f} %", 100 * t.error) : "        -";
    const std::string predicted =
        t.predicted_error >= 0 ? fmt::format("  expected {:.3f} % and {:.3g} ms", 100 * t.predicted_error, t.predicted_ms) : "";
    const std::string force = t.error_force >= 0 ? fmt::format(", of forces {:.3g} %", 100 * t.error_force) : "";
    return fmt::format("  {:<72} {:>7} nodes {:>9.4g} ms per frame, error {}{}{}{}{}", t.what, t.nodes, t.ms_per_frame, error,
                       force, predicted, t.remark.empty() ? "" : "  ", t.remark);
  }

  Plan conclude() {
    Plan plan;
    const Trial* const best = cheapest();
    plan.found = best != nullptr && best->ms_per_frame <= o_.budget;
    const Trial* const exact = most_exact(o_.budget);
    const Trial* const any = most_exact(HUGE_VAL);
    if (any == nullptr)
      throw Error(ErrorCode::bad_input, fmt::format("{}: no configuration {}, so none can be planned; the first: {}",
                                                    scene_.file.string(), moves() ? "reached the end" : "came to rest",
                                                    trials_.empty() ? "none was tried" : trials_[0].remark));
    const Trial* const nearest = best != nullptr ? best : any;
    plan.scene = (plan.found ? best : nearest)->scene;
    plan.report = {{"scene", scene_.name},
                   {"tolerance", o_.tolerance},
                   {"budget_ms", o_.budget},
                   {"frame", o_.frame},
                   {"backend", o_.backend},
                   {"compared", moves() ? Json{{"seconds", course_}, {"times", kSamples}} : Json(nullptr)},
                   {"reference",
                    {{"element", to_string(reference_element())},
                     {"nodes", reference_.nodes},
                     {"uncertainty", reference_.uncertainty},
                     {"seconds", reference_.seconds}}},
                   {"found", plan.found},
                   {"choice", plan.found ? row(*best) : Json(nullptr)},
                   {"nearest", Json::array()},
                   {"trials", Json::array()}};
    plan.text = fmt::format("reference: {}, three lattices up to {} nodes, {:.2f} % apart\n", to_string(reference_element()),
                            reference_.nodes, 100 * reference_.uncertainty);
    if (moves()) plan.text += fmt::format("compared at {} times of the first {:.3g} s, with the tools\n", kSamples, course_);
    for (const Trial& t : trials_) {
      plan.report["trials"].push_back(row(t));
      plan.text += line(t) + "\n";
    }
    const std::string wanted = fmt::format("{:.3g} % and {:.3g} ms", 100 * o_.tolerance, o_.budget);
    if (plan.found) {
      plan.text += fmt::format("chosen: {}, the cheapest of those that meet {}", best->what, wanted);
    } else {
      plan.text += fmt::format("nothing tried meets {}; the nearest choices:\n", wanted);
      plan.report["nearest"].push_back(row(*nearest));
      plan.text += fmt::format("  {}:\n{}", best != nullptr ? "cheapest within the tolerance" : "most exact", line(*nearest));
      if (exact != nullptr && exact != nearest) {
        plan.report["nearest"].push_back(row(*exact));
        plan.text += fmt::format("\n  most exact within the budget:\n{}", line(*exact));
      }
    }
    if (reference_.uncertainty > o_.tolerance / 2) {
      plan.text += fmt::format(
          "\nthe reference is known to {:.2g} % only, and so is every error here (--reference takes more nodes); where planes "
          "and spheres select nodes, their selection changes with the lattice",
          100 * reference_.uncertainty);
    }
    return plan;
  }

  const Scene& scene_;
  const PlanOptions& o_;
  const Stopwatch clock_;
  Size size_;
  double course_ = 0;  ///< of a scene with tools [s]
  Reference reference_;
  std::vector<Trial> trials_;
};

}  // namespace

Plan plan_scene(const Scene& scene, const PlanOptions& options) { return Planner(scene, options).run(); }

}  // namespace pliant
