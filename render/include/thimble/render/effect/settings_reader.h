#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::render {

/// Which numbers a setting takes.
struct NumberLimits {
  std::string_view unit;  ///< SI; empty for a plain number.
  double least = 0;       ///< Smallest that is allowed.
  double most = 0;        ///< Largest that is allowed.
  bool required = false;  ///< False: the value that the setting already has is its default.
  bool whole = false;     ///< Only whole numbers; limits of at most 2^53.
};

/// Asks whoever knows for the settings of an effect. A scene file answers through the app's reader;
/// tests and programs answer by hand. So an effect names its settings once, and knows no file
/// format. A wrong answer is noted by the reader, which leaves a harmless value and goes on.
/// Real-time: never from the servo thread.
class THIMBLE_EXPORT SettingsReader {
 public:
  SettingsReader() = default;
  SettingsReader(const SettingsReader&) = delete;
  SettingsReader& operator=(const SettingsReader&) = delete;
  virtual ~SettingsReader() = default;

  /// Returns whether a setting is given at all.
  virtual bool has(std::string_view key) = 0;
  /// Reads a finite number within limits.
  virtual void number(std::string_view key, double& value, const NumberLimits& limits) = 0;
  /// Reads three finite numbers, each within limits.
  virtual void vector(std::string_view key, Eigen::Vector3d& value, const NumberLimits& limits) = 0;
  /// Reads one of several words and gives its number; absent leaves `value`.
  virtual void choice(std::string_view key, std::size_t& value,
                      const std::vector<std::string_view>& names) = 0;
  /// Reads the name of an existing file; relative names begin beside the scene.
  virtual void file(std::string_view key, std::filesystem::path& value) = 0;
  /// Reads a list of maps with at least one entry; calls `read` for each.
  virtual void list(std::string_view key, const std::function<void(SettingsReader&)>& read) = 0;
  /// Notes a mistake that only the effect can see, such as two settings that do not go together.
  /// `sentence` has no dot: "static friction must not be below sliding friction".
  virtual void reject(std::string_view key, const std::string& sentence) = 0;
};

}  // namespace thimble::render
