#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace thimble::cli {

/// Group of old names, which no help shows. The library's own hidden options, those without a
/// group, have no name in its errors.
inline constexpr const char* kOldNames = "Old names";

/// Makes a command accept the old name of a renamed option: hidden from the help, with a warning,
/// and not together with the new name. `value` is that of `option`. Returns the old option, which
/// needs the same checks. Real-time: never from the servo thread.
template <class Value>
CLI::Option* add_old_name(CLI::App& command, const std::string& old_name, CLI::Option* option,
                          Value& value) {
  // The description, which no help shows, is the new name for the warning.
  return command.add_option(old_name, value, option->get_name())
      ->group(kOldNames)
      ->excludes(option);
}

/// Warns of each old name on the command line; call it after the command line is parsed.
/// Real-time: never from the servo thread.
void warn_of_old_names(const CLI::App& command);

}  // namespace thimble::cli
