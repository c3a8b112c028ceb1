// Two backends in lockstep: the first pass, buffer and index at which they do not hold the same bits.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "simulation/simulation.h"

namespace pliant {

struct CompareOptions {
  std::int64_t steps = 100;  ///< at most; a divergence or an equilibrium of both ends the comparison sooner
  bool every_pass = true;    ///< false: look only after whole steps, and name the step as the pass
  /// Called after every batch with the steps done; return false to stop there. May be empty.
  std::function<bool(std::int64_t done)> progress;
};

/// Where two simulations part. Values are given as bits and as numbers, because numbers that print alike may differ.
struct FirstDifference {
  std::int64_t step = 0;   ///< 1 is the first step of a scene; the step at work when they parted, 0 before the first
  std::int32_t pass = -1;  ///< position in Program::step; -1 outside of it: `label` says where
  std::string kernel;      ///< stem of the pass, "step" for whole steps, "host" outside of passes
  std::string label;
  std::string buffer;
  std::int64_t index = 0;        ///< of the value, in numbers of four bytes
  std::string value_a, value_b;  ///< bits, "0x3f800000"
  std::string decimal_a, decimal_b;
  [[nodiscard]] std::string message() const;
};

struct ComparisonResult {
  bool identical = true;
  std::int64_t steps = 0;    ///< of the batches that both ran; after a divergence the simulations stand at its last good step
  std::int32_t passes = 0;   ///< of one step
  std::int32_t buffers = 0;  ///< compared after every pass; constant ones are compared once, before the first
  std::int64_t values_compared = 0;  ///< numbers, over all looks
  std::optional<FirstDifference> first_difference;
  std::optional<Divergence> diverged;  ///< both, at the same element of the same step
  bool at_equilibrium = false;
  bool stopped = false;  ///< by `progress`
};

/// Advance both by the same passes and compare every buffer as bits, NaN equal to NaN whatever its payload. Both must run the
/// same Model from the same step number on backends that compute in float: throws Error otherwise. Different sizes of the step
/// are a difference like any other.
ComparisonResult compare(Simulation& a, Simulation& b, const CompareOptions& options = {});

}  // namespace pliant
