#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "cli/usage/usage_error.h"
#include "keys/key_schema.h"
#include "log/printed_text.h"
#include "scene_keys.h"
#include "yaml/renamed_keys.h"

namespace thimble::cli {
namespace {

struct HelpOptions {
  std::string file = "scene";
  std::string key;
  bool page = false;
};

driver::Result<std::vector<scene::KeyNote>> keys_of(const std::string& file) {
  if (file == "arm") return scene::arm_keys();
  return scene::scene_keys();
}

/// Returns the error for a key that has a new name; empty if it has none in this kind of file.
std::string renamed(const HelpOptions& options, const std::vector<scene::KeyNote>& keys) {
  for (const scene::RenamedKey& one : scene::kRenamedKeys) {
    const bool here = std::any_of(keys.begin(), keys.end(), [&one](const scene::KeyNote& key) {
      return key.place == one.place && key.key == one.is;
    });
    if (!here || one.was != options.key) continue;
    return fmt::format(
        "KEY: \"{0}\" is the old name of {1} ({2}). Use the new name; `thimble help {3} {1}` "
        "explains it.",
        one.was, one.is, one.place, options.file);
  }
  return {};
}

int print_keys(const HelpOptions& options) {
  const auto keys = keys_of(options.file);
  if (!keys) return report_error(keys.error(), kExitBadInput);
  const std::string text =
      options.page ? scene::key_page(*keys) : scene::key_text(*keys, options.key);
  if (text.empty()) {
    const std::string old = renamed(options, *keys);
    if (!old.empty()) return report_error(driver::Error{old}, kExitBadInput);
    std::vector<std::string> names;
    for (const scene::KeyNote& key : *keys) names.push_back(key.key);
    return report_error(driver::Error{"KEY: there is no key \"" + options.key + "\" in " +
                                      options.file + " files. `thimble help " + options.file +
                                      "` lists all keys." + suggestion(options.key, names)},
                        kExitBadInput);
  }
  scene::print_format("%s", text.c_str());
  return kExitDone;
}

/// Prints the JSON Schema of scene or arm files, as `KEY` names them.
int print_schema(const HelpOptions& options) {
  const std::string file = options.key.empty() ? "scene" : options.key;
  if (file != "scene" && file != "arm") {
    return report_error(
        driver::Error{"help schema: expected scene or arm, found \"" + options.key + "\"."},
        kExitBadInput);
  }
  const auto keys = keys_of(file);
  if (!keys) return report_error(keys.error(), kExitBadInput);
  scene::print_format("%s", scene::key_schema(*keys, "Thimble " + file + " file").c_str());
  return kExitDone;
}

}  // namespace

void add_help_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "help", "List the keys of scene and arm files, with meaning, unit and limits");
  auto options = std::make_shared<HelpOptions>();
  command->add_option("FILE", options->file, "Kind of file, or schema: a JSON Schema for editors")
      ->check(CLI::IsMember({"scene", "arm", "schema"}))
      ->capture_default_str();
  command->add_option("KEY", options->key,
                      "Key to print (default: all); after schema: scene or arm");
  command->add_flag("--page", options->page, "Print the keys as a page of the guide (Markdown)");
  add_example(*command, "thimble help scene stiffness");
  command->callback([options, &exit_code] {
    exit_code = options->file == "schema" ? print_schema(*options) : print_keys(*options);
  });
}

}  // namespace thimble::cli
