#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/rigid3.h"

namespace saccade::config {

// What the reference calls the values of a T: "number", "list of 3 numbers"; "map" where T has a
// from_node() of its own. The argument names the type alone.
template <class T>
[[nodiscard]] std::string type_name(const T*);
template <class T>
[[nodiscard]] std::string type_name(const std::optional<T>*);
template <class T>
[[nodiscard]] std::string type_name(const std::vector<T>*);
template <class T>
[[nodiscard]] std::string type_name(const std::map<std::string, T>*);
template <class T, std::size_t N>
[[nodiscard]] std::string type_name(const std::array<T, N>*);
template <class T, int N>
[[nodiscard]] std::string type_name(const Eigen::Matrix<T, N, 1>*);

/// "numbers" of "number".
[[nodiscard]] inline std::string plural(const std::string& type) {
  if (type.starts_with("list of ")) return "lists of " + type.substr(8);
  if (type.starts_with("whole number")) return "whole numbers" + type.substr(12);
  return type + "s";
}

template <class T>
std::string type_name(const T*) {
  if constexpr (std::same_as<T, bool>) return "true or false";
  if constexpr (std::same_as<T, std::uint64_t>) return "whole number from 0";
  if constexpr (std::is_integral_v<T>) return "whole number";
  if constexpr (std::is_floating_point_v<T>) return "number";
  if constexpr (std::same_as<T, std::string>) return "text";
  if constexpr (std::same_as<T, std::filesystem::path>) return "path";
  if constexpr (std::same_as<T, Rigid3>) return "4 rows of 4 numbers";
  return "map";
}

template <class T>
std::string type_name(const std::optional<T>*) {
  return type_name(static_cast<const T*>(nullptr)) + " or ~";
}

template <class T>
std::string type_name(const std::vector<T>*) {
  return "list of " + plural(type_name(static_cast<const T*>(nullptr)));
}

template <class T>
std::string type_name(const std::map<std::string, T>*) {
  return "map of " + plural(type_name(static_cast<const T*>(nullptr)));
}

template <class T, std::size_t N>
std::string type_name(const std::array<T, N>*) {
  return "list of " + std::to_string(N) + " " + plural(type_name(static_cast<const T*>(nullptr)));
}

template <class T, int N>
std::string type_name(const Eigen::Matrix<T, N, 1>*) {
  return "list of " + std::to_string(N) + " " + plural(type_name(static_cast<const T*>(nullptr)));
}

}  // namespace saccade::config
