#include "core/process/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <utility>

#include "core/check.h"
#include "core/process/thread_pool.h"
#include "core/process/work_handover.h"

namespace saccade {
namespace {

/// The pool, and what guards its being replaced. It is never destroyed: work in the background may
/// outlive the end of main().
struct CurrentPool {
  std::mutex mutex;
  std::shared_ptr<ThreadPool> pool = std::make_shared<ThreadPool>(tbb::info::default_concurrency());
};

CurrentPool& current() {
  static auto* const instance = new CurrentPool;
  return *instance;
}

thread_local const ThreadPool* inside = nullptr;

}  // namespace

void set_thread_count(int count) {
  SACCADE_CHECK(count >= 0);
  const int threads = count > 0 ? count : tbb::info::default_concurrency();
  {
    const std::lock_guard lock(current().mutex);
    current().pool.reset();
    current().pool = std::make_shared<ThreadPool>(threads);
  }
  cv::setNumThreads(threads);
}

std::shared_ptr<ThreadPool> current_thread_pool() {
  const std::lock_guard lock(current().mutex);
  return current().pool;
}

bool is_inside(const ThreadPool& pool) { return inside == &pool; }

InThreadPool::InThreadPool(const ThreadPool& pool) : before_(std::exchange(inside, &pool)) {}
InThreadPool::~InThreadPool() { inside = before_; }

int thread_count() { return current_thread_pool()->arena.max_concurrency(); }

void parallel_for_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body) {
  SACCADE_CHECK(grain > 0);
  const std::size_t ranges = (count + grain - 1) / grain;
  const auto run = [&](std::size_t i) { body(i * grain, std::min((i + 1) * grain, count)); };
  const std::shared_ptr<ThreadPool> pool = current_thread_pool();
  if (ranges <= 1 || pool->arena.max_concurrency() == 1) {
    for (std::size_t i = 0; i < ranges; ++i) run(i);
    return;
  }
  WorkHandover handover;
  const auto run_in_pool = [&](std::size_t i) {
    WorkHandover::receive();
    const WorkHandover::Part part(handover);
    const InThreadPool mark(*pool);
    run(i);
  };
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, ranges, run_in_pool); };
  WorkHandover::send();
  // Entering the arena anew would let the thread take what another thread has handed over to it, such
  // as the wait for the very work that this is a part of.
  if (is_inside(*pool))
    all();
  else
    pool->arena.execute(all);
}

}  // namespace saccade
