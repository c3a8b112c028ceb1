#include "simulation/measure/run_remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "cutting/topology/mesh_edges.h"
#include "geometry/vec.h"
#include "schedule/program_layout.h"
#include "simulation/contact/sunken_tool.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/measure/reactions.h"
#include "simulation/step/applied_loads.h"

namespace pliant {
namespace {

using Sentences = std::vector<std::string>;

constexpr double kDeep = 0.5;     ///< [cells] in tissue
constexpr double kThin = 0.7;     ///< [cells] the diagonal between contact points half a cell apart
constexpr double kDamped = 0.03;  ///< fraction of tool forces from damping that is not reported

void add_substeps(const Simulation& s, Sentences& out) {
  if (s.state().most_substeps == 0) return;
  out.push_back(
      fmt::format("finite elements burst or stiffened where shape matching pulls once in several steps; hybrids went on with "
                  "\"substeps\": {}",
                  s.state().most_substeps));
}

void add_opened(const Simulation& s, Sentences& out) {
  if (s.state().opened == 0) return;
  out.push_back(fmt::format(
      "{} edges split: they were stretched beyond {:.3g} times their length next to a cut or tear, or {:.3g} times "
      "elsewhere (\"break_stretch\"); a material far too soft for its weight also causes this: check the units of the "
      "scene",
      s.state().opened, s.scene().break_stretch, kWholeStretch * s.scene().break_stretch));
}

/// What decomposition and removal have cost.
void add_remade(const Simulation& s, Sentences& out) {
  const RemadeElements& sums = s.state().remade;
  if (sums.empty()) return;
  double mass = 0;
  for (const ModelBody& body : s.model().bodies) mass += body.mass;
  if (blade_method(s.scene()) == BladeMethod::removal) {
    out.push_back(
        fmt::format("blades removed {} elements and with them {:.4g} kg, {:.3g} of the mass, in {} edits (\"removal\")",
                    -sums.elements, sums.mass, sums.mass / (sums.mass + mass), sums.edits));
    return;
  }
  std::string text =
      fmt::format("blades divided elements, {} more now, in {} edits (\"decomposition\"); ", sums.elements, sums.edits);
  const double bound = s.model().element_bound;
  if (s.dt() < sums.first_step) {
    text += fmt::format("the step fell from {:.4g} s before the first to {:.4g} s, {:.3g} of it", sums.first_step, s.dt(),
                        s.dt() / sums.first_step);
  } else if (bound < s.dt()) {
    text += fmt::format("the step stays the given {:.4g} s, and the smallest element is stable up to {:.4g} s", s.dt(), bound);
  } else {
    text += fmt::format("the step stays {:.4g} s", s.dt());
  }
  out.push_back(text);
}

void add_ballast(const Simulation& s, Sentences& out) {
  const BallastReport& ballast = s.report().ballast;
  if (!(ballast.most > 0)) return;
  double mass = 0;
  for (const ModelBody& body : s.model().bodies) mass += body.mass;
  out.push_back(fmt::format(
      "elements whose stable step is below {:.3g} of the first step received inertia: at most {:.3g} of the mass, {:.3g} "
      "on {} nodes at the end",
      s.scene().least_step, ballast.most / mass, ballast.mass / mass, ballast.nodes));
}

void add_inversions(const Simulation& s, Sentences& out) {
  const Inversions& inverted = s.report().inversions;
  if (inverted.calmed > 0) {
    out.push_back(
        fmt::format("{} elements deformed by more than a quarter of an edge in one step, and the solver damped the excess "
                    "(an element counts once per batch)",
                    inverted.calmed));
  }
  if (inverted.batches == 0) return;
  out.push_back(
      fmt::format("up to {} elements at a time were turned inside out and driven back, first in step {} (t = {:.4g} s), "
                  "element {} of body '{}'; {} in the last steps",
                  inverted.most, inverted.first_step, inverted.first_time, inverted.element, inverted.body, inverted.last));
}

/// Springs resist no change of volume, so that a network may stay as it is when it has been crushed or turned inside out.
void add_turned_networks(const Simulation& s, Sentences& out) {
  for (std::size_t b = 0; b < s.model().bodies.size(); ++b) {
    if (s.scene().bodies[b].model.type != ModelType::mass_spring) continue;
    const ModelBody& body = s.model().bodies[b];
    const std::vector<Vec3d> u = s.displacements(b);
    std::size_t turned = 0;
    for (const auto& t : body.tets) {
      std::array<Vec3d, 4> x{};
      for (std::size_t a = 0; a < 4; ++a) x[a] = vec::add(body.rest[t[a]], u[static_cast<std::size_t>(t[a])]);
      const Vec3d p = vec::sub(x[1], x[0]), q = vec::sub(x[2], x[0]), r = vec::sub(x[3], x[0]);
      if (vec::dot(p, vec::cross(q, r)) < 0) ++turned;
    }
    if (turned == 0) continue;
    out.push_back(fmt::format(
        "{} of {} tetrahedra of the network '{}' are inside out at t = {:.4g} s: its springs resist no change of volume, and a "
        "network that is pressed or bent too far stays so; stiffer springs, smaller loads or finite elements (\"tled\") do not",
        turned, body.tets.size(), body.name, s.time()));
  }
}

/// `t`: the tool that the model has at number `tool`.
void add_grip(const Simulation& s, const ContactTool& t, std::size_t tool, Sentences& out) {
  if (!t.grip) return;
  if (t.grip->times.empty() && s.state().gripping.count(t.name) == 0) {
    out.push_back(
        fmt::format("tool '{}' has a \"grip\" without \"times\", and nothing told it to grip: it holds no tissue", t.name));
    return;
  }
  const BufferId anchors = s.program().find("contact_anchor");
  if (anchors < 0 || !(tool_grip(t, s.state(), s.time()) > 0)) return;
  const std::vector<double> numbers = s.backend().read_reals(anchors);
  for (std::size_t i = 0; i < s.model().contact->size(); ++i) {
    if (numbers[tile_base(i, 4) + 3 * PLIANT_TILE] == -static_cast<double>(tool + 1)) return;
  }
  out.push_back(fmt::format(
      "tool '{}' grips at t = {:.4g} s and holds no tissue: it holds what it touches, but for fixed and prescribed nodes, from "
      "when its times begin; check its path, its \"times\" and its \"strength\"",
      t.name, s.time()));
}

/// The smallest dimension of a shape [m]; infinite for a half space.
double thickness(const ToolForm& form) {
  switch (form.shape) {
    case ToolShape::sphere:
    case ToolShape::capsule:
      return 2 * form.radius;
    case ToolShape::box:
    case ToolShape::blade_face:
      return 2 * std::min({form.second[0], form.second[1], form.second[2]});
    case ToolShape::half_space:
      break;
    case ToolShape::mesh:
    case ToolShape::sequence: {
      vec::Box box;
      for (const Vec3d& x : form.surface.vertices) box.extend(x);
      for (const ToolFrame& frame : form.frames) {
        for (const Vec3d& x : frame.surface.vertices) box.extend(x);
      }
      const Vec3d size = vec::sub(box.upper, box.lower);
      return std::min({size[0], size[1], size[2]});
    }
  }
  return std::numeric_limits<double>::infinity();
}

/// `now`: where it is deepest below a surface at the end.
void add_tool(const Simulation& s, const std::string& name, std::size_t tool, const SunkenTool& now, Sentences& out) {
  const ToolHistory& h = s.report().tools[tool];
  const double spacing = s.model().contact->spacing, cells = h.max_depth / spacing;
  const double thick = thickness((*s.model().tools)[tool]);
  if (thick < kThin * spacing && edge_points((*s.model().tools)[tool], *s.model().contact).empty()) {
    out.push_back(fmt::format(
        "tool '{}' is {:.3g} m thin, and points of contact are {:.3g} m apart (half a cell): it passes between them, and its "
        "force means little; smaller cells would feel it, and \"edges\": true does (docs/contact.md, Thin tools)",
        name, thick, 0.5 * spacing));
  }
  if (cells > kDeep) {
    out.push_back(
        fmt::format("tool '{}' went {:.2g} cells deep into tissue: nodes that are fixed or prescribed do not yield to it, an "
                    "edge thinner than half a cell passes between contact points, and a tool that moves a cell in a few steps "
                    "is detected late",
                    name, cells));
  }
  SunkenTool sunk = h.deepest;
  if (now.cells() > sunk.cells()) sunk = now;
  if (sunk.cells() > sunken_cells) {
    out.push_back(fmt::format(
        "tool '{}' stood {:.3g} m ({:.2g} cells) below the surface of body '{}' at t = {:.4g} s, [{:.4g}, {:.4g}, {:.4g}]: "
        "points of "
        "contact have let it through, or nodes that are fixed or prescribed do not yield, and its force means little; a tool "
        "that is thicker than a cell and presses less deep is held (docs/contact.md, Limits)",
        name, sunk.depth, sunk.cells(), s.model().bodies[static_cast<std::size_t>(sunk.body)].name, sunk.time, sunk.where[0],
        sunk.where[1], sunk.where[2]));
    return;
  }
  if (h.touched == 0 && s.step() > 0) {
    out.push_back(fmt::format(
        "tool '{}' has touched nothing until t = {:.4g} s: check its path, its size and the units of both", name, s.time()));
  }
}

/// The reactions of the bodies' supports balance the tool forces, except for loads, inertia and the damping of moving
/// material: M a + c M v = (reactions) + (loads) - (force on tools).
void add_damping(Simulation& s, Sentences& out) {
  if (s.scene().relaxation.enabled || !s.model().flsm.empty() || !integrator_info(s.scene().integrator).contact) return;
  Vec3d on_tools{}, held{}, damped{};
  for (const ToolHistory& h : s.report().tools) on_tools = vec::add(on_tools, h.now.force);
  const double size = vec::norm(on_tools);
  if (!(size > 0)) return;
  bool holds = false;
  for (std::size_t b = 0; b < s.model().bodies.size(); ++b) {
    const auto loads = applied_loads(s, b), reaction = reactions(s, b), v = s.velocities(b);
    const std::vector<std::int32_t>& slot = s.model().bodies[b].slot;
    for (std::size_t n = 0; n < slot.size(); ++n) {
      const auto i = static_cast<std::size_t>(slot[n]);
      holds = holds || vec::norm(reaction[n]) > 0;
      held = vec::add(held, vec::add(reaction[n], loads[n]));
      damped = vec::add(damped, vec::mul(v[n], s.model().mass[i] * s.model().damping[i]));
    }
  }
  const double apart = vec::norm(vec::sub(on_tools, held));
  if (!holds || !(apart > kDamped * size) || !(vec::norm(damped) > 0.5 * apart)) return;
  out.push_back(fmt::format(
      "the force on the tools is {:.3g} N, and the supports carry {:.3g} N less the loads: \"damping\" causes most of the "
      "difference, {:.2g} % of the force; it resists all motion as if the tissue stood in a thick liquid; slower tools, less "
      "damping or \"relaxation\" give the force of the tissue alone (docs/contact.md, Force curves)",
      size, vec::norm(held), 100 * apart / size));
}

void add_contact(Simulation& s, Sentences& out) {
  const ContactPoints* points = s.model().contact.get();
  if (points == nullptr || points->size() == 0) return;
  const double deepest = s.report().tissue.max_depth / points->spacing;
  if (deepest > kDeep) {
    out.push_back(fmt::format(
        "tissue went {:.2g} cells deep into other tissue: sharp edges and parts thinner than a cell meet late, and held nodes "
        "do not give way; smaller cells help",
        deepest));
  }
  // Those that the model has: without those that a host has removed or parked, with those that it has added.
  const std::vector<ContactTool> tools = present_tools(s.scene(), s.state().tools);
  const std::vector<SunkenTool> sunken = s.contact().sunken_now();
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (!is_face(tools[t])) add_tool(s, tools[t].name, t, sunken[t], out);
  }
  for (std::size_t t = 0; t < tools.size(); ++t) add_grip(s, tools[t], t, out);
  add_damping(s, out);
}

}  // namespace

std::vector<std::string> run_remarks(Simulation& simulation) {
  Sentences out;
  add_substeps(simulation, out);
  add_opened(simulation, out);
  add_remade(simulation, out);
  add_ballast(simulation, out);
  add_inversions(simulation, out);
  add_turned_networks(simulation, out);
  add_contact(simulation, out);
  if (std::string of_backend = simulation.backend().remark(); !of_backend.empty()) out.push_back(std::move(of_backend));
  return out;
}

}  // namespace pliant
