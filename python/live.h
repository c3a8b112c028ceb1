// Free running, events and traces of forces in the Python module.
#pragma once
#include <pliant/world.h>
#include <pybind11/pybind11.h>

void bind_live(pybind11::class_<pliant::World>& world);
