// Arithmetic on wrenches, and their conversion to the structs of C and of the wire.
#pragma once
#include <algorithm>

#include "geometry/vec.h"
#include "pliant/wrench.h"

namespace pliant {

inline Wrench scaled(const Wrench& w, double by) { return {vec::mul(w.force, by), vec::mul(w.torque, by)}; }
inline Wrench plus(const Wrench& a, const Wrench& b) { return {vec::add(a.force, b.force), vec::add(a.torque, b.torque)}; }
inline Wrench minus(const Wrench& a, const Wrench& b) { return {vec::sub(a.force, b.force), vec::sub(a.torque, b.torque)}; }

/// Copies to a struct with arrays `force` and `torque`.
template <class CStruct>
void copy_wrench(const Wrench& from, CStruct& to) {
  std::copy(from.force.begin(), from.force.end(), to.force);
  std::copy(from.torque.begin(), from.torque.end(), to.torque);
}

}  // namespace pliant
