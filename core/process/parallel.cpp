#include "core/process/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "core/check.h"
#include "core/process/thread_pool.h"

namespace saccade {
namespace {

std::shared_ptr<ThreadPool>& pool() {
  static std::shared_ptr<ThreadPool> instance =
      std::make_shared<ThreadPool>(tbb::info::default_concurrency());
  return instance;
}

}  // namespace

void set_thread_count(int count) {
  SACCADE_CHECK(count >= 0);
  const int threads = count > 0 ? count : tbb::info::default_concurrency();
  std::shared_ptr<ThreadPool>& current = pool();
  current.reset();
  current = std::make_shared<ThreadPool>(threads);
  cv::setNumThreads(threads);
}

std::shared_ptr<ThreadPool> current_thread_pool() { return pool(); }

int thread_count() { return pool()->arena.max_concurrency(); }

void parallel_for_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body) {
  SACCADE_CHECK(grain > 0);
  const std::size_t ranges = (count + grain - 1) / grain;
  const auto run = [&](std::size_t i) { body(i * grain, std::min((i + 1) * grain, count)); };
  if (ranges <= 1 || thread_count() == 1) {
    for (std::size_t i = 0; i < ranges; ++i) run(i);
    return;
  }
  pool()->arena.execute([&] { tbb::parallel_for(std::size_t{0}, ranges, run); });
}

}  // namespace saccade
