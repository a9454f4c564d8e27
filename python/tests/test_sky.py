"""Dilutions of skies against the normal equations in numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import navwalker as nw


def by_normal_equations(azimuth_deg, elevation_deg, system):
    """Q = (HᵀH)⁻¹ with a clock a system."""
    azimuth, elevation = np.radians(azimuth_deg), np.radians(elevation_deg)
    systems = np.unique(system)
    clocks = (np.asarray(system)[:, np.newaxis] == systems).astype(float)
    east, north = np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth)
    matrix = np.column_stack([east, north, np.sin(elevation), clocks])
    variances = np.diag(np.linalg.inv(matrix.T @ matrix))
    return np.sqrt([variances.sum(), variances[:3].sum(), variances[:2].sum(), variances[2]])


@settings(deadline=None, max_examples=200)
@given(st.integers(0, 2**32 - 1), st.integers(8, 20), st.integers(1, 3))
def test_validate_dops_against_normal_equations(seed, satellites, systems):
    rng = np.random.default_rng(seed)
    azimuth, elevation = rng.uniform(0, 360, satellites), rng.uniform(5, 90, satellites)
    system = np.arange(satellites) % systems
    found = nw.dop(azimuth, elevation, system)
    expected = by_normal_equations(azimuth, elevation, system)
    ours = [found.gdop, found.pdop, found.hdop, found.vdop]
    # The condition of the normal matrix amplifies rounding; skies of eight are rarely beyond 1e6.
    np.testing.assert_allclose(np.array(ours, dtype=float), expected, rtol=1e-8)


def test_axes_and_unsolved():
    azimuth = np.array([[0, 90, 180, 270, 0], [0, 0, 0, 0, 0]])
    elevation = np.array([[10, 10, 10, 10, 90], [30, 30, 30, 30, 30]])
    found = nw.dop(azimuth, elevation)
    assert found.pdop.shape == (2,) and np.isfinite(found.pdop[0]) and np.isnan(found.pdop[1])
    assert found.tdop.shape == (2, 1)
    one = nw.dop(azimuth[0], elevation[0])
    assert one.pdop.shape == () and one.pdop == found.pdop[0]
    absent = nw.dop([*azimuth[0], np.nan], [*elevation[0], 45])
    assert absent.pdop == one.pdop
    assert np.isnan(nw.dop(azimuth[0], elevation[0], mask_deg=15).pdop)


def test_bad_skies():
    with pytest.raises(nw.NavwalkerError, match="elevation is 91"):
        nw.dop([0], [91])
    with pytest.raises(nw.NavwalkerError, match="do not fit"):
        nw.dop([0, 1], [1, 2, 3])
    with pytest.raises(nw.NavwalkerError, match="at least one axis"):
        nw.dop(0, 1)
