#include "eval/sweep/plan/sampled_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/config/convert.h"
#include "core/config/suggest.h"
#include "core/random.h"
#include "eval/sweep/plan/settings.h"

namespace saccade {
namespace {

using config::Node;

const std::vector<std::string> kDistributions{"uniform", "log_uniform", "integer", "normal",
                                              "choose",  "same_as",     "repeat"};
/// A normal distribution whose bounds lie far from its mean is taken for an error in the file.
constexpr std::uint64_t kNormalAttempts = 1000;
constexpr double kMaxBoundDistance = 3;  // [sigma]

[[noreturn]] void reject(const Node& node, const std::string& name, const std::string& problem) {
  throw config::error_at(node.location, name, " ", problem);
}

/// The distribution that a node states; nullptr for a value or a container of values.
const config::Entry* distribution_of(const Node& node) {
  if (node.kind != Node::Kind::kMap || node.entries.size() != 1) return nullptr;
  const config::Entry& only = node.entries.front();
  const bool known =
      std::find(kDistributions.begin(), kDistributions.end(), only.key) != kDistributions.end();
  return known ? &only : nullptr;
}

std::vector<double> numbers_of(const Node& node, const std::string& name) {
  std::vector<double> numbers;
  config::from_node(node, name, numbers);
  return numbers;
}

void check_range(const config::Entry& distribution, const std::string& name) {
  const Node& node = distribution.value;
  const std::vector<double> range = numbers_of(node, name);
  if (range.size() != 2) reject(node, name, "must be [low, high]");
  const bool whole = distribution.key == "integer";
  if (whole && (range[0] != std::floor(range[0]) || range[1] != std::floor(range[1])))
    reject(node, name, "must hold whole numbers");
  if (distribution.key == "log_uniform" && range[0] <= 0) reject(node, name, "must be above 0");
  if (whole ? range[1] < range[0] : range[1] <= range[0])
    reject(node, name, fmt::format("is empty: {} is not below {}", range[0], range[1]));
  constexpr double kLargest = 9007199254740992.0;  // 2^53
  if (whole && (std::abs(range[0]) > kLargest || std::abs(range[1]) > kLargest))
    reject(node, name, "must lie within +-2^53");
}

void check_normal(const Node& node, const std::string& name) {
  const std::vector<double> values = numbers_of(node, name);
  if (values.size() != 2 && values.size() != 4)
    reject(node, name, "must be [mean, sigma] or [mean, sigma, low, high]");
  if (values[1] < 0) reject(node, name, "must not have a sigma below 0");
  if (values.size() == 2) return;
  if (values[2] > values[3]) reject(node, name, "has its low bound above its high one");
  const double reach = kMaxBoundDistance * values[1];
  if (values[2] > values[0] + reach || values[3] < values[0] - reach)
    reject(node, name, "lies outside its bounds: they are more than 3 sigma from the mean");
}

void check_value(const Node& root, const Node& node, const std::string& name);

bool holds_same_as(const Node& node) {
  const auto in_entry = [](const config::Entry& entry) {
    return entry.key == "same_as" || holds_same_as(entry.value);
  };
  return std::any_of(node.items.begin(), node.items.end(), holds_same_as) ||
         std::any_of(node.entries.begin(), node.entries.end(), in_entry);
}

void check_same_as(const Node& root, const Node& node, const std::string& name) {
  const config::Entry* other = root.find(node.text);
  if (other == nullptr)
    reject(node, name, "names '" + node.text + "', which has no distribution here");
  if (holds_same_as(other->value))
    reject(node, name, "names '" + node.text + "', which is the same as another key itself");
}

/// `count` and `item`, and nothing else.
void check_repeat(const Node& root, const Node& node, const std::string& name) {
  const config::Entry* count = node.find("count");
  const config::Entry* item = node.find("item");
  if (count == nullptr || item == nullptr || node.entries.size() != 2)
    reject(node, name, "must be {count: n, item: value}");
  check_value(root, count->value, name + ".count");
  check_value(root, item->value, name + ".item");
}

void check_distribution(const Node& root, const config::Entry& distribution,
                        const std::string& name) {
  const Node& node = distribution.value;
  if (distribution.key == "choose") {
    if (config::items_of(node, name).empty()) reject(node, name, "holds nothing to choose from");
    for (std::size_t i = 0; i < node.items.size(); ++i)
      check_value(root, node.items[i], config::item_name(name, i));
  } else if (distribution.key == "repeat") {
    check_repeat(root, node, name);
  } else if (distribution.key == "same_as") {
    check_same_as(root, node, name);
  } else if (distribution.key == "normal") {
    check_normal(node, name);
  } else {
    check_range(distribution, name);
  }
}

void check_value(const Node& root, const Node& node, const std::string& name) {
  if (const config::Entry* distribution = distribution_of(node))
    return check_distribution(root, *distribution, name + "." + distribution->key);
  if (node.kind == Node::Kind::kMap && node.entries.size() == 1)
    if (const auto meant = config::nearest(node.entries[0].key, kDistributions))
      reject(node, name, "'" + node.entries[0].key + "': did you mean '" + *meant + "'?");
  for (std::size_t i = 0; i < node.items.size(); ++i)
    check_value(root, node.items[i], config::item_name(name, i));
  for (const config::Entry& entry : node.entries)
    check_value(root, entry.value, name + "." + entry.key);
}

/// The random stream of a path: its FNV-1a hash.
std::uint64_t stream_of(const std::string& path) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : path) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

Node number_node(double value) { return Node::scalar(fmt::format("{:.6g}", value), false); }

/// Replaces distributions by samples.
class ParameterSampler {
 public:
  ParameterSampler(const Node& root, std::uint64_t seed, std::uint64_t index)
      : root_(root), random_(seed), index_(index) {}

  [[nodiscard]] Node value(const Node& node, const std::string& path) const {
    if (const config::Entry* distribution = distribution_of(node))
      return sample(distribution->key, distribution->value, path);
    Node sampled = node;
    for (std::size_t i = 0; i < node.items.size(); ++i)
      sampled.items[i] = value(node.items[i], path + "." + std::to_string(i));
    for (std::size_t i = 0; i < node.entries.size(); ++i)
      sampled.entries[i].value = value(node.entries[i].value, path + "." + node.entries[i].key);
    return sampled;
  }

 private:
  [[nodiscard]] Node sample(const std::string& kind, const Node& node,
                            const std::string& path) const {
    if (kind == "choose") {
      const std::uint64_t chosen = random_.below(node.items.size(), stream_of(path), index_);
      return value(node.items[chosen], path + ".choice");
    }
    if (kind == "repeat") return repeat(node, path);
    if (kind == "same_as") return value(root_.find(node.text)->value, node.text);
    const std::vector<double> numbers = numbers_of(node, path);
    if (kind == "normal") return number_node(normal(numbers, path));
    const double low = numbers[0], high = numbers[1];
    if (kind == "integer") {
      const auto count = static_cast<std::uint64_t>(high - low) + 1;
      const auto offset = static_cast<double>(random_.below(count, stream_of(path), index_));
      return Node::scalar(fmt::format("{:.0f}", low + offset), false);
    }
    const double u = random_.uniform(stream_of(path), index_);
    if (kind == "uniform") return number_node(low + (high - low) * u);
    return number_node(low * std::pow(high / low, u));
  }

  [[nodiscard]] Node repeat(const Node& node, const std::string& path) const {
    constexpr double kMost = 10000;
    const Node& stated = node.find("count")->value;
    const Node sampled = value(stated, path + ".count");
    const std::optional<double> count = config::number_of(sampled);
    if (!count || !(*count >= 0 && *count <= kMost))
      reject(stated, path, "must repeat from 0 to 10000 times");
    Node list = Node::list();
    for (std::size_t k = 0; k < static_cast<std::size_t>(*count); ++k)
      list.items.push_back(value(node.find("item")->value, fmt::format("{}.{}", path, k)));
    return list;
  }

  [[nodiscard]] double normal(const std::vector<double>& numbers, const std::string& path) const {
    for (std::uint64_t attempt = 0; attempt < kNormalAttempts; ++attempt) {
      const std::uint64_t stream =
          stream_of(attempt == 0 ? path : fmt::format("{}#{}", path, attempt));
      const double sample = numbers[0] + numbers[1] * random_.normal(stream, index_);
      if (numbers.size() == 2 || (sample >= numbers[2] && sample <= numbers[3])) return sample;
    }
    return std::clamp(numbers[0], numbers[2], numbers[3]);
  }

  const Node& root_;
  Random random_;
  std::uint64_t index_;
};

}  // namespace

void from_node(const Node& node, const std::string& name, SampledParameters& parameters) {
  parameters.keys = Node::map();
  for (const config::Entry& entry : config::entries_of(node, name)) {
    check_value(node, entry.value, name + "." + entry.key);
    parameters.keys.entries.push_back(entry);
    make_paths_absolute(parameters.keys.entries.back().value);
  }
}

Node to_node(const SampledParameters& parameters) { return parameters.keys; }

Node sample_values(const SampledParameters& parameters, std::uint64_t seed, std::uint64_t index) {
  const ParameterSampler sampler(parameters.keys, seed, index);
  Node values = Node::map();
  for (const config::Entry& entry : parameters.keys.entries)
    values.entries.push_back({entry.key, {}, sampler.value(entry.value, entry.key), {}});
  return values;
}

std::uint64_t sample_below(std::uint64_t bound, const std::string& path, std::uint64_t seed,
                           std::uint64_t index) {
  return Random(seed).below(bound, stream_of(path), index);
}

}  // namespace saccade
