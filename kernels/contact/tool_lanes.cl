// LANES contact points and a tool (contact_shape.cl, contact_point.cl): the same operations in the same order as for a point alone.
#include "contact_lanes.cl"

// A signed distance and the outward normal (tool_distance), in the tool's frame.
typedef struct {
  vec3 normal;
  real distance;
} tool_gaps;

// From a sphere (0) or capsule (1).
INLINE tool_gaps round_gaps(int kind, __global const float* data, vec3 y) {
  vec3 from = y;
  if (kind == 1) {
    const real none = 0.0f, one = 1.0f;
    const float ex = data[4] - data[1], ey = data[5] - data[2], ez = data[6] - data[3], length = dot3(ex, ex, ey, ey, ez, ez);
    const vec3 along = {SAME(ex), SAME(ey), SAME(ez)}, f = {y.x - data[1], y.y - data[2], y.z - data[3]};
    const real t = dot_lanes(f, along) / length, s = t > 0.0f ? (t < 1.0f ? t : one) : none;
    from = times_add(-s, along, f);
  }
  const real length = sqrt(dot_lanes(from, from));
  const tool_gaps out = {over(from, length), length - data[0]};
  return out;
}

INLINE tool_gaps box_gaps(__global const float* data, vec3 y) {
  const real none = 0.0f, one = 1.0f;
  const vec3 q = {fabs(y.x) - data[4], fabs(y.y) - data[5], fabs(y.z) - data[6]};
  const vec3 p = {q.x > 0.0f ? q.x : none, q.y > 0.0f ? q.y : none, q.z > 0.0f ? q.z : none};
  const real length = sqrt(dot_lanes(p, p));
  const integer outside = length > 0.0f, in_x = q.x >= q.y && q.x >= q.z, in_y = !in_x && q.y >= q.z;  // inside: the nearest face
  const vec3 face = {in_x ? one : none, in_y ? one : none, in_x || in_y ? none : one}, to = where(outside, p, face);
  const vec3 away = {copysign(to.x, y.x), copysign(to.y, y.y), copysign(to.z, y.z)};
  const tool_gaps out = {over(away, outside ? length : one), outside ? length : (in_x ? q.x : (in_y ? q.y : q.z))};
  return out;
}

// From any tool: of a mesh each of the lanes that are `wanted` reads its own grid nodes. (The shapes are those of tool_distance, contact_shape.cl.)
INLINE tool_gaps gaps_of_tool(__global const int* kind, __global const float* data, __global const float* tool_grid, __global const float* moment,
                              integer wanted, vec3 y) {
  if (kind[0] == 0 || kind[0] == 1) return round_gaps(kind[0], data, y);
  if (kind[0] == 2 || kind[0] == FACE_OF_BLADE) return box_gaps(data, y);
  if (kind[0] == 3) {
    const vec3 normal = {SAME(data[4]), SAME(data[5]), SAME(data[6])}, from = {y.x - data[1], y.y - data[2], y.z - data[3]};
    const tool_gaps plane = {normal, dot_lanes(from, normal)};
    return plane;
  }
  const real none = 0.0f, one = 1.0f;
  tool_gaps out = {{none, none, one}, none};
  for (int l = 0; l < LANES; ++l) {
    if (!LANE_INT(wanted, l)) continue;
    const float4 found = mesh_distance(kind, data, tool_grid, moment, (float4)(LANE(y.x, l), LANE(y.y, l), LANE(y.z, l), 0.0f));
    SET_LANE(out.normal.x, l, found.x);
    SET_LANE(out.normal.y, l, found.y);
    SET_LANE(out.normal.z, l, found.z);
    SET_LANE(out.distance, l, found.w);
  }
  return out;
}

// R v of a pose, and its transpose.
INLINE vec3 turned_lanes(__global const float* r, vec3 v) {
  const vec3 x = {SAME(r[0]), SAME(r[1]), SAME(r[2])}, y = {SAME(r[3]), SAME(r[4]), SAME(r[5])}, z = {SAME(r[6]), SAME(r[7]), SAME(r[8])};
  const vec3 out = {dot_lanes(x, v), dot_lanes(y, v), dot_lanes(z, v)};
  return out;
}
INLINE vec3 turned_back_lanes(__global const float* r, vec3 v) {
  const vec3 x = {SAME(r[0]), SAME(r[3]), SAME(r[6])}, y = {SAME(r[1]), SAME(r[4]), SAME(r[7])}, z = {SAME(r[2]), SAME(r[5]), SAME(r[8])};
  const vec3 out = {dot_lanes(x, v), dot_lanes(y, v), dot_lanes(z, v)};
  return out;
}
INLINE vec3 less_origin(vec3 x, __global const float* pose) {
  const vec3 out = {x.x - pose[9], x.y - pose[10], x.z - pose[11]};
  return out;
}

// contact_place of LANES points.
typedef struct {
  vec3 now, moved;
} point_lanes;
INLINE point_lanes places_of_points(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                                    __global const int* contact_node, __global const float* contact_weight, int first) {
  __global const int* node = contact_node + POINT_BASE(first, 8);
  __global const float* weight = contact_weight + POINT_BASE(first, 8);
  const real none = 0.0f;
  vec3 u = {none, none, none}, w = u;
  for (int a = 0; a < 8; ++a) {
    const real c = LOAD(weight, a * PLIANT_TILE);
    u = times_add(c, xyz(texels_gather(node_u, node + a * PLIANT_TILE)), u);
    w = times_add(c, xyz(texels_gather(node_w, node + a * PLIANT_TILE)), w);
  }
  const vec3 rest = load3(contact_rest + POINT_BASE(first, 4));
  const point_lanes out = {{rest.x + u.x, rest.y + u.y, rest.z + u.z}, w};
  return out;
}

// meeting (contact_point.cl) of the LANES points that are `wanted`.
typedef struct {
  real distance, opening;
  vec3 normal, slip, inside;
} meetings;
INLINE meetings meet_lanes(__global const int* tool_kind, __global const float* tool_data, __global const float* tool_grid,
                           __global const float* tool_pose, int tools, int step, int t, integer wanted, point_lanes p) {
  __global const float* now = tool_pose + POSE_NUMBERS * (step * tools + t);
  __global const float* next = now + POSE_NUMBERS * tools;
  __global const int* kind = tool_kind + TOOL_INTEGERS * t;
  __global const float* data = tool_data + TOOL_NUMBERS * t;
  const vec3 start = turned_back_lanes(now, less_origin(sub(p.now, p.moved), now));
  meetings m;
  m.inside = turned_back_lanes(next, less_origin(p.now, next));
  const tool_gaps found = gaps_of_tool(kind, data, tool_grid, next + 12, wanted, start);
  const vec3 way = sub(m.inside, start);
  m.opening = dot_lanes(found.normal, way);
  m.distance = found.distance + m.opening;
  m.normal = turned_lanes(next, found.normal);
  m.slip = turned_lanes(now, way);
  if (kind[5] > 1) m.opening = m.opening + (found.distance - gaps_of_tool(kind, data, tool_grid, now + 12, wanted, start).distance);
  return m;
}
