#include "report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>

#include "output/output_file.h"
#include "report/figure_output.h"

namespace thimble::report {
namespace {

constexpr const char* kMissingMessage =
    "gnuplot, which draws the pictures, was not found: install it (apt install gnuplot-nox).";

enum class RunEnd { kGood, kMissing, kBad };

// Runs `gnuplot argument` in `folder`, with standard input `input` and its messages to `log`. No
// shell is used, so folder names may contain any character.
RunEnd run_gnuplot(const std::string& argument, int input, const std::string& folder,
                   const std::string& log) {
  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0) return RunEnd::kBad;
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  if (input >= 0) posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  if (input < 0) {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::string program = "gnuplot";
  std::string copy = argument;
  std::array<char*, 3> arguments{program.data(), copy.data(), nullptr};
  pid_t child = 0;
  const int failure = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return failure == ENOENT ? RunEnd::kMissing : RunEnd::kBad;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return RunEnd::kBad;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? RunEnd::kGood : RunEnd::kBad;
}

std::string content_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

bool has_gnuplot() {
  return run_gnuplot("--version", -1, "/", "/dev/null") == RunEnd::kGood;
}

namespace {

/// Quotes a string for gnuplot.
std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted.append(c == '\'' ? "''" : std::string(1, c));
  return quoted + "'";
}

/// Returns the script that draws a plot into two files.
std::string script_of(const Plot& plot, const std::string& png, const std::string& svg) {
  const std::string size = std::to_string(plot.width) + "," + std::to_string(plot.height);
  const std::array<std::pair<std::string, std::string>, 2> terminals{
      std::pair{png, "pngcairo size " + size + " font 'DejaVu Sans,17' background '#ffffff'"},
      std::pair{svg,
                "svg size " + size + " font 'DejaVu Sans,sans-serif,17' background '#ffffff'"}};
  std::string script = "set encoding utf8\n";
  for (const auto& [file, terminal] : terminals) {
    script.append("reset\nset terminal ").append(terminal).append("\nset output ");
    script.append(quoted(file)).append("\n");
    script.append(plot.commands).append("unset output\n");
  }
  return script;
}

/// Runs gnuplot with a script as its standard input.
RunEnd draw(const std::string& script, const std::string& folder, const std::string& log) {
  const int input = memfd_create("plot", MFD_CLOEXEC);
  if (input < 0) return RunEnd::kBad;
  std::size_t written = 0;
  while (written < script.size()) {
    const ssize_t now = write(input, script.data() + written, script.size() - written);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) break;
    written += static_cast<std::size_t>(now);
  }
  const bool whole = written == script.size() && lseek(input, 0, SEEK_SET) == 0;
  const RunEnd end = whole ? run_gnuplot("-", input, folder, log) : RunEnd::kBad;
  close(input);
  return end;
}

}  // namespace

driver::Result<void> draw_plot(const Plot& plot, const std::filesystem::path& folder) {
  const std::string log_name = "data/" + plot.name + ".log";
  if (auto done = write_text(script_of(plot, plot.name + ".png", plot.name + ".svg"),
                             folder / ("data/" + plot.name + ".gp"));
      !done) {
    return done;
  }
  auto png = output::OutputFile::open(folder / (plot.name + ".png"), output::kPng);
  if (!png) return png.error();
  auto svg = output::OutputFile::open(folder / (plot.name + ".svg"), output::kSvg);
  if (!svg) return svg.error();
  const RunEnd end =
      draw(script_of(plot, png->part().string(), svg->part().string()), folder.string(), log_name);
  if (end == RunEnd::kMissing) return driver::Error{kMissingMessage};
  const std::string messages = content_of(folder / log_name);
  if (end == RunEnd::kBad) {
    return driver::Error{"gnuplot could not draw " + plot.name + " in " + folder.string() +
                         (messages.empty() ? "." : ": " + messages)};
  }
  // Warnings (an empty range, a bad font) do not fail a run; they remain in the log.
  std::error_code status;
  if (messages.empty()) std::filesystem::remove(folder / log_name, status);
  if (auto done = png->commit(); !done) return done;
  return svg->commit();
}

}  // namespace thimble::report
