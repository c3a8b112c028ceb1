// The Program of the embedded surface: four buffers and one pass, either separate from the Program of the steps or part of
// it.
#include "schedule/surface_program.h"

#include <algorithm>

#include "schedule/program_builder.h"

namespace pliant {
namespace {

/// Ranges of the tiles that contain vertices, with `width` values per vertex.
std::vector<ValueRange> tiles_of(const std::vector<std::int32_t>& vertices, std::size_t width) {
  std::vector<ValueRange> ranges;
  for (const std::int32_t v : vertices) {
    const std::size_t tile = static_cast<std::size_t>(v) / PLIANT_TILE * PLIANT_TILE;
    if (ranges.empty() || ranges.back().last <= width * tile) {
      ranges.push_back({width * tile, width * (tile + PLIANT_TILE)});
    }
  }
  return ranges;
}

}  // namespace

namespace {

/// The first three of its buffers in order; surface_x is the fourth.
struct Rows {
  explicit Rows(Program& program)
      : rest(program.buffers[0]), node(program.buffers[1]), weight(program.buffers[2]), x(program.buffers[3]) {}
  Buffer &rest, &node, &weight, &x;
};

std::size_t width_of(const ModelSurface& s) {
  const bool single = std::all_of(s.weights.begin(), s.weights.end(), [](const auto& w) { return w[0] == 1 && w[1] == 0; });
  return single ? 1 : 8;
}

/// Writes the listed vertices, or all.
void fill(const ModelSurface& s, std::size_t width, const SurfaceChanges* changes, Rows rows) {
  const std::size_t count = padded(s.rest.size());
  rows.rest.count = rows.x.count = count;
  rows.node.count = rows.weight.count = width * count;
  const auto place = [&](std::size_t v) {
    std::copy(s.rest[v].begin(), s.rest[v].end(), &rows.rest.reals[4 * v]);
    for (std::size_t a = 0; a < width; ++a) rows.weight.reals[tile_base(v, width) + a * PLIANT_TILE] = s.weights[v][a];
  };
  const auto embed = [&](std::size_t v) {
    for (std::size_t a = 0; a < width; ++a) rows.node.ints[tile_base(v, width) + a * PLIANT_TILE] = s.nodes[v][a];
  };
  rows.rest.reals.resize(4 * count, 0.0);
  rows.weight.reals.resize(width * count, 0.0);
  rows.node.ints.resize(width * count, 0);
  if (changes == nullptr) {
    for (std::size_t v = 0; v < s.rest.size(); ++v) {
      place(v);
      embed(v);
    }
    return;
  }
  for (const std::int32_t v : changes->vertices) place(static_cast<std::size_t>(v));
  for (const std::int32_t v : changes->reembedded) embed(static_cast<std::size_t>(v));
  rows.rest.changed = tiles_of(changes->vertices, 4);
  rows.weight.changed = tiles_of(changes->vertices, width);
  rows.node.changed = tiles_of(changes->reembedded, width);
}

/// `own`: the Program that has the buffers of the surface.
Pass surface_pass(const ModelSurface& s, std::size_t width, const Program& steps, const Program& own) {
  const auto arg = [&](const char* name) { return buffer_arg(own.find(name)); };
  return {"surface_position",
          {{"WIDTH", static_cast<int>(width)}},
          {buffer_arg(steps.find("node_u")), arg("surface_rest"), arg("surface_node"), arg("surface_weight"), arg("surface_x")},
          Shape::lanes,
          static_cast<std::int64_t>(padded(s.rest.size())),
          "surface",
          static_cast<std::int64_t>(s.rest.size()),
          static_cast<double>(32 + width * 24),
          static_cast<double>(6 * width + 3)};
}

}  // namespace

Program surface_program(const ModelSurface& s, const Program& steps, Program* before, const SurfaceChanges* changes) {
  Program program;
  program.first = static_cast<BufferId>(steps.buffers.size());
  if (s.rest.empty()) return program;
  if (steps.find("surface_x") >= 0) {  // already part of the step for pressures
    program.step.push_back(surface_pass(s, width_of(s), steps, steps));
    return program;
  }
  const std::size_t width = width_of(s);
  const bool patch = before != nullptr && changes != nullptr && before->buffers.size() == 4 && width == 8 &&
                     before->buffers[1].count == 8 * before->buffers[0].count;
  if (patch) {
    program.buffers = std::move(before->buffers);
  } else {
    program.add(make_reals("surface_rest", BufferType::real4, 0, BufferRole::constant, "[vertices]", "m", "model"));
    program.add(make_ints("surface_node", BufferRole::constant, "[tiles][8][16]", {}));
    program.add(make_reals("surface_weight", BufferType::real, 0, BufferRole::constant, "[tiles][8][16]", "1", "model"));
    program.add(make_reals("surface_x", BufferType::real4, 0, BufferRole::scratch, "[vertices]", "m", "surface_position"));
  }
  fill(s, width, patch ? changes : nullptr, Rows(program));
  program.step.push_back(surface_pass(s, width, steps, program));
  return program;
}

}  // namespace pliant
