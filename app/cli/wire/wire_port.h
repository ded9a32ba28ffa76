#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wires/wire_table.h"

namespace thimble::cli {

/// Prints the timing of the reports of a board, which is named as in `thimble devices` or by its
/// port. Nothing is sent to a board that streams. A board that answers commands gets zero force, if
/// its USB properties and its start-up answers are those of the installed arm file. Returns the
/// exit code; `result` gets the figures as "port". Real-time: never from the servo thread.
int time_port(const std::string& file, const driver::WireTable& wire, const std::string& device,
              nlohmann::ordered_json& result);

}  // namespace thimble::cli
