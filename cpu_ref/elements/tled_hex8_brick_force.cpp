// Twin of kernels/elements/tled_hex8_brick_force.cl: a whole brick in plain arrays, one stage after the other. The kernel's
// header describes the butterfly and the order of the sums; the sums here have the same order.
#include <memory>

#include "cpu_ref/laws/law.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {
namespace {

constexpr int columns = PLIANT_BRICK_X, rows = PLIANT_BRICK_Y, layers = PLIANT_BRICK_Z;

template <class Scalar>
struct Vec3 {
  Scalar x, y, z;
};
template <class Scalar>
Vec3<Scalar> operator+(const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Scalar>
Vec3<Scalar> operator-(const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Scalar>
Vec3<Scalar> operator*(Scalar s, const Vec3<Scalar>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Scalar>
Vec3<Scalar> fma(Scalar s, const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return {std::fma(s, a.x, b.x), std::fma(s, a.y, b.y), std::fma(s, a.z, b.z)};
}

/// A cell face normal to z: sums (s) and differences (d) along x (first letter) and y (second letter).
template <class Scalar>
struct Face {
  Vec3<Scalar> ss, ds, sd, dd;
};

/// Displacements or forces of a brick between the stages.
template <class Scalar>
struct Work {
  Vec3<Scalar> u[layers + 1][rows + 1][columns + 1];
  Face<Scalar> faces[layers + 1][rows][columns];  ///< of displacements
  Face<Scalar> forces[layers + 1][rows][columns];
};

/// Loads the brick's nodes and the first ones of its upper neighbours.
template <class Scalar>
void load_nodes(const Scalar* node_u, const std::int32_t* neighbor, Work<Scalar>& work) {
  for (int z = 0; z <= layers; ++z) {
    for (int y = 0; y <= rows; ++y) {
      for (int x = 0; x <= columns; ++x) {
        const int side = (x == columns ? 1 : 0) + (y == rows ? 2 : 0) + (z == layers ? 4 : 0);
        const int local = ((z % layers) * rows + y % rows) * columns + x % columns;
        const Scalar* texel = node_u + 4 * (std::int64_t{neighbor[side]} * PLIANT_BRICK_NODES + local);
        work.u[z][y][x] = {texel[0], texel[1], texel[2]};
      }
    }
  }
}

template <class Scalar>
Face<Scalar> face_of(const Vec3<Scalar>& u00, const Vec3<Scalar>& u10, const Vec3<Scalar>& u01, const Vec3<Scalar>& u11) {
  const Vec3<Scalar> s0 = u00 + u10, s1 = u01 + u11, d0 = u10 - u00, d1 = u11 - u01;
  return {s0 + s1, d0 + d1, s1 - s0, d1 - d0};
}

/// Forces on the upper and lower face of one cell.
template <class LawType, class Scalar>
std::int32_t cell_forces(const Face<Scalar>& below, const Face<Scalar>& above, Scalar fill, const LawType& law, Scalar gradient,
                         Scalar volume, Scalar stiffness, Face<Scalar>& lower, Face<Scalar>& upper) {
  const Vec3<Scalar> mx = below.ds + above.ds, my = below.sd + above.sd, mxy = below.dd + above.dd;
  const Vec3<Scalar> mz = above.ss - below.ss, mxz = above.ds - below.ds, myz = above.sd - below.sd, mxyz = above.dd - below.dd;
  const Scalar own = fill > Scalar(0) ? gradient : Scalar(0);
  const auto scaled = [&](Scalar m) { return std::fma(own, m, Scalar(0)); };
  const Deformation<Scalar> d = deformation_of<Scalar>({scaled(mx.x), scaled(my.x), scaled(mz.x), scaled(mx.y), scaled(my.y),
                                                        scaled(mz.y), scaled(mx.z), scaled(my.z), scaled(mz.z)});
  const Mat3<Scalar> p = law.stress(d, fill * volume, law.pressure(d.j), is_low(law, d));
  const Scalar k = fill * stiffness;
  const Vec3<Scalar> qx{p.m00, p.m10, p.m20}, qy{p.m01, p.m11, p.m21}, qz{p.m02, p.m12, p.m22}, qxy = k * mxy;
  upper = {qz, fma(k, mxz, qx), fma(k, myz, qy), fma(k, mxyz, qxy)};
  lower = {Vec3<Scalar>{} - qz, fma(-k, mxz, qx), fma(-k, myz, qy), fma(-k, mxyz, qxy)};
  return fill > Scalar(0) ? fault_of(law, d) : no_fault;
}

/// Inverse butterflies along y and x for the rows of one plane of nodes.
template <class Scalar>
void write_plane(const Face<Scalar> (&forces)[rows][columns], int plane, Scalar* brick_force) {
  for (int y = 0; y <= rows; ++y) {
    const int row = plane * (rows + 1) + y;
    Scalar* out = brick_force + 3 * row * columns;
    Vec3<Scalar> left{Scalar(-0.0), Scalar(-0.0), Scalar(-0.0)};  // force of the cell to the left
    for (int x = 0; x < columns; ++x) {
      Vec3<Scalar> s, d;
      if (y > 0) {
        const Face<Scalar>& f = forces[y - 1][x];
        s = f.ss + f.sd;
        d = f.ds + f.dd;
      }
      if (y < rows) {
        const Face<Scalar>& f = forces[y][x];
        const Vec3<Scalar> own_s = f.ss - f.sd, own_d = f.ds - f.dd;
        s = y > 0 ? s + own_s : own_s;
        d = y > 0 ? d + own_d : own_d;
      }
      const Vec3<Scalar> sum = (s - d) + left;
      left = s + d;
      out[x] = sum.x;
      out[columns + x] = sum.y;
      out[2 * columns + x] = sum.z;
    }
    Scalar* last = brick_force + PLIANT_BRICK_FORCE_X16 + 3 * row;
    last[0] = left.x;
    last[1] = left.y;
    last[2] = left.z;
  }
}

}  // namespace

template <class Scalar, int Number>
void tled_hex8_brick_force(Range range, const Scalar* node_u, const std::int32_t* brick_neighbor,
                           const std::int32_t* brick_rows, const Scalar* brick_fill, Scalar* brick_force, std::int32_t* fault,
                           const Scalar* law_parameters, Scalar gradient, Scalar volume, Scalar stiffness,
                           std::int32_t first_brick, std::int32_t fault_base, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  const auto work = std::make_unique<Work<Scalar>>();
  for (std::int64_t brick = first_brick + range.begin; brick < first_brick + range.end; ++brick) {
    load_nodes(node_u, brick_neighbor + brick * PLIANT_BRICK_NEIGHBORS, *work);
    const auto& u = work->u;
    for (int z = 0; z <= layers; ++z) {
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
          work->faces[z][y][x] = face_of(u[z][y][x], u[z][y][x + 1], u[z][y + 1][x], u[z][y + 1][x + 1]);
        }
      }
    }
    for (int z = 0; z < layers; ++z) {  // on each plane, the cells below it come first
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
          const std::int64_t cell = brick * PLIANT_BRICK_NODES + (z * rows + y) * columns + x;
          Face<Scalar> lower{}, &plane = work->forces[z][y][x];
          work->forces[z + 1][y][x] = {};
          if ((brick_rows[2 * brick] >> (4 * z + y) & 1) != 0) {
            mark_fault(cell_forces(work->faces[z][y][x], work->faces[z + 1][y][x], brick_fill[cell], law, gradient, volume,
                                   stiffness, lower, work->forces[z + 1][y][x]),
                       step, fault[fault_base + cell]);
          }
          plane =
              z > 0 ? Face<Scalar>{plane.ss + lower.ss, plane.ds + lower.ds, plane.sd + lower.sd, plane.dd + lower.dd} : lower;
        }
      }
    }
    for (int z = 0; z <= layers; ++z) write_plane(work->forces[z], z, brick_force + brick * PLIANT_BRICK_FORCE);
  }
}

void register_tled_hex8_brick_force(Registry& registry) {
  registry.add_specialised<law_count>("tled_hex8_brick_force", {"LAW"},
                                      [](auto scalar, auto law) { return tled_hex8_brick_force<decltype(scalar), law()>; });
}

}  // namespace pliant::ref
