#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "yaml/key_log.h"
#include "yaml/yaml_text.h"

namespace thimble::scene {

// Strict reading of YAML files. Every mistake becomes one sentence with file, line, what was
// expected and what was found:
//   elephant.yaml:12: stiffness: expected a number from 0 to 1e+05 N/m, found "stiff".
// A getter that meets a mistake notes it and returns a harmless value, so one reading finds several
// mistakes; YamlFile::finish tells them. Nothing here throws. Real-time: never from the servo
// thread.

/// Collects the mistakes of one file and keeps the first few. There are two kinds: values that are
/// wrong by themselves, and checks that compare values. Checks are reported only if all values are
/// right: a wrong value is replaced by a harmless one, so a check against it would mislead.
class YamlMistakes {
 public:
  static constexpr std::size_t kKept = 5;

  explicit YamlMistakes(std::string file_name, KeyLog* keys = nullptr)
      : file_name_(std::move(file_name)), keys_(keys) {}

  /// Stores misplaced characters of the text, in the order of the text. A mistake in the line of
  /// one is reported as that character; if it is in indentation, nothing else is reported.
  void set_misplaced(std::vector<TextFlaw> misplaced) { misplaced_ = std::move(misplaced); }

  /// Returns where the keys that are asked for are noted; nullptr: nowhere.
  KeyLog* keys() const noexcept { return keys_; }

  /// Adds a wrong value at a line (counted from 1; 0 for the file as a whole). `sentence` has no
  /// dot.
  void add(int line, const std::string& sentence);

  /// Adds a syntax error at a line. If misplaced characters precede it, they are reported instead.
  void add_syntax_error(int line, const std::string& sentence);

  /// Adds a failed check between values that are right by themselves, as above.
  void add_check(int line, const std::string& sentence);

  /// Drops all checks, because values of another file that they need could not be read.
  void ignore_checks() { checks_ignored_ = true; }

  /// Returns whether further wrong values would only be counted.
  bool full() const { return values_.count >= kKept; }

  /// Notes what is read nevertheless, but should be written in another way.
  void warn(int line, const std::string& sentence);

  /// Returns what was warned of, a sentence each with file and line.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Returns whether nothing is wrong.
  bool empty() const {
    return flaws_.count == 0 && values_.count == 0 && (checks_ignored_ || checks_.count == 0);
  }

  /// Returns the mistakes kept, one per line, and how many more there are.
  std::string text() const;

 private:
  struct Kind {
    std::vector<std::string> sentences;
    std::size_t count = 0;
  };

  void add_to(Kind& kind, int line, const std::string& sentence);
  void add_flaw(const TextFlaw& flaw);

  std::string file_name_;
  KeyLog* keys_;
  std::vector<TextFlaw> misplaced_;
  std::vector<std::string> warnings_;
  Kind flaws_, values_, checks_;
  bool flaws_explain_all_ = false;
  bool checks_ignored_ = false;
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

  /// Reads a whole number from `min` to `max`, at most 2^53: digits, or a decimal number without a
  /// fraction. A mistake gives `min`.
  std::int64_t require_whole(std::string_view key, std::string_view unit, std::int64_t min,
                             std::int64_t max);

  /// Reads a whole number like `require_whole`, or gives `fallback` if the key is absent.
  std::int64_t optional_whole(std::string_view key, std::int64_t fallback, std::string_view unit,
                              std::int64_t min, std::int64_t max);

  /// Reads a list of three whole numbers, each from `min` to `max`. A mistake gives zeros.
  std::array<std::int64_t, 3> require_three_whole(std::string_view key, std::string_view unit,
                                                  std::int64_t min, std::int64_t max);

  /// Reads a list like `require_three_whole`, or gives `fallback` if the key is absent.
  std::array<std::int64_t, 3> optional_three_whole(std::string_view key,
                                                   const std::array<std::int64_t, 3>& fallback,
                                                   std::string_view unit, std::int64_t min,
                                                   std::int64_t max);

  /// Reads a list of three signs, each 1 or -1. A mistake gives 1.
  std::array<std::int64_t, 3> require_signs(std::string_view key);

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

  /// Adds a failed check of this map's values against each other or against others, at the line of
  /// `key` (or of this map). It is reported only if all values of the file are right.
  void reject(std::string_view key, const std::string& sentence);

  /// Adds a wrong value that only the caller can detect, at the line of `key` (or of this map).
  void refuse(std::string_view key, const std::string& sentence);

  /// Drops the failed checks of the whole file; see YamlMistakes::ignore_checks.
  void ignore_checks() { mistakes_->ignore_checks(); }

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
  bool read_whole(const Entry& entry, const YAML::Node& node, const std::string& what,
                  std::int64_t min, std::int64_t max, std::int64_t& number);
  const Entry* find_three(std::string_view key, std::string_view what);
  int line_for(std::string_view key);

  std::vector<Entry> entries_;
  std::vector<std::string> asked_;
  std::shared_ptr<YamlMistakes> mistakes_;
  int line_ = 0;
  std::string place_;
  bool quiet_ = false;  // this map could not be read: do not blame its keys as well
};

/// One YAML file whose outermost value is a map.
class THIMBLE_EXPORT YamlFile {
 public:
  /// Reads a file. Fails on a file that cannot be read, that is empty or beyond 4 MB, that is not
  /// UTF-8 (with line and column), or that is not YAML (with line).
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
