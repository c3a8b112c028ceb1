// Surface patches around contact points: for a lattice the face of half a cell, for a volume mesh a third of a triangle. The undeformed place with
// coordinates (a, b) is x + a t1 + b t2 of the contact point; it moves with the nodes by trilinear or linear weights. contact_patch: [tiles][34][16]
// six sides (p, q, r, m): inside where p a + q b < r; over a further distance m the weight of the area falls to zero [m], so that an edge passes from
// one patch to the next smoothly. Then, for a lattice: the point's position in its cell (3), t1 and t2 (3 each) [1/m] in cells, and 1; for a volume
// mesh zeros. Where more than half of a point hangs on nodes of the other side of a cut, or on held ones, the last is 2 and -2. t1, t2 and the gradients of the linear weights are in touch_surface.
#define PATCH_SIDES 6
#define PATCH_FAR 1e30f

// Whether nothing can part the cut on which a point may lie.
static inline int is_joined(__global const float* contact_patch, int i) {
  return fabs(contact_patch[POINT_BASE(i, PLIANT_PATCH) + (4 * PATCH_SIDES + 9) * PLIANT_TILE]) > 1.5f;
}

// A place on a patch.
typedef struct {
  float weight[8];       // weights of the nodes
  float4 now, moved;     // position after the trial step, and increment [m]
  float4 first, second;  // F t1, F t2 at the start of the step
} patch_place;

static inline patch_place place_on(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                                   __global const int* contact_node, __global const float* contact_weight,
                                   __global const float* touch_surface, __global const float* contact_patch, int i, float a, float b) {
  __global const float* surface = touch_surface + POINT_BASE(i, PLIANT_TOUCH_SURFACE);
  __global const float* cell = contact_patch + POINT_BASE(i, PLIANT_PATCH) + 4 * PATCH_SIDES * PLIANT_TILE;
  __global const int* node = contact_node + POINT_BASE(i, 8);
  __global const float* weight = contact_weight + POINT_BASE(i, 8);
  __global const float* rest = contact_rest + POINT_BASE(i, 4);
  const int trilinear = cell[9 * PLIANT_TILE] > 0.0f;
  const float4 at = fma((float4)(a), three(cell + 3 * PLIANT_TILE), fma((float4)(b), three(cell + 6 * PLIANT_TILE), three(cell)));
  const float4 t1 = three(surface + 16 * PLIANT_TILE), t2 = three(surface + 19 * PLIANT_TILE);
  patch_place p;
  p.moved = 0.0f;
  p.first = p.second = 0.0f;
  float4 u = 0.0f;
  for (int k = 0; k < 8; ++k) {
    float da = surface[k * PLIANT_TILE], db = surface[(8 + k) * PLIANT_TILE];
    float w = fma(a, da, fma(b, db, weight[k * PLIANT_TILE]));
    if (trilinear) {
      const float sx = k & 1 ? 1.0f : -1.0f, sy = k & 2 ? 1.0f : -1.0f, sz = k & 4 ? 1.0f : -1.0f;
      const float fx = k & 1 ? at.x : 1.0f - at.x, fy = k & 2 ? at.y : 1.0f - at.y, fz = k & 4 ? at.z : 1.0f - at.z;
      w = (fx * fy) * fz;
      da = fma(sx * cell[3 * PLIANT_TILE], fy * fz, fma(sy * cell[4 * PLIANT_TILE], fx * fz, (sz * cell[5 * PLIANT_TILE]) * (fx * fy)));
      db = fma(sx * cell[6 * PLIANT_TILE], fy * fz, fma(sy * cell[7 * PLIANT_TILE], fx * fz, (sz * cell[8 * PLIANT_TILE]) * (fx * fy)));
    }
    const float4 whole = vload4(node[k * PLIANT_TILE], node_u), moved = vload4(node[k * PLIANT_TILE], node_w), before = whole - moved;
    p.weight[k] = w;
    u = fma((float4)(w), whole, u);
    p.moved = fma((float4)(w), moved, p.moved);
    p.first = fma((float4)(da), before, p.first);
    p.second = fma((float4)(db), before, p.second);
  }
  p.now = fma((float4)(a), t1, fma((float4)(b), t2, three(rest))) + u;
  p.first = t1 + p.first;
  p.second = t2 + p.second;
  p.now.w = p.moved.w = p.first.w = p.second.w = 0.0f;
  return p;
}

// The tangent plane of a patch at a place, in a tool's frame.
typedef struct {
  float4 y, normal, dual_first, dual_second;
  int flat;  // false if the patch is degenerate
} patch_plane;

static inline patch_plane plane_of(patch_place p, __global const float* now) {
  patch_plane out;
  out.y = turned_back(now, (p.now - p.moved) - origin_of(now));
  const float4 first = turned_back(now, p.first), second = turned_back(now, p.second), across = cross3(first, second);
  const float area = sqrt(dot_xyz(across, across)), inverse = area > 0.0f ? 1.0f / area : 0.0f;
  out.normal = normalised(across.x, across.y, across.z, area);
  out.dual_first = cross3(second, out.normal) * inverse;
  out.dual_second = cross3(out.normal, first) * inverse;
  out.flat = area > 0.0f;
  return out;
}

// Distance of (a, b) from a region relative to the patch's margin m; negative inside.
static inline float beyond_region(__global const float* sides, float a, float b) {
  float most = -PATCH_FAR;
  for (int k = 0; k < PATCH_SIDES; ++k, sides += 4 * PLIANT_TILE) {
    const float out = fma(sides[0], a, fma(sides[PLIANT_TILE], b, -sides[2 * PLIANT_TILE])) / sides[3 * PLIANT_TILE];
    most = out > most ? out : most;
  }
  return most;
}
