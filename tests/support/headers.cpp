// Stands for the headers that all tests share (tests/CMakeLists.txt); a target needs a source.
