#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace talkgraph::study {

/// The database cannot be read or written: locked, damaged, the disk full. Names the file and the cause.
struct DatabaseError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An SQLite database in WAL mode; what is committed is on the disk.
class Database {
 public:
  enum class Access { read, write };
  /// Written, it is made where there is none, readable by its owner alone.
  Database(const std::filesystem::path& file, Access access);

  /// Runs a statement that gives no rows.
  template <class... Value>
  void run(std::string_view sql, const Value&... values);

  [[noreturn]] void fail() const;
  sqlite3* get() const { return database_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };

  std::string name_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// A statement and the values of its parameters.
class Statement {
 public:
  template <class... Value>
  Statement(const Database& database, std::string_view sql, const Value&... values) : Statement(database, sql) {
    int place = 0;
    (bind(++place, values), ...);
  }
  Statement(const Database& database, std::string_view sql);

  /// Whether there is another row.
  bool step();
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double real(int column) const { return sqlite3_column_double(statement_.get(), column); }
  std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };

  void bind(int place, std::int64_t value);
  void bind(int place, int value) { bind(place, std::int64_t{value}); }
  void bind(int place, double value);
  void bind(int place, const std::string& value);
  void check(int code) const;

  const Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// All or nothing; alone in writing. What is not committed is taken back.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
};

template <class... Value>
void Database::run(std::string_view sql, const Value&... values) {
  Statement(*this, sql, values...).step();
}

}  // namespace talkgraph::study
