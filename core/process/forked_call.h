#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace saccade {

/// What a call in a process of its own may take.
struct ForkLimits {
  double cpu_s = 120;
  double wall_s = 600;
  /// Beside what this process has taken already. Without effect under AddressSanitizer and
  /// ThreadSanitizer, which reserve more than any limit.
  std::uint64_t memory_mb = 8192;
};

/// How it ended: with the bytes that it returned, or with a problem in words ("crashed
/// (Segmentation fault)", "took more than 120 s", or what its exception says).
struct ForkedResult {
  std::string bytes;
  std::string problem;  ///< "" when it ended well
  bool died = false;    ///< it had no chance to say what was wrong
};

/// A copy of this process that answers calls one after the other, for code that may crash, hang or
/// take all memory. What it changes is lost but for the bytes that it returns, and stays with it
/// from one call to the next; what it prints is dropped. A copy that died is replaced at the next
/// call by one of this process as it then is. Each thread may have its own.
class ForkedWorker {
 public:
  /// `work`: from a request to its answer. It must not wait for other threads: the copy has none of
  /// them. The limits hold for each call. The copy lives no longer than the thread that makes it.
  /// Throws InputError when the system gives no process.
  using Work = std::function<std::string(const std::string&)>;
  explicit ForkedWorker(Work work, const ForkLimits& limits = {});
  ~ForkedWorker();
  ForkedWorker(const ForkedWorker&) = delete;
  ForkedWorker& operator=(const ForkedWorker&) = delete;

  [[nodiscard]] ForkedResult call(const std::string& request);
  /// From any thread: the call in progress, and all that follow, end with a problem.
  void stop();

 private:
  class Child;
  Work work_;
  ForkLimits limits_;
  std::mutex mutex_;  ///< of what follows
  std::shared_ptr<Child> child_;
  bool is_stopped_ = false;
};

/// One call in a copy of this process as it is now.
[[nodiscard]] ForkedResult call_in_child(const std::function<std::string()>& work,
                                         const ForkLimits& limits = {});

}  // namespace saccade
