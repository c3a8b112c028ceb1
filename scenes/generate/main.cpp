// Writes the meshes that the shipped scenes use: generate_meshes FOLDER
#include <cstdio>

#include "pliant/error.h"
#include "scenes/generate/organs.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: generate_meshes FOLDER\n");
    return 2;
  }
  try {
    for (const std::string& name : pliant::shape_names()) {
      const pliant::TriangleMesh mesh = pliant::make_shape(name);
      pliant::write_obj_text(mesh, name + ", metres, y up; written by generate_meshes",
                             std::string(argv[1]) + "/" + name + ".obj");
      std::printf("%s: %zu vertices, %zu triangles, %.6g m^3\n", name.c_str(), mesh.vertices.size(), mesh.triangles.size(),
                  pliant::signed_volume(mesh));
    }
  } catch (const pliant::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return static_cast<int>(e.code());
  }
  return 0;
}
