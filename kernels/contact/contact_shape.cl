// Signed distance from a point to a tool's shape and the outward normal, in the tool's frame. tool_kind: per tool (shape in the order of
// host/scene/contact_tool.h, first value of its grid, grid nodes in x, y, z, number of frames of a sequence, which has a grid for each and
// interpolates two: `moment` holds the number of the first and the weight of the second); tool_data: per tool radius, first point (3), second point,
// normal or half size (3), origin of the grid (3) [m], 1 / grid spacing, grid spacing, then the contact law: lambda [Pa/m^n], 3/2 alpha [s/m],
// friction, core [m], whether n is 3/2. tool_grid: signed distances [m], x fastest.
#define TOOL_NUMBERS 20
#define FACE_OF_BLADE 6  // in the broad phase the box around the blade (contact_face.cl)
#define TOOL_INTEGERS 8

static inline float dot3(float ax, float bx, float ay, float by, float az, float bz) { return fma(ax, bx, fma(ay, by, az * bz)); }
static inline float mixed(float a, float b, float t) { return fma(t, b - a, a); }

// (x, y, z) / length; the z axis if the length is 0.
static inline float4 normalised(float x, float y, float z, float length) {
  return length > 0.0f ? (float4)(x / length, y / length, z / length, 0.0f) : (float4)(0.0f, 0.0f, 1.0f, 0.0f);
}

static inline float4 grid_distance(__global const int* kind, __global const float* data, __global const float* grid, float4 y) {
  const int nx = kind[2], ny = kind[3], nz = kind[4];
  const float inverse = data[10], spacing = data[11];
  const float gx = (y.x - data[7]) * inverse, gy = (y.y - data[8]) * inverse, gz = (y.z - data[9]) * inverse;
  const float mx = (float)(nx - 1), my = (float)(ny - 1), mz = (float)(nz - 1);
  const float cx = gx > 0.0f ? (gx < mx ? gx : mx) : 0.0f, cy = gy > 0.0f ? (gy < my ? gy : my) : 0.0f,
              cz = gz > 0.0f ? (gz < mz ? gz : mz) : 0.0f;
  const float ox = gx - cx, oy = gy - cy, oz = gz - cz;
  const float beyond = dot3(ox, ox, oy, oy, oz, oz);
  if (beyond > 0.0f) return (float4)(0.0f, 0.0f, 1.0f, fma(2.0f, spacing, sqrt(beyond) * spacing));
  const int ix = (int)cx < nx - 2 ? (int)cx : nx - 2, iy = (int)cy < ny - 2 ? (int)cy : ny - 2,
            iz = (int)cz < nz - 2 ? (int)cz : nz - 2;
  const float tx = cx - (float)ix, ty = cy - (float)iy, tz = cz - (float)iz;
  __global const float* v = grid + (iz * ny + iy) * nx + ix;
  const float v000 = v[0], v100 = v[1], v010 = v[nx], v110 = v[nx + 1];
  v += nx * ny;
  const float v001 = v[0], v101 = v[1], v011 = v[nx], v111 = v[nx + 1];
  const float v00 = mixed(v000, v100, tx), v10 = mixed(v010, v110, tx), v01 = mixed(v001, v101, tx), v11 = mixed(v011, v111, tx);
  const float v0 = mixed(v00, v10, ty), v1 = mixed(v01, v11, ty);
  const float dx = mixed(mixed(v100 - v000, v110 - v010, ty), mixed(v101 - v001, v111 - v011, ty), tz);
  const float dy = mixed(v10 - v00, v11 - v01, tz), dz = v1 - v0;
  float4 out = normalised(dx, dy, dz, sqrt(dot3(dx, dx, dy, dy, dz, dz)));
  out.w = mixed(v0, v1, tz);
  return out;
}

static inline float4 mesh_distance(__global const int* kind, __global const float* data, __global const float* tool_grid,
                                   __global const float* moment, float4 y) {
  __global const float* grid = tool_grid + kind[1];
  if (kind[5] < 2) return grid_distance(kind, data, grid, y);
  const int nodes = (kind[2] * kind[3]) * kind[4];
  grid += (int)moment[0] * nodes;
  const float share = moment[1];
  const float4 now = grid_distance(kind, data, grid, y);
  if (!(share > 0.0f)) return now;
  const float4 after = grid_distance(kind, data, grid + nodes, y);
  const float nx = mixed(now.x, after.x, share), ny = mixed(now.y, after.y, share), nz = mixed(now.z, after.z, share);
  float4 out = normalised(nx, ny, nz, sqrt(dot3(nx, nx, ny, ny, nz, nz)));
  out.w = mixed(now.w, after.w, share);
  return out;
}

// Returns (normal, distance) at the point y.
static inline float4 tool_distance(__global const int* kind, __global const float* data, __global const float* tool_grid,
                                   __global const float* moment, float4 y) {
  float4 out;
  if (kind[0] == 0 || kind[0] == 1) {
    float x = y.x, v = y.y, z = y.z;
    if (kind[0] == 1) {
      const float ex = data[4] - data[1], ey = data[5] - data[2], ez = data[6] - data[3];
      const float fx = x - data[1], fy = v - data[2], fz = z - data[3];
      const float t = dot3(fx, ex, fy, ey, fz, ez) / dot3(ex, ex, ey, ey, ez, ez);
      const float s = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
      x = fma(-s, ex, fx);
      v = fma(-s, ey, fy);
      z = fma(-s, ez, fz);
    }
    const float length = sqrt(dot3(x, x, v, v, z, z));
    out = normalised(x, v, z, length);
    out.w = length - data[0];
    return out;
  }
  if (kind[0] == 2 || kind[0] == FACE_OF_BLADE) {
    const float qx = fabs(y.x) - data[4], qy = fabs(y.y) - data[5], qz = fabs(y.z) - data[6];
    float px = qx > 0.0f ? qx : 0.0f, py = qy > 0.0f ? qy : 0.0f, pz = qz > 0.0f ? qz : 0.0f;
    const float length = sqrt(dot3(px, px, py, py, pz, pz));
    float distance = length;
    if (!(length > 0.0f)) {  // inside: the nearest face
      const int in_x = qx >= qy && qx >= qz, in_y = !in_x && qy >= qz;
      distance = in_x ? qx : in_y ? qy : qz;
      px = in_x ? 1.0f : 0.0f;
      py = in_y ? 1.0f : 0.0f;
      pz = in_x || in_y ? 0.0f : 1.0f;
    }
    out = normalised(copysign(px, y.x), copysign(py, y.y), copysign(pz, y.z), length > 0.0f ? length : 1.0f);
    out.w = distance;
    return out;
  }
  if (kind[0] == 3)
    return (float4)(data[4], data[5], data[6], dot3(y.x - data[1], data[4], y.y - data[2], data[5], y.z - data[3], data[6]));
  return mesh_distance(kind, data, tool_grid, moment, y);
}
