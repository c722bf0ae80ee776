#pragma once

#include <cstdint>
#include <string>

#include "core/config/node.h"

namespace saccade {

/// Overrides `key.path: value` where a value, or any part of it, may be a distribution. Each
/// dataset gets its own sample:
///   {uniform: [low, high]}          low <= x < high
///   {log_uniform: [low, high]}      ln x is uniform; 0 < low
///   {integer: [low, high]}          whole numbers, both ends included
///   {normal: [mean, sigma]}         or [mean, sigma, low, high]: truncated by rejection
///   {choose: [value, ...]}          one of them, equally likely; they may hold distributions
///   {repeat: {count: n, item: value}}   a list of n values, each sampled by itself; n may be a
///                                   distribution
///   {same_as: key.path}             the sample of another key
struct SampledParameters {
  config::Node keys = config::Node::map();
};

// In the namespace of the type, where the templates of Fields find them. InputError at the node's
// place for a distribution that cannot be sampled.
void from_node(const config::Node& node, const std::string& name, SampledParameters& parameters);
[[nodiscard]] config::Node to_node(const SampledParameters& parameters);

/// Samples all distributions for the dataset number `index`. A sample depends on the seed, the
/// index and the path of its key alone, not on other keys or on the number of datasets. Numbers
/// have six significant digits.
[[nodiscard]] config::Node sample_values(const SampledParameters& parameters, std::uint64_t seed,
                                         std::uint64_t index);

/// A whole number below `bound` >= 1, uniform and by the same rule, for what is not a key of a
/// configuration.
[[nodiscard]] std::uint64_t sample_below(std::uint64_t bound, const std::string& path,
                                         std::uint64_t seed, std::uint64_t index);

}  // namespace saccade
