// Pushes with a constant force while it monitors the temperature of the motors, one number for
// each.
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <HDU/hduVector.h>

#include "proof_hd.h"

namespace {

struct Motors {
  int ticks = 0, warnings = 0, motors = 0;
  double hottest = 0;
  bool guarded = true;
};

HDCallbackCode HDCALLBACK push(void* data) {
  Motors& motors = *static_cast<Motors*>(data);
  hduVector3Dd position;
  const hduVector3Dd force(0.3, 0.2, -0.1);
  HDdouble heat[7] = {-7, -7, -7, -7, -7, -7, -7};
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_MOTOR_TEMPERATURE, heat);
  hdGetDoublev(HD_CURRENT_POSITION, position);
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, position, force);
  for (int i = 0; i < 7; ++i) {
    if (i < motors.motors && heat[i] > motors.hottest) motors.hottest = heat[i];
    if (i >= motors.motors && heat[i] != -7) motors.guarded = false;
  }
  const HDErrorInfo error = hdGetError();
  if (HD_DEVICE_ERROR(error)) {
    if (error.errorCode != HD_WARM_MOTORS) return HD_CALLBACK_DONE;
    ++motors.warnings;
  }
  return ++motors.ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

}  // namespace

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  Motors motors;
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  hdGetIntegerv(HD_OUTPUT_DOF, &motors.motors);
  PROOF(motors.motors == 3);
  const HDSchedulerHandle handle =
      hdScheduleAsynchronous(push, &motors, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(motors.ticks == kProofTicks && motors.guarded && motors.warnings == 0);
  PROOF(motors.hottest >= 0 && motors.hottest < 0.8);  // of the limit
  return proof_end();
}
