// Events and cutting attempts of a World, detected between batches. Private to host/api and its tests.
#pragma once
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pliant/live.h"
#include "pliant/tool.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// An event without its moment.
[[nodiscard]] Event event_of(std::string kind, std::string subject, double amount, std::string text,
                             const std::optional<Vec3d>& at = {});

/// The stepping thread adds events, and the caller's thread takes them.
class EventLog {
 public:
  static constexpr std::size_t kMost = 1024;

  /// Compares the simulation with the last call and adds new events. Costs a few comparisons if nothing is.
  void look(const Simulation& simulation);
  /// Call after the simulation was replaced or has gone back: nothing before this is new.
  void renew(const Simulation& simulation);
  void add(Event event);
  /// The same at the simulation's current time.
  void add(const Simulation& simulation, Event event);
  std::vector<Event> take();
  std::vector<CutAttempt> take_attempts();

 private:
  void look_at_pieces(const Simulation& simulation);
  void look_at_tools(const Simulation& simulation);
  void look_at_sunken(const Simulation& simulation, const std::string& tool, const SunkenTool& sunk);
  void look_at_backend(const Simulation& simulation);
  void look_at_blades(const Simulation& simulation);
  void look_at_strokes(const Simulation& simulation);

  // Used by the stepping thread.
  std::int64_t opened_ = 0, topology_ = 0, calmed_ = 0, inverted_ = 0, made_again_ = 0;
  bool diverged_ = false;
  std::vector<std::int64_t> pieces_;      ///< [bodies]
  std::map<std::string, bool> deep_;      ///< tools that are deep in tissue
  std::map<std::string, bool> passed_;    ///< tools that stand below the surface of tissue
  std::string at_work_;                   ///< what computes
  std::map<std::string, bool> gave_way_;  ///< blades to which tissue has given way
  std::map<std::string, std::int64_t> attempts_seen_;

  std::mutex mutex_;
  std::deque<Event> events_;
  std::deque<CutAttempt> attempts_;
};

}  // namespace pliant::api
