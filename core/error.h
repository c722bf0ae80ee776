#pragma once

#include <stdexcept>
#include <string>

namespace saccade {

/// Bad input from outside: a file, a configuration, an option or a dataset. `location` says where
/// ("config.yaml:12", "events.h5:/events/t[17]", "--threads"), `problem` what is wrong and what
/// would be right. Thrown anywhere, caught once, in apps/, where it becomes exit code 2.
class InputError : public std::runtime_error {
 public:
  InputError(std::string location, const std::string& problem)
      : std::runtime_error(location.empty() ? problem : location + ": " + problem),
        location_(std::move(location)) {}

  [[nodiscard]] const std::string& location() const { return location_; }

 private:
  std::string location_;
};

}  // namespace saccade
