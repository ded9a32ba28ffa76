/* Switches force on with a ramp and holds 0.3 N upwards; the force may grow no faster than asked.
 */
#include <HD/hd.h>
#include <stdio.h>
#include <unistd.h>

static double sent[3], steepest;

static HDCallbackCode HDCALLBACK push(void* data) {
  static double before;
  const double f[3] = {0, 0.3, 0};
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdSetDoublev(HD_CURRENT_FORCE, f);
  hdGetDoublev(HD_LAST_FORCE, sent);
  hdEndFrame(hdGetCurrentDevice());
  if (sent[1] - before > steepest) steepest = sent[1] - before;
  before = sent[1];
  return HD_CALLBACK_CONTINUE;
}

int main(void) {
  const double rate = 0.4; /* N/s */
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 2;
  hdSetDoublev(HD_FORCE_RAMPING_RATE, &rate);
  hdEnable(HD_FORCE_RAMPING);
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(push, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  usleep(1500000);
  hdStopScheduler();
  hdDisableDevice(device);
  printf("%.3f N at the end, %.4f N in one tick at most\n", sent[1], steepest);
  /* Ten ticks of the ramp: a busy machine skips some. */
  return sent[1] > 0.295 && sent[1] < 0.305 && steepest < 10 * rate * 1e-3 ? 0 : 3;
}
