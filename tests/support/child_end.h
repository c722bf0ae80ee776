#pragma once

#include <gtest/gtest.h>
#include <poll.h>

#include <optional>

#include "core/process/child_process.h"

namespace saccade::testing {

/// Waits for a process, a minute at most; fails the running test when it has not ended then.
[[nodiscard]] inline ChildEnd end_of(ChildProcess& process) {
  constexpr int kMinute_ms = 60'000;
  pollfd ended{process.descriptor(), POLLIN, 0};
  ::poll(&ended, 1, kMinute_ms);
  const std::optional<ChildEnd> end = process.poll_end();
  EXPECT_TRUE(end);
  return end.value_or(ChildEnd{});
}

}  // namespace saccade::testing
