"""Searches: the run of the program, and problems for other optimisers."""

import numpy as np
import pytest

import navwalker as nw

KEYS = {"time_step_s": 1800, "region_step_deg": 20, "optimizer_population": 8, "optimizer_generations": 3}


@pytest.fixture(scope="module")
def scenario():
    return nw.Scenario("paper", **KEYS)


def test_run(scenario, tmp_path):
    run = scenario.optimize(seed=3)
    front = run.front
    assert run.seed == 3 and run.evaluations == 24 and len(run.history) == 3
    assert (np.diff(front["j_pos"]) >= 0).all()
    best = run.pick("fuzzy")
    assert best.notation in front["notation"] and run.pick(1).notation == front["notation"][0]
    with pytest.raises(nw.NavwalkerError, match="no pick 'best'"):
        run.pick("best")
    saved = run.save(tmp_path / "run")
    assert nw.Run(tmp_path / "run").to_dict() == saved.to_dict() == run.to_dict()
    page = saved.report(tmp_path / "r.html")
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    with pytest.raises(nw.FileError, match="not a run directory"):
        nw.Run(tmp_path)
    again = scenario.optimize(seed=3)
    np.testing.assert_array_equal(again.front["j_pos"], front["j_pos"])


def test_batches_are_evaluated_as_designs(scenario):
    variables = scenario.search_space()
    rng = np.random.default_rng(1)
    lower, upper = (np.array([one[place] for one in variables]) for place in (2, 3))
    vectors = rng.uniform(lower, upper, (6, len(variables)))
    found = scenario.batch(vectors)
    table = scenario.evaluate(found["notation"])
    np.testing.assert_array_equal(found["objectives"][:, 0], table["j_pos"])
    np.testing.assert_array_equal(found["objectives"][:, 1], table["j_cost"])
    whole = [place for place, one in enumerate(variables) if one[1] == "integer"]
    assert (found["vectors"][:, whole] == np.rint(found["vectors"][:, whole])).all()
    with pytest.raises(nw.NavwalkerError, match=r"expected \(n, "):
        scenario.batch([[1.0]])


def test_pymoo(scenario):
    pytest.importorskip("pymoo")
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.optimize import minimize

    problem = scenario.problem()
    result = minimize(problem, NSGA2(pop_size=8), ("n_gen", 2), seed=1)
    again = scenario.batch(result.X)
    np.testing.assert_array_equal(again["objectives"], result.F)


def test_objectives_of_the_caller(scenario):
    """The scenario's own objectives as a name and as a function give the scenario's own front."""
    calls = []

    def cost(table):
        calls.append(len(table))
        return table["j_cost"]

    run = scenario.optimize(seed=3, objectives=["j-pos", cost])
    same = scenario.optimize(seed=3)
    np.testing.assert_array_equal(run.objectives[:, 0], same.front["j_pos"])
    np.testing.assert_array_equal(run.front["notation"], same.front["notation"])
    assert run.names == ["j-pos", "cost"] and len(calls) == 3
    assert run.pick(1).notation == run.front["notation"][0]


def test_objectives_that_fail(scenario):
    with pytest.raises(ZeroDivisionError):
        scenario.optimize(objectives=["satellites", lambda table: 1 / 0])
    with pytest.raises(nw.NavwalkerError, match="1 values for 8 designs"):
        scenario.optimize(objectives=[lambda table: [1.0]])
    with pytest.raises(nw.NavwalkerError, match="gave NaN"):
        scenario.optimize(objectives=[lambda table: table["j_cost"] * np.nan])
    with pytest.raises(nw.ScenarioError, match="satelites"):
        scenario.optimize(objectives=["satelites"])
