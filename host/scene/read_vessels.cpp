// The key "vessels" of a body.
#include <fmt/format.h>

#include "geometry/vec.h"
#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {
namespace {

std::vector<std::array<std::int32_t, 2>> read_segments(const Reader& segments, std::size_t points) {
  const std::string expected = fmt::format("two different numbers of points, from 0 to {}", points - 1);
  std::vector<std::array<std::int32_t, 2>> out;
  for (const Reader& row : segments.items("a list of pairs [from, to]", 1)) {
    const std::vector<Reader> ends = row.items(expected);
    if (ends.size() != 2) row.fail(expected);
    std::array<std::int32_t, 2> pair{};
    for (std::size_t i = 0; i < 2; ++i)
      pair[i] = static_cast<std::int32_t>(ends[i].integer(0, static_cast<std::int64_t>(points) - 1));
    if (pair[0] == pair[1]) row.fail(expected);
    out.push_back(pair);
  }
  return out;
}

}  // namespace

Vessel read_vessel(const Reader& entry) {
  entry.expect_object("vessel");
  Vessel vessel;
  vessel.pointer = entry.pointer();
  const Reader points = entry.at("points", "a list of at least two places [x, y, z]");
  for (const Reader& point : points.items("a list of at least two places [x, y, z]", 2)) vessel.points.push_back(point.vec3());
  const std::size_t count = vessel.points.size();
  if (entry.has("segments")) {
    vessel.segments = read_segments(entry.at("segments"), count);
  } else {
    for (std::size_t i = 0; i + 1 < count; ++i)
      vessel.segments.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(i) + 1});
  }
  for (const auto& [from, to] : vessel.segments) {
    if (vessel.points[static_cast<std::size_t>(from)] == vessel.points[static_cast<std::size_t>(to)])
      points.fail(fmt::format("points {} and {}, which a segment connects, at different places", from, to));
  }
  describe_vessel(ReadKeys{entry}, vessel);
  if (vessel.wall >= vessel.radius && vessel.wall > 0)
    entry.at("wall").fail(fmt::format("a wall thinner than the radius, {} m", vessel.radius));
  return vessel;
}

}  // namespace pliant
