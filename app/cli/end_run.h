#pragma once

#include "cli/exit_code.h"
#include "thimble/driver/real_time.h"
#include "thimble/session/session.h"

namespace thimble::cli {

/// Returns whether every arm of a run took its last zero force.
bool zero_assured(const session::Session& session);

/// Prints how a run went; of several arms, each under its name. `grant`: what the kernel granted
/// the servo's thread.
void print_summaries(const session::Session& session, const driver::RealTimeGrant& grant);

/// Returns the exit code of a run that is over; with several arms the fault of any counts.
/// `by_viewer`: whether a viewer ended it.
ExitCode end_of(const session::Session& session, bool by_viewer);

}  // namespace thimble::cli
