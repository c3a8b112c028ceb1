// A prepared pass: its twin and the arguments that do not change from step to step.
#pragma once
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "backends/interface/pass_table.h"
#include "cpu_ref/registry.h"
#include "pliant/error.h"

namespace pliant::ref {

template <class Scalar>
struct PreparedTwin {
  std::function<void(Range, const ArgValue<Scalar>*)> call;
  std::vector<ArgValue<Scalar>> args;
  std::vector<std::size_t> step_args;

  /// Threads copy only the arguments that change from step to step.
  void execute(Range range, std::int32_t step) const {
    if (range.begin == range.end) return;
    if (step_args.empty()) {
      call(range, args.data());
      return;
    }
    std::vector<ArgValue<Scalar>> own = args;
    for (const std::size_t i : step_args) own[i].integer = step;
    call(range, own.data());
  }
};

/// `values_of(id)` returns one of the program's `buffers` buffers as an argument, with either reals or ints set. Throws Error
/// (internal) for a pass that does not match its twin.
template <class Scalar, class ValuesOf>
PreparedTwin<Scalar> prepare_twin(const Registry& registry, const Pass& pass, std::size_t buffers, ValuesOf&& values_of) {
  check_pass(pass, buffers);
  Twin twin = registry.find(pass.kernel, pass.defines);
  TwinFunction<Scalar> function;
  if constexpr (std::is_same_v<Scalar, float>) {
    function = std::move(twin.of_float);
  } else {
    function = std::move(twin.of_double);
  }
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::internal, fmt::format("pass \"{}\", twin of kernel \"{}\": {}", pass.label, pass.kernel, what));
  };
  if (pass.args.size() != function.parameters.size()) {
    fail(fmt::format("{} arguments for {} parameters", pass.args.size(), function.parameters.size()));
  }
  PreparedTwin<Scalar> p{std::move(function.call), std::vector<ArgValue<Scalar>>(pass.args.size()), {}};
  static constexpr const char* kind_names[] = {"a buffer of reals", "a buffer of integers", "a real", "an integer"};
  for (std::size_t i = 0; i < pass.args.size(); ++i) {
    ParameterKind kind = ParameterKind::integer;
    if (pass.args[i].index() == 0) {
      p.args[i] = values_of(std::get<0>(pass.args[i]));
      kind = p.args[i].ints == nullptr ? ParameterKind::reals : ParameterKind::ints;
    } else if (pass.args[i].index() == 1) {
      kind = ParameterKind::real;
      p.args[i].real = static_cast<Scalar>(std::get<1>(pass.args[i]));
    } else if (pass.args[i].index() == 2) {
      p.args[i].integer = std::get<2>(pass.args[i]);
    } else {
      p.step_args.push_back(i);
    }
    const ParameterKind wanted = function.parameters[i];
    if (kind != wanted) {
      fail(fmt::format("argument {} is {}, the parameter is {}", i, kind_names[static_cast<int>(kind)],
                       kind_names[static_cast<int>(wanted)]));
    }
  }
  return p;
}

}  // namespace pliant::ref
