// Any bytes may stand in a mesh file: they give a mesh whose indices are in range and whose vertices are finite, or Error
// says why not. The first byte chooses the format, the rest is the file.
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "mesh_io/mesh_io.h"
#include "mesh_io/mesh_tags.h"
#include "pliant/error.h"

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 6> surface_formats{".obj", ".stl", ".ply", ".3ds", ".gltf", ".glb"};
constexpr std::array<const char*, 5> volume_formats{".msh", ".vtk", ".vtu", ".ele", ".node"};
constexpr std::size_t formats = surface_formats.size() + volume_formats.size();

/// A folder of this process for the files under test, removed at exit.
class Folder {
 public:
  Folder() : path_(parent() / ("pliant_fuzz_mesh_" + std::to_string(getpid()))) { fs::create_directories(path_); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] fs::path file(const std::string& extension) const { return path_ / ("input" + extension); }

 private:
  /// In memory where the system offers that: a busy disk can hold up one write for longer than an input may take.
  static fs::path parent() { return access("/dev/shm", W_OK | X_OK) == 0 ? fs::path("/dev/shm") : fs::temp_directory_path(); }

  fs::path path_;
};

void write(const fs::path& file, const char* data, std::size_t size) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(data, static_cast<std::streamsize>(size));
}

void check(bool holds) {
  if (!holds) std::abort();
}

template <class Elements>
void check_mesh(const std::vector<pliant::Vec3d>& vertices, const Elements& elements) {
  for (const pliant::Vec3d& v : vertices) check(std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]));
  for (const auto& element : elements) {
    for (const std::int32_t node : element) check(node >= 0 && static_cast<std::size_t>(node) < vertices.size());
  }
}

void check_volume(const fs::path& file) {
  const pliant::VolumeMesh mesh = pliant::read_volume(file);
  check_mesh(mesh.vertices, mesh.tets);
  check_mesh(mesh.vertices, mesh.hexes);
  check(!mesh.tets.empty() || !mesh.hexes.empty());
  check_mesh(mesh.vertices, pliant::boundary_triangles(mesh));
  // Its tags may be damaged although the mesh is not.
  pliant::MeshTags tags;
  const std::size_t elements = mesh.tets.size() + mesh.hexes.size();
  check(pliant::read_volume(file, 1, {}, &tags).vertices.size() == mesh.vertices.size());
  for (const auto& face : tags.faces) {
    for (const std::int32_t node : face) check(node >= -1 && node < static_cast<std::int32_t>(mesh.vertices.size()));
  }
  for (const pliant::MeshTags::Array& array : tags.arrays) {
    for (const pliant::MeshTags::Tag& tag : array.tags)
      check(tag.place >= 0 && static_cast<std::size_t>(tag.place) < (tag.dimension == 3 ? elements : tags.faces.size()));
  }
}

/// TetGen splits a mesh over two files: the text up to the first line "---" is the .node file, the rest the .ele file.
void check_tetgen(const Folder& folder, const std::string& text, const std::string& extension) {
  const std::size_t cut = text.find("---\n");
  const std::size_t end = cut == std::string::npos ? text.size() : cut;
  const std::size_t next = cut == std::string::npos ? text.size() : cut + 4;
  write(folder.file(".node"), text.data(), end);
  write(folder.file(".ele"), text.data() + next, text.size() - next);
  check_volume(folder.file(extension));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size == 0) return 0;
  const std::size_t format = data[0] % formats;
  const char* const bytes = reinterpret_cast<const char*>(data) + 1;
  try {
    if (format < surface_formats.size()) {
      const fs::path file = folder.file(surface_formats[format]);
      write(file, bytes, size - 1);
      const pliant::TriangleMesh mesh = pliant::read_surface(file);
      check(!mesh.triangles.empty());
      check_mesh(mesh.vertices, mesh.triangles);
      return 0;
    }
    const std::string extension = volume_formats[format - surface_formats.size()];
    if (extension == ".ele" || extension == ".node") {
      check_tetgen(folder, std::string(bytes, size - 1), extension);
      return 0;
    }
    write(folder.file(extension), bytes, size - 1);
    check_volume(folder.file(extension));
  } catch (const pliant::Error&) {
  }
  return 0;
}
