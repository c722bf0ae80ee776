#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <utility>

#include "core/process/progress.h"

namespace saccade::python {

namespace py = pybind11;

/// While it lives, progress of the library's work in this thread reaches Python: a signal that came
/// (Ctrl-C) raises its exception, which ends the work, and `progress(label, done, total)` is called,
/// unless it is None. Both at most every 50 ms.
class ObservedWork {
 public:
  explicit ObservedWork(py::object progress);
  ~ObservedWork();
  ObservedWork(const ObservedWork&) = delete;
  ObservedWork& operator=(const ObservedWork&) = delete;

  /// A step of the work; without the interpreter's lock.
  void step(const ProgressState& state);

 private:
  py::object progress_;
  ObservedWork* outer_;
  std::chrono::steady_clock::time_point next_;
};

/// Makes all progress known to the ObservedWork of its thread; once, at import.
void observe_progress();

/// Raises the exception of a signal that came; without the interpreter's lock.
void check_signals();

/// work() without the interpreter's lock, observed.
template <class Work>
auto without_lock(py::object progress, const Work& work) {
  const ObservedWork observed(std::move(progress));
  const py::gil_scoped_release release;
  return work();
}

}  // namespace saccade::python
