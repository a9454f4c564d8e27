"""Evaluations in tiles, against those of the whole, to the bit."""

from concurrent.futures import ThreadPoolExecutor

import pytest

import navwalker as nw


def test_tiles(small, design):
    """In tiles, here and by an executor, the metrics are those of the whole."""
    whole = small.evaluate(design).to_dict()
    assert small.evaluate(design, tiles=1).to_dict() == whole
    assert small.evaluate(design, tiles=48).to_dict() == whole
    with ThreadPoolExecutor(2) as executor:
        assert small.evaluate(design, tiles=5, executor=executor).to_dict() == whole
    named = nw.Constellation("delta:53:12/3/1@1000+star:90:8/4/1@1100", name="hybrid")
    tiled = small.evaluate(named, tiles=3)
    assert tiled.name == "hybrid" and tiled.to_dict() == small.evaluate(named).to_dict()
    without = small.replace(gnss_constellations=[])
    assert without.evaluate(design, tiles=2).to_dict() == without.evaluate(design).to_dict()


def test_tiles_of_what_is_too_large_to_be_whole():
    """Any number of samples in tiles; whole, it is refused with what to do."""
    globe = {"latitude_deg": [-90, 90], "longitude_deg": [-180, 180], "step_deg": 0.5}
    large = nw.Scenario("paper", time_duration_h=168, **{f"region_{key}": value for key, value in globe.items()})
    with pytest.raises(nw.ScenarioError, match=r"2.6e9 samples.*evaluate\(…, tiles=N\)"):
        large.evaluate("delta:55:6/3/1@925")


def test_tiles_that_cannot_be(small, design):
    for tiles in (-1, 0, 49):
        with pytest.raises(nw.NavwalkerError, match=f"tiles is {tiles}, expected 1 to 48"):
            small.evaluate(design, tiles=tiles)
    with pytest.raises(nw.ScenarioError, match="the PDOP of windows cannot be cut"):
        small.replace(metrics_window_min=60).evaluate(design, tiles=2)
    with pytest.raises(nw.DesignError, match="out of service"):
        small.evaluate(nw.Constellation(design).without("NW-P01-S01"), tiles=2)
    with pytest.raises(nw.NavwalkerError, match="of one design"):
        small.evaluate([design], tiles=2)
    with ThreadPoolExecutor(2) as executor, pytest.raises(nw.NavwalkerError, match="of one design"):
        small.evaluate(design, executor=executor)
    executor.shutdown()
    with pytest.raises(nw.NavwalkerError, match="takes no work"):
        small.evaluate(design, tiles=2, executor=executor)
