// Maps kernels to their twins.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cpu_ref/twin.h"

namespace pliant::ref {

using Defines = std::vector<std::pair<std::string, int>>;

/// The float and double instantiations of a twin.
struct Twin {
  TwinFunction<float> of_float;
  TwinFunction<double> of_double;
};

class Registry {
 public:
  /// Returns the twin for the defines of a pass.
  using Factory = std::function<Twin(const Defines&)>;

  void add(const std::string& stem, Factory factory) { factories_[stem] = std::move(factory); }

  /// A kernel without defines: add("node_update", node_update<float>, node_update<double>).
  template <class... F, class... D>
  void add(const std::string& stem, void (*of_float)(Range, F...), void (*of_double)(Range, D...)) {
    add(stem, [=](const Defines& defines) {
      require_names(stem, defines, {});
      return Twin{adapt<float>(of_float), adapt<double>(of_double)};
    });
  }

  /// A kernel specialised by defines; Counts are the numbers of values, which run from 0:
  ///   add_specialised<3, 2>("tled_tet4_force", {"LAW", "FORCE_ONLY"}, [](auto scalar, auto law, auto force_only) {
  ///     return tled_tet4_force<decltype(scalar), law, force_only>;
  ///   });
  template <int... Counts, class Select>
  void add_specialised(const std::string& stem, const std::array<const char*, sizeof...(Counts)>& names, Select select) {
    add(stem, [=](const Defines& defines) {
      require_names(stem, defines, {names.begin(), names.end()});
      return choose<Counts...>(stem, defines, names.data(), select);
    });
  }

  /// Throws Error (internal) that names an unknown stem, an unknown or missing define, or a value out of range.
  [[nodiscard]] Twin find(const std::string& stem, const Defines& defines) const;
  [[nodiscard]] std::vector<std::string> stems() const;

 private:
  static void require_names(const std::string& stem, const Defines& defines, const std::vector<std::string>& names);
  static int require_value(const std::string& stem, const Defines& defines, const char* name, int count);

  /// Converts the run-time values of the defines to compile-time constants, one define after the other.
  template <int Count, int... Rest, class Select, class... Chosen>
  static Twin choose(const std::string& stem, const Defines& defines, const char* const* names, Select select,
                     Chosen... chosen) {
    const int value = require_value(stem, defines, names[0], Count);
    Twin twin;
    [&]<int... V>(std::integer_sequence<int, V...>) {
      const auto attempt = [&](auto candidate) {
        if (candidate() != value) return;
        if constexpr (sizeof...(Rest) > 0) {
          twin = choose<Rest...>(stem, defines, names + 1, select, chosen..., candidate);
        } else {
          twin = {adapt<float>(select(float{}, chosen..., candidate)), adapt<double>(select(double{}, chosen..., candidate))};
        }
      };
      (attempt(std::integral_constant<int, V>{}), ...);
    }
    (std::make_integer_sequence<int, Count>{});
    return twin;
  }

  std::map<std::string, Factory> factories_;
};

/// All twins of kernels/.
const Registry& registry();

}  // namespace pliant::ref
