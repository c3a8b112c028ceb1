#include "cli/energy_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace pliant::cli {
namespace {

constexpr double kCreated = 0.01;
constexpr std::int64_t kLooks = 32;  ///< number of checks in a run; a check costs as much as some ten steps

bool is_accounted(const Scene& scene) {
  const bool held = std::all_of(scene.bodies.begin(), scene.bodies.end(),
                                [](const Body& body) { return body.pressures.empty() && body.material.toughness == 0; });
  // A sequence also changes its shape.
  const bool rigid = std::none_of(scene.tools.begin(), scene.tools.end(),
                                  [](const ContactTool& tool) { return tool.shape == ToolShape::sequence; });
  return held && rigid && (!scene.tools.empty() || scene.contact) && scene.blades.empty() && !scene.relaxation.enabled;
}

}  // namespace

EnergyReport::EnergyReport(Simulation& simulation, const RunLoop& loop)
    : simulation_(simulation),
      loop_(loop),
      accounted_(is_accounted(simulation.scene())),
      every_(std::max<std::int64_t>(1, loop.remaining() / kLooks)),
      next_(loop.remaining()) {
  look();
}

void EnergyReport::look() {
  if (!accounted_ || simulation_.topology_version() > 0) return;
  const std::int64_t left = loop_.remaining();
  if (left > next_) return;
  next_ = std::max<std::int64_t>(0, left - every_);
  simulation_.watch_energy();
}

std::optional<double> EnergyReport::created() const {
  if (!accounted_ || simulation_.topology_version() > 0) return {};
  return simulation_.report().energy.share();
}

std::optional<double> EnergyReport::parted() const {
  if (!created()) return {};
  return simulation_.report().energy.share_of(simulation_.report().tissue.work);
}

std::vector<std::string> EnergyReport::remarks() const {
  std::vector<std::string> out;
  if (const double share = created().value_or(0); share > kCreated) {
    out.push_back(fmt::format(
        "energy appeared without a source: {:.2g} times the largest energy of the run more than tools, loads and gravity "
        "put in; tissue that vibrates under a tool causes this: compare a run with a shorter step",
        share));
  }
  if (const double share = parted().value_or(0); share > kCreated) {
    out.push_back(fmt::format(
        "parting tissue that had come inside other tissue put in {:.2g} times the largest energy of the run: faces "
        "that turn or slide over edges, and parts thinner than a cell, meet late; smaller cells or slower loads help",
        share));
  }
  return out;
}

}  // namespace pliant::cli
