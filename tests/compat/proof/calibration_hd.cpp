// Calibrates in the order of the drivers for ROS: the style, the scheduler, then a loop until it is
// calibrated; afterwards a spring that needs the calibrated position.
#include <HD/hd.h>
#include <HDU/hduMatrix.h>
#include <HDU/hduVector.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

namespace {

struct State {
  int ticks = 0;
  double off = 0;
};

HDCallbackCode HDCALLBACK servo(void* data) {
  State& state = *static_cast<State*>(data);
  const double origin[3] = {0, 0, 0};
  hduVector3Dd position, force, joints, gimbal;
  hduMatrix transform;
  if (hdCheckCalibration() == HD_CALIBRATION_NEEDS_UPDATE) hdUpdateCalibration(HD_CALIBRATION_AUTO);
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_TRANSFORM, transform);
  hdGetDoublev(HD_CURRENT_POSITION, position);
  hdGetDoublev(HD_CURRENT_JOINT_ANGLES, joints);
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, gimbal);
  spring_force(0.025, origin, position, force);
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, position, force);
  const hduVector3Dd place(transform[3][0], transform[3][1], transform[3][2]);
  const double off = (place - position).magnitude();
  if (off > state.off) state.off = off;
  return ++state.ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

}  // namespace

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  State state;
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  HDint styles = 0;
  hdGetIntegerv(HD_CALIBRATION_STYLE, &styles);
  HDint style = 0;
  if (styles & HD_CALIBRATION_ENCODER_RESET) style = HD_CALIBRATION_ENCODER_RESET;
  if (styles & HD_CALIBRATION_INKWELL) style = HD_CALIBRATION_INKWELL;
  if (styles & HD_CALIBRATION_AUTO) style = HD_CALIBRATION_AUTO;
  PROOF(style != 0);
  for (int tries = 0; hdCheckCalibration() != HD_CALIBRATION_OK; ++tries) {
    hdUpdateCalibration(static_cast<HDenum>(style));
    PROOF(tries < 3);
  }
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  const HDSchedulerHandle handle = hdScheduleAsynchronous(servo, &state, HD_MAX_SCHEDULER_PRIORITY);
  PROOF(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(state.ticks == kProofTicks && state.off < 1e-9);
  return proof_end();
}
