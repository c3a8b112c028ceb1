// Contact points: position, motion and contact with a tool. Data per point are in tiles of 16. contact_rest: (undeformed position (3) [m], area
// [m^2]); contact_node: 8 slots; contact_weight: 8 weights with sum one. tool_pose: [steps + 1][tools] rows of the rotation (9), position of the
// origin (3) [m], frame of a sequence and weight of the next frame, strength of the grip [Pa]; row `step` is the current time.
#define POSE_NUMBERS 15
#define POINT_BASE(i, planes) TILE_BASE(i, planes)
#define QUANTUM_LIMIT 67108864.0f  // thirty of these fit into an integer

typedef struct {
  float4 now;   // position after the trial step [m]
  float4 moved; // increment of this step [m]
} contact_place;

// R v of a pose, and its transpose.
static inline float4 turned(__global const float* r, float4 v) {
  return (float4)(dot3(r[0], v.x, r[1], v.y, r[2], v.z), dot3(r[3], v.x, r[4], v.y, r[5], v.z), dot3(r[6], v.x, r[7], v.y, r[8], v.z), 0.0f);
}
static inline float4 turned_back(__global const float* r, float4 v) {
  return (float4)(dot3(r[0], v.x, r[3], v.y, r[6], v.z), dot3(r[1], v.x, r[4], v.y, r[7], v.z), dot3(r[2], v.x, r[5], v.y, r[8], v.z), 0.0f);
}
static inline float4 origin_of(__global const float* pose) { return (float4)(pose[9], pose[10], pose[11], 0.0f); }

static inline float dot_xyz(float4 a, float4 b) { return dot3(a.x, b.x, a.y, b.y, a.z, b.z); }

// Contact is with the tool's tangent plane at the point that was nearest at the start of the step. The normal of the trial step would accelerate a
// point that slides on a curved tool (docs/contact.md).
typedef struct {
  float distance;  // signed distance to this plane, negative inside the tool [m]
  float opening;   // change of this distance in the step [m]
  float4 normal;   // outward, in world coordinates
  float4 slip;     // increment of the point relative to the tool [m]
  float4 inside;   // the point in the tool's frame [m]
} meeting;

static inline meeting meet(__global const int* tool_kind, __global const float* tool_data, __global const float* tool_grid,
                           __global const float* tool_pose, int tools, int step, int t, contact_place p) {
  __global const float* now = tool_pose + POSE_NUMBERS * (step * tools + t);
  __global const float* next = now + POSE_NUMBERS * tools;
  meeting m;
  const float4 start = turned_back(now, (p.now - p.moved) - origin_of(now));
  m.inside = turned_back(next, p.now - origin_of(next));
  __global const int* kind = tool_kind + TOOL_INTEGERS * t;
  __global const float* data = tool_data + TOOL_NUMBERS * t;
  const float4 found = tool_distance(kind, data, tool_grid, next + 12, start), way = m.inside - start;
  m.opening = dot_xyz(found, way);
  m.distance = found.w + m.opening;
  m.normal = turned(next, found);
  m.slip = turned(now, way);
  // The surface of a sequence also moves within its frame.
  if (kind[5] > 1) m.opening = m.opening + (found.w - tool_distance(kind, data, tool_grid, now + 12, start).w);
  return m;
}

// Fraction of the margin within which a point may touch in the next step. It is larger for points that were within it before, so that the set of
// these points does not flicker.
#define READY_AGAIN 0.24f
#define READY_NEW 0.08f

// Rounds a force in quanta; NaN becomes 0.
static inline int quanta(float value) {
  const float inside = value > QUANTUM_LIMIT ? QUANTUM_LIMIT : value < -QUANTUM_LIMIT ? -QUANTUM_LIMIT : value;
  return inside == inside ? (int)rint(inside) : 0;
}
