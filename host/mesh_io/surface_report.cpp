#include "mesh_io/surface_report.h"

#include <fmt/format.h>

#include <cmath>

#include "pliant/error.h"

namespace pliant {
namespace {

// A closed surface whose volume is at most this times its area^(3/2) counts as a sheet whose two sides coincide.
constexpr double kFlatSurface = 1e-9;
// Largest relative difference between the volume of the lattice and that inside the surface before a remark is made.
constexpr double kDisagree = 0.05;

std::string at(const Vec3d& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p[0], p[1], p[2]); }

std::string holes(const SurfaceReport& r) {
  const Hole& largest = r.holes[0];
  return fmt::format(
      "holes: {}, of {} edges and {:.3g} m^2 together, {:.3g} % of the area; the largest, of {} edges and {:.3g} m^2, is at {}",
      r.holes.size(), r.hole_edges(), r.hole_area(), 100 * r.hole_area() / (r.area - r.sheet_area), largest.edges, largest.area,
      at(largest.centre));
}

[[noreturn]] void fail(const SurfaceReport& r, const std::string& what) {
  throw Error(ErrorCode::bad_input, fmt::format("surface mesh '{}': {}", r.name, what));
}

}  // namespace

double SurfaceReport::hole_area() const {
  double sum = 0;
  for (const Hole& hole : holes) sum += hole.area;
  return sum;
}

std::int64_t SurfaceReport::hole_edges() const {
  std::int64_t sum = 0;
  for (const Hole& hole : holes) sum += hole.edges;
  return sum;
}

void require_inside(const SurfaceReport& r) {
  const char* const mend = "close it in a mesh editor, or make it a sheet with \"thickness\"";
  if (r.sheet_area > 0.5 * r.area) {
    fail(r, fmt::format("has no inside to fill: {} of its {} triangles, {:.3g} % of the area, the first at {}, belong to parts "
                        "whose holes are larger than {:.0f} % of the part; {}",
                        r.sheet_triangles, r.triangles, 100 * r.sheet_area / r.area, at(r.sheet_at), 100 * kLargestHole, mend));
  }
  if (r.hole_area() > kLargestHole * (r.area - r.sheet_area)) {
    fail(r, fmt::format("has no inside to fill: {}; up to {:.0f} % are closed; {}", holes(r), 100 * kLargestHole, mend));
  }
  if (!(r.volume > kFlatSurface * std::pow(r.area, 1.5))) {
    fail(r, fmt::format("has no inside to fill: its {:.3g} m^2 enclose {:.3g} m^3; {}", r.area, r.volume, mend));
  }
}

std::vector<std::string> surface_warnings(const SurfaceReport& r, const Crossings& crossings, double filled) {
  std::vector<std::string> out;
  const auto say = [&](const std::string& text) { out.push_back(fmt::format("surface mesh '{}': {}", r.name, text)); };
  if (r.merged > 0)
    say(fmt::format("points in the place of another, merged with it: {}, the first at {}", r.merged, at(r.merged_at)));
  if (r.degenerate > 0) {
    say(fmt::format("triangles without area, dropped: {}, the first at {}", r.degenerate, at(r.degenerate_at)));
  }
  if (r.doubled > 0) {
    say(fmt::format("triangles in the place of another: {}, of these dropped: {}, the first at {}{}", r.doubled,
                    r.doubled_dropped, at(r.doubled_at),
                    r.doubled > r.doubled_dropped ? "; those that are left belong to parts that touch or overlap" : ""));
  }
  if (r.flipped == r.triangles) {
    say(fmt::format("all {} triangles were wound inward and were turned round", r.triangles));
  } else if (r.flipped > 0) {
    say(fmt::format("triangles wound against the rest, turned round: {} of {}, the first at {}", r.flipped, r.triangles,
                    at(r.flipped_at)));
  }
  if (r.sheet_triangles > 0) {
    say(fmt::format(
        "triangles of open sheets that bound nothing: {}, the first at {}; they move along with the body, but nothing is "
        "filled there",
        r.sheet_triangles, at(r.sheet_at)));
  }
  if (!r.holes.empty()) say(holes(r) + "; the body ends there as if they were closed");
  if (crossings.pairs > 0) {
    say(fmt::format(
        "pairs of triangles that pass through each other: {} ({} of them of two parts), the first at {}; volume inside "
        "several parts counts once",
        crossings.pairs, crossings.between_shells, at(crossings.place)));
  }
  if (crossings.searched < 1) {
    say(fmt::format("the search for triangles that pass through each other was cut short after {:.0f} % of them",
                    100 * crossings.searched));
  }
  if (r.volume > 0 && std::abs(filled / r.volume - 1) > kDisagree) {
    say(fmt::format(
        "the elements fill {:.6g} m^3, the surface encloses {:.6g} m^3 ({:+.3g} %): parts that overlap count once in the "
        "elements, and a spacing that is coarse for thin parts shows here",
        filled, r.volume, 100 * (filled / r.volume - 1)));
  }
  return out;
}

}  // namespace pliant
