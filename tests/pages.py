"""Opens pages in a browser without a window and looks at them as readers do.

    python3 tests/pages.py [--shots DIR] PAGE...       needs chromium (or the browser named in $CHROMIUM)

Each page is opened at 390 and 1280 px, light and dark. A message on the console, a file that cannot be loaded, a request that leaves the
directory, or a page that is wider than its window is a fault. Pictures of whole pages go to DIR.
"""

import argparse
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

WIDTHS = [390, 1280]
SCHEMES = ["light", "dark"]
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
    seen = ask("Runtime.evaluate", expression=OVERFLOW, returnByValue=True)["result"]["value"]
    if shots:
        clip = {"x": 0, "y": 0, "width": width, "height": seen["height"], "scale": 1}
        data = ask("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)["data"]
        name = f"{page.resolve().parent.name}-{page.stem}-{width}-{scheme}.png"
        (shots / name).write_bytes(base64.b64decode(data))
    faults = [words for event in browser.events if event.get("sessionId") == session and (words := said(event))]
    if seen["over"] > 0 or seen["beyond"]:
        faults.append(f"{seen['over']} px wider than its window: {'; '.join(seen['beyond'])}")
    browser.ask("Target.closeTarget", targetId=target)
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pages", nargs="+", type=Path, metavar="PAGE")
    parser.add_argument("--shots", type=Path, metavar="DIR", help="where pictures of the pages go")
    args = parser.parse_args()
    missing = [str(page) for page in args.pages if not page.is_file()]
    if missing:
        sys.exit(f"not there: {', '.join(missing)}")
    if args.shots:
        args.shots.mkdir(parents=True, exist_ok=True)
    browser, bad = Browser(), 0
    for page in args.pages:
        for width in WIDTHS:
            for scheme in SCHEMES:
                faults = look(browser, page, width, scheme, args.shots)
                bad += len(faults)
                print(f"{page} at {width} px, {scheme}: {'fine' if not faults else ''}")
                for fault in faults:
                    print(f"  fault: {fault}")
    browser.close()
    print(f"{len(args.pages)} pages, {bad} faults")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
