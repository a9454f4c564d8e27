"""Hypervolume of pymoo's NSGA-II on the problems that navwalker's is measured on.

    pip install -r validation/peers/requirements.txt
    python validation/peers/pymoo_nsga2.py functions [--seeds 10]
    python validation/peers/pymoo_nsga2.py paper --binary target/release/navwalker [--seeds 10]

`functions`: ZDT1 to 4 and 6 and DTLZ2, 100 individuals, 250 generations, crossover 0.9 and
mutation 1/n; ours is `cargo run --release --example test_functions`.
`paper`: the built-in scenario with 30 x 30, designs evaluated by the binary; ours is
`navwalker optimize --seeds 10`. Both measure the last population alone.
"""

import argparse
import json
import math
import statistics
import subprocess
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.core.repair import Repair
from pymoo.indicators.hv import HV
from pymoo.operators.crossover.sbx import SBX
from pymoo.operators.mutation.pm import PM
from pymoo.optimize import minimize
from pymoo.problems import get_problem

FUNCTIONS = ["zdt1", "zdt2", "zdt3", "zdt4", "zdt6", "dtlz2"]


def volume(result, reference):
    front = result.algorithm.pop.get("F")
    return HV(ref_point=np.array(reference))(front)


def report(name, volumes):
    deviation = statistics.stdev(volumes) if len(volumes) > 1 else 0.0
    print(
        f"{name},{statistics.mean(volumes):.5f},{min(volumes):.5f},{max(volumes):.5f},{deviation:.5f}",
        flush=True,
    )


def functions(seeds):
    for name in FUNCTIONS:
        problem = get_problem(name)
        algorithm = NSGA2(
            pop_size=100,
            crossover=SBX(prob=0.9, eta=15),
            mutation=PM(prob_var=1.0 / problem.n_var, eta=20),
        )
        runs = [minimize(problem, algorithm, ("n_gen", 250), seed=s) for s in range(1, seeds + 1)]
        report(name, [volume(run, [1.1] * problem.n_obj) for run in runs])


class WholeCounts(Repair):
    """Planes and satellites are whole in the genome, as pymoo's own RoundingRepair does it."""

    def _do(self, _problem, x, **_kwargs):
        x = x.copy()
        x[:, :2] = np.rint(x[:, :2])
        return x


class Paper(Problem):
    """The paper's search space."""

    def __init__(self, binary):
        super().__init__(n_var=4, n_obj=2, xl=[11, 11, 40, 400], xu=[15, 15, 60, 1000])
        self.evaluate_design = lru_cache(maxsize=None)(lambda design: evaluate(binary, design))

    def _evaluate(self, x, out, *_args, **_kwargs):
        designs = [
            f"delta:{i:.4f}:{round(p) * round(s)}/{round(p)}/1@{h:.3f}" for p, s, i, h in x
        ]
        with ThreadPoolExecutor(2) as pool:
            out["F"] = np.array(list(pool.map(self.evaluate_design, designs)))


def evaluate(binary, design):
    command = [binary, "evaluate", "--quiet", "--threads", "1", "--design", design, "--format", "json"]
    metrics = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["metrics"]
    solved = metrics["solved_fraction"] == 1.0
    return (metrics["j_pos"], metrics["j_cost"]) if solved else (math.inf, math.inf)


def paper(binary, seeds):
    problem = Paper(binary)
    settings = {
        "paper's probabilities (0.8, 0.1)": {
            "crossover": SBX(prob=0.8, eta=15),
            "mutation": PM(prob_var=0.1, eta=20),
        },
        "pymoo's defaults": {},
    }
    for name, operators in settings.items():
        # Rounded at evaluation alone, genomes drift on plateaus: 0.592 and 0.598 in place of 0.609.
        algorithm = NSGA2(pop_size=30, repair=WholeCounts(), **operators)
        runs = [minimize(problem, algorithm, ("n_gen", 30), seed=s) for s in range(1, seeds + 1)]
        report(name, [volume(run, [2.0, 22.0]) for run in runs])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["functions", "paper"])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--binary", default="target/release/navwalker")
    arguments = parser.parse_args()
    print("problem,mean,min,max,std_dev")
    if arguments.what == "functions":
        functions(arguments.seeds)
    else:
        paper(arguments.binary, arguments.seeds)


if __name__ == "__main__":
    main()
