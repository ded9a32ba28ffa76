// A plane without friction at 18 mm, which pushes up, with the length of the force below a limit.
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <HDU/hduVector.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

namespace {

int ticks = 0, touched = 0;

HDCallbackCode HDCALLBACK feel(void*) {
  hduVector3Dd position, force;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, position);
  plane_force(0.15, 18, 1, position, force);  // N/mm, mm
  if (force.magnitude() > 2) force *= 2 / force.magnitude();
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, position, force);
  if (force[1] > 0) ++touched;
  return ++ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

}  // namespace

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  const HDSchedulerHandle handle =
      hdScheduleAsynchronous(feel, nullptr, HD_DEFAULT_SCHEDULER_PRIORITY);
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdUnschedule(handle);
  hdDisableDevice(device);
  PROOF(ticks == kProofTicks && touched > 300);
  return proof_end();
}
