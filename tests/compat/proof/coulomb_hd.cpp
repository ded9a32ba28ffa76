// A charge at the origin that attracts the tip, with the vectors of HDU and a synchronous callback
// that copies the state.
#include <HD/hd.h>
#include <HDU/hduError.h>
#include <HDU/hduVector.h>

#include "../clients/force_laws.h"
#include "proof_hd.h"

namespace {

struct State {
  hduVector3Dd position, force;
  int ticks = 0;
};

HDCallbackCode HDCALLBACK attract(void* data) {
  State& state = *static_cast<State*>(data);
  hdBeginFrame(hdGetCurrentDevice());
  hdGetDoublev(HD_CURRENT_POSITION, state.position);
  coulomb_force(0.8, 12, state.position, state.force);  // N, mm
  hdSetDoublev(HD_CURRENT_FORCE, state.force);
  hdEndFrame(hdGetCurrentDevice());
  proof_note_hd(0, state.position, state.force);
  return ++state.ticks < kProofTicks ? HD_CALLBACK_CONTINUE : HD_CALLBACK_DONE;
}

struct Copy {
  const State* from;
  State to;
};

HDCallbackCode HDCALLBACK copy_state(void* data) {
  Copy& copy = *static_cast<Copy*>(data);
  copy.to = *copy.from;
  return HD_CALLBACK_DONE;
}

}  // namespace

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  State state;
  const HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  hdEnable(HD_FORCE_OUTPUT);
  hdStartScheduler();
  PROOF(!HD_DEVICE_ERROR(hdGetError()));
  const HDSchedulerHandle handle =
      hdScheduleAsynchronous(attract, &state, HD_DEFAULT_SCHEDULER_PRIORITY);
  for (int ticks = 0; ticks < kProofTicks;) {
    Copy copy{&state, {}};
    hdScheduleSynchronous(copy_state, &copy, HD_MIN_SCHEDULER_PRIORITY);
    PROOF(copy.to.ticks >= ticks);
    PROOF(copy.to.position.magnitude() < 100);
    ticks = copy.to.ticks;
    if (!hdWaitForCompletion(handle, HD_WAIT_CHECK_STATUS)) break;
  }
  hdStopScheduler();
  hdDisableDevice(device);
  PROOF(state.ticks == kProofTicks && !HD_DEVICE_ERROR(hdGetError()));
  return proof_end();
}
