#pragma once

#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

// All text of this program to standard output is written by these functions; text to standard error
// is written by Console, through the loggers. Both remove terminal control characters
// (driver::printable), because names come from files of unknown origin. tests/arch/printing.sh
// finds other output.

/// Writes the printable characters of a text. Write errors are ignored: the caller may hold an arm,
/// which an exception would leave with its last force. Real-time: never from the servo thread.
THIMBLE_EXPORT void write_text(std::FILE* stream, std::string_view text);

/// Lets the text of commands go to standard error from now on, because standard output is for JSON.
/// Call it before other threads print.
THIMBLE_EXPORT void print_text_to_stderr() noexcept;

/// Returns the stream of the text of commands: standard output, unless `print_text_to_stderr` was
/// called.
THIMBLE_EXPORT std::FILE* text_stream() noexcept;

/// Prints to `text_stream` as std::printf does, through `write_text`. Real-time: never from the
/// servo thread.
[[gnu::format(printf, 1, 2)]] THIMBLE_EXPORT void print_format(const char* format, ...);

/// Colour of a text at a terminal.
enum class Tone { kPlain, kGood, kAdvice, kBad };

/// Prints a text in a colour, if `text_stream` is a terminal and NO_COLOR is not set [S
/// no-color.org]; otherwise as `print_format`. Real-time: never from the servo thread.
THIMBLE_EXPORT void print_toned(Tone tone, std::string_view text);

}  // namespace thimble::scene
