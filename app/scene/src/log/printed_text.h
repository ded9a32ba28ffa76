#pragma once

#include <cstdarg>
#include <cstdio>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

// The only way of this program's own texts to standard output; those to standard error go through
// Console, by the loggers. Both leave out what a terminal would obey (driver::printable): names
// come from files of unknown origin. tests/arch/printing.sh looks for prints elsewhere.

/// Writes a text, printable. A write that fails is ignored: the caller may hold an arm, which an
/// exception would leave with its last force. Real-time: never from the servo thread.
THIMBLE_EXPORT void write_text(std::FILE* stream, std::string_view text);

/// Prints to standard output as std::printf does, by `write_text`. Real-time: never from the servo
/// thread.
[[gnu::format(printf, 1, 2)]] THIMBLE_EXPORT void print_format(const char* format, ...);

/// Shows a text on the last line of the terminal, instead of the one before; an empty one removes
/// it. Shows nothing if standard error is no terminal. Real-time: never from the servo thread.
void show_progress(std::string_view text);

}  // namespace thimble::scene
