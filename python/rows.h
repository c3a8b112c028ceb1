// Numbers for Python.
#pragma once
#include <pybind11/numpy.h>

#include <array>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

/// A copy of a list of numbers. The shape is a vector because pybind11 before 2.12 derives the stride of a mere count from a
/// member of NumPy's descriptor that NumPy 2 has moved: every element was the first one.
template <class Numbers>
pybind11::array_t<double> row(const Numbers& numbers) {
  return pybind11::array_t<double>(std::vector<pybind11::ssize_t>{static_cast<pybind11::ssize_t>(numbers.size())},
                                   numbers.data());
}

/// A vector in memory that its capsule owns: `data` holds as long as `owner`.
template <class Element>
struct Held {
  const Element* data;
  pybind11::capsule owner;
};

template <class Element>
Held<Element> held(std::vector<Element> values) {
  auto kept = std::make_unique<std::vector<Element>>(std::move(values));
  pybind11::capsule owner(kept.get(), [](void* all) { delete static_cast<std::vector<Element>*>(all); });
  return {kept.release()->data(), std::move(owner)};
}

/// An array that takes over a vector of numbers or of arrays of numbers, without a copy: shape [size], or [size][n].
template <class Element>
pybind11::array hand_over(std::vector<Element> values) {
  namespace py = pybind11;
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(values.size())}, strides{sizeof(Element)};
  const Held<Element> all = held(std::move(values));
  if constexpr (requires { typename Element::value_type; }) {
    shape.push_back(static_cast<py::ssize_t>(std::tuple_size_v<Element>));
    strides.push_back(sizeof(typename Element::value_type));
    return {py::dtype::of<typename Element::value_type>(), shape, strides, all.data, all.owner};
  } else {
    return {py::dtype::of<Element>(), shape, strides, all.data, all.owner};
  }
}
