// The loaded model: its Program and the Program of its embedded surface on the backend, with typed access to their buffers.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "model/model.h"
#include "program/program.h"

namespace pliant {

/// The values of a buffer.
struct BufferValues {
  BufferId id = -1;
  std::vector<double> reals;
  std::vector<std::int32_t> ints;
};

class LoadedModel {
 public:
  explicit LoadedModel(std::unique_ptr<Backend> backend) : backend_(std::move(backend)) {}
  LoadedModel(const LoadedModel&) = delete;
  LoadedModel& operator=(const LoadedModel&) = delete;

  /// Loads everything. Throws what Backend::load throws.
  void load(std::shared_ptr<const Model> model, Program program, Program surface);
  /// Replaces the Program of the steps; update_surface() must follow. After an error in either, call load().
  void update(std::shared_ptr<const Model> model, Program program);
  /// Replaces the values of a constant buffer, in a model that differs in nothing else.
  void replace_constant(std::shared_ptr<const Model> model, BufferId id, std::vector<double> values);
  /// Replaces a model by one with the same Program.
  void replace_model(std::shared_ptr<const Model> model) { model_ = std::move(model); }
  /// Sets initial values in program(); the buffers on the backend stay as they are.
  void reset_initial_state(std::vector<BufferValues> initial);
  /// Replaces the Program of the surface. `patched`: it was made from take_surface(), and Buffer::changed lists the
  /// differences.
  void update_surface(Program surface, bool patched);
  /// Returns the loaded surface Program for patching. The backend keeps its own copy until update_surface().
  [[nodiscard]] Program take_surface() { return std::exchange(surface_, {}); }

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const std::shared_ptr<const Model>& shared_model() const { return model_; }
  [[nodiscard]] const Program& program() const { return program_; }
  /// The Program that computes the positions of the embedded surface, an extension of program().
  [[nodiscard]] const Program& surface() const { return surface_; }
  /// The buffer with these positions, valid in either Program; -1 without a surface.
  [[nodiscard]] BufferId surface_x() const { return surface_buffer("surface_x"); }
  /// The same for the rest positions [m] that it starts from.
  [[nodiscard]] BufferId surface_rest() const { return surface_buffer("surface_rest"); }
  [[nodiscard]] Backend& backend() const { return *backend_; }

  /// node_u and node_w as stored. For displacements use RunContext::u().
  [[nodiscard]] BufferId u_id() const { return ids_.u; }
  [[nodiscard]] std::vector<double> u() const { return backend_->read_reals(ids_.u); }
  [[nodiscard]] std::vector<double> w() const { return backend_->read_reals(ids_.w); }
  void write_u(const std::vector<double>& u) { backend_->write_reals(ids_.u, u); }
  void write_w(const std::vector<double>& w) { backend_->write_reals(ids_.w, w); }
  void write_params(const std::vector<double>& params) { backend_->write_reals(ids_.params, params); }
  void write_curves(const std::vector<double>& values) { backend_->write_reals(ids_.curves, values); }
  /// R - F as computed by Program::force.
  [[nodiscard]] std::vector<double> force() const { return backend_->read_reals(ids_.force); }
  /// The result of fault_reduce, shape [256][4] (see its kernel). clear_faults() resets the marks.
  [[nodiscard]] std::vector<std::int32_t> faults() const { return backend_->read_ints(ids_.summary); }
  void clear_faults();
  /// The largest component of node_w at the last run of Program::status.
  [[nodiscard]] double largest_increment() const;

  /// Counter that is incremented when state buffers may have been changed by something other than steps.
  [[nodiscard]] std::int64_t changes() const { return changes_; }
  void note_change() { ++changes_; }

  /// Copies the state buffers to their backups, or back.
  void keep_state();
  void return_to_kept_state();

  /// Returns the bytes of the buffers that keep_state() copies; write_state_bytes() restores them.
  [[nodiscard]] std::vector<std::vector<std::uint8_t>> state_bytes() const;
  void write_state_bytes(const std::vector<std::vector<std::uint8_t>>& bytes);
  /// Writes bytes from Backend::read_bytes to a buffer of program().
  void write_bytes(BufferId id, const std::vector<std::uint8_t>& bytes);

  /// Shape [slots][3]: whether the component is unconstrained.
  [[nodiscard]] const std::vector<char>& free() const { return free_; }
  /// Current positions of a body's nodes [m]. `u`: displacements, as texels.
  [[nodiscard]] std::vector<Vec3d> positions(const std::vector<double>& u, std::size_t body) const;
  /// The first three numbers of each texel of a body's nodes, times `factor`.
  [[nodiscard]] std::vector<Vec3d> pick(const std::vector<double>& texels, std::size_t body, double factor) const;

 private:
  struct Ids {
    BufferId u = -1, w = -1, force = -1, params = -1, curves = -1, fault = -1, summary = -1, fastest = -1;
  };
  [[nodiscard]] BufferId surface_buffer(const char* name) const;
  void look_up();
  void count_surface();

  std::unique_ptr<Backend> backend_;
  std::shared_ptr<const Model> model_;
  Program program_, surface_;
  std::vector<std::size_t> surface_counts_;  ///< lengths of the surface buffers on the backend, also while surface_ is taken
  Ids ids_;
  std::vector<std::pair<BufferId, BufferId>> kept_;  ///< state buffers and their backups at the last good step
  std::vector<char> free_;
  std::int64_t changes_ = 0;
};

}  // namespace pliant
