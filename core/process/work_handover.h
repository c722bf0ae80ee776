#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace saccade {

/// Tells ThreadSanitizer what TBB guarantees: work that is handed to another thread comes after all
/// that was done before it was made, and before what follows on waiting for it. TBB's library is
/// not built for ThreadSanitizer, which would take each such pair for a race. Does nothing in other
/// builds. Made by the thread that is about to hand work over, and destroyed by the one that has
/// waited for all of it. For core/process alone.
class WorkHandover {
 public:
  WorkHandover() = default;
  ~WorkHandover() { acquire(done_); }
  WorkHandover(const WorkHandover&) = delete;
  WorkHandover& operator=(const WorkHandover&) = delete;

  /// By the thread that hands the work over, when all that belongs to it has been made.
  static void send() { release(begun); }
  /// First of all by a thread that begins a part, before it reads anything that it was given: so
  /// this cannot be told for each handover alone.
  static void receive() { acquire(begun); }

  /// As long as a part of the work is done.
  class Part {
   public:
    explicit Part(WorkHandover& handover) : handover_(handover) {}
    ~Part() { release(handover_.done_); }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

   private:
    WorkHandover& handover_;
  };

 private:
#if defined(__SANITIZE_THREAD__)
  static void acquire(char& at) { __tsan_acquire(&at); }
  static void release(char& at) { __tsan_release(&at); }
#else
  static void acquire(char& /*at*/) {}
  static void release(char& /*at*/) {}
#endif

  inline static char begun = 0;  ///< these are addresses alone
  char done_ = 0;
};

}  // namespace saccade
