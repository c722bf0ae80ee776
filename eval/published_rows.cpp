#include "eval/published_rows.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>

#include "core/config/config.h"

namespace saccade {
namespace {

struct PublishedMethod {
  std::string name;
  std::string sensors;
  std::string paper;
};

void describe(config::Fields& fields, PublishedMethod& method) {
  fields.value("name", method.name, "as the source calls it").required();
  fields.value("sensors", method.sensors, "that it uses").required();
  fields.value("paper", method.paper, "address or citation");
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
  fields.value("dataset", table.dataset, "that the sequences are of").required();
  fields.value("metric", table.metric, "key of metrics.json").required();
  fields.value("protocol", table.protocol, "alignment and error").required();
  fields.value("citation", table.citation, "where the numbers were read").required();
  fields.value("url", table.url, "of the source").required();
  fields.list("methods", table.methods, "columns: {name, sensors, paper}").required();
  fields.value("sequences", table.sequences, "sequence: a value for each method").required();
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
  fields.list("tables", file.tables, "of one dataset and protocol each").required();
}

}  // namespace

std::vector<PublishedRow> read_published_rows(const std::filesystem::path& file) {
  std::vector<PublishedRow> rows;
  for (const PublishedTable& table : config::read<PublishedFile>(config::load(file)).tables)
    for (const auto& [sequence, values] : table.sequences)
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!values[i]) continue;
        const PublishedMethod& method = table.methods[i];
        rows.push_back({table.dataset, sequence, method.name, method.sensors, table.metric,
                        *values[i], table.protocol, method.paper, table.citation, table.url});
      }
  return rows;
}

}  // namespace saccade
