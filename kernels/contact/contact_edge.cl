// Tools that are thin compared to the distance h between contact points: a needle, a blade, the rim of a plate. They would pass between contact
// points. Instead, the surface patch around a contact point (contact_patch.cl) is tested against points on the tool's edges, which are balls.
// tool_edge: [edge points][4] (position in the tool's frame (3), radius) [m]; per tool tool_kind[6] is its first edge point and tool_kind[7] their
// number. The edge point with the least gap along the patch's normal is in contact, at the place found by two Newton steps with tangent planes.
// Normal and place are those of the start of the step (see contact_point.cl). The force acts at this place, with the weights of the nodes there.
#define EDGE_EASE 0.5f     // fraction of the force that would remove a depth at once
#define EDGE_LOOSE 1.5f    // tolerance beyond the patch in the first Newton step
#define EDGE_INSIDE 1.0f   // [h] deeper edge points belong to the other side of the tissue
#define EDGE_NARROW 0.5f   // [h] faces of at most twice this width are treated as edges
#define EDGE_CLOSE 0.1f    // [h] no edge search if a face of a box is nearer than this
#define EDGE_ALIKE 0.7f    // minimum cosine between the normals of a tool face and the patch it lies on
#define EDGE_STRETCH 3.0f  // assumed stretch of patches in the broad phase
#define EDGE_FAR 1e30f

static inline int has_edges(__global const int* tool_kind, int t) { return EDGES && tool_kind[TOOL_INTEGERS * t + 7] > 0; }

// Returns whether a point lies over the face of a box that faces it most directly. Faces narrow compared to h do not count: they are edges.
static inline int on_box_face(__global const float* data, float4 normal, float4 y, float spacing, float4* face) {
  const float nx = fabs(normal.x), ny = fabs(normal.y), nz = fabs(normal.z), least = EDGE_NARROW * spacing;
  const int along_x = nx >= ny && nx >= nz, along_y = !along_x && ny >= nz;
  const float side = (along_x ? normal.x : along_y ? normal.y : normal.z) > 0.0f ? -1.0f : 1.0f;
  *face = (float4)(along_x ? side : 0.0f, along_y ? side : 0.0f, along_x || along_y ? 0.0f : side, 0.0f);
  face->w = side * (along_x ? y.x : along_y ? y.y : y.z) - (along_x ? data[4] : along_y ? data[5] : data[6]);
  const int over_x = fabs(y.x) < data[4] && data[4] > least, over_y = fabs(y.y) < data[5] && data[5] > least,
            over_z = fabs(y.z) < data[6] && data[6] > least;
  return (along_x || over_x) && (along_y || over_y) && (along_x || along_y ? over_z : 1);
}

typedef struct {
  float4 at;         // position (3) and radius of the edge point
  float gap, a, b;   // EDGE_FAR if none is over the patch
} edge_gap;

// The edge point with the least gap to the tangent plane of a patch at (at_a, at_b), within the patch or its margin scaled by `wide`.
static inline edge_gap nearest_edge(__global const float* edge, int count, patch_plane p, __global const float* region, float spacing,
                                    float wide, float at_a, float at_b) {
  edge_gap found = {0.0f, EDGE_FAR, 0.0f, 0.0f};
  for (int e = 0; e < count; ++e) {
    const float4 at = vload4(e, edge), start = (float4)(at.x - p.y.x, at.y - p.y.y, at.z - p.y.z, 0.0f);
    const float gap = dot_xyz(p.normal, start) - at.w;
    if (!(gap < found.gap) || !(gap > -EDGE_INSIDE * spacing)) continue;
    const float a = at_a + dot_xyz(p.dual_first, start), b = at_b + dot_xyz(p.dual_second, start);
    if (!(beyond_region(region, a, b) < wide)) continue;
    found.at = at;
    found.gap = gap;
    found.a = a;
    found.b = b;
  }
  return found;
}

typedef struct {
  meeting m;        // slip and inside are those of the contact point, the rest belongs to the place of contact
  patch_place at;   // where the force acts
  float share, ease;  // fraction of the point's area, and of the force that would remove the depth
  int edged;        // whether the force acts at `at` instead of the contact point
} patch_meeting;

// Contact of tool t with point i at `x`, or with the patch around it if the tool has edges.
static inline patch_meeting meet_patch(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                                       __global const int* contact_node, __global const float* contact_weight, __global const int* tool_kind,
                                       __global const float* tool_data, __global const float* tool_grid, __global const float* tool_edge,
                                       __global const float* tool_pose, __global const float* touch_surface,
                                       __global const float* contact_patch, int tools, int step, int t, int i, contact_place x) {
  patch_meeting out;
  out.m = meet(tool_kind, tool_data, tool_grid, tool_pose, tools, step, t, x);
  out.at.now = x.now;
  out.share = out.ease = 1.0f, out.edged = 0;
  if (!has_edges(tool_kind, t)) return out;
  __global const float* now = tool_pose + POSE_NUMBERS * (step * tools + t);
  __global const float* next = now + POSE_NUMBERS * tools;
  __global const int* kind = tool_kind + TOOL_INTEGERS * t;
  __global const float* data = tool_data + TOOL_NUMBERS * t;
  __global const float* region = contact_patch + POINT_BASE(i, PLIANT_PATCH);
  __global const float* edge = tool_edge + 4 * kind[6];
  const float spacing = touch_surface[POINT_BASE(i, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
  patch_place at = place_on(node_u, node_w, contact_rest, contact_node, contact_weight, touch_surface, contact_patch, i, 0.0f, 0.0f);
  patch_plane plane = plane_of(at, now);
  const float4 outward = (float4)(0.0f) - plane.normal;
  if (kind[0] == 4) {  // a mesh whose face lies on the patch: the depth of the point
    const float alike = dot_xyz(out.m.normal, turned(next, outward));
    if (out.m.distance - out.m.opening < 0.0f && alike > EDGE_ALIKE) return out;
  }
  float4 face;
  int on_face = kind[0] == 2 && on_box_face(data, plane.normal, plane.y, spacing, &face) && face.w > -EDGE_INSIDE * spacing &&
                dot_xyz(face, outward) > EDGE_ALIKE;
  if (!(on_face && face.w < EDGE_CLOSE * spacing)) {
    edge_gap found = nearest_edge(edge, plane.flat ? kind[7] : 0, plane, region, spacing, EDGE_LOOSE, 0.0f, 0.0f);
    if (found.gap < EDGE_FAR) {
      at = place_on(node_u, node_w, contact_rest, contact_node, contact_weight, touch_surface, contact_patch, i, found.a, found.b);
      plane = plane_of(at, now);
      found = nearest_edge(edge, plane.flat ? kind[7] : 0, plane, region, spacing, 1.0f, found.a, found.b);
    }
    if (found.gap < EDGE_FAR) {
      at = place_on(node_u, node_w, contact_rest, contact_node, contact_weight, touch_surface, contact_patch, i, found.a, found.b);
      plane = plane_of(at, now);
      const float4 toward = (float4)(0.0f) - plane.normal;
      const float beyond = beyond_region(region, found.a, found.b);
      const float depth = dot_xyz(toward, (float4)(found.at.xyz, 0.0f) - plane.y) + found.at.w;
      out.m.opening = dot_xyz(toward, turned_back(next, at.now - origin_of(next)) - plane.y);
      out.m.distance = out.m.opening - depth;
      out.m.normal = turned(next, toward);
      out.at = at;
      out.share = beyond > 0.0f ? 1.0f - beyond : 1.0f;
      out.ease = EDGE_EASE, out.edged = 1;
      return out;
    }
    if (kind[0] == 4) return out;
  }
  if (on_face) {
    const float4 toward = (float4)(face.xyz, 0.0f);
    out.m.opening = dot_xyz(toward, out.m.inside - plane.y);
    out.m.distance = face.w + out.m.opening;
    out.m.normal = turned(next, toward);
    return out;
  }
  out.m.distance = EDGE_FAR, out.m.opening = 0.0f;
  return out;
}
