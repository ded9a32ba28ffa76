// The command line by which the window of a run starts it again after its end.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options/run_options.h"

namespace thimble::cli {
namespace {

const char* clock_word(session::ClockKind clock) {
  switch (clock) {
    case session::ClockKind::kWall:
      return "wall";
    case session::ClockKind::kPaced:
      return "paced";
    case session::ClockKind::kVirtual:
      break;
  }
  return "virtual";
}

std::string absolute_path(const std::string& file) {
  return std::filesystem::absolute(file).lexically_normal().string();
}

}  // namespace

std::vector<std::string> run_again_words(const RunOptions& options,
                                         const session::SessionOptions& asked) {
  if (!asked.restarts || options.hold_to_run == "key") return {};
  // NAME=VALUE in one word, so that no value is taken for an option.
  std::vector<std::string> words = {"run", absolute_path(options.scene), "--no-view",
                                    fmt::format("--clock={}", clock_word(asked.clock)),
                                    options.reloads() ? "--reload" : "--no-reload"};
  const auto add = [&words](const char* option, const std::string& value) {
    if (!value.empty()) words.push_back(fmt::format("--{}={}", option, value));
  };
  if (!options.arm_file.empty()) add("arm", absolute_path(options.arm_file));
  if (options.by_viewer()) add("hand", options.hand);
  for (const std::string& press : options.presses) add("button-at", press);
  if (options.duration) add("duration", fmt::format("{}", *options.duration));
  if (options.seed) add("seed", fmt::format("{}", *options.seed));
  if (options.speed) add("speed", fmt::format("{}", *options.speed));
  add("quality", options.quality);
  if (options.budget) add("budget", fmt::format("{}", *options.budget));
  add("hold-to-run", options.hold_to_run);
  return words;
}

}  // namespace thimble::cli
