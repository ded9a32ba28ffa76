#pragma once

#include <filesystem>
#include <string_view>

#include "output/output_kind.h"
#include "output/output_path.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// File that is being written: next to its target and locked, until it is complete. Devices and
/// pipes are written directly. Real-time: never from the servo thread.
class THIMBLE_EXPORT OutputFile {
 public:
  /// Opens an empty output. `replace` allows overwriting an existing file of a kind with
  /// Existing::kReplaceForced. Fails if the folder does not exist or is not writable, if a file of
  /// another kind has the name, or if another writer has locked it. Takes over an output that an
  /// OutputPlan of this process has reserved.
  static driver::Result<OutputFile> open(const std::filesystem::path& path, const OutputKind& kind,
                                         bool replace = false);
  /// Opens another part of this output, which replaces the part published before.
  driver::Result<OutputFile> open_again(const OutputKind& kind) const;
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// Removes an unpublished file.
  ~OutputFile();

  /// Returns the name to write to, for libraries that open files themselves: that of the part or
  /// the device.
  const std::filesystem::path& part() const noexcept { return part_; }
  /// Returns the final path, with links resolved.
  const std::filesystem::path& target() const noexcept { return place_.target; }
  /// Returns the descriptor, which is open for writing, and for reading if it is a file.
  int descriptor() const noexcept { return descriptor_; }
  /// Returns whether this is a device or pipe.
  bool stream() const noexcept { return place_.stream; }

  /// Appends bytes.
  driver::Result<void> write(std::string_view bytes);
  /// Renames the part to the final name. It stays open, and locked against other writers but not
  /// readers.
  driver::Result<void> publish();
  /// Publishes the file if it is not published yet, and closes it. The error describes the problem.
  driver::Result<void> commit();
  /// Returns an error of a library with the name of the part replaced by that of the output.
  driver::Error named(const driver::Error& error) const;

 private:
  OutputFile(std::filesystem::path name, OutputPath place)
      : name_(std::move(name)), place_(std::move(place)) {}
  driver::Result<void> open_stream();
  driver::Result<void> open_part(const OutputKind& kind);
  void close_now() noexcept;

  std::filesystem::path name_;  // As given by the user.
  OutputPath place_;
  std::filesystem::path part_;
  int descriptor_ = -1;
  bool published_ = false;
};

/// Fails if an existing file may not be replaced by an output of this kind, or is being written.
/// `path` is the name as given by the user.
THIMBLE_EXPORT driver::Result<void> check_replaceable(const std::filesystem::path& path,
                                                      const OutputPath& place,
                                                      const OutputKind& kind, bool replace);

/// Opens an output and reserves it for the next writer in this process that opens it. Returns the
/// key for `release_output`. Fails as OutputFile::open.
driver::Result<std::filesystem::path> reserve_output(const std::filesystem::path& path,
                                                     const OutputKind& kind, bool replace);

/// Removes an output that is still reserved.
void release_output(const std::filesystem::path& key);

/// Writes a whole file. Fails as OutputFile::open, or if it cannot be written.
THIMBLE_EXPORT driver::Result<void> write_file(const std::filesystem::path& path,
                                               const OutputKind& kind, std::string_view bytes);

}  // namespace thimble::output
