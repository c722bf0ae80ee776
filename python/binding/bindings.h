#pragma once

#include <pybind11/pybind11.h>

namespace saccade::python {

/// Each adds one part of the library to the module; the docstrings that users read are those of the
/// Python files beside it.
void bind_errors(pybind11::module_& module);
void bind_config(pybind11::module_& module);
void bind_events(pybind11::module_& module);
void bind_dataset(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_tracking(pybind11::module_& module);
void bind_runs(pybind11::module_& module);
void bind_scores(pybind11::module_& module);

}  // namespace saccade::python
