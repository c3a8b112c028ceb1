// The Program: a Model in executable form, consisting of the buffer table and the Schedule, the ordered passes of one step.
// It is built once and is the same object for every backend.
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "program/buffer.h"

namespace pliant {

/// A pass argument that changes with each step: the index of the step within the batch.
struct StepInBatch {};

/// Arguments in the order of the kernel's parameters.
using Arg = std::variant<BufferId, double, std::int32_t, StepInBatch>;
inline Arg buffer_arg(BufferId id) { return Arg{std::in_place_index<0>, id}; }
inline Arg real_arg(double value) { return Arg{std::in_place_index<1>, value}; }
inline Arg int_arg(std::int32_t value) { return Arg{std::in_place_index<2>, value}; }
inline Arg step_arg() { return Arg{StepInBatch{}}; }

/// Mapping of a kernel's index space to work-items. It is a property of the kernel, not of the device, which chooses the
/// lanes.
enum class Shape {
  lanes,   ///< one index per element or node, `count` a multiple of 16; a work-item processes LANES consecutive indices
  items,   ///< one work-item per index, always scalar (short lists, bricks of irregular work)
  tiles,   ///< one work-item per index, which stands for 16 elements or nodes; they are processed LANES at a time
  bricks,  ///< one brick per index, processed by one work-item (16 lanes) or by a row of 16 work-items (1 lane)
};

/// One kernel launch of the Schedule.
struct Pass {
  std::string kernel;                                ///< the stem, common to file, kernel and twin
  std::vector<std::pair<std::string, int>> defines;  ///< compile-time specialisation, e.g. {"LAW", 0}
  std::vector<Arg> args;
  Shape shape = Shape::lanes;
  std::int64_t count = 0;
  std::string label;             ///< for display, e.g. the body, its element and its law
  std::int64_t elements = 0;     ///< number of elements or nodes it advances, for reports
  double bytes_per_element = 0;  ///< memory traffic, each datum once
  double flops_per_element = 0;  ///< operations; an fma is two
  std::int32_t every = 1;        ///< runs in steps whose number in the run is a multiple of this (subcycling)
  bool uneven = false;           ///< most of the time is spent in a few adjacent indices
  /// If set, only the first *active of `count` indices run; the host changes it between steps. The kernel reads the indices
  /// from a list and skips entries < 0. With Shape::items, either all or none run.
  std::shared_ptr<const std::int64_t> active = nullptr;
  [[nodiscard]] std::int64_t indices() const {
    return active == nullptr ? count : shape == Shape::items ? (*active > 0 ? count : 0) : std::min(*active, count);
  }
  [[nodiscard]] bool runs_in(std::int64_t step) const { return step % every == 0; }
};

struct Program {
  /// Id of its first buffer. 0: an independent program. Otherwise an extension of a loaded program with that many buffers;
  /// its passes may use the buffers of both.
  BufferId first = 0;
  std::vector<Buffer> buffers;
  std::vector<Pass> step;    ///< one time step; for an extension, its only list
  std::vector<Pass> look;    ///< broad-phase searches of contact, run between steps when the host needs them
  std::vector<Pass> force;   ///< R - F of the current configuration into node_force, without advancing
  std::vector<Pass> rates;   ///< the same with the viscous forces of the last increments; empty without any
  std::vector<Pass> status;  ///< once per batch: first fault into fault_summary, largest increment into increment_summary
  /// Values for Pass::active: contact points in tiles near something, and the nodes that they move.
  std::shared_ptr<std::int64_t> near_points, near_nodes;
  /// The same for blades that cut by force: samples of their edges that have met material.
  std::shared_ptr<std::int64_t> near_samples;
  [[nodiscard]] BufferId find(const std::string& name) const;  ///< -1 if absent
  BufferId add(Buffer buffer);  ///< appends a buffer and returns its id; state has to declare its Carry
  [[nodiscard]] Buffer& at(BufferId id) { return buffers.at(static_cast<std::size_t>(id - first)); }
  [[nodiscard]] const Buffer& at(BufferId id) const { return buffers.at(static_cast<std::size_t>(id - first)); }
};

}  // namespace pliant
