#pragma once

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "support/scratch.h"

namespace thimble::firmware_test {

/// Writes an arm file of the vintage PHANTOM with a board that runs the reference firmware, and the
/// described wire of that board; returns its path.
inline std::filesystem::path reference_arm() {
  const auto text_of = [](const char* file) {
    std::ifstream in(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" / file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  };
  std::string arm = text_of("vintage_phantom.yaml");
  arm = std::regex_replace(arm, std::regex("\n(name|board|board_model):[^\n]*"), "");
  arm = std::regex_replace(arm, std::regex("\nprotocol:[^\n]*"),
                           "\nname: reference\nprotocol: described");
  arm = std::regex_replace(arm, std::regex("watchdog: 0\\.1 "), "watchdog: 0.05 ");
  arm = std::regex_replace(arm, std::regex("\n    current_range:"),
                           "\n    board: reference\n    current_range:");
  const auto path = support::scratch_folder() / "reference.yaml";
  std::ofstream(path) << arm << "\n" << text_of("wires/reference_hid.yaml");
  return path;
}

}  // namespace thimble::firmware_test
