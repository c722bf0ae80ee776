#include "eval/store/database.h"

#include <sqlite3.h>

#include "core/check.h"
#include "core/error.h"

namespace saccade {
namespace {

constexpr int kWaitMs = 60'000;

[[noreturn]] void fail(sqlite3* connection) {
  const char* file = sqlite3_db_filename(connection, nullptr);
  throw InputError(file == nullptr ? "" : file, sqlite3_errmsg(connection));
}

void require(sqlite3* connection, int code) {
  if (code != SQLITE_OK) fail(connection);
}

/// Lets reading through and nothing else: no ATTACH, no PRAGMA that changes something.
int allow_reading(void*, int action, const char* name, const char*, const char*, const char*) {
  const bool reads = action == SQLITE_SELECT || action == SQLITE_READ ||
                     action == SQLITE_FUNCTION ||
                     (action == SQLITE_PRAGMA && std::string_view(name) == "user_version");
  return reads ? SQLITE_OK : SQLITE_DENY;
}

sqlite3* connection_of(sqlite3_stmt* statement) { return sqlite3_db_handle(statement); }

}  // namespace

void Statement::Finish::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

void Statement::bind(int parameter, std::int64_t value) {
  SACCADE_CHECK(sqlite3_bind_int64(statement_.get(), parameter, value) == SQLITE_OK);
}

void Statement::bind(int parameter, const std::optional<double>& value) {
  SACCADE_CHECK((value ? sqlite3_bind_double(statement_.get(), parameter, *value)
                       : sqlite3_bind_null(statement_.get(), parameter)) == SQLITE_OK);
}

void Statement::bind(int parameter, std::string_view text) {
  SACCADE_CHECK(sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(),
                                    SQLITE_TRANSIENT, SQLITE_UTF8) == SQLITE_OK);
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) fail(connection_of(statement_.get()));
  return code == SQLITE_ROW;
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::optional<double> Statement::number(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* bytes = sqlite3_column_text(statement_.get(), column);
  if (bytes == nullptr) return {};
  return {reinterpret_cast<const char*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void Database::Close::operator()(sqlite3* connection) const { sqlite3_close(connection); }

Database::Database(const std::filesystem::path& file, Access access) {
  const int mode =
      access == Access::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &connection, mode, nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) throw InputError(file.string(), sqlite3_errstr(code));
  require(connection, sqlite3_busy_timeout(connection, kWaitMs));
  if (access == Access::kRead)
    require(connection, sqlite3_set_authorizer(connection, allow_reading, nullptr));
}

void Database::run(const std::string& sql) {
  require(connection_.get(),
          sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

Statement Database::prepare(const std::string& sql) {
  SqlFault fault;
  std::optional<Statement> statement = try_prepare(sql, fault);
  if (!statement) fail(connection_.get());
  return std::move(*statement);
}

std::optional<Statement> Database::try_prepare(const std::string& sql, SqlFault& fault) {
  sqlite3_stmt* raw = nullptr;
  const int code = sqlite3_prepare_v2(connection_.get(), sql.c_str(),
                                      static_cast<int>(sql.size()) + 1, &raw, nullptr);
  Statement statement;
  statement.statement_.reset(raw);
  if (code == SQLITE_OK) return statement;
  fault.message = sqlite3_errmsg(connection_.get());
  const int at = sqlite3_error_offset(connection_.get());
  fault.at = at < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(at));
  return std::nullopt;
}

Transaction::Transaction(Database& database) : database_(database) {
  database_.run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (committed_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const InputError&) {  // SQLite has undone it already
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  committed_ = true;
}

}  // namespace saccade
