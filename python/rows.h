// Numbers for Python.
#pragma once
#include <pybind11/numpy.h>

#include <vector>

/// A copy of a list of numbers. The shape is a vector because pybind11 before 2.12 derives the stride of a mere count from a
/// member of NumPy's descriptor that NumPy 2 has moved: every element was the first one.
template <class Numbers>
pybind11::array_t<double> row(const Numbers& numbers) {
  return pybind11::array_t<double>(std::vector<pybind11::ssize_t>{static_cast<pybind11::ssize_t>(numbers.size())},
                                   numbers.data());
}
