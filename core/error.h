#pragma once

#include <stdexcept>
#include <string>

namespace saccade {

/// Bad input from outside: a file, a configuration, an option or a dataset. `place` says where
/// ("config.yaml:12", "events.h5:/events/t[17]", "--threads"), `problem` what is wrong and what
/// would be right. Thrown anywhere, caught once, in apps/, where it becomes exit code 2.
class InputError : public std::runtime_error {
 public:
  InputError(std::string place, const std::string& problem)
      : std::runtime_error(place.empty() ? problem : place + ": " + problem),
        place_(std::move(place)) {}

  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  std::string place_;
};

}  // namespace saccade
