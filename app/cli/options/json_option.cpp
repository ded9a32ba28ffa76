#include "cli/options/json_option.h"

#include <string>

#include "log/printed_text.h"
#include "report/json_text.h"
#include "thimble/scene/build_info.h"

namespace thimble::cli {
namespace {

/// Version of all formats; it grows if a member is renamed, removed or changes its meaning.
constexpr int kVersion = 1;

bool asked = false;

}  // namespace

CLI::Option* add_json_option(CLI::App& command) {
  return command.add_flag_callback(
      "--json",
      [] {
        asked = true;
        scene::print_text_to_stderr();
      },
      "Print the result as JSON; other text to stderr");
}

bool json_asked() noexcept {
  return asked;
}

void print_json(std::string_view name, const nlohmann::ordered_json& result) {
  if (!asked) return;
  nlohmann::ordered_json whole{{"format", "thimble." + std::string(name)},
                               {"version", kVersion},
                               {"thimble", scene::build_info().version}};
  whole.update(result);
  scene::write_text(stdout, report::json_text(whole, 2) + "\n");
}

}  // namespace thimble::cli
