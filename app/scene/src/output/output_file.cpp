#include "output/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "output/file_lock.h"

namespace thimble::output {
namespace {

namespace fs = std::filesystem;

/// Outputs that are reserved for a later writer, by target.
struct ReservedOutputs {
  std::mutex mutex;
  std::map<fs::path, OutputFile> files;
};

ReservedOutputs& reserved() {
  static auto* const only =
      new ReservedOutputs;  // never destroyed: threads may still write at exit
  return *only;
}

/// Returns the name of the part. It keeps the extension, because programs select formats by it.
fs::path part_of(const fs::path& target) {
  constexpr std::size_t kStemMax = 200;  // bytes; names have 255 [S limits.h, NAME_MAX]
  return target.parent_path() / (target.stem().string().substr(0, kStemMax) + ".thimble-part" +
                                 target.extension().string().substr(0, 32));
}

driver::Error busy(const fs::path& path, int descriptor) {
  return cannot_write(path, "it is being written or read by " + lock_holder(descriptor) +
                                ". Wait until it has finished, or name another file.");
}

driver::Error failed(const fs::path& path, int number) {
  const bool full = number == ENOSPC || number == EDQUOT || number == EFBIG;
  return cannot_write(path, error_text(number) + (full ? ". Free some space, or name another disk."
                                                       : ". Check its folder, or name another."));
}

}  // namespace

driver::Result<void> check_replaceable(const fs::path& path, const OutputPath& place,
                                       const OutputKind& kind, bool replace) {
  if (place.stream && kind.needs_file) {
    return cannot_write(path, "it is a device or a pipe, and " + std::string(kind.name) +
                                  " needs a file. Name a file.");
  }
  if (place.stream || !place.exists) return {};
  if (place.is_folder) return cannot_write(path, "it is a folder. Name a file in it.");
  const int existing =
      kind.shared ? -1 : ::open(place.target.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (existing >= 0) {
    const bool taken = lock_to_write(existing) == Locked::kBusy;
    std::optional<driver::Error> error;
    if (taken) error = busy(path, existing);
    if (!taken) unlock(existing);
    ::close(existing);
    if (error) return *error;
  }
  if (kind.existing == Existing::kKeep) {
    return cannot_write(path, "it exists already, and " + std::string(kind.name) +
                                  " never replaces a file. Name another.");
  }
  std::error_code status;
  if (fs::file_size(place.target, status) == 0 && !status) return {};
  if (!kind.matches(place.target)) {
    return cannot_write(path, "the existing file is not " + std::string(kind.name) +
                                  ", and a file of another kind is never overwritten. Give the "
                                  "output another name, or remove the file.");
  }
  if (kind.existing == Existing::kReplaceForced && !replace) {
    return cannot_write(path, std::string(kind.name) +
                                  " exists there already and is kept. Give the output another "
                                  "name, or allow its replacement (--force; in Python and C++ "
                                  "`overwrite`).");
  }
  return {};
}

driver::Result<OutputFile> OutputFile::open(const fs::path& path, const OutputKind& kind,
                                            bool replace) {
  auto place = resolve_output(path);
  if (!place) return place.error();
  {
    const std::lock_guard guard(reserved().mutex);
    if (const auto found = reserved().files.find(place->target); found != reserved().files.end()) {
      OutputFile file = std::move(found->second);
      reserved().files.erase(found);
      return file;
    }
  }
  if (auto may = check_replaceable(path, *place, kind, replace); !may) return may.error();
  OutputFile file(path, std::move(place).value());
  if (auto opened = file.stream() ? file.open_stream() : file.open_part(kind); !opened) {
    return opened.error();
  }
  if (file.stream()) return file;
  // Checked again under the lock: another writer may have published the file in the meantime.
  auto now = resolve_output(path);
  if (!now) return now.error();
  if (auto may = check_replaceable(path, *now, kind, replace); !may) return may.error();
  return file;
}

driver::Result<OutputFile> OutputFile::open_again(const OutputKind& kind) const {
  OutputFile file(name_, place_);
  if (auto opened = file.open_part(kind); !opened) return opened.error();
  return file;
}

driver::Result<void> OutputFile::open_stream() {
  part_ = place_.target;
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK | O_APPEND);
  if (descriptor_ < 0 && errno == ENXIO) {
    return cannot_write(name_, "no program reads this pipe. Start its reader first.");
  }
  if (descriptor_ < 0) return failed(name_, errno);
  const int flags = ::fcntl(descriptor_, F_GETFL);
  if (flags >= 0) ::fcntl(descriptor_, F_SETFL, flags & ~O_NONBLOCK);
  return {};
}

driver::Result<void> OutputFile::open_part(const OutputKind& kind) {
  constexpr int kAttemptsMax = 100;  // an attempt fails if another writer publishes in between
  const mode_t mode = kind.owner_only ? 0600 : 0666;
  const fs::path part = part_of(place_.target);
  for (int attempt = 0; attempt < kAttemptsMax; ++attempt) {
    const int opened = ::open(
        part.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NOCTTY | O_NONBLOCK, mode);
    if (opened < 0 && errno == ELOOP) {
      return cannot_write(name_, part.string() + " is a link. Remove it.");
    }
    if (opened < 0) return failed(name_, errno);
    if (lock_to_write(opened) == Locked::kBusy) {
      const driver::Error error = busy(name_, opened);
      ::close(opened);
      return error;
    }
    struct stat ours {
    }, named{};
    const bool same = ::fstat(opened, &ours) == 0 && ::lstat(part.c_str(), &named) == 0 &&
                      ours.st_dev == named.st_dev && ours.st_ino == named.st_ino;
    if (!same) {
      ::close(opened);
      continue;
    }
    if (!S_ISREG(ours.st_mode) || ours.st_nlink != 1) {
      ::close(opened);
      return cannot_write(name_, part.string() + " is not a part of an output. Remove it.");
    }
    descriptor_ = opened;
    part_ = part;
    struct stat before {};
    const bool replaces = place_.exists && ::stat(place_.target.c_str(), &before) == 0;
    if (::ftruncate(opened, 0) != 0) return failed(name_, errno);
    if (kind.owner_only) {
      if (::fchmod(opened, 0600) != 0) return failed(name_, errno);
    } else if (replaces) {
      // If permitted: an administrator's run leaves a user's file to the user.
      [[maybe_unused]] const int owner = ::fchown(opened, before.st_uid, before.st_gid);
      [[maybe_unused]] const int access = ::fchmod(opened, before.st_mode & 0777);
    }
    return {};
  }
  return cannot_write(name_, "other programs write it continuously. Name another file.");
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : name_(std::move(other.name_)),
      place_(std::move(other.place_)),
      part_(std::move(other.part_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      published_(other.published_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this == &other) return *this;
  close_now();
  name_ = std::move(other.name_);
  place_ = std::move(other.place_);
  part_ = std::move(other.part_);
  descriptor_ = std::exchange(other.descriptor_, -1);
  published_ = other.published_;
  return *this;
}

OutputFile::~OutputFile() {
  close_now();
}

void OutputFile::close_now() noexcept {
  if (descriptor_ < 0) return;
  if (!published_ && !stream()) ::unlink(part_.c_str());  // while the lock is held
  if (!stream()) unlock(descriptor_);
  ::close(std::exchange(descriptor_, -1));
}

driver::Result<void> OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return failed(name_, written < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

driver::Result<void> OutputFile::publish() {
  if (published_ || stream()) return {};
  if (lock_to_be_read(descriptor_) == Locked::kBusy) return busy(name_, descriptor_);
  if (::rename(part_.c_str(), place_.target.c_str()) != 0) return failed(name_, errno);
  published_ = true;
  return {};
}

driver::Result<void> OutputFile::commit() {
  if (auto done = publish(); !done) return done;
  if (descriptor_ < 0) return {};
  if (!stream()) unlock(descriptor_);
  // Some file systems report a full disk only on close.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) return failed(name_, errno);
  return {};
}

driver::Error OutputFile::named(const driver::Error& error) const {
  std::string text = error.message;
  const std::string part = part_.string();
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at)) {
    text.replace(at, part.size(), name_.string());
    at += name_.string().size();
  }
  return driver::Error{text};
}

driver::Result<fs::path> reserve_output(const fs::path& path, const OutputKind& kind,
                                        bool replace) {
  auto file = OutputFile::open(path, kind, replace);
  if (!file) return file.error();
  const fs::path key = file->target();
  const std::lock_guard guard(reserved().mutex);
  reserved().files.insert_or_assign(key, std::move(file).value());
  return key;
}

void release_output(const fs::path& key) {
  const std::lock_guard guard(reserved().mutex);
  reserved().files.erase(key);
}

driver::Result<void> write_file(const fs::path& path, const OutputKind& kind,
                                std::string_view bytes) {
  auto file = OutputFile::open(path, kind);
  if (!file) return file.error();
  if (auto written = file->write(bytes); !written) return written;
  return file->commit();
}

}  // namespace thimble::output
