#pragma once

#include <optional>
#include <string_view>

namespace saccade {

/// The tables of the thesis (Horstschaefer, University of Zurich, 2016) that a report compares
/// with.
namespace thesis {

/// Table 8.1.
struct Sequence {
  std::string_view name;
  double events_millions;
  double duration_s;
  double mean_depth_m;
  double path_m;
};

struct Errors {
  double mean, sigma, max, rmse;
};

/// Tables 8.2 and 8.3.
struct Tracking {
  std::string_view sequence;
  bool fast;  ///< the fast setting: 50 samples, 5 iterations
  Errors dt_rel_percent;
  Errors dtheta_deg;
  double time_ms;
  double events_per_s_millions;  ///< as it follows from time and events, see kSpeedErratum
  double poses_per_s;
};

/// Case of letters does not matter. nullptr where the thesis has no such sequence or setting.
[[nodiscard]] const Sequence* find_sequence(std::string_view name);
[[nodiscard]] const Tracking* find_tracking(std::string_view sequence, bool fast);

/// What table 8.3 prints for the fast setting, and why it cannot be.
constexpr std::string_view kSpeedErratum =
    "Table 8.3 prints 204 M events/s for Walls (fast). 1.8 M events in its 90 ms are 20 M "
    "events/s; "
    "that is what is compared with here. Its machine was a desktop computer of 2016, one thread.";

}  // namespace thesis
}  // namespace saccade
