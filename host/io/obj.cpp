#include "io/obj.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Lines of a file that appears when it is complete.
class ObjFile {
 public:
  explicit ObjFile(const std::filesystem::path& file) : name_(file.string()), out_(file) {}

  template <class... Arguments>
  void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(line_), format, std::forward<Arguments>(arguments)...);
    line_.push_back('\n');
    out_.write(line_.data(), line_.size());
    line_.clear();
  }
  void vectors(const char* key, const std::vector<Vec3d>& list) {
    for (const Vec3d& v : list) line("{} {:.9g} {:.9g} {:.9g}", key, v[0], v[1], v[2]);
  }
  /// The number of an entry in the file. Throws Error (internal) where there is none.
  [[nodiscard]] std::int32_t number(std::int32_t index, std::size_t count, const char* what) const {
    if (index >= 0 && static_cast<std::size_t>(index) < count) return index + 1;
    throw Error(ErrorCode::internal, fmt::format("cannot write '{}': a triangle names {} {} of {}", name_, what, index, count));
  }
  void require(bool fits, const std::string& what) const {
    if (!fits) throw Error(ErrorCode::internal, fmt::format("cannot write '{}': {}", name_, what));
  }
  void commit() { out_.commit(); }

 private:
  std::string name_;
  AtomicFile out_;
  fmt::memory_buffer line_;
};

}  // namespace

void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh, const std::vector<Vec3d>& normals) {
  ObjFile out(file);
  out.require(normals.empty() || normals.size() == mesh.vertices.size(),
              fmt::format("{} normals for {} vertices", normals.size(), mesh.vertices.size()));
  out.vectors("v", mesh.vertices);
  out.vectors("vn", normals);
  for (const auto& t : mesh.triangles) {
    std::array<std::int32_t, 3> n{};
    for (std::size_t k = 0; k < 3; ++k) n[k] = out.number(t[k], mesh.vertices.size(), "vertex");
    if (normals.empty()) {
      out.line("f {} {} {}", n[0], n[1], n[2]);
    } else {
      out.line("f {0}//{0} {1}//{1} {2}//{2}", n[0], n[1], n[2]);
    }
  }
  out.commit();
}

void write_textured_obj(const std::filesystem::path& file, const TriangleMesh& mesh, const ObjCorners& corners) {
  ObjFile out(file);
  const std::size_t triangles = mesh.triangles.size();
  out.require(corners.normal_of.size() == triangles && corners.texture_of.size() == triangles &&
                  (corners.cut.empty() || corners.cut.size() == triangles),
              fmt::format("attributes of {} corners for {} triangles", corners.normal_of.size(), triangles));
  out.vectors("v", mesh.vertices);
  for (const auto& [u, v] : corners.texture) out.line("vt {:.9g} {:.9g}", u, v);
  out.vectors("vn", corners.normals);
  for (const bool cut : {false, true}) {
    bool begun = false;
    for (std::size_t t = 0; t < triangles; ++t) {
      if ((!corners.cut.empty() && corners.cut[t] != 0) != cut) continue;
      if (!std::exchange(begun, true)) out.line("g {}", cut ? "cut" : "skin");
      std::string face = "f";
      for (std::size_t k = 0; k < 3; ++k) {
        face += fmt::format(" {}/{}/{}", out.number(mesh.triangles[t][k], mesh.vertices.size(), "vertex"),
                            out.number(corners.texture_of[t][k], corners.texture.size(), "texture coordinates"),
                            out.number(corners.normal_of[t][k], corners.normals.size(), "normal"));
      }
      out.line("{}", face);
    }
  }
  out.commit();
}

}  // namespace pliant
