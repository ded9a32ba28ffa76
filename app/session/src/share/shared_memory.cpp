#include "share/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "share/shared_layout.h"

namespace thimble::session {
namespace {

// Where Linux shows POSIX shared memory as files [shm_overview(7)].
constexpr const char* kFolder = "/dev/shm";
// A segment without an owner's pid for so long is one whose run died while it made it.
constexpr std::time_t kMakingMost = 10;  // s, chosen
// After the name of a run whose memory takes that name when it is complete. No run's name has a
// dot.
constexpr const char* kNext = ".next";

std::string prefix() {
  std::string text = "thimble-";
  text += std::to_string(geteuid());
  text += '-';
  return text;
}

std::string path_of(const std::string& run) {
  std::string path = "/";
  path += prefix();
  path += run;
  return path;
}

driver::Error trouble(const std::string& what) {
  return driver::Error{what + ": " + std::strerror(errno) + "."};
}

/// Says whose a segment is, as far as its first bytes tell.
enum class Owner { kAlive, kDead, kUnknown };

Owner owner_of(int file, const struct stat& status, std::int64_t* began_ns = nullptr) {
  // The first bytes alone, by reading: mapping needs a size that can be trusted.
  SharedHead head{};
  const auto read_bytes = pread(file, static_cast<void*>(&head), sizeof head, 0);
  const bool whole = read_bytes == static_cast<ssize_t>(sizeof head);
  if (!whole || head.pid <= 0) {
    return std::time(nullptr) - status.st_mtime > kMakingMost ? Owner::kDead : Owner::kUnknown;
  }
  if (began_ns != nullptr) *began_ns = head.began_ns;
  const std::uint64_t start = start_of_process(head.pid);
  return start != 0 && start == head.pid_start ? Owner::kAlive : Owner::kDead;
}

/// Opens a segment if it is this user's own; -1 otherwise.
int open_own(const std::string& run, int flags, struct stat& status) {
  const int file = shm_open(path_of(run).c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0);
  if (file < 0) return -1;
  if (fstat(file, &status) == 0 && status.st_uid == geteuid() && (status.st_mode & 077) == 0 &&
      S_ISREG(status.st_mode)) {
    return file;
  }
  close(file);
  errno = EACCES;
  return -1;
}

/// Removes a segment if its run is dead; tells whether it is gone.
bool remove_if_dead(const std::string& run) {
  struct stat status {};
  const int file = open_own(run, O_RDONLY, status);
  if (file < 0) return errno == ENOENT;
  const bool dead = owner_of(file, status) == Owner::kDead;
  close(file);
  return dead && shm_unlink(path_of(run).c_str()) == 0;
}

/// Lists the names of all segments of this user.
std::vector<std::string> names() {
  std::vector<std::string> found;
  std::error_code status;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder, status)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix())) found.push_back(name.substr(prefix().size()));
  }
  return found;
}

}  // namespace

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::map(int file, std::size_t bytes,
                                                                const std::string& run, bool made) {
  void* at = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (at == MAP_FAILED) {
    const auto error = trouble("Shared memory cannot be mapped");
    close(file);
    if (made && !run.empty()) shm_unlink(path_of(run).c_str());
    return error;
  }
  return std::unique_ptr<SharedMemory>(
      new SharedMemory(file, {static_cast<std::byte*>(at), bytes}, run, made));
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create_next(const SharedMemory& before,
                                                                        std::size_t bytes) {
  return create(before.run_ + kNext, bytes);
}

driver::Result<void> SharedMemory::take_name(SharedMemory& before) {
  const std::string from = kFolder + path_of(run_), to = kFolder + path_of(before.run_);
  // In one step for whoever looks [rename(2)].
  if (rename(from.c_str(), to.c_str()) != 0) {
    return trouble("The name \"" + before.run_ + "\" cannot be taken over");
  }
  run_ = before.run_;
  before.made_ = false;
  return {};
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create(const std::string& run,
                                                                   std::size_t bytes) {
  const std::string path = path_of(run);
  const int flags = O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC;
  int file = shm_open(path.c_str(), flags, 0600);
  if (file < 0 && errno == EEXIST && remove_if_dead(run)) {
    file = shm_open(path.c_str(), flags, 0600);
  }
  if (file < 0 && errno == EEXIST) {
    return driver::Error{"A run named \"" + run +
                         "\" is already shown; end it, or give this one another --name."};
  }
  if (file < 0) return trouble("Shared memory " + path + " cannot be made");
  fchmod(file, 0600);
  // Reserves the pages too: where memory is short, that is said here and not by SIGBUS in a tick.
  if (const int full = posix_fallocate(file, 0, static_cast<off_t>(bytes)); full != 0) {
    errno = full;
    const auto error =
        trouble("Shared memory of " + std::to_string(bytes) + " bytes cannot be had");
    close(file);
    shm_unlink(path.c_str());
    return error;
  }
  return map(file, bytes, run, true);
}

std::string SharedMemory::path() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(file_);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::create_nameless(std::size_t bytes) {
  const int file = memfd_create("thimble", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (file < 0) return trouble("Shared memory cannot be made");
  if (ftruncate(file, static_cast<off_t>(bytes)) != 0 ||
      fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0) {
    const auto error =
        trouble("Shared memory of " + std::to_string(bytes) + " bytes cannot be had");
    close(file);
    return error;
  }
  return map(file, bytes, "", true);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::open(const std::string& run) {
  struct stat status {};
  const int file = open_own(run, O_RDWR, status);
  if (file < 0) {
    if (errno == ENOENT) {
      return driver::Error{"No run named \"" + run +
                           "\" is shown; `thimble view --list` tells which are."};
    }
    return trouble("The run \"" + run + "\" cannot be seen");
  }
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  if (bytes < kSharedTablesOffset || bytes > kSharedBytesMost) {
    close(file);
    return driver::Error{"What is shared as \"" + run +
                         "\" is not a run of this version of thimble; end the run and start it "
                         "with the same thimble as the viewer."};
  }
  return map(file, static_cast<std::size_t>(bytes), run, false);
}

driver::Result<std::unique_ptr<SharedMemory>> SharedMemory::again() const {
  const int file = fcntl(file_, F_DUPFD_CLOEXEC, 0);
  if (file < 0) return trouble("Shared memory cannot be mapped once more");
  return map(file, bytes_.size(), run_, false);
}

SharedMemory::~SharedMemory() {
  if (made_) remove_name();
  guard_.reset();
  munmap(bytes_.data(), bytes_.size());
  close(file_);
}

void SharedMemory::remove_name() {
  if (!run_.empty() && made_) shm_unlink(path_of(run_).c_str());
  made_ = false;
}

std::vector<RunningRun> running_runs() {
  std::vector<RunningRun> runs;
  for (const std::string& name : names()) {
    if (name.ends_with(kNext)) continue;
    struct stat status {};
    const int file = open_own(name, O_RDONLY, status);
    if (file < 0) continue;
    RunningRun run{.name = name};
    const Owner owner = owner_of(file, status, &run.began_ns);
    close(file);
    if (owner == Owner::kAlive) runs.push_back(run);
  }
  std::sort(runs.begin(), runs.end(),
            [](const auto& a, const auto& b) { return a.began_ns > b.began_ns; });
  return runs;
}

void remove_dead_runs() {
  for (const std::string& name : names()) remove_if_dead(name);
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
  return std::filesystem::exists(kFolder + path_of(run));
}

std::uint64_t start_of_process(std::int64_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  if (!std::getline(file, line)) return 0;
  // The second field is the program's name in brackets and may hold anything, brackets too.
  const std::size_t after_name = line.rfind(')');
  if (after_name == std::string::npos) return 0;
  std::istringstream rest(line.substr(after_name + 1));
  std::string field;
  rest >> field;
  if (field == "Z" || field == "X") return 0;  // dead, but nobody has asked yet
  for (int i = 4; i <= 22; ++i) rest >> field;
  return std::strtoull(field.c_str(), nullptr, 10);
}

}  // namespace thimble::session
