#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace thimble::fuzz {

/// Lists the kinds of files that the program reads. The corpus of each is the folder of its name in
/// tests/fuzz/files.
inline constexpr std::array<std::string_view, 14> kFileKinds{
    "scene", "arm", "off", "obj", "stl", "ply",  "gltf",
    "glb",   "3mf", "dae", "amf", "3ds", "page", "recording"};

/// Reads bytes as a file of a kind, by the functions that the program itself calls, and uses what
/// came out of it as the program would. Every reader must survive any bytes: it refuses them with a
/// sentence, or what it gives is sound. Answers whether the file was taken. Breaks off the process
/// if a promise is broken. Precondition: `kind` is one of kFileKinds.
///
/// A recording and a page file are given by what is damaged of a sound one: place (4 bytes, modulo
/// the size of the file), count (1, at most 16), the bytes to put there, as often as there are
/// bytes. Before the orders for pages stands a byte: odd, to put the checksums right again.
bool read_any_file(std::string_view kind, std::span<const std::byte> bytes);

}  // namespace thimble::fuzz
