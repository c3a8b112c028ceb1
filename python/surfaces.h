// Surfaces from arrays of Python.
#pragma once
#include <pliant/scene.h>
#include <pybind11/numpy.h>

using Vertices = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// A surface of vertices [m], shape [vertices, 3], and triangles, integers of the shape [triangles, 3]. Throws Error (usage).
pliant::SurfaceSpec surface(const Vertices& vertices, const pybind11::object& given);
