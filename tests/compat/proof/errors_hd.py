# Wrong calls in each hundredth callback; errors are structs that are returned by value, the newest first.
import proof

hd = proof.load_hd()
device = hd.hdInitDevice(None)
proof.prove(hd.hdInitDevice(None) == -1, "it opened twice")
error = hd.hdGetError()
proof.prove((error.code, error.internal) == (0x0301, 0), f"{error.code:#x}")
p, f = proof.Vector(), proof.Vector()
errors = []


def feel(tick):
    hd.hdBeginFrame(device)
    if tick % 100 == 0:
        hd.hdBeginFrame(device)
        hd.hdGetDoublev(0x1234, p)
    hd.hdGetDoublev(0x2050, p)
    f[:] = [-0.02 * x for x in p]
    hd.hdSetDoublev(0x2700, f)
    hd.hdEndFrame(device)
    proof.note_hd(0, p, f)
    while (error := hd.hdGetError()).code:
        errors.append((error.code, error.device))


proof.run_hd(hd, feel)
hd.hdDisableDevice(device)
proof.prove(errors == [(0x0100, device), (0x0400, device)] * (proof.TICKS // 100), f"{errors}")
