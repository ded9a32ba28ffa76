/* The functions of hdPhantom, loaded at run time by the library's bare name, as CHAI3D does. */
#ifndef LOAD_PHANTOM_H
#define LOAD_PHANTOM_H

#include <dlfcn.h>

typedef struct {
  int (*count)(void);
  int (*open_arm)(int);
  int (*close_arm)(int);
  int (*position)(int, double*, double*, double*);
  int (*buttons)(int);
  int (*force)(int, const double*, const double*, const double*, const double*, const double*,
               const double*);
} Phantom;

/* Returns whether the library was found and has all functions. */
static int load_phantom(Phantom* phantom) {
  void* library = dlopen("libhdPhantom.so", RTLD_LAZY | RTLD_GLOBAL);
  if (!library) return 0;
  *(void**)&phantom->count = dlsym(library, "hdPhantomGetNumDevices");
  *(void**)&phantom->open_arm = dlsym(library, "hdPhantomOpen");
  *(void**)&phantom->close_arm = dlsym(library, "hdPhantomClose");
  *(void**)&phantom->position = dlsym(library, "hdPhantomGetPosition");
  *(void**)&phantom->buttons = dlsym(library, "hdPhantomGetButtons");
  *(void**)&phantom->force = dlsym(library, "hdPhantomSetForceAndTorque");
  return phantom->count && phantom->open_arm && phantom->close_arm && phantom->position &&
         phantom->buttons && phantom->force;
}

/* Requests a force without torque and waits for the tick that takes it. Returns whether it was
 * taken. */
static int push_phantom(const Phantom* phantom, int arm, const double f[3]) {
  const double none = 0;
  return phantom->force(arm, &f[0], &f[1], &f[2], &none, &none, &none) != -1;
}

#endif
