"""Inputs that are wrong: an exception of the module that says what and where, never a panic."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import navwalker as nw

TINY = {"time_duration_h": 1, "time_step_s": 1800, "region_step_deg": 40, "gnss_constellations": []}
TYPES = ["f8", "f4", "f2", "i8", "i4", "u1", "?", "U3", "O", "c8", "M8[s]"]
FEW = settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.too_slow])


@pytest.fixture(scope="module")
def tiny():
    return nw.Scenario("paper", **TINY)


@st.composite
def column(draw):
    """Anything that a column may be by mistake: types, shapes, and values that are no numbers."""
    kind = draw(st.sampled_from(TYPES))
    shape = draw(st.sampled_from([(), (0,), (1,), (2,), (3,), (2, 2)]))
    if kind == "O":
        return np.full(shape, draw(st.sampled_from([None, "a", 1, {}])), dtype=object)
    return draw(arrays.arrays(kind, shape))


@FEW
@given(st.fixed_dictionaries({name: column() for name in ("planes", "satellites_per_plane", "inclination_deg", "altitude_km", "phasing")}))
def test_columns(tiny, columns):
    try:
        table = tiny.evaluate(**columns, errors="column")
    except nw.NavwalkerError as error:
        assert str(error)
    else:
        assert [(why is None) for why in table["error"]] == np.isfinite(table["mean_visible"]).tolist()


@FEW
@given(
    planes=st.integers(-3, 6),
    satellites=st.integers(-3, 6),
    phasing=st.integers(-2, 8),
    inclination=st.floats(allow_nan=False, allow_infinity=False) | st.floats(-10, 190),
    altitude=st.floats(allow_nan=False, allow_infinity=False) | st.floats(-100, 50_000),
)
def test_shells(tiny, planes, satellites, phasing, inclination, altitude):
    """A shell is evaluated as its notation is, or refused as its notation is."""
    columns = {
        "planes": planes,
        "satellites_per_plane": satellites,
        "inclination_deg": inclination,
        "altitude_km": altitude,
        "phasing": phasing,
    }
    table = tiny.evaluate(**columns, errors="column")
    notation = f"delta:{inclination!r}:{planes * satellites}/{planes}/{phasing}@{altitude!r}"
    if table["error"][0] is None:
        assert tiny.evaluate([table["notation"][0]])["mean_visible"] == table["mean_visible"]
    else:
        with pytest.raises(nw.NavwalkerError, match="row 0"):
            tiny.evaluate(**columns)
        with pytest.raises(nw.NavwalkerError):
            tiny.evaluate(notation)


@FEW
@given(st.text(max_size=40))
def test_texts(tiny, text):
    for use in (nw.Constellation, tiny.evaluate, nw.Scenario):
        try:
            use(text)
        except nw.NavwalkerError as error:
            assert str(error)


@FEW
@given(st.dictionaries(st.text(max_size=12), st.none() | st.integers() | st.floats() | st.text(max_size=8) | st.binary(max_size=4), max_size=2))
def test_keys(keys):
    try:
        nw.Scenario("paper", set=keys)
    except nw.NavwalkerError as error:
        assert str(error)


@FEW
@given(column(), column(), st.none() | column())
def test_skies(azimuth, elevation, system):
    try:
        found = nw.dop(azimuth, elevation, system)
    except nw.NavwalkerError as error:
        assert str(error)
    else:
        assert not np.isinf(found.gdop).any() and found.tdop.shape == (*found.pdop.shape, len(found.systems))


@FEW
@given(column())
def test_vectors(vectors):
    scenario = nw.Scenario("paper", **{**TINY, "gnss_constellations": ["beidou-3"]})
    try:
        found = scenario.batch(vectors)
    except nw.NavwalkerError as error:
        assert str(error)
    else:
        assert len(found["notation"]) == len(found["violation"])


def test_places(tiny, tmp_path, design):
    """What is wrong is named with its place and the nearest name."""
    with pytest.raises(nw.ScenarioError, match="visibility.mask-deg: found 95, expected a number >= 0 and < 90"):
        nw.Scenario("paper", visibility_mask_deg=95)
    with pytest.raises(nw.ScenarioError, match=r"did you mean .*mask-deg"):
        nw.Scenario("paper", set={"visibility.mask-dge": 10})
    with pytest.raises(nw.ScenarioError, match=r"scenario:3: visibility.mask-dg: unknown key, did you mean .visibility.mask-deg."):
        nw.Scenario('name = "own"\n[visibility]\nmask-dg = 10\n')
    with pytest.raises(nw.ScenarioError, match="missing.toml"):
        nw.Scenario(tmp_path / "missing.toml")
    with pytest.raises(nw.NavwalkerError, match="planes has the type <U1, expected numbers"):
        tiny.evaluate(planes="a", satellites_per_plane=14, inclination_deg=55, altitude_km=925, phasing=1)
    with pytest.raises(nw.NavwalkerError, match="inclination_deg has a value that is not finite in row 2"):
        tiny.evaluate(planes=3, satellites_per_plane=4, inclination_deg=[1, 2, np.nan], altitude_km=925, phasing=1)
    with pytest.raises(nw.NavwalkerError, match="there is no constellation to evaluate"):
        tiny.evaluate(iter(()))
    with pytest.raises(nw.DesignError, match="not int"):
        tiny.evaluate([design, 3])
    with pytest.raises(nw.NavwalkerError, match="'raise' or 'column'"):
        tiny.evaluate([design], errors="ignore")
    with pytest.raises(nw.NavwalkerError, match="frame"):
        tiny.positions(design, frame="ITRS")
    with pytest.raises(nw.NavwalkerError, match="expected 0 to"):
        tiny.look_angles(design, 10_000)
    with pytest.raises(nw.FileError, match=r"missing\.oem"):
        nw.lint(tmp_path / "missing.oem")
    with pytest.raises(nw.NavwalkerError, match="not finite"):
        tiny.batch([[np.nan] * len(tiny.search_space())])
    for wrong in (np.array([1 + 2j]), np.array([True]), np.array(["a"]), np.array([None])):
        with pytest.raises(nw.NavwalkerError, match="has the type .*, expected numbers"):
            nw.dop(wrong, [45])
        with pytest.raises(nw.NavwalkerError, match="has the type .*, expected numbers"):
            tiny.batch(np.resize(wrong, (1, len(tiny.search_space()))))
    with pytest.raises(nw.NavwalkerError, match="azimuth_deg is no array"):
        nw.dop([[1, 2], [3]], [45])
