"""The pipe as MATLAB users take it, with Octave in MATLAB's place."""

from __future__ import annotations

import shutil
import subprocess
from array import array
from pathlib import Path

import numpy as np
import pytest
from conftest import STUDIES

import retune as rt

def test_contract_the_lines_for_pyenv_are_python_as_matlab_says_it() -> None:
    """MATLAB gives a row of numbers as an `array.array`, and calls methods."""
    problem = rt.Problem.from_study(str(STUDIES / "ssvi.json"))
    row = array("d", [215, 232, 0.06, 0.36])
    assert problem.evaluate(row).value == problem([215, 232, 0.06, 0.36])
    batch = problem.batch(np.array([row, [250, 200, 0.05, 0.4]]))
    assert batch.get("E1max")[0] == problem.evaluate(row).value
    run = problem.simulate(**{"omega": 6.28})
    assert len(run.t) == len(run.x1) > 1000


MATLAB = Path(__file__).parent.parent / "examples" / "matlab"
octave = shutil.which("octave-cli")


def said(code: str) -> str:
    done = subprocess.run([str(octave), "--quiet", "--no-gui", "--eval", code], capture_output=True, text=True, cwd=MATLAB, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.skipif(octave is None, reason="there is no octave-cli here")
def test_contract_octave_gets_the_same_bits_over_the_pipe(program: Path) -> None:
    study = STUDIES / "tmd-free.json"
    X = np.array([[2083.081, 111.893], [600, 262], [-1, 5]])
    text = said(f"printf('%.17g\\n', retune_values('{study}', [2083.081 111.893; 600 262; -1 5], '{program}'))")
    values = [float(line) for line in text.split()]
    problem = rt.Problem.from_study(study)
    assert values[:2] == problem.batch(X).value[:2].tolist() and np.isnan(values[2])


@pytest.mark.skipif(octave is None, reason="there is no octave-cli here")
def test_contract_octave_tunes_over_the_pipe(program: Path) -> None:
    """Octave's fminsearch is another algorithm than MATLAB's, and ends near the same optimum."""
    text = said(f"tune_tmd('{STUDIES / 'tmd-free.json'}', '{program}');")
    value = float(text.split(" J")[0])
    assert value == pytest.approx(160.605, abs=0.5)
