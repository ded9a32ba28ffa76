// Functions that no known program uses. They exist so that a program that binds all functions can
// be loaded. They ignore their arguments and return -1 with DHD_ERROR_NOT_IMPLEMENTED.
#include "compat/dhd/last_error.h"
#include "drdc.h"

#define THIMBLE_DHD_UNANSWERED(result, name)                            \
  result name(...) {                                                    \
    return thimble::compat::dhd::fail(#name, DHD_ERROR_NOT_IMPLEMENTED, \
                                      "not implemented by Thimble");    \
  }

extern "C" {
#include "dhd_unanswered.inc"
}  // extern "C"
