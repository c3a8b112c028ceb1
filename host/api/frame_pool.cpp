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
  if (free_.size() < kKept) free_.push_back(std::move(data));
}

namespace {

/// Twice the area, along the normal.
std::array<float, 3> face_normal(const std::vector<Vec4f>& positions, const Triangle& t) {
  const Vec4f &a = positions[static_cast<std::size_t>(t[0])], &b = positions[static_cast<std::size_t>(t[1])],
              &c = positions[static_cast<std::size_t>(t[2])];
  const float ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
  const float vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
  return {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

}  // namespace

void vertex_normals(const std::vector<Vec4f>& positions, std::size_t count, View<Triangle> triangles,
                    View<std::uint8_t> cut_faces, std::vector<Vec4f>& normals) {
  normals.assign(positions.size(), Vec4f{});
  std::vector<char> on_skin(cut_faces.empty() ? 0 : positions.size(), 0);
  for (std::size_t t = 0; t < cut_faces.size(); ++t) {
    if (cut_faces[t] != 0) continue;
    for (const std::int32_t corner : triangles[t]) on_skin[static_cast<std::size_t>(corner)] = 1;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<float, 3> n = face_normal(positions, triangles[t]);
    for (const std::int32_t corner : triangles[t]) {
      if (!cut_faces.empty() && cut_faces[t] != 0 && on_skin[static_cast<std::size_t>(corner)] != 0) continue;
      Vec4f& sum = normals[static_cast<std::size_t>(corner)];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += n[k];
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    Vec4f& n = normals[v];
    // Twice the area of small triangles is around 1e-6 m^2, so its square would underflow without scaling.
    const float largest = std::max({std::fabs(n[0]), std::fabs(n[1]), std::fabs(n[2])});
    if (!(largest > 0)) continue;
    const float x = n[0] / largest, y = n[1] / largest, z = n[2] / largest;
    const float inverse = 1 / std::sqrt(x * x + y * y + z * z);
    n = {x * inverse, y * inverse, z * inverse, 0};
  }
}

namespace {

/// Compares the elements that both have; further ones in `now` are new.
template <class Same>
IndexRange changed(std::size_t before, std::size_t now, const Same& same) {
  const std::size_t both = std::min(before, now);
  std::size_t first = 0, end = now;
  while (first < both && same(first)) ++first;
  while (end > first && end <= both && same(end - 1)) --end;
  return {first, end - first};
}

}  // namespace

IndexRange changed_range(View<Vec4f> from, View<Vec4f> to) {
  return changed(from.size(), to.size(), [&](std::size_t v) { return std::memcmp(&from[v], &to[v], sizeof(Vec4f)) == 0; });
}

IndexRange changed_vertices(const Frame& from, const Frame& to) {
  return joined(changed_range(from.positions, to.positions), changed_range(from.normals, to.normals));
}

IndexRange changed_triangles(const Frame& from, const Frame& to) {
  if (from.triangles.data() == to.triangles.data() && from.cut_faces.data() == to.cut_faces.data()) return {};  // same topology
  const auto flag = [](const Frame& f, std::size_t t) { return f.cut_faces.empty() ? 0 : f.cut_faces[t]; };
  return changed(from.triangles.size(), to.triangles.size(),
                 [&](std::size_t t) { return from.triangles[t] == to.triangles[t] && flag(from, t) == flag(to, t); });
}

FrameChange change_since(const Frame* seen, FramePtr now) {
  FrameChange change{std::move(now), {}, {}};
  const Frame& f = *change.frame;
  if (seen == &f) return change;
  const Frame none;
  change.dirty_vertices = changed_vertices(seen == nullptr ? none : *seen, f);
  change.dirty_triangles = changed_triangles(seen == nullptr ? none : *seen, f);
  return change;
}

IndexRange joined(const IndexRange& a, const IndexRange& b) {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const std::size_t first = std::min(a.first, b.first), end = std::max(a.first + a.count, b.first + b.count);
  return {first, end - first};
}

}  // namespace pliant::api
