// Twin of kernels/links/membrane_force.cl.
#include <algorithm>

#include "cpu_ref/elements/deformation.h"
#include "cpu_ref/minus.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {
namespace {

template <class Scalar>
struct Column {
  Scalar x, y, z;
};

template <class Scalar>
inline Scalar dot(const Column<Scalar>& a, const Column<Scalar>& b) {
  return dot3(a.x, b.x, a.y, b.y, a.z, b.z);
}

/// p a + q b, the first product rounded first.
template <class Scalar>
inline Column<Scalar> mixed(const Column<Scalar>& p, Scalar a, const Column<Scalar>& q, Scalar b) {
  return {std::fma(q.x, b, p.x * a), std::fma(q.y, b, p.y * a), std::fma(q.z, b, p.z * a)};
}

/// Displacements of the corners of a tile's triangles: [corner][component][triangle].
template <class Scalar>
using Corners = Scalar[3][3][PLIANT_TILE];

template <class Scalar>
void gather(const Scalar* link_u, const std::int32_t* points, Corners<Scalar>& u) {
  for (int a = 0; a < 3; ++a) {
    for (int e = 0; e < PLIANT_TILE; ++e) {
      const Scalar* texel = link_u + std::int64_t{4} * points[a * PLIANT_TILE + e];
      for (int c = 0; c < 3; ++c) u[a][c][e] = texel[c];
    }
  }
}

}  // namespace

template <class Scalar>
void membrane_force(Range range, const Scalar* link_u, const std::int32_t* membrane_points, const Scalar* membrane_data,
                    Scalar* link_force, Scalar stiffness, Scalar ratio, std::int32_t force_base) {
  for (std::int64_t tile = range.begin; tile < range.end; tile += PLIANT_TILE) {
    const Scalar* data = membrane_data + PLIANT_MEMBRANE_DATA_PLANES * tile;
    Corners<Scalar> u;
    gather(link_u, membrane_points + 3 * tile, u);
    Scalar f[PLIANT_MEMBRANE_FORCE_PLANES][PLIANT_TILE];  // local, so that no other array can alias it
    for (int e = 0; e < PLIANT_TILE; ++e) {
      const auto plane = [&](int k) { return data[k * PLIANT_TILE + e]; };
      const auto edge = [&](int a) {
        return Column<Scalar>{u[a][0][e] - u[0][0][e], u[a][1][e] - u[0][1][e], u[a][2][e] - u[0][2][e]};
      };
      const Column<Scalar> v1 = edge(1), v2 = edge(2);
      const Scalar b11 = plane(6), b12 = plane(7), b22 = plane(8);
      const Column<Scalar> g1{v1.x * b11, v1.y * b11, v1.z * b11}, g2 = mixed(v1, b12, v2, b22);
      const Column<Scalar> t1{plane(0), plane(1), plane(2)}, t2{plane(3), plane(4), plane(5)};
      const Scalar e11 = std::fma(Scalar(0.5), dot(g1, g1), dot(t1, g1)), e22 = std::fma(Scalar(0.5), dot(g2, g2), dot(t2, g2));
      const Scalar e12 = Scalar(0.5) * (dot(g1, g2) + (dot(t1, g2) + dot(t2, g1)));
      const Scalar c = stiffness * plane(9);
      const Scalar s11 = c * std::fma(ratio, e22, e11), s22 = c * std::fma(ratio, e11, e22),
                   s12 = c * ((Scalar(1) - ratio) * e12);
      const Column<Scalar> f1{std::fma(v1.x, b11, t1.x), std::fma(v1.y, b11, t1.y), std::fma(v1.z, b11, t1.z)};
      const Column<Scalar> f2{t2.x + g2.x, t2.y + g2.y, t2.z + g2.z};
      const Column<Scalar> p1 = mixed(f1, s11, f2, s12), p2 = mixed(f1, s12, f2, s22);
      const Column<Scalar> a1 = mixed(p1, b11, p2, b12), a2{p2.x * b22, p2.y * b22, p2.z * b22};
      f[3][e] = a1.x, f[4][e] = a1.y, f[5][e] = a1.z;
      f[6][e] = a2.x, f[7][e] = a2.y, f[8][e] = a2.z;
      f[0][e] = minus(std::fma(p2.x, b22, a1.x)), f[1][e] = minus(std::fma(p2.y, b22, a1.y)),
      f[2][e] = minus(std::fma(p2.z, b22, a1.z));
    }
    for (int a = 0; a < 3; ++a) {
      for (int e = 0; e < PLIANT_TILE; ++e) {
        Scalar* texel = link_force + 4 * (force_base + 3 * tile + a * PLIANT_TILE + e);
        for (int c = 0; c < 3; ++c) texel[c] = f[3 * a + c][e];
        texel[3] = 0;
      }
    }
  }
}

void register_membrane_force(Registry& registry) {
  registry.add("membrane_force", membrane_force<float>, membrane_force<double>);
}

}  // namespace pliant::ref
