// Runs the passes of a Program on the caller's thread, by the twins, without allocating.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backends/twins/prepared_twin.h"
#include "program/program.h"

namespace pliant::haptics {

class TwinRunner {
 public:
  /// Allocates the buffers of `program`, which must outlive the runner. Throws Error (device) on a processor without fma.
  explicit TwinRunner(const Program& program);
  /// The copy of "step_params" from which tools and blades compute their forces: its step [s] is how stiff they are.
  [[nodiscard]] std::span<float> contact_step() { return contact_step_; }
  /// Runs one step of a batch of one.
  void step() { run(step_); }
  /// Runs the searches of contact.
  void look() { run(look_); }
  /// Values of a buffer; empty if the program has none of this name.
  [[nodiscard]] std::span<float> reals(const std::string& name);
  [[nodiscard]] std::span<std::int32_t> ints(const std::string& name);

 private:
  struct Entry {
    const Pass* pass;
    ref::PreparedTwin<float> twin;
  };
  struct Storage {
    std::vector<float> reals;
    std::vector<std::int32_t> ints;
  };
  std::vector<Entry> prepare(const std::vector<Pass>& passes);
  static void run(const std::vector<Entry>& entries) {
    for (const Entry& e : entries) {
      const std::int64_t count = e.pass->indices();
      if (count > 0) e.twin.call({0, count}, e.twin.args.data());  // the step in the batch is always 0
    }
  }

  const Program& program_;
  std::vector<Storage> storage_;
  std::vector<float> contact_step_;
  std::vector<Entry> step_, look_;
};

}  // namespace pliant::haptics
