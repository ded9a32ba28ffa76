/* A shared library without functions of its own. */
int thimble_any_library;
