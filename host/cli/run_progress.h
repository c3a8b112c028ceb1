// Progress output of a run: percentage, simulated time, remaining time, and urgent warnings.
#pragma once
#include <optional>
#include <set>
#include <string>

#include "cli/cli.h"
#include "cli/run_loop.h"

namespace pliant::cli {

/// "3 min 20 s": two units at most.
std::string duration_text(double seconds);

class RunProgress {
 public:
  RunProgress(const Common& common, const Simulation& simulation, const RunLoop& loop)
      : common_(common), simulation_(simulation), loop_(loop), bar_(!common.quiet), first_time_(simulation.time()) {}
  /// After every batch.
  void show(const RunResult& done);
  void clear() { bar_.clear(); }
  /// Reports blades that met nothing, each once.
  void missed(const std::vector<std::string>& blades);

 private:
  [[nodiscard]] double share(const RunResult& done) const;
  void warn_of_no_end(double left);

  const Common& common_;
  const Simulation& simulation_;
  const RunLoop& loop_;
  Progress bar_;
  const double first_time_;
  /// The first batch may wait for a compiler: the pace is that of those after it.
  std::optional<std::chrono::steady_clock::time_point> begin_;
  std::int64_t first_steps_ = 0;
  bool warned_ = false;
  std::set<std::string> missed_;
};

}  // namespace pliant::cli
