/* Requests a force, then hangs in its callback for a second. */
#include <HD/hd.h>
#include <unistd.h>

static HDCallbackCode HDCALLBACK push(void* data) {
  static int ticks;
  const double f[3] = {0.3, 0, 0};
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdSetDoublev(HD_CURRENT_FORCE, f);
  hdEndFrame(hdGetCurrentDevice());
  if (++ticks == 500) usleep(1000000);
  return HD_CALLBACK_CONTINUE;
}

int main(int argc, char** argv) {
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  (void)argv;
  if (device == HD_INVALID_HANDLE) return 2;
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(push, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  usleep(1800000);
  if (argc > 1) _exit(0); /* without closing anything */
  hdStopScheduler();
  hdDisableDevice(device);
  return 0;
}
