#include <pybind11/pybind11.h>

#include <exception>
#include <filesystem>

#include "core/error.h"
#include "core/refused_path.h"
#include "python/binding/bindings.h"

namespace saccade::python {
namespace {

namespace py = pybind11;

PyObject* input_error_type = nullptr;  ///< lives as long as the interpreter

void raise(const InputError& error) {
  const auto type = py::reinterpret_borrow<py::object>(input_error_type);
  py::object instance = type(error.what());
  instance.attr("location") = error.location();
  PyErr_SetObject(input_error_type, instance.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const InputError& error) {
    raise(error);
  } catch (const std::filesystem::filesystem_error& error) {
    const auto refusal = refused_path(error);
    if (!refusal) throw;
    raise(*refusal);
  }
}

}  // namespace

void bind_errors(py::module_& module) {
  input_error_type = PyErr_NewExceptionWithDoc(
      "saccade.InputError",
      "Bad input: a file, a configuration, an argument or a dataset.\n\n"
      "The text is that of the command: where, what is wrong, what would be right.\n\n"
      "Attributes\n----------\nlocation : str\n    File and line, key, argument or index.\n",
      PyExc_ValueError, nullptr);
  module.attr("InputError") = py::reinterpret_borrow<py::object>(input_error_type);
  py::register_exception_translator(translate);
}

}  // namespace saccade::python
