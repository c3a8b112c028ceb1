#include "cli/attempt_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/csv_text.h"
#include "io/atomic_file.h"

namespace pliant::cli {
namespace {

const std::string& body_of(const Simulation& simulation, const StrokeAttempt& attempt) {
  return simulation.scene().bodies[static_cast<std::size_t>(attempt.body)].name;
}

}  // namespace

void add_attempts(const Simulation& simulation, const std::string& blade, nlohmann::ordered_json& row) {
  const auto found = simulation.report().strokes.find(blade);
  const BladeStrokes own = found == simulation.report().strokes.end() ? BladeStrokes{} : found->second;
  row["strokes"] = own.strokes;
  row["attempts"] = own.attempts;
  row["cut_attempts"] = nlohmann::ordered_json::array();
  for (const StrokeAttempt& a : own.last) {
    row["cut_attempts"].push_back({{"stroke", a.stroke},
                                   {"body", body_of(simulation, a)},
                                   {"from", a.from},
                                   {"to", a.to},
                                   {"time", a.time},
                                   {"position", a.place},
                                   {"rest", a.rest},
                                   {"gave_way", a.gave_way}});
  }
}

void AttemptTable::write(const Simulation& simulation, const std::filesystem::path& file) {
  if (simulation.press().names().empty()) return;
  if (table_.empty()) table_ = "time [s],blade,stroke,body,from,to,x [m],y [m],z [m],gave way\n";
  for (const std::string& name : simulation.press().names()) {
    const auto found = simulation.report().strokes.find(name);
    if (found == simulation.report().strokes.end()) continue;
    std::int64_t& seen = seen_[name];
    found->second.after(seen, [&](const StrokeAttempt& a) {
      table_ += fmt::format("{:.9g},{},{},{},{},{},{:.9g},{}\n", a.time, csv_text(name), a.stroke,
                            csv_text(body_of(simulation, a)), a.from, a.to, fmt::join(a.place, ","), a.gave_way ? 1 : 0);
    });
    seen = found->second.attempts;
  }
  write_file(file, table_);
}

}  // namespace pliant::cli
