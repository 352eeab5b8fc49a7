// From C++ to Python and back.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "core/base/json.h"
#include "python/attended.h"
#include "python/failure.h"

namespace whit::python {

namespace py = pybind11;

/// Text that may come from files: bytes that are no UTF-8 are kept, as os.fsdecode() does.
py::str text(const std::string& bytes);

/// None, bool, int, float, str, list or dict.
py::object to_python(const Json& json);

/// A dict with the members of Said.
py::dict to_python(const Said& said);
py::list to_python(const std::vector<Said>& said);

/// The value of a key into `to`; nothing where it is missing or None.
template <class T>
void take(const py::dict& from, const char* key, T& to) {
  if (from.contains(key) && !from[key].is_none()) to = from[key].cast<T>();
}

/// Raises whit.Error's class for it, with `diagnostics`.
void raise(const Failure& failure);

/// The result of work(attention), which runs without the interpreter. Meanwhile signals come through, and `progress` is
/// called with the share done unless it is None; the work ends early when it returns False.
template <class Work>
auto wait_for(Work&& work, const py::object& progress) {
  const Look look = [&progress](double share) {
    const py::gil_scoped_acquire interpreter;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return progress.is_none() || progress(share).ptr() != Py_False;
  };
  const py::gil_scoped_release released;
  return attended(std::forward<Work>(work), look);
}

/// What a module of the extension adds to it.
void add_scenes(py::module_& module);
void add_pictures(py::module_& module);
void add_inquiries(py::module_& module);
void add_comparisons(py::module_& module);

}  // namespace whit::python
