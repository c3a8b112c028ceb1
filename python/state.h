// Displacements and velocities of nodes for Python.
#pragma once
#include <pliant/world.h>
#include <pybind11/pybind11.h>

void bind_state(pybind11::class_<pliant::World>& world);
