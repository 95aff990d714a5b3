"""Drives the page of `retune explore` in a browser without a window, as a person does.

    python3 tests/explore.py RETUNE [--shots DIR]          what must hold
    python3 tests/explore.py RETUNE --bench [SECONDS]      how fast it is: results/explore/bench.txt
    python3 tests/explore.py RETUNE --picture FILE         the picture of the tutorial: docs/figures/explore.png

Needs chromium (or the browser named in $CHROMIUM). RETUNE is the program.
"""

import argparse
import ast
import atexit
import base64
import json
import os
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pages import OVERFLOW, PATIENCE, Browser, look, said

ROOT = Path(__file__).resolve().parent.parent
RESULTS = "results/ssvi"
# 225.8 J from rest, and 735.6 J from other starts: what `retune branches` found of it.
ISOLA = "studies/ssvi-isola.json"
BRANCHES = "results/branches/isola/branches.json"
# Where `just test-python` installs the package; or any other that has it.
PYTHON = os.environ.get("RETUNE_PYTHON") or str(ROOT / "target/test-python/bin/python")
WIDTHS = [390, 768, 1280, 1600]
# The greatest size of the page, with all that it loads, bytes.
LARGEST_PAGE = 300_000


class Explorer:
    """`retune explore`, running."""

    def __init__(self, program, study=RESULTS):
        command = [program, "explore", *([study] if study else []), "--no-browser"]
        self.process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        atexit.register(self.process.kill)
        self.address = self.process.stdout.readline().strip()

    def memory(self):
        """Its resident memory, MB."""
        text = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+) kB", text).group(1)) / 1000

    def threads(self):
        return len(os.listdir(f"/proc/{self.process.pid}/task"))

    def close(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(PATIENCE)


class Page:
    """A page of it, open in the browser."""

    def __init__(self, browser, address, width=1280, scheme="light", downloads=None):
        self.browser = browser
        self.target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.ask("Target.attachToTarget", targetId=self.target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network", "Accessibility"]:
            self.ask(f"{domain}.enable")
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        if downloads:
            browser.ask("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(downloads), eventsEnabled=True)
        self.width, self.address, self.faults = width, address, []
        self.ask("Page.addScriptToEvaluateOnNewDocument", source=LISTENER)
        self.open(address)

    def ask(self, method, **params):
        return self.browser.ask(method, self.session, **params)

    def open(self, address):
        # By way of an empty page: an address that differs in its fragment alone is not loaded again.
        for url in ["about:blank", address]:
            self.faults += self.messages()
            self.browser.events = [e for e in self.browser.events if e.get("sessionId") != self.session]
            self.ask("Page.navigate", url=url)
            self.browser.wait("Page.loadEventFired", self.session)
        self.known()

    def js(self, expression):
        """The value of an expression, awaited."""
        found = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in found:
            sys.exit(f"{expression}: {found['exceptionDetails'].get('exception', {}).get('description', found)}")
        return found["result"].get("value")

    def until(self, expression, patience=PATIENCE):
        """Waits until an expression is true, and gives its value."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            if value := self.js(expression):
                return value
            time.sleep(0.05)
        sys.exit(f"this did not become true: {expression}")

    def known(self):
        """Waits until the page shows all there is to know about the place where it stands."""
        self.until("window.heard && heard.known && heard.known === heard.asked")

    def mouse(self, kind, x, y, buttons=1, clicks=1):
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=clicks)

    def middle(self, selector):
        return self.js(
            f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{ block: 'center' }});"
            " const b = e.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2, b.left, b.width]; })()"
        )

    def click(self, selector, clicks=1):
        x, y, *_ = self.middle(selector)
        for count in range(1, clicks + 1):
            self.mouse("mousePressed", x, y, clicks=count)
            self.mouse("mouseReleased", x, y, 0, clicks=count)

    def drag(self, selector, shares, share_now):
        """Drags over an element from one share of its width to others."""
        _, y, left, width = self.middle(selector)
        self.mouse("mousePressed", left + share_now * width, y)
        for share in shares:
            self.mouse("mouseMoved", left + share * width, y)
        self.mouse("mouseReleased", left + shares[-1] * width, y, 0)

    def type(self, selector, text):
        self.click(selector, clicks=3)
        self.ask("Input.insertText", text=text)
        self.key("Enter")

    def key(self, key):
        text = {"text": "\r"} if key == "Enter" else {}
        code = {"Enter": 13, "ArrowRight": 39, "ArrowLeft": 37, "Tab": 9, "Escape": 27}[key]
        self.ask("Input.dispatchKeyEvent", type="keyDown", key=key, code=key, windowsVirtualKeyCode=code, **text)
        self.ask("Input.dispatchKeyEvent", type="keyUp", key=key, code=key, windowsVirtualKeyCode=code)

    def value(self, name):
        return float(self.js(f"document.getElementById('number-{name}').value"))

    def text(self, selector):
        return self.js(f"document.querySelector({json.dumps(selector)}).textContent")

    def messages(self):
        """What the page said that it should not."""
        mine = [e for e in self.browser.events if e.get("sessionId") == self.session]
        words = [w for e in mine if (w := said(e))]
        own = tuple(f"request to {place}" for place in [self.address.split("#")[0], "about:"])
        return self.faults + [w for w in words if not w.startswith(own)]

    def shot(self, path):
        height = self.js("document.documentElement.scrollHeight")
        clip = {"x": 0, "y": 0, "width": self.width, "height": height, "scale": 1}
        data = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True, clip=clip)["data"]
        path.write_bytes(base64.b64decode(data))

    def close(self):
        self.browser.ask("Target.closeTarget", targetId=self.target)


LISTENER = """window.heard = { asked: 0, painted: 0, known: 0, followed: 0 };
for (const name of ["asked", "painted", "known", "followed"]) document.addEventListener(name, ({ detail }) => { heard[name] = detail; });
window.sockets = [];
window.WebSocket = class extends WebSocket { constructor(...words) { super(...words); sockets.push(this); } };
"""


def opened():
    """A browser that ends with this program, however that ends."""
    browser = Browser()
    atexit.register(browser.process.kill)
    return browser


class Checks:
    def __init__(self):
        self.count, self.bad = 0, 0

    def that(self, what, holds, more=""):
        self.count += 1
        self.bad += not holds
        print(f"{'holds' if holds else 'FAULT'}  {what}{'' if holds else f': {more}'}", flush=True)


def family(pid):
    """A process and all that it started."""
    parents = {}
    for place in Path("/proc").glob("[0-9]*/stat"):
        try:
            parents.setdefault(int(place.read_text().rpartition(")")[2].split()[1]), []).append(int(place.parent.name))
        except OSError:
            pass  # it has ended
    found = [pid]
    for one in found:
        found += parents.get(one, [])
    return found


def asleep(pids, seconds):
    """Stops processes for some time, as a laptop does whose lid is closed."""
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)
    time.sleep(seconds)
    for pid in pids:
        os.kill(pid, signal.SIGCONT)


def python_command(lines):
    """The command line that makes the run of some lines of Python: what they call, and with what."""
    calls = {ast.unparse(call.func).split(".")[-1]: call for call in ast.walk(ast.parse(lines)) if isinstance(call, ast.Call)}
    assert {"from_study", "simulate"} <= set(calls), lines
    at = calls["at"].keywords if "at" in calls else []
    turned = [f" --set {word.arg}={ast.literal_eval(word.value)}" for word in at]
    return f"retune simulate {ast.literal_eval(calls['from_study'].args[0])}{''.join(turned)}"


def simulated(program, words):
    """What `retune simulate` prints for the command line that the page gives."""
    command = words.split("  #")[0].split()
    assert command[0] == "retune"
    return subprocess.run([program, *command[1:]], cwd=ROOT, capture_output=True, text=True, check=True).stdout


def try_it(program, shots):
    checks, browser, explorer = Checks(), opened(), Explorer(program)
    downloads = Path(tempfile.mkdtemp())
    page = Page(browser, explorer.address, downloads=downloads)

    def written(what):
        page.js("document.querySelector('dialog').close(); document.querySelector('dialog textarea').value = ''")
        page.js(f"document.querySelector('[data-write={what}]').click()")
        return page.until("document.querySelector('dialog textarea').value")

    def saved_text(file):
        """The text of a file that the page saves; a browser makes the file first and fills it then."""
        end = time.monotonic() + PATIENCE
        while not ((downloads / file).is_file() and (downloads / file).stat().st_size) and time.monotonic() < end:
            browser.message(time.monotonic() + 0.1)
        return (downloads / file).read_text() if (downloads / file).is_file() else ""

    def same(name):
        page.known()
        words = written("command")
        ours, theirs = page.text("#text").strip(), simulated(program, words).strip()
        checks.that(f"{name}: the page's figures are those of `{words}`", ours == theirs, f"{ours}\n{theirs}")
        page.js("document.querySelector('dialog').close()")

    hero = lambda: page.text(".hero .number")
    checks.that("the tuned damper's worst is that of its results", hero().startswith("225.8 J"), hero())
    same("as opened")

    share = "(s => s.value / s.max)(document.getElementById('slider-k2'))"
    before = page.value("k2")
    page.drag("#slider-k2", [0.8, 0.6, 0.5, 0.45], page.js(share))
    checks.that("a dragged slider turns its number", page.value("k2") < before, page.value("k2"))
    same("dragged")
    page.drag("#response .u-over", [0.4, 0.3, 0.25], 0.5)
    checks.that("the cursor of the response is dragged", abs(page.value("omega") - 5.75) < 0.05, page.value("omega"))
    same("another frequency")
    page.type("#number-c2", "120.5")
    checks.that("a typed number is taken", page.value("c2") == 120.5)
    same("typed")
    address = page.until("location.hash.includes('c2=120.5') && location.href")
    state = page.text("#text")
    page.type("#number-D", "-1")
    problem = page.until("!document.getElementById('problem').hidden && document.getElementById('problem').textContent")
    checks.that("a number out of range is refused with its field", problem.startswith("D: -1 is not allowed here"), problem)
    marked = page.js("document.getElementById('number-D').getAttribute('aria-invalid')")
    checks.that("and marked", marked == "true", marked)
    page.click("#slider-D", clicks=2)
    page.until("document.getElementById('problem').hidden && document.getElementById('number-D').value < 0.1")
    checks.that("a double click brings the study's value back", abs(page.value("D") - 0.02885) < 1e-4, page.value("D"))

    page.open(address)
    checks.that("a reload from the address shows the same", page.text("#text") == state)
    page.js("document.getElementById('slider-k2').focus()")
    page.key("ArrowRight")
    page.known()
    checks.that("the arrow keys turn a slider", page.text("#text") != state)

    page.click("#pin-A")
    page.until("!!document.querySelector('#figures th.a')")
    page.click("#dampers label:nth-of-type(2)")
    page.known()
    checks.that("a TMD has no walls", not page.js("document.getElementById('number-D')"))
    checks.that("a pinned design is beside it", "A, worst" in page.text("#figures"), page.text("#figures"))
    checks.that("the pinned curve is drawn", " A " in page.text("#response-key"), page.text("#response-key"))
    page.click("#dampers label:nth-of-type(1)")
    page.known()
    none = page.text(".hero .number")
    checks.that("without a damper there is the structure alone", none.startswith("1568 J"), none)
    page.click("#dampers label:nth-of-type(3)")
    page.known()

    for file, text in [("ssvi-explored.json", "study"), ("ssvi-response.csv", "curves"), ("ssvi-motion.csv", "motion")]:
        page.js(f"document.querySelector('[data-write={text}]').click()")
        checks.that(f"{file} is saved", saved_text(file))
    saved = subprocess.run([program, "simulate", downloads / "ssvi-explored.json"], capture_output=True, text=True, check=True).stdout
    numbers = lambda text: text.strip().split("\n")[1:]  # the first line names the study
    checks.that("the saved study gives the page's figures", numbers(saved) == numbers(page.text("#text")), saved)
    trajectory = downloads / "check.csv"
    subprocess.run([program, "simulate", downloads / "ssvi-explored.json", "--trajectory", trajectory], check=True, capture_output=True)
    checks.that("the saved motion is that of `--trajectory`", trajectory.read_bytes() == (downloads / "ssvi-motion.csv").read_bytes())
    for what, begin in [("picture", "ssvi-motion.svg"), ("response", "ssvi-response.svg")]:
        page.js(f"document.querySelector('[data-write={what}]').click()")
        checks.that(f"{begin} is a figure", saved_text(begin).startswith("<svg"))
    checks.that("that of the response has the pinned design", ">A<" in (downloads / "ssvi-response.svg").read_text())
    words = written("command")
    page.js("document.querySelector('dialog').close(); document.querySelector('[data-write=json]').click()")
    checks.that("the saved run is what `--json` prints", saved_text("ssvi-run.json") == simulated(program, words + " --json"), words)
    page.js("(e => { e.value = 'stroke'; e.dispatchEvent(new Event('change')); })(document.getElementById('quantity'))")
    page.known()
    explained = page.text("#response-part")
    checks.that("curves of another quantity say what they are of", explained == "The largest deflection of the damper's spring, from rest on.", explained)
    checks.that("there is none without a damper", "no damper" not in page.text("#response-key"), page.text("#response-key"))
    page.js("document.querySelector('[data-write=report]').click()")
    report = saved_text("ssvi-explored.html")
    checks.that("the report has the page's figures and its curves", "stroke over frequency" in report and page.text("#text").strip().split("\n")[-1] in report)
    faults = look(browser, downloads / "ssvi-explored.html", 390, "dark", shots)
    checks.that("and nothing of it is beyond a narrow window", not faults, faults)
    page.js("(e => { e.value = 'E1max'; e.dispatchEvent(new Event('change')); })(document.getElementById('quantity'))")
    page.known()
    lines = written("python")
    ours, theirs = page.text("#text").strip(), simulated(program, python_command(lines)).strip()
    checks.that("the lines of Python name the run that the page shows", ours == theirs, f"{lines}\n{theirs}")
    if Path(PYTHON).exists():
        run = subprocess.run([PYTHON, "-c", lines + '\nprint(run.maxima["E1max"])'], cwd=ROOT, capture_output=True, text=True)
        expected = json.loads(simulated(program, python_command(lines) + " --json"))["E1max"]
        made = run.returncode == 0 and float(run.stdout.strip().split("\n")[-1]) == expected
        checks.that("and make it, to the last bit", made, f"{expected} {run.stdout}{run.stderr}")
    page.js("document.querySelector('dialog').close()")

    other = Page(browser, explorer.address)
    other.drag("#slider-k2", [0.9, 0.7], other.js(share))
    other.known()
    other.close()
    page.type("#number-k2", "333")
    page.known()
    checks.that("two pages at once, one of which vanishes", page.value("k2") == 333 and "E1max" in page.text("#text"))
    checks.that("no message on the console", not page.messages(), page.messages())
    named = page.ask("Accessibility.getFullAXTree")["nodes"]
    roles = {"button", "slider", "textbox", "radio", "combobox", "img", "image"}
    nameless = [n["role"]["value"] for n in named if not n.get("ignored") and n["role"]["value"] in roles and not n.get("name", {}).get("value")]
    count = sum(n.get("role", {}).get("value") == "slider" for n in named)
    checks.that(f"every control has a name, {count} sliders", not nameless and count >= 10, nameless)
    page.close()

    for width in WIDTHS:
        for scheme in ["light", "dark"]:
            shown = Page(browser, explorer.address, width, scheme)
            shown.click("#pin-A")
            shown.until("!!document.querySelector('#figures th.a')")
            seen = shown.js(OVERFLOW)
            faults = shown.messages() + seen["beyond"] + ([f"{seen['over']} px too wide"] if seen["over"] > 0 else [])
            checks.that(f"{width} px, {scheme}: no message, nothing beyond the window", not faults, faults)
            if shots:
                shown.shot(shots / f"explore-{width}-{scheme}.png")
            shown.close()
    symbols(browser, explorer, checks, shots)
    own_structure(program, browser, checks, shots)
    moved_by(program, browser, checks, shots)
    tune(program, browser, checks)
    follow_motions(program, browser, checks, shots)
    sleep(browser, explorer, checks)
    browser.close()
    explorer.close()
    checks.that("Ctrl-C ends it", explorer.process.returncode in (-signal.SIGINT, 130), explorer.process.returncode)
    print(f"{checks.count} checks, {checks.bad} faults")
    return 1 if checks.bad else 0


def symbols(browser, explorer, checks, shots):
    """Every symbol explains itself on hover, on focus and after a tap; a slider says that it stands at its end."""
    page = Page(browser, explorer.address)
    page.known()
    note = "document.getElementById('help').hidden ? '' : document.getElementById('help').textContent"
    symbol = ".control:has(#slider-k2) b"
    x, y, *_ = page.middle(symbol)
    page.mouse("mouseMoved", x, y, 0)
    said = page.js(note)
    checks.that("a symbol explains itself under the mouse", said.startswith("k2: stiffness of the damper's spring.") and "N/m" in said, said)
    box = page.js("(() => { const b = document.getElementById('help').getBoundingClientRect(); return [b.left, b.right - innerWidth, b.top, b.bottom - innerHeight]; })()")
    checks.that("within the window", box[0] >= 0 and box[1] <= 0 and box[2] >= 0 and box[3] <= 0, box)
    page.mouse("mouseMoved", 5, 5, 0)
    checks.that("and no longer when it has left", page.js(note) == "")
    page.js("document.querySelector('#figures th[scope=row] [data-help]').focus()")
    checks.that("one that has the focus, too", page.js(note).startswith("E1max: ") and len(page.js(note)) > 15, page.js(note))
    page.key("Escape")
    checks.that("until Escape", page.js(note) == "")
    nameless = page.js("[...document.querySelectorAll('.control b, #figures tr + tr th[scope=row] span')].filter((e) => !e.dataset.help).map((e) => e.textContent)")
    checks.that("no symbol is without help", not nameless, nameless)
    page.type("#number-k2", page.js("(() => { const s = document.getElementById('slider-k2'); s.value = s.max; s.dispatchEvent(new Event('input')); return document.getElementById('number-k2').value; })()"))
    page.known()
    checks.that("a slider at its bound says so", "study allows" in page.text(".control:has(#slider-k2) .end"), page.text(".control:has(#slider-k2) .end"))
    page.js("(() => { const s = document.getElementById('slider-m1'); s.value = s.min; s.dispatchEvent(new Event('input')); })()")
    checks.that("and one at its end", "lower end" in page.text(".control:has(#slider-m1) .end"), page.text(".control:has(#slider-m1) .end"))
    heights = page.js("(() => { const s = document.getElementById('slider-m1'), row = s.closest('.control'), end = row.offsetHeight; s.value = 500; s.dispatchEvent(new Event('input')); return [end, row.offsetHeight]; })()")
    checks.that("which does not move when it leaves it", heights[0] == heights[1], heights)
    page.close()

    phone = Page(browser, explorer.address, 390)
    phone.known()
    phone.ask("Emulation.setTouchEmulationEnabled", enabled=True)
    x, y, *_ = phone.middle(symbol)
    for kind, points in [("touchStart", [{"x": x, "y": y}]), ("touchEnd", [])]:
        phone.ask("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    phone.until(f"({note}).startsWith('k2')")
    checks.that("a symbol explains itself after a tap", True)
    if shots:
        phone.shot(shots / "explore-help-390.png")
    phone.close()


def own_structure(program, browser, checks, shots):
    """A structure of one's own, typed with units; without a study its form stands first."""
    explorer = Explorer(program, None)
    page = Page(browser, explorer.address)
    form = "document.getElementById('own')"
    checks.that("without a study the form is open", page.js(f"{form}.open"))
    fields = {"m1": "40 t", "f1": "2 Hz", "zeta": "0.5 %", "size": "280 kg", "band": "1.8 Hz .. 2.2 Hz", "mass": "2 %"}
    put = lambda name, text: page.js(f"{form}.querySelector('[name={name}]').value = {json.dumps(text)}")
    send = lambda: page.click("#own button")
    for name, text in fields.items():
        put(name, text)
    send()
    page.until("!document.getElementById('own-problem').hidden")
    words = page.text("#own-problem")
    checks.that("a wrong unit is refused with its field", words.startswith('force: "280 kg" is not a number in N'), words)
    checks.that("and marked", page.js(f"{form}.querySelector('[name=size]').getAttribute('aria-invalid')") == "true")
    put("size", "280 N")
    send()
    page.until("document.getElementById('study').textContent === 'own'")
    page.known()
    hero = lambda: page.text(".hero .number")
    checks.that("Den Hartog's TMD has the energy that `retune design` tells of it", hero().startswith("0.5676 J"), hero())
    checks.that("and the form makes room", not page.js(f"{form}.open") and page.js("document.getElementById('own-problem').hidden"))
    page.type("#number-k2", "130 kN/m")
    page.known()
    checks.that("a number typed with its unit is taken", page.value("k2") == 130_000, page.value("k2"))
    page.type("#number-k2", "130 kN")
    page.until("!document.getElementById('problem').hidden")
    words = page.text("#problem")
    checks.that("another unit is refused with those that are there", words.startswith('k2: "130 kN" is not a number, alone or in N/m, kN/m'), words)
    before = page.text("#text")
    page.type("#number-k2", "130000")
    # The address follows a moment after what it tells of.
    page.open(page.until("location.hash.includes('k2=130000&') && location.hash.includes('own=') && location.href"))
    checks.that("a reload from the address has the structure", page.text("#text") == before and page.text("#study") == "own", page.text("#study"))
    page.js(f"{form}.open = true")
    put("limits", "x1max = 0.4 kN")
    send()
    page.until("!document.getElementById('own-problem').hidden")
    words = page.text("#own-problem")
    checks.that("a limit in a wrong unit is refused", "x1max" in words and "0.4 kN" in words, words)
    put("limits", "x1max = 0.4 mm, stroke = 15 mm")
    send()
    page.until("document.getElementById('quantity').textContent.includes('x1max, limited')")
    page.known()
    checks.that("sliders have the numbers of the structure", page.value("m2") == 800 and page.value("k1") > 6e6, page.value("k1"))
    page.js("(e => { e.value = 'x1max'; e.dispatchEvent(new Event('change')); })(document.getElementById('quantity'))")
    page.known()
    words = page.text("#response-part")
    checks.that("a limit is told with what it covers", words.endswith("The study's limit: 0.0004 m from 25 s on."), words)
    page.js("document.querySelector('[name=damper][value=ssvi]').click()")
    page.known()
    checks.that("its SSVI NES has walls", page.value("D") > 0 and "contacts" in page.text("#text"), page.text("#text"))
    checks.that("no message on the console, with a structure of one's own", not page.messages(), page.messages())
    page.close()
    for width in WIDTHS:
        page = Page(browser, explorer.address, width=width)
        seen = page.js(OVERFLOW)
        checks.that(f"{width} px: the form is within the window", not seen["beyond"] and seen["over"] <= 0, seen)
        if shots:
            page.shot(shots / f"own-{width}.png")
        page.close()
    explorer.close()


def moved_by(program, browser, checks, shots):
    """A pulse typed with its units, and a record from a file, in the place of the study's force; a study that has a record."""
    explorer = Explorer(program)
    page = Page(browser, explorer.address, downloads=(downloads := Path(tempfile.mkdtemp())))
    form = "document.querySelector('#forcing form')"
    put = lambda name, text: page.js(f"(e => {{ e.value = {json.dumps(text)}; e.dispatchEvent(new Event('change')); }})({form}.elements.{name})")
    page.js("document.getElementById('forcing').open = true")
    put("kind", "half sine")
    put("peak", "10 kg")
    put("duration", "100 ms")
    page.click("#forcing button")
    words = page.until("document.querySelector('#forcing .wrong').textContent")
    checks.that("a pulse in a wrong unit is refused with those that are there", "kg" in words and "N, kN" in words, words)
    put("peak", "10 kN")
    page.click("#forcing button")
    page.until("document.getElementById('frequency').hidden")
    page.known()
    charts = page.js("document.querySelectorAll('#series .chart').length")
    checks.that("the force is drawn under the motion", charts == 5, charts)
    checks.that("a pulse has no slider of a frequency", not page.js("document.getElementById('number-omega')"))
    state, address = page.text("#text"), page.until("location.hash.includes('forcing=') && location.href")
    page.open(address)
    checks.that("a reload from the address has the pulse", page.text("#text") == state)
    page.js("document.getElementById('forcing').open = true")
    put("kind", "record")
    put("of", "base acceleration")
    root = page.ask("DOM.getDocument")["root"]["nodeId"]
    node = page.ask("DOM.querySelector", nodeId=root, selector="#forcing [name=file]")["nodeId"]
    page.ask("DOM.setFileInputFiles", nodeId=node, files=[str(ROOT / "studies/records/quake.csv")])
    page.click("#forcing button")
    page.until("document.getElementById('moved').textContent === 'quake.csv: acceleration of the base'")
    page.known()
    page.js("document.querySelector('[data-write=study]').click()")
    file = downloads / "ssvi-explored.json"
    end = time.monotonic() + PATIENCE
    while not (file.is_file() and file.stat().st_size) and time.monotonic() < end:
        browser.message(time.monotonic() + 0.1)
    run = subprocess.run([program, "simulate", file], capture_output=True, text=True, check=True).stdout
    numbers = lambda text: text.strip().split("\n")[1:]
    checks.that("the saved study has the record in it and gives the page's figures", numbers(run) == numbers(page.text("#text")), run)
    seen = page.js(OVERFLOW)
    checks.that("nothing of it is beyond the window", not seen["beyond"] and seen["over"] <= 0, seen)
    if shots:
        page.shot(shots / "explore-record.png")
    page.js("document.getElementById('forcing').open = true")
    put("kind", "")
    page.click("#forcing button")
    page.until("!document.getElementById('frequency').hidden")
    page.known()
    checks.that("and back to the study's force", page.text(".hero .number").startswith("225.8 J"), page.text(".hero .number"))
    checks.that("no message on the console, with a pulse and a record", not page.messages(), page.messages())
    page.close()
    explorer.close()
    explorer = Explorer(program, "studies/quake.json")
    page = Page(browser, explorer.address)
    theirs = simulated(program, "retune simulate studies/quake.json").strip()
    checks.that("a study with a record opens with its figures", page.text("#text").strip() == theirs, page.text("#text"))
    checks.that("no message on the console, with its record", not page.messages(), page.messages())
    page.close()
    explorer.close()


def follow_motions(program, browser, checks, shots):
    """The branches: found, drawn, kept while only the frequency is turned, given up when the design is."""
    explorer = Explorer(program, ISOLA)
    page = Page(browser, explorer.address)
    heroes = "document.querySelectorAll('.hero')"
    found = f"{heroes}.length > 3 && {heroes}[3].innerText"
    checks.that("no other motions are looked for unasked", page.js(f"{heroes}.length") == 3)
    page.click("#follow")
    words = page.until(found)
    motions = [branch["largest_stable"] for branch in json.loads((ROOT / BRANCHES).read_text())["branches"]]
    most = max((motion for motion in motions if motion), key=lambda motion: motion["E1max"])
    expected = [f"{most['E1max']:.4g} J", f"{most['value']:.4g} rad/s", "from other starts"]
    checks.that("the largest of all motions is that of `retune branches`", all(word in words for word in expected), f"{expected} {words}")
    checks.that("bifurcations are marked", "fold" in page.text("#following"), page.text("#following"))
    # Pixels of the colour of branches well above the curve from rest: the isola.
    purple = """(() => { const u = document.querySelector('#response canvas'), c = document.createElement('canvas'); [c.width, c.height] = [u.width, u.height];
        const x = c.getContext('2d', { willReadFrequently: true }); x.drawImage(u, 0, 0); const b = x.getImageData(0, 0, u.width, u.height / 2).data;
        const [r, g, l] = getComputedStyle(document.documentElement).getPropertyValue('--purple').match(/[0-9A-F]{2}/gi).map((x) => parseInt(x, 16));
        let n = 0; for (let i = 0; i < b.length; i += 4) n += Math.abs(b[i] - r) + Math.abs(b[i + 1] - g) + Math.abs(b[i + 2] - l) < 12 && b[i + 3] > 200;
        return n; })()"""
    page.type("#number-P", "1000")  # so that the isola is high
    page.known()
    page.until(found)
    drawn = page.js(purple)
    checks.that("they are drawn", drawn > 20, drawn)
    page.drag("#response .u-over", [0.4, 0.3], 0.5)
    page.known()
    checks.that("they stay while the frequency is turned", page.js(found), page.text("#following"))
    seen = page.js(OVERFLOW)
    checks.that("nothing of them is beyond the window", not seen["beyond"] and seen["over"] <= 0, seen)
    line = page.js("(r => r.left + r.width / 2)(document.querySelector('.handle').getBoundingClientRect())")
    place = page.js("(r => r.left + (r.width * (document.getElementById('number-omega').value - 5)) / 3)(document.querySelector('#response .u-over').getBoundingClientRect())")
    checks.that("the cursor stands at the frequency", abs(line - place) < 2, f"{line} {place}")
    if shots:
        page.shot(shots / "explore-branches.png")
    address = page.until("location.hash.includes('omega=5.9&') && location.href")
    page.click("#follow")
    checks.that("they are hidden", page.js(f"{heroes}.length") == 3 and page.js(purple) == 0, page.js(purple))
    page.open(address)
    checks.that("a reload from the address has them", page.until(found))

    # Another design while they are looked for: it is answered at once, and the search begins anew.
    page.type("#number-k2", "400")
    page.until("document.getElementById('following').textContent.startsWith('Looking')")
    begun = time.monotonic()
    page.drag("#slider-c2", [0.9, 0.8, 0.7], 0.6)
    page.known()
    took = time.monotonic() - begun
    checks.that("a slider is answered at once while they are looked for", took < 3, f"{took:.1f} s")
    words = page.until(found)
    checks.that("and then they are found", page.js("heard.followed === heard.asked"), words)
    checks.that("no message on the console, with branches", not page.messages(), page.messages())
    checks.that("nothing is said of runs from rest", page.js("document.getElementById('from-rest').hidden"))
    page.close()
    explorer.close()

    study = json.loads((ROOT / ISOLA).read_text())
    study["optimize"]["objective"]["response"] = "motions"
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "motions.json"
        path.write_text(json.dumps({key: value for key, value in study.items() if key != "$schema"}))
        explorer = Explorer(program, path)
        page = Page(browser, explorer.address)
        checks.that("a study of all motions is told that curves are from rest", not page.js("document.getElementById('from-rest').hidden"))
        page.close()
        explorer.close()


def tune(program, browser, checks):
    """A tuning is stopped. Its study has so many frequencies that it takes far longer than a slow browser needs to stop it."""
    study = json.loads((ROOT / "studies/ssvi.json").read_text())
    study["optimize"]["objective"]["omega"]["samples"] = 151
    study["optimize"]["refine"] |= {"TolX": 1e-12, "TolFun": 1e-12}
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "long.json"
        path.write_text(json.dumps({key: value for key, value in study.items() if key != "$schema"}))
        explorer = Explorer(program, path)
        page = Page(browser, explorer.address)
        page.known()
        page.click("#tune")
        page.until("document.getElementById('log').textContent.split('\\n').length > 6")
        page.click("#stop")
        ended = page.until("document.getElementById('tuned').textContent")
        page.known()
        log = page.text("#log").strip().split("\n")
        checks.that("a tuning stops when it is told to", ended.startswith("Stopped; the best design so far is kept: "), ended)
        best = [float(re.findall(r"\d\.\d{6}E[+-]\d{3}", line)[-1]) for line in log[1:]]
        kept = float(re.search(r": ([\d.]+) J", ended).group(1))
        checks.that("and keeps the best of its log", abs(kept - min(best)) < 1e-3, f"{kept} {best}")
        shown = float(page.text(".hero .number").split()[0])
        checks.that("and the page stands there", abs(shown - kept) < 0.06, f"{shown} {kept}")
        checks.that("no message on the console while it tunes", not page.messages(), page.messages())
        page.close()
        explorer.close()


def sleep(browser, explorer, checks):
    """A laptop that sleeps: first the server alone, then the page, longer than the server waits for it."""
    page = Page(browser, explorer.address)
    page.click("#follow")
    threads = explorer.threads()
    page.type("#number-k2", "320")
    asleep([explorer.process.pid], 3)
    page.type("#number-k2", "321")
    page.known()
    checks.that("the server slept: the page goes on", page.value("k2") == 321 and "E1max" in page.text("#text"))
    page.click("#tune")
    page.until("document.getElementById('log').textContent.split('\\n').length > 3")
    asleep(family(browser.process.pid), 14)
    page.type("#number-k2", "322")
    page.until("heard.known === heard.asked && !document.body.classList.contains('lost')")
    page.js("document.getElementById('stop').disabled || document.getElementById('stop').click()")
    page.until("document.getElementById('stop').disabled")
    page.type("#number-k2", "323")
    page.known()
    checks.that("the page slept: it goes on", page.value("k2") == 323 and "E1max" in page.text("#text"))
    before = page.text("#text")
    page.js("sockets.at(-1).close()")
    page.until("document.body.classList.contains('lost')")
    page.until("sockets.length === 2 && !document.body.classList.contains('lost')")
    page.type("#number-k2", "324")
    page.known()
    checks.that("a lost connection is found again", page.js("sockets.length") == 2 and page.text("#text") != before)
    checks.that("no message on the console after sleep", not page.messages(), page.messages())
    checks.that("no thread is left over", explorer.threads() <= threads, f"{threads} {explorer.threads()}")
    # What is lost is lost in every round; a thread's own heap, and what is kept for the next run, come once.
    memory = [explorer.memory()]
    for k2 in range(325, 329):
        page.type("#number-k2", str(k2))
        page.known()
        lines = "document.getElementById('log').textContent.split('\\n').length"
        page.click("#tune")
        page.until(f"!document.getElementById('stop').disabled && {lines} > 3")
        page.click("#stop")
        page.until("document.getElementById('stop').disabled")
        memory.append(explorer.memory())
    grown = min(after - before for before, after in zip(memory, memory[1:]))
    checks.that("no memory is left over", grown < 0.5, f"at least {grown:.1f} MB a round")
    page.close()


# A slider that is turned again and again; the time from the event to the end of the frame that shows its time series.
DRAG = """(async (seconds, pause) => {
    const slider = document.getElementById("slider-c2");
    const times = [];
    let painted = null;
    document.addEventListener("painted", () => painted?.());
    const end = performance.now() + 1000 * seconds;
    for (let i = 0; performance.now() < end; i++) {
        await new Promise((r) => setTimeout(r, pause));
        const begun = performance.now();
        const seen = new Promise((r) => (painted = r));
        slider.value = 300 + 400 * (0.5 + 0.5 * Math.sin(i / 40));
        slider.dispatchEvent(new Event("input", { bubbles: true }));
        await seen;
        painted = null;
        // After the next frame: the message is handled once what was drawn is on its way to the screen.
        await new Promise(requestAnimationFrame);
        await new Promise((r) => { const c = new MessageChannel(); c.port1.onmessage = r; c.port2.postMessage(0); });
        times.push(performance.now() - begun);
    }
    return times;
})"""


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def bench(program, seconds):
    """Prints what is measured; to be kept in results/explore/bench.txt."""
    browser, explorer = opened(), Explorer(program)
    page = Page(browser, explorer.address)
    loads = page.js("performance.getEntriesByType('resource').concat(performance.getEntriesByType('navigation')).map((e) => [e.name, e.decodedBodySize])")
    size = sum(count for _, count in loads)
    print(
        f"`just lab bench-explore`: results/ssvi at 1280 px, headless Chromium and the server on {os.cpu_count()} cores,"
        f" priority {-os.getpriority(os.PRIO_PROCESS, 0)}; load of the machine before: {os.getloadavg()[0]:.1f}\n"
    )
    print(f"page with all that it loads: {size / 1000:.0f} kB in {len(loads)} files (target 300 kB): {met(size <= LARGEST_PAGE)}")
    times = page.js(f"{DRAG}(20, 16)")
    p50, p95 = statistics.median(times), quantile(times, 0.95)
    print(f"slider event to painted time series, {len(times)} events: median {p50:.1f} ms, p95 {p95:.1f} ms (target 33 ms): {met(p95 <= 33)}", flush=True)
    print(f"\n{seconds:.0f} s of dragging, memory of the server and of the page, MB:")
    rows = []
    steps = 10
    for step in range(steps + 1):
        if step:
            end = time.monotonic() + seconds / steps
            while (left := end - time.monotonic()) > 0:
                page.js(f"{DRAG}({min(left, 20)}, 4).then((times) => times.length)")
        page.ask("HeapProfiler.collectGarbage")
        heap = page.ask("Runtime.getHeapUsage")["usedSize"] / 1e6
        rows.append((step * seconds / steps, explorer.memory(), heap))
        print(f"  {rows[-1][0]:5.0f} s   server {rows[-1][1]:6.1f}   page {rows[-1][2]:6.1f}", flush=True)
    grown = [rows[-1][i] - rows[1][i] for i in (1, 2)]
    print(f"  from the first to the last: server {grown[0]:+.1f}, page {grown[1]:+.1f} (target flat: within 5 MB): {met(max(grown) <= 5)}")
    browser.close()
    explorer.close()
    return 0


# The tuned damper where it strikes once a period, beside the tuned TMD.
PICTURED = "#damper=ssvi&omega=5.9&A=damper=tmd;k2=600;c2=259.8"


def picture(program, file):
    """The picture of the tutorial: as it is at one moment, for the drawing does not move."""
    browser, explorer = opened(), Explorer(program)
    page = Page(browser, explorer.address + PICTURED)
    page.until("!!document.querySelector('#figures td.a')")
    page.js("document.querySelector('#response-key .A') && document.getElementById('pause').click()")
    page.shot(file)
    browser.close()
    explorer.close()
    return 0


def met(holds):
    return "met" if holds else "MISSED"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("retune", metavar="RETUNE", help="the program")
    parser.add_argument("--shots", type=Path, metavar="DIR", help="where pictures of the page go")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="write a picture of the page, and no more")
    parser.add_argument("--bench", type=float, nargs="?", const=600, metavar="SECONDS", help="measure, with so many seconds of dragging")
    args = parser.parse_args()
    program = str(Path(args.retune).resolve())
    if args.shots:
        args.shots.mkdir(parents=True, exist_ok=True)
    if args.picture:
        return picture(program, args.picture)
    return bench(program, args.bench) if args.bench else try_it(program, args.shots)


if __name__ == "__main__":
    sys.exit(main())
