// The shared libraries are made of an archive; a CMake target needs a source.
