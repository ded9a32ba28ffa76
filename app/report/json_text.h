#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::report {

/// Returns JSON as text: on one line, or with `indent` blanks for each level. Names come from files
/// and may contain any byte; invalid UTF-8 is replaced.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Writes JSON to a file, indented. Real-time: never from the servo thread.
driver::Result<void> write_json(const nlohmann::ordered_json& json,
                                const std::filesystem::path& file);

}  // namespace thimble::report
