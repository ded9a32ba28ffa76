#include "view/gl/animation_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>

#include "output/output_file.h"

namespace thimble::view {
namespace {

enum class Ended { kGood, kMissing, kBad };

/// Runs ffmpeg with standard input from `input` and its messages to `said`. No shell is used, so
/// names may contain any character.
class Ffmpeg {
 public:
  Ffmpeg(std::vector<std::string> words, int input, int said) {
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0) return;
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, said, STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    failure_ = posix_spawnp(&child_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
  }

  Ended wait() const {
    if (failure_ != 0) return failure_ == ENOENT ? Ended::kMissing : Ended::kBad;
    int status = 0;
    while (waitpid(child_, &status, 0) < 0) {
      if (errno != EINTR) return Ended::kBad;
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? Ended::kGood : Ended::kBad;
  }

 private:
  int failure_ = ENOMEM;
  pid_t child_ = 0;
};

/// A file descriptor that the destructor closes.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close_now(); }
  int number() const { return number_; }
  void close_now() {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

bool send_all(int to, const std::vector<std::uint8_t>& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    // A closed reader must not raise SIGPIPE.
    const ssize_t now = send(to, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) return false;
    sent += static_cast<std::size_t>(now);
  }
  return true;
}

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::vector<std::string> words_for(const Picture& first, double frame_time,
                                   const std::filesystem::path& file) {
  // An absolute path, because a name that begins with a dash would be an option.
  const std::string out = std::filesystem::absolute(file).string();
  std::vector<std::string> words{"ffmpeg",
                                 "-nostdin",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pixel_format",
                                 "rgb24",
                                 "-video_size",
                                 fmt::format("{}x{}", first.width, first.height),
                                 "-framerate",
                                 fmt::format("{:.6f}", 1 / frame_time),
                                 "-i",
                                 "pipe:0"};
  const auto add = [&words](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  if (is_gif(file)) {
    // One palette of 256 colours for all pictures, as in the animated PNG.
    add({"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none", "-f",
         "gif"});
  } else {
    add({"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-c:v", "libx264", "-pix_fmt",
         "yuv420p", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"});
  }
  add({"-bitexact"});
  words.push_back("file:" + out);
  return words;
}

std::string text_of(std::FILE* file) {
  std::string text;
  std::rewind(file);
  std::array<char, 512> piece{};
  while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), file)) {
    text.append(piece.data(), size);
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

driver::Error missing() {
  return driver::Error{
      "MP4 and GIF files need ffmpeg, which was not found. Install it (apt install "
      "ffmpeg), or choose a file name that ends in .png (animated PNG)."};
}

}  // namespace

bool is_animation(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".mp4" || ending == ".gif";
}

bool is_gif(const std::filesystem::path& file) {
  return ending_of(file) == ".gif";
}

driver::Result<void> find_ffmpeg() {
  const Descriptor nothing(open("/dev/null", O_RDWR | O_CLOEXEC));
  const Ffmpeg asked({"ffmpeg", "-version"}, nothing.number(), nothing.number());
  if (asked.wait() == Ended::kGood) return {};
  return missing();
}

driver::Result<void> write_animation(const std::vector<Picture>& pictures, double frame_time,
                                     const std::filesystem::path& file) {
  std::array<int, 2> ends{-1, -1};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> said(std::tmpfile(), &std::fclose);
  if (said == nullptr || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return driver::Error{file.string() + " cannot be written: too many open files."};
  }
  auto target = output::OutputFile::open(file, output::kAnimation);
  if (!target) return target.error();
  Descriptor ours(ends[0]);
  Descriptor theirs(ends[1]);
  const Ffmpeg ffmpeg(words_for(pictures.front(), frame_time, target->part()), theirs.number(),
                      fileno(said.get()));
  theirs.close_now();
  bool sent = true;
  for (const Picture& picture : pictures) sent = sent && send_all(ours.number(), picture.rgb);
  ours.close_now();
  const Ended ended = ffmpeg.wait();
  if (ended == Ended::kMissing) return missing();
  if (ended == Ended::kGood && sent) return target->commit();
  const std::string text = text_of(said.get());
  return driver::Error{file.string() + " cannot be written by ffmpeg" +
                       (text.empty() ? std::string(".") : ": " + text)};
}

}  // namespace thimble::view
