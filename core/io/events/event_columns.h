#pragma once

#include <cstdint>
#include <vector>

namespace saccade {

/// Consecutive events of an HDF5 file as it stores them.
struct EventColumns {
  std::vector<std::uint16_t> x, y;
  std::vector<std::int16_t> p;  ///< 1 ON, 0 or -1 OFF
  std::vector<std::int64_t> t;  ///< in units of the file, from its offset

  void resize(std::size_t count) {
    x.resize(count);
    y.resize(count);
    p.resize(count);
    t.resize(count);
  }
};

}  // namespace saccade
