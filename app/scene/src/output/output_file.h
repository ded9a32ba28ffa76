#pragma once

#include <filesystem>
#include <string_view>

#include "output/output_kind.h"
#include "output/output_path.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// A file that is being written: beside its target and locked, until it is complete. Devices and
/// pipes are written directly. Real-time: never from the servo thread.
class THIMBLE_EXPORT OutputFile {
 public:
  /// Opens it, empty. `replace`: the user allows that an existing file of a kind that is not simply
  /// replaced (Existing::kReplaceForced) is. Fails if the folder does not exist or cannot be
  /// written to, if a file of another kind has the name, or if another writer has it. An output
  /// that an OutputPlan of this process keeps for its writer is taken over.
  static driver::Result<OutputFile> open(const std::filesystem::path& path, const OutputKind& kind,
                                         bool replace = false);
  /// Opens another part of this output, which takes the place of what was published of it.
  driver::Result<OutputFile> open_again(const OutputKind& kind) const;
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// Removes what was not published.
  ~OutputFile();

  /// Returns the name to write to, for libraries that open files themselves: the part, or the
  /// device.
  const std::filesystem::path& part() const noexcept { return part_; }
  /// Returns the file that it becomes, links followed.
  const std::filesystem::path& target() const noexcept { return place_.target; }
  /// Returns the descriptor, which is open for writing (a file: and reading).
  int descriptor() const noexcept { return descriptor_; }
  /// Returns whether this is a device or pipe.
  bool stream() const noexcept { return place_.stream; }

  /// Writes bytes at the end.
  driver::Result<void> write(std::string_view bytes);
  /// Gives the part its name. It stays open, and locked against other writers but not readers.
  driver::Result<void> publish();
  /// Publishes the file, unless that was done, and closes it. The error says what is wrong.
  driver::Result<void> commit();
  /// Returns an error of a library that names the part, with the output's own name.
  driver::Error named(const driver::Error& error) const;

 private:
  OutputFile(std::filesystem::path name, OutputPath place)
      : name_(std::move(name)), place_(std::move(place)) {}
  driver::Result<void> open_stream();
  driver::Result<void> open_part(const OutputKind& kind);
  void close_now() noexcept;

  std::filesystem::path name_;  // as the user gave it
  OutputPath place_;
  std::filesystem::path part_;
  int descriptor_ = -1;
  bool published_ = false;
};

/// Fails if what exists under a name may not be replaced by an output of this kind, or is being
/// written. `path` is the name as the user gave it.
THIMBLE_EXPORT driver::Result<void> check_replaceable(const std::filesystem::path& path,
                                                      const OutputPath& place,
                                                      const OutputKind& kind, bool replace);

/// Opens an output and keeps it for the writer in this process that opens it next. Returns the key
/// for `release_output`. Fails as OutputFile::open.
driver::Result<std::filesystem::path> reserve_output(const std::filesystem::path& path,
                                                     const OutputKind& kind, bool replace);

/// Removes an output that is still kept.
void release_output(const std::filesystem::path& key);

/// Writes a whole file. Fails as OutputFile::open, or says why it could not be written.
THIMBLE_EXPORT driver::Result<void> write_file(const std::filesystem::path& path,
                                               const OutputKind& kind, std::string_view bytes);

}  // namespace thimble::output
