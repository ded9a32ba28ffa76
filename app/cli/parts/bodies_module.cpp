// The module of the package thimble-bodies (bodies.h).
#include "cli/parts/bodies.h"
#include "thimble/version.h"

extern "C" __attribute__((visibility("default")))
const thimble::cli::Bodies thimble_bodies{THIMBLE_VERSION, &thimble::render::collide_objects};
