"""Operates the page of a live run in headless Chromium and prints its observations as JSON.

  live_page_browser.py CHROMIUM ADDRESS PICTURE STOP...      ADDRESS: as `thimble view --web` prints it; STOP: the
      command that ends the run. Without STOP only a picture is made, scaled to one eighth
"""
import asyncio
import json
import subprocess
import sys

import websockets

from page_browser import DRAWN, Tab, in_chromium, try_to_get_out, what_went_out


async def steer(tab):
    """Turns a knob, pauses and restarts the run with the controls of the page; the run confirms each change to the page."""
    found = {}
    knob = "document.querySelector('#knobs input')"
    await tab.wait_for("thimblePage.state().live.knobs !== undefined")
    initial = await tab.value("thimblePage.state().live.knobs[0]")
    await tab.value(f"{knob}.value = {knob}.value > 500 ? 200 : 800; {knob}.dispatchEvent(new Event('input'))")
    await tab.wait_for(f"thimblePage.state().live.knobs[0] !== {initial}")
    await tab.value("document.getElementById('steer-pause').click()")
    await tab.wait_for("thimblePage.state().live.state === 'paused'")
    found["paused_words"] = await tab.value("document.getElementById('steer-pause').textContent")
    found["steps_by_the_wall"] = not await tab.value("document.getElementById('steer-step').disabled")
    await tab.value("document.getElementById('steer-pause').click()")
    await tab.wait_for("thimblePage.state().live.state === 'running'")
    await tab.value("window.before = true; document.getElementById('steer-restart').click()")
    await tab.wait_for("window.before === undefined && window.thimblePage !== undefined && thimblePage.begun")
    await tab.wait_for("thimblePage.state().live.knobs !== undefined")
    found["knob_anew"] = await tab.value("thimblePage.state().live.knobs[0]") == initial
    found["steer_note"] = await tab.value("document.getElementById('steer-note').textContent")
    return found


async def look(address, page, picture, stop):
    async with websockets.connect(address, max_size=None) as socket:
        tab = Tab(socket)
        for domain in ("Page", "Runtime", "Log", "Network"):
            await tab.call(domain + ".enable")
        await tab.call("Emulation.setDeviceMetricsOverride", width=1280, height=960, deviceScaleFactor=1, mobile=False)
        await tab.call("Page.navigate", url=page)
        await tab.wait_for("window.thimblePage !== undefined && thimblePage.begun")
        if not stop:
            await tab.value(DRAWN)
            await asyncio.sleep(1)  # lists and plots are drawn a few times a second
            await tab.value(DRAWN)
            await tab.picture(picture, 1 / 8)
            return {}
        found = await steer(tab)

        # The page follows the run.
        before = await tab.value("thimblePage.state()")
        await tab.wait_for(f"thimblePage.state().t > {before['t']} + 1.5 && thimblePage.state().drawn > {before['drawn']} + 1")
        await tab.value(DRAWN)
        await tab.picture(picture)
        found["followed"] = (await tab.value("thimblePage.state()"))["following"]

        # After a seek the page stays at its moment while the run continues; a button returns to live.
        await tab.value("thimblePage.seek(thimblePage.state().t - 1)")
        held = await tab.value("thimblePage.state()")
        await tab.wait_for(f"thimblePage.duration > {held['t']} + 1.5")
        still = await tab.value("thimblePage.state()")
        found["held"] = still["t"] == held["t"] and still["tick"] == held["tick"] and not still["following"]
        found["held_words"] = await tab.value("document.getElementById('live').textContent")
        await tab.value("document.getElementById('now').click()")
        await tab.value(DRAWN)
        now = await tab.value("thimblePage.state()")
        found["came_back"] = now["following"] and now["t"] > held["t"] + 1

        # The page ends with the run, and its data can still be viewed.
        subprocess.run(stop, check=True)
        await tab.wait_for("thimblePage.state().live.state === 'ended'")
        await tab.value(DRAWN)
        found["end"] = await tab.value("thimblePage.state()")
        found["words"] = await tab.value("document.body.innerText")
        found["forces"] = []
        for share in (0.2, 0.5, 0.7, 0.9):
            await tab.value(f"thimblePage.seek(thimblePage.state().begin * (1 - {share}) + thimblePage.duration * {share})")
            found["forces"].append(await tab.value("thimblePage.state()"))
        await try_to_get_out(tab)
    found.update(what_went_out(tab))
    return found


def main():
    chromium, page, picture, *stop = sys.argv[1:]
    print(json.dumps(in_chromium(chromium, lambda tab: look(tab, page, picture, stop)), indent=1))


if __name__ == "__main__":
    main()
