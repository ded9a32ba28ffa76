"""Drops a file on a window of X11, as a file manager does (XDND version 5, https://www.freedesktop.org/wiki/Specifications/XDND).
  drop_file.py WINDOW_ID FILE
Exits with 0 if the window took the file."""
import ctypes
import pathlib
import sys
import time

x11 = ctypes.CDLL("libX11.so.6")
Long, ULong, Int = ctypes.c_long, ctypes.c_ulong, ctypes.c_int
HEAD = [("type", Int), ("serial", ULong), ("send_event", Int), ("display", ctypes.c_void_p)]
SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33


class Message(ctypes.Structure):
    _fields_ = HEAD + [("window", ULong), ("kind", ULong), ("format", Int), ("data", Long * 5)]


class Request(ctypes.Structure):
    _fields_ = HEAD + [("owner", ULong), ("requestor", ULong), ("selection", ULong), ("target", ULong), ("property", ULong), ("time", ULong)]


class Notify(ctypes.Structure):
    _fields_ = HEAD + [("requestor", ULong), ("selection", ULong), ("target", ULong), ("property", ULong), ("time", ULong)]


class Event(ctypes.Union):
    _fields_ = [("type", Int), ("message", Message), ("request", Request), ("notify", Notify), ("pad", Long * 24)]


x11.XOpenDisplay.restype = ctypes.c_void_p
x11.XInternAtom.restype = x11.XCreateSimpleWindow.restype = x11.XDefaultRootWindow.restype = ULong
display = ctypes.c_void_p(x11.XOpenDisplay(None))
root = ULong(x11.XDefaultRootWindow(display))
target = ULong(int(sys.argv[1]))
own = ULong(x11.XCreateSimpleWindow(display, root, 0, 0, 1, 1, 0, ULong(0), ULong(0)))


def atom(name):
    return x11.XInternAtom(display, name.encode(), 0)


def send(kind, *data):
    event = Event()
    event.message.type = CLIENT_MESSAGE
    event.message.window = target.value
    event.message.kind = atom(kind)
    event.message.format = 32
    for place, value in enumerate((own.value, *data)):
        event.message.data[place] = value
    x11.XSendEvent(display, target, 0, Long(0), ctypes.byref(event))
    x11.XFlush(display)


def give(request, text):
    """Answers the window's request for the list of files."""
    x11.XChangeProperty(display, ULong(request.requestor), ULong(request.property), ULong(request.target), 8, 0, text, len(text))
    answer = Event()
    answer.notify.type = SELECTION_NOTIFY
    for name in ("requestor", "selection", "target", "property", "time"):
        setattr(answer.notify, name, getattr(request, name))
    x11.XSendEvent(display, ULong(request.requestor), 0, Long(0), ctypes.byref(answer))
    x11.XFlush(display)


listed = atom("text/uri-list")
text = (pathlib.Path(sys.argv[2]).resolve().as_uri() + "\r\n").encode()
x11.XSetSelectionOwner(display, ULong(atom("XdndSelection")), own, ULong(0))
send("XdndEnter", 5 << 24, listed, 0, 0)
send("XdndPosition", 0, (200 << 16) | 200, 0, atom("XdndActionCopy"))
dropped = False
end = time.monotonic() + 20
while time.monotonic() < end:
    if not x11.XPending(display):
        time.sleep(0.01)
        continue
    event = Event()
    x11.XNextEvent(display, ctypes.byref(event))
    if event.type == SELECTION_REQUEST:
        give(event.request, text)
    elif event.type == CLIENT_MESSAGE and event.message.kind == atom("XdndStatus") and not dropped:
        dropped = True
        send("XdndDrop", 0, 0, 0, 0)
    elif event.type == CLIENT_MESSAGE and event.message.kind == atom("XdndFinished"):
        sys.exit(0)
sys.exit("drop_file.py: the window did not take the file")
