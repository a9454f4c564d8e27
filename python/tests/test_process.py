"""Pickling, interruption and memory."""

import pickle
import resource
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import navwalker as nw


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


def test_interrupt_ends_a_batch():
    """SIGINT during a batch of minutes raises KeyboardInterrupt within 0.2 s; a second covers a loaded machine."""
    script = """
        import navwalker as nw
        scenario = nw.Scenario("paper")
        scenario.evaluate("delta:55:182/13/1@925")
        print("ready", flush=True)
        try:
            scenario.evaluate(["delta:55:182/13/1@925"] * 100_000)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
    """
    with subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        assert time.monotonic() - began < 1.0
        process.kill()


def test_no_leak(small):
    """Ten thousand small calls keep the resident memory within 20 MB."""
    constellation = nw.Constellation("delta:55:6/3/1@925")
    tiny = nw.Scenario("paper", time_duration_h=1, time_step_s=1800, region_step_deg=40)
    tiny.evaluate(constellation)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(10_000):
        tiny.evaluate(constellation)
        nw.Constellation("delta:55:6/3/1@925").without("NW-P01")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000
