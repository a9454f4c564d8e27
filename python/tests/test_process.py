"""Pickling, interruption and memory."""

import gc
import io
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import navwalker as nw
from navwalker._progress import ProgressLine


def test_pickles(small, design):
    scenario = pickle.loads(pickle.dumps(small))
    assert scenario == small
    hybrid = nw.Constellation("delta:53:6/3/1@1000", name="a").without("NW-P01")
    again = pickle.loads(pickle.dumps(hybrid))
    assert again == hybrid and again.out_of_service == ["NW-P01"] and again.name == "a"
    metrics = small.evaluate(design)
    assert pickle.loads(pickle.dumps(metrics)) == metrics


def test_processes(small, design):
    designs = [design, "star:90:182/13/1@925"]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(small.evaluate, designs))
    assert found == [small.evaluate(one) for one in designs]


def test_constellations_from_files_reach_other_processes(small, tmp_path, monkeypatch):
    """They go by the absolute paths of their files, also if they were read by relative ones."""
    nw.Constellation("delta:53:12/3/1@1000").export(tmp_path / "out", "tle", scenario=small)
    name = next((tmp_path / "out").glob("*.tle")).name
    monkeypatch.chdir(tmp_path / "out")
    read = nw.read(name, name="ours", exclude="NW-P01-S01").without("NW-P02-S01")
    monkeypatch.chdir(tmp_path)
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert pool.submit(small.evaluate, read).result() == small.evaluate(read)
    assert pickle.loads(pickle.dumps(read)) == read
    again = pickle.dumps(read)
    (tmp_path / "out" / name).unlink()
    with pytest.raises(nw.FileError, match=name):
        pickle.loads(again)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_processes_that_are_forked_off(small, design):
    """A process that is forked off has none of the threads of its parent, which evaluated before, and makes its own."""
    expected = small.evaluate(design)
    one = nw.Scenario("paper", time_step_s=1800, region_step_deg=20, threads=1)
    assert one.evaluate(design) == expected
    with get_context("fork").Pool(1) as pool:
        for scenario in (small, one):
            assert pool.apply_async(scenario.evaluate, (design,)).get(timeout=60) == expected
        found = pool.apply_async(nw.validate, ("delta:55:6/3/1@925", "analytic"), {"scenario": small}).get(timeout=60)
        assert found.passed
        pool.apply_async(nw.dop, ([0, 90, 180, 270, 0], [9, 9, 9, 9, 90])).get(timeout=60)


def test_threads_of_python(small, design):
    """Threads of Python share the threads of the engine, commands and objectives that evaluate again included."""
    expected = small.evaluate(design)
    one = nw.Scenario(
        "paper", time_step_s=1800, region_step_deg=20, threads=1, optimizer_population=4, optimizer_generations=2
    )

    def cost(table):
        return one.evaluate(table["notation"])["j_cost"]

    with ThreadPoolExecutor(8) as pool:
        metrics = [pool.submit(scenario.evaluate, design) for scenario in (small, one) * 8]
        checks = [pool.submit(nw.validate, "delta:55:6/3/1@925", "analytic", scenario=small) for _ in range(3)]
        runs = [pool.submit(one.optimize, objectives=["j-pos", cost]) for _ in range(2)]
        assert all(one.result(timeout=120) == expected for one in metrics)
        assert all(one.result(timeout=120).passed for one in checks)
        first, second = (one.result(timeout=120) for one in runs)
    np.testing.assert_array_equal(first.objectives, second.objectives)


def test_import():
    """The module takes less than 100 ms to import, and NumPy, which alone takes that, is imported where it is needed."""
    script = """
        import sys, time
        began = time.process_time()
        import navwalker
        assert "numpy" not in sys.modules
        print(time.process_time() - began)
    """
    command = [sys.executable, "-c", textwrap.dedent(script)]
    runs = [subprocess.run(command, check=True, capture_output=True, text=True) for _ in range(5)]
    assert min(float(run.stdout) for run in runs) < 0.1


INTERRUPTED = """
    import sys, threading
    import navwalker as nw
    scenario = nw.Scenario("paper", optimizer_generations=100_000)
    scenario.evaluate("delta:55:182/13/1@925")
    def cost(table):
        return table["satellites"]
    print("ready", flush=True)
    try:
        {work}
    except KeyboardInterrupt:
        print("interrupted", flush=True)
"""


@pytest.mark.parametrize(
    "work",
    [
        'scenario.evaluate(["delta:55:182/13/1@925"] * 100_000)',
        'scenario.evaluate(["delta:55:182/13/1@925"] * 100_000, progress=True)',
        "scenario.optimize(progress=True)",
        'scenario.optimize(objectives=["j-pos", cost], progress=True)',
    ],
)
def test_interrupt(work):
    """SIGINT during work of minutes raises KeyboardInterrupt within 0.2 s; three seconds cover a machine under load."""
    script = textwrap.dedent(INTERRUPTED).format(work=work)
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True}
    with subprocess.Popen([sys.executable, "-c", script], **pipes) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        assert time.monotonic() - began < 3.0
        process.kill()


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_progress(monkeypatch, design):
    """A terminal sees one line that is rewritten, whose last state is the end of the work; a file sees that alone."""
    scenario = nw.Scenario(
        "paper", time_step_s=1800, region_step_deg=20, optimizer_population=8, optimizer_generations=3
    )
    for stream in (Terminal(), io.StringIO()):
        monkeypatch.setattr(sys, "stderr", stream)
        scenario.evaluate([design] * 5, progress=True)
        scenario.optimize(progress=True)
        scenario.optimize(objectives=["satellites", lambda table: table["j_pos"]], progress=True)
        lines = [line.split("\r")[-1].rstrip() for line in stream.getvalue().rstrip("\n").split("\n")]
        assert lines[0] == "design 5/5"
        assert [line.split(", hyper")[0] for line in lines[1:]] == ["generation 3/3, 24 evaluations"] * 2
    monkeypatch.setattr(sys, "stderr", None)
    assert len(scenario.evaluate([design] * 2, progress=True)) == 2


def test_progress_line():
    line = ProgressLine("generation", terminal := Terminal())
    for step, hypervolume in ((0, None), (1, 0.123456789), (10, 0.5)):
        line(step, 10, 30 * step, hypervolume)
    line.close()
    longest = "generation 1/10, 30 evaluations, hypervolume 0.123457, ETA 0 s"
    last = "generation 10/10, 300 evaluations, hypervolume 0.5".ljust(len(longest)) + "\n"
    assert terminal.getvalue().split("\r") == ["", "generation 0/10", longest, last]


def resident_bytes():
    gc.collect()
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="it takes Linux to tell the resident memory")
def test_no_leak():
    """A hundred thousand calls, a quarter of each kind, keep the resident memory: what grows is below 160 bytes a call."""
    tiny = nw.Scenario("paper", time_duration_h=1, time_step_s=1800, region_step_deg=40, gnss_constellations=[])
    constellation = nw.Constellation("delta:55:6/3/1@925")
    sky = np.array([0.0, 120, 240, 0]), np.array([20.0, 20, 20, 90])

    def mistaken():
        with pytest.raises(nw.DesignError):
            nw.Constellation("delta:55:6/3/1@")

    calls = [
        lambda: tiny.evaluate(constellation),
        lambda: nw.dop(*sky),
        lambda: nw.Constellation("delta:55:6/3/1@925", name="one").without("NW-P01"),
        mistaken,
    ]
    for call in calls:
        for _ in range(2000):
            call()
        before = resident_bytes()
        for _ in range(25_000):
            call()
        assert resident_bytes() - before < 4_000_000
