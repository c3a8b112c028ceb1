// The list of material laws. A row is the law's stem and the name of its types in C++. The stem names its files:
// kernels/law_STEM.cl, its twin cpu_ref/law_STEM.h and host/material/law_STEM.h with its properties. Its number, the define
// LAW of a kernel, is its position in the list. cmake/PliantLists.cmake also reads this file, to generate the includes, which
// a macro cannot produce.
#pragma once

// clang-format off
#define PLIANT_LAWS(LAW) \
  LAW(neo_hookean, NeoHookean) \
  LAW(saint_venant_kirchhoff, SaintVenantKirchhoff) \
  LAW(isochoric_neo_hookean, IsochoricNeoHookean) \
  LAW(mooney_rivlin, MooneyRivlin) \
  LAW(yeoh, Yeoh) \
  LAW(stable_neo_hookean, StableNeoHookean)
// clang-format on

namespace pliant {

#define PLIANT_LAW_NAME(stem, Type) stem,
enum class Law { PLIANT_LAWS(PLIANT_LAW_NAME) };
#undef PLIANT_LAW_NAME

#define PLIANT_LAW_ONE(stem, Type) +1
inline constexpr int law_count = 0 PLIANT_LAWS(PLIANT_LAW_ONE);
#undef PLIANT_LAW_ONE

}  // namespace pliant
