// Stands in for ray_scene_embree.cpp in a build without Embree.
#include "pliant/error.h"
#include "render/ray_scene.h"

namespace pliant::render {

struct RayScene::Embree {};

RayScene::RayScene() { throw Error(ErrorCode::bad_input, Renderer::missing()); }
RayScene::~RayScene() = default;
bool RayScene::available() { return false; }
void RayScene::build(const Surface&) {}
void RayScene::refit() {}
Hit RayScene::nearest(Vec3f, Vec3f) const { return {}; }
bool RayScene::blocked(Vec3f, Vec3f) const { return false; }

}  // namespace pliant::render
