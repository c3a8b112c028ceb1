// Where and when: selections and curves.
#include <fmt/format.h>

#include <algorithm>

#include "scene/closed_surface.h"
#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

constexpr std::int64_t largest_index = 2147483647;  // node indices are int32 on the device

Selection read_box(const Reader& box) {
  const char* const expected = "two corners [[x, y, z], [x, y, z]], lower first";
  const std::vector<Reader> corners = box.items(expected);
  if (corners.size() != 2) box.fail(expected);
  Selection s;
  s.kind = Selection::Kind::box;
  s.a = corners[0].vec3();
  s.b = corners[1].vec3();
  for (int c = 0; c < 3; ++c) {
    if (s.a[c] > s.b[c]) {
      box.fail(fmt::format("{} from {} to {}", "xyz"[c], s.a[c], s.b[c]),
               "the lower corner first: no component above that of the second");
    }
  }
  return s;
}

Selection read_sphere(const Reader& sphere) {
  const char* const expected = "a centre and a radius [[x, y, z], r]";
  const std::vector<Reader> parts = sphere.items(expected);
  if (parts.size() != 2) sphere.fail(expected);
  Selection s;
  s.kind = Selection::Kind::sphere;
  s.a = parts[0].vec3();
  s.radius = parts[1].positive();
  return s;
}

Selection read_plane(const Reader& plane) {
  const char* const expected = "a point and a normal [[x, y, z], [x, y, z]]";
  const std::vector<Reader> parts = plane.items(expected);
  if (parts.size() != 2) plane.fail(expected);
  Selection s;
  s.kind = Selection::Kind::plane;
  s.a = parts[0].vec3();
  s.b = parts[1].vec3();
  const double largest = std::max({s.b[0], s.b[1], s.b[2], -s.b[0], -s.b[1], -s.b[2]});
  if (!(largest >= 1e-30)) parts[1].fail("a normal that is not zero");
  return s;
}

Selection read_nodes(const Reader& nodes) {
  Selection s;
  s.kind = Selection::Kind::nodes;
  for (const Reader& index : nodes.items("a list of at least one node index", 1))
    s.nodes.push_back(index.integer(0, largest_index));
  std::sort(s.nodes.begin(), s.nodes.end());
  const auto twice = std::adjacent_find(s.nodes.begin(), s.nodes.end());
  if (twice != s.nodes.end()) nodes.fail(fmt::format("node {} twice", *twice), "every index at most once");
  return s;
}

RegionName read_region_name(const Reader& entry, const SelectionFrame& frame) {
  const Reader region = entry.at("region");
  if (frame.mesh == nullptr) {
    region.fail(
        "no region in a body that is a surface filled with a lattice: only the files of volume meshes have them (give a "
        "closed \"surface\" around the part instead)");
  }
  RegionName name;
  if (region.json().is_string()) {
    name.name = region.text("the name of a physical group");
  } else {
    constexpr std::int64_t most = 9007199254740992;  // 2^53
    if (!region.json().is_number_integer()) region.fail("a tag of the mesh file, or the name of one");
    name.number = region.integer(-most, most);
  }
  if (entry.has("data")) name.data = entry.at("data").text("the name of an array of the mesh file");
  if (entry.has("dimension")) name.dimension = static_cast<int>(entry.at("dimension").integer(2, 3));
  return name;
}

}  // namespace

SelectionFrame frame_of(const Body& body, const std::filesystem::path& folder) {
  SelectionFrame frame{folder, body.scale, body.translate};
  if (!body.mesh.empty()) frame.mesh = std::make_shared<const TaggedMesh>(body.mesh, body.scale, body.translate);
  return frame;
}

Selection read_selection(const Reader& entry, Selected of, const SelectionFrame& frame) {
  const std::string expected =
      std::string("exactly one of box, sphere, plane, surface, region, ") + (of == Selected::nodes ? "nodes, all" : "all");
  std::vector<std::string> given;
  for (const char* key : {"box", "sphere", "plane", "surface", "region", "nodes", "all"}) {
    if (entry.has(key)) given.emplace_back(key);
  }
  if (given.size() != 1) entry.fail(given.empty() ? "no selection" : listed(given), expected);
  for (const char* key : {"data", "dimension"}) {
    if (entry.has(key) && given[0] != "region") entry.at(key).fail(fmt::format("no \"{}\" with \"{}\"", key, given[0]));
  }

  const std::string& key = given.front();
  const Reader value = entry.at(key);
  Selection s;
  if (key == "box") s = read_box(value);
  if (key == "sphere") s = read_sphere(value);
  if (key == "plane") s = read_plane(value);
  if (key == "nodes") s = read_nodes(value);
  if (key == "surface") {
    const std::filesystem::path file = value.text("the path of a closed surface");
    s.kind = Selection::Kind::surface;
    s.surface = std::make_shared<const ClosedSurface>(file.is_absolute() ? file : frame.folder / file, frame.scale,
                                                      frame.translate, value.pointer());
  }
  if (key == "region") {
    s.kind = Selection::Kind::region;
    s.region = std::make_shared<const MeshRegion>(frame.mesh, read_region_name(entry, frame), of, value.pointer());
  }
  if (key == "all" && !value.boolean()) value.fail("true (or another selection)");
  s.pointer = entry.pointer();
  return s;
}

Curve read_curve(const Reader& entry) {
  Curve curve;
  const bool table = entry.has("table");
  if (table) curve.kind = Curve::Kind::table;
  describe_curve(ReadKeys{entry}, curve);
  if (table && curve.kind != Curve::Kind::table) entry.at("curve").fail("table, because the entry has a \"table\"");
  if (curve.kind == Curve::Kind::table) {
    for (const char* key : {"start", "duration"}) {
      if (entry.has(key)) entry.at(key).fail(fmt::format("no {} with a table (the table has its own times)", key));
    }
    curve.table =
        read_rows<2>(entry.at("table", "the rows of the table curve"), "a list of rows [time, factor]", "a row [time, factor]");
  } else if (curve.kind == Curve::Kind::constant && entry.has("duration")) {
    entry.at("duration").fail("no duration with a constant curve (set \"curve\" to ramp or smooth)");
  } else if (curve.kind != Curve::Kind::constant) {
    (void)entry.at("duration", "the duration of the curve in seconds");
  }
  return curve;
}

}  // namespace pliant
