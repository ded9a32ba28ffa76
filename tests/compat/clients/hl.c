/* A program that draws with HL and pushes with HDAPI: each call of HL leaves an error that can be
 * read, and HDAPI works. Returns 0 if both is so. */
#include <HD/hd.h>
#include <HL/hl.h>
#include <string.h>

#include "count_failures.h"

static int ticks;

static HDCallbackCode HDCALLBACK push(void* data) {
  const double force[3] = {0, 0.25, 0};
  (void)data;
  hdBeginFrame(hdGetCurrentDevice());
  hdSetDoublev(HD_CURRENT_FORCE, force);
  hdEndFrame(hdGetCurrentDevice());
  return ++ticks < 600 ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

static void HLCALLBACK touched(HLenum event, HLuint object, HLenum thread, HLcache* cache,
                               void* data) {
  (void)event, (void)object, (void)thread, (void)cache, (void)data;
}

/* Returns how many errors were left, all of them with this code. */
static int errors_of(HLenum code) {
  HLerror error;
  int count = 0;
  while (HL_ERROR(error = hlGetError())) {
    if (strcmp(error.errorCode, code) != 0) return -1;
    ++count;
  }
  return count;
}

int main(void) {
  HLerror error;
  HHLRC context;
  HHD device;
  HLuint shape;
  HDSchedulerHandle handle;
  double sent[3], position[4] = {7, 7, 7, 7};
  device = hdInitDevice(HD_DEFAULT_DEVICE);
  CHECK(!HD_DEVICE_ERROR(hdGetError()));
  CHECK(!HL_ERROR(hlGetError()));
  context = hlCreateContext(device);
  error = hlGetError();
  CHECK(context == NULL && error.errorCode == HL_DEVICE_ERROR);
  CHECK(error.errorInfo.errorCode == HD_INVALID_OPERATION && !HL_ERROR(hlGetError()));
  hlMakeCurrent(context);
  CHECK(!HL_ERROR(hlGetError()) && hlGetCurrentContext() == NULL);
  hlEnable(HL_HAPTIC_CAMERA_VIEW);
  shape = hlGenShapes(1);
  CHECK(shape == 0 && !hlIsShape(shape));
  hlAddEventCallback(HL_EVENT_TOUCH, shape, HL_CLIENT_THREAD, touched, NULL);
  hlTouchableFace(HL_FRONT);
  CHECK(errors_of(HL_INVALID_OPERATION) == 5);
  hlBeginFrame();
  hlMaterialf(HL_FRONT_AND_BACK, HL_STIFFNESS, 0.7f);
  hlBeginShape(HL_SHAPE_FEEDBACK_BUFFER, shape);
  hlEndShape();
  hlEffectd(HL_EFFECT_PROPERTY_GAIN, 0.8);
  hlStartEffect(HL_EFFECT_FRICTION, hlGenEffects(1));
  hlEndFrame();
  hlGetDoublev(HL_PROXY_POSITION, position);
  CHECK(position[0] == 0 && position[1] == 7);
  CHECK(errors_of(HL_INVALID_OPERATION) == 9);
  hdEnable(HD_FORCE_OUTPUT);
  handle = hdScheduleAsynchronous(push, 0, HD_DEFAULT_SCHEDULER_PRIORITY);
  hdStartScheduler();
  CHECK(hdWaitForCompletion(handle, HD_WAIT_INFINITE));
  hdGetDoublev(HD_LAST_FORCE, sent);
  CHECK(sent[1] > 0.2499 && sent[1] < 0.2501);
  hdStopScheduler();
  hlMakeCurrent(NULL);
  hlDeleteContext(context);
  hdDisableDevice(device);
  CHECK(!HL_ERROR(hlGetError()) && !HD_DEVICE_ERROR(hdGetError()));
  printf("HL beside HDAPI: %d failures\n", failures);
  return failures != 0;
}
