#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace thimble::cli {

/// Adds `--theme`, light or dark, to a command that draws.
inline CLI::Option* add_theme_option(CLI::App& command, std::string& theme,
                                     const std::string& about) {
  return command.add_option("--theme", theme, about)->check(CLI::IsMember({"light", "dark"}));
}

}  // namespace thimble::cli
