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

/// Prints to standard output as std::printf does, through `write_text`. Real-time: never from the
/// servo thread.
[[gnu::format(printf, 1, 2)]] THIMBLE_EXPORT void print_format(const char* format, ...);

/// Replaces the text on the last line of the terminal; an empty one removes it. Does nothing if
/// standard error is not a terminal. Real-time: never from the servo thread.
void show_progress(std::string_view text);

}  // namespace thimble::scene
