#pragma once

#include <cstdint>
#include <functional>
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

/// Calls `work` in a copy of this process, for code that may crash, hang or take all memory. What it
/// changes is lost but for the bytes that it returns, and what it prints is dropped. `work` must not
/// wait for other threads: the copy has none of them. Throws InputError when the system gives no
/// process.
[[nodiscard]] ForkedResult call_in_child(const std::function<std::string()>& work,
                                         const ForkLimits& limits = {});

}  // namespace saccade
