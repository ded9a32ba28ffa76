# A vibration of 25 Hz to the user, in the order of calls of a wrapper: the current device before the first one is opened,
# then texts, force, scheduler, callback.
import math

import proof

hd = proof.load_hd()
proof.prove(hd.hdGetCurrentDevice() == hd.hdInitDevice(b"Default Device"), "the handle is another one")
proof.prove(hd.hdGetString(0x2503) and hd.hdGetString(0x2501), "no texts")
p, f = proof.Vector(), proof.Vector()


def feel(tick):
    device = hd.hdGetCurrentDevice()
    hd.hdBeginFrame(device)
    hd.hdMakeCurrentDevice(device)
    hd.hdGetDoublev(0x2050, p)
    f[2] = 0.3 * math.sin(2 * math.pi * 25e-3 * tick)
    hd.hdSetDoublev(0x2700, f)
    hd.hdEndFrame(device)
    proof.note_hd(0, p, f)
    proof.prove(hd.hdGetError().code == 0, "an error")


proof.run_hd(hd, feel)
hd.hdDisableDevice(0)
