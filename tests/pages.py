"""Opens pages and figures in a browser without a window and looks at them as readers do.

    python3 tests/pages.py [--shots DIR] PLACE...       needs chromium (or the browser named in $CHROMIUM)

A place is a page, a figure, or a directory with all of both below it. Each is opened at 390 and 1200 px, light and dark. A message on the
console, a file that cannot be loaded, a request that leaves the directory, or a page that is wider than its window is a fault; of a figure
texts that lie on one another, that are cut off, that are smaller than 11 px where the figure is 1000 px wide, or that can hardly be told from
what is behind them, or more than six lines in one frame; of the paper's page a height of more than 12,000 px. Pictures of whole pages go to DIR.
"""

import argparse
import base64
import fcntl
import json
import math
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

WIDTHS = [390, 1200]
# The greatest height of a page in a wide window, px, by the name of its directory.
HEIGHTS = {"paper": 12_000}
SCHEMES = ["light", "dark"]
# The most series in one frame.
SERIES_MOST = 6
# Faults of texts that are told of a page.
MOST = 6
# Seconds that the browser may take for an answer.
PATIENCE = 60.0

# How much wider the page is than its window, and what reaches beyond it, boxes that scroll aside.
OVERFLOW = """(() => {
    const root = document.documentElement;
    const scrolls = (e) => e && (/auto|scroll|hidden/.test(getComputedStyle(e).overflowX) || scrolls(e.parentElement));
    const beyond = [...document.querySelectorAll('body *')].filter((e) => !(e instanceof SVGElement && !(e instanceof SVGSVGElement))
        && e.getBoundingClientRect().right > root.clientWidth + 1 && !scrolls(e.parentElement));
    const name = (e) => e.tagName.toLowerCase() + (e.id ? '#' + e.id : '') + ' "' + e.textContent.trim().slice(0, 40) + '"';
    return { over: root.scrollWidth - root.clientWidth, beyond: beyond.slice(0, 5).map(name), height: root.scrollHeight };
})()"""


# What is wrong with the texts of figures. A line between two texts that only touch is no overlap: boxes hold room for letters that are not there.
# Letters in their colour are compared with the paper behind the figure (W3C's contrast, of which 3 is enough for large letters).
TEXTS = """(() => {
    const faults = [], round = (x) => Number(x.toFixed(1));
    const rgb = (colour) => (colour.match(/[\\d.]+/g) ?? [0, 0, 0]).slice(0, 3).map(Number);
    const light = (colour) => {
        const [r, g, b] = rgb(colour).map((c) => (c / 255 <= .04045 ? c / 3294.6 : ((c / 255 + .055) / 1.055) ** 2.4));
        return .2126 * r + .7152 * g + .0722 * b;
    };
    for (const svg of document.querySelectorAll('svg')) {
        const box = svg.getBoundingClientRect();
        if (!box.width || !box.height) continue;
        const wide = svg.viewBox.baseVal?.width || box.width;
        const seen = (t) => t.textContent.trim() && getComputedStyle(t).visibility !== 'hidden';
        const texts = [...svg.querySelectorAll('text')].filter(seen);
        const rects = texts.map((t) => t.getBoundingClientRect());
        const word = (t) => JSON.stringify(t.textContent.trim().slice(0, 30));
        const paper = svg.querySelector('path[fill="#FFFFFF"]');
        const behind = paper && texts.length ? light(getComputedStyle(paper).fill) : null;
        texts.forEach((t, i) => {
            const own = rects[i], style = getComputedStyle(t);
            const size = parseFloat(style.fontSize) * 1000 / wide;
            if (size < 10.9) faults.push(`${word(t)} has ${round(size)} px`);
            if (own.left < box.left - 1 || own.right > box.right + 1 || own.top < box.top - 1 || own.bottom > box.bottom + 1)
                faults.push(`${word(t)} is cut off`);
            if (behind !== null) {
                const [low, high] = [light(style.fill), behind].sort((a, b) => a - b);
                if ((high + .05) / (low + .05) < 2) faults.push(`${word(t)} can hardly be seen`);
            }
            for (const [j, other] of rects.slice(0, i).entries()) {
                const x = Math.min(own.right, other.right) - Math.max(own.left, other.left);
                const y = Math.min(own.bottom, other.bottom) - Math.max(own.top, other.top);
                const least = Math.min(own.height, other.height);
                if (x > .02 * least + .5 && y > .3 * least) faults.push(`${word(texts[j])} and ${word(t)} lie on one another`);
            }
        });
    }
    for (const caption of document.querySelectorAll('figcaption, table caption')) {
        const { left, right } = caption.getBoundingClientRect();
        if (right - left > document.documentElement.clientWidth || left < 0) faults.push(`the caption "${caption.textContent.trim().slice(0, 30)}" is not in view`);
    }
    return faults;
})()"""


# Frames of figures with more than six series: lines of different looks, or names beside the frame. A frame is the last rectangle of its path; a
# rule, straight across or upright, is no series.
SERIES = """(() => {
    const faults = [];
    for (const svg of document.querySelectorAll('svg.figure')) {
        if (!svg.getBoundingClientRect().width) continue;
        const paths = [...svg.querySelectorAll('path[fill="none"]')];
        const has = (path, name) => path.hasAttribute(name);
        const within = (a, b) => a.x >= b.x - 2 && a.y >= b.y - 2 && a.x + a.width <= b.x + b.width + 2 && a.y + a.height <= b.y + b.height + 2;
        const boxes = new Map(paths.map((path) => [path, path.getBBox()]));
        const isLine = (path) => has(path, 'stroke-dasharray') || (has(path, 'stroke-linecap') && has(path, 'stroke-linejoin'));
        const lines = paths.filter((path) => isLine(path) && boxes.get(path).width > 0 && boxes.get(path).height > 0);
        const leaders = paths.filter((path) => path.getAttribute('stroke') === '#999999' && path.getAttribute('stroke-width') === '3' && !isLine(path));
        for (const path of paths.filter((path) => path.getAttribute('stroke') === '#000000' && !has(path, 'stroke-linejoin'))) {
            const found = path.getAttribute('d').match(/M(-?\\d+) (-?\\d+)h(\\d+)v(\\d+)h-\\d+z$/);
            if (!found) continue;
            const [x, y, width, height] = found.slice(1).map(Number);
            const frame = { x, y, width, height };
            const look = (line) => ['stroke', 'stroke-width', 'stroke-dasharray'].map((name) => line.getAttribute(name)).join();
            const looks = new Set(lines.filter((line) => within(boxes.get(line), frame)).map(look)).size;
            const begins = ({ x, y, width, height }) => x <= frame.x + frame.width + 1 && x + width > frame.x + frame.width + 1 && x >= frame.x - 2
                && y + height >= frame.y - 2 && y <= frame.y + frame.height + 2;
            const names = leaders.filter((line) => begins(boxes.get(line))).length;
            const count = Math.max(looks, names);
            if (count > 6) faults.push(count);
        }
    }
    return faults;
})()"""


class Browser:
    """A browser that is talked to over a pair of pipes (the DevTools protocol, `--remote-debugging-pipe`)."""

    def __init__(self):
        program = os.environ.get("CHROMIUM") or next(
            (found for name in ["chromium", "chromium-browser", "google-chrome"] if (found := shutil.which(name))), None
        )
        if program is None:
            sys.exit("pages.py needs chromium: install it, or name a browser of its kind in $CHROMIUM")
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        (their_in, our_out), (our_in, their_out) = os.pipe(), os.pipe()
        # Away from 3 and 4, the numbers that the browser expects.
        their_in, their_out = (fcntl.fcntl(fd, fcntl.F_DUPFD, 20) for fd in (their_in, their_out))
        sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []
        options = ["--headless=new", *sandbox, "--remote-debugging-pipe", "--no-first-run", "--disable-gpu", "--hide-scrollbars"]
        self.process = subprocess.Popen(
            [program, *options, f"--user-data-dir={self.profile.name}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=(3, 4),
            preexec_fn=lambda: (os.dup2(their_in, 3), os.dup2(their_out, 4)),
        )
        os.close(their_in)
        os.close(their_out)
        self.out, self.inp, self.number, self.rest, self.events = our_out, our_in, 0, b"", []

    def message(self, until):
        """The next message, or none until a time."""
        while b"\0" not in self.rest:
            if not select.select([self.inp], [], [], max(0.0, until - time.monotonic()))[0]:
                return None
            more = os.read(self.inp, 1 << 20)
            if not more:
                sys.exit("the browser has ended")
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def ask(self, method, session=None, **params):
        """The answer to a command. Events that come before it are kept."""
        self.number += 1
        command = {"id": self.number, "method": method, "params": params}
        text = json.dumps(command | ({"sessionId": session} if session else {})).encode() + b"\0"
        while text:
            text = text[os.write(self.out, text) :]
        until = time.monotonic() + PATIENCE
        while (message := self.message(until)) is not None:
            if message.get("id") == self.number:
                if "error" in message:
                    sys.exit(f"{method}: {message['error']['message']}")
                return message["result"]
            self.events.append(message)
        sys.exit(f"{method}: no answer")

    def wait(self, event, session):
        """Waits for an event."""
        until = time.monotonic() + PATIENCE
        while not any(e.get("method") == event and e.get("sessionId") == session for e in self.events):
            message = self.message(until)
            if message is None:
                sys.exit(f"{event} did not come")
            self.events.append(message)

    def close(self):
        self.ask("Browser.close")
        self.process.wait(PATIENCE)


def said(event):
    """What an event says that should not be, if anything."""
    params = event.get("params", {})
    match event.get("method"):
        case "Runtime.consoleAPICalled":
            return "console: " + " ".join(str(a.get("value", a.get("description", ""))) for a in params["args"])
        case "Runtime.exceptionThrown":
            return "exception: " + params["exceptionDetails"].get("text", "")
        case "Log.entryAdded":
            return f"log: {params['entry']['text']} {params['entry'].get('url', '')}"
        case "Network.loadingFailed":
            return f"not loaded: {params.get('errorText', '')}"
        case "Network.requestWillBeSent" if not params["request"]["url"].startswith(("file:", "data:")):
            return f"request to {params['request']['url']}"
    return None


def look(browser, page, width, scheme, shots):
    """The faults of a page at a width in a colour scheme."""
    target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
    session = browser.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    ask = lambda method, **params: browser.ask(method, session, **params)
    for domain in ["Page", "Runtime", "Log", "Network"]:
        ask(f"{domain}.enable")
    ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)
    ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
    browser.events.clear()
    ask("Page.navigate", url=page.resolve().as_uri())
    browser.wait("Page.loadEventFired", session)
    js = lambda expression: ask("Runtime.evaluate", expression=expression, returnByValue=True)["result"]["value"]
    figure = page.suffix == ".svg"
    # A figure alone may be wider than a window: it is scrolled.
    seen = {"over": 0, "beyond": [], "height": js("document.documentElement.getBoundingClientRect().height")} if figure else js(OVERFLOW)
    if shots:
        clip = {"x": 0, "y": 0, "width": width, "height": seen["height"], "scale": 1}
        data = ask("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)["data"]
        name = f"{page.resolve().parent.name}-{page.stem}-{width}-{scheme}.png"
        (shots / name).write_bytes(base64.b64decode(data))
    faults = [words for event in browser.events if event.get("sessionId") == session and (words := said(event))]
    if seen["over"] > 0 or seen["beyond"]:
        faults.append(f"{seen['over']} px wider than its window: {'; '.join(seen['beyond'])}")
    texts = js(TEXTS) + [f"{count} series in one frame" for count in js(SERIES) if count > SERIES_MOST]
    faults += [*texts[:MOST], *([f"and {len(texts) - MOST} more"] if len(texts) > MOST else [])]
    if width > 500 and seen["height"] > (most := HEIGHTS.get(page.resolve().parent.name, math.inf)):
        faults.append(f"{seen['height']} px high: at most {most}")
    browser.ask("Target.closeTarget", targetId=target)
    return faults


# A figure with one fault of each kind, and what is to be said of it.
BAD = """<!doctype html><meta charset="utf-8"><title>bad</title><svg viewBox="0 0 1000 200" width="380" height="76"><path d="M0 0h1000v200h-1000z" fill="#FFFFFF"/>
<text x="10" y="50" font-size="30">one word</text><text x="60" y="55" font-size="30">another</text><text x="900" y="120" font-size="40">beyond</text>
<text x="10" y="120" font-size="8">small</text><text x="10" y="180" font-size="30" fill="#EEEEEE">pale</text></svg>
<svg class="figure" viewBox="0 0 1000 200" width="380" height="76"><path d="M0 50h5M10 10h900v180h-900z" fill="none" stroke="#000000" stroke-width="6"/>LINES</svg>"""
LINE = '<path d="M20 20l800 {0}" fill="none" stroke="{1}" stroke-width="11" stroke-linejoin="round" stroke-linecap="round"/>'
BAD = BAD.replace("LINES", "".join(LINE.format(20 * n, f"#00{n}000") for n in range(1, 8)))
KINDS = ["lie on one another", "is cut off", "has 8 px", "can hardly be seen", "7 series in one frame"]


def blind(browser):
    """The kinds of faults that are not seen in a figure that has them."""
    with tempfile.TemporaryDirectory() as place:
        page = Path(place) / "bad.html"
        page.write_text(BAD)
        faults = look(browser, page, 1200, "light", None)
    return [kind for kind in KINDS if sum(kind in fault for fault in faults) != 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("places", nargs="+", type=Path, metavar="PLACE")
    parser.add_argument("--shots", type=Path, metavar="DIR", help="where pictures of the pages go")
    parser.add_argument("--faults", action="store_true", help="tell nothing of what is fine")
    args = parser.parse_args()
    missing = [str(place) for place in args.places if not place.exists()]
    if missing:
        sys.exit(f"not there: {', '.join(missing)}")
    below = lambda place: sorted(page for page in place.rglob("*") if page.suffix in (".html", ".svg")) if place.is_dir() else [place]
    pages = [page for place in args.places for page in below(place)]
    if args.shots:
        args.shots.mkdir(parents=True, exist_ok=True)
    browser, bad = Browser(), 0
    if missed := blind(browser):
        sys.exit(f"a figure with faults is called fine: {', '.join(missed)}")
    for page in pages:
        for width in WIDTHS:
            for scheme in SCHEMES:
                faults = look(browser, page, width, scheme, args.shots)
                bad += len(faults)
                if faults or not args.faults:
                    print(f"{page} at {width} px, {scheme}: {'fine' if not faults else ''}")
                for fault in faults:
                    print(f"  fault: {fault}")
    browser.close()
    print(f"{len(pages)} pages and figures, {bad} faults")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
