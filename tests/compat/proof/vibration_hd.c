/* A vibration of 20 Hz along the vertical axis. The amplitude is a fraction of the continuous
 * force; the phase comes from the rate of the scheduler. */
#include <HD/hd.h>
#include <HDU/hduVector.h>

#include "proof_hd.h"

static double amplitude, timer;
static int ticks;

static HDCallbackCode HDCALLBACK vibrate(void* data) {
  const hduVector3Dd direction = {0, 1, 0};
  hduVector3Dd position, force;
  HDint rate = 0;
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetIntegerv(HD_INSTANTANEOUS_UPDATE_RATE, &rate);
  if (rate > 0) timer += 1.0 / rate;
  hdGetDoublev(HD_CURRENT_POSITION, position);
  hduVecScale(force, direction, amplitude * sin(timer * 2 * 3.14159265358979 * 20));
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, position, force);
  return ++ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

int main(int argc, char** argv) {
  HDSchedulerHandle handle;
  HHD device;
  proof_begin(argc, argv);
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  hdGetDoublev(HD_NOMINAL_MAX_CONTINUOUS_FORCE, &amplitude);
  PROOF(amplitude > 0);
  amplitude = 0.25 * amplitude < 0.4 ? 0.25 * amplitude : 0.4;
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  handle = hdScheduleAsynchronous(vibrate, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdUnschedule(handle);
  PROOF(hdGetError().errorCode == HD_INVALID_VALUE); /* it has ended, so it has no handle */
  hdDisableDevice(device);
  PROOF(timer > 1.4 && timer < 1.6);
  return proof_end();
}
