#include "scene/mesh_region.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <unordered_map>

#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"
#include "mesh_io/mesh_tags.h"
#include "pliant/error.h"

namespace pliant {

struct TaggedMesh::Content {
  VolumeMesh mesh;
  MeshTags tags;
  double slack = 0;  ///< [m]
  [[nodiscard]] std::vector<std::int32_t> corners(std::size_t element) const;
};

namespace {

using Triple = std::array<std::int32_t, 3>;

Triple sorted(Triple t) {
  std::sort(t.begin(), t.end());
  return t;
}

Vec3d middle(const std::vector<Vec3d>& vertices, std::span<const std::int32_t> of) {
  Vec3d sum{};
  for (const std::int32_t v : of) sum = vec::add(sum, vec::mul(vertices[v], 1.0 / static_cast<double>(of.size())));
  return sum;
}

}  // namespace

std::vector<std::int32_t> TaggedMesh::Content::corners(std::size_t element) const {
  if (element < mesh.tets.size()) return {mesh.tets[element].begin(), mesh.tets[element].end()};
  const auto& hex = mesh.hexes[element - mesh.tets.size()];
  return {hex.begin(), hex.end()};
}

TaggedMesh::TaggedMesh(std::filesystem::path file, double scale, const Vec3d& translate)
    : file_(std::move(file)), scale_(scale), translate_(translate) {}

TaggedMesh::~TaggedMesh() = default;

const TaggedMesh::Content& TaggedMesh::content() const {
  std::call_once(once_, [this] {
    auto content = std::make_unique<Content>();
    content->mesh = read_volume(file_, scale_, translate_, &content->tags);
    double largest = 0;
    for (const Vec3d& x : content->mesh.vertices) {
      for (const double v : x) largest = std::max(largest, std::fabs(v));
    }
    content->slack = std::max(1e-9 * largest, 1e-300);
    content_ = std::move(content);
  });
  return *content_;
}

const std::vector<double>& TaggedMesh::values(const std::string& name, const std::string& pointer) const {
  const MeshTags& tags = content().tags;
  if (const MeshTags::Values* found = tags.values_of(name)) return found->of;
  std::string has;
  for (const MeshTags::Values& v : tags.values) has += fmt::format("{}\"{}\"", has.empty() ? "" : ", ", v.name);
  throw Error(ErrorCode::bad_input, fmt::format("{}: got \"{}\": {} has {}, expected an array with one number per element",
                                                pointer, name, file_.string(), has.empty() ? "no numbers of elements" : has));
}

/// Of each node, element or triangle of the mesh its place and whether it belongs to the region.
struct MeshRegion::Members {
  /// Places on a grid of cells so small that hardly two share one.
  class Places {
   public:
    Places() = default;
    explicit Places(double slack) : slack_(slack), edge_(1e3 * slack) {}
    void add(const Vec3d& x) { at_[key(x, {0, 0, 0})].push_back(x); }
    [[nodiscard]] bool has(const Vec3d& x) const {
      for (int corner = 0; corner < 8; ++corner) {
        const auto shift = [&](int axis) { return (corner >> axis & 1) == 0 ? -slack_ : slack_; };
        const auto cell = at_.find(key(x, {shift(0), shift(1), shift(2)}));
        if (cell == at_.end()) continue;
        for (const Vec3d& y : cell->second) {
          if (vec::norm(vec::sub(x, y)) <= slack_) return true;
        }
      }
      return false;
    }

   private:
    [[nodiscard]] std::uint64_t key(const Vec3d& x, const Vec3d& shift) const {
      std::uint64_t h = 0;
      for (int a = 0; a < 3; ++a) {
        const double cell = std::floor((x[a] + shift[a]) / edge_);
        if (!(std::fabs(cell) < 1e18)) return 0;
        h = (h ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))) * 0x9e3779b97f4a7c15U;
      }
      return h;
    }

    double slack_ = 0, edge_ = 1;
    std::unordered_map<std::uint64_t, std::vector<Vec3d>> at_;
  };

  std::vector<Vec3d> place;
  std::vector<char> chosen;
  double slack = 0;
  Places places;  ///< of the chosen ones
};

MeshRegion::MeshRegion(std::shared_ptr<const TaggedMesh> mesh, RegionName name, Selected of, std::string pointer)
    : mesh_(std::move(mesh)), name_(std::move(name)), of_(of), pointer_(std::move(pointer)) {}

MeshRegion::~MeshRegion() = default;

namespace {

/// Which region of a file a name means.
class Named {
 public:
  Named(const RegionName& name, Selected of, const std::filesystem::path& file, const std::string& pointer)
      : name_(name), of_(of), file_(file), pointer_(pointer) {}

  [[nodiscard]] const MeshTags::Array& array(const MeshTags& tags) const {
    const MeshTags::Array* found = tags.find(name_.data);
    if (found != nullptr) return *found;
    std::string has;
    for (const MeshTags::Array& a : tags.arrays) has += fmt::format("{}\"{}\"", has.empty() ? "" : ", ", a.name);
    fail(has.empty() ? fmt::format("{} has no numbers of cells", file_.string())
                     : fmt::format("the numbers of cells in {} are {}", file_.string(), has),
         name_.data.empty()
             ? fmt::format("one of the usual names ({}), or its name as \"data\"", fmt::join(MeshTags::usual_arrays(), ", "))
             : fmt::format("an array \"{}\"", name_.data));
  }

  [[nodiscard]] MeshTags::Region region(const MeshTags& tags, const MeshTags::Array& array) const {
    const std::vector<MeshTags::Region> all = tags.regions(array);
    std::vector<MeshTags::Region> found;
    for (const MeshTags::Region& r : all) {
      const bool named = name_.name.empty() ? r.number == name_.number : r.name == name_.name;
      const bool fits = of_ != Selected::elements || r.dimension == 3;
      if (named && fits && (name_.dimension == 0 || r.dimension == name_.dimension)) found.push_back(r);
    }
    if (found.size() == 1) return found[0];
    if (found.empty()) {
      fail(fmt::format("no such region {}in {}",
                       of_ == Selected::elements || name_.dimension == 3 ? "of elements "
                       : name_.dimension == 2                            ? "of faces "
                                                                         : "",
                       file_.string()),
           fmt::format("one of {} (array \"{}\")", MeshTags::listed(all), array.name));
    }
    fail(fmt::format("{} in {}", MeshTags::listed(found), file_.string()),
         "one of them: \"dimension\": 2 (faces) or 3 (elements)");
  }

 private:
  [[noreturn]] void fail(const std::string& got, const std::string& expected) const {
    const std::string key = name_.name.empty() ? std::to_string(name_.number) : "\"" + name_.name + "\"";
    throw Error(ErrorCode::bad_input, fmt::format("{}: got {}: {}, expected {}", pointer_, key, got, expected));
  }

  const RegionName& name_;
  Selected of_;
  const std::filesystem::path& file_;
  const std::string& pointer_;
};

/// The corners of the region's elements or faces.
std::vector<std::vector<std::int32_t>> cells_of(const TaggedMesh::Content& content, const MeshTags::Array& array,
                                                const MeshTags::Region& region, std::vector<char>& elements) {
  std::vector<std::vector<std::int32_t>> cells;
  elements.assign(content.mesh.tets.size() + content.mesh.hexes.size(), 0);
  for (const MeshTags::Tag& tag : array.tags) {
    if (tag.dimension != region.dimension || tag.number != region.number) continue;
    if (tag.dimension == 3) {
      elements[tag.place] = 1;
      cells.push_back(content.corners(tag.place));
      continue;
    }
    const auto& face = content.tags.faces[tag.place];
    cells.emplace_back(face.begin(), face.end() - (face[3] < 0 ? 1 : 0));
  }
  return cells;
}

/// All that three corners of a cell can be: of boundary triangles only its own lie among them.
std::set<Triple> triples_of(const std::vector<std::vector<std::int32_t>>& cells) {
  std::set<Triple> out;
  for (const auto& c : cells) {
    for (std::size_t i = 0; i < c.size(); ++i) {
      for (std::size_t j = i + 1; j < c.size(); ++j) {
        for (std::size_t k = j + 1; k < c.size(); ++k) out.insert(sorted({c[i], c[j], c[k]}));
      }
    }
  }
  return out;
}

}  // namespace

void MeshRegion::find() const {
  const TaggedMesh::Content& content = mesh_->content();
  const Named named(name_, of_, mesh_->file(), pointer_);
  const MeshTags::Array& array = named.array(content.tags);
  const MeshTags::Region region = named.region(content.tags, array);
  auto members = std::make_unique<Members>();
  std::vector<char> elements;
  const std::vector<std::vector<std::int32_t>> cells = cells_of(content, array, region, elements);
  const VolumeMesh& mesh = content.mesh;
  if (of_ == Selected::nodes) {
    members->place = mesh.vertices;
    members->chosen.assign(mesh.vertices.size(), 0);
    for (const auto& cell : cells) {
      for (const std::int32_t v : cell) members->chosen[v] = 1;
    }
  } else if (of_ == Selected::elements) {
    members->chosen = std::move(elements);
    for (std::size_t e = 0; e < members->chosen.size(); ++e)
      members->place.push_back(middle(mesh.vertices, content.corners(e)));
  } else {
    const std::set<Triple> triples = triples_of(cells);
    for (const Triple& t : boundary_triangles(mesh)) {
      members->place.push_back(middle(mesh.vertices, t));
      members->chosen.push_back(triples.contains(sorted(t)) ? 1 : 0);
    }
  }
  members->slack = content.slack;
  members->places = Members::Places(content.slack);
  for (std::size_t i = 0; i < members->place.size(); ++i) {
    if (members->chosen[i] != 0) members->places.add(members->place[i]);
  }
  members_ = std::move(members);
}

bool MeshRegion::contains(const Vec3d& x, std::int64_t index) const {
  std::call_once(once_, [this] { find(); });
  const Members& m = *members_;
  const auto i = static_cast<std::size_t>(index);
  if (index >= 0 && i < m.place.size() && vec::norm(vec::sub(x, m.place[i])) <= m.slack) return m.chosen[i] != 0;
  return m.places.has(x);
}

}  // namespace pliant
