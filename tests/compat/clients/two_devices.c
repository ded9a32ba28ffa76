/* Two arms in one callback, coupled by a spring. */
#include <HD/hd.h>
#include <stdio.h>
#include <unistd.h>

static HHD arms[2];
static double max_force;

static HDCallbackCode HDCALLBACK tie(void* data) {
  double p[2][3], f[2][3];
  int arm, i;
  (void)data;
  for (arm = 0; arm < 2; ++arm) {
    hdMakeCurrentDevice(arms[arm]);
    hdBeginFrame(arms[arm]);
    hdGetDoublev(HD_CURRENT_POSITION, p[arm]);
  }
  for (i = 0; i < 3; ++i) {
    f[0][i] = 0.05 * (p[1][i] - p[0][i]);
    f[1][i] = -f[0][i];
    if (f[0][i] > max_force) max_force = f[0][i];
  }
  for (arm = 0; arm < 2; ++arm) {
    hdMakeCurrentDevice(arms[arm]);
    hdSetDoublev(HD_CURRENT_FORCE, f[arm]);
    hdEndFrame(arms[arm]);
  }
  return HD_CALLBACK_CONTINUE;
}

int main(void) {
  char model[2][64];
  int arm;
  arms[0] = hdInitDevice(HD_DEFAULT_DEVICE);
  arms[1] = hdInitDevice("Phantom2");
  for (arm = 0; arm < 2; ++arm) {
    if (arms[arm] == HD_INVALID_HANDLE) return 2;
    hdMakeCurrentDevice(arms[arm]);
    hdEnable(HD_FORCE_OUTPUT);
    snprintf(model[arm], sizeof model[arm], "%s", hdGetString(HD_DEVICE_MODEL_TYPE));
  }
  hdScheduleAsynchronous(tie, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  usleep(1500000);
  hdStopScheduler();
  hdDisableDevice(arms[0]);
  hdDisableDevice(arms[1]);
  printf("%s and %s\n", model[0], model[1]);
  return HD_DEVICE_ERROR(hdGetError()) ? 3 : 0;
}
