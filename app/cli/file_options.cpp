#include "cli/file_options.h"

#include <filesystem>
#include <vector>

#include "thimble/scene/quality.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::cli {
namespace {

/// Converts a name to the path that `find` finds, or its error.
template <class Find>
CLI::Validator file_by(Find find, const char* kind) {
  return CLI::Validator(
      [find](std::string& text) {
        const auto found = find(text);
        if (!found) return found.error().message;
        text = found->string();
        return std::string();
      },
      kind);
}

CLI::Option* by_name(CLI::Option* arm) {
  return arm->transform(file_by(scene::find_arm_file, "FILE or NAME"))->check(CLI::ExistingFile);
}

}  // namespace

CLI::Option* add_scene_option(CLI::App& command, std::string& scene, const std::string& name,
                              const std::string& about) {
  return command.add_option(name, scene, about)
      ->transform(file_by(scene::find_scene, "FILE or NAME"));
}

CLI::Option* add_arm_option(CLI::App& command, std::string& arm_file, const std::string& about) {
  return by_name(command.add_option("--arm", arm_file, about));
}

CLI::Option* add_arm_option(CLI::App& command, std::filesystem::path& arm_file,
                            const std::string& about) {
  return by_name(command.add_option("--arm", arm_file, about));
}

CLI::Option* add_quality_option(CLI::App& command, std::string& quality, const std::string& about) {
  return command.add_option("--quality", quality, about)
      ->check(CLI::IsMember(
          std::vector<std::string>(scene::kQualityNames.begin(), scene::kQualityNames.end())))
      ->capture_default_str();
}

}  // namespace thimble::cli
