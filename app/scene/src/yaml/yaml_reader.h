#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"
#include "yaml/key_log.h"

namespace thimble::scene {

// Strict reading of YAML files. Every mistake becomes one sentence with file, line, what was
// expected and what was found:
//   elephant.yaml:12: stiffness: expected a number from 0 to 1e+05 N/m, found "stiff".
// A getter that meets a mistake notes it and returns a harmless value, so one reading finds several
// mistakes; YamlFile::finish tells them. Nothing here throws. Real-time: never from the servo
// thread.

/// Collects the mistakes of one file; keeps the first few, for a reader mends them from the top.
class YamlMistakes {
 public:
  static constexpr std::size_t kKept = 5;

  explicit YamlMistakes(std::string file_name, KeyLog* keys = nullptr)
      : file_name_(std::move(file_name)), keys_(keys) {}

  /// Returns where the keys that are asked for are noted; nullptr: nowhere.
  KeyLog* keys() const noexcept { return keys_; }

  /// Notes a mistake at a line (counted from 1; 0 for the file as a whole). `sentence` has no dot.
  void add(int line, const std::string& sentence);

  /// Notes what is read nevertheless, but should be written in another way.
  void warn(int line, const std::string& sentence);

  /// Returns what was warned of, a sentence each with file and line.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Returns whether nothing was noted.
  bool empty() const { return count_ == 0; }

  /// Returns the mistakes kept, one per line, and how many more there are.
  std::string text() const;

 private:
  std::string file_name_;
  KeyLog* keys_;
  std::vector<std::string> sentences_, warnings_;
  std::size_t count_ = 0;
};

/// One map of a YAML file. Copies share what was asked of it, so that `finish` knows.
class YamlMap {
 public:
  /// The map at `node`; notes a mistake if it is none, or if a key stands twice in it. `name` is
  /// the key it stands under.
  YamlMap(const YAML::Node& node, std::string_view name, int line,
          std::shared_ptr<YamlMistakes> mistakes);

  /// Returns whether a key is there (and counts it as known).
  bool has(std::string_view key);

  /// Reads a finite number from `min` to `max` (in `unit`, told to the reader; may be empty).
  /// A mistake gives `min`.
  double require_number(std::string_view key, std::string_view unit, double min, double max);

  /// Reads a number like `require_number`, or gives `fallback` if the key is absent.
  double optional_number(std::string_view key, double fallback, std::string_view unit, double min,
                         double max);

  /// Reads a list of three numbers, each from `min` to `max`. A mistake gives zeros.
  Eigen::Vector3d require_vector3(std::string_view key, std::string_view unit, double min,
                                  double max);

  /// Reads a list like `require_vector3`, or gives `fallback` if the key is absent.
  Eigen::Vector3d optional_vector3(std::string_view key, const Eigen::Vector3d& fallback,
                                   std::string_view unit, double min, double max);

  /// Reads a list of turns `[[x, 90], [z, -45]]`, done one after the other about the fixed axes of
  /// the outer frame, each in degrees. Gives identity if the key is absent or wrong.
  Eigen::Matrix3d optional_rotation(std::string_view key);

  /// Reads a text that is not empty. A mistake gives "".
  std::string require_string(std::string_view key);

  /// Reads a text, or gives `fallback` if the key is absent.
  std::string optional_string(std::string_view key, std::string_view fallback);

  /// Reads one of the words of `choices` and gives its number. A mistake gives 0.
  std::size_t require_choice(std::string_view key, const std::vector<std::string_view>& choices);

  /// Reads one of the words of `choices` like `require_choice`, or gives `fallback` if the key is
  /// absent.
  std::size_t optional_choice(std::string_view key, std::size_t fallback,
                              const std::vector<std::string_view>& choices);

  /// Reads one of the words of `choices`, or a list of several, and gives their numbers in the
  /// order of the file; `fallback` if the key is absent. A mistake gives none.
  std::vector<std::size_t> optional_choices(std::string_view key,
                                            const std::vector<std::size_t>& fallback,
                                            const std::vector<std::string_view>& choices);

  /// Reads `true` or `false`, or gives `fallback` if the key is absent or wrong.
  bool optional_bool(std::string_view key, bool fallback);

  /// Reads a map. A mistake gives an empty one, whose getters keep quiet.
  YamlMap require_map(std::string_view key);

  /// Reads a list of maps with at least one entry. A mistake gives an empty list.
  std::vector<YamlMap> require_maps(std::string_view key);

  /// Notes a mistake that only the caller can see, at the line of `key` (or of this map).
  void reject(std::string_view key, const std::string& sentence);

  /// Notes each key that nobody asked for, with the nearest known key as a suggestion.
  void finish();

  /// Names the place of this map in the reference of keys: "effects[] friction: bristle".
  void set_place(std::string place) { place_ = std::move(place); }

  /// Returns the line (from 1) at which a key stands, or 0 if it is absent.
  int key_line(std::string_view key) const;

  /// Returns the line (from 1) at which this map begins.
  int line() const { return line_; }

 private:
  struct Entry {
    std::string key;
    int line = 0;
    YAML::Node value;
  };

  const Entry* find(std::string_view key, bool required);
  void note(std::string_view key, std::string what, bool required, std::string fallback = {});
  void expected(const Entry& entry, const std::string& what);
  bool read_number(const Entry& entry, const YAML::Node& node, const std::string& what, double min,
                   double max, double& number);

  std::vector<Entry> entries_;
  std::vector<std::string> asked_;
  std::shared_ptr<YamlMistakes> mistakes_;
  int line_ = 0;
  std::string place_;
  bool quiet_ = false;  // this map could not be read: do not blame its keys as well
};

/// One YAML file whose outermost value is a map.
class YamlFile {
 public:
  /// Reads a file. Fails on a file that cannot be read, that is empty or beyond 4 MB, or that is
  /// not YAML (with line).
  static driver::Result<YamlFile> load(const std::filesystem::path& file);

  /// Reads YAML from a text; `name` stands in for the file's name in messages.
  /// `keys` notes what is asked of it.
  static driver::Result<YamlFile> parse(const std::string& text, const std::string& name,
                                        KeyLog* keys = nullptr);

  /// Returns the outermost map.
  YamlMap& root() { return root_; }

  /// Returns whether everything read so far was right. Call `YamlMap::finish` on each map before.
  /// Warns the user of keys that have got another name, once in a process.
  driver::Result<void> finish() const;

  /// Returns what the user is warned of, a sentence each.
  const std::vector<std::string>& warnings() const noexcept { return mistakes_->warnings(); }

 private:
  YamlFile(YamlMap root, std::shared_ptr<YamlMistakes> mistakes)
      : root_(std::move(root)), mistakes_(std::move(mistakes)) {}

  YamlMap root_;
  std::shared_ptr<YamlMistakes> mistakes_;
};

}  // namespace thimble::scene
