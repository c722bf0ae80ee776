#pragma once

#include <cstddef>
#include <string>

namespace saccade {

/// Seeds of a view by the gate that dropped them, to tell why a view stays empty.
struct GateCounts {
  std::size_t still = 0;      ///< moved too little across their edge
  std::size_t weak = 0;       ///< too few votes, or more at another depth of the same pixel
  std::size_t scattered = 0;  ///< their events lie on no straight line within the range of depths
  std::size_t uncertain = 0;  ///< their depth's sigma is too large
  std::size_t alone = 0;      ///< their neighbours do not agree with them

  GateCounts& operator+=(const GateCounts& other);
};

/// The gate that dropped most: "most of 512 candidates moved too little across their edge (480)".
[[nodiscard]] std::string main_gate(const GateCounts& dropped);

}  // namespace saccade
