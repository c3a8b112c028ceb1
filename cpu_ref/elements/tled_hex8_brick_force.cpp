// Twin of kernels/elements/tled_hex8_brick_force.cl: a brick in plain arrays, plane after plane, the 16 columns of a row
// together. The kernel's header describes the butterfly and the order of the sums; the sums here have the same order.
#include <algorithm>

#include "cpu_ref/laws/law.h"
#include "cpu_ref/registry.h"
#include "cpu_ref/tile.h"

namespace pliant::ref {
namespace {

constexpr int columns = PLIANT_BRICK_X, rows = PLIANT_BRICK_Y, layers = PLIANT_BRICK_Z, planes = 3 * columns;

/// The x, y and z components of a row of nodes or cells.
template <class Scalar>
struct Vectors {
  Scalar v[planes];
};

/// A row of cell faces normal to z: sums (s) and differences (d) along x (first letter) and y (second letter).
template <class Scalar>
struct Faces {
  Vectors<Scalar> ss, ds, sd, dd;
};

/// Sums and differences of the neighbours along x in a row of nodes.
template <class Scalar>
struct Pairs {
  Vectors<Scalar> s, d;
};

/// Arrays of one brick. An index for y or z comes first.
template <class Scalar>
struct Work {
  Scalar u[rows + 1][3][columns + 1];      ///< displacements of a plane of nodes, with the first ones of the next brick
  Pairs<Scalar> pairs[rows + 1];           ///< of that plane
  Faces<Scalar> faces[layers + 1][rows];   ///< of displacements
  Faces<Scalar> forces[rows];              ///< on the plane below a layer of cells
  Faces<Scalar> pending[rows];             ///< on the plane above it
  Pairs<Scalar> sums[rows + 1];            ///< forces of a plane after the butterfly along y
  Scalar right[rows + 1][3][columns + 1];  ///< forces on the right of the cells that precede a node; -0 at x = 0
  Scalar dilation[columns];                ///< J - 1 of a row of cells
};

/// The rows of nodes (bit 5 z + y) at the rows of cells (bit 4 z + y).
std::int32_t rows_of_nodes(std::int32_t cells) {
  std::int32_t nodes = 0;
  for (int z = 0; z < layers; ++z) nodes |= (cells >> rows * z & 15) << (rows + 1) * z;
  return nodes | nodes << 1 | nodes << (rows + 1) | nodes << (rows + 2);
}

/// Displacements of plane z of the nodes, and their sums and differences along x.
template <class Scalar>
void load_plane(const Scalar* node_u, const std::int32_t* neighbor, int z, std::int32_t used, Work<Scalar>& work) {
  for (int y = 0; y <= rows; ++y) {
    if ((used >> y & 1) == 0) continue;
    const int side = (y == rows ? 2 : 0) + (z == layers ? 4 : 0), row = ((z % layers) * rows + y % rows) * columns;
    const Scalar* own = node_u + 4 * (std::int64_t{neighbor[side]} * PLIANT_BRICK_NODES + row);
    const Scalar* next = node_u + 4 * (std::int64_t{neighbor[side + 1]} * PLIANT_BRICK_NODES + row);
    auto& u = work.u[y];
#pragma GCC unroll 1
    for (int x = 0; x < columns; ++x) {
      u[0][x] = own[4 * x];
      u[1][x] = own[4 * x + 1];
      u[2][x] = own[4 * x + 2];
    }
    for (int c = 0; c < 3; ++c) u[c][columns] = next[c];
  }
  for (int y = 0; y <= rows; ++y) {
    if ((used >> y & 1) == 0) continue;
    for (int c = 0; c < 3; ++c) {
      const Scalar* u = work.u[y][c];
#pragma GCC unroll 1
      for (int x = 0; x < columns; ++x) {
        work.pairs[y].s.v[columns * c + x] = u[x] + u[x + 1];
        work.pairs[y].d.v[columns * c + x] = u[x + 1] - u[x];
      }
    }
  }
}

/// Sums and differences along y of two rows of nodes.
template <class Scalar>
void make_faces(const Pairs<Scalar>& low, const Pairs<Scalar>& high, Faces<Scalar>& faces) {
  for (int k = 0; k < planes; ++k) {
    const Scalar s0 = low.s.v[k], s1 = high.s.v[k], d0 = low.d.v[k], d1 = high.d.v[k];
    faces.ss.v[k] = s0 + s1;
    faces.ds.v[k] = d0 + d1;
    faces.sd.v[k] = s1 - s0;
    faces.dd.v[k] = d1 - d0;
  }
}

/// The force that waits on the plane above a layer takes the place of that on the plane below it.
template <class Scalar>
[[gnu::always_inline]] inline void pass_on(Scalar lower, Scalar upper, Scalar& below, Scalar& above) {
  below = above + lower;
  above = upper;
}

/// A row of cells: adds its forces to those that wait on the plane below, and leaves in their place those on the plane above.
template <class LawType, class Scalar>
void cell_row(int z, int y, const Scalar* fill, const LawType& law, Scalar gradient, Scalar volume, Scalar stiffness,
              Work<Scalar>& work) {
  const Faces<Scalar>&below = work.faces[z][y], &above = work.faces[z + 1][y];
  Faces<Scalar>&forces = work.forces[y], &pending = work.pending[y];
  for (int x = 0; x < columns; ++x) {
    const Scalar own = fill[x] > Scalar(0) ? gradient : Scalar(0), k = fill[x] * stiffness;
    const auto mx = [&](int i) { return std::fma(own, below.ds.v[i] + above.ds.v[i], Scalar(0)); };
    const auto my = [&](int i) { return std::fma(own, below.sd.v[i] + above.sd.v[i], Scalar(0)); };
    const auto mz = [&](int i) { return std::fma(own, above.ss.v[i] - below.ss.v[i], Scalar(0)); };
    const int i0 = x, i1 = columns + x, i2 = 2 * columns + x;
    const Deformation<Scalar> d =
        deformation_of<Scalar>({mx(i0), my(i0), mz(i0), mx(i1), my(i1), mz(i1), mx(i2), my(i2), mz(i2)});
    work.dilation[x] = d.j;
    const Mat3<Scalar> p = law.stress(d, fill[x] * volume, law.pressure(d.j), is_low(law, d));
    const auto add = [&](int i, Scalar qx, Scalar qy, Scalar qz) __attribute__((always_inline)) {
      const Scalar mxz = above.ds.v[i] - below.ds.v[i], myz = above.sd.v[i] - below.sd.v[i];
      const Scalar mxyz = above.dd.v[i] - below.dd.v[i], qxy = k * (below.dd.v[i] + above.dd.v[i]);
      pass_on(Scalar(0) - qz, qz, forces.ss.v[i], pending.ss.v[i]);
      pass_on(std::fma(-k, mxz, qx), std::fma(k, mxz, qx), forces.ds.v[i], pending.ds.v[i]);
      pass_on(std::fma(-k, myz, qy), std::fma(k, myz, qy), forces.sd.v[i], pending.sd.v[i]);
      pass_on(std::fma(-k, mxyz, qxy), std::fma(k, mxyz, qxy), forces.dd.v[i], pending.dd.v[i]);
    };
    add(i0, p.m00, p.m01, p.m02);
    add(i1, p.m10, p.m11, p.m12);
    add(i2, p.m20, p.m21, p.m22);
  }
}

/// A row without cells.
template <class Scalar>
void empty_row(Faces<Scalar>& forces, Faces<Scalar>& pending) {
  for (int k = 0; k < planes; ++k) {
    pass_on(Scalar(0), Scalar(0), forces.ss.v[k], pending.ss.v[k]);
    pass_on(Scalar(0), Scalar(0), forces.ds.v[k], pending.ds.v[k]);
    pass_on(Scalar(0), Scalar(0), forces.sd.v[k], pending.sd.v[k]);
    pass_on(Scalar(0), Scalar(0), forces.dd.v[k], pending.dd.v[k]);
  }
}

/// Inverse butterflies along y and x for the rows of one plane of nodes.
template <class Scalar>
void write_plane(const Faces<Scalar> (&forces)[rows], int plane, std::int32_t used, Work<Scalar>& work, Scalar* brick_force) {
  for (int y = 0; y <= rows; ++y) {
    if ((used >> y & 1) == 0) continue;
    Vectors<Scalar>&s = work.sums[y].s, &d = work.sums[y].d;
    for (int k = 0; k < planes; ++k) {
      s.v[k] = y > 0 ? forces[y - 1].ss.v[k] + forces[y - 1].sd.v[k] : Scalar(-0.0);
      d.v[k] = y > 0 ? forces[y - 1].ds.v[k] + forces[y - 1].dd.v[k] : Scalar(-0.0);
    }
    for (int k = 0; y < rows && k < planes; ++k) {
      s.v[k] += forces[y].ss.v[k] - forces[y].sd.v[k];
      d.v[k] += forces[y].ds.v[k] - forces[y].dd.v[k];
    }
    for (int c = 0; c < 3; ++c) {
#pragma GCC unroll 1
      for (int x = 0; x < columns; ++x) work.right[y][c][x + 1] = s.v[columns * c + x] + d.v[columns * c + x];
    }
  }
  for (int y = 0; y <= rows; ++y) {
    const int row = plane * (rows + 1) + y;
    if ((used >> y & 1) == 0) {
      std::fill_n(brick_force + row * planes, planes, Scalar(0));
      std::fill_n(brick_force + PLIANT_BRICK_FORCE_X16 + 3 * row, 3, Scalar(0));
      continue;
    }
    const Vectors<Scalar>&s = work.sums[y].s, &d = work.sums[y].d;
    for (int c = 0; c < 3; ++c) {
      const Scalar* right = work.right[y][c];
      Scalar* out = brick_force + (3 * row + c) * columns;
#pragma GCC unroll 1
      for (int x = 0; x < columns; ++x) out[x] = (s.v[columns * c + x] - d.v[columns * c + x]) + right[x];
      brick_force[PLIANT_BRICK_FORCE_X16 + 3 * row + c] = right[columns];
    }
  }
}

/// A brick; `fill` and `fault` of its cells.
template <class LawType, class Scalar>
void brick(const Scalar* node_u, const std::int32_t* neighbor, std::int32_t cells, const Scalar* fill, Scalar* brick_force,
           std::int32_t* fault, const LawType& law, Scalar gradient, Scalar volume, Scalar stiffness, std::int32_t step,
           Work<Scalar>& work) {
  const std::int32_t nodes = rows_of_nodes(cells);
  for (int z = 0; z <= layers; ++z) {
    const std::int32_t used = nodes >> (rows + 1) * z;
    load_plane(node_u, neighbor, z, used, work);
    for (int y = 0; y < rows; ++y) {
      if ((used >> y & 3) == 3) make_faces(work.pairs[y], work.pairs[y + 1], work.faces[z][y]);
    }
  }
  std::fill_n(&work.pending[0].ss.v[0], rows * 4 * planes, Scalar(-0.0));  // -0 + x is x, whatever its sign
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < rows; ++y) {
      const int row = rows * z + y;
      if ((cells >> row & 1) != 0) {
        cell_row(z, y, fill + row * columns, law, gradient, volume, stiffness, work);
        mark_faults(law, work.dilation, fill + row * columns, 0, columns, step, fault + row * columns);
      } else if (((nodes >> (rows + 1) * z | nodes >> (rows + 1) * (z + 1)) >> y & 3) != 0) {  // else nothing reads them
        empty_row(work.forces[y], work.pending[y]);
      }
    }
    write_plane(work.forces, z, nodes >> (rows + 1) * z, work, brick_force);
  }
  write_plane(work.pending, layers, nodes >> (rows + 1) * layers, work, brick_force);
}

}  // namespace

template <class Scalar, int Number>
void tled_hex8_brick_force(Range range, const Scalar* node_u, const std::int32_t* brick_neighbor,
                           const std::int32_t* brick_rows, const Scalar* brick_fill, Scalar* brick_force, std::int32_t* fault,
                           const Scalar* law_parameters, Scalar gradient, Scalar volume, Scalar stiffness,
                           std::int32_t first_brick, std::int32_t fault_base, std::int32_t step) {
  const MaterialLaw<Number, Scalar> law(law_parameters);
  Work<Scalar> work;
  for (auto& row : work.right) {
    for (Scalar(&right)[columns + 1] : row) right[0] = Scalar(-0.0);
  }
  for (std::int64_t b = first_brick + range.begin; b < first_brick + range.end; ++b) {
    const std::int64_t cell = b * PLIANT_BRICK_NODES;
    brick(node_u, brick_neighbor + b * PLIANT_BRICK_NEIGHBORS, brick_rows[2 * b], brick_fill + cell,
          brick_force + b * PLIANT_BRICK_FORCE, fault + fault_base + cell, law, gradient, volume, stiffness, step, work);
  }
}

void register_tled_hex8_brick_force(Registry& registry) {
  registry.add_specialised<law_count>("tled_hex8_brick_force", {"LAW"},
                                      [](auto scalar, auto law) { return tled_hex8_brick_force<decltype(scalar), law()>; });
}

}  // namespace pliant::ref
