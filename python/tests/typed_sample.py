"""A program that type checkers see: what comes back has the types that it says."""

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
