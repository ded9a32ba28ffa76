/* A sphere of 20 mm, in the order of calls of the usual first program. */
#include <HD/hd.h>
#include <HDU/hduError.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

static int ticks;
static double deepest;

static HDCallbackCode HDCALLBACK feel(void* data) {
  const Sphere* sphere = data;
  double p[3], f[3], depth;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, p);
  depth = sphere_force(sphere, p, f);
  if (depth > deepest) deepest = depth;
  hdSetDoublev(HD_CURRENT_FORCE, f);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, p, f);
  return ++ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

int main(int argc, char** argv) {
  Sphere sphere = {{0, 0, 0}, 20, 0.25}; /* mm, N/mm */
  HDSchedulerHandle handle;
  HDErrorInfo error;
  HHD device;
  proof_begin(argc, argv);
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (HD_DEVICE_ERROR(error = hdGetError())) {
    hduPrintError(stderr, &error, "Failed to initialise");
    return 2;
  }
  PROOF(hdGetString(HD_DEVICE_MODEL_TYPE)[0] != 0);
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  handle = hdScheduleAsynchronous(feel, &sphere, HD_DEFAULT_SCHEDULER_PRIORITY);
  while (hdWaitForCompletion(handle, HD_WAIT_CHECK_STATUS)) {
  }
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(ticks == kProofTicks && deepest > 2 && !HD_DEVICE_ERROR(hdGetError()));
  return proof_end();
}
