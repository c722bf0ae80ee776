#include "apps/pose_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace saccade {

Rigid3 parse_pose(const std::string& text, const std::string& option) {
  static constexpr const char* kNames[] = {"x", "y", "z", "qx", "qy", "qz", "qw"};
  std::vector<double> values;
  std::size_t at = 0;
  const auto fail = [&](const std::string& problem) {
    throw InputError(option, fmt::format("{} in \"{}\"; a pose is \"x y z qx qy qz qw\", 2 m along "
                                         "the world's z for instance \"0 0 2 0 0 0 1\"",
                                         problem, text));
  };
  constexpr const char* kSpace = " \t,";
  while ((at = text.find_first_not_of(kSpace, at)) != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(kSpace, at), text.size());
    const std::string word = text.substr(at, end - at);
    double value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || rest != word.data() + word.size() || !std::isfinite(value))
      fail(fmt::format("character {}{}: '{}' is no number", at + 1,
                       values.size() < 7 ? fmt::format(" ({})", kNames[values.size()]) : "", word));
    values.push_back(value);
    at = end;
  }
  if (values.size() != 7)
    fail(fmt::format("{} number{} instead of 7", values.size(), values.size() == 1 ? "" : "s"));
  const Eigen::Quaterniond q(values[6], values[3], values[4], values[5]);
  if (!(std::abs(q.norm() - 1) <= 1e-3))
    fail(q.norm() > 0
             ? fmt::format("qx qy qz qw has length {:.4g} instead of 1 (did you mean {:.6g} {:.6g} "
                           "{:.6g} {:.6g}?)",
                           q.norm(), q.x() / q.norm(), q.y() / q.norm(), q.z() / q.norm(),
                           q.w() / q.norm())
             : "qx qy qz qw is zero, which is no rotation");
  return {q, {values[0], values[1], values[2]}};
}

}  // namespace saccade
