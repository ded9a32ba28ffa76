"""Operates a page in headless Chromium and prints its observations as JSON: console errors, requests, contents.

  page_browser.py CHROMIUM PAGE PICTURE TIME...     PICTURE: file of the screenshot; PICTURE_small.png is one at the
      last TIME, scaled to one eighth. TIME: s, times at which the force is read

It uses the remote debugging of Chromium, on a free port of this computer.
"""
import asyncio
import base64
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import urllib.request

import websockets


class Tab:
    """A page in Chromium. Answers are matched to commands by number; events in between are stored."""

    def __init__(self, socket):
        self.socket = socket
        self.number = 0
        self.events = []

    async def call(self, method, **parameters):
        self.number += 1
        await self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(await asyncio.wait_for(self.socket.recv(), 120))
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    async def value(self, expression):
        result = await self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    async def wait_for(self, expression):
        for _ in range(1800):
            if await self.value(expression):
                return
            await asyncio.sleep(0.1)
        raise RuntimeError(f"never came true: {expression}")

    async def picture(self, path, scale=1, size=(1280, 960)):
        clip = {"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": scale}
        shot = await self.call("Page.captureScreenshot", format="png", clip=clip)
        pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))


# Waits until the browser has drawn the requested state.
DRAWN = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"


def said(events):
    """Returns warnings and errors of the console, and uncaught exceptions."""
    words = []
    for event in events:
        parameters = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            words.append(str(parameters["exceptionDetails"]))
        if event.get("method") == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            words.append(" ".join(str(one.get("value", one.get("description"))) for one in parameters["args"]))
        if event.get("method") == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            words.append(parameters["entry"]["text"])
    # Chromium's messages about drawing without a graphics card.
    return [one for one in words if "GPU stall" not in one and "swiftshader" not in one.lower()]


async def look(address, page, picture, times):
    async with websockets.connect(address, max_size=None) as socket:
        tab = Tab(socket)
        for domain in ("Page", "Runtime", "Log", "Network"):
            await tab.call(domain + ".enable")
        await tab.call("Emulation.setDeviceMetricsOverride", width=1280, height=960, deviceScaleFactor=1, mobile=False)
        await tab.call("Page.navigate", url=page)
        await tab.wait_for("window.thimblePage !== undefined")
        await tab.value(DRAWN)
        found = {"duration": await tab.value("thimblePage.duration")}
        await tab.picture(picture)

        found["forces"] = []
        for time in times:
            await tab.value(f"thimblePage.seek({time})")
            found["forces"].append(await tab.value("thimblePage.state()"))
        await tab.value(DRAWN)
        await tab.picture(picture.replace(".png", "_small.png"), 1 / 8)

        # Playback: time advances, pictures are drawn, and a pause stops it.
        await tab.value("thimblePage.seek(0); document.getElementById('speed').value = '0.25';"
                        "document.getElementById('speed').dispatchEvent(new Event('change'));"
                        "document.getElementById('play').click()")
        before = await tab.value("thimblePage.state()")
        await tab.wait_for(f"thimblePage.state().drawn > {before['drawn']} + 3 && thimblePage.state().t > 0")
        await tab.value("document.getElementById('play').click()")
        paused = await tab.value("thimblePage.state()")
        await tab.value(DRAWN)
        found["played"] = paused["t"] > 0 and not paused["playing"]
        found["held"] = (await tab.value("thimblePage.state()"))["t"] == paused["t"]

        # Scrubbing: a press in the middle of the time line seeks there.
        middle = await tab.value("(() => { const box = document.getElementById('strip').getBoundingClientRect();"
                                 "return [box.left + box.width / 2, box.top + box.height / 2]; })()")
        for kind in ("mousePressed", "mouseReleased"):
            await tab.call("Input.dispatchMouseEvent", type=kind, x=middle[0], y=middle[1], button="left",
                           buttons=1, clickCount=1)
        found["scrubbed"] = (await tab.value("thimblePage.state()"))["t"]

        # A zoom applies to the windows of all plots; a channel can be hidden.
        await tab.value(f"thimblePage.zoom({found['duration'] / 4}, {found['duration'] / 2})")
        found["window"] = (await tab.value("thimblePage.state()"))["window"]
        await tab.value("document.querySelector('[data-channel=depth]').click()")
        found["plotted"] = (await tab.value("thimblePage.state()"))["plotted"]
        found["words"] = await tab.value("document.body.innerText")
        await try_to_get_out(tab)
    found.update(what_went_out(tab))
    return found


async def try_to_get_out(tab):
    """Makes a script of the page request another address. The policy of the page must refuse it before any network access."""
    await tab.value("fetch('http://127.0.0.1:1/').catch(() => 0)")
    await tab.value(DRAWN)


def what_went_out(tab):
    found = {}
    asked = [event["params"] for event in tab.events if event.get("method") == "Network.requestWillBeSent"]
    tried = {one["requestId"] for one in asked if "127.0.0.1:1/" in one["request"]["url"]}
    refused = {event["params"]["requestId"] for event in tab.events
               if event.get("method") == "Network.loadingFailed" and event["params"].get("blockedReason") == "csp"}
    found["leaks"] = "went out" if tried - refused else "held"
    found["requests"] = [one["request"]["url"] for one in asked
                         if one["requestId"] not in tried and not one["request"]["url"].startswith("data:")]
    found["said"] = [one for one in said(tab.events) if "127.0.0.1:1/" not in one]
    return found


def in_chromium(chromium, work):
    """Starts Chromium without a screen and returns the result of `work`, which gets the address of the first tab."""
    with tempfile.TemporaryDirectory() as home:
        browser = subprocess.Popen(
            [chromium, "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", "--window-size=1280,960", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--remote-debugging-port=0",
             "--user-data-dir=" + home, "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
        try:
            for line in browser.stderr:
                if line.startswith("DevTools listening on "):
                    port = line.split("127.0.0.1:")[1].split("/")[0]
                    break
            else:
                raise RuntimeError("Chromium does not start")
            # Reads and drops later output, so that the pipe cannot fill.
            threading.Thread(target=lambda: [None for _ in browser.stderr], daemon=True).start()
            open_ones = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json"))
            return asyncio.run(work(next(one["webSocketDebuggerUrl"] for one in open_ones if one["type"] == "page")))
        finally:
            os.killpg(browser.pid, signal.SIGTERM)
            browser.wait()


def main():
    chromium, page, picture, *times = sys.argv[1:]
    found = in_chromium(chromium, lambda tab: look(tab, pathlib.Path(page).resolve().as_uri(), picture, times))
    print(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
