// Closest points by Embree. A build without it has distance_no_embree.cpp in place of this file.
#include <embree3/rtcore.h>

#include <limits>

#include "geometry/distance.h"
#include "pliant/error.h"

namespace pliant {

// Embree holds the triangles in float, relative to the centre of the box. `slack` bounds how far that moved a vertex.
struct SurfaceDistance::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const TriangleMesh* mesh = nullptr;
  Vec3d centre{};
  double slack = 0;

  Embree(const TriangleMesh& surface, const vec::Box& box) : mesh(&surface) {
    centre = vec::mul(vec::add(box.lower, box.upper), 0.5);
    slack = 1e-6 * vec::norm(vec::sub(box.upper, box.lower));
    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw Error(ErrorCode::internal, "Embree could not open its device");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), surface.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                        3 * sizeof(std::uint32_t), surface.triangles.size()));
    if (vertices == nullptr || indices == nullptr) throw Error(ErrorCode::internal, "Embree could not allocate its buffers");
    for (const Vec3d& v : surface.vertices) {
      for (int a = 0; a < 3; ++a) *vertices++ = static_cast<float>(v[a] - centre[a]);
    }
    for (const auto& t : surface.triangles) {
      for (const std::int32_t v : t) *indices++ = static_cast<std::uint32_t>(v);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  struct Query {
    const Embree* self;
    Vec3d p;
    ClosestPoint best;
  };

  static bool visit(RTCPointQueryFunctionArguments* args) {
    Query& query = *static_cast<Query*>(args->userPtr);
    const TriangleMesh& mesh = *query.self->mesh;
    const auto triangle = static_cast<std::int32_t>(args->primID);
    const auto& t = mesh.triangles[triangle];
    const Vec3d q = closest_on_triangle(query.p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    const double distance = vec::norm(vec::sub(q, query.p));
    if (distance > query.best.distance || (distance == query.best.distance && triangle > query.best.triangle)) return false;
    query.best = {distance, triangle, q};
    args->query->radius = static_cast<float>(distance * (1 + 1e-6) + query.self->slack);
    return true;
  }

  [[nodiscard]] ClosestPoint closest(const Vec3d& p) const {
    Query data{this, p, {}};
    RTCPointQuery query{};
    query.x = static_cast<float>(p[0] - centre[0]);
    query.y = static_cast<float>(p[1] - centre[1]);
    query.z = static_cast<float>(p[2] - centre[2]);
    query.time = 0;
    query.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, &Embree::visit, &data);
    return data.best;
  }
};

bool SurfaceDistance::has_embree() { return true; }

std::shared_ptr<const SurfaceDistance::Embree> SurfaceDistance::start_embree(const TriangleMesh& surface, const vec::Box& box) {
  return std::make_shared<Embree>(surface, box);
}

ClosestPoint SurfaceDistance::closest_by_embree(const Vec3d& p) const { return embree_->closest(p); }

}  // namespace pliant
