#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drdc.h"

namespace thimble::compat {

// A call with one null pointer or one wrong number. The caller gives the number of the arm.
struct Call {
  std::string name;
  std::function<int(char)> call;
  int error = DHD_ERROR_NULL_ARGUMENT;
};

// Returns every function that takes pointers, once for each null pointer.
std::vector<Call> calls_with_null();
// Returns every function that checks numbers, once for each wrong number.
std::vector<Call> calls_with_bad_numbers();
// Returns the functions that only need an open arm.
std::vector<Call> calls_of_an_arm();
// Returns all of these calls.
std::vector<Call> all_calls();

}  // namespace thimble::compat
