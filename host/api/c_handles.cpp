#include "api/c_handles.h"

namespace pliant::api {

HandleTable<CWorld>& Handles::all() {
  static HandleTable<CWorld> worlds("world");
  return worlds;
}

HandleTable<CDevice>& Handles::devices() {
  static HandleTable<CDevice> devices("device");
  return devices;
}

HandleTable<CLoop>& Handles::loops() {
  static HandleTable<CLoop> loops("loop");
  return loops;
}

}  // namespace pliant::api
