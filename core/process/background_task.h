#pragma once

#include <functional>
#include <memory>

namespace saccade {

/// One piece of work at a time that goes on beside the caller's, on the threads of parallel_for(), which
/// it may use itself. With a single thread it is done when it is waited for, so that a program never
/// uses more threads than it was told to. Who waits does other work of parallel_for() meanwhile: hold
/// no lock then that such work may take.
class BackgroundTask {
 public:
  BackgroundTask();
  /// Waits for what has begun; an error that nobody asked for is lost.
  ~BackgroundTask();
  BackgroundTask(const BackgroundTask&) = delete;
  BackgroundTask& operator=(const BackgroundTask&) = delete;

  /// Begins; what was begun before must have been waited for (contract).
  void start(std::function<void()> work);
  /// Waits until the work is done, and rethrows its error; nothing where there is no work.
  void wait();
  /// Waits likewise, but keeps the error for wait().
  void settle();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
