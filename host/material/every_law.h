// Maps law enumerators to their structs. Private to host/material.
#pragma once
#include <fmt/format.h>

#include "material/host_laws.h"
#include "pliant/error.h"

namespace pliant {

/// Calls use(std::type_identity<laws::X>) for the law X.
template <class Use>
decltype(auto) with_law(Law law, Use&& use) {
  switch (law) {
#define PLIANT_CASE(stem, Type) \
  case Law::stem:               \
    return use(std::type_identity<laws::Type>());
    PLIANT_LAWS(PLIANT_CASE)
#undef PLIANT_CASE
  }
  throw Error(ErrorCode::internal, fmt::format("law {} is not in kernels/laws.h", static_cast<int>(law)));
}

/// Calls use(law) with the law of a material.
template <class Use>
decltype(auto) with_law(const Material& material, Use&& use) {
  return with_law(material.law, [&]<class Type>(std::type_identity<Type>) {
    if (material.parameters.size() != Type::info.parameters.size()) {
      throw Error(ErrorCode::internal,
                  fmt::format("a material of the law {} has {} parameters", Type::info.word, material.parameters.size()));
    }
    return use(Type(material.parameters.data()));
  });
}

}  // namespace pliant
