/* Calibrates like programs for ROS, and prints properties of the arm. */
#include <HD/hd.h>
#include <stdio.h>
#include <unistd.h>

int main(void) {
  HDint styles = 0, dof = 0;
  HDenum style;
  double box[6], force = 0;
  int tries = 0;
  HHD device = hdInitDevice("PHANToM 1");
  if (device == HD_INVALID_HANDLE) return 2;
  hdGetIntegerv(HD_CALIBRATION_STYLE, &styles);
  style = styles & HD_CALIBRATION_AUTO ? HD_CALIBRATION_AUTO : HD_CALIBRATION_ENCODER_RESET;
  hdStartScheduler();
  while (hdCheckCalibration() != HD_CALIBRATION_OK) {
    usleep(10000);
    if (hdCheckCalibration() == HD_CALIBRATION_NEEDS_UPDATE) hdUpdateCalibration(style);
    if (++tries > 10) return 3;
  }
  hdGetDoublev(HD_USABLE_WORKSPACE_DIMENSIONS, box);
  hdGetDoublev(HD_NOMINAL_MAX_FORCE, &force);
  hdGetIntegerv(HD_INPUT_DOF, &dof);
  printf("calibrated after %d, %g x %g x %g mm, %g N, %d in\n", tries, box[3] - box[0],
         box[4] - box[1], box[5] - box[2], force, dof);
  hdStopScheduler();
  hdDisableDevice(device);
  return tries == 1 ? 0 : 4;
}
