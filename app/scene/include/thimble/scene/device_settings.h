#pragma once

// Deprecated: former header of device_settings.
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
