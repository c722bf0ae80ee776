#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/config/document.h"
#include "core/config/fields.h"
#include "core/config/former_keys.h"
#include "core/config/reference.h"
#include "core/config/yaml_emit.h"

namespace saccade::config {

/// Runs a description in the modes of Fields; use the functions below.
class Session {
 public:
  static void read(const Document& document, const std::function<void(Fields&)>& describe_root,
                   std::span<const FormerKey> former);
  [[nodiscard]] static Node write(const std::function<void(Fields&)>& describe_root);
  static void check(const std::function<void(Fields&)>& describe_root);
  [[nodiscard]] static std::vector<ReferenceKey> reference(
      const std::function<void(Fields&)>& describe_root);
};

/// Reads a whole document into a struct with a describe(Fields&, T&); `options` holds the defaults.
/// Throws InputError with its location for unknown keys (with what a former key of the table
/// `former` is called now, or else the nearest valid key), wrong types, values out of range and
/// missing required keys. Conditions between keys belong into describe() (Fields::expect); no other
/// check is called.
template <class T>
[[nodiscard]] T read(const Document& document, T options = {},
                     std::span<const FormerKey> former = former_keys()) {
  Session::read(
      document, [&](Fields& fields) { describe(fields, options); }, former);
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

/// All keys of a T with their defaults, rules and help, those of choices that are not taken by
/// default included.
template <class T>
[[nodiscard]] std::vector<ReferenceKey> reference() {
  return Session::reference([](Fields& fields) {
    T options;
    describe(fields, options);
  });
}

/// Checks options that code has set against the ranges of their describe(). Throws InputError whose
/// location is the key.
template <class T>
void check(T options) {
  Session::check([&](Fields& fields) { describe(fields, options); });
}

}  // namespace saccade::config
