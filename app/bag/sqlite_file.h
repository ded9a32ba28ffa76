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

/// A question or an order to a file of SQLite, with its answer row by row. Real-time: never from
/// the servo thread.
class SqliteStatement {
 public:
  /// Goes to the next row; false if there is none. The error is SQLite's.
  driver::Result<bool> next();
  /// Returns a number of the row; 0 if it is none.
  std::int64_t number(int column) const;
  /// Returns a text of the row, until the next one.
  std::string_view text(int column) const;
  /// Returns bytes of the row, until the next one.
  std::span<const unsigned char> bytes(int column) const;

  /// Puts a value for a `?` (from 1). What it names must stay until `next`.
  void put(int place, std::int64_t value);
  void put(int place, std::string_view value);                ///< As above.
  void put(int place, std::span<const unsigned char> value);  ///< As above.
  /// Makes it ready for other values.
  void reset();

 private:
  friend class SqliteFile;
  struct End {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, End> statement_;
};

/// A file of SQLite. Real-time: never from the servo thread.
class SqliteFile {
 public:
  /// Opens a file that is there, to read it alone. What is in it is not trusted: nothing in it is
  /// run.
  static driver::Result<SqliteFile> open(const std::filesystem::path& file);
  /// Makes a new file. Precondition: there is none of that name.
  static driver::Result<SqliteFile> create(const std::filesystem::path& file);

  /// Prepares a question; the error is SQLite's.
  driver::Result<SqliteStatement> ask(const std::string& question) const;
  /// Carries out orders that answer nothing.
  driver::Result<void> run(const std::string& orders) const;

 private:
  struct Close {
    void operator()(sqlite3* file) const;
  };
  static driver::Result<SqliteFile> open(const std::filesystem::path& file, int mode);
  std::unique_ptr<sqlite3, Close> file_;
};

}  // namespace thimble::bag
