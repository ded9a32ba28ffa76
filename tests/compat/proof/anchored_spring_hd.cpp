// A press of the button anchors a spring at the tip; its release removes the spring.
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <HDU/hduVector.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

namespace {

struct Spring {
  hduVector3Dd anchor;
  bool anchored = false;
  double stiffness = 0.03;  // N/mm
  int ticks = 0, anchored_ticks = 0;
};

HDCallbackCode HDCALLBACK feel(void* data) {
  Spring& spring = *static_cast<Spring*>(data);
  hduVector3Dd position, force;
  HDint buttons = 0, before = 0;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetIntegerv(HD_CURRENT_BUTTONS, &buttons);
  hdGetIntegerv(HD_LAST_BUTTONS, &before);
  hdGetDoublev(HD_CURRENT_POSITION, position);
  const bool pressed = (buttons & HD_DEVICE_BUTTON_1) != 0;
  if (pressed && (before & HD_DEVICE_BUTTON_1) == 0) {
    spring.anchor = position;
    spring.anchored = true;
  } else if (!pressed) {
    spring.anchored = false;
  }
  if (spring.anchored) {
    spring_force(spring.stiffness, spring.anchor, position, force);
    ++spring.anchored_ticks;
  }
  hdSetDoublev(HD_CURRENT_FORCE, force);
  proof_note_hd(0, position, force);
  hdEndFrame(hdGetCurrentDevice());
  const HDErrorInfo error = hdGetError();
  if (HD_DEVICE_ERROR(error) && hduIsSchedulerError(&error)) return HD_CALLBACK_DONE;
  return ++spring.ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

}  // namespace

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  const HDErrorInfo error = hdGetError();
  if (HD_DEVICE_ERROR(error)) {
    hduPrintError(stderr, &error, "Failed to initialise");
    return 2;
  }
  Spring spring;
  HDdouble max_stiffness = 0;
  hdGetDoublev(HD_NOMINAL_MAX_STIFFNESS, &max_stiffness);
  PROOF(max_stiffness > spring.stiffness);
  const HDSchedulerHandle handle = hdScheduleAsynchronous(feel, &spring, HD_MAX_SCHEDULER_PRIORITY);
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(spring.ticks == kProofTicks && spring.anchored_ticks > 500);
  return proof_end();
}
