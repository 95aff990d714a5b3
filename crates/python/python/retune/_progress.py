"""How far a job is: a line on a terminal, a line that changes in a notebook, nothing elsewhere."""

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
        self._begun = time.monotonic()
        self._display = _display() if show else None
        self._is_terminal = show and self._display is None and sys.stderr.isatty()
        self._is_open = False

    def __call__(self, kind: str, words: str, done: int, known: int, count: int) -> None:
        if kind in ("result", "warning"):
            self.lines.append(words)
            self._show("")
            if self._display is not None or self._is_terminal:
                print(words, file=sys.stderr)
        elif kind in ("progress", "finished"):
            rate = (done - known) / max(time.monotonic() - self._begun, 1e-3)
            self._show(f"{words} {done}/{count}  {rate:.0f}/s" if kind == "progress" else "")

    def _show(self, line: str) -> None:
        if self._display is not None:
            self._display.update({"text/plain": line}, raw=True)
        elif self._is_terminal and (line or self._is_open):
            print(f"\r\x1b[K{line}", end="", file=sys.stderr, flush=True)
            self._is_open = bool(line)


def _display() -> Any:
    """A line of a notebook, if this is one."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    from IPython.display import display

    return display({"text/plain": ""}, raw=True, display_id=True)
