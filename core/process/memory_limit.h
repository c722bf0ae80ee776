#pragma once

#include <cstdint>
#include <string>

namespace saccade {

/// The most memory that this process can have: what the machine has, or less where the control group (containers, jobs of
/// a cluster) or the limit of its address space (ulimit -v) says so [bytes].
[[nodiscard]] std::uint64_t memory_limit_bytes();

/// InputError at `location` where `bytes` are more than that: "WHAT takes about 94 GB of memory, of which there are 25:
/// CURE". To be called before the memory is taken.
void check_memory(double bytes, const std::string& location, const std::string& what,
                  const std::string& cure);

}  // namespace saccade
