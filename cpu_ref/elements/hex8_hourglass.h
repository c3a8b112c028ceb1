// Twin of kernels/elements/hex8_hourglass.cl, which describes the computation.
#pragma once
#include <array>

#include "cpu_ref/elements/hex8.h"
#include "cpu_ref/minus.h"

namespace pliant::ref {

template <class Scalar>
using Vec3 = std::array<Scalar, 3>;
template <class Scalar>
using Modes = std::array<Scalar, 4>;  ///< xy, xz, yz, xyz

template <class Scalar>
inline Modes<Scalar> modes_of(const std::array<Scalar, 8>& v) {
  const Scalar s0 = v[0] + v[1], s1 = v[2] + v[3], s2 = v[4] + v[5], s3 = v[6] + v[7];
  const Scalar d0 = v[1] - v[0], d1 = v[3] - v[2], d2 = v[5] - v[4], d3 = v[7] - v[6];
  return {(d1 - d0) + (d3 - d2), (d2 - d0) + (d3 - d1), (s3 - s2) - (s1 - s0), (d3 - d2) - (d1 - d0)};
}

template <class Scalar>
inline std::array<Scalar, 8> modes_back(Scalar xy, Scalar xz, Scalar yz, Scalar xyz) {
  const Scalar sum = xy + xz, difference = xy - xz;
  const Scalar d0 = xyz - sum, d1 = difference - xyz, d2 = -difference - xyz, d3 = sum + xyz;
  return {yz - d0, yz + d0, -yz - d1, d1 - yz, -yz - d2, d2 - yz, yz - d3, yz + d3};
}

template <class Scalar>
inline Scalar dot3(const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return dot3(a[0], b[0], a[1], b[1], a[2], b[2]);
}

template <class Scalar>
inline Vec3<Scalar> scaled(Scalar s, const Vec3<Scalar>& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

/// a + s b
template <class Scalar>
inline Vec3<Scalar> add_times(const Vec3<Scalar>& a, Scalar s, const Vec3<Scalar>& b) {
  return {std::fma(s, b[0], a[0]), std::fma(s, b[1], a[1]), std::fma(s, b[2], a[2])};
}

/// a + m b
template <class Scalar>
inline Vec3<Scalar> add_product(const Vec3<Scalar>& a, const Mat3<Scalar>& m, const Vec3<Scalar>& b) {
  return {add_dot3(a[0], m.m00, b[0], m.m01, b[1], m.m02, b[2]), add_dot3(a[1], m.m10, b[0], m.m11, b[1], m.m12, b[2]),
          add_dot3(a[2], m.m20, b[0], m.m21, b[1], m.m22, b[2])};
}

/// m += a b^T
template <class Scalar>
inline void add_outer(Mat3<Scalar>& m, const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  m.m00 = std::fma(a[0], b[0], m.m00), m.m01 = std::fma(a[0], b[1], m.m01), m.m02 = std::fma(a[0], b[2], m.m02);
  m.m10 = std::fma(a[1], b[0], m.m10), m.m11 = std::fma(a[1], b[1], m.m11), m.m12 = std::fma(a[1], b[2], m.m12);
  m.m20 = std::fma(a[2], b[0], m.m20), m.m21 = std::fma(a[2], b[1], m.m21), m.m22 = std::fma(a[2], b[2], m.m22);
}

template <class Scalar>
using ByAxis = std::array<Modes<Scalar>, 3>;  ///< [axis][mode]

template <class Scalar>
inline ByAxis<Scalar> hourglass_strains(const ByAxis<Scalar>& p, Scalar k, Scalar fill, const HexRecord<Scalar, false>& data) {
  const Scalar dx = fill * data[45], dy = fill * data[46], dz = fill * data[47];
  const Scalar nxy = fill * data[48], nxz = fill * data[49], nyz = fill * data[50];
  const Scalar ax = data[51], ay = data[52], az = data[53], third = Scalar(1) / Scalar(3);
  const Scalar xz = fill * std::fma(ax, p[2][0], az * p[0][2]), yz = fill * std::fma(ay, p[2][0], az * p[1][1]);
  const Scalar xy = fill * std::fma(ax, p[1][1], ay * p[0][2]);
  ByAxis<Scalar> w;
  w[0][0] = std::fma(dx, p[0][0], nxz * p[2][2]);
  w[2][2] = std::fma(dz, p[2][2], nxz * p[0][0]);
  w[1][0] = std::fma(dy, p[1][0], nyz * p[2][1]);
  w[2][1] = std::fma(dz, p[2][1], nyz * p[1][0]);
  w[0][1] = std::fma(dx, p[0][1], nxy * p[1][2]);
  w[1][2] = std::fma(dy, p[1][2], nxy * p[0][1]);
  w[2][0] = std::fma(-k, p[2][0], std::fma(ax, xz, ay * yz));
  w[0][2] = std::fma(-k, p[0][2], std::fma(az, xz, ay * xy));
  w[1][1] = std::fma(-k, p[1][1], std::fma(az, yz, ax * xy));
  w[0][3] = third * dx * p[0][3];
  w[1][3] = third * dy * p[1][3];
  w[2][3] = third * dz * p[2][3];
  return w;
}

/// q: sum_c h_a,c u_c, replaced by dW/dq; adds dW/dH to the stress.
template <class Scalar>
inline void hourglass(std::array<Vec3<Scalar>, 4>& q, const Mat3<Scalar>& h, Mat3<Scalar>& stress, Scalar fill,
                      const HexRecord<Scalar, false>& data) {
  const Scalar k = fill * data[54];
  std::array<Vec3<Scalar>, 3> e, g;
  std::array<Vec3<Scalar>, 4> m;
  Vec3<Scalar> scale;
  ByAxis<Scalar> p;
  for (std::size_t a = 0; a < 4; ++a) {
    const auto at = 24 + 3 * static_cast<std::int64_t>(a);
    m[a] = {data[at], data[at + 1], data[at + 2]};
    q[a] = add_product(q[a], h, {-m[a][0], -m[a][1], -m[a][2]});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = 36 + 3 * static_cast<std::int64_t>(i);
    e[i] = {data[at], data[at + 1], data[at + 2]};
    const Vec3<Scalar> moved = add_product(e[i], h, e[i]);
    scale[i] = Scalar(2) / (Scalar(1) + dot3(moved, moved));
    g[i] = scaled(scale[i], moved);
    for (std::size_t a = 0; a < 4; ++a) p[i][a] = dot3(g[i], q[a]);
  }
  const ByAxis<Scalar> w = hourglass_strains(p, k, fill, data);
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3<Scalar> sum = scaled(w[i][0], q[0]);
    Scalar work = w[i][0] * p[i][0];
    for (std::size_t a = 1; a < 4; ++a) {
      sum = add_times(sum, w[i][a], q[a]);
      work = std::fma(w[i][a], p[i][a], work);
    }
    add_outer(stress, add_times(scaled(scale[i], sum), minus(work), g[i]), e[i]);
  }
  for (std::size_t a = 0; a < 4; ++a) {
    q[a] = scaled(k, q[a]);
    for (std::size_t i = 0; i < 3; ++i) q[a] = add_times(q[a], w[i][a], g[i]);
    add_outer(stress, {minus(q[a][0]), minus(q[a][1]), minus(q[a][2])}, m[a]);
  }
}

}  // namespace pliant::ref
