#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace thimble::fuzz {

/// Kinds of files that the program reads. The corpus of each is the folder of its name in
/// tests/fuzz/files.
inline constexpr std::array<std::string_view, 15> kFileKinds{
    "scene", "arm", "wire", "off", "obj", "stl",  "ply",      "gltf",
    "glb",   "3mf", "dae",  "amf", "3ds", "page", "recording"};

/// Reads bytes as a file of a kind with the program's own functions, and uses the result as the
/// program would. Every reader must survive any bytes: it returns an error with a message, or a
/// valid result. Returns whether the file was accepted. Aborts the process if a check fails.
/// Precondition: `kind` is one of kFileKinds.
///
/// For a recording and a page file the bytes describe the damage to a valid file: place (4 bytes,
/// modulo the size of the file), count (1 byte, at most 16), the bytes to write there; repeated.
/// For pages, a byte precedes this: odd, to correct the checksums.
bool read_any_file(std::string_view kind, std::span<const std::byte> bytes);

}  // namespace thimble::fuzz
