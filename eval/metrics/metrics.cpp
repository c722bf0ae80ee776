#include "eval/metrics/metrics.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/json_depth.h"

namespace saccade {
namespace {

using Json = nlohmann::json;  // its objects are sorted by key

void flatten(const Json& node, const std::string& prefix, Metrics& metrics) {
  for (const auto& [name, value] : node.items()) {
    const std::string key = prefix.empty() ? name : prefix + "." + name;
    if (value.is_object())
      flatten(value, key, metrics);
    else if (value.is_number())
      metrics.set(key, value.get<double>());
    else if (value.is_null())
      metrics.set(key, std::nullopt);
  }
}

Json& child(Json& root, std::string_view key) {
  Json* node = &root;
  for (;;) {
    const std::size_t dot = key.find('.');
    node = &(*node)[std::string(key.substr(0, dot))];
    if (dot == std::string_view::npos) return *node;
    key.remove_prefix(dot + 1);
  }
}

/// 1234.0 is written as 1234: counts read as counts.
Json number(double value) {
  constexpr double kExactIntegers = 9007199254740992.0;
  if (value == std::floor(value) && std::abs(value) < kExactIntegers)
    return static_cast<std::int64_t>(value);
  return value;
}

Json parse_object(std::string_view text, const std::string& source) {
  if (const auto byte = json_too_deep_at(text))
    throw InputError(source, "byte " + std::to_string(*byte) + " is nested too deeply");
  try {
    Json root = Json::parse(text);
    if (!root.is_object()) throw InputError(source, "must be a JSON object");
    return root;
  } catch (const Json::parse_error& error) {
    throw InputError(source, "byte " + std::to_string(error.byte) + " is no valid JSON");
  } catch (const Json::exception&) {
    throw InputError(source, "holds a number that is too large");
  }
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), "cannot be read");
  return std::string(std::istreambuf_iterator<char>(in), {});
}

}  // namespace

void Metrics::set(std::string key, std::optional<double> value) {
  if (value && !std::isfinite(*value)) value.reset();
  values_.insert_or_assign(std::move(key), value);
}

std::optional<double> Metrics::get(std::string_view key) const {
  const auto found = values_.find(key);
  return found == values_.end() ? std::nullopt : found->second;
}

std::string to_json(const Metrics& metrics, const std::map<std::string, std::string>& inputs) {
  Json root = Json::object();
  if (!inputs.empty()) root["inputs"] = inputs;
  for (const auto& [key, value] : metrics.values()) {
    Json& leaf = child(root, key);
    SACCADE_CHECK(leaf.is_null());
    if (value) leaf = number(*value);
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Metrics parse_json_metrics(std::string_view text, const std::string& source) {
  Metrics metrics;
  flatten(parse_object(text, source), "", metrics);
  return metrics;
}

Metrics read_json_metrics(const std::filesystem::path& file) {
  return parse_json_metrics(text_of(file), file.string());
}

std::map<std::string, std::string> read_json_texts(const std::filesystem::path& file,
                                                   const std::string& name) {
  const Json root = parse_object(text_of(file), file.string());
  std::map<std::string, std::string> texts;
  if (const auto object = root.find(name); object != root.end() && object->is_object())
    for (const auto& [key, value] : object->items())
      if (value.is_string()) texts[key] = value.get<std::string>();
  return texts;
}

}  // namespace saccade
