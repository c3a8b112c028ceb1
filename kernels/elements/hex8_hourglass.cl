// Hourglass control of a general hexahedron, from the strains of its hourglass modes in bending and twisting.
//
// With h_a the products of two or three corner signs (a = xy, xz, yz, xyz), X the corners at rest, u their displacements and
// m_a = sum_c h_a,c X_c [m], the hourglass displacements are q_a = sum_c h_a,c u_c - H m_a: 0 for every linear field (Flanagan and
// Belytschko 1981, their gamma written out). Their components are taken along the element's axes e_i as rotated by the mean deformation F = I + H:
// G_i = F e_i, scaled towards length 1: g_i = 2 / (1 + |G_i|^2) G_i, p_ia = g_i . q_a. So p is invariant under rigid rotation.
//
// W = k/2 sum_a |q_a|^2 + sum_ia D_i' p_ia^2 / 2 (a third of it for xyz) + N_ij p_i p_j + shears^2 / 2: in each direction of the element the energy
// of a plate in plane stress, bent about both axes and twisted. The shear that bending causes in a trilinear field and the volume change are omitted
// to avoid locking (Belytschko and Bindeman 1993 assume such strains). host/elements/hourglass.h derives the coefficients. The force is the exact
// derivative of W, including that of g_i with respect to F.
//
// Planes of the record: m_a [4][3] from 24 on, e_i [3][3] from 36 on, D' [3] 45, N (xy, xz, yz) 48, A [3] 51, k 54.
typedef struct {
  real x, y, z;
} vec3;
typedef struct {
  real xy, xz, yz, xyz;
} modes;
#define RECORD(k) LOAD(data, (k)*PLIANT_TILE)

// sum_c h_a,c v_c of one component, first along x, then y and z.
static inline modes modes_of(const real* v) {
  const real s0 = v[0] + v[1], s1 = v[2] + v[3], s2 = v[4] + v[5], s3 = v[6] + v[7];
  const real d0 = v[1] - v[0], d1 = v[3] - v[2], d2 = v[5] - v[4], d3 = v[7] - v[6];
  const modes r = {(d1 - d0) + (d3 - d2), (d2 - d0) + (d3 - d1), (s3 - s2) - (s1 - s0), (d3 - d2) - (d1 - d0)};
  return r;
}

// v_c = sum_a h_a,c r_a of one component.
static inline void modes_back(modes r, real* v) {
  const real sum = r.xy + r.xz, difference = r.xy - r.xz;
  const real d0 = r.xyz - sum, d1 = difference - r.xyz, d2 = -difference - r.xyz, d3 = sum + r.xyz;
  v[0] = r.yz - d0;
  v[1] = r.yz + d0;
  v[2] = -r.yz - d1;
  v[3] = d1 - r.yz;
  v[4] = -r.yz - d2;
  v[5] = d2 - r.yz;
  v[6] = r.yz - d3;
  v[7] = r.yz + d3;
}

static inline real dot3(vec3 a, vec3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }
// a + s b
static inline vec3 add_times(vec3 a, real s, vec3 b) {
  const vec3 r = {fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z)};
  return r;
}
// a + m b
static inline vec3 add_product(vec3 a, mat3 m, vec3 b) {
  const vec3 r = {fma(m.m02, b.z, fma(m.m01, b.y, fma(m.m00, b.x, a.x))), fma(m.m12, b.z, fma(m.m11, b.y, fma(m.m10, b.x, a.y))),
                  fma(m.m22, b.z, fma(m.m21, b.y, fma(m.m20, b.x, a.z)))};
  return r;
}
// m + a b^T
static inline mat3 add_outer(mat3 m, vec3 a, vec3 b) {
  const mat3 r = {fma(a.x, b.x, m.m00), fma(a.x, b.y, m.m01), fma(a.x, b.z, m.m02), fma(a.y, b.x, m.m10), fma(a.y, b.y, m.m11),
                  fma(a.y, b.z, m.m12), fma(a.z, b.x, m.m20), fma(a.z, b.y, m.m21), fma(a.z, b.z, m.m22)};
  return r;
}

// dW/dp from p, both [axis][mode].
static inline void hourglass_strains(const real (*p)[4], real k, real fill, __global const float* data, real (*w)[4]) {
  const real dx = fill * RECORD(45), dy = fill * RECORD(46), dz = fill * RECORD(47);
  const real nxy = fill * RECORD(48), nxz = fill * RECORD(49), nyz = fill * RECORD(50);
  const real ax = RECORD(51), ay = RECORD(52), az = RECORD(53), third = 1.0f / 3.0f;
  w[0][0] = fma(dx, p[0][0], nxz * p[2][2]);  // bending along y, ...
  w[2][2] = fma(dz, p[2][2], nxz * p[0][0]);
  w[1][0] = fma(dy, p[1][0], nyz * p[2][1]);  // along x
  w[2][1] = fma(dz, p[2][1], nyz * p[1][0]);
  w[0][1] = fma(dx, p[0][1], nxy * p[1][2]);  // along z
  w[1][2] = fma(dy, p[1][2], nxy * p[0][1]);
  const real xz = fill * fma(ax, p[2][0], az * p[0][2]), yz = fill * fma(ay, p[2][0], az * p[1][1]);
  const real xy = fill * fma(ax, p[1][1], ay * p[0][2]);
  w[2][0] = fma(-k, p[2][0], fma(ax, xz, ay * yz));
  w[0][2] = fma(-k, p[0][2], fma(az, xz, ay * xy));
  w[1][1] = fma(-k, p[1][1], fma(az, yz, ax * xy));
  w[0][3] = third * dx * p[0][3];
  w[1][3] = third * dy * p[1][3];
  w[2][3] = third * dz * p[2][3];
}

// q: sum_c h_a,c u_c [4], replaced by dW/dq. Returns the stress with dW/dH added, all times fill.
static inline mat3 hourglass(vec3* q, mat3 h, mat3 stress, real fill, __global const float* data) {
  const real k = fill * RECORD(54), one = 1.0f, two = 2.0f;
  vec3 e[3], g[3];
  real scale[3], p[3][4], w[3][4];
#pragma unroll
  for (int a = 0; a < 4; ++a) {
    const vec3 minus = {-RECORD(24 + 3 * a), -RECORD(25 + 3 * a), -RECORD(26 + 3 * a)};
    q[a] = add_product(q[a], h, minus);
  }
#pragma unroll
  for (int i = 0; i < 3; ++i) {
    e[i].x = RECORD(36 + 3 * i);
    e[i].y = RECORD(37 + 3 * i);
    e[i].z = RECORD(38 + 3 * i);
    const vec3 moved = add_product(e[i], h, e[i]);
    scale[i] = two / (one + dot3(moved, moved));
    g[i].x = scale[i] * moved.x;
    g[i].y = scale[i] * moved.y;
    g[i].z = scale[i] * moved.z;
#pragma unroll
    for (int a = 0; a < 4; ++a) p[i][a] = dot3(g[i], q[a]);
  }
  hourglass_strains(p, k, fill, data, w);
#pragma unroll
  for (int i = 0; i < 3; ++i) {  // dW/dG_i = scale sum_a w_ia q_a - (sum_a w_ia p_ia) g_i
    vec3 sum = {w[i][0] * q[0].x, w[i][0] * q[0].y, w[i][0] * q[0].z};
    real work = w[i][0] * p[i][0];
#pragma unroll
    for (int a = 1; a < 4; ++a) {
      sum = add_times(sum, w[i][a], q[a]);
      work = fma(w[i][a], p[i][a], work);
    }
    const vec3 scaled = {scale[i] * sum.x, scale[i] * sum.y, scale[i] * sum.z};
    stress = add_outer(stress, add_times(scaled, -work, g[i]), e[i]);
  }
#pragma unroll
  for (int a = 0; a < 4; ++a) {
    vec3 force = {k * q[a].x, k * q[a].y, k * q[a].z};
#pragma unroll
    for (int i = 0; i < 3; ++i) force = add_times(force, w[i][a], g[i]);
    q[a] = force;
    const vec3 minus = {-force.x, -force.y, -force.z}, m = {RECORD(24 + 3 * a), RECORD(25 + 3 * a), RECORD(26 + 3 * a)};
    stress = add_outer(stress, minus, m);
  }
  return stress;
}
