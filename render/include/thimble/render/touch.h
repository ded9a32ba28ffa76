#pragma once

// Deprecated: the former place of ContactForceLaw.
#include "thimble/render/object_touch.h"
