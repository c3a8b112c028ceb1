#include "render/ray_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "pliant/error.h"

namespace pliant::render {

bool RayScene::update(const Surface& surface) {
  surface_ = surface;
  const bool rebuild = !built_ || surface.topology != topology_ || surface.positions.size() / surface.stride != vertices_ ||
                       surface.triangles.size() != corners_;
  if (rebuild) {
    built_ = false;
    check();
  }
  pack();
  if (rebuild) {
    build(surface);
    smooth_ = SmoothNormals(positions_, surface.triangles, surface.cut);
    find_seams();
    topology_ = surface.topology;
    vertices_ = vertices();
    corners_ = surface.triangles.size();
    built_ = true;
  } else {
    refit();
  }
  normals_ = smooth_.compute(positions_, surface.triangles);
  measure();
  return rebuild;
}

void RayScene::pack() {
  const std::size_t count = surface_.positions.size() / surface_.stride;
  positions_.resize(3 * count);
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t c = 0; c < 3; ++c) positions_[3 * v + c] = surface_.positions[surface_.stride * v + c];
  }
}

void RayScene::check() const {
  const Surface& s = surface_;
  if (s.stride < 3)
    throw Error(ErrorCode::internal, fmt::format("picture: {} floats per vertex, expected 3 or more", s.stride));
  const std::size_t vertices = s.positions.size() / s.stride, triangles = s.triangles.size() / 3;
  const auto require = [](bool fits, const char* what) {
    if (!fits) throw Error(ErrorCode::internal, fmt::format("picture: {}", what));
  };
  require(s.positions.size() % s.stride == 0 && s.triangles.size() % 3 == 0, "whole vertices and triangles");
  require(s.cut.empty() || s.cut.size() == triangles, "as many cut flags as triangles");
  require(s.body.empty() || s.body.size() == triangles, "as many body numbers as triangles");
  require(s.values.empty() || s.values.size() == vertices, "as many values as vertices");
  require(s.kinds.empty() || s.kinds.size() == 3 * vertices, "three kinds per vertex");
  for (const std::int32_t v : s.triangles) {
    require(v >= 0 && static_cast<std::size_t>(v) < vertices, "a triangle names a vertex that is not there");
  }
}

void RayScene::find_seams() {
  seams_.clear();
  const std::span<const std::int32_t> t = surface_.triangles;
  const auto is_cut = [&](std::size_t corner) { return surface_.cut[corner / 3] != 0; };
  const auto edge = [&](std::size_t corner) {  // opposite it
    const std::size_t first = corner / 3 * 3;
    return std::minmax({t[first + (corner + 1) % 3], t[first + (corner + 2) % 3]});
  };
  std::vector<std::pair<std::int32_t, std::int32_t>> of_cuts;
  for (std::size_t c = 0; c < t.size() && !surface_.cut.empty(); ++c) {
    if (is_cut(c)) of_cuts.push_back(edge(c));
  }
  if (of_cuts.empty()) return;
  std::sort(of_cuts.begin(), of_cuts.end());
  seams_.resize(t.size());
  for (std::size_t c = 0; c < t.size(); ++c) {
    seams_[c] = static_cast<char>(!is_cut(c) && std::binary_search(of_cuts.begin(), of_cuts.end(), edge(c)));
  }
}

void RayScene::measure() {
  Vec3f low{HUGE_VALF, HUGE_VALF, HUGE_VALF}, high = -low;
  for (std::size_t i = 0; i < vertices(); ++i) {
    const Vec3f p = vertex(static_cast<std::int32_t>(i));
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  size_ = positions_.empty() ? 1.0F : std::max(length(high - low), 1e-6F);
}

}  // namespace pliant::render
