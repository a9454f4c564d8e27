"""One evaluation in tiles, each of some instants, that any machine can compute."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from navwalker import _native
from navwalker._engines import Executor, engine_of
from navwalker._engines import evaluate as by_engine
from navwalker._progress import followed
from navwalker._results import Metrics
from navwalker._sweep import Stopped

if TYPE_CHECKING:
    from navwalker._scenario import Scenario


def evaluate(
    scenario: Scenario, one: _native.NativeConstellation, tiles: int, executor: Executor | None, progress: bool
) -> Metrics:
    """The metrics of a design by tiles, which are in a temporary directory until they are merged."""
    if one.notation is None or one.has_files or one.out_of_service:
        raise _native.DesignError(f"{one.name}: tiles are of designs, without files and satellites out of service")
    jobs = _native.tile_jobs(scenario._engine, one, tiles)
    with tempfile.TemporaryDirectory(prefix="navwalker-tiles-") as directory, followed(progress, "tile") as tick:
        paths = [os.path.join(directory, f"{number}.tile") for number in range(1, tiles + 1)]
        done = 0

        def put(number: int, result: bytes) -> None:
            nonlocal done
            FilePath(paths[number]).write_bytes(result)
            done += 1
            if tick is not None:
                tick(done, tiles, done, None)

        if executor is None:
            for number, job in enumerate(jobs):
                put(number, _native.run_tile(scenario._engine, job))
        else:
            _elsewhere(engine_of(executor, scenario, "tile"), jobs, put)
        return Metrics(one.name, _native.merge_tiles(scenario._engine, one, paths))


def _elsewhere(engine: Any, jobs: list[bytes], put: Any) -> None:
    name = os.urandom(8).hex()
    try:
        by_engine(engine, range(len(jobs)), lambda number: (f"{name}-{number}", jobs[number]), put)
    except Stopped as error:
        raise _native.NavwalkerError(str(error)) from error.__cause__
