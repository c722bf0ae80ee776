#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "estimator/registry.h"
#include "python/binding/bindings.h"
#include "simulator/simulation_config.h"

namespace saccade::python {
namespace {

namespace py = pybind11;

/// A file, a text, or neither, with overrides "key.path=value". Paths in a text and in overrides are
/// relative to the working folder.
config::Document make_document(const std::optional<std::string>& file,
                               const std::optional<std::string>& text,
                               const std::vector<std::string>& overrides) {
  if (file) return config::load(*file, overrides);
  if (text) return config::parse(*text, "config", std::filesystem::current_path(), overrides);
  return config::Document::empty(overrides);
}

}  // namespace

void bind_config(py::module_& module) {
  py::class_<config::Document>(module, "Document")
      .def(py::init(&make_document), py::arg("file"), py::arg("text"), py::arg("overrides"));
  module.def("print_simulation_config", [](const config::Document& document) {
    return config::print_documented(config::read<SimulationConfig>(document));
  });
  module.def("print_run_config", [](const std::string& name, const config::Document& document) {
    return find_module(name).print_config(document);
  });
  module.def("module_names", [] {
    std::vector<std::string> names;
    for (const Module& one : modules()) names.emplace_back(one.name);
    return names;
  });
}

}  // namespace saccade::python
