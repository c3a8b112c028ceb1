// The described keys of materials, contact and tools (described.h).
#pragma once
#include "scene/described.h"

namespace pliant {

template <class V, class... S>
void describe_material(V&& v, S&&... s) {
  v(Key{.name = "density",
        .range = above(0),
        .unit = "kg/m^3",
        .about = "Density at rest",
        .note = "at rest",
        .example = "1060"},
    s.density...);
  v(Key{.name = "damping",
        .range = at_least(0),
        .unit = "1/s",
        .about = "Mass-proportional damping rate",
        .note = "mass-proportional rate c in M u'' + c M u' = R - F",
        .example = "5"},
    s.damping...);
  v(Key{.name = "hourglass",
        .range = at_least(0),
        .about = "Factor on the hourglass stiffness of hex8",
        .note = "factor on the hourglass stiffness of `hex8`",
        .example = "0.5"},
    s.hourglass...);
}

template <class V, class... S>
void describe_tearing(V&& v, S&&... s) {
  v(Key{.name = "toughness",
        .range = above(0),
        .optional = true,
        .unit = "Pa",
        .about = "Principal stress at which the material tears; without it, it does not",
        .note = "largest principal stress that it bears before it tears; none: it does not tear",
        .example = "9000"},
    s.toughness...);
  v(Key{.name = "integrity",
        .range = above_to(0, 1),
        .about = "Share of the toughness that is left",
        .note = "share of the toughness that is left; only beside `toughness`",
        .example = "0.7"},
    s.integrity...);
}

/// Of a tool, and of tissue on tissue.
template <class V, class... S>
void describe_friction(V&& v, S&&... s) {
  v(Key{.name = "friction",
        .range = at_least(0),
        .about = "Coulomb's coefficient",
        .note = "Coulomb's coefficient",
        .example = "0.3"},
    s.friction...);
}

/// What every tool has.
template <class V, class... S>
void describe_tool(V&& v, S&&... s) {
  describe_friction(v, s...);
  v(Key{.name = "edges",
        .about = "A sphere, capsule, box or mesh that is thinner than half a cell is met along its edges; experimental",
        .note = "`true` beside a sphere, capsule, box or mesh: where it is thinner than half a cell it is met along its edges "
                "instead of passing between points of contact; experimental ([contact](contact.md#thin-tools))",
        .example = "true"},
    s.edges...);
}

/// Of a tool that is a mesh or a sequence of meshes.
template <class V, class... S>
void describe_mesh_tool(V&& v, S&&... s) {
  v(Key{.name = "scale",
        .range = above(0),
        .about = "Applied to the coordinates of a mesh or a sequence",
        .note = "of the coordinates of a mesh or a sequence",
        .example = "0.001"},
    s.scale...);
}

/// Of a tool that is a sequence of meshes.
template <class V, class... S>
void describe_sequence_tool(V&& v, S&&... s) {
  v(Key{.name = "frames_per_second",
        .range = above(0),
        .unit = "1/s",
        .about = "Of a sequence; the first mesh stands at time 0, the last one stays",
        .note = "of a sequence, whose first mesh stands at time 0 and whose last one stays",
        .example = "25"},
    s.frames_per_second...);
}

}  // namespace pliant
