// Runs two backends in lockstep and finds the first pass, buffer and index at which their bits differ.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "simulation/simulation.h"

namespace pliant {

struct CompareOptions {
  std::int64_t steps = 100;  ///< maximum number; ends earlier if both diverge or reach equilibrium
  bool every_pass = true;    ///< false: compare only after whole steps
  /// Called after every batch with the number of steps done; returning false stops the comparison. May be empty.
  std::function<bool(std::int64_t done)> progress;
};

/// Location of the first difference. Values are given as bits and as numbers, since different bits may print as the same
/// number.
struct FirstDifference {
  std::int64_t step = 0;   ///< the step in progress, 1 is the first; 0: before the first step
  std::int32_t pass = -1;  ///< position in Program::step; -1 outside of it, see `label`
  std::string kernel;      ///< name of the pass; "step" when comparing whole steps, "host" outside of passes
  std::string label;
  std::string buffer;
  std::int64_t index = 0;        ///< index of the value, in units of four bytes
  std::string value_a, value_b;  ///< bits, "0x3f800000"
  std::string decimal_a, decimal_b;
  [[nodiscard]] std::string message() const;
};

struct ComparisonResult {
  bool identical = true;
  std::int64_t steps =
      0;  ///< steps of the batches that both completed; after a divergence the simulations hold its last good step
  std::int32_t passes = 0;   ///< number of passes of one step
  std::int32_t buffers = 0;  ///< number compared after every pass; constant buffers are compared once, before the first pass
  std::int64_t values_compared = 0;  ///< total number of values over all comparisons
  std::optional<FirstDifference> first_difference;
  std::optional<Divergence> diverged;  ///< set if both diverged at the same element in the same step
  bool at_equilibrium = false;
  bool stopped = false;  ///< by `progress`
};

/// Advances both simulations pass by pass and compares the bits of every buffer; all NaN values count as equal. Both must run
/// the same Model from the same step number on backends that compute in float, otherwise throws Error. A different step size
/// counts as a difference.
ComparisonResult compare(Simulation& a, Simulation& b, const CompareOptions& options = {});

}  // namespace pliant
