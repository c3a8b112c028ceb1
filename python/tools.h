// Grabs, rigid tools and parameters of a World in the Python module.
#pragma once
#include <pliant/world.h>
#include <pybind11/pybind11.h>

void bind_tools(pybind11::class_<pliant::World>& world);
/// By name: where each blade that cuts by force is, and what it feels.
pybind11::dict blade_forces(const pliant::World& w);
/// A dict for each of their attempts since the last call.
pybind11::list cut_attempts(pliant::World& w);
