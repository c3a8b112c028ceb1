// Writes the meshes that the shipped scenes use: generate_meshes FOLDER
#include <cstdio>
#include <filesystem>

#include "pliant/error.h"
#include "scenes/generate/hand.h"
#include "scenes/generate/hollow.h"
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
    const pliant::TriangleMesh hollow = pliant::make_hollow(pliant::make_shape("liver"), 0.012, 0.006);
    pliant::write_obj_text(hollow, "hollow liver, metres, y up; written by generate_meshes",
                           std::string(argv[1]) + "/hollow_liver.obj");
    std::printf("hollow_liver: %zu triangles, %.6g m^3\n", hollow.triangles.size(), pliant::signed_volume(hollow));
    const std::string folder = std::string(argv[1]) + "/hand";
    std::filesystem::create_directories(folder);
    for (int frame = 0; frame < pliant::hand_frames; ++frame) {
      const pliant::TriangleMesh mesh = pliant::make_hand(frame);
      pliant::write_obj_text(mesh, "hand, metres; written by generate_meshes", folder + "/" + std::to_string(frame) + ".obj");
      std::printf("hand %d: %zu triangles\n", frame, mesh.triangles.size());
    }
  } catch (const pliant::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return static_cast<int>(e.code());
  }
  return 0;
}
