#include "report/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>

#include "report/figure.h"

namespace thimble::app {
namespace {

constexpr const char* kMissingMessage =
    "gnuplot draws the pictures but was not found: install it (apt install gnuplot-nox).";

enum class RunEnd { kGood, kMissing, kBad };

// Runs `gnuplot argument` in `folder`, with what it says going to `log`. No shell is involved, so
// folder names may hold any character.
RunEnd run_gnuplot(const std::string& argument, const std::string& folder, const std::string& log) {
  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0) return RunEnd::kBad;
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
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
  return run_gnuplot("--version", "/", "/dev/null") == RunEnd::kGood;
}

driver::Result<void> draw_plot(const Plot& plot, const std::filesystem::path& folder) {
  const std::string size = std::to_string(plot.width) + "," + std::to_string(plot.height);
  const std::array<std::pair<std::string, std::string>, 2> terminals{
      std::pair{"png", "pngcairo size " + size + " font 'DejaVu Sans,17' background '#ffffff'"},
      std::pair{"svg",
                "svg size " + size + " font 'DejaVu Sans,sans-serif,17' background '#ffffff'"}};
  std::string script = "set encoding utf8\n";
  for (const auto& [ending, terminal] : terminals) {
    script.append("reset\nset terminal ").append(terminal).append("\nset output '");
    script.append(plot.name).append(".").append(ending).append("'\n");
    script.append(plot.commands).append("unset output\n");
  }
  const std::string script_name = "data/" + plot.name + ".gp";
  const std::string log_name = "data/" + plot.name + ".log";
  if (auto done = write_text(script, folder / script_name); !done) return done;
  const RunEnd end = run_gnuplot(script_name, folder.string(), log_name);
  if (end == RunEnd::kMissing) return driver::Error{kMissingMessage};
  const std::string said = content_of(folder / log_name);
  if (end == RunEnd::kBad) {
    return driver::Error{"gnuplot could not draw " + plot.name + " in " + folder.string() +
                         (said.empty() ? "." : ": " + said)};
  }
  // Warnings (an empty range, a bad font) do not fail a run; they stay in the log.
  std::error_code status;
  if (said.empty()) std::filesystem::remove(folder / log_name, status);
  return {};
}

}  // namespace thimble::app
