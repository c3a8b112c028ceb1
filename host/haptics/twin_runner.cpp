#include "haptics/twin_runner.h"

#include <algorithm>

#include "backends/interface/buffer_checks.h"
#include "backends/twins/processor.h"

namespace pliant::haptics {

TwinRunner::TwinRunner(const Program& program) : program_(program), storage_(program.buffers.size()) {
  ref::require_fma();
  for (std::size_t b = 0; b < program.buffers.size(); ++b) {
    const Buffer& row = program.buffers[b];
    initial_count(row);  // throws if the initial values do not fit
    if (row.is_int()) {
      storage_[b].ints.assign(std::max<std::size_t>(row.values(), 1), 0);
      std::copy(row.ints.begin(), row.ints.end(), storage_[b].ints.begin());
    } else {
      storage_[b].reals.assign(std::max<std::size_t>(row.values(), 1), static_cast<float>(row.padding));
      round_reals(row.reals, storage_[b].reals.data());
    }
  }
  if (const BufferId params = program.find("step_params"); params >= 0)
    contact_step_ = storage_[static_cast<std::size_t>(params)].reals;
  step_ = prepare(program.step);
  look_ = prepare(program.look);
}

std::vector<TwinRunner::Entry> TwinRunner::prepare(const std::vector<Pass>& passes) {
  std::vector<Entry> entries;
  for (const Pass& pass : passes) {
    const bool presses = pass.kernel == "contact_press" || pass.kernel == "contact_settle" || pass.kernel == "blade_press";
    const auto values_of = [this, presses](BufferId id) {
      if (presses && id == program_.find("step_params")) {
        ref::ArgValue<float> own;
        own.reals = contact_step_.data();
        return own;
      }
      Storage& s = storage_[static_cast<std::size_t>(id)];
      ref::ArgValue<float> value;
      if (s.ints.empty()) {
        value.reals = s.reals.data();
      } else {
        value.ints = s.ints.data();
      }
      return value;
    };
    entries.push_back({&pass, ref::prepare_twin<float>(ref::registry(), pass, storage_.size(), values_of)});
  }
  return entries;
}

std::span<float> TwinRunner::reals(const std::string& name) {
  const BufferId id = program_.find(name);
  if (id < 0) return {};
  return storage_[static_cast<std::size_t>(id)].reals;
}

std::span<std::int32_t> TwinRunner::ints(const std::string& name) {
  const BufferId id = program_.find(name);
  if (id < 0) return {};
  return storage_[static_cast<std::size_t>(id)].ints;
}

}  // namespace pliant::haptics
