// The parts of `pliant bench haptics`.
#pragma once
#include <vector>

#include "bench/common/rows.h"
#include "bench/haptics/haptics.h"
#include "bench/haptics/session.h"

namespace pliant::bench::haptics {

class PartRun : public Rows {
 public:
  PartRun(std::string name, const HapticsOptions& asked, std::function<void(double, const std::string&)> show)
      : Rows(std::move(name), std::move(show)), options(asked) {}
  /// Keeps a curve for figures: force along the tool's first push [N], every `period` [s].
  void trace(const std::string& scene, const std::string& model, const ForceTrace& trace);
  [[nodiscard]] const nlohmann::json& traces() const { return traces_; }
  const HapticsOptions& options;

 private:
  nlohmann::json traces_ = nlohmann::json::array();
};

struct Part {
  const char* name;
  const char* question;
  void (*measure)(PartRun&);
};
/// In the order of the report.
const std::vector<Part>& parts();

/// Of the sessions in virtual time [1/s].
inline constexpr double kTickRate = 1000;

/// A body and a tool that a hand presses into it, draws along it and lifts, with the speeds of a hand (minimum jerk, Flash and
/// Hogan 1985).
struct HandScene {
  std::string name;
  Scene scene;
  std::string tool;
  Stroke stroke;
  double seconds = 0;
};
/// block, liver, bunny: those of which the meshes are there.
std::vector<HandScene> hand_scenes(const HapticsOptions& options);

void measure_strokes(PartRun& run);      ///< buffers of all sizes against the full model
void measure_others(PartRun& run);       ///< the simpler models on the same strokes
void measure_edits(PartRun& run);        ///< a cut that is felt
void measure_instruments(PartRun& run);  ///< a scalpel and forceps
void measure_passivity(PartRun& run);    ///< energy, stiffness, stalls
void measure_times(PartRun& run);        ///< ticks in wall time, beside a World that is cut

}  // namespace pliant::bench::haptics
