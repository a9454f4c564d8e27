"""A session in a notebook from end to end, in the words that a user types."""

import numpy as np
import pytest

import navwalker as nw

KEYS = {"time_step_s": 1800, "region_step_deg": 20, "optimizer_population": 8, "optimizer_generations": 2}
TEXT = """
name = "own"
[time]
step-s = 1800
[region]
points = "points.csv"
[optimizer]
population = 8
generations = 2
"""


@pytest.fixture(scope="module")
def sc():
    return nw.Scenario("paper", visibility_mask_deg=10, **KEYS)


@pytest.fixture(scope="module")
def hyb():
    return nw.Constellation("delta:53:160/10/1@1000+star:90:40/5/1@1100", name="hybrid").without("NW-A-P01-S01")


@pytest.fixture
def sc_of_text(tmp_path, monkeypatch):
    """A scenario of text, with a file beside it and a key changed; then the current directory is another one."""
    home, elsewhere = tmp_path / "home", tmp_path / "elsewhere"
    home.mkdir()
    elsewhere.mkdir()
    (home / "points.csv").write_text("latitude_deg,longitude_deg\n40,116\n23,113\n")
    monkeypatch.chdir(home)
    found = nw.Scenario(TEXT, visibility_mask_deg=10, threads=1)
    monkeypatch.chdir(elsewhere)
    return found


def test_evaluations(sc):
    m = sc.evaluate("delta:55:182/13/1@925")
    assert m.mean_pdop > 1 and m.cvar_pdop > m.mean_pdop and m.to_dict()["mean_pdop"] == m.mean_pdop
    tab = sc.evaluate(["delta:55:182/13/1@925", "star:90:182/13/1@925"])
    assert len(tab) == len(tab.to_pandas()) == len(tab.to_polars()) == len(tab.to_arrow()) == 2
    p, s, f = np.array([13, 12]), np.array([14, 14]), np.array([1, 1])
    i, h = np.array([55.0, 60.0]), np.array([925.0, 1000.0])
    tab = sc.evaluate(planes=p, satellites_per_plane=s, inclination_deg=i, altitude_km=h, phasing=f)
    assert tab["mean_pdop"][0] == m.mean_pdop and tab["notation"][1] == "delta:60:168/12/1@1000"
    by_key = nw.Scenario("paper", set={"visibility.mask-deg": 10}, **KEYS)
    assert by_key == sc


def test_arrays(sc, hyb):
    pytest.importorskip("xarray")
    ds = sc.maps(hyb)
    assert set(ds.sizes) == {"latitude", "longitude"} and ds["latitude"].attrs["units"] == "degrees_north"
    assert len(sc.series(hyb)) == len(sc.elapsed_s) == len(sc.utc)
    samples = sc.samples(hyb)
    assert samples.pdop.shape == samples.visible.shape == (len(sc.elapsed_s), len(sc.points))
    pos = sc.positions(hyb, frame="ITRF")
    assert pos.shape == (199, len(sc.elapsed_s), 3)
    radius = np.linalg.norm(pos, axis=-1)
    # Circular orbits at 1000 and 1100 km over the equatorial radius; the model is secular.
    np.testing.assert_allclose(np.unique(radius.round(6)), [7378.137, 7478.137])


def test_sites_are_over_point(hyb, sc_of_text):
    pytest.importorskip("xarray")
    ds = sc_of_text.maps(hyb)
    assert set(ds.sizes) == {"point"} and ds["latitude"].dims == ("point",)


def my_cost(table):
    """A cost of the caller: a launch for each plane."""
    return 3.0 * table["planes"] + 0.5 * table["satellites"]


def test_searches(sc, tmp_path):
    run = sc.optimize(seed=1, progress=True)
    assert run.pick("fuzzy").notation in run.front["notation"]
    assert len(run.history) == 2 and isinstance(run.diagnostics, list)
    assert run.report(tmp_path / "r.html").exists() and run.save(tmp_path / "saved").seed == 1
    run = sc.optimize(objectives=["satellites", my_cost])
    np.testing.assert_array_equal(run.objectives[:, 1], my_cost(run.front))
    np.testing.assert_array_equal(run.objectives[:, 0], run.front["satellites"])


def test_other_optimisers(sc):
    pytest.importorskip("pymoo")
    prob = sc.problem()
    x = np.array([prob.xl, prob.xu])
    np.testing.assert_array_equal(prob.evaluate(x, return_values_of=["F"]), sc.batch(x)["objectives"])


def test_files_of_a_scenario_of_text(hyb, sc_of_text, tmp_path):
    """Commands take a scenario that is in no file, with the key that was changed and the file that it names."""
    sc = sc_of_text
    manifest = hyb.export("out", ["omm", "oem", "gmat"], scenario=sc, check=True)
    assert manifest["out_of_service"] == 1
    assert {one["format"] for one in manifest["files"]} == {"omm", "oem", "gmat"}
    assert manifest["scenario"]["name"] == "own"
    assert nw.validate(hyb, against="sgp4", scenario=sc).passed
    x = next((tmp_path / "elsewhere" / "out" / "oem").iterdir())
    assert nw.lint(x) == []
    run = sc.optimize(seed=2, out="run")
    front = run.front
    again = sc.evaluate(front["notation"])
    np.testing.assert_array_equal(again["mean_pdop"], front["mean_pdop"])
    with pytest.raises(nw.NavwalkerError, match="scenario:6: region.points: cannot read points.csv"):
        nw.Scenario(TEXT).optimize()


def test_dilutions_of_any_shape():
    rng = np.random.default_rng(1)
    azimuth_deg, elevation_deg = rng.uniform(0, 360, (2, 3, 9)), rng.uniform(5, 90, (2, 3, 9))
    found = nw.dop(azimuth_deg, elevation_deg, system=None)
    assert found.pdop.shape == (2, 3)
    assert found.pdop[1, 2] == nw.dop(azimuth_deg[1, 2], elevation_deg[1, 2]).pdop
