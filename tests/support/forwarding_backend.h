// A backend that hands everything on to another one: tests derive from it what one call does differently.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant::test {

class ForwardingBackend : public Backend {
 public:
  explicit ForwardingBackend(std::unique_ptr<Backend> inner) : inner_(std::move(inner)) {}
  [[nodiscard]] const BackendInfo& info() const override { return inner_->info(); }
  [[nodiscard]] std::string remark() const override { return inner_->remark(); }
  void load(const Program& program) override { inner_->load(program); }
  void update(const Program& loaded, const Program& next) override { inner_->update(loaded, next); }
  void extend(const Program* before, const Program& extension) override { inner_->extend(before, extension); }
  void compile(const Program& program) override { inner_->compile(program); }
  void compile_beside(const Program& program) override { inner_->compile_beside(program); }
  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    inner_->run(passes, first, count, origin);
  }
  void run(const Pass& pass, std::int32_t step) override { inner_->run(pass, step); }
  void finish() override { inner_->finish(); }
  void copy(BufferId from, BufferId to) override { inner_->copy(from, to); }
  std::vector<double> read_reals(BufferId id) override { return inner_->read_reals(id); }
  std::vector<std::int32_t> read_ints(BufferId id) override { return inner_->read_ints(id); }
  void write_reals(BufferId id, const std::vector<double>& values) override { inner_->write_reals(id, values); }
  void write_ints(BufferId id, const std::vector<std::int32_t>& values) override { inner_->write_ints(id, values); }
  std::vector<std::uint8_t> read_bytes(BufferId id) override { return inner_->read_bytes(id); }
  void read_into(BufferId id, void* out) override { inner_->read_into(id, out); }
  void profile(bool on) override { inner_->profile(on); }
  std::vector<PassTime> take_profile() override { return inner_->take_profile(); }

 protected:
  std::unique_ptr<Backend> inner_;
};

}  // namespace pliant::test
