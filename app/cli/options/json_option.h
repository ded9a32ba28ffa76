#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string_view>

namespace thimble::cli {

/// Adds --json to a command: its result is one JSON object on standard output, and all other text
/// goes to standard error. Real-time: never from the servo thread.
CLI::Option* add_json_option(CLI::App& command);

/// Returns whether the command's result is printed as JSON.
bool json_asked() noexcept;

/// Prints the result of the command `name` on standard output, if it is asked for as JSON. The
/// object gets the members "format" ("thimble.NAME"), "version" (that of the schema
/// app/cli/schemas/NAME.json) and "thimble" (the program's version) first. A command without a
/// result, because its input is wrong, prints nothing. Real-time: never from the servo thread.
void print_json(std::string_view name, const nlohmann::ordered_json& result);

}  // namespace thimble::cli
