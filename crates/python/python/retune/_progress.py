"""How far a job is: a line that changes, on a terminal and in a notebook; nothing elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

#: What a job calls: kind, words, and of a stage how many are done, known from before, and there are in all.
Tell = Callable[[str, str, int, int, int], None]


class Progress:
    """Shows what a job tells; its results and warnings stay in ``lines``."""

    def __init__(self, show: bool) -> None:
        self.lines: list[str] = []
        #: The stage, when it began, and what the line says.
        self._stage = ""
        self._begun = 0.0
        self._line = ""
        self._display = _display() if show else None
        self._is_terminal = show and self._display is None and sys.stderr.isatty()

    def __call__(self, kind: str, words: str, done: int, known: int, count: int) -> None:
        if kind in ("result", "warning"):
            self.lines.append(words)
            self._show("")
            if self._display is not None:
                print(words)  # what goes to standard error looks like an error in a notebook
            elif self._is_terminal:
                print(words, file=sys.stderr)
        elif kind == "progress":
            if words != self._stage:
                self._stage, self._begun = words, time.monotonic()
            # Values from the journal of an interrupted run take no time.
            rate = (done - known) / max(time.monotonic() - self._begun, 1e-3)
            left = f"  {(count - done) / rate:.0f} s left" if rate > 0 and count >= done else ""
            self._show(f"{words} {done}/{count}  {rate:.0f}/s{left}")
        elif kind == "finished":
            self._show("")

    def _show(self, line: str) -> None:
        if line == self._line:
            return
        self._line = line
        if self._display is not None:
            self._display.update({"text/plain": line}, raw=True)
        elif self._is_terminal:
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)


def _display() -> Any:
    """A line of a notebook, if this is one."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    from IPython.display import display

    return display({"text/plain": ""}, raw=True, display_id=True)
