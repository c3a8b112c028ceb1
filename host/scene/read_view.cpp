// The key "view" of a scene.
#include "scene/parts.h"

namespace pliant {

SceneView read_view(const Reader& view) {
  view.expect_object("view");
  SceneView v;
  if (view.has("eye")) v.eye = view.at("eye").vec3();
  if (view.has("target")) v.target = view.at("target").vec3();
  if (v.eye && v.target && *v.eye == *v.target) view.at("eye").fail("a point other than the target");
  if (view.has("up")) {
    const Reader up = view.at("up");
    const char* const expected = "three numbers [x, y, z], not all zero";
    v.up = up.vec3(expected);
    if (*v.up == Vec3d{}) up.fail(expected);
  }
  if (view.has("field_of_view")) {
    const Reader angle = view.at("field_of_view");
    v.field_of_view = angle.number();
    if (!(v.field_of_view >= 1 && v.field_of_view <= 120)) angle.fail("1 to 120 degrees");
  }
  if (view.has("ground")) v.ground = view.at("ground").boolean();
  return v;
}

}  // namespace pliant
