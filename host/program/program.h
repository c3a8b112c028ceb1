// A Program is a Model ready to run: the buffer table and the Schedule, the ordered passes of one step. It is built once and is
// the same object for every backend.
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

/// An argument of a pass that changes from step to step: the index of the step inside the running batch.
struct StepInBatch {};

/// Arguments stand in the order of the kernel's parameters.
using Arg = std::variant<BufferId, double, std::int32_t, StepInBatch>;
inline Arg buffer_arg(BufferId id) { return Arg{std::in_place_index<0>, id}; }
inline Arg real_arg(double value) { return Arg{std::in_place_index<1>, value}; }
inline Arg int_arg(std::int32_t value) { return Arg{std::in_place_index<2>, value}; }
inline Arg step_arg() { return Arg{StepInBatch{}}; }

/// How a kernel's index space maps to work-items. It is a property of the kernel, not of the device: the device chooses lanes.
enum class Shape {
  lanes,   ///< one index per element or node, `count` a multiple of 16; a work-item takes LANES consecutive indices
  items,   ///< one work-item per index, always scalar (short lists, bricks of irregular work)
  bricks,  ///< one brick per index; a work-item takes a brick (16 lanes) or a row of 16 work-items takes it (1 lane)
};

/// One kernel launch of the Schedule.
struct Pass {
  std::string kernel;                                ///< the stem: file, kernel and twin share it
  std::vector<std::pair<std::string, int>> defines;  ///< compile-time specialisation, e.g. {"LAW", 0}
  std::vector<Arg> args;
  Shape shape = Shape::lanes;
  std::int64_t count = 0;
  std::string label;             ///< for people, e.g. "liver: tet4 neo-hookean"
  std::int64_t elements = 0;     ///< elements or nodes it advances, for reports
  double bytes_per_element = 0;  ///< counted traffic, each datum once
  double flops_per_element = 0;  ///< counted operations; an fma counts two
  std::int32_t every = 1;        ///< runs in the steps of the whole run that are multiples of this (subcycling)
  bool uneven = false;           ///< a few indices take most of the time, and stand together
  /// If set, only the first so many of `count` indices run, as the host decides between steps; the kernel finds in a list which
  /// they are, and passes over entries < 0. Of `items`, all or none.
  std::shared_ptr<const std::int64_t> active = nullptr;
  [[nodiscard]] std::int64_t indices() const {
    return active == nullptr ? count : shape == Shape::items ? (*active > 0 ? count : 0) : std::min(*active, count);
  }
  [[nodiscard]] bool runs_in(std::int64_t step) const { return step % every == 0; }
};

struct Program {
  /// Number of its first buffer. 0: a program that runs by itself. Otherwise it extends the program of so many buffers that is
  /// loaded: its passes may use the buffers of both.
  BufferId first = 0;
  std::vector<Buffer> buffers;
  std::vector<Pass> step;    ///< one time step; of an extension: all that it does
  std::vector<Pass> look;    ///< now and then, when the host asks for it: what is near what, for the passes that follow
  std::vector<Pass> force;   ///< R - F of the present configuration into node_force, without advancing
  std::vector<Pass> status;  ///< once per batch: first fault of the batch into fault_summary
  /// What Pass::active counts: contact points, and nodes that they move, of tiles that are near something.
  std::shared_ptr<std::int64_t> near_points, near_nodes;
  [[nodiscard]] BufferId find(const std::string& name) const;  ///< -1 if absent
  BufferId add(Buffer buffer);                                 ///< returns its id
  [[nodiscard]] Buffer& at(BufferId id) { return buffers.at(static_cast<std::size_t>(id - first)); }
  [[nodiscard]] const Buffer& at(BufferId id) const { return buffers.at(static_cast<std::size_t>(id - first)); }
};

}  // namespace pliant
