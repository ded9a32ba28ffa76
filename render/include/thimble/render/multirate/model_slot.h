#pragma once

// Deprecated: former header of ModelSlot.
#include "thimble/render/multirate/local_model.h"
