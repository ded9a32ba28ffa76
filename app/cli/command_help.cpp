#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/usage/help_text.h"
#include "cli/usage/usage_error.h"
#include "log/printed_text.h"
#include "scene_keys.h"

namespace thimble::cli {
namespace {

struct HelpOptions {
  std::string file = "scene";
  std::string key;
  bool page = false;
};

int print_keys(const HelpOptions& options) {
  std::vector<scene::KeyNote> keys;
  if (options.file == "arm") {
    keys = scene::arm_keys();
  } else {
    auto found = scene::scene_keys();
    if (!found) return complain(found.error(), kExitBadInput);
    keys = std::move(found).value();
  }
  const std::string text =
      options.page ? scene::key_page(keys) : scene::key_text(keys, options.key);
  if (text.empty()) {
    std::vector<std::string> names;
    for (const scene::KeyNote& key : keys) names.push_back(key.key);
    return complain(driver::Error{"KEY: there is no key \"" + options.key + "\" in " +
                                  options.file + " files. `thimble help " + options.file +
                                  "` lists all keys." + suggestion(options.key, names)},
                    kExitBadInput);
  }
  scene::print_format("%s", text.c_str());
  return kExitDone;
}

}  // namespace

void add_help_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("help", "List the keys of scene and arm files, with units and limits");
  auto options = std::make_shared<HelpOptions>();
  command->add_option("FILE", options->file, "Kind of file")
      ->check(CLI::IsMember({"scene", "arm"}))
      ->capture_default_str();
  command->add_option("KEY", options->key, "Print only keys of this name");
  command->add_flag("--page", options->page, "Print a page of the guide (Markdown)");
  add_example(*command, "thimble help scene stiffness");
  command->callback([options, &exit_code] { exit_code = print_keys(*options); });
}

}  // namespace thimble::cli
