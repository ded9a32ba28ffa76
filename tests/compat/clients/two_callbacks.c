/* Reads at the highest priority and writes at the lowest, in one frame over both. A synchronous
 * callback copies the state to the main thread. */
#include <HD/hd.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

typedef struct {
  double p[3], f[3];
  int reads, writes, out_of_order;
} State;

static HDCallbackCode HDCALLBACK first(void* data) {
  State* state = data;
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, state->p);
  if (state->reads != state->writes) ++state->out_of_order;
  ++state->reads;
  return HD_CALLBACK_CONTINUE;
}

static HDCallbackCode HDCALLBACK last(void* data) {
  State* state = data;
  int i;
  for (i = 0; i < 3; ++i) state->f[i] = -0.02 * state->p[i]; /* N/mm: a spring to the centre */
  hdSetDoublev(HD_CURRENT_FORCE, state->f);
  hdEndFrame(hdGetCurrentDevice());
  ++state->writes;
  return HD_CALLBACK_CONTINUE;
}

typedef struct {
  const State* from;
  State to;
} Copy;

static HDCallbackCode HDCALLBACK copy_state(void* data) {
  Copy* copy = data;
  copy->to = *copy->from;
  return HD_CALLBACK_DONE;
}

int main(void) {
  static State state;
  static Copy copy;
  HDSchedulerHandle handles[2];
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  int i, torn = 0;
  if (device == HD_INVALID_HANDLE) return 2;
  hdEnable(HD_FORCE_OUTPUT);
  handles[1] = hdScheduleAsynchronous(last, &state, HD_MIN_SCHEDULER_PRIORITY);
  handles[0] = hdScheduleAsynchronous(first, &state, HD_MAX_SCHEDULER_PRIORITY);
  hdStartScheduler();
  copy.from = &state;
  for (i = 0; i < 50; ++i) {
    usleep(20000);
    hdScheduleSynchronous(copy_state, &copy, HD_DEFAULT_SCHEDULER_PRIORITY);
    /* At this priority it runs between the two: after the read, before the write. */
    if (copy.to.reads != copy.to.writes + 1) ++torn;
  }
  hdStopScheduler();
  hdUnschedule(handles[0]);
  hdUnschedule(handles[1]);
  hdDisableDevice(device);
  printf("%d reads, %d writes, %d out of order, %d torn\n", state.reads, state.writes,
         state.out_of_order, torn);
  return state.reads > 700 && !state.out_of_order && !torn && !HD_DEVICE_ERROR(hdGetError()) ? 0
                                                                                             : 3;
}
