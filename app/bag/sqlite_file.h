#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "thimble/driver/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace thimble::bag {

/// Prepared statement on an SQLite file, with its result row by row. Real-time: never from the
/// servo thread.
class SqliteStatement {
 public:
  /// Advances to the next row; returns false if there is none. The error is SQLite's.
  driver::Result<bool> next();
  /// Returns an integer column of the row; 0 if it is not a number.
  std::int64_t number(int column) const;
  /// Returns a text column of the row; valid until the next row.
  std::string_view text(int column) const;
  /// Returns a blob column of the row; valid until the next row.
  std::span<const unsigned char> bytes(int column) const;

  /// Binds a value to a `?` (numbered from 1). Text and bytes must stay valid until `next`.
  void put(int place, std::int64_t value);
  void put(int place, std::string_view value);                ///< As above.
  void put(int place, std::span<const unsigned char> value);  ///< As above.
  /// Resets the statement, for other values.
  void reset();

 private:
  friend class SqliteFile;
  struct End {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, End> statement_;
};

/// SQLite file. Real-time: never from the servo thread.
class SqliteFile {
 public:
  /// Opens an existing file read-only. Its contents are not trusted: no code in it is executed.
  static driver::Result<SqliteFile> open(const std::filesystem::path& file);
  /// Creates a new file. Precondition: no file with that name exists.
  static driver::Result<SqliteFile> create(const std::filesystem::path& file);

  /// Prepares a statement; the error is SQLite's.
  driver::Result<SqliteStatement> ask(const std::string& question) const;
  /// Executes statements that return no rows.
  driver::Result<void> run(const std::string& orders) const;

 private:
  struct Close {
    void operator()(sqlite3* file) const;
  };
  static driver::Result<SqliteFile> open(const std::filesystem::path& file, int mode);
  std::unique_ptr<sqlite3, Close> file_;
};

}  // namespace thimble::bag
