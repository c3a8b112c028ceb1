// The model that runs: its Program on the backend, the embedded surface beside it, and where the host finds things in both.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "model/model.h"
#include "program/program.h"

namespace pliant {

class LoadedModel {
 public:
  explicit LoadedModel(std::unique_ptr<Backend> backend) : backend_(std::move(backend)) {}
  LoadedModel(const LoadedModel&) = delete;
  LoadedModel& operator=(const LoadedModel&) = delete;

  /// Load from scratch. Throws what Backend::load throws.
  void load(std::shared_ptr<const Model> model, Program program, Program surface);
  /// The next model in two parts: first what steps, then its surface. After an error in either, load() a model.
  void update(std::shared_ptr<const Model> model, Program program);
  /// What program() says that node_u and node_w begin with; the backend keeps what it has.
  void reset_initial_state(std::vector<double> u, std::vector<double> w);
  /// `patched`: it was made from take_surface() and says in Buffer::changed what differs.
  void update_surface(Program surface, bool patched);
  /// The program of the surface that is loaded, to be patched. The backend keeps its own copy until update_surface().
  [[nodiscard]] Program take_surface() { return std::exchange(surface_, {}); }

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const std::shared_ptr<const Model>& shared_model() const { return model_; }
  [[nodiscard]] const Program& program() const { return program_; }
  /// Positions of the embedded surface; an extension of program().
  [[nodiscard]] const Program& surface() const { return surface_; }
  /// The buffer with these positions, in either Program; -1 without a surface.
  [[nodiscard]] BufferId surface_x() const;
  [[nodiscard]] Backend& backend() const { return *backend_; }

  /// node_u and node_w as they are; displacements: RunContext::u().
  [[nodiscard]] std::vector<double> u() const { return backend_->read_reals(ids_.u); }
  [[nodiscard]] std::vector<double> w() const { return backend_->read_reals(ids_.w); }
  void write_u(const std::vector<double>& u) { backend_->write_reals(ids_.u, u); }
  void write_w(const std::vector<double>& w) { backend_->write_reals(ids_.w, w); }
  void write_params(const std::vector<double>& params) { backend_->write_reals(ids_.params, params); }
  void write_curves(const std::vector<double>& values) { backend_->write_reals(ids_.curves, values); }
  /// R - F as Program::force leaves it.
  [[nodiscard]] std::vector<double> force() const { return backend_->read_reals(ids_.force); }
  /// What fault_reduce found, [256][4] (its kernel); clear_faults() forgets it.
  [[nodiscard]] std::vector<std::int32_t> faults() const { return backend_->read_ints(ids_.summary); }
  void clear_faults();
  /// The largest component of node_w when Program::status ran last.
  [[nodiscard]] double largest_increment() const;

  /// Grows with whatever may have put other values into state buffers than steps do.
  [[nodiscard]] std::int64_t changes() const { return changes_; }
  void note_change() { ++changes_; }

  /// Copy the state aside, or back.
  void keep_state();
  void return_to_kept_state();

  /// The bytes of the buffers that keep_state() copies, and the reverse.
  [[nodiscard]] std::vector<std::vector<std::uint8_t>> state_bytes() const;
  void write_state_bytes(const std::vector<std::vector<std::uint8_t>>& bytes);
  /// As Backend::read_bytes gave them, of a buffer of program().
  void write_bytes(BufferId id, const std::vector<std::uint8_t>& bytes);

  /// [slots][3] whether the component moves freely.
  [[nodiscard]] const std::vector<char>& free() const { return free_; }
  /// Present positions of a body's nodes [m]; `u`: displacements, in texels.
  [[nodiscard]] std::vector<Vec3d> positions(const std::vector<double>& u, std::size_t body) const;
  /// The first three numbers of each of a body's texels, times `factor`.
  [[nodiscard]] std::vector<Vec3d> pick(const std::vector<double>& texels, std::size_t body, double factor) const;

 private:
  struct Ids {
    BufferId u = -1, w = -1, force = -1, params = -1, curves = -1, fault = -1, summary = -1, fastest = -1;
  };
  void look_up();
  void count_surface();

  std::unique_ptr<Backend> backend_;
  std::shared_ptr<const Model> model_;
  Program program_, surface_;
  std::vector<std::size_t> surface_counts_;  ///< of the rows that the backend holds, also while surface_ is taken
  Ids ids_;
  std::vector<std::pair<BufferId, BufferId>> kept_;  ///< state buffers and their copies at the last good step
  std::vector<char> free_;
  std::int64_t changes_ = 0;
};

}  // namespace pliant
