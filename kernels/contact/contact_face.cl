// Faces of a blade that cuts by force. Its frame: x across it, y from the edge to the back, z along the edge. A plate of half thickness data[4] that is
// thin at its edge, its back and its ends: its profile rises by data[2] per metre from a place data[7] behind the edge (one cell: nearer the sides of a
// cut share nodes and cannot part) and from the back, and by data[3] from the ends, so that the surface is continuous wherever tissue comes to it. Each side is a tool of its own, data[1] = 1 towards x, -1 against it, and touches the
// points that look at it by their normals: both faces of a fresh cut lie in the middle of the blade, where no place tells them apart. Points that look
// along the blade (the skin beside a cut) go with their cells. tool_pose[12]: whether the blade is in the scene.
#define FACE_LOOKS 0.6f  // cosine from which a normal tells the side
#define FACE_NEAR 0.25f  // [h] points farther than this from the box around the blade need no normal: they will not touch in the next step either

static inline int is_face(__global const int* tool_kind, int t) { return EDGES && tool_kind[TOOL_INTEGERS * t] == FACE_OF_BLADE; }

// Sets distance, opening and normal of the meeting.
static inline void meet_face(__global const float* data, __global const float* next, patch_plane plane, meeting* m) {
  const float side = data[1], half_of = data[4], looks = side * plane.normal.x, at = side * plane.y.x;
  const float low = (plane.y.y + data[5]) - data[7], high = data[5] - plane.y.y, end = data[6] - fabs(plane.y.z);
  const float up = (low < high ? low : high) * data[2], along = end * data[3], rise = up < along ? up : along;
  const float wide = rise < half_of ? rise : half_of;
  if (!(looks < -FACE_LOOKS) || !(wide > 0.0f) || !(at > -2.0f * half_of) || !(next[12] > 0.0f)) {
    m->distance = EDGE_FAR, m->opening = 0.0f;
    return;
  }
  const float slope_y = rise < half_of && up < along ? (low < high ? data[2] : -data[2]) : 0.0f;
  const float slope_z = rise < half_of && !(up < along) ? (plane.y.z > 0.0f ? -data[3] : data[3]) : 0.0f;
  const float length = sqrt(dot3(1.0f, 1.0f, slope_y, slope_y, slope_z, slope_z));
  const float4 normal = (float4)(side / length, -slope_y / length, -slope_z / length, 0.0f);
  const float inside = at > -wide ? at : -wide;  // beyond the other side it is no deeper
  m->opening = dot_xyz(normal, m->inside - plane.y);
  m->distance = (inside - wide) / length + m->opening;
  m->normal = turned(next, normal);
}
