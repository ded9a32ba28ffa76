#pragma once

/* Error messages for programs written for HDAPI. */

#include <HD/hd.h>
#include <stdio.h>

/** Returns the meaning of an error. */
static inline const char* hduGetErrorString(HDerror error) {
  return hdGetErrorString(error);
}

/** Prints a message and the meaning of an error. */
static inline void hduPrintError(FILE* file, const HDErrorInfo* error, const char* message) {
  fprintf(file, "%s: %s (0x%04x, device %u)\n", message, hdGetErrorString(error->errorCode),
          error->errorCode, error->hHD);
}

/** Returns whether callbacks stop after an error. */
static inline HDboolean hduIsSchedulerError(const HDErrorInfo* error) {
  switch (error->errorCode) {
    case HD_COMM_ERROR:
    case HD_SCHEDULER_FULL:
    case HD_INVALID_PRIORITY:
    case HD_TIMER_ERROR:
    case HD_DEVICE_FAULT:
      return HD_TRUE;
    default:
      return HD_FALSE;
  }
}

/** Returns whether an error concerns the forces of the arm. */
static inline HDboolean hduIsForceError(const HDErrorInfo* error) {
  switch (error->errorCode) {
    case HD_WARM_MOTORS:
    case HD_EXCEEDED_MAX_FORCE:
    case HD_EXCEEDED_MAX_FORCE_IMPULSE:
    case HD_EXCEEDED_MAX_VELOCITY:
    case HD_FORCE_ERROR:
      return HD_TRUE;
    default:
      return HD_FALSE;
  }
}
