// A twin is a plain function with the kernel's parameters in order; this file calls it with a list of values.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cpu_ref/range.h"

namespace pliant::ref {

enum class ParameterKind { reals, ints, real, integer };

/// One argument of a pass; the parameter's type determines which member is used.
template <class Scalar>
struct ArgValue {
  Scalar* reals = nullptr;
  std::int32_t* ints = nullptr;
  Scalar real = 0;
  std::int32_t integer = 0;
};

template <class Scalar>
struct TwinFunction {
  std::function<void(Range, const ArgValue<Scalar>*)> call;
  std::vector<ParameterKind> parameters;
};

template <class Scalar, class Parameter>
constexpr ParameterKind parameter_kind() {
  using Pointee = std::remove_cv_t<std::remove_pointer_t<Parameter>>;
  if constexpr (std::is_pointer_v<Parameter>) {
    static_assert(std::is_same_v<Pointee, Scalar> || std::is_same_v<Pointee, std::int32_t>,
                  "a buffer of a twin is a pointer to Scalar or std::int32_t");
    return std::is_same_v<Pointee, Scalar> ? ParameterKind::reals : ParameterKind::ints;
  } else {
    static_assert(std::is_same_v<Pointee, Scalar> || std::is_same_v<Pointee, std::int32_t>,
                  "a value of a twin is a Scalar or a std::int32_t");
    return std::is_same_v<Pointee, Scalar> ? ParameterKind::real : ParameterKind::integer;
  }
}

template <class Scalar, class Parameter>
Parameter unpack(const ArgValue<Scalar>& value) {
  constexpr ParameterKind kind = parameter_kind<Scalar, Parameter>();
  if constexpr (kind == ParameterKind::reals) return value.reals;
  if constexpr (kind == ParameterKind::ints) return value.ints;
  if constexpr (kind == ParameterKind::real) return value.real;
  if constexpr (kind == ParameterKind::integer) return value.integer;
}

/// Wraps `void twin(Range, parameters...)`.
template <class Scalar, class... Parameters>
TwinFunction<Scalar> adapt(void (*twin)(Range, Parameters...)) {
  TwinFunction<Scalar> result;
  result.parameters = {parameter_kind<Scalar, Parameters>()...};
  result.call = [twin](Range range, const ArgValue<Scalar>* args) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { twin(range, unpack<Scalar, Parameters>(args[I])...); }
    (std::index_sequence_for<Parameters...>{});
  };
  return result;
}

}  // namespace pliant::ref
