# Pushes with a constant force and reads the temperatures of the motors into an array of the size that the arm reports.
import ctypes

import proof

hd = proof.load_hd()
device = hd.hdInitDevice(None)
count = ctypes.c_int()
hd.hdGetIntegerv(0x2554, ctypes.byref(count))
heat = (ctypes.c_double * count.value)()
p, f = proof.Vector(), proof.Vector(0.1, -0.3, 0.2)


def feel(_):
    hd.hdBeginFrame(device)
    hd.hdGetDoublev(0x2050, p)
    hd.hdGetDoublev(0x2605, heat)
    hd.hdSetDoublev(0x2700, f)
    hd.hdEndFrame(device)
    proof.note_hd(0, p, f)
    proof.prove(all(0 <= x < 0.8 for x in heat) and hd.hdGetError().code == 0, "a motor is warm")


proof.run_hd(hd, feel)
hd.hdDisableDevice(device)
