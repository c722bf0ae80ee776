#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/rigid3.h"

namespace saccade::config {

/// What the reference calls the values of a T: "number", "list of 3 numbers". A type with a
/// from_node() of its own is a "map" unless it specialises this.
template <class T>
struct TypeName {
  static std::string text() {
    if constexpr (std::same_as<T, bool>) return "true or false";
    if constexpr (std::same_as<T, std::uint64_t>) return "whole number from 0";
    if constexpr (std::is_integral_v<T>) return "whole number";
    if constexpr (std::is_floating_point_v<T>) return "number";
    if constexpr (std::same_as<T, std::string>) return "text";
    if constexpr (std::same_as<T, std::filesystem::path>) return "path";
    if constexpr (std::same_as<T, Rigid3>) return "4 rows of 4 numbers";
    return "map";
  }
};

/// What the values of a T are called: "numbers".
inline std::string plural(const std::string& type) {
  if (type.starts_with("list of ")) return "lists of " + type.substr(8);
  if (type.starts_with("whole number")) return "whole numbers" + type.substr(12);
  return type == "text" ? "texts" : type + "s";
}

template <class T>
struct TypeName<std::optional<T>> {
  static std::string text() { return TypeName<T>::text() + " or ~"; }
};
template <class T>
struct TypeName<std::vector<T>> {
  static std::string text() { return "list of " + plural(TypeName<T>::text()); }
};
template <class T>
struct TypeName<std::map<std::string, T>> {
  static std::string text() { return "map of " + plural(TypeName<T>::text()); }
};
template <class T, std::size_t N>
struct TypeName<std::array<T, N>> {
  static std::string text() {
    return "list of " + std::to_string(N) + " " + plural(TypeName<T>::text());
  }
};
template <class T, int N>
struct TypeName<Eigen::Matrix<T, N, 1>> {
  static std::string text() {
    return "list of " + std::to_string(N) + " " + plural(TypeName<T>::text());
  }
};

}  // namespace saccade::config
