#pragma once

/* Included by programs that name the parts of HDAPI; all of them are in hd.h. */

#include <HD/hd.h>
