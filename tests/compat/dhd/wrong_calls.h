#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drdc.h"

namespace thimble::compat {

// A call with one null pointer or one wrong number; the number of the arm is the caller's.
struct Call {
  std::string name;
  std::function<int(char)> call;
  int error = DHD_ERROR_NULL_ARGUMENT;
};

// Every function that takes pointers, once with each of them null.
std::vector<Call> calls_with_null();
// Every function that checks numbers, once with each of them wrong.
std::vector<Call> calls_with_bad_numbers();
// What wants nothing but an arm that is open.
std::vector<Call> calls_of_an_arm();
// All of them.
std::vector<Call> all_calls();

}  // namespace thimble::compat
