#include "render/ray_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "pliant/error.h"

#ifdef PLIANT_HAVE_EMBREE
#include <embree3/rtcore.h>
#endif

namespace pliant::render {

#ifdef PLIANT_HAVE_EMBREE

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;
  void* vertices = nullptr;

  Embree() {
    // One thread builds: the hierarchy is then the same in every run.
    device = rtcNewDevice("threads=1,set_affinity=0");
    if (device == nullptr)
      throw Error(ErrorCode::bad_input,
                  fmt::format("Embree could not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  ~Embree() {
    release();
    rtcReleaseDevice(device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  void release() {
    if (geometry != nullptr) rtcReleaseGeometry(geometry);
    if (scene != nullptr) rtcReleaseScene(scene);
    geometry = nullptr;
    scene = nullptr;
  }

  void build(const Surface& surface, const std::vector<float>& positions) {
    release();
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
    if (surface.triangles.empty()) {  // Embree makes no buffer of nothing
      rtcCommitScene(scene);
      return;
    }
    geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);  // the first commit builds, later ones refit
    vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                       positions.size() / 3);
    void* const indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                  3 * sizeof(std::int32_t), surface.triangles.size() / 3);
    if (vertices == nullptr || indices == nullptr)
      throw Error(ErrorCode::bad_input, "Embree: no memory for the surface of the picture");
    std::memcpy(indices, surface.triangles.data(), surface.triangles.size_bytes());
    std::memcpy(vertices, positions.data(), positions.size() * sizeof(float));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
  }

  void refit(const std::vector<float>& positions) {
    if (geometry == nullptr) return;
    std::memcpy(vertices, positions.data(), positions.size() * sizeof(float));
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
    rtcCommitScene(scene);
  }
};

RayScene::RayScene() : embree_(std::make_unique<Embree>()) {}
RayScene::~RayScene() = default;

bool RayScene::available() { return true; }

Hit RayScene::nearest(Vec3f o, Vec3f d) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, HUGE_VALF, ~0U, 0, 0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {query.ray.tfar, static_cast<std::int32_t>(query.hit.primID), query.hit.u, query.hit.v};
}

bool RayScene::blocked(Vec3f o, Vec3f d) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, HUGE_VALF, ~0U, 0, 0};
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;
}

#else

struct RayScene::Embree {
  void build(const Surface&, const std::vector<float>&) {}
  void refit(const std::vector<float>&) {}
};
RayScene::RayScene() { throw Error(ErrorCode::bad_input, Renderer::missing()); }
RayScene::~RayScene() = default;
bool RayScene::available() { return false; }
Hit RayScene::nearest(Vec3f, Vec3f) const { return {}; }
bool RayScene::blocked(Vec3f, Vec3f) const { return false; }

#endif

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
    embree_->build(surface, positions_);
    smooth_ = SmoothNormals(positions_, surface.triangles, surface.cut);
    topology_ = surface.topology;
    vertices_ = vertices();
    corners_ = surface.triangles.size();
    built_ = true;
  } else {
    embree_->refit(positions_);
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
