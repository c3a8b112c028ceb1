#include "io/obj.h"

#include <fmt/format.h>

#include <iterator>

#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant {

void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh, const std::vector<Vec3d>& normals) {
  if (!normals.empty() && normals.size() != mesh.vertices.size()) {
    throw Error(ErrorCode::internal, fmt::format("cannot write '{}': {} normals for {} vertices", file.string(), normals.size(),
                                                 mesh.vertices.size()));
  }
  AtomicFile out(file);
  fmt::memory_buffer line;
  const auto send = [&] {
    out.write(line.data(), line.size());
    line.clear();
  };
  for (const Vec3d& v : mesh.vertices) {
    fmt::format_to(std::back_inserter(line), "v {:.9g} {:.9g} {:.9g}\n", v[0], v[1], v[2]);
    send();
  }
  for (const Vec3d& n : normals) {
    fmt::format_to(std::back_inserter(line), "vn {:.9g} {:.9g} {:.9g}\n", n[0], n[1], n[2]);
    send();
  }
  for (const auto& t : mesh.triangles) {
    line.push_back('f');
    for (const std::int32_t i : t) {
      if (i < 0 || static_cast<std::size_t>(i) >= mesh.vertices.size()) {
        throw Error(ErrorCode::internal,
                    fmt::format("cannot write '{}': a triangle names vertex {} of {}", file.string(), i, mesh.vertices.size()));
      }
      if (normals.empty()) {
        fmt::format_to(std::back_inserter(line), " {}", i + 1);
      } else {
        fmt::format_to(std::back_inserter(line), " {0}//{0}", i + 1);
      }
    }
    line.push_back('\n');
    send();
  }
  out.commit();
}

}  // namespace pliant
