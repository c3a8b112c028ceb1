// The keys of a scene file that are one number, flag or word, each described once. The loader, the keys that it knows, the
// writer, scenes/schema.json, the tables of docs/scene.md and the copy from the structs of include/pliant follow from it
// (described_keys.h, tests/scene/tables_test.cpp). A key of this kind is a member of its struct, a line here, its use and its
// test.
#pragma once
#include <optional>

#include "scene/keys.h"
#include "scene/scene.h"

namespace pliant {

/// What a number may be. Bounds of 1e30 are those of every number; an open bound at 0 is 1e-30 (reader.h).
struct Range {
  double least = -1e30, most = 1e30;
  bool above = false, below = false;  ///< whether the bounds themselves are not allowed
};
constexpr Range above(double least) { return {least, 1e30, true, false}; }
constexpr Range at_least(double least) { return {least, 1e30, false, false}; }
constexpr Range from_to(double least, double most) { return {least, most, false, false}; }
constexpr Range above_to(double least, double most) { return {least, most, true, false}; }
constexpr Range between(double least, double most) { return {least, most, true, true}; }

struct Key {
  const char* name;
  Range range{};
  std::optional<double> also{};  ///< allowed though it is outside of the range
  const char* word = nullptr;    ///< how the file writes `also`
  bool optional = false;         ///< 0 in the struct is a key that is not there
  const char* unit = "";
  const char* about = "";    ///< for scenes/schema.json
  const char* note = "";     ///< for docs/scene.md, behind what is allowed
  const char* example = "";  ///< a value
};

// Each calls v(key, members...) for a number or a flag and v(key, words, members...) for an enumerator: one member of each of
// the objects, which are a Scene and, where there is one, the struct that code fills in (SceneSpec).

template <class V, class... S>
void describe_scene(V&& v, S&&... s) {
  v(Key{.name = "dt",
        .range = above(0),
        .also = 0.0,
        .word = "auto",
        .unit = "s",
        .about = "Time step, or auto: safety times the stable step",
        .note = "a number is used as it is",
        .example = "1e-4"},
    s.dt...);
  v(Key{.name = "safety",
        .range = above_to(0, 1),
        .about = "Share of the stable step that an automatic step takes",
        .note = "an automatic step is this share of the stable one",
        .example = "0.8"},
    s.safety...);
  v(Key{.name = "integrator",
        .about = "Form of the central difference update",
        .note = "`\"textbook\"` loses small increments in float; for comparison",
        .example = "\"textbook\""},
    integrator_words(), s.integrator...);
  v(Key{.name = "inverted",
        .about = "What becomes of an element whose J = det F is not positive",
        .note =
            "what becomes of an element whose J = det F is not positive: it goes on and is driven back, or the run ends (see "
            "[troubleshooting](troubleshooting.md))",
        .example = "\"stop\""},
    inverted_words(), s.inverted...);
  v(Key{.name = "break_stretch",
        .range = above(1),
        .also = 0.0,
        .about = "Edges longer than this times their length at rest part, in scenes that are cut or tear; 0: none does",
        .note =
            "in a scene that is cut, an edge beside a cut that is longer than this times its length at rest parts in its "
            "middle, and elsewhere at four times this; in a body with a `toughness`, beside a tear likewise, along faces at "
            "one of its ends; 0: none does",
        .example = "0"},
    s.break_stretch...);
  v(Key{.name = "least_step",
        .range = from_to(0, 1),
        .about = "Floor of an automatic step, as a share of the first. Elements that ask for less get inertia without weight "
                 "instead, which is reported; 0: no floor",
        .note = "floor of an automatic step, as a share of the first: elements that ask for less get inertia (no weight) "
                "instead, which `run` reports; 0: no floor",
        .example = "0"},
    s.least_step...);
  v(Key{.name = "least_fill",
        .range = from_to(0, 1),
        .about =
            "Where blades cut: a cell or a copy of one is at least as stiff and as inert as this share of a full cell. What "
            "is added has no weight",
        .note = "where blades cut, a cell or a copy of one is at least as stiff and as inert as this share of a full cell "
                "(copies of one cell share its stiffness; of a cell thinner than that, in equal parts at least); inertia that "
                "is added has no weight",
        .example = "0"},
    s.least_fill...);
}

/// Of a run, which code gives by what it calls.
template <class V, class... S>
void describe_run(V&& v, S&&... s) {
  v(Key{.name = "duration",
        .range = above(0),
        .unit = "s",
        .about = "Simulated time of a run without --steps or --seconds",
        .note = "simulated by `run` without `--steps` or `--seconds`",
        .example = "2.5"},
    s.duration...);
}

template <class V, class... S>
void describe_relaxation(V&& v, S&&... s) {
  v(Key{.name = "tolerance",
        .range = between(0, 1),
        .about = "Stop at |R - F| <= tolerance times the larger of |R|, |F|",
        .note = "done when abs(R - F) <= tolerance times the larger of abs(R), abs(F)",
        .example = "1e-6"},
    s.tolerance...);
  v(Key{.name = "max_steps",
        .range = from_to(1, 1e12),
        .unit = "steps",
        .about = "Give up after so many",
        .note = "then the run gives up",
        .example = "20000"},
    s.max_steps...);
}

template <class V, class... S>
void describe_solver(V&& v, S&&... s) {
  v(Key{.name = "linear",
        .about = "Small displacements",
        .note = "`true`: one linear solve, displacements are small by assumption",
        .example = "true"},
    s.linear...);
  v(Key{.name = "load_steps",
        .range = from_to(1, 1e6),
        .also = 0.0,
        .word = "auto",
        .about = "In how many steps loads grow",
        .note = "`\"auto\"`: one, halved where Newton's method fails",
        .example = "10"},
    s.load_steps...);
  v(Key{.name = "tolerance",
        .range = between(0, 1),
        .about = "Converged at |R - F| <= tolerance times the larger of |R|, |F|",
        .note = "converged when abs(R - F) <= tolerance times the larger of abs(R), abs(F)",
        .example = "1e-10"},
    s.tolerance...);
}

}  // namespace pliant
