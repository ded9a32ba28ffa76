/* Counts button presses, as programs do. Returns 0 if they are as many as the argument says, or
 * none. */
#include <HD/hd.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int presses, looks;

static HDCallbackCode HDCALLBACK look(void* data) {
  HDint now = 0, before = 0;
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetIntegerv(HD_CURRENT_BUTTONS, &now);
  hdGetIntegerv(HD_LAST_BUTTONS, &before);
  hdEndFrame(hdGetCurrentDevice());
  if ((now & HD_DEVICE_BUTTON_1) && !(before & HD_DEVICE_BUTTON_1)) ++presses;
  ++looks;
  return HD_CALLBACK_CONTINUE;
}

int main(int argc, char** argv) {
  const int expected = argc > 1 ? atoi(argv[1]) : 0;
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 2;
  hdScheduleAsynchronous(look, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  usleep(500000);
  hdStopScheduler();
  hdDisableDevice(device);
  printf("%d presses in %d looks\n", presses, looks);
  return looks > 300 && presses == expected && !HD_DEVICE_ERROR(hdGetError()) ? 0 : 3;
}
