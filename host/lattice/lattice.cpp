#include "lattice/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/defects.h"
#include "lattice/lattice_parts.h"
#include "pliant/error.h"

namespace pliant {
namespace {

constexpr double kTolerance = 0.02;    // on the number of nodes
constexpr double kGoodEnough = 0.005;  // the search ends here
constexpr int kSteps = 24;             // evaluations of the bracketing search
constexpr int kLeastSteps = 8;         // of these, whatever they cost
constexpr int kScan = 160;             // evaluations of the local search, for small lattices only
constexpr std::int64_t kSmall = 20'000;
constexpr std::int64_t kFarTooMany = 4;  // cells for each node that is wanted
// Amount of work (Parts::work) after which the search accepts its best result; takes a few seconds.
constexpr std::int64_t kEnough = 2'000'000;

Lattice fill(const SurfaceDistance& surface, double spacing, std::int64_t max_cells, bool embed, std::int64_t* work = nullptr) {
  const Grid grid(surface.tree().bounds(), spacing);
  Parts parts(surface, grid, max_cells);
  if (work != nullptr) *work += parts.work;
  Contacts contacts(parts, surface, grid);
  const std::vector<char> drop = contacts.mend();
  if (std::find(drop.begin(), drop.end(), 1) != drop.end()) {
    parts.remove(drop);
    contacts.mend();  // the ties name parts by index
  }
  Lattice lattice;
  lattice.origin = grid.origin;
  lattice.spacing = spacing;
  lattice.size = grid.size;
  number_nodes(parts, contacts, lattice);
  if (embed) lattice.embedding = embed_vertices(surface, grid, parts);
  return lattice;
}

// Finds the spacing whose lattice has `wanted` nodes. The number of nodes falls with the spacing, but in jumps that are not
// quite monotone (the grid moves against the surface), so a bracketing search is followed by a scan of its neighbourhood.
class SpacingSearch {
 public:
  SpacingSearch(const SurfaceDistance& surface, std::int64_t wanted, std::int64_t max_cells)
      : surface_(surface), wanted_(wanted), max_cells_(max_cells) {}

  double run() {
    bracket();
    if (best_ == 0) throw Error(*failure_);
    if (error() > kTolerance && wanted_ <= kSmall) scan();
    return best_;
  }

 private:
  double evaluate(double spacing) {
    const std::int64_t limit = std::min(max_cells_, kFarTooMany * wanted_ + kSmall);
    std::int64_t nodes = 0;
    try {
      nodes = static_cast<std::int64_t>(fill(surface_, spacing, limit, false, &work_).nodes.size());
    } catch (const Error& error) {  // far too many cells: not worth counting
      failure_ = error;
      work_ += limit;
      return static_cast<double>(16 * kFarTooMany * wanted_);
    }
    if (best_ == 0 || std::abs(nodes - wanted_) < std::abs(best_nodes_ - wanted_)) {
      best_ = spacing;
      best_nodes_ = nodes;
    }
    return static_cast<double>(nodes);
  }
  [[nodiscard]] double error() const {
    return std::abs(static_cast<double>(best_nodes_ - wanted_)) / static_cast<double>(wanted_);
  }

  void bracket() {
    const vec::Box& box = surface_.tree().bounds();
    const Vec3d extent = vec::sub(box.upper, box.lower);
    const double longest = std::max({extent[0], extent[1], extent[2]}), n = static_cast<double>(wanted_);
    const double volume = std::max(std::abs(signed_volume(surface_.mesh())), 1e-6 * longest * longest * longest);
    double spacing = std::min(longest, 1.2 * std::cbrt(volume / n)), low = 0, high = 1.001 * longest;
    // A thin body has its cells along its surface: by its volume there would be far too many.
    const double thin = std::min(longest, std::sqrt(area() / n));
    if (thin > 4 * spacing) spacing = thin;
    for (int step = 0; step < kSteps; ++step) {
      const double nodes = evaluate(spacing);
      if (error() <= kGoodEnough || (work_ > kEnough && (error() <= kTolerance || step >= kLeastSteps))) return;
      (nodes < n ? high : low) = spacing;
      double next = spacing * std::cbrt(nodes / n);
      // Outside the bracket, or no longer converging: halve it.
      if (!(next > low && next < high) || step > kSteps / 2) next = low > 0 ? std::sqrt(low * high) : high / 2;
      if (std::abs(next - spacing) < 1e-9 * spacing) return;
      spacing = next;
    }
  }

  void scan() {
    const double centre = best_;
    for (int i = 0; i < kScan && error() > kGoodEnough && work_ <= kEnough; ++i) {
      const int offset = (i + 2) / 2 * (i % 2 == 0 ? 1 : -1);  // outwards from the centre, both ways
      evaluate(centre * std::exp(0.25 * offset / (kScan / 2)));
    }
  }

  [[nodiscard]] double area() const {
    double sum = 0;
    for (std::size_t t = 0; t < surface_.mesh().triangles.size(); ++t)
      sum += area_of(surface_.mesh(), static_cast<std::int64_t>(t));
    return sum;
  }

  const SurfaceDistance& surface_;
  std::int64_t wanted_, max_cells_;
  double best_ = 0;
  std::int64_t best_nodes_ = 0, work_ = 0;
  std::optional<Error> failure_;
};

}  // namespace

Lattice build_lattice(const TriangleMesh& surface, const LatticeSpec& spec, std::int64_t max_cells) {
  const bool by_nodes = spec.nodes != 0;
  if (by_nodes && spec.nodes < 8) {
    throw Error(ErrorCode::bad_input,
                fmt::format("lattice nodes is {}; a lattice has at least the 8 nodes of one cell", spec.nodes));
  }
  if (spec.nodes > max_cells) {
    throw Error(ErrorCode::bad_input, fmt::format("lattice nodes is {}; at most {} are allowed", spec.nodes, max_cells));
  }
  if (!by_nodes && !(spec.spacing > 0 && std::isfinite(spec.spacing))) {
    throw Error(ErrorCode::bad_input, fmt::format("lattice spacing is {} m; a positive number is needed", spec.spacing));
  }
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    if (!vec::finite(surface.vertices[v])) throw Error(ErrorCode::bad_input, fmt::format("surface vertex {} is not finite", v));
  }
  std::optional<SurfaceDistance> distance(surface);
  if (!distance->orientation().closed()) {
    const std::vector<char> sheets = sheets_of(distance->mesh(), distance->orientation());
    if (!sheets.empty() && std::find(sheets.begin(), sheets.end(), 0) != sheets.end()) {
      const TriangleMesh rest = without(distance->mesh(), sheets);
      distance.emplace(rest);
    }
  }
  const double spacing = by_nodes ? SpacingSearch(*distance, spec.nodes, max_cells).run() : spec.spacing;
  return fill(*distance, spacing, max_cells, true);
}

}  // namespace pliant
