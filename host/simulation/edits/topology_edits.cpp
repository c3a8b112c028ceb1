#include "simulation/edits/topology_edits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "schedule/build_program.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/edits/model_swap.h"

namespace pliant {
namespace {

constexpr double kDrivenSpeed = 0.1;        ///< of a blade that waits for the host, by which its updates are counted [m/s]
constexpr double kLongestBatch = 1.0 / 60;  ///< maximum interval of the blade updates [s]

void check_blade(const Blade& blade) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_input, fmt::format("blade '{}': {}", blade.name, what));
  };
  if (blade.path.size() < (blade.cuts == BladeCuts::by_force ? 1U : 2U))
    fail(
        fmt::format("got a path of {} rows; allowed are two or more, or one of a blade that cuts by force", blade.path.size()));
  for (std::size_t i = 0; i < blade.path.size(); ++i) {
    const auto& row = blade.path[i];
    const bool finite = std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
    if (!finite) fail(fmt::format("got [{}] in row {} of the path; allowed are finite numbers", fmt::join(row, ", "), i));
    if (Vec3d{row[1], row[2], row[3]} == Vec3d{row[4], row[5], row[6]}) {
      fail(fmt::format("both ends are [{}] m in row {} of the path; allowed are two different points",
                       fmt::join(row.begin() + 1, row.begin() + 4, ", "), i));
    }
    if (i > 0 && !(row[0] > blade.path[i - 1][0])) {
      fail(fmt::format("got {} s after {} s in row {} of the path; allowed are ascending times", row[0], blade.path[i - 1][0],
                       i));
    }
  }
}

/// Returns true if a blade's trace, which may come from a checkpoint, is valid for this body.
bool belongs(const BladeTrace& front, const CutMesh& mesh) {
  if (front.levels < 0 || front.levels > kMostLevels) return false;
  std::int64_t place = -1;
  for (const TracePoint& p : front.points) {
    const bool carried = p.carried.cell >= 0;
    if (p.place <= place || p.place > (std::int64_t{1} << front.levels) || p.place > front.points[0].place + (1 << 17) ||
        p.node < -1 || p.node >= static_cast<std::int64_t>(mesh.rest.size()) || carried == (p.node >= 0) ||
        p.carried.cell < -1 || p.carried.cell >= static_cast<std::int64_t>(mesh.cells.size()) || p.carried.tet < 0 ||
        p.carried.tet >= static_cast<std::int64_t>(mesh.shape->tets.size())) {
      return false;
    }
    place = p.place;
  }
  return true;
}

/// The same for a sample of the edge of a blade that cuts by force.
bool belongs(const FrontSample& s, EditedBodies& all) {
  if (s.kind < 0 || s.kind > static_cast<std::int32_t>(FrontKind::beside)) return false;
  if (s.kind == static_cast<std::int32_t>(FrontKind::none)) return true;
  if (s.body < 0 || static_cast<std::size_t>(s.body) >= all.size()) return false;
  const auto b = static_cast<std::size_t>(s.body);
  if (!all.meets_blades(b)) return false;
  for (const double w : s.point.weight) {
    if (!std::isfinite(w)) return false;
  }
  if (!std::isfinite(s.advance + s.depth + s.zeta + s.limit)) return false;
  const CutMesh& mesh = all.topology(b).mesh();
  return s.point.cell >= 0 && s.point.cell < static_cast<std::int64_t>(mesh.cells.size()) && s.point.tet >= 0 &&
         s.point.tet < static_cast<std::int64_t>(mesh.shape->tets.size());
}

/// Interval of the blade updates [s]: the front of a blade that cuts by force stays within a small part of a cell of it.
double update_interval(const Scene& scene, double edge) {
  constexpr double kLag = 0.1;  // of an edge
  double longest = kLongestBatch;
  for (const Blade& blade : scene.blades) {
    if (blade.cuts != BladeCuts::by_force) continue;
    const double speed = blade.stands() ? kDrivenSpeed : top_speed(blade);
    if (speed > 0) longest = std::min(longest, kLag * edge / speed);
  }
  return longest;
}

bool follows(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.model.follow.empty(); });
}

}  // namespace

void TopologyEdits::start() {
  const Scene& scene = run_.scene;
  strokes_.start(run_.model());
  run_.settings.breaks = std::any_of(scene.joins.begin(), scene.joins.end(),
                                     [](const Join& j) { return j.break_stretch > 0 || j.break_force > 0; });
  const bool moves_freely = integrator_info(scene.integrator).edits && !scene.relaxation.enabled;
  if (!scene.blades.empty()) {
    for (const Blade& blade : scene.blades) check_blade(blade);
    prepare_cuts();
    const double steps = update_interval(scene, run_.settings.blade_edge) / run_.state.clock.dt;
    run_.settings.blade_steps =
        steps < 1 ? 1 : static_cast<std::int64_t>(std::min(steps, static_cast<double>(run_.settings.batch_steps)));
  }
  const bool parts = parts_along_faces(scene);
  if (parts) run_.settings.tears = true;  // along overstretched edges at least
  if (!EditedBodies::tears(scene)) return;
  if (!moves_freely || (!scene.blades.empty() && !parts)) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("a scene with another integrator than {}, with relaxation or with blades that do not separate cannot tear: "
                    "no material may have a toughness",
                    integrators_with(&IntegratorInfo::edits)));
  }
  static_cast<void>(bodies());
  run_.settings.tears = true;
}

void TopologyEdits::update() {
  known_u_.clear();
  if (under_way_ == nullptr && check_after_ && run_.reached(*check_after_)) check_step();
  using Update = void (TopologyEdits::*)();
  static constexpr Update updates[] = {&TopologyEdits::move_scene_blades,  &TopologyEdits::move_fronts,
                                       &TopologyEdits::open_overstretched, &TopologyEdits::make_tears,
                                       &TopologyEdits::break_joins,        &TopologyEdits::move_regions};
  for (const Update next : updates) {
    if (under_way_ != nullptr) break;  // one edit at a time; what is due is made up for afterwards
    (this->*next)();
  }
  known_u_.clear();
}

void TopologyEdits::build_beside(bool beside) {
  const bool waits = run_.settings.tears || run_.settings.breaks || run_.settings.force_blades > 0;
  beside_ = beside && !waits;
}

void TopologyEdits::perform(ModelEdit edit, std::vector<double> u, CutReport& report) {
  auto work = std::make_unique<EditUnderWay>(run_, loads_, bodies(), std::move(edit), report);
  if (beside_) {
    if (under_way_ != nullptr) throw Error(ErrorCode::internal, "an edit began while another was under way");
    report.pending = true;
    if (builder_ == nullptr) builder_ = std::make_unique<HelperThread>();
    under_way_ = std::move(work);
    return under_way_->build_beside(*builder_);
  }
  try {
    work->build();
  } catch (...) {
    work->give_up();
    throw;
  }
  work->load(std::move(u));
  report = work->report();
}

std::optional<CutReport> TopologyEdits::load_built(bool wait) {
  if (under_way_ == nullptr || run_.phase() != 0 || !(wait || under_way_->built())) return {};
  const std::unique_ptr<EditUnderWay> work = std::move(under_way_);
  work->load(run_.u());
  return work->report();
}

std::optional<CutReport> TopologyEdits::take_built(bool wait) {
  std::optional<CutReport> report;
  if (settled_.empty()) {
    report = load_built(wait);
  } else {
    const Settled first = settled_.front();
    settled_.erase(settled_.begin());
    if (first.error != nullptr) std::rethrow_exception(first.error);
    report = first.report;
  }
  if (wait) check_step();
  return report;
}

void TopologyEdits::check_step() {
  if (!std::exchange(check_after_, std::nullopt)) return;
  step_.adapt_after_move();
}

void TopologyEdits::settle() {
  if (under_way_ == nullptr) return;
  try {
    if (const std::optional<CutReport> report = load_built(true)) settled_.push_back({*report, nullptr});
  } catch (...) {  // it is not the caller's
    settled_.push_back({{}, std::current_exception()});
  }
  if (under_way_ != nullptr) under_way_->wait();
}

void TopologyEdits::end_building() {
  settle();
  settled_.clear();
  check_after_.reset();
  if (under_way_ != nullptr) std::exchange(under_way_, nullptr)->give_up();
}

EditedBodies& TopologyEdits::bodies() {
  if (bodies_ == nullptr) bodies_ = std::make_unique<EditedBodies>(run_.scene, whole_);
  return *bodies_;
}

/// Returns the bodies; throws for a scene that cannot be cut.
EditedBodies& TopologyEdits::cut_bodies() {
  if (!parts_along_faces(run_.scene) && (run_.settings.tears || EditedBodies::tears(run_.scene))) {
    throw Error(ErrorCode::bad_input, "a scene with a material that tears (\"toughness\") cannot be cut");
  }
  const IntegratorInfo& integrator = integrator_info(run_.scene.integrator);
  if (!integrator.edits || run_.scene.relaxation.enabled) {
    const std::string has = integrator.edits ? "relaxation" : fmt::format("\"integrator\": \"{}\"", integrator.word);
    throw Error(ErrorCode::bad_input,
                fmt::format("a scene with {} cannot be cut, only with the integrator {} and no relaxation", has,
                            integrators_with(&IntegratorInfo::edits)));
  }
  return bodies();
}

void TopologyEdits::prepare_cuts() {
  settle();
  EditedBodies& all = cut_bodies();
  if (blade_method(run_.scene) != BladeMethod::virtual_nodes) return;  // other methods add no kind of element
  if (run_.backend().info().compiles && !compiled_) {
    run_.backend().compile(build_program(all.trial_model(), run_.program_options()));
    compiled_ = true;
  }
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (can_be_cut(all.uncut(b))) static_cast<void>(all.cut(b));
  }
  if (all.size() == 1) all.surface_copy.make(run_.loaded.shared_model(), all.helper);
}

const CutTopology* TopologyEdits::cut_topology(std::size_t body) const {
  if (bodies_ == nullptr || body >= bodies_->size()) return nullptr;
  if (const RemadeBody* remade = bodies_->remade(body)) return &remade->topology();
  if (const SweptFaces* swept = bodies_->find_swept(body)) return &swept->topology();
  return bodies_->find_cut(body) == nullptr ? nullptr : &bodies_->find_cut(body)->topology();
}

std::int64_t TopologyEdits::cut_in_part(std::size_t body) const {
  const CutTopology* topology = cut_topology(body);
  if (topology == nullptr) return 0;
  const RemadeBody* remade = bodies_->remade(body);
  return remade != nullptr ? remade->cut_in_part() : topology->cut_in_part();
}

std::optional<std::int32_t> TopologyEdits::element_at(std::size_t body, std::int32_t element, const Vec3d& rest) const {
  const RemadeBody* remade = bodies_ == nullptr ? nullptr : bodies_->remade(body);
  if (remade == nullptr) return {};
  return remade->element_at(element, rest);
}

std::optional<Vec3d> TopologyEdits::edited_at() const {
  const Model& model = run_.model();
  if (changed_nodes_.size() != model.mass.size()) return {};
  const std::vector<double> u = run_.u();
  Vec3d sum{};
  double count = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<Vec3d> x = run_.loaded.positions(u, b);
    for (std::size_t n = 0; n < x.size(); ++n) {
      if (changed_nodes_[static_cast<std::size_t>(model.bodies[b].slot[n])] == 0) continue;
      sum = vec::add(sum, x[n]);
      ++count;
    }
  }
  if (count == 0) return {};
  return vec::mul(sum, 1 / count);
}

Scene TopologyEdits::scene_at(const RunState& state) const {
  Scene scene = run_.scene;
  scene.cuttable = scene.cuttable || !state.cuts.empty();
  if (!state.tools.empty()) scene.tools = present_tools(run_.scene, state.tools);
  for (std::size_t j = 0; j < state.broken.size(); ++j) scene.joins[j].broken = state.broken[j];
  for (std::size_t b = 0; b < scene.bodies.size() && !state.regions.empty(); ++b) {
    if (!scene.bodies[b].model.follow.empty()) scene.bodies[b].model.cells = state.regions[b].cells;
  }
  for (Body& body : scene.bodies) {
    DeformationModel& m = body.model;
    if (state.most_substeps == 0 || m.type != ModelType::hybrid || m.substeps <= state.most_substeps) continue;
    const double ratio = static_cast<double>(state.most_substeps) / m.substeps;
    // Keep stiffness and damping over time at the shorter step.
    m.alpha *= ratio * ratio;
    m.damping = 1 - std::pow(1 - m.damping, ratio);
    m.substeps = state.most_substeps;
  }
  return scene;
}

std::unique_ptr<EditedBodies> TopologyEdits::bodies_at(const RunState& state) const {
  const Scene& scene = run_.scene;
  const auto refuse = [](const char* what) {
    throw Error(ErrorCode::bad_input, fmt::format("{} do not belong to this scene, or are damaged", what));
  };
  if (!state.regions.empty() && (state.regions.size() != scene.bodies.size() || !follows(scene))) refuse("its moved regions");
  if (!state.broken.empty() && state.broken.size() != scene.joins.size()) refuse("its broken joins");
  const auto edited = [](const RunState& s) {
    return !s.cuts.empty() || !s.tears.empty() || !s.regions.empty() || s.most_substeps != 0 || !s.blades.traces.empty() ||
           !s.pressed.empty() || (s.kept && !s.kept->pressed.empty()) || !s.changed.parameters.empty() || !s.broken.empty();
  };
  if (!edited(state) && !edited(run_.state)) return nullptr;
  auto all = std::make_unique<EditedBodies>(scene, whole());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {  // keep prepared cuts
    if (bodies_ != nullptr && bodies_->find_cut(b) != nullptr) static_cast<void>(all->cut(b));
  }
  for (std::size_t b = 0; b < state.regions.size(); ++b) {
    const std::vector<std::int32_t>& cells = state.regions[b].cells;
    const auto last = static_cast<std::int64_t>(all->uncut(b).lattice == nullptr ? 0 : all->uncut(b).lattice->cells.size());
    const bool ordered = std::adjacent_find(cells.begin(), cells.end(), std::greater_equal<>()) == cells.end();
    if (!ordered || (!cells.empty() && (cells.front() < 0 || cells.back() >= last))) refuse("its moved regions");
  }
  all->replay(state);
  const auto check_fronts = [&](const std::map<std::string, PressedBlade>& blades) {
    for (const auto& pressed : blades) {
      const std::vector<FrontSample>& samples = pressed.second.samples;
      const auto own =
          std::find_if(scene.blades.begin(), scene.blades.end(), [&](const Blade& b) { return b.name == pressed.first; });
      const bool known = own != scene.blades.end() && own->cuts == BladeCuts::by_force &&
                         samples.size() == static_cast<std::size_t>(sample_count(*own, run_.settings.blade_edge));
      if (!known || !std::all_of(samples.begin(), samples.end(), [&](const FrontSample& s) { return belongs(s, *all); }))
        refuse("its fronts of blades");
    }
  };
  check_fronts(state.pressed);
  if (state.kept) check_fronts(state.kept->pressed);
  for (const auto& [key, traces] : state.blades.traces) {
    for (const auto& [body, front] : traces) {
      const bool known = body >= 0 && static_cast<std::size_t>(body) < all->size() &&
                         all->meets_blades(static_cast<std::size_t>(body)) &&
                         belongs(front, all->topology(static_cast<std::size_t>(body)).mesh());
      if (!known) refuse("its traces of blades");
    }
  }
  return all;
}

void TopologyEdits::take_up(std::unique_ptr<EditedBodies> bodies) {
  if (bodies == nullptr) return;  // neither state had edits
  bodies_ = std::move(bodies);
  if (bodies_->size() == 1) {
    bodies_->surface_copy.make(run_.loaded.shared_model(), bodies_->helper);
  }
}

}  // namespace pliant
