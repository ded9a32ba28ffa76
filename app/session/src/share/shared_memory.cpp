#include "share/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include "byte_lock.h"
#include "share/shared_layout.h"

namespace thimble::session {
namespace {

// Folder in which Linux shows POSIX shared memory as files [shm_overview(7)].
constexpr const char* kFolder = "/dev/shm";
// Suffix of memory that takes a run's name once it is complete. Run names contain no dot, so the
// first dot of a file name ends the run's name.
constexpr const char* kNext = ".next";

std::string prefix() {
  std::string text = "thimble-";
  text += std::to_string(geteuid());
  text += '-';
  return text;
}

std::string path_of(const std::string& file) {
  std::string path = kFolder;
  path += '/';
  path += file;
  return path;
}

driver::Error system_error(const std::string& what) {
  return driver::Error{what + ": " + std::strerror(errno) + "."};
}

bool is_own(const struct stat& status) {
  return status.st_uid == geteuid() && (status.st_mode & 077) == 0 && S_ISREG(status.st_mode);
}

/// Opens a file of shared memory if it belongs to this user; returns -1 otherwise. Any user may put
/// any file into the folder. Therefore it does not wait (FIFO, lease) or follow links, and checks
/// the open file itself before using it.
int open_own(const std::string& file, struct stat& status) {
  const int opened =
      ::open(path_of(file).c_str(), O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_NOCTTY | O_CLOEXEC);
  if (opened < 0) return -1;
  if (fstat(opened, &status) == 0 && is_own(status)) return opened;
  close(opened);
  errno = EACCES;
  return -1;
}

/// File of shared memory of this user.
struct Segment {
  std::string file;
  std::string run;
  std::string end;  // end of the file's name, from the first dot on
};

/// Lists the shared memory of this user's runs.
std::vector<Segment> segments() {
  std::vector<Segment> found;
  std::error_code ended;
  const std::string own = prefix();
  for (std::filesystem::directory_iterator entry(kFolder, ended), none; !ended && entry != none;
       entry.increment(ended)) {
    const std::string file = entry->path().filename().string();
    struct stat status {};
    if (!file.starts_with(own) || lstat(entry->path().c_str(), &status) != 0 || !is_own(status)) {
      continue;
    }
    const std::string rest = file.substr(own.size());
    const std::size_t dot = std::min(rest.find('.'), rest.size());
    found.push_back({file, rest.substr(0, dot), rest.substr(dot)});
  }
  return found;
}

bool is_next(const Segment& segment) {
  return segment.end.starts_with(kNext);
}

/// Removes a segment if the process that created it has died. Returns whether its name is free.
bool remove_if_dead(const std::string& file) {
  struct stat status {};
  const int opened = open_own(file, status);
  if (opened < 0) return errno == ENOENT;
  // Holds the lock meanwhile, so that only one process does this. A second one could remove a new
  // segment of the same name.
  bool removed = false;
  if (driver::lock_byte(opened, SharedMemory::kMakerByte)) {
    struct stat now {};
    const std::string path = path_of(file);
    const bool same = lstat(path.c_str(), &now) == 0 && now.st_dev == status.st_dev &&
                      now.st_ino == status.st_ino;
    removed = same && unlink(path.c_str()) == 0;
  }
  close(opened);
  return removed;
}

/// Returns a random word that other users cannot predict.
std::string random_word() {
  std::uint64_t number = 0;
  if (getrandom(&number, sizeof number, 0) != sizeof number) number = std::random_device{}();
  return std::to_string(number);
}

}  // namespace

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::map(int file, std::size_t bytes,
                                                                Place place, bool made) {
  void* at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (at == MAP_FAILED) {
    const auto error = system_error("Cannot map shared memory");
    close(file);
    if (made && !place.file.empty()) unlink(path_of(place.file).c_str());
    return error;
  }
  return std::unique_ptr<SharedMemory>(
      new SharedMemory(file, {static_cast<std::byte*>(at), bytes}, std::move(place), made));
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create_next(const SharedMemory& before,
                                                                        std::size_t bytes) {
  return create_as(before.run_, kNext, bytes);
}

driver::Result<void> SharedMemory::take_name(SharedMemory& before) {
  struct stat own {};
  struct stat there {};
  const bool is_there = lstat(path_of(before.name_).c_str(), &there) == 0;
  if (is_there && (fstat(before.file_, &own) != 0 || own.st_dev != there.st_dev ||
                   own.st_ino != there.st_ino)) {
    return driver::Error{"Another run uses the name \"" + before.run_ +
                         "\"; choose another name with --name."};
  }
  // Atomic for all readers [rename(2)].
  if (rename(path_of(name_).c_str(), path_of(before.name_).c_str()) != 0) {
    return system_error("The name \"" + before.run_ + "\" cannot be taken over");
  }
  name_ = before.name_;
  before.made_ = false;
  return {};
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create(const std::string& run,
                                                                   std::size_t bytes) {
  for (const Segment& segment : segments()) {
    if (segment.run != run || is_next(segment) || remove_if_dead(segment.file)) continue;
    return driver::Error{"A run named \"" + run +
                         "\" is already shared; end it, or choose another name with --name."};
  }
  return create_as(run, "", bytes);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create_as(const std::string& run,
                                                                      const std::string& end,
                                                                      std::size_t bytes) {
  // Created without a name first, so that it is locked before any process can find it.
  const int file = ::open(kFolder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) return system_error("Cannot create shared memory in " + std::string(kFolder));
  fchmod(file, 0600);
  driver::lock_byte(file, kMakerByte);
  // Also reserves the pages, so that a lack of memory is reported here and not by SIGBUS in a tick.
  if (const int full = posix_fallocate(file, 0, static_cast<off_t>(bytes)); full != 0) {
    errno = full;
    const auto error =
        system_error("Cannot allocate " + std::to_string(bytes) + " bytes of shared memory");
    close(file);
    return error;
  }
  const std::string own = "/proc/self/fd/" + std::to_string(file);
  Place place{.file = prefix() + run + end, .run = run};
  /// Links the memory to its name; returns 0 or an errno.
  const auto put = [&] {
    const bool done = linkat(AT_FDCWD, own.c_str(), AT_FDCWD, path_of(place.file).c_str(),
                             AT_SYMLINK_FOLLOW) == 0;
    return done ? 0 : errno;
  };
  int failed = put();
  if (failed == EEXIST && remove_if_dead(place.file)) failed = put();
  if (failed == EEXIST) {
    struct stat status {};
    // Either another run of this user was faster, or the file belongs to another user. In the
    // latter case uses a name that other users cannot predict.
    const bool ours = lstat(path_of(place.file).c_str(), &status) == 0 && is_own(status);
    if (!ours) {
      place.file += '.' + random_word();
      failed = put();
    }
  }
  if (failed == 0) return map(file, bytes, std::move(place), true);
  close(file);
  errno = failed;
  if (failed != EEXIST) return system_error("Cannot create shared memory " + path_of(place.file));
  return driver::Error{"A run named \"" + run +
                       "\" is already shared; end it, or choose another name with --name."};
}

std::string SharedMemory::path() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(file_);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create_nameless(std::size_t bytes) {
  const int file = memfd_create("thimble", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (file < 0) return system_error("Cannot create shared memory");
  if (ftruncate(file, static_cast<off_t>(bytes)) != 0 ||
      fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0) {
    const auto error =
        system_error("Cannot allocate " + std::to_string(bytes) + " bytes of shared memory");
    close(file);
    return error;
  }
  driver::lock_byte(file, kMakerByte);
  return map(file, bytes, {}, true);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::open(const std::string& run) {
  struct stat status {};
  int file = -1;
  Place place{.file = {}, .run = run};
  // Prefers a live run to the remains of one that was killed.
  for (const Segment& segment : segments()) {
    if (segment.run != run || is_next(segment)) continue;
    struct stat found {};
    const int opened = open_own(segment.file, found);
    if (opened < 0) continue;
    const bool alive = driver::is_byte_locked(opened, kMakerByte);
    if (file >= 0 && !alive) {
      close(opened);
      continue;
    }
    if (file >= 0) close(file);
    file = opened;
    status = found;
    place.file = segment.file;
    if (alive) break;
  }
  if (file < 0) {
    return driver::Error{"No run named \"" + run +
                         "\" is shared; list the shared runs with `thimble view --list`."};
  }
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  if (bytes < kSharedTablesOffset || bytes > kSharedBytesMax) {
    close(file);
    return driver::Error{"The shared memory \"" + run +
                         "\" is not a run of this version of thimble; restart the run with the "
                         "version of the viewer."};
  }
  return map(file, static_cast<std::size_t>(bytes), std::move(place), false);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::again() const {
  const std::string own = "/proc/self/fd/" + std::to_string(file_);
  const int file = ::open(own.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return system_error("Cannot map shared memory again");
  return map(file, bytes_.size(), {.file = name_, .run = run_}, false);
}

SharedMemory::~SharedMemory() {
  if (made_) remove_name();
  guard_.reset();
  munmap(bytes_.data(), bytes_.size());
  close(file_);
}

void SharedMemory::remove_name() {
  const std::string path = path_of(name_);
  struct stat own {};
  struct stat there {};
  // Removes only its own file, not one that another run has created since.
  if (!name_.empty() && made_ && fstat(file_, &own) == 0 && lstat(path.c_str(), &there) == 0 &&
      own.st_dev == there.st_dev && own.st_ino == there.st_ino) {
    unlink(path.c_str());
  }
  made_ = false;
}

bool SharedMemory::maker_alive() const noexcept {
  return maker_ || driver::is_byte_locked(file_, kMakerByte);
}

bool SharedMemory::lock(std::int64_t byte) const noexcept {
  return driver::lock_byte(file_, byte);
}

void SharedMemory::unlock(std::int64_t byte) const noexcept {
  driver::unlock_byte(file_, byte);
}

bool SharedMemory::locked_elsewhere(std::int64_t byte) const noexcept {
  return driver::is_byte_locked(file_, byte);
}

std::vector<RunningRun> running_runs() {
  std::vector<RunningRun> runs;
  for (const Segment& segment : segments()) {
    if (is_next(segment)) continue;
    struct stat status {};
    const int file = open_own(segment.file, status);
    if (file < 0) continue;
    RunningRun run{.name = segment.run};
    // Reads the value, because mapping requires a trusted size.
    std::int64_t began_ns = 0;
    const auto got = pread(file, &began_ns, sizeof began_ns, offsetof(SharedHead, began_ns));
    if (got == static_cast<ssize_t>(sizeof began_ns)) run.began_ns = began_ns;
    if (driver::is_byte_locked(file, SharedMemory::kMakerByte)) runs.push_back(run);
    close(file);
  }
  std::sort(runs.begin(), runs.end(),
            [](const auto& a, const auto& b) { return a.began_ns > b.began_ns; });
  return runs;
}

void remove_dead_runs() {
  for (const Segment& segment : segments()) remove_if_dead(segment.file);
}

std::string run_name_of(const std::string& scene) {
  constexpr std::size_t kLongest = 48;
  std::string name;
  for (const char c : scene.substr(0, kLongest)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    name += plain ? c : '-';
  }
  return name.empty() ? "run" : name;
}

bool run_name_taken(const std::string& run) {
  const auto found = segments();
  return std::any_of(found.begin(), found.end(), [&](const Segment& segment) {
    return segment.run == run && !is_next(segment);
  });
}

}  // namespace thimble::session
