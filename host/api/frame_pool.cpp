#include "api/frame_pool.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pliant::api {

std::shared_ptr<FrameData> FramePool::take() {
  std::unique_ptr<FrameData> data;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      data = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (data == nullptr) data = std::make_unique<FrameData>();
  return {data.release(), [pool = weak_from_this()](FrameData* released) {
            std::unique_ptr<FrameData> owned(released);
            if (const auto alive = pool.lock()) alive->give_back(std::move(owned));
          }};
}

void FramePool::give_back(std::unique_ptr<FrameData> data) {
  const std::lock_guard lock(mutex_);
  if (free_.size() < 4) free_.push_back(std::move(data));
}

void vertex_normals(const std::vector<Vec4f>& positions, std::size_t count, View<Triangle> triangles,
                    std::vector<Vec4f>& normals) {
  normals.assign(positions.size(), Vec4f{});
  for (const Triangle& t : triangles) {
    const Vec4f &a = positions[static_cast<std::size_t>(t[0])], &b = positions[static_cast<std::size_t>(t[1])],
                &c = positions[static_cast<std::size_t>(t[2])];
    const float ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const float vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    const float n[3]{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
    for (const std::int32_t corner : t) {
      Vec4f& sum = normals[static_cast<std::size_t>(corner)];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += n[k];
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    Vec4f& n = normals[v];
    // Twice the area of small triangles is around 1e-6 m^2: its square is far from the smallest float only after scaling.
    const float largest = std::max({std::fabs(n[0]), std::fabs(n[1]), std::fabs(n[2])});
    if (!(largest > 0)) continue;
    const float x = n[0] / largest, y = n[1] / largest, z = n[2] / largest;
    const float inverse = 1 / std::sqrt(x * x + y * y + z * z);
    n = {x * inverse, y * inverse, z * inverse, 0};
  }
}

IndexRange changed_range(const std::vector<Vec4f>& before, const std::vector<Vec4f>& now, std::size_t count) {
  const auto same = [&](std::size_t v) { return std::memcmp(&before[v], &now[v], sizeof(Vec4f)) == 0; };
  std::size_t first = 0, end = count;
  while (first < end && same(first)) ++first;
  while (end > first && same(end - 1)) --end;
  return {first, end - first};
}

IndexRange joined(const IndexRange& a, const IndexRange& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const std::size_t first = std::min(a.first, b.first), end = std::max(a.first + a.count, b.first + b.count);
  return {first, end - first};
}

}  // namespace pliant::api
