"""HTML pages: in notebooks, as files, in a browser."""

from __future__ import annotations

import json
import subprocess
import tempfile
import webbrowser
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from ._arguments import PathOrName, path_of, whole_of
from ._core import ArgumentError, Error
from ._study import BAD_INPUT, program

if TYPE_CHECKING:
    from ._ticks import Ticks
    from ._timeline import Timeline


class Page:
    """An HTML page that needs no network. A notebook displays it.

    height: height in a notebook, pixels.
    """

    def __init__(self, html: str, height: int = 640) -> None:
        self.html = html
        self.height = height

    def save(self, path: PathOrName) -> None:
        """Write it as an HTML file."""
        Path(path_of("path", path)).write_text(self.html, encoding="utf-8")

    def open(self) -> bool:
        """Show it in the browser, as a temporary file that remains. Returns whether a browser was found."""
        with tempfile.NamedTemporaryFile("w", prefix="thimble-", suffix=".html", delete=False, encoding="utf-8") as file:
            file.write(self.html)
        return webbrowser.open(Path(file.name).as_uri())

    def __repr__(self) -> str:
        return f"Page({len(self.html.encode()) / 1e6:.2f} MB; .save(path) writes it, .open() shows it in a browser)"

    def _repr_html_(self) -> str:
        # Scripts of the page run in a frame without access to the notebook.
        return (
            f'<iframe sandbox="allow-scripts" style="width:100%;height:{self.height}px;border:0" '
            f'srcdoc="{escape(self.html)}"></iframe>'
        )


def show(
    run: Union[Ticks, Timeline, PathOrName], *, timeline: Optional[Timeline] = None, height: Optional[int] = None
) -> Page:
    """Return the page that plays a run: scene, arm, forces and plots on one time line. A notebook displays it.

    run: a :class:`Run`, which the program repeats to draw it, bit-identically; the file of a recording; a
    :class:`Timeline`; or other ticks, such as a recording that was read, of which only the curves are known. A run
    that the program cannot repeat (see :meth:`Run.shot`) is shown as curves, too. timeline: other runs and signals of
    your own, drawn below; their cursor follows the moment that is played. height: height in a notebook, pixels; by
    default 640, and 1000 with a timeline.
    """
    from ._runs import Run
    from ._ticks import Ticks
    from ._timeline import Timeline

    if timeline is not None and not isinstance(timeline, Timeline):
        raise TypeError(f"timeline: expected a Timeline, found {timeline!r}.")
    pixels = whole_of("height", (640 if timeline is None else 1000) if height is None else height, 100, 10_000)
    if isinstance(run, Timeline):
        page = run.page()
    elif isinstance(run, Run) and run._shot_source is not None and not run._shot_source.why_not:
        page = _of_run(run)
    elif isinstance(run, Ticks):
        page = Timeline([run], title=run._title()).page()
    else:
        try:
            file = path_of("run", run)
        except TypeError:
            raise TypeError(f"run: expected a Run, a Timeline, ticks or the file of a recording, found {run!r}.") from None
        page = _made("replay", file)
    if timeline is not None:
        page = _above(page, timeline.page())
    page.height = pixels
    return page


# Posts the time that the page of a run shows in its clock ("1.406 / 2.000 s").
_POSTS_TIME = """<script>
{
  const clock = document.getElementById("clock");
  const post = () => { const time = parseFloat(clock.textContent); if (Number.isFinite(time)) parent.postMessage({time}, "*"); };
  if (clock) { new MutationObserver(post).observe(clock, {childList: true, characterData: true, subtree: true}); addEventListener("load", post); post(); }
}
</script>
</body>"""

_TWO_PAGES = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>Thimble</title>
<style>
html, body { height: 100%; margin: 0; }
body { display: flex; flex-direction: column; }
iframe { border: 0; width: 100%; flex: 3; min-height: 0; }
iframe + iframe { flex: 2; border-top: 1px solid #9aa5b1; }
</style>
</head>
<body>
<script>
"use strict";
const [above, below] = /*PAGES*/[].map(text => {
  const frame = document.createElement("iframe");
  frame.setAttribute("sandbox", "allow-scripts");
  frame.srcdoc = text;
  document.body.append(frame);
  return frame;
});
let last = null;
const pass = () => { if (last !== null) below.contentWindow.postMessage({time: last}, "*"); };
below.addEventListener("load", pass);
addEventListener("message", event => {
  if (event.source !== above.contentWindow || !event.data || typeof event.data.time !== "number") return;
  last = event.data.time;
  document.body.dataset.time = last;
  pass();
});
</script>
</body>
</html>
"""


def _above(run: Page, timeline: Page) -> Page:
    """Return a page with a run above a timeline, whose cursor follows the run."""
    above, end, rest = run.html.rpartition("</body>")
    pages = [above + _POSTS_TIME + rest if end else run.html, timeline.html]
    return Page(_TWO_PAGES.replace("/*PAGES*/[]", json.dumps(pages).replace("<", "\\u003c")))


def _of_run(run: Any) -> Page:
    source, info = run._shot_source, run.info
    ticks = run.stride * len(run)
    options: list[str] = ["--duration", repr(ticks / float(info["rate"])), "--seed", str(info["seed"]), "--no-view"]
    if source.arm is not None:
        options += ["--arm", path_of("arm", source.arm)]
    return _made("run", source.scene, *options)


def _made(command: str, file: str, *options: str) -> Page:
    """Return the page that a command of the program writes."""
    with tempfile.TemporaryDirectory(prefix="thimble-page-") as folder:
        page = Path(folder, "index.html")
        output = ["--page", str(page)] if command == "replay" else ["--report", folder]
        done = subprocess.run(
            [program(), command, file, *options, *output], capture_output=True, text=True, check=False
        )
        said = done.stderr.strip() or done.stdout.strip()
        if done.returncode == BAD_INPUT:
            raise ArgumentError(f"thimble {command}: {said}")
        if not page.is_file():
            raise Error(f"thimble {command} wrote no page: {said}")
        return Page(page.read_text(encoding="utf-8"))
