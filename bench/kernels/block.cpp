#include "bench/kernels/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <utility>

#include "geometry/mesh.h"
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

namespace {

/// Under gravity, held at the bottom.
Body held_body(Law law) {
  Body body;
  body.name = "block";
  Material& m = body.material;
  m.set_moduli(law, Moduli::from_young(3000, 0.45));
  m.density = 1000;
  m.damping = 5;
  Fixed fixed;
  fixed.where.kind = Selection::Kind::box;
  fixed.where.a = {-1, -1e-6, -1};
  fixed.where.b = {1, 1e-6, 1};
  body.fixed.push_back(fixed);
  return body;
}

Block block_of(Body body, const std::string& name) {
  Block block;
  block.scene.name = name;
  block.scene.gravity = {0, -9.81, 0};
  block.scene.bodies.push_back(std::move(body));
  block.model = std::make_shared<const Model>(build_model(block.scene));
  block.scene.dt = 0.9 * block.model->element_bound;
  block.counted = block.model->elements();
  return block;
}

int cells_along(double cells) { return std::max(1, static_cast<int>(std::lround(std::cbrt(cells)))); }

}  // namespace

Block make_block(ElementKind element, Law law, std::int64_t elements) {
  const bool tets = element == ElementKind::tet4 || element == ElementKind::tet4anp;
  const double size = 0.1;
  const BoxFile box(size);
  Body body = held_body(law);
  body.surface = box.path();
  body.lattice.spacing = size / cells_along(static_cast<double>(elements) / (tets ? 6 : 1));
  body.element = element;
  return block_of(std::move(body), fmt::format("block of {} elements", elements));
}

Block make_network(std::int64_t springs) {
  const double size = 0.1;
  const BoxFile box(size);
  Body body = held_body(Law::neo_hookean);
  body.surface = box.path();
  body.lattice.spacing = size / cells_along(static_cast<double>(springs) / 7);
  body.element = ElementKind::tet4;
  body.model.type = ModelType::mass_spring;
  Block block = block_of(std::move(body), fmt::format("network of {} springs", springs));
  block.counted = static_cast<std::int64_t>(block.model->links.springs.at(0).size());
  return block;
}

Block make_membrane(std::int64_t triangles) {
  const auto cells = std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 4))));
  const double edge = 0.1 / cells;
  auto surface = std::make_shared<TriangleMesh>();
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) surface->vertices.push_back({i * edge, j * edge, 0});
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const std::int32_t a = j * (cells + 1) + i;
      surface->triangles.insert(surface->triangles.end(), {{a, a + 1, a + cells + 2}, {a, a + cells + 2, a + cells + 1}});
    }
  }
  Body body = held_body(Law::neo_hookean);
  body.surface = "sheet";
  body.surface_in_memory = std::move(surface);
  body.thickness = edge;
  body.element = ElementKind::tet4;
  body.model.type = ModelType::mass_spring;
  body.membrane = Membrane{.thickness = edge / 100, .young = 3e4, .poisson = 0.4, .density = 1000};
  Block block = block_of(std::move(body), fmt::format("membrane of {} triangles", triangles));
  block.counted = static_cast<std::int64_t>(block.model->links.membranes.at(0).size());
  return block;
}

}  // namespace pliant::bench
