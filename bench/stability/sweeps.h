// The sweeps of `pliant bench stability`, and how they report.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/stability/trial.h"

namespace pliant::bench::stability {

inline constexpr double kYoung = 3000;  ///< of the specimens [Pa]
inline constexpr double kEdge = 0.01;   ///< of their cells [m]

/// A number of a row, or null.
using Number = std::optional<double>;

/// What a row says beside its sweep, method and parameters.
struct Finding {
  std::string quantity;        ///< what `predicted` and `measured` are, with the unit in brackets
  Number predicted, measured;  ///< predicted null: none is; measured is the last value of the sweep where `reached` is false
  bool reached = false;        ///< whether the limit lies inside the sweep
  std::string outcome;         ///< what happens past it, in a few words
  std::string diagnosis;       ///< what the engine said there; empty: nothing
  int exit_code = 0;           ///< of a run past the limit
};

class SweepRun {
 public:
  SweepRun(std::string name, bool quick, std::function<void(const std::string&)> show)
      : name_(std::move(name)), quick_(quick), show_(std::move(show)) {}
  /// Few points: for CI.
  [[nodiscard]] bool quick() const { return quick_; }
  /// One of two lists of parameters.
  template <class T>
  [[nodiscard]] std::vector<T> pick(std::vector<T> all, std::vector<T> few) const {
    return quick_ ? few : all;
  }
  void show(const std::string& what) const { show_(name_ + ": " + what); }
  /// `parameters` is an object of numbers and words; `more` are further members of the row.
  void add(const std::string& method, nlohmann::json parameters, const Finding& finding,
           const nlohmann::json& more = nlohmann::json::object());
  void add(Method method, nlohmann::json parameters, const Finding& finding,
           const nlohmann::json& more = nlohmann::json::object()) {
    add(std::string(name_of(method)), std::move(parameters), finding, more);
  }
  /// The row of a stable step: the engine's estimate, the measured limit, and a run beyond it under gravity.
  void add_step_limit(Method method, nlohmann::json parameters, const Specimen& specimen);
  [[nodiscard]] const nlohmann::json& rows() const { return rows_; }

 private:
  std::string name_;
  bool quick_;
  std::function<void(const std::string&)> show_;
  nlohmann::json rows_ = nlohmann::json::array();
};

struct Sweep {
  const char* name;
  const char* question;
  void (*measure)(SweepRun&);
};

/// In the order of the report.
const std::vector<Sweep>& sweeps();

// step.cpp
void sweep_step(SweepRun& run);      ///< limit of the step by element, aspect ratio, Poisson's ratio
void sweep_share(SweepRun& run);     ///< steps until the engine stops, by dt over the stable step
void sweep_poisson(SweepRun& run);   ///< static equilibrium at nu to 0.4999
void sweep_contrast(SweepRun& run);  ///< two materials in a body
void sweep_bodies(SweepRun& run);    ///< two bodies in a scene
void sweep_sliver(SweepRun& run);    ///< cells of little fill
// strain.cpp
void sweep_stretch(SweepRun& run);    ///< slow stretch and compression
void sweep_inversion(SweepRun& run);  ///< return from a bad start
void sweep_load(SweepRun& run);       ///< loads and motions switched on at once
// rest.cpp
void sweep_hourglass(SweepRun& run);  ///< share of the hourglass energy in bending
void sweep_rest(SweepRun& run);       ///< a million steps of a body at rest
// matching.cpp
void sweep_matching(SweepRun& run);    ///< alpha, step and half-width: stiffness, overshoot, jitter
void sweep_alpha(SweepRun& run);       ///< alpha beyond what a scene may ask
void sweep_beta(SweepRun& run);        ///< stiffness of the interface
void sweep_subcycling(SweepRun& run);  ///< steps of elements per step of shape matching

}  // namespace pliant::bench::stability
