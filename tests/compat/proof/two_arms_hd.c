/* Two arms tied by a spring, by a program that has only its own declarations. */
#include "../clients/force_laws.h"
#include "proof_hd.h"

extern unsigned int hdInitDevice(const char* name);
extern void hdDisableDevice(unsigned int device);
extern void hdMakeCurrentDevice(unsigned int device);
extern void hdBeginFrame(unsigned int device);
extern void hdEndFrame(unsigned int device);
extern void hdEnable(unsigned int capability);
extern void hdGetDoublev(unsigned int parameter, double* values);
extern void hdSetDoublev(unsigned int parameter, const double* values);
extern void hdStartScheduler(void);
extern void hdStopScheduler(void);
extern unsigned long hdScheduleAsynchronous(unsigned int (*callback)(void*), void* data,
                                            unsigned short priority);
extern unsigned char hdWaitForCompletion(unsigned long handle, int code);

static unsigned int arms[2];
static int ticks;

static unsigned int tie(void* data) {
  double p[2][3], f[2][3];
  int arm;
  (void)data;
  for (arm = 0; arm < 2; ++arm) {
    hdBeginFrame(arms[arm]);
    hdGetDoublev(0x2050, p[arm]);
  }
  for (arm = 0; arm < 2; ++arm) {
    hdMakeCurrentDevice(arms[arm]);
    spring_force(0.02, p[1 - arm], p[arm], f[arm]);
    f[arm][0] += 0.2; /* the arms have the same hand; this keeps the force above zero */
    hdSetDoublev(0x2700, f[arm]);
    proof_note_hd(arm, p[arm], f[arm]);
  }
  hdEndFrame(arms[0]);
  hdEndFrame(arms[1]);
  return ++ticks < kProofTicks;
}

int main(int argc, char** argv) {
  unsigned long handle;
  int arm;
  proof_begin(argc, argv);
  arms[0] = hdInitDevice("PHANToM 1");
  hdEnable(0x4000);
  arms[1] = hdInitDevice("PHANToM 2");
  hdEnable(0x4000);
  PROOF(arms[0] == 0 && arms[1] == 1);
  hdStartScheduler();
  handle = hdScheduleAsynchronous(tie, 0, 0x7fff);
  PROOF(hdWaitForCompletion(handle, 1));
  hdStopScheduler();
  for (arm = 0; arm < 2; ++arm) hdDisableDevice(arms[arm]);
  PROOF(ticks == kProofTicks);
  return proof_end();
}
