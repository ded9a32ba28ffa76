#pragma once

#include "cli/exit_code.h"
#include "thimble/driver/real_time.h"
#include "thimble/session/session.h"

namespace thimble::cli {

/// Returns whether every arm of a run took its last zero force.
bool zero_assured(const session::Session& session);

/// Prints the summary of a run; with several arms, each under its name. `grant`: the real-time
/// priority that the kernel granted to the servo thread.
void print_summaries(const session::Session& session, const driver::RealTimeGrant& grant);

/// Returns the exit code of a finished run; with several arms, the fault of any arm counts.
/// `by_viewer`: whether a viewer ended the run.
ExitCode end_of(const session::Session& session, bool by_viewer);

}  // namespace thimble::cli
