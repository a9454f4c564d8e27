"""Searches and their results."""

from __future__ import annotations

import json
import os
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from navwalker import _native
from navwalker._commands import run
from navwalker._constellation import Constellation, Path
from navwalker._progress import followed
from navwalker._results import Table

if TYPE_CHECKING:
    import tempfile

    from navwalker._scenario import Scenario


class Run:
    """The results of a search, in a run directory as ``navwalker optimize`` writes it.

    >>> import navwalker as nw
    >>> scenario = nw.Scenario("paper", time_step_s=900, region_step_deg=20, optimizer_population=8, optimizer_generations=2)
    >>> run = scenario.optimize(seed=1)
    >>> run.pick("fuzzy").name in run.front["notation"]
    True
    """

    def __init__(self, directory: Path) -> None:
        self._directory = FilePath(directory)
        self._temporary: tempfile.TemporaryDirectory[str] | None = None
        try:
            with open(self._directory / "front.json", encoding="utf-8") as file:
                self._whole: dict[str, Any] = json.load(file)
        except (OSError, ValueError) as error:
            raise _native.FileError(f"{directory} is not a run directory: {error}") from None

    @property
    def directory(self) -> FilePath:
        """Where the run is kept."""
        return self._directory

    @property
    def front(self) -> Table:
        """The non-dominated designs, sorted by the first objective."""
        return self._table("front.csv")

    @property
    def history(self) -> Table:
        """The generations."""
        return self._table("history.csv")

    @property
    def seed(self) -> int:
        """The seed of the search."""
        return int(self._whole["seed"])

    @property
    def evaluations(self) -> int:
        """Number of evaluated designs."""
        return int(self._whole["evaluations"])

    @property
    def hypervolume(self) -> float | None:
        """The hypervolume of the front."""
        value: float | None = self._whole["hypervolume"]["value"]
        return value

    @property
    def diagnostics(self) -> list[dict[str, str]]:
        """What may be wrong with the search: codes and messages."""
        diagnostics: list[dict[str, str]] = self._whole["diagnostics"]
        return diagnostics

    def pick(self, how: str | int = "fuzzy") -> Constellation:
        """A design of the front: by a decision method (``fuzzy``, ``sum``, ``topsis``, ``knee``) or by its index from 1."""
        members = self._whole["front"]
        place = _native.picked(json.dumps(members), str(how))
        return Constellation(members[place]["design"]["notation"])

    def report(self, out: Path) -> FilePath:
        """Writes the page of the run, one self-contained HTML file."""
        run(["report", os.fspath(self._directory), "--out", os.fspath(out)], _native.FileError)
        return FilePath(out)

    def save(self, directory: Path) -> Run:
        """Copies the run into a new directory and returns it from there."""
        import shutil

        try:
            shutil.copytree(self._directory, directory)
        except OSError as error:
            raise _native.FileError(f"cannot save the run: {error}") from None
        return Run(directory)

    def to_dict(self) -> dict[str, Any]:
        """Everything that ``navwalker optimize --format json`` says."""
        return dict(self._whole)

    def _table(self, name: str) -> Table:
        text = (self._directory / name).read_text(encoding="utf-8")
        return Table(_native.Columns.of_csv(text))

    def __repr__(self) -> str:
        designs = len(self._whole["front"])
        return f"<Run of {self.evaluations} evaluations, seed {self.seed}: {designs} designs on the front>"

    def _repr_html_(self) -> str:
        return self.front._repr_html_()


def search(scenario: Scenario, seed: int | None, out: Path | None, force: bool, progress: bool) -> Run:
    """Runs the search of a scenario."""
    import tempfile

    temporary = None
    if out is None:
        temporary = tempfile.TemporaryDirectory(prefix="navwalker-")
        out = os.path.join(temporary.name, "run")
    seeds = [] if seed is None else ["--seed", str(seed)]
    switches = ["--force"] if force else []
    arguments = ["optimize", *seeds, "--out", os.fspath(out), *switches, "--format", "json"]
    with followed(progress, "generation") as tick:
        run(arguments, scenario=scenario, tick=tick)
    found = Run(out)
    found._temporary = temporary
    return found
