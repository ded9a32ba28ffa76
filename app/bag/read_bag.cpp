#include "bag/read_bag.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>
#include <utility>

#include "bag/sqlite_file.h"
#include "system/printable_text.h"
#include "system/regular_file.h"

namespace thimble::bag {
namespace {

namespace fs = std::filesystem;

// Five hours at 1 kHz. [chosen: a file with more is damaged, or longer than any session]
constexpr std::size_t kMessagesMax = 20'000'000;
constexpr std::int64_t kLongest =
    86'400'000'000'000;  // ns; one day, so that a double in s resolves ns
constexpr std::int64_t kLatest = std::int64_t{1} << 62;  // ns; so that differences do not overflow

/// Message in memory, with its stamp and its time of reception.
struct Kept {
  std::int64_t received_ns = 0, stamp_ns = 0;
  Eigen::Vector3d value;
};

struct TopicRow {
  std::int64_t id = 0;
  std::string name, type, format;
};

struct OpenBag {
  fs::path file;
  SqliteFile data;
  std::vector<TopicRow> topics;
};

std::string_view word_of(BagKind kind) {
  return kind == BagKind::kPositions ? "/pose" : "/wrench";
}

/// Returns the files of a bag, sorted by name.
driver::Result<std::vector<fs::path>> files_of(const fs::path& path) {
  std::error_code status;
  std::vector<fs::path> files;
  std::string other;  // extension of another bag format, if found
  const auto judge = [&](const fs::path& file) {
    const std::string end = file.extension().string();
    if (end == ".mcap" || end == ".zstd") other = end;
    return end == ".db3";
  };
  if (fs::is_directory(path, status)) {
    for (fs::directory_iterator at(path, status), end; !status && at != end; at.increment(status)) {
      if (judge(at->path())) files.push_back(at->path());
    }
    std::sort(files.begin(), files.end());
  } else if (fs::is_regular_file(path, status)) {
    judge(path);
    if (other.empty()) files.push_back(path);
  } else {
    return driver::Error{
        path.string() +
        ": no such bag; expected a folder made by `ros2 bag record`, or the .db3 file in it."};
  }
  if (!files.empty()) return files;
  if (other == ".mcap") {
    return driver::Error{
        path.string() +
        ": MCAP bags are not supported; convert it to sqlite3 with `ros2 bag convert`."};
  }
  if (other == ".zstd") {
    return driver::Error{
        path.string() +
        ": compressed bags are not supported; decompress it with `ros2 bag convert`."};
  }
  return driver::Error{path.string() + ": contains no bag; expected a file *.db3 in the folder."};
}

driver::Error damaged(const fs::path& file, const std::string& how) {
  return {fmt::format("{}: is damaged, or not a ROS bag ({}); copy or record it again.",
                      file.string(), how)};
}

driver::Result<OpenBag> open_bag(const fs::path& file) {
  auto data = SqliteFile::open(file);
  if (!data) return damaged(file, data.error().message);
  OpenBag bag{file, std::move(data).value(), {}};
  auto tables = bag.data.ask(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')");
  if (!tables) return damaged(file, tables.error().message);
  auto counted = tables->next();
  if (!counted) return damaged(file, counted.error().message);
  if (!*counted || tables->number(0) != 2) {
    return driver::Error{
        file.string() +
        ": is an SQLite file but not a ROS bag: the tables topics and messages are missing."};
  }
  auto rows = bag.data.ask("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  if (!rows) return damaged(file, rows.error().message);
  for (;;) {
    const auto row = rows->next();
    if (!row) return damaged(file, row.error().message);
    if (!*row) return bag;
    bag.topics.push_back({rows->number(0), driver::printable_name(rows->text(1)),
                          driver::printable_name(rows->text(2)),
                          driver::printable_name(rows->text(3))});
  }
}

/// Lists the topics of bags: "/pose (geometry_msgs/msg/PoseStamped), ...".
std::string topics_in(const std::vector<OpenBag>& bags) {
  std::vector<std::string> names;
  for (const OpenBag& bag : bags) {
    for (const TopicRow& topic : bag.topics) {
      std::string name = fmt::format("{} ({})", topic.name, topic.type);
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(std::move(name));
      }
    }
  }
  if (names.empty()) return "none";
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Returns the name of the topic to read.
driver::Result<std::string> choose_topic(const fs::path& path, const std::vector<OpenBag>& bags,
                                         BagKind kind, const std::string& asked) {
  std::vector<std::string> fitting;
  const TopicRow* named = nullptr;
  for (const OpenBag& bag : bags) {
    for (const TopicRow& topic : bag.topics) {
      if (topic.name == asked) named = &topic;
      if (topic.type == type_of(kind) &&
          std::find(fitting.begin(), fitting.end(), topic.name) == fitting.end()) {
        fitting.push_back(topic.name);
      }
    }
  }
  const auto found = [&](const std::string& name) {
    return std::find(fitting.begin(), fitting.end(), name) != fitting.end();
  };
  if (!asked.empty()) {
    if (found(asked)) return asked;
    if (named != nullptr) {
      return driver::Error{fmt::format("{}: the topic {} is of type {}; expected {}. Topics: {}.",
                                       path.string(), asked, named->type, type_of(kind),
                                       topics_in(bags))};
    }
    return driver::Error{
        fmt::format("{}: has no topic {}. Topics: {}.", path.string(), asked, topics_in(bags))};
  }
  if (fitting.size() == 1) return fitting.front();
  if (found(std::string(word_of(kind)))) return std::string(word_of(kind));
  return driver::Error{fmt::format("{}: has {} of type {}{}. Topics: {}.", path.string(),
                                   fitting.empty() ? "no topic" : "several topics", type_of(kind),
                                   fitting.empty() ? "" : "; name one", topics_in(bags))};
}

/// Adds the messages of a topic in one file, in the order in which they were received.
driver::Result<void> add_messages(const OpenBag& bag, const TopicRow& topic, BagKind kind,
                                  std::optional<std::string>& frame, std::vector<Kept>& kept) {
  auto rows = bag.data.ask(
      "SELECT timestamp, data FROM messages WHERE topic_id = ? ORDER BY timestamp, id");
  if (!rows) return damaged(bag.file, rows.error().message);
  rows->put(1, topic.id);
  for (std::size_t number = 1;; ++number) {
    const auto row = rows->next();
    if (!row) return damaged(bag.file, row.error().message);
    if (!*row) return {};
    const auto wrong = [&](std::string_view what) {
      return driver::Error{
          fmt::format("{}: message {} of {} {}", bag.file.string(), number, topic.name, what)};
    };
    const std::int64_t received_ns = rows->number(0);
    const std::span<const unsigned char> bytes = rows->bytes(1);
    const auto message = decode(kind, bytes);
    if (!message || received_ns < 0 || received_ns > kLatest) {
      constexpr std::array<unsigned char, 4> kZstd{0x28, 0xB5, 0x2F, 0xFD};  // [S RFC 8878, 3.1.1]
      if (bytes.size() > 4 && std::equal(kZstd.begin(), kZstd.end(), bytes.begin())) {
        return wrong("is compressed; decompress the bag with `ros2 bag convert`.");
      }
      return wrong(fmt::format("is not a {}: the bag is damaged; record or convert it again.",
                               type_of(kind)));
    }
    if (!message->value.allFinite()) {
      return wrong(
          "contains a number that is not finite; remove the message, or fix its publisher.");
    }
    if (!frame) frame = message->frame;
    if (*frame != message->frame) {
      return wrong(fmt::format(
          "is in the frame \"{}\", the previous ones in \"{}\"; expected one frame for all.",
          driver::printable_name(message->frame), driver::printable_name(*frame)));
    }
    if (kept.size() == kMessagesMax) {
      return wrong("exceeds the limit of 20 million messages; split the bag.");
    }
    kept.push_back({received_ns, message->stamp_ns, message->value});
  }
}

}  // namespace

bool is_bag(const std::filesystem::path& path) {
  std::error_code status;
  if (fs::is_directory(path, status)) return true;
  const std::string end = path.extension().string();
  if (end == ".db3" || end == ".mcap") return true;
  return driver::read_head(path, 15) == "SQLite format 3";
}

driver::Result<BagTopic> read_bag(const std::filesystem::path& path, BagKind kind,
                                  const std::string& topic, BagClock clock) {
  const auto files = files_of(path);
  if (!files) return files.error();
  std::vector<OpenBag> bags;
  for (const fs::path& file : *files) {
    auto bag = open_bag(file);
    if (!bag) return bag.error();
    bags.push_back(std::move(bag).value());
  }
  const auto name = choose_topic(path, bags, kind, topic);
  if (!name) return name.error();
  std::vector<Kept> kept;
  std::optional<std::string> frame;
  for (const OpenBag& bag : bags) {
    for (const TopicRow& row : bag.topics) {
      if (row.name != *name || row.type != type_of(kind)) continue;
      if (row.format != "cdr") {
        return driver::Error{fmt::format("{}: {} is serialized as \"{}\"; expected cdr.",
                                         bag.file.string(), row.name, row.format)};
      }
      if (auto added = add_messages(bag, row, kind, frame, kept); !added) return added.error();
    }
  }
  if (kept.empty()) {
    return driver::Error{fmt::format("{}: {} has no messages.", path.string(), *name)};
  }
  // The files of a bag are consecutive, so the messages are almost sorted already.
  std::stable_sort(kept.begin(), kept.end(),
                   [](const Kept& a, const Kept& b) { return a.received_ns < b.received_ns; });
  const bool stamped = std::any_of(kept.begin(), kept.end(),
                                   [](const Kept& message) { return message.stamp_ns != 0; });
  BagTopic read;
  read.name = *name;
  read.frame = *frame;
  read.clock = stamped ? clock : BagClock::kReceived;
  const auto time_of = [&read](const Kept& message) {
    return read.clock == BagClock::kStamps ? message.stamp_ns : message.received_ns;
  };
  read.start_ns = time_of(kept.front());
  std::int64_t last_ns = 0;
  for (const Kept& message : kept) {
    const std::int64_t time_ns = time_of(message);
    if (!read.samples.empty() && time_ns < last_ns) {
      return driver::Error{
          fmt::format("{}: the time of {} decreases after {:g} s, by {:g} s; record it again with "
                      "one clock, or split the bag there.",
                      path.string(), *name, 1e-9 * static_cast<double>(last_ns - read.start_ns),
                      1e-9 * static_cast<double>(last_ns - time_ns))};
    }
    if (!read.samples.empty() && time_ns == last_ns) continue;
    if (time_ns - read.start_ns > kLongest) {
      return driver::Error{fmt::format(
          "{}: {} lasts more than a day; fix its stamps, or split the bag.", path.string(), *name)};
    }
    last_ns = time_ns;
    read.samples.push_back({1e-9 * static_cast<double>(time_ns - read.start_ns), message.value});
  }
  return read;
}

}  // namespace thimble::bag
