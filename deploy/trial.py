"""What the trials of the scripts here share: a small study, the answer of a single process, and what must be the same.

Each line that a trial prints and that begins with "ok" was checked; the first that does not hold ends it with an error. They work
in the current directory.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
RETUNE = str(Path(sys.argv[1]).resolve())
SHARDS = 8
POINTS = 10  # along each of four axes: a share takes a second


def ok(words):
    print(f"ok: {words}", flush=True)


def study(k1=39500):
    """The paper's study with a grid of POINTS⁴ runs."""
    study = json.loads((HERE.parent / "studies" / "ssvi-resonance.json").read_text())
    study["scene"]["primary"]["k1"] = k1
    study["name"] = "cluster"
    study.pop("$schema", None)
    for axis in study["optimize"]["surf"].values():
        axis["points"] = POINTS
    return json.dumps(study)


def run(*arguments, expect=0):
    """What the program says, on both streams."""
    done = subprocess.run([RETUNE, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == expect, f"{arguments}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout, done.stderr.strip()


def single():
    """The results of a single process, in `whole`."""
    Path("study.json").write_text(study())
    begun = time.monotonic()
    run("optimize", "study.json", "--out", "whole", "--quiet")
    print(f"a grid of {POINTS ** 4} runs and its refinement, one process: {time.monotonic() - begun:.1f} s", flush=True)


def same(out):
    """That results have the bytes of the single process, in words."""
    found, expected = ({path.name: path.read_bytes() for path in Path(place).iterdir() if path.is_file()} for place in (out, "whole"))
    assert found.keys() == expected.keys(), (sorted(found), sorted(expected))
    for name, content in expected.items():
        assert found[name] == content, f"{out}/{name} has other bytes"
    return f"{len(expected)} files have the bytes of the single process"


def parts(out):
    return sorted(Path(out, "parts").glob("*.part"))


def tasks(out):
    """The processes that work on shares of this directory, by their command line, the last share first."""
    found = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                here = os.readlink(entry / "cwd") == os.getcwd()
            except OSError:
                continue
            if here and words[0] == RETUNE.encode() and b"--shard" in words and out.encode() in words:
                found[int(words[words.index(b"--shard") + 1].split(b"/")[0])] = int(entry.name)
    return [found[share] for share in sorted(found, reverse=True)]


def a_task(out, after, process=None):
    """The process that began last, once so many parts are there: it has not made its own yet."""
    found = []
    wait_until(lambda: len(parts(out)) >= after and found.extend(tasks(out)) or found, "a task to kill", process=process)
    return found[0]


def wait_until(condition, what, seconds=120, process=None):
    """Waits, but not for a process that has ended."""
    begun = time.monotonic()
    while not condition():
        assert process is None or process.poll() is None, process.stderr.read()
        assert time.monotonic() - begun < seconds, f"waited in vain for {what}"
        time.sleep(0.005)
