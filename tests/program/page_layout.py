"""Checks the layout and the colours of a page that plays a run, at the sizes of a small laptop and of a phone.

  page_layout.py CHROMIUM PAGE PICTURES     PICTURES: folder of the screenshots: laptop and phone, light and dark
"""
import pathlib
import re
import sys

import websockets

from page_browser import DRAWN, Tab, in_chromium, said

LAPTOP = (1280, 720)
PHONE = (390, 844)
MIN_CONTRAST = 4.5  # WCAG 2.1, success criterion 1.4.3: text of normal size
# Behind the values over the scene: dark parts of arms on a light page, light surfaces on a dark one. [measured on pictures
# of the shipped scenes]
BEHIND = {"light": (90, 99, 109), "dark": (201, 214, 226)}

BOX = "(id => { const b = document.getElementById(id).getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom]; })"
STYLE = "((id, name) => getComputedStyle(typeof id === 'string' ? document.querySelector(id) : id)[name])"
# Colour of a pixel of the timeline's upper left corner, where no force is drawn.
CORNER = ("(() => { const c = document.createElement('canvas'), pen = c.getContext('2d');"
          "pen.drawImage(document.querySelector('#strip canvas'), -12, -12); return [...pen.getImageData(0, 0, 1, 1).data]; })()")


def colour(text):
    """Returns red, green, blue and opacity of a colour in CSS."""
    parts = [float(one) for one in re.findall(r"[0-9.]+", text)]
    return parts[:3] + [parts[3] if len(parts) > 3 else 1.0]


def over(front, behind):
    return [front[3] * a + (1 - front[3]) * b for a, b in zip(front, behind)]


def luminance(rgb):
    """Relative luminance (WCAG 2.1)."""
    linear = [one / 255 / 12.92 if one / 255 <= 0.03928 else ((one / 255 + 0.055) / 1.055) ** 2.4 for one in rgb]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


class Layout:
    def __init__(self, tab, page, pictures):
        self.tab, self.page, self.pictures = tab, page, pathlib.Path(pictures)
        self.wrong = []

    def check(self, true, what):
        if not true:
            self.wrong.append(what)

    async def load(self, fragment=""):
        await self.tab.call("Page.navigate", url="about:blank")  # another fragment alone does not load the page again
        await self.tab.call("Page.navigate", url=self.page + fragment)
        await self.tab.wait_for("window.thimblePage !== undefined")
        await self.tab.value(DRAWN)

    async def show(self, size, scheme):
        await self.tab.call("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1,
                            mobile=size == PHONE)
        await self.tab.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        await self.tab.value(DRAWN)

    async def box(self, name):
        return await self.tab.value(f"{BOX}('{name}')")

    async def style(self, selector, name):
        return await self.tab.value(f"{STYLE}('{selector}', '{name}')")

    async def aligned(self, where):
        extents = await self.tab.value("thimblePage.extents()")
        apart = max(abs(a - b) for a, b in zip(extents["plots"], extents["strip"]))
        self.check(apart <= 1, f"{where}: the timeline is {apart:.1f} px off the time axis of the plots")

    async def readable(self, where, scheme):
        paper = colour(await self.style("body", "backgroundColor"))
        dark = luminance(paper) < 0.1
        self.check(dark == (scheme == "dark"), f"{where}: the page is {'dark' if dark else 'light'}")
        glass = over(colour(await self.style("#readout", "backgroundColor")), BEHIND[scheme])
        for selector, ground in (("body", paper), ("header p", paper), ("#figures td", paper), ("#readout dt", glass),
                                 ("#readout dd", glass), ("#scales", glass), ("#stage-choices span", glass),
                                 (".plot h3", paper)):
            ratio = contrast(colour(await self.style(selector, "color")), ground)
            self.check(ratio >= MIN_CONTRAST, f"{where}: text of {selector} has a contrast of {ratio:.1f}")
        for channel in ("requested", "force", "depth", "period"):
            ratio = contrast(colour(await self.tab.value(
                f"(() => {{ const i = document.createElement('i'); i.style.color = 'var(--{channel})'; document.body.append(i);"
                "const is = getComputedStyle(i).color; i.remove(); return is; })()")), paper)
            self.check(ratio >= 3, f"{where}: the curve {channel} has a contrast of {ratio:.1f}")  # WCAG 1.4.11
        corner = luminance((await self.tab.value(CORNER))[:3])
        self.check((corner < 0.2) == (scheme == "dark"), f"{where}: the timeline has the other theme")

    async def laptop(self, scheme):
        where = f"laptop, {scheme}"
        await self.show(LAPTOP, scheme)
        await self.tab.picture(self.pictures / f"laptop_{scheme}.png", size=LAPTOP)
        height = await self.tab.value("document.documentElement.scrollHeight")
        self.check(height <= LAPTOP[1], f"{where}: the page is {height} px high")
        plots, stage = await self.box("plots"), await self.box("stage")
        self.check(plots[3] <= LAPTOP[1], f"{where}: the plots end at {plots[3]} px")
        self.check(stage[3] - stage[1] >= LAPTOP[1] / 3, f"{where}: the scene is only {stage[3] - stage[1]} px high")
        await self.aligned(where)
        await self.readable(where, scheme)

    async def phone(self, scheme):
        where = f"phone, {scheme}"
        await self.show(PHONE, scheme)
        await self.tab.picture(self.pictures / f"phone_{scheme}.png", size=PHONE)
        width = await self.tab.value("document.documentElement.scrollWidth")
        self.check(width <= PHONE[0], f"{where}: the page is {width} px wide")
        stage = await self.box("stage")
        self.check(stage[2] - stage[0] >= 0.9 * PHONE[0], f"{where}: the scene is {stage[2] - stage[0]} px wide")
        for end in ("0", "document.documentElement.scrollHeight"):
            await self.tab.value(f"window.scrollTo(0, {end})")
            await self.tab.value(DRAWN)
            strip = await self.box("strip")
            self.check(strip[1] >= 0 and strip[3] <= PHONE[1], f"{where}: the timeline is not on the screen")
            self.check(strip[2] - strip[0] >= 0.75 * PHONE[0], f"{where}: the timeline is {strip[2] - strip[0]} px wide")
        await self.aligned(where)
        await self.readable(where, scheme)

    async def switch(self):
        """The switch changes the theme at once, and a later visit keeps it."""
        await self.show(LAPTOP, "light")
        await self.tab.value("document.getElementById('theme').click()")
        await self.tab.value(DRAWN)
        await self.readable("after the switch", "dark")
        await self.load()
        await self.readable("a later visit", "dark")
        await self.load("#theme=light")
        await self.readable("the theme of the address", "light")

    async def all_plots(self):
        """Another plot keeps the page on the screen, the axes aligned and the scene undistorted."""
        await self.tab.value("document.querySelector('[data-channel=speed]').click()")
        await self.tab.value(DRAWN)
        await self.aligned("four plots")
        height = await self.tab.value("document.documentElement.scrollHeight")
        self.check(height <= LAPTOP[1], f"four plots: the page is {height} px high")
        view = await self.tab.value("(() => { const v = document.querySelector('canvas.view'), s = document.getElementById('stage');"
                                    "return v ? [v.width / v.height, s.clientWidth / s.clientHeight] : [1, 1]; })()")
        self.check(abs(view[0] / view[1] - 1) < 0.02, f"the scene is distorted: {view}")


async def look(address, page, pictures):
    async with websockets.connect(address, max_size=None) as socket:
        tab = Tab(socket)
        for domain in ("Page", "Runtime", "Log"):
            await tab.call(domain + ".enable")
        layout = Layout(tab, page, pictures)
        # The page is loaded dark, then the theme of the system changes while it is open.
        await layout.show(LAPTOP, "dark")
        await layout.load()
        for scheme in ("dark", "light"):
            await layout.laptop(scheme)
            await layout.phone(scheme)
        await layout.switch()
        await layout.all_plots()
        layout.wrong += [f"console: {one}" for one in said(tab.events)]
        return layout.wrong


def main():
    chromium, page, pictures = sys.argv[1:]
    pathlib.Path(pictures).mkdir(parents=True, exist_ok=True)
    wrong = in_chromium(chromium, lambda tab: look(tab, pathlib.Path(page).resolve().as_uri(), pictures))
    print("\n".join(wrong) if wrong else "as it should be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
