"""Results as text and as HTML."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


def number(value: object) -> str:
    """A number in the digits that matter, anything else as it is."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Rows as aligned columns."""
    lines = [list(head), *([number(cell) for cell in row] for row in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(head))]
    if not any(head):
        del lines[0]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines)


def page(head: Sequence[str], rows: Iterable[Sequence[object]], caption: str = "") -> str:
    """Rows as an HTML table."""

    def line(cells: Iterable[object], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(number(cell))}</{tag}>" for cell in cells) + "</tr>"

    top = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    body = "".join(line(row, "td") for row in rows)
    named = f"<thead>{line(head, 'th')}</thead>" if any(head) else ""
    return f"<table>{top}{named}<tbody>{body}</tbody></table>"


class Report(str):
    """A page of HTML as text; in a notebook it is shown in a frame."""

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self)}" style="width: 100%; height: 40em; border: 0" title="report"></iframe>'


def report(title: str, body: str) -> Report:
    """A page with a body of its own."""
    head = f'<head><meta charset="utf-8"><title>{html.escape(title)}</title></head>'
    return Report(f'<!doctype html><html lang="en">{head}<body style="font-family: sans-serif">{body}</body></html>')
