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
  std::size_t foreign = 0;    ///< their events are those of other edges
  std::size_t hidden = 0;     ///< seen at other times than the view's, or outside of it
  std::size_t jittered = 0;   ///< the noise of the poses makes their depth too uncertain

  GateCounts& operator+=(const GateCounts& other);
};

/// The gate that dropped most: "480 of 512 candidates are seen by too few events".
[[nodiscard]] std::string main_gate(const GateCounts& dropped);

}  // namespace saccade
