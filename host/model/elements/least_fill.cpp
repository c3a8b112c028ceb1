#include "model/elements/least_fill.h"

#include <algorithm>
#include <cstdint>
#include <map>

namespace pliant {
namespace {

/// Raises the thin copies of a cell at the cost of the others. `first`: an element of each copy, of `parts` elements.
void share(const std::vector<std::size_t>& first, double least, std::vector<double>& fill) {
  double material = 0, over = 0, excess = 0;
  for (const std::size_t e : first) material += fill[e];
  if (std::all_of(first.begin(), first.end(), [&](std::size_t e) { return fill[e] >= least; })) return;
  const double whole = std::max(material, least), lowest = std::min(least, whole / static_cast<double>(first.size()));
  for (const std::size_t e : first) {
    fill[e] = std::max(fill[e] * (whole / material), lowest);
    over += fill[e] - lowest;
    excess += fill[e];
  }
  excess -= whole;
  if (!(over > 0)) return;
  for (const std::size_t e : first) fill[e] -= excess / over * (fill[e] - lowest);  // over - excess = whole - n lowest >= 0
}

}  // namespace

std::vector<double> stiff_fills(const BodyElements& solid, double least) {
  std::vector<double> fill = solid.fill;
  if (!(least > 0)) return fill;
  const std::size_t parts = solid.copy_of.empty() ? 1 : fill.size() / solid.copy_of.size();
  std::map<std::int32_t, std::vector<std::size_t>> divided;  // first elements of a cell's copies, of cells that have several
  std::vector<std::size_t> seen(solid.copy_of.size());       // the first copy of each cell, plus one; cells come before copies
  for (std::size_t c = 0; c < solid.copy_of.size(); ++c) {
    const std::int32_t cell = solid.copy_of[c];
    if (!(fill[parts * c] > 0)) continue;
    std::size_t& other = seen[static_cast<std::size_t>(cell)];
    if (other == 0) {
      other = c + 1;
      continue;
    }
    std::vector<std::size_t>& copies = divided[cell];
    if (copies.empty()) copies.push_back(parts * (other - 1));
    copies.push_back(parts * c);
  }
  std::vector<char> done(fill.size());
  for (const auto& [cell, copies] : divided) {
    share(copies, least, fill);
    for (const std::size_t e : copies) {
      for (std::size_t p = 0; p < parts; ++p) {
        fill[e + p] = fill[e];
        done[e + p] = 1;
      }
    }
  }
  for (std::size_t e = 0; e < fill.size(); ++e) {
    if (!done[e] && fill[e] > 0) fill[e] = std::max(fill[e], least);
  }
  return fill;
}

}  // namespace pliant
