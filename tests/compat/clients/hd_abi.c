/* A program that was built against the maker's own headers: it has only the numbers, types and
 * structs of its own build. Returns 0 if calls, results by value and callbacks fit. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "count_failures.h"

typedef struct {
  unsigned int code;
  int internal;
  unsigned int device;
} Error;

extern unsigned int hdInitDevice(const char* name);
extern void hdDisableDevice(unsigned int device);
extern void hdMakeCurrentDevice(unsigned int device);
extern unsigned int hdGetCurrentDevice(void);
extern void hdBeginFrame(unsigned int device);
extern void hdEndFrame(unsigned int device);
extern Error hdGetError(void);
extern const char* hdGetErrorString(unsigned int code);
extern void hdEnable(unsigned int capability);
extern unsigned char hdIsEnabled(unsigned int capability);
extern void hdGetBooleanv(unsigned int parameter, unsigned char* values);
extern void hdGetIntegerv(unsigned int parameter, int* values);
extern void hdGetFloatv(unsigned int parameter, float* values);
extern void hdGetDoublev(unsigned int parameter, double* values);
extern void hdGetLongv(unsigned int parameter, long* values);
extern const char* hdGetString(unsigned int parameter);
extern void hdSetDoublev(unsigned int parameter, const double* values);
extern void hdSetFloatv(unsigned int parameter, const float* values);
extern unsigned int hdCheckCalibration(void);
extern void hdUpdateCalibration(unsigned int style);
extern void hdStartScheduler(void);
extern void hdStopScheduler(void);
extern void hdSetSchedulerRate(unsigned long hertz);
extern unsigned long hdScheduleAsynchronous(unsigned int (*callback)(void*), void* data,
                                            unsigned short priority);
extern void hdScheduleSynchronous(unsigned int (*callback)(void*), void* data,
                                  unsigned short priority);
extern void hdUnschedule(unsigned long handle);
extern unsigned char hdWaitForCompletion(unsigned long handle, int code);
extern double hdGetSchedulerTimeStamp(void);

static int calls;

static unsigned int push(void* data) {
  const double force[3] = {0, 0.25, 0};
  double read[3] = {7, 7, 7};
  hdBeginFrame(0);
  hdGetDoublev(0x2700, read);
  if (read[0] != 0 || read[1] != 0) ++*(int*)data;
  hdSetDoublev(0x2700, force);
  hdEndFrame(0);
  return ++calls < 600 ? 1u : 0u; /* continue, or done */
}

static unsigned int ask(void* data) {
  *(double*)data = hdGetSchedulerTimeStamp();
  return 0;
}

int main(void) {
  Error error;
  int number[6] = {-7, -7, -7, -7, -7, -7}, wrong = 0;
  long counts[7] = {-7, -7, -7, -7, -7, -7, -7};
  double d[16], stamp = -1;
  float f[3];
  unsigned char flag = 7;
  unsigned long handle;
  CHECK(hdInitDevice(NULL) == 0 && hdGetCurrentDevice() == 0);
  hdEnable(0x1234);
  error = hdGetError();
  CHECK(error.code == 0x0100 && error.internal == 0 && error.device == 0);
  error = hdGetError();
  CHECK(error.code == 0 && strlen(hdGetErrorString(0x0302)) > 3);
  hdUpdateCalibration(2);
  CHECK(hdCheckCalibration() == 0x5000);
  hdGetIntegerv(0x2554, number);
  CHECK(number[0] == 3 && number[1] == -7);
  hdGetLongv(0x2010, counts);
  CHECK(counts[3] == 0 && counts[5] == 0 && counts[6] == -7);
  hdGetBooleanv(0x2001, &flag);
  CHECK(flag == 1);
  hdGetFloatv(0x2602, f);
  hdGetDoublev(0x2602, d);
  CHECK(f[0] == (float)d[0]);
  hdGetDoublev(0x2052, d);
  CHECK(d[0] == 1 && d[15] == 1);
  CHECK(strcmp(hdGetString(0x2501), "vintage_phantom") == 0 && strlen(hdGetString(0x2504)) > 0);
  hdEnable(0x4000);
  CHECK(hdIsEnabled(0x4000) == 1 && hdIsEnabled(0x4002) == 0);
  hdSetSchedulerRate(1000UL);
  handle = hdScheduleAsynchronous(push, &wrong, 0xffff);
  CHECK(handle != 0);
  hdStartScheduler();
  hdScheduleSynchronous(ask, &stamp, 0);
  CHECK(stamp >= 0 && stamp < 1);
  CHECK(hdWaitForCompletion(handle, 0) == 1); /* still scheduled */
  CHECK(hdWaitForCompletion(handle, 1) == 1);
  hdGetDoublev(0x2800, d);
  hdStopScheduler();
  CHECK(wrong == 0 && calls == 600);
  CHECK(d[1] > 0.24 && d[1] < 0.26 && d[0] > -0.01 && d[0] < 0.01);
  error = hdGetError();
  CHECK(error.code == 0);
  hdDisableDevice(0);
  hdMakeCurrentDevice(0);
  CHECK(hdGetError().code == 0x0104);
  printf("ABI of HDAPI: %d failures\n", failures);
  return failures != 0;
}
