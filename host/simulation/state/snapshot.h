// All that a run is at one moment: from it a simulation of the same scene goes on with the same bits.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/state/run_context.h"
#include "simulation/state/run_report.h"

namespace pliant {

/// The content of one buffer, as the backend holds it.
struct NamedBytes {
  std::string name;
  std::vector<std::uint8_t> bytes;
  bool operator==(const NamedBytes&) const = default;
};

/// What a simulation was made of, in parts that a user knows by their names: {name, hash}.
struct ModelPart {
  std::string name;
  std::uint64_t hash = 0;
  bool operator==(const ModelPart&) const = default;
};

struct Snapshot {
  std::vector<ModelPart> made_of;  ///< a snapshot is taken up only by what was made of the same
  std::string real_type;           ///< "float" or "double"
  RunState state;
  RunReports reports;               ///< what no step depends on
  std::vector<NamedBytes> buffers;  ///< those of the role `state`, in the order of the table
};

/// The model as the backend sees it, the scene's settings of the solver and what follows from the options: all that decides
/// how a state goes on.
std::vector<ModelPart> parts_of(const Scene& scene, const RunSettings& settings, const Model& model, const Program& program,
                                const Program& surface);

/// One hash of all parts.
[[nodiscard]] std::uint64_t hash_of(const std::vector<ModelPart>& parts);

/// The names of one's own parts that a snapshot was not taken with, such as "gravity, blades".
[[nodiscard]] std::string differing(const std::vector<ModelPart>& taken, const std::vector<ModelPart>& own);

[[nodiscard]] Snapshot take_snapshot(const RunContext& run, const RunReports& reports = {});

/// Hash over all of a snapshot but its reports: two runs with the same one go on alike.
[[nodiscard]] std::uint64_t deep_hash(const Snapshot& snapshot);

/// Throws Error (bad_input) for a state that came from elsewhere and holds numbers that no run of this model has: a step that
/// is not positive, vectors of another length, forces on nodes that do not exist, points that are not finite.
void check_state(const RunState& state, const Model& model, const Scene& scene);

/// Throws Error (bad_input) for a report of other tools than those of the model.
void check_report(const RunReports& reports, const RunState& state, std::size_t tools);

/// Throws Error (bad_input) for ballast (RunState) that no node of this model can have.
void check_ballast(const RunState& state, const Model& model);

/// Throws Error (bad_input) that says what a snapshot holds of another size than `program` wants.
void check_buffers(const Snapshot& snapshot, const Program& program);
/// Write the state buffers. check_buffers() passed for the loaded program.
void write_buffers(const Snapshot& snapshot, LoadedModel& loaded);

}  // namespace pliant
