"""A service with the published JSON of Haply's, with arms at rest: haply_service.py PORT_FILE [NAME...].

Writes its port into PORT_FILE, serves until it is killed, and prints each force it is given."""
import asyncio
import json
import os
import sys

import websockets


NAMES = sys.argv[2:] or ["049D"]


def state(device_id):
    return {
        "device_id": device_id,
        "config": {"device_info": {"major_version": 3}},
        "state": {
            "cursor_position": {"x": 0.0, "y": -0.13, "z": 0.17},
            "cursor_velocity": {"x": 0.0, "y": 0.0, "z": 0.0},
        },
        "status": {"calibrated": True, "ready": True, "power_supply": True, "in_use": False},
    }


async def serve(socket, path):
    await socket.send(json.dumps({"session_id": 1, "inverse3": [state(name) for name in NAMES]}))
    async for text in socket:
        (arm,) = json.loads(text)["inverse3"]
        force = arm["commands"]["set_cursor_force"]["vector"]
        print(arm["device_id"], force["x"], force["y"], force["z"], flush=True)
        await socket.send(json.dumps({"inverse3": [state(name) for name in NAMES]}))


async def main():
    async with websockets.serve(serve, "127.0.0.1", 0) as server:
        with open(sys.argv[1] + ".new", "w") as file:
            file.write(str(server.sockets[0].getsockname()[1]))
        os.rename(sys.argv[1] + ".new", sys.argv[1])
        await asyncio.Future()


asyncio.run(main())
