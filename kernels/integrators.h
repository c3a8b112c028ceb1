// The list of integrators. A row is the integrator's stem and the name of its types in C++. The stem names its files:
// kernels/integrate_STEM.cl, its twin cpu_ref/integrate_STEM.h and host/integrators/STEM.h with its properties. Its number,
// the define INTEGRATOR of a kernel, is its position in the list. cmake/PliantLists.cmake also reads this file, to generate
// the includes, which a macro cannot produce.
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
