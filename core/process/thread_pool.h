#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <memory>

namespace saccade {

/// TBB's own default arena never has more threads than cores; this one has as many as asked for.
/// For core/process alone.
struct ThreadPool {
  explicit ThreadPool(int count)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)),
        arena(count) {}

  tbb::global_control limit;
  tbb::task_arena arena;
};

/// The one that parallel_for() uses from now on; work that is under way keeps that which it began on.
[[nodiscard]] std::shared_ptr<ThreadPool> current_thread_pool();

/// Whether this thread does work of the pool.
[[nodiscard]] bool is_inside(const ThreadPool& pool);

/// Marks this thread as one that does work of a pool, for as long as it lives: loops of that work then
/// stay within the pool.
class InThreadPool {
 public:
  explicit InThreadPool(const ThreadPool& pool);
  ~InThreadPool();
  InThreadPool(const InThreadPool&) = delete;
  InThreadPool& operator=(const InThreadPool&) = delete;

 private:
  const ThreadPool* before_;
};

}  // namespace saccade
