#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace saccade {

/// One SQL statement, run once or, after reset(), again. Parameters count from 1, columns from 0.
class Statement {
 public:
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, const std::optional<double>& value);
  void bind(int parameter, std::string_view text);

  /// True while there is another row. InputError with the file for what SQLite refuses.
  bool step();
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::optional<double> number(int column) const;
  [[nodiscard]] std::string text(int column) const;

 private:
  friend class Database;
  struct Finish {
    void operator()(sqlite3_stmt* statement) const;
  };

  std::unique_ptr<sqlite3_stmt, Finish> statement_;
};

/// What SQLite finds wrong with the text of a statement.
struct SqlFault {
  std::string message;
  std::optional<std::size_t> at;  ///< byte in the text; nullopt: at its end
};

/// A connection to an SQLite file, for one thread. A file that others write at this moment is
/// waited for (a minute at most). The journal is SQLite's rollback journal and not WAL: that one
/// needs shared memory, which network file systems lack, and a folder that readers may write to.
class Database {
 public:
  enum class Access {
    kRead,   ///< the file exists; nothing but SELECT is let through
    kWrite,  ///< the file is created where there is none
  };

  /// InputError with the path when the file cannot be opened.
  Database(const std::filesystem::path& file, Access access);

  /// Runs statements that give no rows.
  void run(const std::string& sql);
  [[nodiscard]] Statement prepare(const std::string& sql);
  /// The same for a text of which a part was written by a person: nullopt and `fault` where it is
  /// wrong.
  [[nodiscard]] std::optional<Statement> try_prepare(const std::string& sql, SqlFault& fault);

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };

  std::unique_ptr<sqlite3, Close> connection_;
};

/// All that is written while it lives, or nothing of it. From the beginning on nobody else writes.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();  ///< undoes everything unless commit() was called
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit();

 private:
  Database& database_;
  bool committed_ = false;
};

}  // namespace saccade
