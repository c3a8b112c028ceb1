// A complete state of a run, from which a simulation of the same scene continues with the same bits.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/state/run_context.h"
#include "simulation/state/run_report.h"

namespace pliant {

/// The content of one buffer in the backend's format.
struct NamedBytes {
  std::string name;
  std::vector<std::uint8_t> bytes;
  bool operator==(const NamedBytes&) const = default;
};

/// A named part of the model or settings with its hash, {name, hash}, for error messages.
struct ModelPart {
  std::string name;
  std::uint64_t hash = 0;
  bool operator==(const ModelPart&) const = default;
};

/// Names of the parts that options of a host add (WorldOptions).
inline constexpr const char* kInteractive = "interactive";
inline constexpr const char* kCutting = "cutting";
[[nodiscard]] bool has_part(const std::vector<ModelPart>& parts, const char* name);

struct Snapshot {
  std::vector<ModelPart> made_of;  ///< parts of the model and settings; must match when restoring
  std::string real_type;           ///< "float" or "double"
  RunState state;
  RunReports reports;               ///< statistics, which no step depends on
  std::vector<NamedBytes> buffers;  ///< state buffers, in the order of the buffer table
};

/// Returns hashes of everything that determines how a state continues: the model as loaded, the scene's solver settings and
/// the settings derived from the options.
std::vector<ModelPart> parts_of(const Scene& scene, const RunSettings& settings, const Model& model, const Program& program,
                                const Program& surface);

/// Combines the hashes of all parts.
[[nodiscard]] std::uint64_t hash_of(const std::vector<ModelPart>& parts);

/// Returns the names of the parts of `own` that differ from `taken`, such as "gravity, blades".
[[nodiscard]] std::string differing(const std::vector<ModelPart>& taken, const std::vector<ModelPart>& own);

[[nodiscard]] Snapshot take_snapshot(const RunContext& run, const RunReports& reports = {});

/// Hash over a snapshot without its reports. Runs with equal hashes continue identically.
[[nodiscard]] std::uint64_t deep_hash(const Snapshot& snapshot);

/// Validates a state of unknown origin. Throws Error (bad_input) for values that no run of this model can have: a
/// non-positive step size, wrong lengths, forces on unknown nodes, non-finite points.
void check_state(const RunState& state, const Model& model, const Scene& scene);

/// Throws Error (bad_input) for a report on other tools than the model's, or on strokes of blades that the scene does not have
/// or on bodies that it does not have.
void check_report(const RunReports& reports, const RunState& state, const Scene& scene);

/// Throws Error (bad_input) for ballast (RunState) that this model's nodes cannot have.
void check_ballast(const RunState& state, const Model& model);

/// Throws Error (bad_input) with the buffers whose size differs from `program`.
void check_buffers(const Snapshot& snapshot, const Program& program);
/// Writes the state buffers. Requires check_buffers() for the loaded program.
void write_buffers(const Snapshot& snapshot, LoadedModel& loaded);

}  // namespace pliant
