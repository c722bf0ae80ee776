#include "python/binding/interruption.h"

#include "core/process/progress_observer.h"

namespace saccade::python {
namespace {

constexpr std::chrono::milliseconds kInterval{50};

/// Other threads of the same work, which have none, leave Python to the one that was called.
thread_local ObservedWork* current_work = nullptr;

void raise_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace

ObservedWork::ObservedWork(py::object progress)
    : progress_(std::move(progress)),
      outer_(std::exchange(current_work, this)),
      next_(std::chrono::steady_clock::now() + kInterval) {}

ObservedWork::~ObservedWork() { current_work = outer_; }

void ObservedWork::step(const ProgressState& state) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + kInterval;
  const py::gil_scoped_acquire lock;
  raise_signals();
  if (!progress_.is_none()) progress_(state.label, state.done, state.total);
}

void observe_progress() {
  set_progress_observer([](const ProgressState& state) {
    if (current_work != nullptr) current_work->step(state);
  });
}

void check_signals() {
  const py::gil_scoped_acquire lock;
  raise_signals();
}

}  // namespace saccade::python
