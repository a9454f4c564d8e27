"""Designs, evaluates, exports and validates LEO Walker constellations that augment a GNSS.

>>> import navwalker as nw
>>> scenario = nw.Scenario("paper", time_step_s=900, region_step_deg=20)
>>> metrics = scenario.evaluate("delta:55:182/13/1@925")
>>> round(metrics.mean_visible, 2)
7.52
"""

from navwalker._commands import Finding, ValidationReport, lint, validate
from navwalker._constellation import Constellation, read
from navwalker._custom import CustomRun
from navwalker._native import (
    DesignError,
    FileError,
    NavwalkerError,
    NavwalkerWarning,
    ScenarioError,
    __version__,
)
from navwalker._plots import Plots
from navwalker._results import Metrics, Samples, Table
from navwalker._run import Run
from navwalker._scenario import Scenario
from navwalker._sky import Dops, dop
from navwalker._sweep import Sweep, SweepError

__all__ = [
    "Constellation",
    "CustomRun",
    "DesignError",
    "Dops",
    "FileError",
    "Finding",
    "Metrics",
    "NavwalkerError",
    "NavwalkerWarning",
    "Plots",
    "Run",
    "Samples",
    "Scenario",
    "ScenarioError",
    "Sweep",
    "SweepError",
    "Table",
    "ValidationReport",
    "__version__",
    "dop",
    "lint",
    "read",
    "validate",
]
