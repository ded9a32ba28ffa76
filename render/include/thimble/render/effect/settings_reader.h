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

/// Allowed values of a numeric setting.
struct NumberLimits {
  std::string_view unit;  ///< SI unit; empty for a plain number.
  double min = 0;         ///< Smallest allowed value.
  double max = 0;         ///< Largest allowed value.
  /// True if the setting must be given; false: its current value is the default.
  bool required = false;
  bool whole = false;  ///< True if only whole numbers are allowed; limits of at most 2^53.
};

/// Interface through which an effect reads its settings. The app implements it for scene files;
/// tests and programs implement it in code. So an effect lists its settings once and is independent
/// of the file format. The reader records an invalid value, keeps a harmless one and continues.
/// Real-time: never from the servo thread.
class THIMBLE_EXPORT SettingsReader {
 public:
  SettingsReader() = default;
  SettingsReader(const SettingsReader&) = delete;
  SettingsReader& operator=(const SettingsReader&) = delete;
  virtual ~SettingsReader() = default;

  /// Returns whether a setting is given.
  virtual bool has(std::string_view key) = 0;
  /// Reads a finite number within limits.
  virtual void number(std::string_view key, double& value, const NumberLimits& limits) = 0;
  /// Reads three finite numbers, each within limits.
  virtual void vector(std::string_view key, Eigen::Vector3d& value, const NumberLimits& limits) = 0;
  /// Reads one of several words as its index in `names`; if it is missing, `value` is unchanged.
  virtual void choice(std::string_view key, std::size_t& value,
                      const std::vector<std::string_view>& names) = 0;
  /// Reads a text; if it is missing, `value` is unchanged. Texts cannot be set by default.
  virtual void text(std::string_view key, std::string&) { reject(key, "cannot be set here"); }
  /// Reads the name of an existing file; relative names start in the scene's folder.
  virtual void file(std::string_view key, std::filesystem::path& value) = 0;
  /// Reads a list of maps with at least one entry; calls `read` for each.
  virtual void list(std::string_view key, const std::function<void(SettingsReader&)>& read) = 0;
  /// Records a mistake that only the effect can detect, such as two incompatible settings.
  /// `sentence` has no period: "static friction must not be below sliding friction".
  virtual void reject(std::string_view key, const std::string& sentence) = 0;
  /// Sets the reason (second argument) why a setting is not read ("needs hold"). If the setting is
  /// given, a reader of files reports this sentence instead of an unknown key. Does nothing by
  /// default.
  virtual void explain_unused(std::string_view, const std::string&) {}
};

}  // namespace thimble::render
