// The shared libraries of a face are made of its archive; a target needs a source.
