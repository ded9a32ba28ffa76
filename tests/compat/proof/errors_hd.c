/* Reads the error stack after each frame. Wrong calls between frames and an excessive force for
 * some frames leave errors; the program continues with its spring. */
#include <HD/hd.h>
#include <HDU/hduError.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

static int ticks, excessive, wrong;

static HDCallbackCode HDCALLBACK push(void* data) {
  const double origin[3] = {0, 0, 0};
  double p[3], f[3], much[3] = {0, 50, 0};
  HDErrorInfo error;
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, p);
  spring_force(0.02, origin, p, f);
  hdSetDoublev(HD_CURRENT_FORCE, ticks == 400 ? much : f);
  if (ticks % 100 == 0) hdGetDoublev(0x7777, p); /* no such parameter */
  hdEndFrame(hdGetCurrentDevice());
  if (ticks != 400) proof_note_hd(0, p, f);
  while (HD_DEVICE_ERROR(error = hdGetError())) {
    if (error.errorCode == HD_INVALID_ENUM) ++wrong;
    if (error.errorCode == HD_EXCEEDED_MAX_FORCE) ++excessive;
    if (hduIsForceError(&error)) continue;
    if (hduIsSchedulerError(&error)) return HD_CALLBACK_DONE;
  }
  return ++ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

int main(int argc, char** argv) {
  HDSchedulerHandle handle;
  HHD device;
  proof_begin(argc, argv);
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  PROOF(hdInitDevice("no such arm") == HD_INVALID_HANDLE);
  PROOF(hdGetError().errorCode == HD_COMM_CONFIG_ERROR);
  hdDisable(HD_SOFTWARE_FORCE_IMPULSE_LIMIT); /* so that the whole force meets the limit */
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  handle = hdScheduleAsynchronous(push, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(ticks == kProofTicks && wrong == kProofTicks / 100 && excessive > 0);
  return proof_end();
}
