#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "meshes/cache/cache_folder.h"
#include "text/counted.h"

namespace thimble::cli {
namespace {

constexpr double kMegabyte = 1e6;

/// Returns a time as "2026-01-31 12:00", local time.
std::string time_text(std::filesystem::file_time_type time) {
  const auto world = std::chrono::file_clock::to_sys(time);
  const std::time_t seconds = std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(world));
  std::tm local{};
  char text[32] = "";
  if (localtime_r(&seconds, &local) == nullptr) return "";
  return std::string(text, std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M", &local));
}

int list_cache(bool clear) {
  const std::filesystem::path folder = scene::chosen_mesh_cache();
  if (const auto readable = scene::check_cache_folder(folder); !readable) {
    return report_error(readable.error(), kExitTrouble);
  }
  const auto entries = scene::cache_entries(folder);
  std::uint64_t bytes = 0;
  for (const scene::EntryFile& entry : entries) {
    bytes += entry.bytes;
    const std::string about = scene::describe_entry(entry.file);
    scene::print_format("%8.1f MB  %s  %s\n", static_cast<double>(entry.bytes) / kMegabyte,
                        time_text(entry.used).c_str(),
                        about.empty() ? "damaged, or of another version" : about.c_str());
  }
  if (clear) {
    scene::limit_cache(folder, 0);
    if (const auto left = scene::cache_entries(folder); !left.empty()) {
      return report_error({folder.string() + ": " + scene::counted(left.size(), "file") +
                           " could not be removed. Make the folder writable."},
                          kExitTrouble);
    }
  }
  scene::print_format("%s: %s, %.1f MB%s.\n", folder.c_str(),
                      scene::counted(entries.size(), "file").c_str(),
                      static_cast<double>(bytes) / kMegabyte, clear ? ", removed" : "");
  return kExitDone;
}

}  // namespace

void add_mesh_cache_command(CLI::App& mesh_command, int& exit_code) {
  CLI::App* command =
      mesh_command.add_subcommand("cache", "List or clear the prepared meshes of --mesh-cache");
  auto clear = std::make_shared<bool>(false);
  command->add_flag("--clear", *clear, "Remove all of them");
  add_example(*command, "thimble mesh cache --clear",
              "The folder is $THIMBLE_MESH_CACHE if that is an absolute path; otherwise\n"
              "~/.cache/thimble/prepared ($XDG_CACHE_HOME). Each line: size, time of the last\n"
              "use, file and contents.");
  command->callback([clear, &exit_code] { exit_code = list_cache(*clear); });
}

}  // namespace thimble::cli
