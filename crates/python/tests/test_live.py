"""What a user sees and does while work goes on: Ctrl-C, and progress in a terminal and in a notebook."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, STUDIES

SETUP = """
import sys, time, numpy as np, retune as rt
structure = rt.Structure(m1=1000, c1=452, k1=3.95e4)
damper = rt.SSVI(60, k2=215, c2=232, D=0.06, C=0.36)
search = {"vary": ["k2", "c2"], "bounds": {"k2": (10, 600), "c2": (1, 1000)}}
# Half a minute of runs, each some milliseconds long; and one run of half a minute.
band = rt.Problem(structure, damper, P=800, band=(5, 8), samples=3001, window=(0, 4000), **search)
once = rt.Problem(structure, damper, P=800, omega=6.28, window=(0, 1e8), solver={"max_steps": 10**12}, **search)
"""


@pytest.mark.parametrize(
    "call",
    [
        "band(band.start)",
        "band.evaluate(band.start)",
        "band.gradient(band.start)",
        "band.batch([band.start])",
        "band.sweep(k1=[3e4, 4e4], objective=True)",
        "band.sweep(omega=np.linspace(5, 8, 20000))",
        "rt.certify(band)",
        "once(once.start)",
        "once.gradient(once.start)",
        "once.simulate(interval=1e3)",
    ],
)
def test_contract_ctrl_c_ends_whatever_takes_long(call: str) -> None:
    code = f"""{SETUP}
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    # The interpreter lives, and so does the package.
    small = band.at(T=100.0, t0=50.0)
    assert small.simulate(omega=6.0).maxima["E1max"] > 0
    print("stopped", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        assert process.poll() is None, "it takes long"
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        try:
            assert process.stdout.readline() == "stopped\n"
            assert time.monotonic() - begun < 1.5
            assert process.wait(timeout=30) == 0
        finally:
            process.kill()


SEARCH = """
import sys, json, retune as rt
study = json.load(open(sys.argv[1]))
study["optimize"] |= {
    "surf": {"k2": {"from": 100, "to": 600, "points": 20}, "c2": {"from": 50, "to": 300, "points": 20}},
    "vary": ["k2", "c2"], "bounds": {"k2": [10, 600], "c2": [1, 1000]},
    "objective": {"omega": {"from": 5, "to": 8, "samples": 9}}, "coarse": {}, "refine": {"starts": 1, "MaxFunEvals": 25},
}
del study["$schema"]
result = rt.optimize(rt.Problem.from_study(study), sys.argv[2])
"""


def in_terminal(command: list[str]) -> str:
    """What a process writes to a terminal."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    said = b""
    while True:
        try:
            more = os.read(ours, 4096)
        except OSError:  # the other end is closed
            break
        if not more:
            break
        said += more
    os.close(ours)
    assert process.wait(timeout=60) == 0, said.decode()
    return said.decode()


def test_contract_a_terminal_has_one_line_that_changes(tmp_path: Path) -> None:
    said = in_terminal([sys.executable, "-c", SEARCH, str(STUDIES / "ssvi.json"), str(tmp_path / "out")])
    counts = [int(done) for done in re.findall(r"\r\x1b\[Ksurf (\d+)/400  \d+/s", said)]
    assert len(counts) >= 3 and counts == sorted(counts) and counts[0] < counts[-1], "it is told again and again"
    assert re.search(r"\d+ s left", said)
    # What is left on the screen: of each line the part after the last time that it was cleared.
    screen = [line.rpartition("\r\x1b[K")[2] for line in said.replace("\r\n", "\n").split("\n")]
    assert not any("/400" in line for line in screen), "the line is cleared"
    assert any("E1max" in line for line in screen), "the answer stays"
    piped = subprocess.run(
        [sys.executable, "-c", SEARCH, STUDIES / "ssvi.json", tmp_path / "piped"], capture_output=True, text=True, check=True
    )
    assert piped.stdout == piped.stderr == "", "nothing where nobody watches"


def test_contract_a_notebook_has_one_output_that_changes(tmp_path: Path) -> None:
    import nbformat
    from nbclient import NotebookClient

    updates: list[str] = []

    class Watching(NotebookClient):
        def process_message(self, msg: Any, cell: Any, cell_index: int) -> Any:
            if msg["msg_type"] == "update_display_data":
                updates.append(msg["content"]["data"]["text/plain"])
            return super().process_message(msg, cell, cell_index)

    code = SEARCH.replace("sys.argv[1]", repr(str(ROOT / "studies" / "ssvi.json"))).replace("sys.argv[2]", repr(str(tmp_path / "out")))
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
    Watching(notebook, timeout=120).execute()
    counts = [int(line.split()[1].split("/")[0]) for line in updates if line.startswith("surf ")]
    assert len(counts) >= 3 and counts == sorted(counts), "it is told again and again"
    (line,) = (output for output in notebook.cells[0].outputs if output.output_type == "display_data")
    assert line.data["text/plain"] == "", "one output, empty at the end"
    (said,) = (output for output in notebook.cells[0].outputs if output.output_type == "stream")
    assert said.name == "stdout" and "E1max" in said.text
    assert len(notebook.cells[0].outputs) == 2
