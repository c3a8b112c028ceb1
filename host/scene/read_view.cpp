// The key "view" of a scene.
#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

SceneView read_view(const Reader& view) {
  view.expect_object("view");
  SceneView v;
  describe_view(ReadKeys{view}, v);
  if (v.eye && v.target && *v.eye == *v.target) view.at("eye").fail("a point other than the target");
  if (v.up == Vec3d{}) view.at("up").fail("three numbers [x, y, z], not all zero");
  return v;
}

}  // namespace pliant
