#pragma once

// Deprecated: former header of Figure.
#include "thimble/session/run_figures.h"
