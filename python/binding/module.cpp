#include <pybind11/pybind11.h>

#include "core/process/parallel.h"
#include "core/process/progress.h"
#include "core/version.h"
#include "python/binding/bindings.h"
#include "python/binding/interruption.h"

PYBIND11_MODULE(_native, module) {
  using namespace saccade;
  module.doc() = "The compiled part of the package saccade.";
  module.attr("version") = version();
  module.attr("commit") = git_commit();
  module.def("set_threads", &set_thread_count);
  module.def("threads", &thread_count);
  module.def("set_quiet", &set_progress_quiet);
  python::observe_progress();
  python::bind_errors(module);
  python::bind_config(module);
  python::bind_events(module);
  python::bind_dataset(module);
  python::bind_simulation(module);
  python::bind_tracking(module);
  python::bind_runs(module);
  python::bind_scores(module);
}
