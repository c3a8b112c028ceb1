// The integrators: the one list of them. A row is the integrator's stem and the name of its types in C++. The stem names its
// files: kernels/integrate_STEM.cl, its twin cpu_ref/integrate_STEM.h and host/integrators/STEM.h, which says what it stores
// and allows. Its number, the define INTEGRATOR of a kernel, is its place here. cmake/PliantLists.cmake reads this file too,
// for what cannot be said with a macro: the includes.
#pragma once

// clang-format off
#define PLIANT_INTEGRATORS(INTEGRATOR) \
  INTEGRATOR(increment, Increment) \
  INTEGRATOR(textbook, Textbook) \
  INTEGRATOR(forward_euler, ForwardEuler)
// clang-format on

namespace pliant {

#define PLIANT_INTEGRATOR_NAME(stem, Type) stem,
enum class Integrator { PLIANT_INTEGRATORS(PLIANT_INTEGRATOR_NAME) };
#undef PLIANT_INTEGRATOR_NAME

#define PLIANT_INTEGRATOR_ONE(stem, Type) +1
inline constexpr int integrator_count = 0 PLIANT_INTEGRATORS(PLIANT_INTEGRATOR_ONE);
#undef PLIANT_INTEGRATOR_ONE

}  // namespace pliant
