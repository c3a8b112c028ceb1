// Buffers and passes of fast lattice shape matching: nodes to regions, regions to nodes, damping, and the interface force.
#include <fmt/format.h>

#include <array>

#include "schedule/matching/flsm_data.h"
#include "schedule/program_builder.h"

namespace pliant {
namespace {

using Defines = std::vector<std::pair<std::string, int>>;
using Args = std::vector<Arg>;

Args operator+(Args a, const Args& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Buffers shared by all batches and bodies with shape matching.
struct SharedBuffers {
  Arg node_u, node_w, node_load, step_params, alpha, fault;
};

/// Adds the buffers and passes of one batch.
class FlsmPasses {
 public:
  FlsmPasses(const Model& model, std::size_t index, const SharedBuffers& shared, Program& program)
      : b_(model.flsm[index]),
        places_(b_),
        index_(static_cast<std::int32_t>(index)),
        label_(fmt::format("{}: shape matching", model.bodies[b_.body].name)),
        shared_(shared),
        program_(program),
        data_(region_data(b_, places_)) {
    const auto nodes = static_cast<double>(b_.slot.size());
    missing_ = static_cast<double>(data_.missing.other.size()) / nodes;
    missing_of_ = static_cast<double>(data_.missing_of.other.size()) / nodes;
    add_buffers();
  }

  void add(bool has_load, std::int32_t fault_base, std::int32_t slots) {
    missing_args_ = list("flsm_missing", data_.missing);
    add_sums(shared_.node_u, weight_, 1, "displacements");
    const double nu = b_.poisson;
    pass("flsm_region", {{"WIDTH", b_.settings.width}, {"ELASTIC", elastic() ? 1 : 0}},
         Args{shared_.node_u, plates_, link_[2]} + missing_args_ +
             Args{reference_, rest_, regions_, elastic_, pulls_, real_arg(b_.spacing), real_arg(1 / (1 + nu)),
                  real_arg(nu / ((1 + nu) * (1 - 2 * nu)))},
         places_.nodes, (elastic() ? 276 : 184) + 24 * missing_,
         36.0 * b_.settings.width + 32 * missing_ + (elastic() ? 1690 : 1480));
    missing_of_args_ = list("flsm_missing_of", data_.missing_of);
    if (b_.settings.damping > 0) add_damping();
    add_goals(pulls_, "goals");
    if (b_.interface > 0) add_interface();
    if (reaction()) add_reaction(slots);
    if (b_.own > 0) {
      pass("flsm_update", {{"WIDTH", b_.settings.width}, {"HAS_LOAD", has_load ? 1 : 0}},
           Args{shared_.node_u, shared_.node_w, shared_.node_load} + goal_args(pulls_, bars_) +
               Args{reference_, shared_.step_params, shared_.alpha, shared_.fault, int_arg(index_),
                    int_arg(b_.settings.substeps), int_arg(b_.first_slot), int_arg(fault_base), step_arg()},
           places_.interface_base, goal_bytes() + 64 + (has_load ? 16 : 0), goal_flops() + 27, b_.own);
    }
  }

 private:
  /// Whether regions deform like a material.
  [[nodiscard]] bool elastic() const { return !b_.elastic.empty(); }
  /// Returns true if the interface springs do not conserve momentum by themselves.
  [[nodiscard]] bool reaction() const { return b_.interface > 0 && b_.settings.beta > 0 && b_.settings.conservative; }
  [[nodiscard]] Defines width() const { return {{"WIDTH", b_.settings.width}}; }
  [[nodiscard]] double goal_bytes() const { return 44 + 84 * missing_of_; }
  [[nodiscard]] double goal_flops() const { return 20.0 * b_.settings.width + 4 + 32 * missing_of_; }

  Arg ints(const std::string& stem, const char* shape, std::vector<std::int32_t> values) {
    return buffer_arg(
        program_.add(make_ints(fmt::format("{}/{}", stem, index_), BufferRole::constant, shape, std::move(values), 2)));
  }
  Arg reals(const std::string& stem, std::size_t size, BufferRole role, const char* shape, const char* unit,
            const char* producer, std::vector<double> values = {}) {
    return buffer_arg(program_.add(make_reals(fmt::format("{}/{}", stem, index_), BufferType::real, size, role, shape, unit,
                                              producer, std::move(values))));
  }
  /// In metres. Regions and the interface are other ones after an edit.
  Arg state(const std::string& stem, std::size_t size, const char* shape, const char* producer) {
    return buffer_arg(program_.add(declare_state(
        make_reals(fmt::format("{}/{}", stem, index_), BufferType::real, size, BufferRole::state, shape, "m", producer),
        Carry::drop)));
  }
  Args list(const std::string& stem, MissingList& from) {
    const std::size_t entries = std::max<std::size_t>(from.other.size(), 1);
    return {ints(stem + "_offset", "[regions + 1]", std::move(from.offset)), ints(stem, "[entries]", std::move(from.other)),
            reals(stem + "_factor", 4 * entries, BufferRole::constant, "[entries][4]", "1", "model", std::move(from.factor))};
  }

  void add_buffers() {
    const auto count = static_cast<std::size_t>(places_.count), with_region = static_cast<std::size_t>(places_.nodes);
    slot_ = ints("flsm_slot", "[regions]", data_.slot);
    const char* const names[] = {"flsm_link_x", "flsm_link_y", "flsm_link_z"};
    for (int axis = 0; axis < 3; ++axis) link_[axis] = ints(names[axis], "[regions][2]", std::move(data_.link[axis]));
    weight_ = reals("flsm_weight", count, BufferRole::constant, "[regions]", "1/m", "model", std::move(data_.weight));
    rest_ = reals("flsm_rest", PLIANT_FLSM_REST_PLANES * with_region, BufferRole::constant, "[tiles][10][16]", "m, 1", "model",
                  std::move(data_.rest));
    holders_ = reals("flsm_inverse_holders", with_region, BufferRole::constant, "[regions]", "1", "model",
                     std::move(data_.inverse_holders));
    reference_ = state("flsm_reference", 8, "[2][4]", "flsm_bar");
    bars_ = reals("flsm_bars", 8 * count, BufferRole::scratch, "[regions][2][4]", "1", "flsm_bar, flsm_goal_bar");
    plates_ = reals("flsm_plates", PLIANT_FLSM_RECORD * count, BufferRole::scratch, "[regions][4][4]", "1",
                    "flsm_plate, flsm_goal_plate");
    regions_ = state("flsm_regions", PLIANT_FLSM_RECORD * count, "[regions][4][4]", "flsm_region");
    elastic_ = rest_;  // unused by rigid regions
    pulls_ = regions_;
    if (elastic()) {
      elastic_ = reals("flsm_elastic", PLIANT_FLSM_ELASTIC_PLANES * with_region, BufferRole::constant, "[tiles][7][16]", "1",
                       "model", std::move(data_.elastic));
      pulls_ = reals("flsm_pulls", PLIANT_FLSM_RECORD * count, BufferRole::scratch, "[regions][4][4]", "m", "flsm_region");
      program_.buffers[std::get<0>(pulls_)].fixed = PLIANT_FLSM_RECORD * (count - with_region);  // fillers, as below
    }
    if (b_.settings.damping > 0 || reaction()) {
      rates_ = reals("flsm_rates", PLIANT_FLSM_RECORD * count, BufferRole::scratch, "[regions][4][4]", "m", "flsm_damp_region");
      // Only regions move; the fillers after them contribute 0.
      program_.buffers[std::get<0>(rates_)].fixed = PLIANT_FLSM_RECORD * (count - with_region);
      spin_ = reals("flsm_spin", PLIANT_FLSM_SPIN_PLANES * with_region, BufferRole::constant, "[tiles][6][16]", "m", "model",
                    std::move(data_.spin));
    }
  }

  /// Adds the passes for bars and plates of a texel buffer of the nodes.
  void add_sums(const Arg& texels, const Arg& weight, int relative, const char* of) {
    pass("flsm_bar", {{"WIDTH", b_.settings.width}, {"RELATIVE", relative}},
         {texels, slot_, weight, link_[0], reference_, bars_}, places_.count, 64, 8 + 32.0 * b_.settings.width, 0, of);
    pass("flsm_plate", width(), {bars_, link_[1], plates_}, places_.count, 104, 28.0 * b_.settings.width, 0, of);
  }
  /// Adds the passes for plates and bars of the regions' records, from regions to nodes.
  void add_goals(const Arg& records, const char* of) {
    pass("flsm_goal_plate", width(), {records, link_[2], plates_}, places_.count, 136, 36.0 * b_.settings.width, 0, of);
    pass("flsm_goal_bar", width(), {plates_, link_[1], bars_}, places_.count, 104, 28.0 * b_.settings.width, 0, of);
  }
  [[nodiscard]] Args goal_args(const Arg& records, const Arg& bars) const {
    return Args{bars, link_[0], records} + missing_of_args_ + Args{holders_};
  }
  /// Adds the closest rigid motion of each region to the increments, and the damping or reaction at the nodes.
  void add_rates(const Arg& increments, const Arg& weight, const Args& missing, int reaction, double damping, const char* of) {
    add_sums(increments, weight, 0, of);
    pass("flsm_damp_region", width(),
         Args{increments, plates_, link_[2]} + missing + Args{rest_, spin_, regions_, rates_, real_arg(1 / b_.spacing)},
         places_.nodes, 260 + 24 * missing_, 36.0 * b_.settings.width + 32 * missing_ + 160, 0, of);
    add_goals(rates_, of);
    pass("flsm_damp_update", {{"WIDTH", b_.settings.width}, {"REACTION", reaction}},
         Args{shared_.node_u, shared_.node_w, slot_} + goal_args(rates_, bars_) +
             Args{real_arg(damping), int_arg(b_.settings.substeps), int_arg(places_.interface_base)},
         places_.nodes, goal_bytes() + 52, goal_flops() + 16, 0, of);
  }
  void add_damping() {
    const Arg weight = reals("flsm_rate_weight", static_cast<std::size_t>(places_.count), BufferRole::constant, "[regions]",
                             "1/m", "model", std::move(data_.rate_weight));
    add_rates(shared_.node_w, weight, list("flsm_rate_missing", data_.rate_missing), 0, b_.settings.damping, "damping");
  }

  void add_interface() {
    const auto shared = static_cast<std::size_t>(places_.nodes - places_.interface_base);
    const int n = b_.settings.substeps;
    goals_ = state("flsm_goals", 8 * shared, "[interface][2][4]", "flsm_goal");
    if (n > 1) {  // kept over several steps, so they need backups for rollback
      for (const Arg& state : {reference_, goals_}) add_last_good(program_, std::get<0>(state));
    }
    beta_ = reals("flsm_beta", shared, BufferRole::control, "[interface]", "N/m", "host");
    const Arg base = int_arg(places_.interface_base);
    pass("flsm_goal", width(), goal_args(pulls_, bars_) + Args{reference_, goals_, base}, static_cast<std::int32_t>(shared),
         goal_bytes() + 64, goal_flops(), b_.interface);
    pass("flsm_interface", {{"EXTRAPOLATED", b_.settings.extrapolate && n > 1 ? 1 : 0}},
         {shared_.node_u, shared_.node_load, slot_, reference_, goals_, beta_, shared_.step_params, int_arg(n), base,
          step_arg()},
         static_cast<std::int32_t>(shared), 88, 12, b_.interface);
    // Held goals act only in the first substep, n times as hard, when both ends of the spring are where the regions were
    // evaluated: an impulse like that of shape matching's own nodes, so that momenta are conserved. In later substeps they
    // would drag nodes that have moved on.
    program_.step.back().every = b_.settings.extrapolate ? 1 : n;
  }

  /// Returns the excess of the interface springs to the regions. This overwrites the bars and plates, so the goals are
  /// computed again afterwards.
  void add_reaction(std::int32_t slots) {
    const Arg mean = reals("flsm_mean_beta", static_cast<std::size_t>(places_.nodes - places_.interface_base),
                           BufferRole::control, "[interface]", "N/m", "host");
    const Arg excess =
        reals("flsm_excess", 4 * static_cast<std::size_t>(slots), BufferRole::scratch, "[slots]", "m", "flsm_excess");
    program_.buffers[std::get<0>(excess)].carried = Carried::unwritten;  // zero except at interface nodes
    pass("flsm_excess", {},
         {shared_.node_u, slot_, reference_, goals_, mean, shared_.alpha, shared_.step_params, excess, int_arg(index_),
          int_arg(b_.settings.substeps), int_arg(places_.interface_base)},
         places_.nodes - places_.interface_base, 88, 12, b_.interface);
    add_rates(excess, weight_, missing_args_, 1, 0, "reaction");
    add_goals(pulls_, "goals");
  }

  void pass(const char* kernel, Defines defines, Args args, std::int64_t indices, double bytes, double flops,
            std::int64_t elements = 0, const std::string& of = {}) {
    const auto nodes = static_cast<std::int64_t>(b_.slot.size());
    program_.step.push_back({kernel, std::move(defines), std::move(args), Shape::lanes, indices,
                             of.empty() ? label_ : fmt::format("{}, {}", label_, of), elements > 0 ? elements : nodes, bytes,
                             flops, b_.settings.substeps});
  }

  const FlsmBatch& b_;
  const RegionLayout places_;
  const std::int32_t index_;
  const std::string label_;
  const SharedBuffers& shared_;
  Program& program_;
  RegionData data_;
  double missing_ = 0, missing_of_ = 0;  ///< entries per node
  Arg slot_, link_[3], weight_, rest_, holders_, bars_, plates_, regions_, rates_, spin_, elastic_, pulls_, goals_, beta_,
      reference_;
  Args missing_args_, missing_of_args_;
};

}  // namespace

void ProgramBuilder::add_flsm(std::size_t index) {
  if (flsm_alpha_ < 0) {
    flsm_alpha_ =
        add(make_reals("flsm_alpha", BufferType::real, model_.flsm.size(), BufferRole::control, "[batches]", "1", "host"));
  }
  const SharedBuffers shared{buffer_arg(node_u_), buffer_arg(node_w_),     buffer_arg(node_load_),
                             buffer_arg(now_),    buffer_arg(flsm_alpha_), buffer_arg(fault_)};
  FlsmPasses(model_, index, shared, program_).add(needs_load(), layout_.flsm[index].fault_base, model_.slots);
}

}  // namespace pliant
