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

/// The inputs and outputs of a command. It checks all of them before the work begins, and keeps the
/// outputs locked until their writers open them. Real-time: never from the servo thread.
class THIMBLE_EXPORT OutputPlan {
 public:
  OutputPlan() = default;
  OutputPlan(const OutputPlan&) = delete;
  OutputPlan& operator=(const OutputPlan&) = delete;
  /// Removes outputs that were not written, and folders that it made and that are empty.
  ~OutputPlan();

  /// Adds a file or folder that is read. An empty name is none.
  void read(const std::filesystem::path& path);
  /// Adds a file that is written. `option` names it to the user ("--csv"). An empty name is none.
  /// `replace` as for OutputFile::open.
  void write(const std::string& option, const std::filesystem::path& path, const OutputKind& kind,
             bool replace = false);
  /// As `write`, of a file that its writer opens before the work begins: it is only checked.
  void check(const std::string& option, const std::filesystem::path& path, const OutputKind& kind,
             bool replace = false);
  /// Adds a folder of results. `names`: files that are written there and may exist.
  void write_folder(const std::string& option, const std::filesystem::path& path,
                    const std::vector<std::string>& names);
  /// Adds a folder that must be new or empty.
  void write_new_folder(const std::string& option, const std::filesystem::path& path);

  /// Checks everything, makes and locks the folders, and opens the files. The error names the
  /// option and the remedy. May be called again after more was added.
  driver::Result<void> begin();

 private:
  enum class Use { kKeep, kCheck, kFolder, kNewFolder };
  struct Output {
    std::string option;
    std::filesystem::path path;
    const OutputKind* kind;
    Use use;
    bool replace = false;
    std::vector<std::string> names = {};  // in a folder
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
  std::vector<std::filesystem::path> made_;  // folders, the outermost first
  std::vector<std::filesystem::path> kept_;  // keys of outputs
};

}  // namespace thimble::output
