// The part of `pliant run` that hands have: devices that drive tools, the log of their drives, and its replay.
#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/cli.h"
#include "cli/paced.h"
#include "haptics/replay.h"

namespace pliant::cli {

struct LiveArguments {
  std::vector<std::string> live, tools;
  std::string log, replay;
  bool lockstep = false;
  std::optional<double> rate, patience;

  void add_to(CLI::App& app);
  /// Throws Error (bad_input) for options that do not go together or are out of range.
  void check() const;
  /// The option that makes it a run by hand; empty: it is none.
  [[nodiscard]] std::string given() const;
};

class LiveRun {
 public:
  /// Opens the devices, or reads the log. `own_end`: the run has an end of its own (--steps, --seconds), which a replay then
  /// has instead of that of its log. Throws Error. `arguments`, `common` and `simulation` must outlive this.
  LiveRun(const LiveArguments& arguments, const Common& common, const Simulation& simulation, bool own_end);
  [[nodiscard]] haptics::RunGuide& guide();
  /// Time at which the log of a replay ends, which may be behind the scene's duration; 0: it does not say [s].
  [[nodiscard]] double logged_end() const { return replay_ && replay_->log().end ? replay_->log().end->time : 0; }
  /// The run has ended: lets go of the devices and writes the log.
  void finish();
  /// The member "instruments" of docs/schema/run.json, after finish().
  [[nodiscard]] nlohmann::ordered_json json();
  /// A line per device for people.
  [[nodiscard]] std::vector<std::string> lines();

 private:
  void open();
  [[nodiscard]] nlohmann::ordered_json device_json(std::size_t i);

  const LiveArguments& o_;
  const Common& common_;
  const Simulation& simulation_;
  haptics::DriveLog log_;
  std::vector<haptics::HeldTool> held_;
  // One of them.
  std::optional<haptics::Replay> replay_;
  std::optional<haptics::Lockstep> lockstep_;
  std::optional<Paced> paced_;
};

}  // namespace pliant::cli
