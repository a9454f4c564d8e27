"""Searches with objectives of the caller."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navwalker import _native
from navwalker._constellation import Constellation
from navwalker._progress import followed
from navwalker._results import Table

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from navwalker._scenario import Scenario

    Objective = Callable[[Table], npt.ArrayLike]


@dataclass(frozen=True)
class CustomRun:
    """The result of a search with objectives of the caller.

    ``front`` has the non-dominated designs with their metrics, ``objectives`` (design, objective) their values as
    minimised, named by ``names``; ``history`` the generations.
    """

    front: Table
    objectives: npt.NDArray[np.float64]
    names: list[str]
    history: Table

    def pick(self, index: int = 1) -> Constellation:
        """A design of the front by its index from 1."""
        if not 1 <= index <= len(self.front):
            raise _native.NavwalkerError(f"index is {index}, expected 1 to {len(self.front)}")
        return Constellation(self.front["notation"][index - 1])


def search(
    scenario: Scenario, seed: int | None, objectives: Sequence[str | Objective], progress: bool
) -> CustomRun:
    """Searches for designs under some objectives, each a name of a quantity or a function of a table."""
    if not objectives:
        raise _native.NavwalkerError("there is no objective")
    names = [one for one in objectives if isinstance(one, str)]
    under = scenario
    if names:
        under = scenario.replace(set={"objectives.minimize": names})
    given = [names.index(one) if isinstance(one, str) else _called(one) for one in objectives]
    with followed(progress, "generation") as tick:
        front, values, history = _native.search_custom(under._engine, seed, given, tick)
    named = [one if isinstance(one, str) else getattr(one, "__name__", "objective") for one in objectives]
    return CustomRun(Table(front), values, named, Table(history))


def _called(function: Objective) -> Callable[[_native.Columns], npt.NDArray[np.float64]]:
    """A function of a table as the native part calls it."""
    if not callable(function):
        raise _native.NavwalkerError(f"an objective is a name or a function, not {type(function).__name__}")

    import numpy as np

    def called(columns: _native.Columns) -> npt.NDArray[np.float64]:
        return np.ascontiguousarray(function(Table(columns)), dtype=np.float64)

    return called
