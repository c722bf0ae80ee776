#pragma once

namespace saccade::testing {

constexpr double kLogEps = 1e-3;  ///< eps of L = ln(eps + I)

}  // namespace saccade::testing
