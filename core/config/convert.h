#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config/node.h"

namespace saccade::config {

/// Strict conversions between nodes and values. from_node throws InputError at the node's location,
/// calling it `name`; numbers are finite and without rest ("1e6" is a whole number, "1.5" and "'3'"
/// are not). to_node writes what from_node reads back to the same value, doubles in their shortest
/// exact form.
void from_node(const Node& node, const std::string& name, bool& value);
void from_node(const Node& node, const std::string& name, int& value);
void from_node(const Node& node, const std::string& name, std::int64_t& value);
void from_node(const Node& node, const std::string& name, std::uint64_t& value);
void from_node(const Node& node, const std::string& name, float& value);
void from_node(const Node& node, const std::string& name, double& value);
void from_node(const Node& node, const std::string& name, std::string& value);
/// A relative path is taken relative to the file that states it.
void from_node(const Node& node, const std::string& name, std::filesystem::path& value);

[[nodiscard]] Node to_node(bool value);
[[nodiscard]] Node to_node(int value);
[[nodiscard]] Node to_node(std::int64_t value);
[[nodiscard]] Node to_node(std::uint64_t value);
[[nodiscard]] Node to_node(float value);
[[nodiscard]] Node to_node(double value);
[[nodiscard]] Node to_node(const std::string& value);
[[nodiscard]] Node to_node(const std::filesystem::path& value);  ///< made absolute

/// Whether plain text is a finite number, and which.
[[nodiscard]] std::optional<double> number_of(const Node& node);

/// The items of a list node; throws when it is no list.
[[nodiscard]] const std::vector<Node>& items_of(const Node& node, const std::string& name);
/// The same, exactly `count` of them.
[[nodiscard]] const std::vector<Node>& items_of(const Node& node, const std::string& name,
                                                std::size_t count);
/// The entries of a map node; throws when it is no map.
[[nodiscard]] const std::vector<Entry>& entries_of(const Node& node, const std::string& name);
[[nodiscard]] std::string item_name(const std::string& name, std::size_t index);

template <class T>
void from_node(const Node& node, const std::string& name, std::optional<T>& value);
template <class T>
void from_node(const Node& node, const std::string& name, std::vector<T>& value);
template <class T>
void from_node(const Node& node, const std::string& name, std::map<std::string, T>& value);
template <class T, std::size_t N>
void from_node(const Node& node, const std::string& name, std::array<T, N>& value);
template <class T, int N>
void from_node(const Node& node, const std::string& name, Eigen::Matrix<T, N, 1>& value);
template <class T>
[[nodiscard]] Node to_node(const std::optional<T>& value);
template <class T>
[[nodiscard]] Node to_node(const std::vector<T>& value);
template <class T>
[[nodiscard]] Node to_node(const std::map<std::string, T>& value);
template <class T, std::size_t N>
[[nodiscard]] Node to_node(const std::array<T, N>& value);
template <class T, int N>
[[nodiscard]] Node to_node(const Eigen::Matrix<T, N, 1>& value);

namespace detail {

template <class Range>
Node list_node(const Range& values) {
  Node node = Node::list();
  for (const auto& value : values) node.items.push_back(to_node(value));
  return node;
}

}  // namespace detail

template <class T>
void from_node(const Node& node, const std::string& name, std::optional<T>& value) {
  value.reset();
  if (node.kind != Node::Kind::kNull) from_node(node, name, value.emplace());
}

template <class T>
void from_node(const Node& node, const std::string& name, std::vector<T>& value) {
  const std::vector<Node>& items = items_of(node, name);
  value.clear();
  for (std::size_t i = 0; i < items.size(); ++i) {
    T item{};
    from_node(items[i], item_name(name, i), item);
    value.push_back(std::move(item));
  }
}

template <class T>
void from_node(const Node& node, const std::string& name, std::map<std::string, T>& value) {
  value.clear();
  for (const Entry& entry : entries_of(node, name))
    from_node(entry.value, name + "." + entry.key, value[entry.key]);
}

template <class T, std::size_t N>
void from_node(const Node& node, const std::string& name, std::array<T, N>& value) {
  const std::vector<Node>& items = items_of(node, name, N);
  for (std::size_t i = 0; i < N; ++i) from_node(items[i], item_name(name, i), value[i]);
}

template <class T, int N>
void from_node(const Node& node, const std::string& name, Eigen::Matrix<T, N, 1>& value) {
  static_assert(N > 0, "only vectors of fixed length");
  const std::vector<Node>& items = items_of(node, name, static_cast<std::size_t>(N));
  for (int i = 0; i < N; ++i)
    from_node(items[static_cast<std::size_t>(i)], item_name(name, static_cast<std::size_t>(i)),
              value[i]);
}

template <class T>
Node to_node(const std::optional<T>& value) {
  return value ? to_node(*value) : Node{};
}

template <class T>
Node to_node(const std::vector<T>& value) {
  return detail::list_node(value);
}

template <class T>
Node to_node(const std::map<std::string, T>& value) {
  Node node = Node::map();
  for (const auto& [key, item] : value) node.entries.push_back({key, {}, to_node(item), {}});
  return node;
}

template <class T, std::size_t N>
Node to_node(const std::array<T, N>& value) {
  return detail::list_node(value);
}

template <class T, int N>
Node to_node(const Eigen::Matrix<T, N, 1>& value) {
  return detail::list_node(value);
}

}  // namespace saccade::config
