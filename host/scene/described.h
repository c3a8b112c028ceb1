// Keys of a scene file with a single value (a number, a flag, a word, three numbers), each described once. The loader, its
// list of keys, the writer, scenes/schema.json, the tables of docs/scene.md and the conversion from the structs of
// include/pliant derive from it (described_keys.h, write.cpp, tests/scene/tables_test.cpp). A key of this kind needs a member
// of its struct, a line here, in described_parts.h or in described_entries.h, its use and its test.
#pragma once
#include <limits>
#include <optional>

#include "scene/keys.h"
#include "scene/scene.h"

namespace pliant {

/// Allowed range of a number. Bounds of 1e30 are those of every number; an open bound at 0 is 1e-30 (reader.h).
struct Range {
  double least = -1e30, most = 1e30;
  bool above = false, below = false;  ///< whether the bounds themselves are not allowed
  std::optional<double> also{};       ///< allowed though it is outside
  const char* word = nullptr;         ///< how the file writes `also`
  std::optional<double> absent{};     ///< in the struct: a key that is not there; of a flag 0 or 1

  [[nodiscard]] constexpr Range or_number(double x) const {
    Range r = *this;
    r.also = x;
    return r;
  }
  /// The struct has 0 for it.
  [[nodiscard]] constexpr Range or_word(const char* text) const {
    Range r = or_number(0);
    r.word = text;
    return r;
  }
  [[nodiscard]] constexpr Range absent_at(double x) const {
    Range r = *this;
    r.absent = x;
    return r;
  }
};
constexpr Range any{};
constexpr Range above(double least) { return {least, 1e30, true, false}; }
constexpr Range at_least(double least) { return {least, 1e30, false, false}; }
constexpr Range from_to(double least, double most) { return {least, most, false, false}; }
constexpr Range above_to(double least, double most) { return {least, most, true, false}; }
constexpr Range between(double least, double most) { return {least, most, true, true}; }

/// A number that may be another one in each element: the file gives it, or {"field": the name of an array of the body's mesh}.
struct PerElement {
  double value = 0;
  std::string field{};
};

struct Key {
  const char* name;
  Range range;
  const char* unit;
  const char* example;  ///< a value
  const char* about;    ///< text after the allowed values; the schema has it without the marks of code spans and links
  const char* standard = nullptr;  ///< for docs/scene.md, where it is no value of the struct
  bool required = false;
};
constexpr Key required(Key key) {
  key.required = true;
  return key;
}

// Each calls v(member, key) or, for a value that a file writes as a word, v(member, words, key). The object is a part of a
// Scene, or the struct of include/pliant that becomes one, whose words are text and whose members may be optional.

template <class V, class S>
void describe_scene(V&& v, S&& s) {
  v(s.dt,
    {"dt", above(0).or_word("auto"), "s", "1e-4", "time step, used as it is; `\"auto\"`: `safety` times the stable step"});
  v(s.safety, {"safety", above_to(0, 1), "", "0.8", "an automatic step is this share of the stable one"});
  v(s.integrator, integrator_words(),
    {"integrator", any, "", "\"textbook\"",
     "central differences in two forms, of which `\"textbook\"` loses small increments in float, and explicit Euler "
     "([stability](stability.md#integrators)), both for comparison"});
  v(s.inverted, inverted_words(),
    {"inverted", any, "", "\"stop\"",
     "treatment of an element whose J = det F is not positive: it is driven back, or the run ends (see "
     "[troubleshooting](troubleshooting.md))"});
  v(s.break_stretch,
    {"break_stretch", above(1).or_number(0), "", "0",
     "in a scene that is cut, an edge at a cut parts in its middle when it is longer than this times its undeformed length, "
     "and elsewhere at four times this; in a body with a `toughness` likewise at a tear, along faces at one of its ends; 0: "
     "never"});
  v(s.least_step,
    {"least_step", from_to(0, 1), "", "0",
     "lower bound of an automatic step, as a share of the first: elements that need a shorter one get inertia (no weight) "
     "instead, which `run` reports; 0: no floor"});
  v(s.least_fill,
    {"least_fill", from_to(0, 1), "", "0",
     "where blades cut, a cell or a copy of one is at least as stiff and as inert as this share of a full cell (copies of one "
     "cell share its stiffness; of a cell thinner than that, in equal parts at least); inertia that is added has no weight"});
}

/// Settings of a run, which code passes in its calls.
template <class V, class S>
void describe_run(V&& v, S&& s) {
  v(s.duration, {"duration", above(0), "s", "2.5", "time that `run` simulates without `--steps` or `--seconds`"});
}

template <class V, class S>
void describe_relaxation(V&& v, S&& s) {
  v(s.tolerance,
    {"tolerance", between(0, 1), "", "1e-6", "done when abs(R - F) <= tolerance times the larger of abs(R), abs(F)"});
  v(s.max_steps, {"max_steps", from_to(1, 1e12), "steps", "20000", "after so many the run gives up"});
}

template <class V, class S>
void describe_solver(V&& v, S&& s) {
  v(s.enabled, solver_words(),
    required({"type", any, "", "\"static\"", "steps in time, or equilibrium under the final values of all curves"}));
  v(s.linear, {"linear", any, "", "true", "small displacements by assumption, one linear solve"});
  v(s.load_steps, {"load_steps", from_to(1, 1e6).or_word("auto"), "", "10",
                   "in how many steps loads grow; `\"auto\"`: one, halved where Newton's method fails"});
  v(s.tolerance,
    {"tolerance", between(0, 1), "", "1e-10", "converged when abs(R - F) <= tolerance times the larger of abs(R), abs(F)"});
  v(s.order, {"order", from_to(1, 2), "", "2", "2 gives tetrahedra a node in the middle of every edge (tet10)"});
}

template <class V, class S>
void describe_blade(V&& v, S&& s) {
  constexpr double kAlways = std::numeric_limits<double>::infinity();
  v(s.start,
    {"start", any.absent_at(-kAlways), "s", "0.1", "it cuts from then on, while its path lasts", "first time of the path"});
  v(s.end, {"end", any.absent_at(kAlways), "s", "0.4", "it cuts until then, while its path lasts", "last time of the path"});
  v(s.cuts, blade_cuts_words(),
    {"cuts", any, "", "\"by-force\"",
     "what it cuts: all that it sweeps over, or what gives way to the force of its edge "
     "([cutting by force](cutting.md#cutting-by-force))"});
  v(s.method, blade_method_words(),
    {"method", any, "", "\"separation\"",
     "how it divides the elements ([live methods](cutting.md#methods-of-live-cuts)); all blades of a scene have the same"});
  v(s.sharpness, {"sharpness", above(0).absent_at(1), "", "0.5",
                  "kappa: tissue gives way at this share of its `toughness`; the smaller the sharper; only by force"});
  v(s.edge, {"edge", above(0).absent_at(0), "m", "0.0002", "radius of the edge; required by force, refused otherwise"});
  v(s.friction, {"friction", at_least(0).absent_at(0), "", "0.2", "between the blade and tissue; only by force"});
  v(s.thickness, {"thickness", above(0).absent_at(0), "m", "0.001",
                  "the blade has two faces, which hold the cut open by this ([faces](cutting.md#faces)); only by force, with "
                  "`height`; none: it is an edge without faces"});
  v(s.height, {"height", above(0).absent_at(0), "m", "0.012",
               "how far the faces reach back from the edge, at least `thickness`; they are flat in the middle third"});
  v(s.back, {"back", any, "", "[0, 1, 0]",
             "direction from the edge to the back of the blade, turned with the edge; needed where the path does not move the "
             "blade across its edge",
             "against the first motion of the path across the edge"});
}

template <class V, class S>
void describe_view(V&& v, S&& s) {
  v(s.eye, {"eye", any, "m", "[0.2, 0.3, 0.6]", "place of the camera, not the target",
            "so far from the target that the scene fills the picture"});
  v(s.target, {"target", any, "m", "[0, 0.05, 0]", "what is in the middle of the picture", "the middle of the scene"});
  v(s.up, {"up", any, "", "[0, 0, 1]", "vertical direction, not zero", "against gravity, or y"});
  v(s.field_of_view, {"field_of_view", from_to(1, 120).absent_at(30), "degrees", "20", "vertical"});
  v(s.ground, {"ground", any.absent_at(1), "", "false", "a plane below the bodies, which holds nothing"});
}

}  // namespace pliant
