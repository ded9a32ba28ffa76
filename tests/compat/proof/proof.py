"""Shared by the Python programs of this folder: the log (see proof.h), and the libraries by their bare names."""
import ctypes
import sys

TICKS = 1500
Vector = ctypes.c_double * 3
Callback = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p)


class Error(ctypes.Structure):
    """The error of HDAPI, which is returned by value."""

    _fields_ = [("code", ctypes.c_uint), ("internal", ctypes.c_int), ("device", ctypes.c_uint)]


LOG = open(sys.argv[1], "w")


def note(arm, p, f):
    print(arm, *(repr(float(x)) for x in (*p, *f)), file=LOG)


def note_hd(arm, p, f):
    """Logs mm and the axes of HDAPI: x right, y up, z to the user."""
    note(arm, (1e-3 * p[2], 1e-3 * p[0], 1e-3 * p[1]), (f[2], f[0], f[1]))


def prove(condition, what):
    if not condition:
        raise SystemExit(f"{sys.argv[0]}: {what}")


def load_hd():
    hd = ctypes.CDLL("libHD.so")
    hd.hdGetError.restype = Error
    hd.hdScheduleAsynchronous.restype = ctypes.c_ulong
    hd.hdScheduleAsynchronous.argtypes = [Callback, ctypes.c_void_p, ctypes.c_ushort]
    hd.hdWaitForCompletion.restype = ctypes.c_ubyte
    hd.hdWaitForCompletion.argtypes = [ctypes.c_ulong, ctypes.c_int]
    hd.hdGetString.restype = ctypes.c_char_p
    return hd


def load_drd():
    drd = ctypes.CDLL("libdrd.so")
    number, byte = ctypes.c_double, ctypes.c_byte
    pointer = ctypes.POINTER(number)
    drd.dhdGetPosition.argtypes = [pointer, pointer, pointer, byte]
    drd.dhdSetForceAndTorqueAndGripperForce.argtypes = [number] * 7 + [byte]
    drd.dhdErrorGetLastStr.restype = ctypes.c_char_p
    drd.drdIsInitialized.restype = drd.drdIsRunning.restype = ctypes.c_bool
    drd.drdMoveToPos.argtypes = [number] * 3 + [ctypes.c_bool, byte]
    drd.dhdGetTime.restype = number
    return drd


def position_dhd(drd, arm=-1):
    p = [ctypes.c_double() for _ in range(3)]
    prove(drd.dhdGetPosition(*(ctypes.byref(x) for x in p), arm) >= 0, "no position")
    return [x.value for x in p]


def push_dhd(drd, f, arm=-1):
    prove(drd.dhdSetForceAndTorqueAndGripperForce(*f, 0, 0, 0, 0, arm) >= 0, "the force was refused")


def run_hd(hd, feel):
    """Runs feel(tick), which returns nothing, in each tick of the scheduler."""
    ticks = 0

    def each_tick(_):
        nonlocal ticks
        feel(ticks)
        ticks += 1
        return 1 if ticks < TICKS else 0

    callback = Callback(each_tick)
    hd.hdEnable(0x4000)
    hd.hdStartScheduler()
    handle = hd.hdScheduleAsynchronous(callback, None, 0x7FFF)
    prove(hd.hdWaitForCompletion(handle, 1) == 1, "the callback has not ended")
    hd.hdStopScheduler()
    prove(ticks == TICKS, f"{ticks} callbacks")


class Phantom:
    """An arm by hdPhantom."""

    def __init__(self):
        self.library = ctypes.CDLL("libhdPhantom.so")
        prove(self.library.hdPhantomGetNumDevices() > 0 and self.library.hdPhantomOpen(0) == 0, "no arm")

    @staticmethod
    def each(vector):
        return [ctypes.byref(vector, i * ctypes.sizeof(ctypes.c_double)) for i in range(3)]

    def position(self):
        p = Vector()
        prove(self.library.hdPhantomGetPosition(0, *self.each(p)) == 1, "no position")
        return list(p)

    def push(self, p, f):
        """Logs a position and its force, and requests the force."""
        note(0, p, f)
        force, torque = Vector(*f), Vector()
        prove(self.library.hdPhantomSetForceAndTorque(0, *self.each(force), *self.each(torque)) == 0, "the force was refused")

    def close(self):
        prove(self.library.hdPhantomClose(0) == 1, "it was not open")
