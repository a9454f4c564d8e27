"""Figures by matplotlib, each on axes of the caller or of its own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from navwalker._constellation import Constellation
from navwalker._extras import needed
from navwalker._maps import Lattice
from navwalker._results import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from navwalker._run import Run
    from navwalker._scenario import Scenario

Given = str | Constellation


class Plots:
    """The figures of a scenario; each returns the Axes that it draws on."""

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario

    def front(self, run: Run, *, ax: Axes | None = None, pick: str = "fuzzy") -> Axes:
        """The front of a search in its first two objectives, with a pick marked."""
        axes = _axes(ax)
        objectives = [name.replace("-", "_") for name in self._scenario.objectives()[:2]]
        if len(objectives) < 2:
            raise ValueError("a front of one objective has no figure")
        front = run.front
        axes.plot(front[objectives[0]], front[objectives[1]], "o-", markersize=4, label="front")
        chosen = list(front["notation"]).index(run.pick(pick).notation)
        axes.plot(front[objectives[0]][chosen], front[objectives[1]][chosen], "D", label=f"{pick} pick")
        axes.set_xlabel(_label(objectives[0]))
        axes.set_ylabel(_label(objectives[1]))
        axes.legend()
        return axes

    def map(self, constellation: Given, measure: str = "mean_pdop", *, ax: Axes | None = None) -> Axes:
        """A metric by ground point, with the borders of the region."""
        axes = _axes(ax)
        points = self._scenario.by_point(constellation)
        lattice = Lattice.of(points)
        drawn: Any
        if lattice is None:
            drawn = axes.scatter(points["longitude_deg"], points["latitude_deg"], c=points[measure], s=24)
        else:
            cells = lattice.laid_out(points[measure])
            drawn = axes.pcolormesh(lattice.longitudes, lattice.latitudes, cells, shading="nearest")
        for line in self._scenario._engine.outlines():
            longitudes, latitudes = zip(*line, strict=True)
            axes.plot(longitudes, latitudes, color="black", linewidth=0.6)
        bar = axes.figure.colorbar(drawn, ax=axes, shrink=0.8)
        bar.set_label(_label(measure))
        axes.set_xlabel("longitude (°)")
        axes.set_ylabel("latitude (°)")
        axes.set_aspect("equal")
        return axes

    def cdf(self, *constellations: Given, ax: Axes | None = None) -> Axes:
        """The cumulative distribution of PDOP over all samples, weighted by point; what is not solved is missing."""
        import numpy as np

        axes = _axes(ax)
        for one in constellations:
            samples = self._scenario.samples(one)
            weights = np.broadcast_to(samples.points["weight"], samples.pdop.shape)
            solved = np.isfinite(samples.pdop)
            order = np.argsort(samples.pdop[solved])
            share = np.cumsum(weights[solved][order]) / weights.sum()
            axes.step(samples.pdop[solved][order], share, where="post", label=_name(one))
        axes.set_xlabel("PDOP")
        axes.set_ylabel("share of samples")
        axes.set_ylim(0, 1)
        axes.legend()
        return axes

    def series(self, *constellations: Given, measure: str = "mean_pdop", ax: Axes | None = None) -> Axes:
        """A metric over all points against time."""
        axes = _axes(ax)
        for one in constellations:
            instants = self._scenario.series(one)
            axes.plot(instants["elapsed_s"] / 3600, instants[measure], label=_name(one))
        axes.set_xlabel("time since the epoch (h)")
        axes.set_ylabel(_label(measure))
        axes.legend()
        return axes

    def compare(
        self,
        constellations: Iterable[Given],
        measures: Iterable[str] = ("mean_pdop", "cvar_pdop"),
        *,
        ax: Axes | None = None,
    ) -> Axes:
        """Bars of some metrics for several constellations."""
        import numpy as np

        axes = _axes(ax)
        given = list(constellations)
        measures = list(measures)
        table: Table = self._scenario.evaluate(given)
        places = np.arange(len(given))
        width = 0.8 / len(measures)
        for number, measure in enumerate(measures):
            axes.bar(places + (number - (len(measures) - 1) / 2) * width, table[measure], width, label=_label(measure))
        axes.set_xticks(places, [_name(one) for one in given], rotation=20, ha="right")
        axes.legend()
        return axes

    def sky(self, constellation: Given, point: int = 0, *, ax: Axes | None = None) -> Axes:
        """The tracks of the satellites of a constellation over a ground point, by azimuth and zenith distance."""
        import numpy as np

        axes: Any = ax if ax is not None else _pyplot().figure().add_subplot(projection="polar")
        azimuth, elevation = self._scenario.look_angles(constellation, point)
        above = np.where(elevation > 0, elevation, np.nan)
        for one_azimuth, one_elevation in zip(azimuth, above, strict=True):
            axes.plot(np.radians(one_azimuth), 90 - one_elevation, ".", markersize=1.5)
        axes.set_theta_zero_location("N")
        axes.set_theta_direction(-1)
        axes.set_rlim(0, 90)
        axes.set_yticks([0, 30, 60, 90], ["90°", "60°", "30°", "0°"])
        found: Axes = axes
        return found


def _pyplot() -> Any:
    return needed("matplotlib.pyplot", "plot")


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    made: Axes = _pyplot().subplots()[1]
    return made


def _name(one: Given) -> str:
    return one if isinstance(one, str) else one.name


def _label(measure: str) -> str:
    """The name of a metric with its unit."""
    words = measure.split("_")
    words = ["PDOP" if word == "pdop" else "CVaR" if word == "cvar" else word for word in words]
    units = {"s": " (s)", "m": " (m)", "km": " (km)", "deg": " (°)"}
    unit = units.get(words[-1], "")
    return " ".join(words[:-1] if unit else words) + unit
