// Dispatches from the kind of an element to its type.
#pragma once
#include <utility>

#include "elements/element_hex8.h"
#include "elements/element_hex8full.h"
#include "elements/element_tet4.h"
#include "elements/element_tet4anp.h"

namespace pliant {

/// Calls f(TYPE{}) with the element of this kind.
template <class F>
decltype(auto) with_element(ElementKind kind, const F& f) {
  switch (kind) {
#define PLIANT_ELEMENT_CASE(stem, type) \
  case ElementKind::stem:               \
    return f(type{});
    PLIANT_ELEMENTS(PLIANT_ELEMENT_CASE)
#undef PLIANT_ELEMENT_CASE
  }
  __builtin_unreachable();
}

inline std::vector<double> element_record(ElementKind kind, std::span<const Vec3d> x, const Material& material,
                                          const std::string& what) {
  return with_element(kind, [&](auto e) { return decltype(e)::record(x, material, what); });
}
/// The same for a cube of a lattice with this edge [m].
inline std::vector<double> element_cube_record(ElementKind kind, double edge, const Material& material,
                                               const std::string& what) {
  return with_element(kind, [&](auto e) { return decltype(e)::cube_record(edge, material, what); });
}
inline double element_volume(ElementKind kind, std::span<const double> record) {
  return with_element(kind, [&](auto e) { return decltype(e)::volume(record); });
}
inline ElementCost element_cost(ElementKind kind, double law, bool uniform) {
  return with_element(kind, [&](auto e) { return decltype(e)::cost(law, uniform); });
}
inline double element_frequency(ElementKind kind, std::span<const double> record, const Material& material) {
  return with_element(kind, [&](auto e) { return decltype(e)::frequency(record, material); });
}

}  // namespace pliant
