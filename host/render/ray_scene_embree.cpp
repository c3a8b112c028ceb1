// The rays that Embree follows. A build without it has ray_scene_no_embree.cpp in place of this file.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "pliant/error.h"
#include "render/ray_scene.h"

namespace pliant::render {

struct RayScene::Embree {
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");  // one thread: the hierarchy is then the same in every run
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;
  void* vertices = nullptr;

  Embree() {
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

void RayScene::build(const Surface& surface) { embree_->build(surface, positions_); }
void RayScene::refit() { embree_->refit(positions_); }

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

}  // namespace pliant::render
