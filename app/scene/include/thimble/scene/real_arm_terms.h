#pragma once

// Deprecated: former header of ArmPolicy.
#include "thimble/scene/arm_policy.h"
