// The geometric criterion of a cutting stroke (Mendoza and Laugier 2003; docs/cutting.md): the movement of a blade that cuts by
// force is told on the uncut surface of the bodies, from vertex to vertex.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "geometry/surface_walk.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/state/run_context.h"
#include "simulation/state/run_report.h"

namespace pliant {

class CutStrokes {
 public:
  CutStrokes(RunContext& run, RunReport& report) : run_(run), report_(report) {}
  /// Keeps the surface of the uncut model; nothing in a scene without blades that cut by force.
  void start(const Model& uncut);
  /// Call after an update of a blade's samples. `held`: those that were in contact before it, which are so too where they have
  /// met other tissue. x: present positions of the nodes of each body [m].
  void look(const std::string& blade, const std::vector<FrontSample>& samples, const std::vector<char>& held,
            EditedBodies& bodies, const std::vector<std::vector<Vec3d>>& x);

 private:
  /// Samples next to each other at which the edge meets the surface, and what they have in common.
  struct Meeting {
    std::int32_t body = 0;
    double weight = 0;
    Vec3d rest{}, place{};
    bool gave_way = false;
    SurfacePoint foot{};  ///< `rest` taken to the surface
  };
  struct OwnSurface {
    std::int32_t first_vertex = 0;
    std::unique_ptr<SurfaceWalk> walk;  ///< null: it has no surface
  };
  [[nodiscard]] const OwnSurface& surface(std::int32_t body) const { return surfaces_[static_cast<std::size_t>(body)]; }
  [[nodiscard]] std::vector<Meeting> meetings(const std::vector<FrontSample>& samples, const std::vector<char>& held,
                                              EditedBodies& bodies, const std::vector<std::vector<Vec3d>>& x) const;
  [[nodiscard]] bool go_on(StrokeContact& contact, const Meeting& to, std::vector<StrokeAttempt>& made) const;

  RunContext& run_;
  RunReport& report_;
  std::vector<OwnSurface> surfaces_;  ///< per body
};

}  // namespace pliant
