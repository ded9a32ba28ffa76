#pragma once

/* All of HDU, as programs written for HDAPI include it. */

#include <HD/hd.h>
#include <HDU/hduError.h>
#include <HDU/hduMath.h>
#include <HDU/hduVector.h>
#ifdef __cplusplus
#include <HDU/hduMatrix.h>
#include <HDU/hduQuaternion.h>
#endif
