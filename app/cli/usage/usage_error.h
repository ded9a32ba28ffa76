#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace thimble::cli {

/// Returns the error message for a command line that the argument library rejected. It names the
/// unknown or wrong word, what was expected, the nearest known word, and where to read more.
/// `program`: in the state in which the library left it. Real-time: never from the servo thread.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error);

/// Returns the sentence for a word that no argument of a command accepts: an unknown command, an
/// unknown option, or a surplus argument. Real-time: never from the servo thread.
std::string unknown_word(const CLI::App& command, const std::string& word);

/// Returns " Did you mean NAME?" for the known word nearest to `word`, or "".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// Removes the `--` between the options of a command and the program that the command starts. The
/// argument library would parse the words after it as ours. `words`: without the name of this
/// program.
std::vector<std::string> without_separator(const CLI::App& program, std::vector<std::string> words);

/// Makes every numeric option reject all but decimal numbers. The argument library would accept
/// hexadecimal and octal forms, infinities and NaN. Call after all commands were added.
void check_numbers(CLI::App& program);

/// Makes every text option reject an empty text. Otherwise an unset variable of a script could mean
/// that no file is written, or that no enabling input is used. Call after all commands were added.
void check_texts(CLI::App& program);

}  // namespace thimble::cli
