#pragma once

#include <functional>
#include <string>

#include "core/config/document.h"
#include "core/config/fields.h"
#include "core/config/yaml_emit.h"

namespace saccade::config {

/// Runs a description in the modes of Fields; use the functions below.
class Session {
 public:
  static void read(const Document& document, const std::function<void(Fields&)>& describe_root);
  [[nodiscard]] static Node write(const std::function<void(Fields&)>& describe_root);
  static void check(const std::function<void(Fields&)>& describe_root);
};

/// Reads a whole document into a struct with a describe(Fields&, T&); `options` holds the defaults.
/// Throws InputError with its place for unknown keys (with the nearest valid one), wrong types,
/// values out of range and missing required keys. Conditions between keys belong into describe()
/// (Fields::expect); no other check is called.
template <class T>
[[nodiscard]] T read(const Document& document, T options = {}) {
  Session::read(document, [&](Fields& fields) { describe(fields, options); });
  return options;
}

/// The resolved whole as YAML, which read() turns into the same struct again: doubles exact, paths
/// absolute.
template <class T>
[[nodiscard]] std::string print(T options) {
  return to_yaml(Session::write([&](Fields& fields) { describe(fields, options); }));
}

/// print() with help and range of every key as a comment behind it.
template <class T>
[[nodiscard]] std::string print_documented(T options) {
  return to_yaml(Session::write([&](Fields& fields) { describe(fields, options); }), true);
}

/// Checks options that code has set against the ranges of their describe(). Throws InputError whose
/// place is the key.
template <class T>
void check(T options) {
  Session::check([&](Fields& fields) { describe(fields, options); });
}

}  // namespace saccade::config
