"""The examples run, and find what they say."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

EXAMPLES = Path(__file__).parent.parent / "examples"


@pytest.mark.parametrize("name", sorted(path.name for path in EXAMPLES.glob("*.py")))
def test_contract_an_example_runs(name: str, tmp_path: Path) -> None:
    environment = {**os.environ, "MPLBACKEND": "Agg", "RETUNE_STUDIES": str(ROOT / "studies")}
    command = [sys.executable, "-W", "error::DeprecationWarning:__main__", EXAMPLES / name]
    # The million points of the grid are for the bench; a test takes fewer.
    options = ["--points", "20"] if name == "dask_sweep.py" else []
    done = subprocess.run([*command, *options], capture_output=True, text=True, cwd=tmp_path, env=environment, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip(), "it says what it found"


def test_contract_the_notebook_says_what_it_says_now(tmp_path: Path) -> None:
    """Its outputs are committed; run again, its text is the same."""
    import nbformat
    from nbclient import NotebookClient

    file = EXAMPLES / "tutorial.ipynb"
    notebook = nbformat.read(file, as_version=4)
    said = [text_of(cell) for cell in notebook.cells]
    assert any(said), "it is committed with its outputs"
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert [text_of(cell) for cell in notebook.cells] == said


def text_of(cell: object) -> list[str]:
    outputs = getattr(cell, "outputs", [])
    texts = [output.get("text") or output.get("data", {}).get("text/plain", "") for output in outputs if output.get("name") != "stderr"]
    # A figure's plain text has its size in pixels, which fonts decide.
    return [text for text in texts if text and not text.startswith("<Figure")]
