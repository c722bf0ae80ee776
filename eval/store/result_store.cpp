#include "eval/store/result_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/process/progress.h"
#include "eval/store/where_expression.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSchemaVersion = 1;

struct TypeName {
  const char* operator()(std::string ResultRow::*) const { return "TEXT"; }
  const char* operator()(std::uint64_t ResultRow::*) const { return "INTEGER"; }
  const char* operator()(int ResultRow::*) const { return "INTEGER"; }
  const char* operator()(std::optional<double> ResultRow::*) const { return "REAL"; }
};

/// `"run", "module", ...`: "commit" is a word of SQL. The text of the configuration, which would be
/// carried through the sorting of the rows, is left empty where nobody wants it.
std::string column_list(bool with_config_text = true) {
  std::string list;
  for (const ResultColumn& column : result_columns()) {
    list += list.empty() ? "" : ", ";
    list += column.name != "config_yaml" || with_config_text ? "\"" + column.name + "\"" : "''";
  }
  return list;
}

/// Metrics are in long form, so that a new one needs no new column; their names are stored once.
std::string schema() {
  std::string columns = "id INTEGER PRIMARY KEY";
  for (const ResultColumn& column : result_columns())
    columns += fmt::format(", \"{}\" {}", column.name, std::visit(TypeName{}, column.member));
  return fmt::format(
      "CREATE TABLE runs ({}, UNIQUE (run));"
      "CREATE TABLE metric_names (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE);"
      "CREATE TABLE metrics (run INTEGER NOT NULL REFERENCES runs (id),"
      "  metric INTEGER NOT NULL REFERENCES metric_names (id), value REAL,"
      "  PRIMARY KEY (run, metric)) WITHOUT ROWID;"
      "PRAGMA user_version = {}",
      columns, kSchemaVersion);
}

std::int64_t number_in(Database& database, const std::string& sql) {
  Statement statement = database.prepare(sql);
  statement.step();
  return statement.integer(0);
}

bool is_empty(Database& database) {
  return number_in(database, "SELECT count(*) FROM sqlite_master") == 0;
}

void check_version(Database& database, const fs::path& file) {
  const std::int64_t found = number_in(database, "PRAGMA user_version");
  if (found == kSchemaVersion) return;
  if (found == 0) throw InputError(file.string(), "is no result store");
  throw InputError(file.string(),
                   fmt::format("is a result store of version {}; this program knows version {}",
                               found, kSchemaVersion));
}

/// Binds the columns of a row to the parameters from 1 on. Seeds above 2^63 are stored wrapped.
void bind_columns(Statement& statement, const ResultRow& row) {
  struct Bind {
    Statement& statement;
    int parameter;
    void operator()(const std::string& text) const { statement.bind(parameter, text); }
    void operator()(std::uint64_t value) const {
      statement.bind(parameter, static_cast<std::int64_t>(value));
    }
    void operator()(int value) const { statement.bind(parameter, std::int64_t{value}); }
    void operator()(const std::optional<double>& value) const { statement.bind(parameter, value); }
  };
  int parameter = 0;
  for (const ResultColumn& column : result_columns()) {
    const Bind bind{statement, ++parameter};
    std::visit([&](auto member) { bind(row.*member); }, column.member);
  }
}

void take_column(const Statement& statement, int i, std::string& text) { text = statement.text(i); }
void take_column(const Statement& statement, int i, std::uint64_t& value) {
  value = static_cast<std::uint64_t>(statement.integer(i));
}
void take_column(const Statement& statement, int i, int& value) {
  value = static_cast<int>(statement.integer(i));
}
void take_column(const Statement& statement, int i, std::optional<double>& value) {
  value = statement.number(i);
}

/// The columns of column_list() with the id before them.
ResultRow row_of(const Statement& statement) {
  ResultRow row;
  row.id = statement.integer(0);
  int i = 0;
  for (const ResultColumn& column : result_columns()) {
    ++i;
    std::visit([&](auto member) { take_column(statement, i, row.*member); }, column.member);
  }
  return row;
}

std::string insert_run() {
  std::string parameters;
  for (std::size_t i = 0; i < result_columns().size(); ++i) parameters += i == 0 ? "?" : ", ?";
  return "INSERT INTO runs (" + column_list() + ") VALUES (" + parameters + ") RETURNING id";
}

/// The statements that add rows, prepared once for all of them.
class Adder {
 public:
  explicit Adder(Database& database)
      : old_metrics_(database.prepare(
            "DELETE FROM metrics WHERE run = (SELECT id FROM runs WHERE run = ?)")),
        old_run_(database.prepare("DELETE FROM runs WHERE run = ?")),
        run_(database.prepare(insert_run())),
        name_(database.prepare("INSERT OR IGNORE INTO metric_names (name) VALUES (?)")),
        metric_(database.prepare("INSERT INTO metrics (run, metric, value) VALUES (?, "
                                 "(SELECT id FROM metric_names WHERE name = ?), ?)")) {}

  void add(const ResultRow& row) {
    for (Statement* old : {&old_metrics_, &old_run_}) {
      old->reset();
      old->bind(1, row.run);
      old->step();
    }
    run_.reset();
    bind_columns(run_, row);
    run_.step();
    const std::int64_t id = run_.integer(0);
    run_.step();
    for (const auto& [key, value] : row.metrics.values()) add_metric(id, key, value);
  }

 private:
  void add_metric(std::int64_t run, const std::string& key, const std::optional<double>& value) {
    name_.reset();
    name_.bind(1, key);
    name_.step();
    metric_.reset();
    metric_.bind(1, run);
    metric_.bind(2, key);
    metric_.bind(3, value);
    metric_.step();
  }

  Statement old_metrics_, old_run_, run_, name_, metric_;
};

Database open_for_reading(const fs::path& file) {
  if (!fs::exists(file))
    throw InputError(file.string(),
                     "is not there; `saccade eval RUN` writes it, and `saccade results --scan "
                     "FOLDER` for runs that were scored before");
  return {file, Database::Access::kRead};
}

}  // namespace

bool MetricTable::any_has(std::size_t metric) const {
  for (std::size_t at = metric; at < values_.size(); at += names_.size())
    if (!std::isnan(values_[at])) return true;
  return false;
}

fs::path result_store_beside(const fs::path& run_folder) {
  const fs::path whole = fs::absolute(run_folder).lexically_normal();
  const fs::path run = whole.has_filename() ? whole : whole.parent_path();
  return run.parent_path() / kResultStoreName;
}

fs::path find_result_store(const fs::path& named) {
  if (fs::is_regular_file(named)) return named;
  for (const fs::path& folder : {named, named / "runs"})
    if (fs::exists(folder / kResultStoreName)) return folder / kResultStoreName;
  return named / kResultStoreName;
}

std::vector<fs::path> without_store(std::span<const fs::path> named) {
  std::vector<fs::path> runs(named.begin(), named.end());
  // Its journal, while somebody writes, is called "results.sqlite-...".
  std::erase_if(runs, [](const fs::path& path) {
    return path.filename().string().starts_with(kResultStoreName) && fs::is_regular_file(path);
  });
  return runs;
}

ResultStore::ResultStore(const fs::path& file) : database_(file, Database::Access::kWrite) {
  Transaction transaction(database_);  // another program may be creating it
  if (is_empty(database_)) database_.run(schema());
  check_version(database_, file);
  transaction.commit();
}

void ResultStore::add(std::span<const ResultRow> rows) {
  Transaction transaction(database_);
  Adder adder(database_);
  for (const ResultRow& row : rows) adder.add(row);
  transaction.commit();
}

void store_result(const fs::path& run_folder) {
  const ResultRow row = read_result(run_folder);
  ResultStore(result_store_beside(run_folder)).add({&row, 1});
}

void keep_result(const fs::path& run_folder) {
  try {
    store_result(run_folder);
  } catch (const InputError& error) {
    show_notice(std::string("not stored for `saccade results`: ") + error.what());
  }
}

ResultReader::ResultReader(const fs::path& file) : database_(open_for_reading(file)) {
  check_version(database_, file);
  Statement names = database_.prepare("SELECT name, id FROM metric_names");
  while (names.step()) metrics_.emplace(names.text(0), names.integer(1));
}

std::vector<std::string> ResultReader::metric_names() const {
  std::vector<std::string> names;
  for (const auto& [name, id] : metrics_) names.push_back(name);
  return names;
}

std::string ResultReader::stored_metric(const std::string& name) const {
  if (metrics_.contains(name)) return name;
  const std::string median = name + ".median";
  return metrics_.contains(median) ? median : "";
}

std::vector<ResultRow> ResultReader::select(std::string_view where, bool with_config_text) {
  const std::string begin = "SELECT id, " + column_list(with_config_text) + " FROM runs WHERE ";
  const std::string end = " ORDER BY dataset, module, config, seed, run";
  const auto metric_sql = [this](const std::string& name) -> std::string {
    const std::string metric = stored_metric(name);
    if (metric.empty()) return {};
    return fmt::format("(SELECT value FROM metrics WHERE run = runs.id AND metric = {})",
                       metrics_.at(metric));
  };
  const WhereExpression condition(where, metric_sql, metric_names());
  SqlFault fault;
  std::optional<Statement> statement = database_.try_prepare(begin + condition.sql() + end, fault);
  if (!statement) condition.fail(fault, begin.size());
  int parameter = 0;
  for (const std::string& text : condition.texts()) statement->bind(++parameter, text);
  std::vector<ResultRow> rows;
  while (statement->step()) rows.push_back(row_of(*statement));
  return rows;
}

MetricTable ResultReader::metrics(std::span<const ResultRow> rows, std::vector<std::string> names) {
  std::vector<std::size_t> column_of;  // by number of the metric
  std::string chosen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::int64_t id = metrics_.at(names[i]);
    column_of.resize(std::max(column_of.size(), static_cast<std::size_t>(id) + 1));
    column_of[static_cast<std::size_t>(id)] = i;
    chosen += (chosen.empty() ? "" : ", ") + std::to_string(id);
  }
  const bool all = names.size() == metrics_.size();
  Statement statement = database_.prepare("SELECT metric, value FROM metrics WHERE run = ?" +
                                          (all ? "" : " AND metric IN (" + chosen + ")"));
  MetricTable table(rows.size(), std::move(names));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    statement.reset();
    statement.bind(1, rows[row].id);
    while (statement.step())
      if (const std::optional<double> value = statement.number(1))
        table.set(row, column_of[static_cast<std::size_t>(statement.integer(0))], *value);
  }
  return table;
}

}  // namespace saccade
