#include "core/process/background_task.h"

#include <tbb/task_group.h>

#include <exception>
#include <optional>
#include <utility>

#include "core/check.h"
#include "core/process/thread_pool.h"
#include "core/process/work_handover.h"

namespace saccade {

struct BackgroundTask::State {
  void run() {
    try {
      work();
    } catch (...) {
      error = std::current_exception();
    }
  }

  std::function<void()> work;            ///< empty: none that is not waited for
  std::shared_ptr<ThreadPool> pool;      ///< where it runs; null: it has not begun
  std::optional<WorkHandover> handover;  ///< of what runs in the pool
  tbb::task_group group;
  std::exception_ptr error;
};

BackgroundTask::BackgroundTask() : state_(std::make_unique<State>()) {}

BackgroundTask::~BackgroundTask() {
  // What has not begun is wanted by nobody.
  if (!state_->pool) state_->work = nullptr;
  settle();
}

void BackgroundTask::start(std::function<void()> work) {
  SACCADE_CHECK(!state_->work && !state_->error);
  state_->work = std::move(work);
  const std::shared_ptr<ThreadPool> pool = current_thread_pool();
  if (pool->arena.max_concurrency() == 1) return;
  state_->pool = pool;
  state_->handover.emplace();
  WorkHandover::send();
  pool->arena.execute([state = state_.get()] {
    state->group.run([state] {
      WorkHandover::receive();
      const WorkHandover::Part part(*state->handover);
      const InThreadPool mark(*state->pool);
      state->run();
    });
  });
}

void BackgroundTask::settle() {
  if (!state_->work) return;
  if (!state_->pool)
    state_->run();
  else if (is_inside(*state_->pool))
    state_->group.wait();
  else
    state_->pool->arena.execute([this] { state_->group.wait(); });
  state_->handover.reset();
  state_->pool.reset();
  state_->work = nullptr;
}

void BackgroundTask::wait() {
  settle();
  if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
}

}  // namespace saccade
