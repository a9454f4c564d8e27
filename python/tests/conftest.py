"""A scenario small enough for tests."""

import pytest

import navwalker as nw

SMALL = {"time_step_s": 1800, "region_step_deg": 20}


@pytest.fixture(scope="session")
def small() -> nw.Scenario:
    return nw.Scenario("paper", **SMALL)


@pytest.fixture(scope="session")
def design() -> str:
    return "delta:55:182/13/1@925"
