"""Figures: what is drawn is what was computed."""

import numpy as np
import pytest

import navwalker as nw

pytest.importorskip("matplotlib").use("Agg")


def test_series_and_cdf(small, design):
    axes = small.plot.series(design)
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), small.series(design)["mean_pdop"])
    axes = small.plot.cdf(design)
    share = axes.lines[0].get_ydata()
    assert share[-1] == pytest.approx(small.evaluate(design).solved_fraction)


def test_map_and_sky_and_compare(small, design):
    axes = small.plot.map(design, "mean_pdop")
    cells = np.asarray(axes.collections[0].get_array()).ravel()
    np.testing.assert_array_equal(cells, np.asarray(small.maps(design)["mean_pdop"]).ravel())
    assert len(small.plot.sky(design).lines) == 182
    axes = small.plot.compare([design, "star:90:182/13/1@925"])
    heights = [bar.get_height() for bar in axes.containers[0]]
    assert heights == list(small.evaluate([design, "star:90:182/13/1@925"])["mean_pdop"])


def test_axes_of_the_caller(small, design):
    from matplotlib import pyplot

    _, axes = pyplot.subplots()
    assert small.plot.series(design, ax=axes) is axes


def test_front():
    scenario = nw.Scenario(
        "paper", time_step_s=1800, region_step_deg=20, optimizer_population=8, optimizer_generations=2
    )
    run = scenario.optimize(seed=1)
    front, chosen = scenario.plot.front(run).lines
    np.testing.assert_array_equal(front.get_xdata(), run.front["j_pos"])
    np.testing.assert_array_equal(front.get_ydata(), run.front["j_cost"])
    place = list(run.front["notation"]).index(run.pick("fuzzy").notation)
    assert chosen.get_xdata() == [run.front["j_pos"][place]]
