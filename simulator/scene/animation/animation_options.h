#pragma once

#include <string>

namespace saccade {

namespace config {
class Fields;
}

/// How a mesh plays an animation of its file (section `animation` of a mesh).
struct AnimationOptions {
  std::string name;    ///< or the index as a number; empty: the first of the file
  double start_s = 0;  ///< time of the recording at which it starts
  double speed = 1;
  bool loop = false;  ///< else the last pose stays
};

void describe(config::Fields& fields, AnimationOptions& options);

}  // namespace saccade
