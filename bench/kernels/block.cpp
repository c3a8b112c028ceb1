#include "bench/kernels/block.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "pliant/error.h"

namespace pliant::bench {
namespace {

/// A cube of edge `size` as an OBJ file that goes when this object goes.
class BoxFile {
 public:
  explicit BoxFile(double size)
      : path_(std::filesystem::temp_directory_path() / fmt::format("pliant-block-{:08x}.obj", std::random_device{}())) {
    std::ofstream out(path_);
    for (int a = 0; a < 8; ++a) out << fmt::format("v {} {} {}\n", size * (a & 1), size * (a >> 1 & 1), size * (a >> 2 & 1));
    for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"}) out << "f " << face << '\n';
    if (!out.flush()) throw Error(ErrorCode::bad_input, fmt::format("{}: cannot be written", path_.string()));
  }
  ~BoxFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  BoxFile(const BoxFile&) = delete;
  BoxFile& operator=(const BoxFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

Block make_block(ElementKind element, Law law, std::int64_t elements) {
  const bool tets = element == ElementKind::tet4 || element == ElementKind::tet4anp;
  const auto cells = static_cast<int>(std::lround(std::cbrt(static_cast<double>(elements) / (tets ? 6 : 1))));
  const double size = 0.1;
  const BoxFile box(size);
  Block block;
  block.scene.name = fmt::format("block of {} elements", elements);
  block.scene.gravity = {0, -9.81, 0};
  Body body;
  body.name = "block";
  body.surface = box.path();
  body.lattice.spacing = size / cells;
  body.element = element;
  Material& m = body.material;
  m.set_moduli(law, Moduli::from_young(3000, 0.45));
  m.density = 1000;
  m.damping = 5;
  Fixed fixed;
  fixed.where.kind = Selection::Kind::box;
  fixed.where.a = {-1, -1e-6, -1};
  fixed.where.b = {1, 1e-6, 1};
  body.fixed.push_back(fixed);
  block.scene.bodies.push_back(body);
  block.model = std::make_shared<const Model>(build_model(block.scene));
  block.scene.dt = 0.9 * block.model->element_bound;
  return block;
}

}  // namespace pliant::bench
