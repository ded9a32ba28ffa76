#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace thimble::bringup {

/// The lines of a YAML text in which the rest of a line can be replaced from the start of a value;
/// all other lines are unchanged. Real-time: never from the servo thread.
class FileLines {
 public:
  explicit FileLines(const std::string& text) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines_.push_back(line);
  }

  bool exchange(const YAML::Node& value, const std::string& by) {
    const YAML::Mark mark = value.Mark();
    const auto at = static_cast<std::size_t>(mark.line);
    const auto column = static_cast<std::size_t>(mark.column);
    if (mark.is_null() || at >= lines_.size() || column > lines_[at].size()) return false;
    lines_[at] = lines_[at].substr(0, column) + by;
    return true;
  }

  /// Adds a line after that of a value, with the indentation of its key.
  bool add_behind(const YAML::Node& value, const std::string& line) {
    const YAML::Mark mark = value.Mark();
    const auto at = static_cast<std::size_t>(mark.line);
    if (mark.is_null() || at >= lines_.size()) return false;
    const std::size_t indent = lines_[at].find_first_not_of(' ');
    if (indent == std::string::npos) return false;
    added_.emplace_back(at, std::string(indent, ' ') + line);
    return true;
  }

  /// Adds lines before that of a key, with its indentation.
  bool add_before(const YAML::Node& key, const std::vector<std::string>& lines) {
    const YAML::Mark mark = key.Mark();
    const auto at = static_cast<std::size_t>(mark.line);
    if (mark.is_null() || at == 0 || at >= lines_.size()) return false;
    for (const std::string& line : lines) {
      added_.emplace_back(at - 1, std::string(static_cast<std::size_t>(mark.column), ' ') + line);
    }
    return true;
  }

  std::string text() const {
    std::string whole;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      whole += lines_[i] + '\n';
      for (const auto& [at, line] : added_) {
        if (at == i) whole += line + '\n';
      }
    }
    return whole;
  }

 private:
  std::vector<std::string> lines_;
  std::vector<std::pair<std::size_t, std::string>> added_;
};

}  // namespace thimble::bringup
