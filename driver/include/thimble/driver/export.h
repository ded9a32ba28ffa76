#pragma once

/// @file
/// Export macro of the libraries driver, device_sim, render, scene and session.

/// Marks functions and classes that another library or program may link. It gives them default
/// visibility in a shared build (`BUILD_SHARED_LIBS=ON`), which defines `THIMBLE_SHARED` for the
/// libraries and for every target that links them. All other symbols are hidden. It expands to
/// nothing in a static build. One macro serves all libraries, because ELF uses the same attribute
/// for export and import.
#ifdef THIMBLE_SHARED
#define THIMBLE_EXPORT __attribute__((visibility("default")))
#else
#define THIMBLE_EXPORT
#endif
