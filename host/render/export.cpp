#include "render/export.h"

namespace pliant::render {

SurfaceFrame FrameSplitter::split(const Surface& surface, double time, const std::vector<VertexArray>& fields) {
  std::vector<float> packed;
  packed.reserve(surface.positions.size() / surface.stride * 3);
  for (std::size_t i = 0; i + 2 < surface.positions.size(); i += surface.stride) {
    packed.insert(packed.end(), {surface.positions[i], surface.positions[i + 1], surface.positions[i + 2]});
  }
  if (!ready_ || topology_ != surface.topology) {
    smooth_ = SmoothNormals(packed, surface.triangles, surface.cut);
    topology_ = surface.topology;
    ready_ = true;
  }
  SurfaceFrame frame;
  frame.time = time;
  frame.topology = surface.topology;
  frame.triangles = smooth_.corner();
  frame.cut.assign(surface.cut.begin(), surface.cut.end());
  for (const Vec3f& n : smooth_.compute(packed, surface.triangles)) frame.normals.insert(frame.normals.end(), {n.x, n.y, n.z});
  for (const std::int32_t v : smooth_.vertex()) {
    const float* p = packed.data() + 3 * static_cast<std::size_t>(v);
    frame.positions.insert(frame.positions.end(), {p[0], p[1], p[2]});
  }
  for (const VertexArray& field : fields) {
    VertexArray& out = frame.fields.emplace_back(VertexArray{field.name, field.components, {}});
    for (const std::int32_t v : smooth_.vertex()) {
      const auto at = field.values.begin() + static_cast<std::ptrdiff_t>(v) * field.components;
      out.values.insert(out.values.end(), at, at + field.components);
    }
  }
  return frame;
}

}  // namespace pliant::render
