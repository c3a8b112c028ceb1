// The described keys of bodies, their materials and their models (described.h).
#pragma once
#include "scene/described.h"

namespace pliant {

template <class V, class S>
void describe_lattice(V&& v, S&& s) {
  v(s.spacing, {"spacing", above(0).absent_at(0), "m", "0.008", "edge of a cell"});
  v(s.nodes, {"nodes", from_to(8, 1e8).absent_at(0), "", "2886",
              "wanted number: the spacing is chosen to give about this many, or the nearest number found"});
}

template <class V, class S>
void describe_membrane(V&& v, S&& s) {
  v(s.thickness, required({"thickness", above(0), "m", "0.0001", "thickness at rest"}));
  v(s.young, required({"young", above(0), "Pa", "8e6", "Young's modulus"}));
  v(s.poisson, {"poisson", from_to(0, 0.5), "", "0.5", "Poisson's ratio; 0.5: incompressible"});
  v(s.density, {"density", at_least(0), "kg/m^3", "1000", "density at rest, in addition to the mass of the body"});
}

template <class V, class S>
void describe_vessel(V&& v, S&& s) {
  v(s.radius, required({"radius", above(0), "m", "0.002", "outer radius"}));
  v(s.wall, {"wall", above(0).absent_at(0), "m", "0.0004", "thickness of the wall, less than the radius; none: a solid bar"});
  v(s.young, required({"young", above(0), "Pa", "6e5", "Young's modulus of the wall"}));
  v(s.density, {"density", at_least(0), "kg/m^3", "1050", "density of the wall, in addition to the mass of the body"});
}

template <class V, class S>
void describe_body(V&& v, S&& s) {
  v(s.scale, {"scale", above(0), "", "0.001", "factor on the coordinates of the file"});
  v(s.translate, {"translate", any, "m", "[0, 0.1, 0]", "shift after scaling"});
  v(s.thickness, {"thickness", above(0).absent_at(0), "m", "0.002",
                  "with a `surface`, instead of `lattice`: the surface is a sheet, one layer of tetrahedra this thick"});
  v(s.element, element_words(),
    {"element", any, "", "\"hex8full\"", "what the body is made of", "`hex8` with a lattice, `tet4` with a mesh or a sheet"});
  v(s.velocity, {"velocity", any, "m/s", "[0.1, 0, 0]", "velocity at the start"});
  v(s.angular_velocity,
    {"angular_velocity", any, "rad/s", "[0, 0, 6]", "angular velocity at the start, about the centre of mass"});
}

/// What determines the moduli: one of three pairs.
struct ElasticConstants {
  std::optional<PerElement> young{};
  std::optional<double> poisson{}, lambda{}, mu{}, kappa{};
};
template <class V, class S>
void describe_elastic(V&& v, S&& s) {
  v(s.young,
    {"young", above(0), "Pa", "3000", "Young's modulus, with `poisson`; of each element its own from an array of the `mesh`"});
  v(s.poisson, {"poisson", between(-1, 0.5), "", "0.45", "Poisson's ratio, with `young`"});
  v(s.lambda, {"lambda", any, "Pa", "9310", "above -2 mu / 3: first Lame constant, with `mu`"});
  v(s.mu, {"mu", above(0), "Pa", "1034", "shear modulus, with `lambda` or `kappa`"});
  v(s.kappa, {"kappa", above(0), "Pa", "50000", "bulk modulus, with `mu`"});
}

template <class V, class S>
void describe_material(V&& v, S&& s) {
  v(s.density, {"density", above(0), "kg/m^3", "1060", "density at rest"});
  v(s.damping, {"damping", at_least(0), "1/s", "5", "mass-proportional rate c in M u'' + c M u' = R - F"});
  v(s.viscosity, {"viscosity", at_least(0), "Pa s", "20",
                  "shear viscosity eta of a stress 2 eta dev(D) + zeta tr(D) I, added to that of the law (see below)"});
  v(s.bulk_viscosity, {"bulk_viscosity", at_least(0), "Pa s", "50", "its bulk viscosity zeta"});
  v(s.stiffness_damping,
    {"stiffness_damping", at_least(0), "s", "0.001",
     "stiffness-proportional time b: the part b K of Rayleigh damping, K the stiffness at rest (see below); also of springs"});
  v(s.hourglass, {"hourglass", at_least(0), "", "0.5", "factor on the hourglass stiffness of `hex8`"});
  v(s.toughness, {"toughness", above(0).absent_at(0), "Pa", "9000",
                  "largest principal stress that it bears before it tears; none: it does not tear"});
  v(s.integrity,
    {"integrity", above_to(0, 1).absent_at(1), "", "0.7", "share of the toughness that is left; only with `toughness`"});
}

template <class V, class S>
void describe_type(V&& v, S&& s) {
  v(s.type, model_words(),
    required(
        {"type", any, "", "\"hybrid\"", "which nodes follow finite elements: all, those of the operational region, or none"}));
}

/// Of a hybrid without a region: which nodes are operational.
template <class V, class S>
void describe_growth(V&& v, S&& s) {
  v(s.ratio, {"ratio", from_to(0, 1), "", "0.4", "share of the nodes in the operational region"});
  v(s.seed, {"seed", any, "m", "[0.05, 0.02, 0]", "where the operational region grows from", "first vertex of the surface"});
  v(s.follow,
    {"follow", any.absent_at(0), "", "\"scalpel\"",
     "the operational region moves with what has this name: `\"focus\"`, a blade or a tool of the scene, or `\"host/NAME\"`, a "
     "blade that a program moves; cells stretched or compressed beyond 1.5 times keep their model until they are not"});
}

// The struct of a Scene has flags for two words of that of include/pliant.
template <class M>
auto& goals_of(M& model) {
  if constexpr (requires { model.goals; })
    return model.goals;
  else
    return model.extrapolate;
}
template <class M>
auto& coupling_of(M& model) {
  if constexpr (requires { model.coupling; })
    return model.coupling;
  else
    return model.conservative;
}

/// Of a hybrid.
template <class V, class S>
void describe_interface(V&& v, S&& s) {
  v(s.beta,
    {"beta", above(0).or_word("auto"), "N/m", "20", "stiffness of the interface; `\"auto\"`: alpha m / dt^2 of each node"});
  v(s.substeps,
    {"substeps", from_to(1, 64).or_word("auto"), "", "4",
     "steps of TLED per step of FLSM; `\"auto\"`: as many as the stiffness of shape matching allows, 1 to 8, with "
     "extrapolated goals; a run continues with 1 where more drive the elements apart ([stability.md](stability.md))"});
  v(goals_of(s), goals_words(),
    {"goals", any, "", "\"extrapolated\"",
     "`held`: the interface is pulled in the first substep (keeps momentum); `extrapolated`: in all of them (allows larger "
     "steps)"});
  v(coupling_of(s), coupling_words(),
    {"coupling", any, "", "\"one-sided\"", "`conservative`: the reaction of the interface goes back to the regions"});
}

/// Of a hybrid and of shape matching alone.
template <class V, class S>
void describe_regions(V&& v, S&& s) {
  v(s.width, {"width", from_to(1, 5), "cells", "3", "half-width of the regions of shape matching"});
  v(s.damping, {"damping", from_to(0, 1), "", "0.1", "damping of each region per step"});
  v(s.cut, {"cut", any, "", "false", "`false`: blades pass through the shape-matching part without effect"});
}

template <class V, class S>
void describe_alpha(V&& v, S&& s) {
  v(s.alpha, {"alpha", above_to(0, 1), "", "0.8",
              "fraction of the distance to its goal that a node moves per step; refers to the first step: shorter steps "
              "take less, and are as stiff",
              "as `stiffness` of the material (hybrid), 0.5 (flsm)"});
}

/// Of a mass-spring model.
template <class V, class S>
void describe_network(V&& v, S&& s) {
  v(s.edge_springs, {"edge_springs", any, "", "false",
                     "`false`: no springs along the edges of the tetrahedra, only those of the body's `springs`"});
}

/// Of a mass-spring model, of the springs of a body and of a join.
template <class V, class S>
void describe_spring(V&& v, S&& s) {
  v(s.law, spring_law_words(), {"law", any, "", "\"cubic\"", "force F over the elongation e from the length l0 at rest"});
  v(s.stiffness, {"stiffness", above(0).or_word("auto").absent_at(0), "N/m", "40",
                  "of `linear`; `\"auto\"`, only in a model: of each edge from Young's modulus"});
  v(s.lambda1, {"lambda1", at_least(0).absent_at(0), "N", "30", "of `cubic`"});
  v(s.lambda2, {"lambda2", above(0).absent_at(0), "N", "5", "of `cubic`"});
  v(s.a, {"a", any.absent_at(0), "1/N", "-0.2",
          "of `measured`; below 0 the spring stiffens, and from 3/4 of the elongation b / -a, where F is infinite, follows its "
          "tangent"});
  v(s.b, {"b", above(0).absent_at(0), "m/N", "0.02", "of `measured`: 1 / b is the stiffness at rest"});
  v(s.damping, {"damping", at_least(0).absent_at(0), "N s/m", "0.1", "force over the rate of the length"});
  v(s.slack, {"slack", any.absent_at(0), "", "true", "`true`: no force when it is shorter than at rest"});
}

template <class V, class S>
void describe_join(V&& v, S&& s) {
  v(s.distance, required({"distance", above(0), "m", "0.004", "pairs of nodes that are no further apart at rest are joined"}));
  v(s.break_stretch, {"break_stretch", above(1).absent_at(0), "", "1.8",
                      "a spring longer than this times its length at rest breaks; none: it does not"});
  v(s.break_force, {"break_force", above(0).absent_at(0), "N", "0.3", "a spring that pulls more breaks; none: it does not"});
}

template <class V, class S>
void describe_stiffness(V&& v, S&& s) {
  v(s.young, required({"young", above(0), "Pa", "3000", "effective Young's modulus of shape matching"}));
}

}  // namespace pliant
