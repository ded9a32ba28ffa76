#pragma once

// Deprecated: former header of ContactForceLaw.
#include "thimble/render/object_touch.h"
