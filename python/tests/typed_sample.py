"""A program that type checkers see: what comes back has the types that it says."""

from concurrent.futures import ProcessPoolExecutor

import numpy as np
import numpy.typing as npt

import navwalker as nw


def mean_loss(scenario: nw.Scenario, whole: nw.Constellation, names: list[str]) -> float:
    """Mean over satellites of what their loss does to mean PDOP."""
    before: float = scenario.evaluate(whole).mean_pdop
    table: nw.Table = scenario.evaluate([whole.without(name) for name in names])
    pdop: npt.NDArray[np.float64] = table["mean_pdop"]
    return float(pdop.mean() - before)


def best(scenario: nw.Scenario) -> str | None:
    """The notation of the fuzzy pick."""
    run: nw.Run = scenario.optimize(seed=1)
    return run.pick("fuzzy").notation


def first_elevation(scenario: nw.Scenario) -> float:
    """An elevation, degrees."""
    azimuth, elevation = scenario.look_angles("delta:55:6/3/1@925", 0)
    dops: nw.Dops = nw.dop(azimuth[:, 0], elevation[:, 0])
    return float(elevation[0, 0]) + float(dops.pdop)


def costs(scenario: nw.Scenario) -> npt.NDArray[np.float64]:
    """Objectives of a search with a cost of the caller's."""

    def launches(table: nw.Table) -> npt.ArrayLike:
        return 3.0 * table["planes"]

    run: nw.CustomRun = scenario.optimize(objectives=["satellites", launches], progress=True)
    table: nw.Table = scenario.evaluate(
        planes=[3, 4], satellites_per_plane=4, inclination_deg=55, altitude_km=925.0, phasing=np.ones(2), progress=True
    )
    return run.objectives * len(table)


def swept(scenario: nw.Scenario) -> list[int]:
    """What is missing of a sweep by processes; nothing if it is whole."""
    with ProcessPoolExecutor(2) as executor:
        try:
            sweep: nw.Sweep = scenario.sweep(["delta:55:182/13/1@925"], store="sweep", executor=executor, format="csv")
        except nw.SweepError as error:
            return error.missing
    return [] if len(sweep.table()) == sweep.designs else [1]
