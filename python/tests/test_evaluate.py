"""Metrics and tables against the program's own output, to the bit."""

import csv
import io
import json
import subprocess
import sys

import numpy as np
import pytest

import navwalker as nw

SETS = ["--set", "time.step-s=1800", "--set", "region.step-deg=20"]


def program(*arguments: str) -> str:
    """The result of the program that comes with the package."""
    command = [sys.executable, "-m", "navwalker", *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_metrics_equal_the_programs(small, design):
    text = program("evaluate", "paper", *SETS, "--design", design, "--format", "json")
    expected = json.loads(text)["metrics"]
    found = small.evaluate(design)
    for name, value in expected.items():
        if isinstance(value, dict):
            continue
        assert found[name] == value, name
    for level, share in expected["coverage"].items():
        assert found[f"coverage_{level}"] == share


def test_table_equals_the_programs(small, design):
    designs = [design, "star:90:182/13/1@925", "delta:53:160/10/1@1000+star:90:40/5/1@1100"]
    given = [part for one in designs for part in ("--design", one)]
    rows = list(csv.DictReader(io.StringIO(program("evaluate", "paper", *SETS, *given, "--format", "csv"))))
    table = small.evaluate(designs)
    assert len(table) == 3
    for name in table.columns:
        for row, value in zip(rows, table[name], strict=False):
            if row[name] == "":
                assert value is None or value != value, name
            elif isinstance(value, (np.bool_, bool)):
                assert row[name] == str(bool(value)).lower()
            elif isinstance(value, str):
                assert row[name] == value
            else:
                assert float(row[name]) == value, name


def test_columns_are_the_same_designs(small):
    table = small.evaluate(
        planes=[13, 12], satellites_per_plane=14, inclination_deg=[55, 60.5], altitude_km=925.0, phasing=1
    )
    same = small.evaluate(["delta:55:182/13/1@925", "delta:60.5:168/12/1@925"])
    assert table.columns == same.columns
    for name in table.columns:
        np.testing.assert_array_equal(table[name], same[name], err_msg=name)


def test_constellations_without_satellites(small):
    whole = nw.Constellation("delta:53:60/6/1@1000+star:90:40/5/1@1100", name="hybrid")
    less = whole.without("NW-A-P01-S01")
    assert len(small.positions(less)) == len(small.positions(whole)) - 1
    assert small.evaluate(less).mean_visible < small.evaluate(whole).mean_visible
    with pytest.raises(nw.DesignError, match="did you mean 'NW-A-P01-S01'"):
        small.evaluate(whole.without("NW-A-P01-S001"))


def test_samples_and_series_agree(small, design):
    samples = small.samples(design)
    assert samples.pdop.shape == samples.visible.shape == (len(small.elapsed_s), len(small.points))
    series, points = small.series(design), small.by_point(design)
    # Single precision: means of a few hundred values of 24 bits.
    np.testing.assert_allclose(np.nanmean(samples.pdop, axis=1), series["mean_pdop"], rtol=1e-6)
    np.testing.assert_allclose(np.nanmean(samples.pdop, axis=0), points["mean_pdop"], rtol=1e-6)
    np.testing.assert_allclose(samples.visible.mean(axis=0), points["mean_visible"], rtol=1e-12)
    assert samples.visible.mean() == pytest.approx(small.evaluate(design).mean_visible, rel=1e-12)


def test_positions_are_where_satellites_are_seen(small, design):
    """Elevations by numpy from positions and points count the satellites in view as the evaluator does."""
    positions = small.positions(design)
    latitude, longitude = (np.radians(small.points[name]) for name in ("latitude_deg", "longitude_deg"))
    up = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], -1)
    # The sphere of the built-in scenario `paper` has the equatorial radius.
    line = positions[:, :, np.newaxis, :] - 6378.137 * up
    sine = np.einsum("stpk,pk->stp", line, up) / np.linalg.norm(line, axis=-1)
    counted = (sine >= np.sin(np.radians(7.0))).sum(axis=0)
    np.testing.assert_array_equal(counted, small.samples(design).visible)
    azimuth, elevation = small.look_angles(design, 3)
    np.testing.assert_allclose(np.sin(np.radians(elevation)), sine[:, :, 3], atol=1e-12)
    assert ((azimuth >= 0) & (azimuth <= 360)).all()


def test_errors_name_what_and_where(small, design):
    with pytest.raises(nw.ScenarioError, match="visibility.mask-deg"):
        nw.Scenario("paper", visibility_mask_dgr=10)
    with pytest.raises(nw.ScenarioError, match='did you mean "paper"'):
        nw.Scenario("papr")
    with pytest.raises(nw.DesignError, match="row 1"):
        small.evaluate(planes=[13, 12], satellites_per_plane=14, inclination_deg=55, altitude_km=925, phasing=[1, 12])
    with pytest.raises(nw.NavwalkerError, match="different lengths"):
        small.evaluate(planes=[13, 12], satellites_per_plane=[1, 2, 3], inclination_deg=5, altitude_km=9, phasing=1)
    with pytest.raises(nw.NavwalkerError, match="not finite in row 1"):
        small.evaluate(planes=13, satellites_per_plane=14, inclination_deg=[55, np.nan], altitude_km=925, phasing=1)
    with pytest.raises(nw.NavwalkerError, match="expected numbers"):
        small.evaluate(planes=["a"], satellites_per_plane=14, inclination_deg=55, altitude_km=925, phasing=1)
    with pytest.raises(nw.NavwalkerError, match="whole number"):
        small.evaluate(planes=[1.5], satellites_per_plane=14, inclination_deg=55, altitude_km=925, phasing=1)
    with pytest.raises(nw.NavwalkerError, match="no constellation"):
        small.evaluate([])
    with pytest.raises(nw.NavwalkerError, match="no constellation"):
        small.evaluate(planes=[], satellites_per_plane=[], inclination_deg=[], altitude_km=[], phasing=[])
    with pytest.raises(nw.FileError, match="cannot read"):
        nw.read("missing.tle")
    with pytest.raises(nw.NavwalkerError, match="threads"):
        nw.Scenario("paper", threads=100_000).evaluate(design)
    with pytest.raises(TypeError, match="columns need"):
        small.evaluate(planes=[1])
    with pytest.raises(AttributeError, match="did you mean 'mean_pdop'"):
        _ = small.evaluate(design).mean_pdopp


def test_bad_designs_in_a_column(small, design):
    table = small.evaluate([design, "delta:55:182/13/1@", "star:90:182/13/1@925"], errors="column")
    assert [error is None for error in table["error"]] == [True, False, True]
    assert np.isnan(table["mean_pdop"][1]) and np.isfinite(table["mean_pdop"][[0, 2]]).all()
    with pytest.raises(nw.DesignError, match="delta:55:182/13/1@"):
        small.evaluate([design, "delta:55:182/13/1@"])


def test_scenarios_of_text_and_file(tmp_path, design):
    text = 'name = "own"\n[time]\nstep-s = 1800\n[region]\npoints = "points.csv"\n'
    (tmp_path / "points.csv").write_text("latitude_deg,longitude_deg\n40,116\n")
    file = tmp_path / "own.toml"
    file.write_text(text)
    scenario = nw.Scenario(file)
    assert scenario.name == "own" and len(scenario.points) == 1
    assert scenario.evaluate(design).mean_pdop > 0
    again = nw.Scenario(scenario.to_toml().replace("points.csv", str(tmp_path / "points.csv")))
    assert again.evaluate(design).to_dict() == scenario.evaluate(design).to_dict()


def test_keys_as_words_and_as_themselves(design):
    by_word = nw.Scenario("paper", time_step_s=1800, region_step_deg=20, visibility_mask_deg=np.float64(10))
    by_key = nw.Scenario("paper", set={"time.step-s": 1800, "region.step-deg": 20, "visibility.mask-deg": 10})
    assert by_word == by_key and by_word.evaluate(design) == by_key.evaluate(design)
    assert "mask-deg = 10" in by_word.to_toml()


def test_gnss_only(small):
    alone = small.gnss_only()
    assert alone.mean_visible == 0 and alone.mean_gnss_visible > 5
    assert nw.Scenario("paper", gnss_constellations=[], time_step_s=3600, region_step_deg=20).gnss_only() is None


def test_threads_change_nothing(small, design):
    one = nw.Scenario("paper", time_step_s=1800, region_step_deg=20, threads=1)
    assert one.evaluate(design) == small.evaluate(design)
