/* Enables force with a ramp and requests 0.3 N upwards. The force must rise no faster than the
 * ramp, which is slower than the soft start of the arm. */
#include <HD/hd.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static double sent[3], steepest, began, near_all; /* s, when 0.25 N were reached */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

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
  if (near_all == 0 && sent[1] >= 0.25) near_all = now() - began;
  return HD_CALLBACK_CONTINUE;
}

int main(void) {
  const double rate = 0.4; /* N/s */
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 2;
  hdSetDoublev(HD_FORCE_RAMPING_RATE, &rate);
  hdEnable(HD_FORCE_RAMPING);
  began = now();
  hdEnable(HD_FORCE_OUTPUT);
  hdScheduleAsynchronous(push, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  usleep(1500000);
  hdStopScheduler();
  hdDisableDevice(device);
  printf("%.3f N at the end, %.4f N in one tick at most, 0.25 N after %.3f s\n", sent[1], steepest,
         near_all);
  /* A busy machine skips ticks; it can only make this later. */
  return sent[1] > 0.295 && sent[1] < 0.305 && near_all > 0.9 * 0.25 / rate ? 0 : 3;
}
