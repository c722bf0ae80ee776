#pragma once

#include <cstdint>
#include <string>

#include "core/config/node.h"

namespace saccade {

/// `key.path: value` where a value, or any part of it, may be a distribution, drawn anew for each
/// dataset:
///   {uniform: [low, high]}          low <= x < high
///   {log_uniform: [low, high]}      ln x is uniform; 0 < low
///   {integer: [low, high]}          whole, both ends included
///   {normal: [mean, sigma]}         or [mean, sigma, low, high], drawn again until it lies within
///   {choose: [value, ...]}          one of them, all as likely; they may hold distributions
///   {same_as: key.path}             the draw of another key
struct SampledParameters {
  config::Node keys = config::Node::map();
};

// In the namespace of the type, where the templates of Fields find them. InputError at the node's
// place for a distribution that cannot be drawn from.
void from_node(const config::Node& node, const std::string& name, SampledParameters& draws);
[[nodiscard]] config::Node to_node(const SampledParameters& draws);

/// One dataset of the many.
struct DrawIdentity {
  std::uint64_t seed = 0;
  std::uint64_t index = 0;  ///< of the dataset
};

/// The values without distributions. A draw depends on the seed, the index and the path of its key
/// alone: never on other keys, or on how many datasets there are. Numbers have six significant
/// digits.
[[nodiscard]] config::Node sample_values(const SampledParameters& draws, const DrawIdentity& identity);

/// A whole number below `bound` >= 1 by the same rule, for what is no key of a configuration.
[[nodiscard]] std::uint64_t sample_below(std::uint64_t bound, const std::string& path,
                                       const DrawIdentity& identity);

}  // namespace saccade
