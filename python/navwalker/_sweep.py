"""Sweeps: every design of a space or a list evaluated, in chunks that any machine can compute."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from navwalker import _native
from navwalker._constellation import Constellation, Path
from navwalker._progress import Tick, followed
from navwalker._results import Table

if TYPE_CHECKING:
    from navwalker._scenario import Scenario


class Stopped(Exception):
    """Why no more chunks are evaluated."""


class SweepError(_native.NavwalkerError):
    """A sweep that could not be finished, and what is missing; the same call goes on with the rest."""

    def __init__(self, message: str, missing: Iterable[int] = ()) -> None:
        super().__init__(message)
        self.missing = list(missing)

    def __reduce__(self) -> tuple[Any, ...]:
        return SweepError, (str(self), self.missing)


class Sweep:
    """A sweep in its directory, with one table of all metrics, as ``navwalker sweep`` writes it.

    >>> import navwalker as nw, tempfile
    >>> scenario = nw.Scenario("paper", time_step_s=1800, region_step_deg=20)
    >>> with tempfile.TemporaryDirectory() as place:
    ...     sweep = scenario.sweep(["delta:55:182/13/1@925", "star:90:182/13/1@925"], store=f"{place}/sweep")
    ...     sweep.designs, sweep.table()["pattern"].tolist()
    (2, ['delta', 'star'])
    """

    def __init__(self, directory: Path) -> None:
        self._directory = FilePath(directory)
        try:
            with open(self._directory / "index.json", encoding="utf-8") as file:
                self._index: dict[str, Any] = json.load(file)
        except (OSError, ValueError) as error:
            raise _native.FileError(f"{directory} holds no merged sweep: {error}") from None

    @property
    def directory(self) -> FilePath:
        """Where the sweep is kept."""
        return self._directory

    @property
    def path(self) -> FilePath:
        """The merged table, Parquet or CSV, for what reads files: ``polars.scan_parquet(sweep.path)``."""
        return self._directory / str(self._index["table"])

    @property
    def designs(self) -> int:
        """Number of designs, the rows of the table."""
        return int(self._index["designs"])

    @property
    def sha256(self) -> str:
        """SHA-256 of the merged table, the same wherever its chunks were computed."""
        return str(self._index["sha256"])

    @property
    def index(self) -> dict[str, Any]:
        """What ``index.json`` says: scenario, version, and the chunks with their SHA-256."""
        return dict(self._index)

    def table(self) -> Table:
        """The merged table in memory, a row for each design in the order of the space or the list."""
        return Table(_native.read_sweep(os.fspath(self._directory)))

    def __len__(self) -> int:
        return self.designs

    def __repr__(self) -> str:
        return f"<Sweep of {self.designs} designs in {str(self._directory)!r}>"


def sweep(
    scenario: Scenario,
    designs: Iterable[str | Constellation] | None,
    store: Path,
    executor: Any,
    options: dict[str, Any],
    progress: bool,
) -> Sweep:
    """Does the work of :meth:`Scenario.sweep`."""
    listed = None if designs is None else [_listed(one) for one in designs]
    if listed == []:
        raise _native.NavwalkerError("there is no design to sweep")
    place = os.path.abspath(os.fspath(store))
    native = _native.begin_sweep(scenario._engine, place, listed, **options)
    with followed(progress, "design") as tick:
        try:
            _evaluate(scenario, native, executor, tick)
        except Stopped as error:
            missing = [number + 1 for number in native.open()]
            raise SweepError(_unfinished(str(error), store, missing, native.chunks), missing) from error.__cause__
    native.merge()
    return Sweep(place)


def _evaluate(scenario: Scenario, native: _native.NativeSweep, executor: Any, tick: Tick | None) -> None:
    """Evaluates the chunks that are not there, here or by an executor."""
    numbers = native.open()
    done = native.designs - sum(native.size(number) for number in numbers)

    def put(number: int, result: bytes) -> None:
        nonlocal done
        native.put(number, result)
        done += native.size(number)
        if tick is not None:
            tick(done, native.designs, done, None)

    if executor is None:
        for number in numbers:
            put(number, _native.run_chunk(scenario._engine, native.chunk(number)[1]))
        return
    from navwalker import _engines

    _engines.evaluate(_engines.engine_of(executor, scenario, "chunk"), numbers, native.chunk, put)


def _listed(one: str | Constellation) -> tuple[str, str | None]:
    """A design of a list and its name, if it has one of its own."""
    if isinstance(one, str):
        return one, None
    if not isinstance(one, Constellation):
        raise _native.DesignError(f"a design is a notation or a Constellation, not {type(one).__name__}")
    if one.notation is None or one._native.has_files or one.out_of_service:
        raise _native.DesignError(f"{one.name}: a sweep is of designs; evaluate takes files and satellites out of service")
    return one.notation, None if one.name == one.notation else one.name


def _unfinished(why: str, store: Path, missing: list[int], chunks: int) -> str:
    """What stopped a sweep, and what is missing of it."""
    named = ", ".join(map(str, missing[:10])) + (", …" if len(missing) > 10 else "")
    rest = f"{len(missing)} of {chunks} chunks are missing in {os.fspath(store)} ({named}); the same call goes on with these"
    return f"{why}\n{rest}"
