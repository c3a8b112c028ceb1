// Any bytes may stand in a scene file: they load, or Error says why not. A scene that loads must survive being written.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "pliant/error.h"
#include "scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  pliant::Scene scene;
  try {
    scene = pliant::parse_scene(text, "folder/scene.json");
  } catch (const pliant::Error&) {
    return 0;
  }
  const std::string written = pliant::scene_to_json(scene);
  if (pliant::scene_to_json(pliant::parse_scene(written, "folder/scene.json")) != written) std::abort();
  return 0;
}
