#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "yaml/key_log.h"
#include "yaml/yaml_node.h"
#include "yaml/yaml_text.h"

namespace thimble::scene {

// Strict reading of YAML files. Every mistake becomes one sentence with file, line, expected and
// found value:
//   elephant.yaml:12: stiffness: expected a number from 0 to 1e+05 N/m, found "stiff".
// A getter that finds a mistake records it and returns a harmless value, so one reading finds
// several mistakes; YamlFile::finish returns them. No exceptions are thrown. Real-time: none of
// these functions may be called from the servo thread.

/// Collects the mistakes of one file and keeps the first five. There are two kinds: invalid values,
/// and failed checks between values. Checks are reported only if all values are valid, because an
/// invalid value is replaced by a harmless one, with which a check would mislead.
class YamlMistakes {
 public:
  static constexpr std::size_t kKept = 5;

  explicit YamlMistakes(std::string file_name, KeyLog* keys = nullptr)
      : file_name_(std::move(file_name)), keys_(keys) {}

  /// Sets the misplaced characters of the text, in the order of the text. A mistake in the line of
  /// one is reported as that character; if it is in indentation, no other mistakes are reported.
  void set_misplaced(std::vector<TextFlaw> misplaced) { misplaced_ = std::move(misplaced); }

  /// Sets names of places that messages use instead of file and line, for a text that a program
  /// wrote: one per line (from 1), and in entry 0 that of the whole text.
  void set_places(std::vector<std::string> places) { places_ = std::move(places); }

  /// Returns the name of the place of a line: "object 2 'cube'", or the file and the line.
  std::string place_of(int line) const;

  /// Returns the log of requested keys; nullptr if there is none.
  KeyLog* keys() const noexcept { return keys_; }

  /// Adds an invalid value at a line (from 1; 0 for the whole file). `sentence` has no period.
  void add(int line, const std::string& sentence);

  /// Adds a syntax error at a line. If misplaced characters precede it, they are reported instead.
  void add_syntax_error(int line, const std::string& sentence);

  /// Adds a failed check between valid values. `line` and `sentence` as above.
  void add_check(int line, const std::string& sentence);

  /// Ignores all checks, because values of another file that they need could not be read.
  void ignore_checks() { checks_ignored_ = true; }

  /// Returns whether further invalid values would only be counted.
  bool full() const { return values_.count >= kKept; }

  /// Adds a warning about content that is accepted but should be written differently.
  void warn(int line, const std::string& sentence);

  /// Returns the warnings, one sentence each with file and line.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Notes a file that a value of the text names, once.
  void note_file(const std::filesystem::path& file);

  /// Returns the noted files, in the order of the text.
  const std::vector<std::filesystem::path>& files() const noexcept { return files_; }

  /// Returns whether there are no mistakes.
  bool empty() const {
    return flaws_.count == 0 && values_.count == 0 && (checks_ignored_ || checks_.count == 0);
  }

  /// Returns the mistakes kept, one per line, and the number of further ones.
  std::string text() const;

 private:
  struct Kind {
    std::vector<std::string> sentences;
    std::size_t count = 0;
  };

  void add_to(Kind& kind, int line, const std::string& sentence);
  std::string in_place(int line, const std::string& sentence) const;
  void add_flaw(const TextFlaw& flaw);

  std::string file_name_;
  std::vector<std::string> places_;
  KeyLog* keys_;
  std::vector<TextFlaw> misplaced_;
  std::vector<std::string> warnings_;
  std::vector<std::filesystem::path> files_;
  Kind flaws_, values_, checks_;
  bool flaws_explain_all_ = false;
  bool checks_ignored_ = false;
};

/// Map of a YAML file. Copies share the record of requested keys for `finish`.
class YamlMap {
 public:
  /// Constructs the map at `node`. Records a mistake if the node is not a map, or if a key occurs
  /// twice. `name` is the key of the map.
  YamlMap(const YamlNode& node, std::string_view name, int line,
          std::shared_ptr<YamlMistakes> mistakes);

  /// Returns whether a key is present (and marks it as known).
  bool has(std::string_view key);

  /// Returns a finite number from `min` to `max`, in `unit`, which is used for messages and may be
  /// empty. A mistake returns `min`.
  double require_number(std::string_view key, std::string_view unit, double min, double max);

  /// Returns a number as `require_number`, or `fallback` if the key is absent.
  double optional_number(std::string_view key, double fallback, std::string_view unit, double min,
                         double max);

  /// Returns an integer from `min` to `max`, at most 2^53: digits, or a decimal number without a
  /// fraction. A mistake returns `min`.
  std::int64_t require_whole(std::string_view key, std::string_view unit, std::int64_t min,
                             std::int64_t max);

  /// Returns an integer as `require_whole`, or `fallback` if the key is absent.
  std::int64_t optional_whole(std::string_view key, std::int64_t fallback, std::string_view unit,
                              std::int64_t min, std::int64_t max);

  /// Returns a list of three integers, each from `min` to `max`. A mistake returns zeros.
  std::array<std::int64_t, 3> require_three_whole(std::string_view key, std::string_view unit,
                                                  std::int64_t min, std::int64_t max);

  /// Returns a list as `require_three_whole`, or `fallback` if the key is absent.
  std::array<std::int64_t, 3> optional_three_whole(std::string_view key,
                                                   const std::array<std::int64_t, 3>& fallback,
                                                   std::string_view unit, std::int64_t min,
                                                   std::int64_t max);

  /// Returns a list of three signs, each 1 or -1. A mistake returns 1 for each.
  std::array<std::int64_t, 3> require_signs(std::string_view key);

  /// Returns a list of three numbers, each from `min` to `max`. A mistake returns zeros.
  Eigen::Vector3d require_vector3(std::string_view key, std::string_view unit, double min,
                                  double max);

  /// Returns a list as `require_vector3`, or `fallback` if the key is absent.
  Eigen::Vector3d optional_vector3(std::string_view key, const Eigen::Vector3d& fallback,
                                   std::string_view unit, double min, double max);

  /// Returns the rotation given by a list `[[x, 90], [z, -45]]`: rotations by degrees, one after
  /// the other, about the fixed axes of the outer frame. Returns the identity if the key is absent
  /// or invalid.
  Eigen::Matrix3d optional_rotation(std::string_view key);

  /// Returns a non-empty text. A mistake returns "".
  std::string require_string(std::string_view key);

  /// Returns a text, or `fallback` if the key is absent.
  std::string optional_string(std::string_view key, std::string_view fallback);

  /// Returns the index of a word in `choices`. A mistake returns 0.
  std::size_t require_choice(std::string_view key, const std::vector<std::string_view>& choices);

  /// Returns an index as `require_choice`, or `fallback` if the key is absent.
  std::size_t optional_choice(std::string_view key, std::size_t fallback,
                              const std::vector<std::string_view>& choices);

  /// Returns the indices in `choices` of one word or a list of words, in the order of the file;
  /// `fallback` if the key is absent. A mistake returns an empty list.
  std::vector<std::size_t> optional_choices(std::string_view key,
                                            const std::vector<std::size_t>& fallback,
                                            const std::vector<std::string_view>& choices);

  /// Returns `true` or `false`, or `fallback` if the key is absent or invalid.
  bool optional_bool(std::string_view key, bool fallback);

  /// Returns a map. A mistake returns an empty one, whose getters report no mistakes.
  YamlMap require_map(std::string_view key);

  /// Returns a list of maps with at least one entry. A mistake returns an empty list.
  std::vector<YamlMap> require_maps(std::string_view key);

  /// Calls `visit` with each map that `require_maps` would return. Each is made for its call, so a
  /// long list takes the memory of one.
  void visit_maps(std::string_view key, const std::function<void(YamlMap&)>& visit);

  /// Returns the number of entries of a list; 0 if the key is absent or its value is not a list.
  std::size_t list_size(std::string_view key) const;

  /// Adds a failed check of this map's values against each other or against others, at the line of
  /// `key` (or of this map). It is reported only if all values of the file are valid.
  void reject(std::string_view key, const std::string& sentence);

  /// Adds an invalid value that only the caller can detect, at the line of `key` (or of this map).
  void refuse(std::string_view key, const std::string& sentence);

  /// Notes a file that a value of this map names, for `YamlFile::files`.
  void note_file(const std::filesystem::path& file) { mistakes_->note_file(file); }

  /// Ignores the failed checks of the whole file; see YamlMistakes::ignore_checks.
  void ignore_checks() { mistakes_->ignore_checks(); }

  /// Adds that this map has none of several keys, as an invalid value. Returns false and adds
  /// nothing if the map could not be read, because that is reported already, or if keys are logged.
  bool refuse_absence(const std::string& sentence) {
    if (quiet_ || mistakes_->keys() != nullptr) return false;
    refuse("", sentence);
    return true;
  }

  /// Sets the reason why a key of the reference is not used in this map. If the key is present and
  /// was not requested, `finish` reports this sentence ("needs hold") instead of an unknown key.
  void explain_unused(std::string_view key, std::string sentence) {
    unused_.emplace_back(key, std::move(sentence));
  }

  /// Records each key that was not requested as a mistake, with the nearest known key as a
  /// suggestion.
  void finish();

  /// Makes the getters of three values expect `motors` of them (1 to 3), one per motor of the arm,
  /// and return zeros after them (signs: ones).
  void set_motors(int motors) { motors_ = static_cast<std::size_t>(motors); }

  /// Sets the place of this map in the reference of keys: "effects[] friction: bristle".
  void set_place(std::string place) { place_ = std::move(place); }

  /// Returns the line (from 1) of a key, or 0 if it is absent.
  int key_line(std::string_view key) const;

  /// Returns the first line (from 1) of this map.
  int line() const { return line_; }

  /// Returns the place of this map as in messages (YamlMistakes::place_of).
  std::string name_of_place() const { return mistakes_->place_of(line_); }

 private:
  struct Entry {
    std::string key;
    int line = 0;
    YamlNode value;
  };

  const Entry* find(std::string_view key, bool required);
  /// Whether requested keys are logged; only then the arguments of `note` are made.
  bool logs_keys() const noexcept { return mistakes_->keys() != nullptr; }
  void note(std::string_view key, KeyValues values, std::string what, bool required,
            std::string fallback = {});
  void expected(const Entry& entry, const std::string& what);
  bool read_number(const Entry& entry, const YamlNode& node, std::string_view unit, double min,
                   double max, double& number);
  bool read_whole(const Entry& entry, const YamlNode& node, const std::string& what,
                  std::int64_t min, std::int64_t max, std::int64_t& number);
  std::size_t list_length() const noexcept { return motors_ == 0 ? 3 : motors_; }
  const Entry* find_three(std::string_view key, std::string_view what);
  int line_for(std::string_view key);

  std::vector<Entry> entries_;
  std::vector<std::string> requested_;
  std::vector<std::pair<std::string, std::string>> unused_;  ///< Keys and sentences.
  std::shared_ptr<YamlMistakes> mistakes_;
  int line_ = 0;
  std::string place_;
  std::size_t motors_ = 0;  // Length of lists with one value per motor; 0: lists have three.
  bool quiet_ = false;      // The map could not be read, so its keys are not reported.
};

/// YAML file whose root is a map.
class THIMBLE_EXPORT YamlFile {
 public:
  /// Reads a file. Fails if the file cannot be read, is empty or larger than 16 MB, is not UTF-8
  /// (with line and column), or is not YAML (with line).
  static driver::Result<YamlFile> load(const std::filesystem::path& file);

  /// Parses YAML from a text; `name` is used as the file name in messages. `keys`, if not null,
  /// logs the requested keys. `places`, if not empty: see YamlMistakes::set_places.
  static driver::Result<YamlFile> parse(const std::string& text, const std::string& name,
                                        KeyLog* keys = nullptr,
                                        std::vector<std::string> places = {});

  /// Returns the root map.
  YamlMap& root() { return root_; }

  /// Returns the mistakes found so far as an error, or success. Call `YamlMap::finish` on each map
  /// before. Warns the user of renamed keys, once per process.
  driver::Result<void> finish() const;

  /// Returns the warnings to the user, one sentence each.
  const std::vector<std::string>& warnings() const noexcept { return mistakes_->warnings(); }

  /// Returns the files that its values name (`YamlMap::note_file`), each once.
  const std::vector<std::filesystem::path>& files() const noexcept { return mistakes_->files(); }

 private:
  YamlFile(YamlMap root, std::shared_ptr<YamlMistakes> mistakes)
      : root_(std::move(root)), mistakes_(std::move(mistakes)) {}

  YamlMap root_;
  std::shared_ptr<YamlMistakes> mistakes_;
};

}  // namespace thimble::scene
