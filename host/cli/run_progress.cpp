#include "cli/run_progress.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/run_events.h"

namespace pliant::cli {
namespace {

constexpr double kLongest = 86400;  ///< a run that needs more wall time is warned of [s]
constexpr double kJudged = 0.2;     ///< after so much wall time [s]

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  const auto text = [&](double unit, const char* name, double part, const char* part_name) {
    const double whole = std::floor(seconds / unit);
    return fmt::format("{:.0f} {} {:.0f} {}", whole, name, std::floor((seconds - whole * unit) / part), part_name);
  };
  if (seconds < 3600) return text(60, "min", 1, "s");
  if (seconds < 86400) return text(3600, "h", 60, "min");
  if (seconds < 100 * 86400.0) return text(86400, "days", 3600, "h");
  return fmt::format("{:.3g} days", seconds / 86400);
}

double RunProgress::share(const RunResult& done) const {
  const RunEnd& end = loop_.end();
  if (end.time) {
    const double whole = *end.time - first_time_;
    return whole > 0 ? (simulation_.time() - first_time_) / whole : 1;
  }
  const double whole = static_cast<double>(done.steps + loop_.remaining());
  return whole > 0 ? static_cast<double>(done.steps) / whole : 1;
}

void RunProgress::show(const RunResult& done) {
  if (!simulation_.scene().blades.empty()) missed(blades_without_contact(simulation_, true));
  const auto now = std::chrono::steady_clock::now();
  std::string left_text;
  if (!begin_) {
    begin_ = now;
    first_steps_ = done.steps;
  } else if (done.steps > first_steps_) {
    const double wall = std::chrono::duration<double>(now - *begin_).count();
    const double left = static_cast<double>(loop_.remaining()) * wall / static_cast<double>(done.steps - first_steps_);
    left_text = fmt::format("  {} left", duration_text(left));
    if (wall >= kJudged && left > kLongest) warn_of_no_end(left);
  }
  const std::optional<double>& end = loop_.end().time;
  bar_.show(share(done), fmt::format("step {}  t = {:.4g}{} s{}", simulation_.step(), simulation_.time(),
                                     end ? fmt::format(" of {:.4g}", *end) : "", left_text));
}

void RunProgress::warn_of_no_end(double left) {
  if (warned_) return;
  warned_ = true;
  bar_.clear();
  const double dt = simulation_.dt(), stable = simulation_.stable_dt();
  std::string change;
  if (simulation_.scene().dt <= 0) {
    change = "the step is automatic: larger or softer elements allow a longer one (pliant info SCENE names what limits it)";
  } else if (dt < 0.5 * stable) {
    change = fmt::format("the step was given, and {:.3g} s is stable: give a longer one (\"dt\", --dt), or none", 0.9 * stable);
  } else {
    change = "larger or softer elements allow a longer step (pliant info SCENE names what limits it)";
  }
  common_.remark(fmt::format("this run needs about {} more: {:.3g} steps of dt = {:.3g} s at {:.3g} ms each; {}",
                             duration_text(left), static_cast<double>(loop_.remaining()), dt,
                             1e3 * left / static_cast<double>(loop_.remaining()),
                             change + (loop_.end().time ? ", or simulate less time" : ", or run fewer steps")));
}

void RunProgress::missed(const std::vector<std::string>& blades) {
  for (const std::string& name : blades) {
    if (!missed_.insert(name).second) continue;
    bar_.clear();
    common_.remark(
        fmt::format("blade '{}' met nothing on its whole path; check its \"path\", \"start\" and \"end\", and the places "
                    "of the bodies at that time",
                    name));
  }
}

}  // namespace pliant::cli
