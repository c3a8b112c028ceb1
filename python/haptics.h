// Touch in the Python module.
#pragma once
#include <pybind11/pybind11.h>

/// Adds HapticLoop, its devices and what they tell. World must be there already.
void bind_haptics(pybind11::module_& m);
