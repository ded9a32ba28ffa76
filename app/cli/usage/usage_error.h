#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace thimble::cli {

/// Returns what is wrong with a command line that the argument library refused, in the program's
/// words: the unknown or wrong word, what was expected, the known word that is nearest to it, and
/// where to read on. `program`: as the library left it. Real-time: never from the servo thread.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error);

/// Returns the sentence for a word that none of a command's arguments takes: an unknown command,
/// an unknown option, or an argument too many. Real-time: never from the servo thread.
std::string unknown_word(const CLI::App& command, const std::string& word);

/// Returns " Did you mean NAME?" for the known word that is nearest to `word`, or "".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

/// Returns the words of a command line without the `--` that stands between the options of a
/// command and the program which that command starts: the argument library takes what follows for
/// words of ours. `words`: without the name of this program.
std::vector<std::string> without_separator(const CLI::App& program, std::vector<std::string> words);

/// Lets every option that takes numbers refuse what is no decimal number: hexadecimal and octal
/// forms, which the argument library takes, infinities and NaN. For after all commands were added.
void check_numbers(CLI::App& program);

/// Lets every option that takes a text refuse an empty one: a variable of a script that is not set
/// must not mean that a file is not written or that nothing is held to run. For after all commands
/// were added.
void check_texts(CLI::App& program);

}  // namespace thimble::cli
