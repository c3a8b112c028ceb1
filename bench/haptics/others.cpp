// The simpler models of the source on the same strokes: the force of the last frame, extrapolation, a proxy, a condensed body.
#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <memory>

#include "bench/haptics/parts.h"
#include "bench/haptics/spectrum.h"
#include "geometry/vec.h"
#include "haptics/condensed.h"
#include "haptics/held.h"
#include "haptics/proxy.h"
#include "statics/system.h"

namespace pliant::bench::haptics {
namespace {

using pliant::haptics::BufferMessage;
using pliant::haptics::BufferSource;
using pliant::haptics::CondensedForce;
using pliant::haptics::ExtrapolatedForce;
using pliant::haptics::ForceModel;
using pliant::haptics::HeldForce;
using pliant::haptics::Linearised;
using pliant::haptics::ProxyForce;
using Triangle = ProxyForce::Triangle;

/// Stiffness of a body at rest against a rigid tool that sticks to its contact points (Guyan 1965), from the static solver's
/// tangent, factorised once.
class RestStiffness {
 public:
  RestStiffness(const Scene& scene, const Model& model)
      : problem_(statics::problem_of(scene, model, 0)), system_(problem_, true) {
    statics::SparseMatrix lower = system_.pattern();
    statics::Forces forces;
    system_.tangent(Eigen::VectorXd::Zero(system_.components()), 1, forces, lower);
    solver_.compute(lower.selfadjointView<Eigen::Lower>());
    const std::vector<std::int32_t>& slot = model.bodies[0].slot;
    node_.assign(static_cast<std::size_t>(model.slots), -1);
    for (std::size_t n = 0; n < slot.size(); ++n) node_[static_cast<std::size_t>(slot[n])] = static_cast<int>(n);
  }

  /// Of the points: translation [N/m].
  Eigen::Matrix3d of(const ContactPoints& points, const std::vector<std::size_t>& touched) const {
    constexpr double kSoft = 1e-9;  // of the compliance: points may depend on each other
    const auto size = static_cast<Eigen::Index>(3 * touched.size());
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(system_.unknowns(), size), rigid(size, 3);
    for (std::size_t p = 0; p < touched.size(); ++p) {
      for (int c = 0; c < 3; ++c) {
        const auto column = static_cast<Eigen::Index>(3 * p) + c;
        rigid.row(column) = Eigen::Vector3d::Unit(c).transpose();
        for (std::size_t a = 0; a < 8; ++a) {
          const int node = node_[static_cast<std::size_t>(points.nodes[touched[p]][a])];
          const int free = node < 0 ? -1 : system_.free_of()[static_cast<std::size_t>(3 * node + c)];
          if (free >= 0) weights(free, column) += static_cast<double>(points.weights[touched[p]][a]) / contact_weight_unit;
        }
      }
    }
    Eigen::MatrixXd compliance = weights.transpose() * solver_.solve(weights);
    compliance.diagonal().array() += kSoft * compliance.trace();
    return rigid.transpose() * compliance.ldlt().solve(rigid);
  }

 private:
  statics::Problem problem_;
  statics::System system_;
  Eigen::SimplicialLDLT<statics::SparseMatrix> solver_;
  std::vector<int> node_;
};

/// The contact points inside the tool now, at most 16.
std::vector<std::size_t> touched_points(Simulation& s, const Pose& at) {
  std::vector<std::size_t> touched;
  const ContactPoints& points = *s.model().contact;
  const std::vector<Vec3d> u = s.displacements(0);
  std::vector<std::int32_t> node(static_cast<std::size_t>(s.model().slots), 0);
  const std::vector<std::int32_t>& slot = s.model().bodies[0].slot;
  for (std::size_t n = 0; n < slot.size(); ++n) node[static_cast<std::size_t>(slot[n])] = static_cast<std::int32_t>(n);
  for (std::size_t i = 0; i < points.size() && touched.size() < 16; ++i) {
    Vec3d x = points.rest[i];
    for (std::size_t a = 0; a < 8; ++a) {
      const auto n = static_cast<std::size_t>(node[static_cast<std::size_t>(points.nodes[i][a])]);
      x = vec::add(x, vec::mul(u[n], static_cast<double>(points.weights[i][a]) / contact_weight_unit));
    }
    if (tool_distance((*s.model().tools)[0], place_back(at, x)) < 1e-4) touched.push_back(i);
  }
  return touched;
}

std::vector<Triangle> triangles_near(Simulation& s, const Vec3d& centre) {
  const std::vector<Vec3d> x = s.surface_positions();
  std::vector<std::pair<double, Triangle>> all;
  for (const auto& t : s.model().surface.triangles) {
    Triangle corners;
    Vec3d middle{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = x[static_cast<std::size_t>(t[c])];
      middle = vec::add(middle, vec::mul(corners[c], 1.0 / 3));
    }
    all.emplace_back(vec::norm(vec::sub(middle, centre)), corners);
  }
  const std::size_t count = std::min(all.size(), ProxyForce::kTriangles);
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Triangle> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(all[i].second);
  return out;
}

/// What a frame says to any of the models.
struct FrameMessage {
  BufferMessage message;
  std::vector<Triangle> triangles;
  Linearised linearised;
};

ForceTrace felt_by(const HandScene& scene, double frames, ForceModel& model, const RestStiffness* rest) {
  SessionOptions options;
  options.frame_rate = frames;
  options.haptic_rate = kTickRate;
  options.seconds = scene.seconds;
  std::array<FrameMessage, 8> slots;
  BufferSource source(scene.tool, 1);
  auto* proxy = dynamic_cast<ProxyForce*>(&model);
  auto* condensed = dynamic_cast<CondensedForce*>(&model);
  SessionParts parts;
  parts.made = [&](Simulation& s, std::size_t slot) {
    FrameMessage& m = slots.at(slot);
    source.fill(s, 0, m.message);
    if (proxy != nullptr) m.triangles = triangles_near(s, m.message.report.tool.position);
    if (condensed == nullptr) return;
    m.linearised = {};
    m.linearised.topology = m.message.report.topology;
    const std::vector<std::size_t> touched = touched_points(s, m.message.report.tool);
    if (touched.empty()) return;
    const Eigen::Matrix3d k = rest->of(*s.model().contact, touched);
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index j = 0; j < 3; ++j) m.linearised.stiffness[static_cast<std::size_t>(6 * i + j)] = k(i, j);
    }
  };
  parts.arrived = [&](std::size_t slot) {
    const FrameMessage& m = slots.at(slot);
    model.receive(m.message.report);
    if (proxy != nullptr) proxy->surface(m.triangles);
    if (condensed != nullptr) condensed->linearise(m.linearised);
  };
  parts.tick = [&](const Pose& pose, double dt) { return model.tick(pose, dt); };
  return run_session(scene.scene, scene.tool, scene.stroke, options, parts).felt;
}

double radius_of(const HandScene& scene) { return scene.scene.tools.front().radius; }

/// Of a rigid ball on a half space: dF/dd = 2 E a / (1 - nu^2), a the radius of contact (Hertz 1881) at half the ball's radius.
double surface_stiffness(const HandScene& scene) {
  const Moduli& m = scene.scene.bodies.front().material.moduli;
  return 2 * m.young() * 0.5 * radius_of(scene) / (1 - m.poisson() * m.poisson());
}

}  // namespace

void measure_others(PartRun& run) {
  const std::vector<HandScene> scenes = hand_scenes(run.options);
  constexpr double kFrameRate = 30;
  double done = 0;
  for (const HandScene& scene : scenes) {
    const ForceTrace full = full_model(scene.scene, scene.tool, scene.stroke, scene.seconds, kTickRate);
    SessionOptions options;
    options.frame_rate = kFrameRate;
    options.haptic_rate = kTickRate;
    options.seconds = scene.seconds;
    options.rings = 4;
    const ForceTrace buffer = with_buffer(scene.scene, scene.tool, scene.stroke, options).felt;
    const RestStiffness rest(scene.scene, build_model(scene.scene));
    HeldForce held;
    ExtrapolatedForce line;
    ProxyForce proxy(radius_of(scene), surface_stiffness(scene));
    CondensedForce condensed;
    const std::array<std::pair<const char*, ForceModel*>, 4> models{
        std::pair{"held", &held}, {"extrapolated", &line}, {"proxy", &proxy}, {"condensed", &condensed}};
    const auto tell = [&](const std::string& model, const ForceTrace& felt) {
      const ForceError error = compare(felt, full);
      const std::string name = scene.name + ", " + model;
      run.told("largest difference from the full model, over the largest force", name, error.most / error.largest);
      run.told("root mean square difference from the full model, over the largest force", name, error.rms / error.largest);
      run.told("largest change from tick to tick, over that of the full model", name, largest_jump(felt) / largest_jump(full));
      run.trace(scene.name, model, felt);
    };
    tell("buffer of 4 rings", buffer);
    for (const auto& [name, model] : models) {
      run.show(done++ / static_cast<double>(4 * scenes.size()), scene.name + ", " + name);
      const ForceTrace felt = felt_by(scene, kFrameRate, *model, &rest);
      tell(name, felt);
      if (model != &held) continue;
      const double quieter = energy_at_multiples(felt, full, kFrameRate) / energy_at_multiples(buffer, full, kFrameRate);
      run.at_least("energy at the frame rate and its multiples, held over buffer [dB]", scene.name, 10 * std::log10(quieter),
                   20, 0);
    }
  }
}

}  // namespace pliant::bench::haptics
