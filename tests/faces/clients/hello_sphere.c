/* A sphere of 20 mm that pushes the tip out, as the first example of HDAPI that anybody writes.
 * Ends with 0 if the force that was sent is the one that was asked for. */
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

static const double radius = 20, stiffness = 0.25; /* mm, N/mm */
static double asked_before[3], largest_difference, deepest;
static int compared;

static HDCallbackCode HDCALLBACK sphere(void* data) {
  double p[3], f[3] = {0, 0, 0}, sent[3], distance;
  HDErrorInfo error;
  int i;
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, p);
  distance = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  if (distance < radius && distance > 0) {
    for (i = 0; i < 3; ++i) f[i] = stiffness * (radius - distance) * p[i] / distance;
    if (radius - distance > deepest) deepest = radius - distance;
  }
  hdSetDoublev(HD_CURRENT_FORCE, f);
  /* What the tick before has sent is what was asked for before. */
  hdGetDoublev(HD_LAST_FORCE, sent);
  hdEndFrame(hdGetCurrentDevice());
  for (i = 0; i < 3; ++i) {
    const double difference = fabs(sent[i] - asked_before[i]);
    if (compared > 1000 && difference > largest_difference) largest_difference = difference;
    asked_before[i] = f[i];
  }
  ++compared;
  error = hdGetError();
  if (HD_DEVICE_ERROR(error)) {
    hduPrintError(stderr, &error, "in the callback");
    if (hduIsSchedulerError(&error)) return HD_CALLBACK_DONE;
  }
  return HD_CALLBACK_CONTINUE;
}

int main(void) {
  HDSchedulerHandle handle;
  HDErrorInfo error;
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  error = hdGetError();
  if (HD_DEVICE_ERROR(error)) {
    hduPrintError(stderr, &error, "Failed to initialise");
    return 2;
  }
  printf("%s by %s\n", hdGetString(HD_DEVICE_MODEL_TYPE), hdGetString(HD_DEVICE_VENDOR));
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  handle = hdScheduleAsynchronous(sphere, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  usleep(3500000);
  hdStopScheduler();
  hdUnschedule(handle);
  hdDisableDevice(device);
  printf("%d callbacks, %.2f mm deep, force off by %.4f N at most\n", compared, deepest,
         largest_difference);
  if (compared < 2500 || !(deepest > 1)) return 3;
  return largest_difference < 0.2 ? 0 : 4;
}
