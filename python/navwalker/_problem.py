"""The search of a scenario for pymoo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from navwalker._extras import needed

if TYPE_CHECKING:
    from navwalker._scenario import Scenario

# What pymoo gets in place of an objective without a value, which only infeasible designs have.
_NO_VALUE = 1e12


def problem(scenario: Scenario) -> Any:
    """A pymoo Problem over real vectors; its constraint is the violation of the scenario's constraints."""
    base = needed("pymoo.core.problem", "problem").Problem
    variables = scenario.search_space()
    objectives = scenario.objectives()

    class NavwalkerProblem(base):  # type: ignore[misc, valid-type]
        """The designs of a scenario's search space, evaluated as one batch."""

        def __init__(self) -> None:
            lower = np.array([lo for _, _, lo, _ in variables])
            upper = np.array([hi for _, _, _, hi in variables])
            super().__init__(n_var=len(variables), n_obj=len(objectives), n_ieq_constr=1, xl=lower, xu=upper)
            self.scenario = scenario
            self.variable_names = [name for name, *_ in variables]
            self.objective_names = objectives

        def _evaluate(self, x: Any, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
            found = self.scenario.batch(x)
            out["F"] = np.where(np.isfinite(found["objectives"]), found["objectives"], _NO_VALUE)
            out["G"] = np.where(np.isfinite(found["violation"]), found["violation"], _NO_VALUE)[:, np.newaxis]

    return NavwalkerProblem()
