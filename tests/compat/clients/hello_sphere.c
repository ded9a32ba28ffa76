/* A sphere of 20 mm that pushes the tip out, like the usual first program for HDAPI. Returns 0 if
 * the sent force equals the requested one. */
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "client_sphere.h"

static Sphere sphere = {{0, 0, 0}, 20, 0.25}; /* mm, N/mm */
static ForceLog asked;
static double asked_before[3], largest_difference, deepest;
static int compared;

static HDCallbackCode HDCALLBACK feel(void* data) {
  double p[3], f[3], sent[3], depth;
  HDErrorInfo error;
  int i;
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, p);
  depth = sphere_force(&sphere, p, f);
  if (depth > deepest) deepest = depth;
  hdSetDoublev(HD_CURRENT_FORCE, f);
  log_force(&asked, f);
  /* The force sent in the previous tick must be the one requested before it. */
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

int main(int argc, char** argv) {
  const SphereChoice choice = sphere_choice(argc, argv, &sphere, &asked);
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
  handle = hdScheduleAsynchronous(feel, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  usleep((useconds_t)(1e6 * choice.seconds));
  hdStopScheduler();
  hdUnschedule(handle);
  hdDisableDevice(device);
  printf("%d callbacks, %.2f mm deep, force off by %.4f N at most\n", compared, deepest,
         largest_difference);
  if (write_forces(&asked, choice.log_file)) return 5;
  if (compared < 700 * choice.seconds || !(deepest > 1)) return 3;
  /* With a log, the test itself compares each force, including those limited by the gate. */
  return choice.log_file || largest_difference < 0.2 ? 0 : 4;
}
