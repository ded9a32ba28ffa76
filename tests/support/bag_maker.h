#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thimble::test {

/// Writes bags with the layout of `ros2 bag record`, by SQLite only, so that tests can also write
/// invalid ones.
class BagMaker {
 public:
  /// Creates a file. Pages of 512 bytes keep it small.
  explicit BagMaker(const std::filesystem::path& file) {
    std::filesystem::remove(file);
    sqlite3_open(file.c_str(), &file_);
    run("PRAGMA page_size = 512; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; "
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, "
        "serialization_format TEXT, offered_qos_profiles TEXT); "
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
        "data BLOB); CREATE INDEX timestamp_idx ON messages (timestamp ASC);");
  }
  ~BagMaker() { sqlite3_close(file_); }
  BagMaker(const BagMaker&) = delete;
  BagMaker& operator=(const BagMaker&) = delete;

  /// Executes SQL.
  void run(const std::string& orders) {
    sqlite3_exec(file_, orders.c_str(), nullptr, nullptr, nullptr);
  }

  /// Adds a topic.
  void topic(int id, const std::string& name, const std::string& type,
             const std::string& format = "cdr") {
    run("INSERT INTO topics VALUES (" + std::to_string(id) + ", '" + name + "', '" + type + "', '" +
        format + "', '')");
  }

  /// Adds a message to a topic.
  void message(int topic, std::int64_t time_ns, const std::vector<unsigned char>& bytes) {
    sqlite3_stmt* row = nullptr;
    sqlite3_prepare_v2(file_, "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                       -1, &row, nullptr);
    sqlite3_bind_int(row, 1, topic);
    sqlite3_bind_int64(row, 2, time_ns);
    sqlite3_bind_blob(row, 3, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
    sqlite3_step(row);
    sqlite3_finalize(row);
  }

 private:
  sqlite3* file_ = nullptr;
};

}  // namespace thimble::test
