#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns whether the bytes are an STL file in text form. A binary one may begin with "solid" too:
/// its length and its first facet decide. Real-time: never from the servo thread.
bool is_stl_text(std::string_view bytes);

/// Returns whether the bytes are a binary STL file, by the number of triangles in its head and its
/// length. Real-time: never from the servo thread.
bool is_stl_binary(std::string_view bytes);

/// Reads the bytes of an STL file, text or binary. A text may have coordinates in double precision,
/// facets of any number of corners, several solids, and words in either case. Normals are ignored.
/// Bytes after the last triangle of a binary file are ignored and reported in `notes`, and so is a
/// text without its end. Not welded. The error begins with the file's `name` and the line of a text
/// ("a.stl:12: ..."), or is a sentence. Memory grows with the bytes. Real-time: never from the
/// servo thread.
driver::Result<TriangleMesh> read_stl(std::string_view bytes, const std::string& name,
                                      std::vector<std::string>& notes);

}  // namespace thimble::render
