// Volume meshes of boxes as files, for scenes that read one.
#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "cutting/cut_bodies.h"
#include "support/temp_folder.h"

namespace pliant::cut_test {

/// Kuhn tetrahedra of a box of cells of 1 cm from the origin, as a Gmsh file.
inline std::filesystem::path tet_box_file(const test::TempFolder& folder, const std::string& name, int nx, int ny, int nz) {
  const auto mesh = box_mesh(nx, ny, nz, true);
  std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh->rest.size());
  for (std::size_t n = 0; n < mesh->rest.size(); ++n) {
    text += fmt::format("{} {} {} {}\n", n + 1, 0.01 * mesh->rest[n][0], 0.01 * mesh->rest[n][1], 0.01 * mesh->rest[n][2]);
  }
  text += fmt::format("$EndNodes\n$Elements\n{}\n", mesh->cells.size());
  for (std::size_t t = 0; t < mesh->cells.size(); ++t) {
    const auto& c = mesh->cells[t];
    text += fmt::format("{} 4 2 1 1 {} {} {} {}\n", t + 1, c[0] + 1, c[1] + 1, c[2] + 1, c[3] + 1);
  }
  return folder.write(name, text + "$EndElements\n");
}

}  // namespace pliant::cut_test
