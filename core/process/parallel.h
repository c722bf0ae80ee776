#pragma once

#include <cstddef>
#include <functional>

namespace saccade {

/// Threads that parallel_for and the libraries below (TBB, OpenCV) may use from now on; 0 means one
/// per core, which is also the state at the start. Not while parallel work is running.
void set_thread_count(int count);
[[nodiscard]] int thread_count();

/// Calls body(begin, end) for disjoint ranges that cover [0, count), at most `grain` long each, on
/// up to thread_count() threads. The ranges are i * grain .. (i + 1) * grain whatever the number of
/// threads, so a result that depends on its range alone is deterministic. An exception of a body is
/// rethrown.
void parallel_for_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(i) for every i in [0, count), in any order, on up to thread_count() threads.
template <class Body>
void parallel_for(std::size_t count, const Body& body, std::size_t grain = 1) {
  parallel_for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

}  // namespace saccade
