"""A program in the style of programs for an Inverse3, with python3-websockets: program.py CASE [ARGUMENTS].

It knows only the port of Thimble (THIMBLE_HAPLY_PORT). Each case checks itself: it prints "CASE: right", or the
problem and fails."""
import asyncio
import json
import math
import os
import sys

import websockets

URI = "ws://localhost:" + os.environ.get("THIMBLE_HAPLY_PORT", "10001")


class Arm:
    """A session with the service."""

    def __init__(self, socket, first):
        self.socket = socket
        self.first = first
        self.device_id = first["inverse3"][0]["device_id"]

    async def exchange(self, message):
        """Sends a message and returns its answer."""
        await self.socket.send(message if isinstance(message, (str, bytes)) else json.dumps(message))
        return json.loads(await asyncio.wait_for(self.socket.recv(), 5))

    async def push(self, force, spelling="vector"):
        """Requests a force (N, in the service's axes) and returns the arm's state."""
        command = {"set_cursor_force": {spelling: dict(zip("xyz", force))}}
        return state_of(await self.exchange({"inverse3": [{"device_id": self.device_id, "commands": command}]}))

    async def probe(self):
        """Requests only the state."""
        command = {"probe_position": {}}
        return state_of(await self.exchange({"inverse3": [{"device_id": self.device_id, "commands": command}]}))


def state_of(message):
    return message["inverse3"][0]["state"]


def three(vector):
    return [vector["x"], vector["y"], vector["z"]]


def length(vector):
    return math.hypot(*three(vector))


def check(right, what):
    if not right:
        print(f"{sys.argv[1]}: WRONG: {what}", flush=True)
        sys.exit(1)


async def connect(**more):
    socket = await websockets.connect(URI, close_timeout=0.2, **more)
    return Arm(socket, json.loads(await asyncio.wait_for(socket.recv(), 30)))


async def opened(arm, force=(0.3, 0.0, 0.4)):
    """Requests a force until the soft start is over."""
    for _ in range(2000):
        state = await arm.push(force)
        if math.dist(three(state["current_cursor_force"]), force) < 1e-9:
            return state
    check(False, f"the force was not reached: {state['current_cursor_force']}")


async def first_message():
    """The first message has the full state, later ones only state and status."""
    arm = await connect()
    (got,) = arm.first["inverse3"]
    check(isinstance(arm.first["session_id"], int), "no session_id")
    check(got["config"]["handedness"] == "right", "no config")
    check(got["status"] == {"calibrated": True, "ready": True, "started": True, "power_supply": True, "in_use": False},
          got["status"])
    for vector in ("cursor_position", "cursor_velocity", "current_cursor_force"):
        check(len(three(got["state"][vector])) == 3, vector)
    for angles in ("angular_position", "angular_velocity"):
        check(set(got["state"][angles]) == {"a0", "a1", "a2"}, angles)
    (grip,) = arm.first["wireless_verse_grip"]
    check(set(grip["state"]["buttons"]) == {"a", "b", "c"}, "no buttons")
    check(grip["state"]["battery_level"] == 1, "no battery level")
    check(grip["status"]["ready"] is True, "the grip is not ready")
    later = await arm.exchange({"session": {"configure": {"profile": {"name": "test:program"}}}})
    check("session_id" not in later and "config" not in later["inverse3"][0], "a later message has the full state")
    full = await arm.exchange({"session": {"force_render_full_state": {}}})
    check("session_id" in full and "config" in full["inverse3"][0], "force_render_full_state changes nothing")
    # Two messages, two answers, and no third.
    await arm.socket.send("{}")
    await arm.socket.send(b'{"inverse3": []}')
    for _ in range(2):
        await asyncio.wait_for(arm.socket.recv(), 5)
    try:
        await asyncio.wait_for(arm.socket.recv(), 0.2)
        check(False, "a message without a request")
    except asyncio.TimeoutError:
        pass
    await arm.socket.close()


async def stylus():
    """An arm that measures its stylus reports a quaternion."""
    arm = await connect()
    state = arm.first["wireless_verse_grip"][0]["state"]
    q = state["orientation"]
    check(abs(math.hypot(*(q[axis] for axis in "wxyz")) - 1) < 1e-9, q)


async def force(log):
    """Both spellings set a force, and the arm yields. Logs position and force of each turn, in Thimble's world."""
    arm = await connect()
    # The answer after tick n has the state of tick n and the force sent in it.
    with open(log, "w") as lines:
        asked = (0.0, 0.0, 0.0)
        for turn in range(2500):
            asked = (0.12 * math.sin(turn / 90), 0.1 * math.cos(turn / 70), 0.11 * math.sin(turn / 110 + 1))
            state = await arm.push(asked, "vector" if turn % 2 else "values")
            x, y, z = three(state["cursor_position"])
            u, v, w = three(state["cursor_velocity"])
            a, b, c = asked
            # x right, y away, z up, from x to the user, y right, z up; inverse3.yaml has the origin.
            print(-y - 0.130, x, z - 0.170, -v, u, w, -b, a, c, file=lines)
            if turn > 1000:
                got = three(state["current_cursor_force"])
                check(math.dist(got, asked) < 1e-9, f"requested {asked}, sent {got}")
    await arm.socket.close()


async def lets_go():
    """The force of a silent program ends after 20 ms, and programs that only read the state do not renew it."""
    arm, other = await connect(), await connect()
    await opened(arm)
    before = length((await other.probe())["current_cursor_force"])
    check(before > 0.2, f"no force to begin with: {before}")
    for _ in range(500):
        if length((await other.probe())["current_cursor_force"]) == 0:
            break
        await asyncio.sleep(0.002)
    else:
        check(False, "the force remains without requests")
    for _ in range(50):
        check(length((await other.probe())["current_cursor_force"]) == 0, "the force came back by itself")
    await opened(arm)


async def garbage():
    """An invalid message causes no force, but is answered, and later messages are accepted."""
    arm = await connect()
    entry = '{"inverse3":[{"device_id":"%s","commands":{"set_cursor_force":{"vector":%s}}}]}'
    bad = ["", "hello", "[]", "null", "{", b"\x00\xff\xfe", "[" * 10000, '{"inverse3": 3}', '{"inverse3": [3, null, {}]}',
           '{"inverse3":[{"commands":{"set_cursor_force":{"vector":{"x":1,"y":1,"z":1}}}}]}',
           entry % ("FFFF", '{"x":1,"y":1,"z":1}'),
           entry % (arm.device_id, '{"x":NaN,"y":0,"z":0}'), entry % (arm.device_id, '{"x":Infinity,"y":0,"z":0}'),
           entry % (arm.device_id, '{"x":1e999,"y":0,"z":0}'), entry % (arm.device_id, '{"x":"1","y":0,"z":0}'),
           entry % (arm.device_id, '{"x":1,"y":0}'), entry % (arm.device_id, "[1,0,0]"), entry % (arm.device_id, "null"),
           entry % (arm.device_id, "{}"),
           '{"inverse3":[{"device_id":"%s","commands":{"set_cursor_position":{"values":{"x":1,"y":1,"z":1}}}}]}' % arm.device_id]
    for message in bad:
        await opened(arm)
        answer = await arm.exchange(message)
        got = length(state_of(answer)["current_cursor_force"])
        check(got == 0, f"{message[:60]!r} left {got} N")
        check(answer["inverse3"][0]["status"]["ready"], f"{message[:60]!r} is a fault")
    await opened(arm)


async def huge():
    """A force above the gate's limit is limited; one that overflows is a fault that latches."""
    arm = await connect()
    await opened(arm)
    for _ in range(500):
        state = await arm.push((0, 0, 1000.0))
        check(length(state["current_cursor_force"]) < 5 + 1e-9, state["current_cursor_force"])
    check(length(state["current_cursor_force"]) > 1, "the gate sent no force")
    await arm.push((1e300, 1e300, 1e300))
    for _ in range(100):
        answer = await arm.exchange({"inverse3": [{"device_id": arm.device_id, "commands": {
            "set_cursor_force": {"vector": {"x": 0.3, "y": 0, "z": 0}}}}]})
        check(length(state_of(answer)["current_cursor_force"]) == 0, "a force after the fault")
    check(not answer["inverse3"][0]["status"]["ready"], "the fault is not reported")
    await asyncio.sleep(0.3)  # time for the test to read the log
    await arm.socket.close()
    # A program that connects again gets a restarted simulated arm.
    await opened(await connect())


async def two(clock="wall"):
    """The forces of two programs add up, and the force of a program ends with it."""
    first, second = await connect(), await connect()
    await opened(first, (0.3, 0.0, 0.0))
    if clock == "virtual":
        state = await second.push((0.0, 0.1, 0.0))
        check(state["current_cursor_force"]["x"] == 0.3, "the second program restarts the soft start of the first")
    for _ in range(1000):
        await second.push((0.0, 0.4, 0.0))
        state = await first.push((0.3, 0.0, 0.0))
        if math.dist(three(state["current_cursor_force"]), (0.3, 0.4, 0.0)) < 1e-9:
            break
    else:
        check(False, f"no sum: {state['current_cursor_force']}")
    third = await connect()
    check(third.first["inverse3"][0]["status"]["in_use"], "an arm that is pushed is not in use")
    await third.socket.close()
    await first.socket.close()
    for _ in range(1000):
        state = await second.push((0.0, 0.4, 0.0))
        if math.dist(three(state["current_cursor_force"]), (0.0, 0.4, 0.0)) < 1e-9:
            break
    else:
        check(False, f"the force of a program that left: {state['current_cursor_force']}")


async def cut():
    """If the connection breaks, the force ends."""
    arm, other = await connect(), await connect()
    await opened(arm)
    arm.socket.transport.abort()
    for _ in range(500):
        if length((await other.probe())["current_cursor_force"]) == 0:
            break
        await asyncio.sleep(0.002)
    else:
        check(False, "the force remains after its program has ended")
    check(not (await other.exchange("{}"))["inverse3"][0]["status"]["in_use"], "it is still in use")
    await opened(other)


async def doors():
    """Web pages of other computers, other protocols and too long messages are refused."""
    for origin in ("https://example.com", "http://localhost.example.com", "null", "file://"):
        try:
            await connect(origin=origin)
            check(False, f"a page of {origin} was let in")
        except websockets.exceptions.InvalidStatusCode as refused:
            check(refused.status_code == 403, f"{origin}: {refused}")
    await (await connect(origin="http://localhost:8080")).socket.close()
    host, port = "localhost", int(URI.rsplit(":", 1)[1])
    for line, answer in ((b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"HTTP/1.1 426"), (b"\x16\x03\x01\x02\r\n\r\n", b"")):
        reader, writer = await asyncio.open_connection(host, port)
        writer.write(line)
        check((await asyncio.wait_for(reader.read(), 5)).startswith(answer), line)
        writer.close()
    arm = await connect()
    await opened(arm)
    try:
        await arm.exchange(" " * 300_000)
        check(False, "a message of 300 kB was taken")
    except websockets.exceptions.ConnectionClosed as closed:
        check(closed.code == 1009, closed)
    # Many clients at once: those above the limit are refused, and the service survives.
    crowd = [await asyncio.open_connection(host, port) for _ in range(60)]
    for _, writer in crowd:
        writer.close()
    for _ in range(100):
        try:
            await opened(await connect())
            return
        except (OSError, asyncio.TimeoutError, websockets.exceptions.WebSocketException):
            await asyncio.sleep(0.05)
    check(False, "no client is accepted any more")


async def hold():
    """Requests a force until the program is ended."""
    arm = await connect()
    print("holding", flush=True)
    while True:
        await arm.push((0.3, 0.0, 0.0))


async def main():
    case = globals()[sys.argv[1]]
    try:
        await case(*sys.argv[2:])
    except (OSError, asyncio.TimeoutError, websockets.exceptions.WebSocketException) as trouble:
        check(False, repr(trouble))
    print(f"{sys.argv[1]}: right", flush=True)


asyncio.run(main())
