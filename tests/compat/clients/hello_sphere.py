# The sphere in Python, in the usual style of programs with ctypes: libHD with a callback and a struct returned
# by value, then libhdPhantom in a loop.
import ctypes
import math
import time


class Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint), ("internal", ctypes.c_int), ("device", ctypes.c_uint)]


RADIUS = 20.0  # mm
STIFFNESS = 0.25  # N/mm
CURRENT_POSITION, CURRENT_FORCE, FORCE_OUTPUT = 0x2050, 0x2700, 0x4000
CONTINUE, PRIORITY = 1, 0x3FFF
Vector = ctypes.c_double * 3
Callback = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p)


def force_at(p, radius, stiffness):
    distance = math.sqrt(sum(x * x for x in p))
    if not 0 < distance < radius:
        return Vector(0, 0, 0)
    return Vector(*(stiffness * (radius - distance) * x / distance for x in p))


def by_hd():
    hd = ctypes.CDLL("libHD.so")
    hd.hdGetError.restype = Error
    hd.hdScheduleAsynchronous.restype = ctypes.c_ulong
    hd.hdScheduleAsynchronous.argtypes = [Callback, ctypes.c_void_p, ctypes.c_ushort]
    hd.hdUnschedule.argtypes = [ctypes.c_ulong]
    hd.hdGetString.restype = ctypes.c_char_p
    device = hd.hdInitDevice(None)
    error = hd.hdGetError()
    if error.code != 0:
        raise SystemExit(f"failed to initialise: {error.code:#x}")
    hd.hdEndFrame(device)
    error = hd.hdGetError()
    if (error.code, error.internal, error.device) != (0x0401, 0, device):
        raise SystemExit(f"an error by value: {error.code:#x} {error.internal} {error.device}")
    seen = {"callbacks": 0, "force": 0.0}

    def feel(_):
        p = Vector()
        hd.hdBeginFrame(hd.hdGetCurrentDevice())
        hd.hdGetDoublev(CURRENT_POSITION, p)
        f = force_at(p, RADIUS, STIFFNESS)
        hd.hdSetDoublev(CURRENT_FORCE, f)
        hd.hdEndFrame(hd.hdGetCurrentDevice())
        seen["callbacks"] += 1
        seen["force"] = max(seen["force"], f[1])
        return CONTINUE

    callback = Callback(feel)
    hd.hdEnable(FORCE_OUTPUT)
    hd.hdStartScheduler()
    handle = hd.hdScheduleAsynchronous(callback, None, PRIORITY)
    time.sleep(2.5)
    hd.hdStopScheduler()
    hd.hdUnschedule(handle)
    model = hd.hdGetString(0x2501).decode()
    hd.hdDisableDevice(device)
    print(f"{model}: {seen['callbacks']} callbacks, {seen['force']:.2f} N upwards at most")
    return seen["callbacks"] > 1000 and seen["force"] > 0.5


def by_phantom():
    library = ctypes.CDLL("libhdPhantom.so")
    if library.hdPhantomOpen(0) != 0:
        return False
    p = Vector()
    none = ctypes.byref(ctypes.c_double(0))

    def each(vector):
        step = ctypes.sizeof(ctypes.c_double)
        return [ctypes.byref(vector, i * step) for i in range(3)]

    highest = 0.0
    begin = time.monotonic()
    for _ in range(2500):
        if library.hdPhantomGetPosition(0, *each(p)) != 1:
            return False
        f = force_at(p, RADIUS / 1000, STIFFNESS * 1000)
        if library.hdPhantomSetForceAndTorque(0, *each(f), none, none, none) != 0:
            return False
        highest = max(highest, f[2])
    took = time.monotonic() - begin
    library.hdPhantomClose(0)
    print(f"2500 turns in {took:.2f} s, {highest:.2f} N upwards at most")
    return took > 2.4 and highest > 0.5


if not by_hd() or not by_phantom():
    raise SystemExit(3)
print("both libraries: right")
