// Tools that are thin compared to the distance h between contact points: a needle, a blade, the rim of a plate. They would pass between contact
// points. Instead, the surface patch around a contact point (contact_patch.cl) is tested against points on the tool's edges, which are balls.
// tool_edge: [edge points][4] (position in the tool's frame (3), radius) [m]; per tool tool_kind[6] is its first edge point and tool_kind[7] their
// number. The place of an edge point on a patch is found by two Newton steps with tangent planes; normal and place are those of the start of the step
// (see contact_point.cl). All edge points that are inside a patch push on it, each at its own place: were only the deepest to push, the place of the
// force would jump along an edge that lies on tissue, and feed motion. What acts is the sum of their pushes at their mean place. Friction acts at the
// contact point, where slip is measured, so that its matrix is symmetric.
#define EDGE_EASE 0.5f     // fraction of the force that would remove a depth at once
#define EDGE_LOOSE 1.5f    // tolerance beyond the patch in the first Newton step
#define EDGE_INSIDE 1.0f   // [h] deeper edge points belong to the other side of the tissue
#define EDGE_NARROW 0.5f   // [h] faces of at most twice this width are treated as edges
#define EDGE_CLOSE 0.1f    // [h] no edge search if a face of a box is nearer than this
#define EDGE_ALIKE 0.7f    // minimum cosine between the normals of a tool face and the patch it lies on
#define EDGE_STRETCH 3.0f  // assumed stretch of patches in the broad phase
#define EDGE_SOON 0.25f    // [h] edge points nearer than this count for W
#define EDGE_DRAG 0.1f     // fraction of the force that would stop slip at once: W varies along a patch, which feeds motion along it
#define EDGE_FAR 1e30f

#include "edge_touch.cl"
#include "contact_face.cl"

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

// Contact of tool t with point i at `x`, or with the patch around it if the tool has edges.
static inline patch_meeting meet_patch(__global const float* node_u, __global const float* node_w, __global const float* contact_rest,
                                       __global const int* contact_node, __global const float* contact_weight, __global const int* tool_kind,
                                       __global const float* tool_data, __global const float* tool_grid, __global const float* tool_edge,
                                       __global const float* tool_pose, __global const float* touch_surface,
                                       __global const float* contact_patch, int tools, int step, int t, int i, contact_place x) {
  patch_meeting out;
  out.m = meet(tool_kind, tool_data, tool_grid, tool_pose, tools, step, t, x);
  out.at = x.now;
  out.share = out.ease = out.spread_share = 1.0f, out.edged = 0;
  if (!has_edges(tool_kind, t) && !is_face(tool_kind, t)) return out;
  __global const float* now = tool_pose + POSE_NUMBERS * (step * tools + t);
  __global const float* next = now + POSE_NUMBERS * tools;
  __global const int* kind = tool_kind + TOOL_INTEGERS * t;
  __global const float* data = tool_data + TOOL_NUMBERS * t;
  const float spacing = touch_surface[POINT_BASE(i, PLIANT_TOUCH_SURFACE) + 22 * PLIANT_TILE];
  if (is_face(tool_kind, t) && (out.m.distance > FACE_NEAR * spacing || is_joined(contact_patch, i))) {
    out.m.distance = EDGE_FAR, out.m.opening = 0.0f;
    return out;
  }
  const patch_plane plane = plane_of(place_on(PATCH_VALUES, i, 0.0f, 0.0f), now);
  if (is_face(tool_kind, t)) {
    meet_face(data, next, plane, &out.m);
    return out;
  }
  const float4 outward = (float4)(0.0f) - plane.normal;
  if (kind[0] == 4) {  // a mesh whose face lies on the patch: the depth of the point
    const float alike = dot_xyz(out.m.normal, turned(next, outward));
    if (out.m.distance - out.m.opening < 0.0f && alike > EDGE_ALIKE) return out;
  }
  float4 face;
  int on_face = kind[0] == 2 && on_box_face(data, plane.normal, plane.y, spacing, &face) && face.w > -EDGE_INSIDE * spacing &&
                dot_xyz(face, outward) > EDGE_ALIKE;
  if (!(on_face && face.w < EDGE_CLOSE * spacing)) {
    if (meet_edge(PATCH_VALUES, now, next, i, plane, spacing, tool_edge + 4 * kind[6], kind[7], &out)) return out;
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
