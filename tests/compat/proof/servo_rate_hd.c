/* Sets the rate of the scheduler, of which 500 Hz is every second tick, and reads it back. */
#include <HD/hd.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

static int ticks, late;

static HDCallbackCode HDCALLBACK push(void* data) {
  const double origin[3] = {0, 0, 0};
  double p[3], f[3];
  HDint rate = 0;
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetIntegerv(HD_UPDATE_RATE, &rate);
  hdGetDoublev(HD_CURRENT_POSITION, p);
  spring_force(0.02, origin, p, f);
  hdSetDoublev(HD_CURRENT_FORCE, f);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, p, f);
  if (hdGetSchedulerTimeStamp() < 0 || rate <= 0) ++late;
  return ++ticks < kProofTicks / 2 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

int main(int argc, char** argv) {
  HDSchedulerHandle handle;
  HHD device;
  proof_begin(argc, argv);
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  hdSetSchedulerRate(1234);
  PROOF(hdGetError().errorCode == HD_INVALID_VALUE);
  hdSetSchedulerRate(500);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  hdEnable(HD_FORCE_OUTPUT);
  handle = hdScheduleAsynchronous(push, 0, HD_MAX_SCHEDULER_PRIORITY);
  hdStartScheduler();
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(ticks == kProofTicks / 2 && late == 0);
  return proof_end();
}
