#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "wires/wire_table.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads the section `wire` of an arm file and compiles it. Mistakes are recorded with their lines;
/// the result is then null. Real-time: never from the servo thread.
std::shared_ptr<const driver::WireTable> read_wire(YamlMap map);

/// Reads the section `wire` of a file and ignores its other keys, so that a wire can be checked
/// before the rest of an arm file is written. The errors are those of an arm file. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT driver::Result<std::shared_ptr<const driver::WireTable>> load_wire(
    const std::filesystem::path& file);

/// Returns the name of a field of a described wire in arm files: "encoder_1".
THIMBLE_EXPORT std::string wire_field_name(driver::WireItem item, std::size_t axis);

}  // namespace thimble::scene
