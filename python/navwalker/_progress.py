"""How far work is, as a line of plain text on stderr."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

Tick = Callable[[int, int, int, float | None], None]

# Between two lines where a line cannot be rewritten, seconds.
_BETWEEN_LINES_S = 10.0


class ProgressLine:
    """A line that a terminal and a notebook rewrite; a file gets a new one every ten seconds, and the last."""

    def __init__(self, what: str, stream: TextIO) -> None:
        self._what = what
        self._stream = stream
        self._rewrites = stream.isatty() or type(stream).__module__.startswith("ipykernel")
        self._began = self._written = time.monotonic()
        self._text = ""
        self._shown = ""

    def __call__(self, step: int, steps: int, evaluations: int, hypervolume: float | None) -> None:
        """Says how far the work is."""
        if steps == 0:
            return
        now = time.monotonic()
        parts = [f"{self._what} {step}/{steps}"]
        if evaluations != step:
            parts.append(f"{evaluations} evaluations")
        if hypervolume is not None:
            parts.append(f"hypervolume {hypervolume:.6g}")
        if 0 < step < steps:
            parts.append(f"ETA {_duration((now - self._began) * (steps - step) / step)}")
        self._text = ", ".join(parts)
        if self._rewrites:
            self._rewrite()
        elif now - self._written >= _BETWEEN_LINES_S:
            self._line()

    def close(self) -> None:
        """Ends the line."""
        if self._rewrites and self._shown:
            self._stream.write("\n")
        elif not self._rewrites:
            self._line()
        self._stream.flush()

    def _rewrite(self) -> None:
        if self._text != self._shown:
            self._stream.write("\r" + self._text.ljust(len(self._shown)))
            self._stream.flush()
            self._shown = self._text

    def _line(self) -> None:
        if self._text != self._shown:
            self._stream.write(f"{self._text}\n")
            self._stream.flush()
            self._shown, self._written = self._text, time.monotonic()


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


@contextmanager
def followed(progress: bool, what: str) -> Iterator[Tick | None]:
    """What the native part tells how far it is, if progress is wanted; ``what`` is the name of a step."""
    if not progress or sys.stderr is None:
        yield None
        return
    line = ProgressLine(what, sys.stderr)
    try:
        yield line
    finally:
        line.close()
