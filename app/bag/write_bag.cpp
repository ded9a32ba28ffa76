#include "bag/write_bag.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <system_error>

#include "bag/sqlite_file.h"

namespace thimble::bag {
namespace {

namespace fs = std::filesystem;

// Same tables as those of rosbag2 of Humble [S ros2/rosbag2 sqlite_storage.cpp].
constexpr const char* kTables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
    "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
    "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";

/// Writes all messages sorted by time, because players read them in the order of the table.
driver::Result<void> fill(const SqliteFile& file, const std::vector<BagTrack>& tracks,
                          const std::function<void(double)>& written) {
  auto topic = file.ask("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')");
  if (!topic) return topic.error();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    topic->put(1, static_cast<std::int64_t>(i + 1));
    topic->put(2, std::string_view(tracks[i].name));
    topic->put(3, type_of(tracks[i].kind));
    if (auto put = topic->next(); !put) return put.error();
    topic->reset();
  }
  auto row = file.ask("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
  if (!row) return row.error();
  std::vector<std::size_t> next(tracks.size(), 0);
  std::size_t all = 0, done = 0;
  for (const BagTrack& track : tracks) all += track.messages.size();
  for (;;) {
    std::size_t first = tracks.size();
    std::int64_t time_ns = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (next[i] == tracks[i].messages.size()) continue;
      const std::int64_t here_ns = tracks[i].messages[next[i]].time_ns;
      if (first == tracks.size() || here_ns < time_ns) first = i, time_ns = here_ns;
    }
    if (first == tracks.size()) return {};
    const BagMessage& message = tracks[first].messages[next[first]++];
    const auto bytes = encode(tracks[first].kind,
                              {message.time_ns, tracks[first].frame, message.value}, message.q);
    row->put(1, static_cast<std::int64_t>(first + 1));
    row->put(2, message.time_ns);
    row->put(3, std::span<const unsigned char>(bytes));
    if (auto put = row->next(); !put) return put.error();
    row->reset();
    if (written) written(static_cast<double>(++done) / static_cast<double>(all));
  }
}

/// Returns the text of metadata.yaml, version 5 [S ros2/rosbag2 metadata_io.cpp].
std::string metadata(const std::vector<BagTrack>& tracks, const std::string& file) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max(), last_ns = 0;
  std::size_t count = 0;
  std::string topics;
  for (const BagTrack& track : tracks) {
    count += track.messages.size();
    if (!track.messages.empty()) {
      first_ns = std::min(first_ns, track.messages.front().time_ns);
      last_ns = std::max(last_ns, track.messages.back().time_ns);
    }
    topics += fmt::format(
        "    - topic_metadata:\n        name: {}\n        type: {}\n"
        "        serialization_format: cdr\n        offered_qos_profiles: \"\"\n"
        "      message_count: {}\n",
        track.name, type_of(track.kind), track.messages.size());
  }
  if (count == 0) first_ns = 0;
  const std::int64_t duration_ns = last_ns - first_ns;
  return fmt::format(
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
      "  duration:\n    nanoseconds: {1}\n  starting_time:\n    nanoseconds_since_epoch: {2}\n"
      "  message_count: {3}\n  topics_with_message_count:\n{4}"
      "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - {0}\n"
      "  files:\n    - path: {0}\n      starting_time:\n        nanoseconds_since_epoch: {2}\n"
      "      duration:\n        nanoseconds: {1}\n      message_count: {3}\n",
      file, duration_ns, first_ns, count, topics);
}

/// Writes a bag of files `database` and `text` of a folder that is there.
driver::Result<void> write_files(const fs::path& database, const fs::path& text,
                                 const std::vector<BagTrack>& tracks,
                                 const std::function<void(double)>& written) {
  const auto file = SqliteFile::create(database);
  if (!file) return file.error();
  for (const char* orders :
       {"PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF", kTables, "BEGIN"}) {
    if (auto done = file->run(orders); !done) return done.error();
  }
  if (auto filled = fill(*file, tracks, written); !filled) return filled.error();
  if (auto ended = file->run("COMMIT"); !ended) return ended.error();
  std::ofstream stream(text, std::ios::binary);
  stream << metadata(tracks, database.filename().string());
  stream.close();
  if (!stream) return driver::Error{text.filename().string()};
  return {};
}

}  // namespace

driver::Result<void> write_bag(const std::filesystem::path& folder,
                               const std::vector<BagTrack>& tracks,
                               const std::function<void(double)>& share_written) {
  std::error_code failed;
  if (fs::exists(folder, failed) && !fs::is_empty(folder, failed)) {
    return driver::Error{folder.string() + ": already exists; choose a new folder."};
  }
  const auto cannot = [&folder](const std::string& why) {
    return driver::Error{folder.string() + ": the bag cannot be written: " + why +
                         ". Check the free space on the disk and your write permission."};
  };
  // The last component of "bag/" is empty.
  fs::path named = fs::absolute(folder).lexically_normal();
  if (!named.has_filename()) named = named.parent_path();
  const bool created = fs::create_directories(named, failed);
  if (failed) return cannot(failed.message());
  const fs::path database = named / (named.filename().string() + "_0.db3");
  const fs::path text = named / "metadata.yaml";
  if (auto written = write_files(database, text, tracks, share_written); !written) {
    // Removes the incomplete bag, which would block the next attempt.
    std::error_code ignored;
    fs::remove(database, ignored);
    fs::remove(text, ignored);
    if (created) fs::remove(named, ignored);
    return cannot(written.error().message);
  }
  return {};
}

}  // namespace thimble::bag
