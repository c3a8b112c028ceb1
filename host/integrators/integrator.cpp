#include "integrators/integrator.h"

#include "integrators/host_integrators.h"

namespace pliant {

const IntegratorInfo& integrator_info(Integrator integrator) {
#define PLIANT_INFO(stem, Type) integrators::Type::info,
  static constexpr IntegratorInfo infos[]{PLIANT_INTEGRATORS(PLIANT_INFO)};
#undef PLIANT_INFO
  return infos[static_cast<int>(integrator)];
}

std::span<const Integrator, integrator_count> all_integrators() {
#define PLIANT_INTEGRATOR(stem, Type) Integrator::stem,
  static constexpr Integrator all[integrator_count]{PLIANT_INTEGRATORS(PLIANT_INTEGRATOR)};
#undef PLIANT_INTEGRATOR
  return all;
}

std::string integrators_with(bool IntegratorInfo::*property) {
  std::string list, last;
  for (const Integrator i : all_integrators()) {
    if (!(integrator_info(i).*property)) continue;
    if (!last.empty()) list += (list.empty() ? "" : ", ") + last;
    last = integrator_info(i).word;
  }
  return list.empty() ? last : list + " or " + last;
}

}  // namespace pliant
