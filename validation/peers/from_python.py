"""Time of navwalker from Python beside the program, and of pymoo's search on navwalker beside pymoo on numba.

    pip install -r validation/peers/requirements.txt ./python
    python validation/peers/from_python.py [--navwalker BINARY] [--designs 1000] [--repeats 5]

The paper's scenario (see evaluate.py). First, designs one by one and as one batch through the module, and with --navwalker the
same batch by the program. Then NSGA-II of pymoo with 30 individuals and 30 generations, with the designs of a generation evaluated by
numba on as many threads as there are cores, by navwalker's `problem()`, and the search of navwalker itself. Objectives of both must
agree to 1e-6 before any time is printed. Both searches of pymoo have the same seed and settings; their genomes are rounded to whole planes and
satellites at evaluation.

Processor time, user and system, is printed beside wall time, since that of a shared machine says little.
"""

import argparse
import os
import resource
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from evaluate import DESIGN, evaluate_numba, inputs
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.core.problem import Problem
from pymoo.optimize import minimize

import navwalker as nw


class WithNumba(Problem):
    """The paper's search space and objectives, evaluated by numba."""

    def __init__(self, lower, upper):
        super().__init__(n_var=4, n_obj=2, xl=lower, xu=upper)
        self.inputs = inputs()
        self.pool = ThreadPoolExecutor(os.cpu_count())

    def objectives(self, x):
        planes, per_plane, inclination_deg, altitude_km = round(x[0]), round(x[1]), x[2], x[3]
        found = evaluate_numba(*self.inputs, (planes * per_plane, planes, 1, inclination_deg, altitude_km))
        return found["j_pos"], planes * per_plane / found["mean_visible"]

    def _evaluate(self, x, out, *_args, **_kwargs):
        out["F"] = np.array(list(self.pool.map(self.objectives, x)))


def processor_s(who):
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def fastest(function, repeats, who=resource.RUSAGE_SELF):
    """Least wall time and least processor time of some runs, s."""
    walls, processors = [], []
    for _ in range(repeats):
        processor, wall = processor_s(who), time.perf_counter()
        function()
        walls.append(time.perf_counter() - wall)
        processors.append(processor_s(who) - processor)
    return min(walls), min(processors)


def row(name, designs, seconds):
    wall, processor = (1e3 * one / designs for one in seconds)
    print(f"{name:44} {designs:5} designs  wall {wall:8.3f}  processor {processor:8.3f} ms each", flush=True)


def batches(scenario, arguments):
    """One design, and many, through the module and by the program."""
    inclinations = np.linspace(40, 60, arguments.designs)
    scenario.evaluate(DESIGN)
    alone = nw.Scenario("paper", threads=1)
    alone.evaluate(DESIGN)
    row("Python, one by one on one thread", 1, fastest(lambda: alone.evaluate(DESIGN), 20 * arguments.repeats))
    columns = {"planes": 13, "satellites_per_plane": 14, "altitude_km": 925, "phasing": 1, "inclination_deg": inclinations}
    row("Python, one batch", len(inclinations), fastest(lambda: scenario.evaluate(**columns), arguments.repeats))
    if arguments.navwalker:
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.writelines(f"delta:{inclination!r}:182/13/1@925\n" for inclination in inclinations.tolist())
            file.flush()
            command = [arguments.navwalker, "evaluate", "--quiet", "--designs", file.name, "--format", "csv"]
            run = lambda: subprocess.run(command, check=True, capture_output=True)
            seconds = fastest(run, arguments.repeats, resource.RUSAGE_CHILDREN)
        row("the program, set-up included", len(inclinations), seconds)


def searches(scenario, repeats):
    """pymoo on numba and on navwalker, and navwalker."""
    ours = scenario.problem()
    theirs = WithNumba(ours.xl[:4], ours.xu[:4])
    rng = np.random.default_rng(1)
    found = scenario.batch(rng.uniform(ours.xl, ours.xu, (8, ours.n_var)))
    np.testing.assert_allclose(theirs.evaluate(found["vectors"][:, :4]), found["objectives"], rtol=1e-6)
    search = lambda problem: minimize(problem, NSGA2(pop_size=30), ("n_gen", 30), seed=1)
    row("pymoo on numba", 900, fastest(lambda: search(theirs), max(repeats // 2, 1)))
    row("pymoo on navwalker", 900, fastest(lambda: search(ours), repeats))
    row("navwalker's search, files included", 900, fastest(lambda: scenario.optimize(seed=1), repeats))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--navwalker", help="the program to time beside")
    parser.add_argument("--designs", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    scenario = nw.Scenario("paper")
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    batches(scenario, arguments)
    searches(scenario, arguments.repeats)
    print(f"load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
