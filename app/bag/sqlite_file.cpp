#include "bag/sqlite_file.h"

#include <sqlite3.h>

#include "system/regular_file.h"

namespace thimble::bag {

void SqliteStatement::End::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

driver::Result<bool> SqliteStatement::next() {
  switch (sqlite3_step(statement_.get())) {
    case SQLITE_ROW:
      return true;
    case SQLITE_DONE:
      return false;
    default:
      return driver::Error{sqlite3_errmsg(sqlite3_db_handle(statement_.get()))};
  }
}

std::int64_t SqliteStatement::number(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string_view SqliteStatement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return {};
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::span<const unsigned char> SqliteStatement::bytes(int column) const {
  const auto* bytes =
      static_cast<const unsigned char*>(sqlite3_column_blob(statement_.get(), column));
  if (bytes == nullptr) return {};
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void SqliteStatement::put(int place, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), place, value);
}

void SqliteStatement::put(int place, std::string_view value) {
  sqlite3_bind_text64(statement_.get(), place, value.data(), value.size(), SQLITE_STATIC,
                      SQLITE_UTF8);
}

void SqliteStatement::put(int place, std::span<const unsigned char> value) {
  sqlite3_bind_blob64(statement_.get(), place, value.data(), value.size(), SQLITE_STATIC);
}

void SqliteStatement::reset() {
  sqlite3_reset(statement_.get());
}

void SqliteFile::Close::operator()(sqlite3* file) const {
  sqlite3_close(file);
}

driver::Result<SqliteFile> SqliteFile::open(const std::filesystem::path& file, int mode) {
  sqlite3* opened = nullptr;
  const int status = sqlite3_open_v2(file.c_str(), &opened, mode | SQLITE_OPEN_NOMUTEX, nullptr);
  SqliteFile result;
  result.file_.reset(opened);
  if (status != SQLITE_OK) {
    return driver::Error{opened == nullptr ? "out of memory" : sqlite3_errmsg(opened)};
  }
  return result;
}

driver::Result<SqliteFile> SqliteFile::open(const std::filesystem::path& file) {
  // Rejected here, because SQLite would wait for a writer if the file is a pipe.
  if (!driver::is_regular(file)) return driver::Error{"not a regular file"};
  auto opened = open(file, SQLITE_OPEN_READONLY);
  if (!opened) return opened;
  sqlite3* const raw = opened->file_.get();
  sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  if (auto checked = opened->run("PRAGMA cell_size_check = ON"); !checked) return checked.error();
  return opened;
}

driver::Result<SqliteFile> SqliteFile::create(const std::filesystem::path& file) {
  return open(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
}

driver::Result<SqliteStatement> SqliteFile::ask(const std::string& question) const {
  sqlite3_stmt* prepared = nullptr;
  const int status = sqlite3_prepare_v2(file_.get(), question.c_str(), -1, &prepared, nullptr);
  if (status != SQLITE_OK) return driver::Error{sqlite3_errmsg(file_.get())};
  SqliteStatement statement;
  statement.statement_.reset(prepared);
  return statement;
}

driver::Result<void> SqliteFile::run(const std::string& orders) const {
  if (sqlite3_exec(file_.get(), orders.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) return {};
  return driver::Error{sqlite3_errmsg(file_.get())};
}

}  // namespace thimble::bag
