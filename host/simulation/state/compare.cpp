#include "simulation/state/compare.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "pliant/error.h"
#include "program/hash.h"

namespace pliant {
namespace {

/// A point of the step at which the buffers are compared.
struct Place {
  std::int64_t step = 0;
  std::int32_t pass = -1;
  const char* kernel = "host";
  std::string label;
};

bool is_nan(std::uint32_t bits) { return (bits & 0x7f800000u) == 0x7f800000u && (bits & 0x007fffffu) != 0; }

std::string decimal(std::uint32_t bits, bool is_int) {
  return is_int ? fmt::format("{}", std::bit_cast<std::int32_t>(bits)) : fmt::format("{:.9g}", std::bit_cast<float>(bits));
}

class Lockstep {
 public:
  Lockstep(Simulation& a, Simulation& b, const CompareOptions& options) : a_(a), b_(b), options_(options) {
    require_comparable();
    result_.passes = static_cast<std::int32_t>(a.program().step.size());
    for (const Program* program : {&a.program(), &a.surface_program()}) {
      for (const Buffer& buffer : program->buffers) result_.buffers += buffer.role != BufferRole::constant;
    }
  }

  ComparisonResult run() {
    const Place start{a_.step(), -1, "host", "initial state"};
    if (!look(start, true) || !look_at(a_.surface_program(), start, true) || !same_host(start)) return finish();
    const std::int64_t first = a_.step();
    while (result_.steps < options_.steps && !a_.divergence() && !a_.at_equilibrium()) {
      const std::int32_t n = a_.next_batch(options_.steps - result_.steps);
      if (!batch(n)) break;
      result_.steps = a_.step() - first + (a_.divergence() ? n : 0);  // a rollback may have reduced the step number
      if (options_.progress && !options_.progress(result_.steps)) {
        result_.stopped = result_.steps < options_.steps;
        break;
      }
    }
    return finish();
  }

 private:
  void require_comparable() const {
    if (a_.shared_model() != b_.shared_model() && a_.model_hash() != b_.model_hash()) {
      throw Error(ErrorCode::bad_input, "compare: the two simulations do not run the same model");
    }
    for (const Simulation* s : {&a_, &b_}) {
      const BufferId params = s->program().find("step_params");
      if (s->backend().read_bytes(params).size() != 4 * s->program().buffers[static_cast<std::size_t>(params)].values()) {
        throw Error(
            ErrorCode::bad_input,
            fmt::format("compare: the backend {} computes in double, so its bits cannot equal those of a float backend; "
                        "allowed are backends in float: cpu, opencl:N",
                        s->backend().info().name));
      }
    }
    if (a_.step() != b_.step()) {
      throw Error(ErrorCode::bad_input, fmt::format("compare: {} is at step {} and {} at step {}; they must start alike",
                                                    a_.backend().info().name, a_.step(), b_.backend().info().name, b_.step()));
    }
  }

  /// Runs one batch on both. Returns false if a difference was found.
  bool batch(std::int32_t steps) {
    const std::int64_t first = a_.step();
    a_.begin_batch(steps);
    b_.begin_batch(steps);
    if (!look({first + 1, -1, "host", "before the batch"}, false)) return false;
    for (std::int32_t i = 0; i < steps; ++i) {
      if (!(options_.every_pass ? step_by_pass(first, i) : whole_step(first, i))) return false;
    }
    a_.end_batch(steps);
    b_.end_batch(steps);
    const Place end{first + steps, -1, "host", "after the batch"};
    for (Simulation* s : {&a_, &b_}) s->backend().run(s->surface_program().step, 0, 1);
    return look(end, false) && look_at(a_.surface_program(), end, false) && same_host(end);
  }

  bool step_by_pass(std::int64_t first, std::int32_t i) {
    for (Simulation* s : {&a_, &b_}) s->before_step(i);
    const auto& passes_a = a_.program().step;
    const auto& passes_b = b_.program().step;
    for (std::size_t p = 0; p < passes_a.size(); ++p) {
      if (!passes_a[p].runs_in(first + i)) continue;
      // Enqueue both before waiting for either.
      a_.backend().run(passes_a[p], i);
      b_.backend().run(passes_b[p], i);
      if (!look({first + i + 1, static_cast<std::int32_t>(p), passes_a[p].kernel.c_str(), passes_a[p].label}, false))
        return false;
    }
    return true;
  }

  bool whole_step(std::int64_t first, std::int32_t i) {
    a_.run_steps(i, 1);
    b_.run_steps(i, 1);
    return look({first + i + 1, -1, "step", "after the whole step"}, false);
  }

  /// Compares the buffers. Returns false and stores the first difference if there is one.
  bool look(const Place& place, bool constants) { return look_at(a_.program(), place, constants); }

  bool look_at(const Program& program, const Place& place, bool constants) {
    for (std::size_t i = 0; i < program.buffers.size(); ++i) {
      const Buffer& buffer = program.buffers[i];
      if (buffer.role == BufferRole::constant && !constants) continue;
      const BufferId id = program.first + static_cast<BufferId>(i);
      const auto bytes_a = a_.backend().read_bytes(id);
      const auto bytes_b = b_.backend().read_bytes(id);
      result_.values_compared += static_cast<std::int64_t>(buffer.values());
      if (bytes_a.size() == bytes_b.size() &&
          (bytes_a.empty() || std::memcmp(bytes_a.data(), bytes_b.data(), bytes_a.size()) == 0)) {
        continue;
      }
      if (!same_values(place, buffer, bytes_a, bytes_b)) return false;
    }
    return true;
  }

  bool same_values(const Place& place, const Buffer& buffer, const std::vector<std::uint8_t>& bytes_a,
                   const std::vector<std::uint8_t>& bytes_b) {
    if (bytes_a.size() != bytes_b.size()) {
      throw Error(ErrorCode::internal,
                  fmt::format("compare: buffer {} has {} bytes on {} and {} on {}", buffer.name, bytes_a.size(),
                              a_.backend().info().name, bytes_b.size(), b_.backend().info().name));
    }
    for (std::size_t i = 0; i < bytes_a.size() / 4; ++i) {
      std::uint32_t va = 0, vb = 0;
      std::memcpy(&va, &bytes_a[4 * i], 4);
      std::memcpy(&vb, &bytes_b[4 * i], 4);
      if (va == vb || (!buffer.is_int() && is_nan(va) && is_nan(vb))) continue;
      differ(place, buffer.name, static_cast<std::int64_t>(i), fmt::format("0x{:08x}", va), fmt::format("0x{:08x}", vb),
             decimal(va, buffer.is_int()), decimal(vb, buffer.is_int()));
      return false;
    }
    return true;
  }

  /// Compares the host state derived from the same buffers. Only a bug can make it differ, and no later check would detect
  /// that.
  bool same_host(const Place& place) {
    const auto same = [&](const char* what, double va, double vb) {
      const auto bits_a = std::bit_cast<std::uint64_t>(va), bits_b = std::bit_cast<std::uint64_t>(vb);
      if (bits_a == bits_b) return true;
      differ(place, what, 0, fmt::format("0x{:016x}", bits_a), fmt::format("0x{:016x}", bits_b), fmt::format("{}", va),
             fmt::format("{}", vb));
      return false;
    };
    const RunState &sa = a_.state(), &sb = b_.state();
    return same("host: dt", sa.clock.dt, sb.clock.dt) && same("host: stable_dt", sa.limit.stable_dt, sb.limit.stable_dt) &&
           same("host: damping", sa.relaxation.damping, sb.relaxation.damping) &&
           same("host: step", static_cast<double>(sa.clock.step), static_cast<double>(sb.clock.step)) &&
           same("host: run state", static_cast<double>(hash_bytes(write_state(sa)) >> 11),
                static_cast<double>(hash_bytes(write_state(sb)) >> 11)) &&
           same("host: diverged", a_.divergence().has_value(), b_.divergence().has_value()) &&
           same("host: at_equilibrium", a_.at_equilibrium(), b_.at_equilibrium());
  }

  void differ(const Place& place, std::string buffer, std::int64_t index, std::string value_a, std::string value_b,
              std::string decimal_a, std::string decimal_b) {
    result_.identical = false;
    result_.first_difference =
        FirstDifference{place.step, place.pass,         place.kernel,       place.label,          std::move(buffer),
                        index,      std::move(value_a), std::move(value_b), std::move(decimal_a), std::move(decimal_b)};
  }

  ComparisonResult finish() {
    result_.diverged = a_.divergence();
    result_.at_equilibrium = a_.at_equilibrium();
    return std::move(result_);
  }

  Simulation& a_;
  Simulation& b_;
  const CompareOptions& options_;
  ComparisonResult result_;
};

}  // namespace

std::string FirstDifference::message() const {
  const std::string where = pass >= 0 ? fmt::format("pass {} ({}, {})", pass, kernel, label) : label;
  return fmt::format("step {}, {}: buffer {} differs at value {}: {} ({}) and {} ({})", step, where, buffer, index, value_a,
                     decimal_a, value_b, decimal_b);
}

ComparisonResult compare(Simulation& a, Simulation& b, const CompareOptions& options) { return Lockstep(a, b, options).run(); }

}  // namespace pliant
