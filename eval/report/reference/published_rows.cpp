#include "eval/report/reference/published_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "core/config/config.h"
#include "core/config/convert.h"

namespace saccade {
namespace {

struct PublishedMethod {
  std::string name;
  std::string sensors;
  std::string paper;
  std::map<std::string, double> settings;
};

void describe(config::Fields& fields, PublishedMethod& method) {
  fields.value("name", method.name, "The method's name as the source calls it.").required();
  fields.value("sensors", method.sensors, "The sensors that the method uses.").required();
  fields.value("paper", method.paper, "Address or citation of the method's paper.");
  fields.value("settings", method.settings,
               "Values of a run's configuration with which the method's scores are compared: "
               "{a.key or a.former_key: 50}; empty compares them with every "
               "configuration.");
}

struct PublishedTable {
  std::string dataset;
  std::string metric;
  std::string protocol;
  std::string citation;
  std::string url;
  std::vector<PublishedMethod> methods;
  std::map<std::string, std::vector<std::optional<double>>> sequences;
};

void describe(config::Fields& fields, PublishedTable& table) {
  fields.value("dataset", table.dataset, "The dataset that the sequences belong to.").required();
  fields
      .value("metric", table.metric,
             "Key of metrics.json that the values compare with, in its unit.")
      .required();
  fields.value("protocol", table.protocol, "How the values were measured: alignment and error.")
      .required();
  fields.value("citation", table.citation, "Where the numbers were read.").required();
  fields.value("url", table.url, "Address of the source.").required();
  fields.list("methods", table.methods, "The columns of the table.").required();
  fields
      .value("sequences", table.sequences,
             "By sequence, a value for each method; ~ is not published.")
      .required();
  fields.expect(!table.citation.empty(), "citation", "must not be empty");
  std::set<std::string> names;
  for (const PublishedMethod& method : table.methods)
    fields.expect(names.insert(method.name).second, "methods",
                  "holds the name '" + method.name + "' twice");
  for (const auto& [sequence, values] : table.sequences) {
    fields.expect(values.size() == table.methods.size(), "sequences",
                  fmt::format(".{} holds {} values for {} methods", sequence, values.size(),
                              table.methods.size()));
    for (const std::optional<double>& value : values)
      fields.expect(!value || *value >= 0, "sequences", "." + sequence + " holds a negative value");
  }
}

struct PublishedFile {
  std::vector<PublishedTable> tables;
};

void describe(config::Fields& fields, PublishedFile& file) {
  fields.list("tables", file.tables, "Tables of one dataset, metric and protocol each.").required();
}

bool states(const config::Node& root, const std::string& key, double value) {
  const config::Node* node = &root;
  std::istringstream path(key);
  for (std::string part; node != nullptr && std::getline(path, part, '.');) {
    const config::Entry* entry = node->find(part);
    node = entry == nullptr ? nullptr : &entry->value;
  }
  return node != nullptr && config::number_of(*node) == value;
}

/// `keys`: "edges.samples or align.samples".
bool any_states(const config::Node& root, const std::string& keys, double value) {
  constexpr std::string_view kOr = " or ";
  std::size_t begin = 0;
  for (std::size_t end = keys.find(kOr); end != std::string::npos; end = keys.find(kOr, begin)) {
    if (states(root, keys.substr(begin, end - begin), value)) return true;
    begin = end + kOr.size();
  }
  return states(root, keys.substr(begin), value);
}

}  // namespace

bool has_settings(const PublishedRow& row, const RunRecord& run) {
  if (row.settings.empty()) return true;
  if (run.config_yaml.empty()) return false;
  const config::Document configuration = config::parse(run.config_yaml, "configuration");
  return std::all_of(row.settings.begin(), row.settings.end(), [&](const auto& setting) {
    return any_states(configuration.root(), setting.first, setting.second);
  });
}

std::vector<PublishedRow> published_rows(const config::Document& document) {
  std::vector<PublishedRow> rows;
  for (const PublishedTable& table : config::read<PublishedFile>(document).tables)
    for (const auto& [sequence, values] : table.sequences)
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!values[i]) continue;
        const PublishedMethod& method = table.methods[i];
        rows.push_back({table.dataset, sequence, method.name, method.sensors, table.metric,
                        *values[i], table.protocol, method.paper, table.citation, table.url,
                        method.settings});
      }
  return rows;
}

std::vector<PublishedRow> read_published_rows(const std::filesystem::path& file) {
  return published_rows(config::load(file));
}

}  // namespace saccade
