#pragma once

/* HDAPI as implemented by Thimble's libHD.so, to build programs written for HDAPI. Written for
 * Thimble: names, types and numbers are those that public programs use
 * (app/compat/PROVENANCE.md); the text is Thimble's.
 *
 * Units: mm, mm/s, rad, rad/s, N, N mm. Axes: x right, y up, z to the user. A transform is 16
 * numbers, column by column. For C and C++. */

#include <limits.h>
#include <stddef.h>

#include <HD/hdDefines.h>

#define HDAPIENTRY
#define HDCALLBACK
#define HD_DEVICE_ERROR(X) (((X).errorCode) != HD_SUCCESS)

#ifdef __cplusplus
extern "C" {
#endif

typedef int HDint;
typedef unsigned int HDuint;
typedef unsigned char HDboolean;
typedef unsigned short HDushort;
typedef unsigned long HDulong;
typedef float HDfloat;
typedef double HDdouble;
typedef long HDlong;
typedef char HDchar;
typedef unsigned int HDenum;
typedef unsigned int HDerror;
typedef unsigned int HHD;
typedef const char* HDstring;
typedef unsigned long HDSchedulerHandle;
typedef unsigned int HDCallbackCode;
typedef HDCallbackCode (*HDSchedulerCallback)(void*);

/** Error information, returned by value. */
typedef struct {
  HDerror errorCode;
  int internalErrorCode;
  HHD hHD;
} HDErrorInfo;

/** Wait mode of hdWaitForCompletion. */
typedef enum { HD_WAIT_CHECK_STATUS = 0, HD_WAIT_INFINITE = 1 } HDWaitCode;

/* Arms. */

/** Opens an arm, given by NULL, "Default Device", "PHANToM 1" and so on, or its name. */
HHD hdInitDevice(HDstring name);
/** Closes an arm with zero force. */
void hdDisableDevice(HHD device);
/** Makes an arm the current arm of the calling thread, to which all its calls apply. */
void hdMakeCurrentDevice(HHD device);
/** Returns the current arm of the calling thread. */
HHD hdGetCurrentDevice(void);
/** Begins a frame; all values read in a frame are from one tick. */
void hdBeginFrame(HHD device);
/** Ends a frame and sends the force that was set. */
void hdEndFrame(HHD device);

/* Capabilities and parameters of the current arm. */

void hdEnable(HDenum capability);
void hdDisable(HDenum capability);
HDboolean hdIsEnabled(HDenum capability);
void hdGetBooleanv(HDenum parameter, HDboolean* values);
void hdGetIntegerv(HDenum parameter, HDint* values);
void hdGetFloatv(HDenum parameter, HDfloat* values);
void hdGetDoublev(HDenum parameter, HDdouble* values);
void hdGetLongv(HDenum parameter, HDlong* values);
HDstring hdGetString(HDenum parameter);
void hdSetBooleanv(HDenum parameter, const HDboolean* values);
void hdSetIntegerv(HDenum parameter, const HDint* values);
void hdSetFloatv(HDenum parameter, const HDfloat* values);
void hdSetDoublev(HDenum parameter, const HDdouble* values);
void hdSetLongv(HDenum parameter, const HDlong* values);

/* Errors. */

/** Removes the newest error from the stack and returns it; HD_SUCCESS if there is none. */
HDErrorInfo hdGetError(void);
/** Returns the meaning of an error. */
HDstring hdGetErrorString(HDerror error);

/* Calibration. */

HDenum hdCheckCalibration(void);
HDenum hdCheckCalibrationStyle(void);
void hdUpdateCalibration(HDenum style);
void hdUpdateCalibrationMessage(HDenum style);
void hdScaleGimbalAngles(HDdouble scale1, HDdouble scale2, HDdouble scale3, HDdouble transform[16]);

/* The scheduler: callbacks in each tick, the highest priority first. */

void hdStartScheduler(void);
void hdStopScheduler(void);
void hdSetSchedulerRate(HDulong hertz);
HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data,
                                         HDushort priority);
void hdScheduleSynchronous(HDSchedulerCallback callback, void* data, HDushort priority);
void hdUnschedule(HDSchedulerHandle handle);
HDboolean hdWaitForCompletion(HDSchedulerHandle handle, HDWaitCode code);
HDdouble hdGetSchedulerTimeStamp(void);

HDboolean hdDeploymentLicense(const char* vendor, const char* application, const char* password);

#ifdef __cplusplus
}
#endif
