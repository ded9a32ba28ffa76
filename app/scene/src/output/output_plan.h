#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "output/folder_lock.h"
#include "output/output_kind.h"
#include "output/output_path.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// Inputs and outputs of a command. Checks all of them before the work begins, and keeps the
/// outputs locked until their writers open them. Real-time: never from the servo thread.
class THIMBLE_EXPORT OutputPlan {
 public:
  OutputPlan() = default;
  OutputPlan(const OutputPlan&) = delete;
  OutputPlan& operator=(const OutputPlan&) = delete;
  /// Removes unwritten outputs, and empty folders that it created.
  ~OutputPlan();

  /// Adds an input file or folder. An empty name is ignored.
  void read(const std::filesystem::path& path);
  /// Adds an output file. `option` is its option, for messages ("--csv"). An empty name is ignored.
  /// `replace` as for OutputFile::open.
  void write(const std::string& option, const std::filesystem::path& path, const OutputKind& kind,
             bool replace = false);
  /// As `write`, for a file that its writer opens before the work begins: it is checked only.
  void check(const std::string& option, const std::filesystem::path& path, const OutputKind& kind,
             bool replace = false);
  /// Adds a folder of results. `names`: files written there, which may exist. `plots`: true if
  /// plots are drawn there, whose data need a subfolder (kDataFolder).
  void write_folder(const std::string& option, const std::filesystem::path& path,
                    const std::vector<std::string>& names, bool plots = true);
  /// Adds a folder that must be new or empty.
  void write_new_folder(const std::string& option, const std::filesystem::path& path);

  /// Checks all entries, creates and locks the folders, and opens the files. The error names the
  /// option and the fix. May be called again after more entries were added.
  driver::Result<void> begin();

 private:
  enum class Use { kKeep, kCheck, kFolder, kNewFolder };
  struct Output {
    std::string option;
    std::filesystem::path path;
    const OutputKind* kind;
    Use use;
    bool replace = false;
    std::vector<std::string> names = {};  // Names in a folder.
    bool plots = false;                   // Plots are drawn in the folder.
    bool begun = false;
  };
  struct Place {
    std::string option;
    std::filesystem::path path;
    OutputPath found;
  };

  driver::Result<void> make_folder(const Output& output);
  driver::Result<void> add_places(const Output& output, std::vector<Place>& places) const;
  driver::Result<void> compare(const std::vector<Place>& places) const;

  std::vector<std::filesystem::path> inputs_;
  std::vector<Output> outputs_;
  std::vector<FolderLock> locks_;
  std::vector<std::filesystem::path> made_;      // Created folders, outermost first.
  std::vector<std::filesystem::path> reserved_;  // Keys of reserved outputs.
};

}  // namespace thimble::output
