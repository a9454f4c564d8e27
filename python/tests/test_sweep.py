"""Sweeps: the same bytes by every engine, whatever happens to their workers."""

import io
import json
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import navwalker as nw
from navwalker import _native

KEYS = {
    "search_planes": [3, 4],
    "search_satellites_per_plane": [3, 4],
    "search_inclination_step_deg": 5,
    "search_altitude_step_km": 200,
}
LIST = ["delta:55:182/13/1@925", "star:90:182/13/1@925", "delta:53:6/3/1@1000+star:90:4/2/1@1100"]


@pytest.fixture(scope="module")
def space() -> nw.Scenario:
    """A hundred designs or so of 48 instants and 12 points."""
    return nw.Scenario("paper", time_step_s=1800, region_step_deg=20, **KEYS)


@pytest.fixture(scope="module")
def expected(space, tmp_path_factory) -> nw.Sweep:
    """The sweep by the threads of this process."""
    return space.sweep(store=tmp_path_factory.mktemp("here") / "sweep", chunk=7)


def same(sweep, expected):
    assert sweep.sha256 == expected.sha256
    assert sweep.path.read_bytes() == expected.path.read_bytes()
    assert sweep.index == expected.index


def test_table(space, expected):
    """Its metrics are those of an evaluation, in the order of the space."""
    table = expected.table()
    assert len(table) == len(expected) == expected.designs > 50
    columns = ("planes", "satellites_per_plane", "inclination_deg", "altitude_km", "phasing")
    again = space.evaluate(**{name: table[name] for name in columns})
    for name in ("mean_visible", "mean_pdop", "j_cost", "coverage_4"):
        np.testing.assert_array_equal(table[name], again[name])


def test_program(space, expected, tmp_path):
    """The program and the module make the same store, and each goes on with that of the other."""
    sets = [part for one in space._overrides for part in ("--set", one)]
    common = [sys.executable, "-m", "navwalker", "sweep", "paper", *sets, "--chunk", "7", "--quiet", "--out"]
    subprocess.run([*common, str(tmp_path / "program")], check=True, capture_output=True)
    same(nw.Sweep(tmp_path / "program"), expected)
    (tmp_path / "program/index.json").unlink()
    chunk = next((tmp_path / "program/chunks").iterdir())
    before = chunk.read_bytes()
    chunk.unlink()
    same(space.sweep(store=tmp_path / "program", chunk=7), expected)
    assert chunk.read_bytes() == before


def test_list(space, tmp_path):
    named = nw.Constellation(LIST[0], name="ours")
    for form in ("csv", "parquet"):
        sweep = space.sweep([*LIST, named], store=tmp_path / form, format=form)
        table = sweep.table()
        assert sweep.path.name == f"table.{form}" and len(table) == 4
        assert [table["mean_pdop"][n] for n in range(3)] == [space.evaluate(one).mean_pdop for one in LIST]
        assert table["name"].tolist() == [None, None, None, "ours"]
        assert table["mean_pdop"][3] == table["mean_pdop"][0]


def test_executors(space, expected, tmp_path):
    with ThreadPoolExecutor(2) as pool:
        same(space.sweep(store=tmp_path / "threads", chunk=7, executor=pool), expected)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        same(space.sweep(store=tmp_path / "processes", chunk=7, executor=pool), expected)
    loky = pytest.importorskip("loky")
    with loky.ProcessPoolExecutor(2) as pool:
        same(space.sweep(store=tmp_path / "loky", chunk=7, executor=pool), expected)


def test_chunks_do_not_change_the_table(space, expected, tmp_path):
    assert space.sweep(store=tmp_path / "sweep", chunk=11).sha256 == expected.sha256


@pytest.fixture(scope="module")
def dask():
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        yield client


def test_dask(space, expected, dask, tmp_path):
    same(space.sweep(store=tmp_path / "sweep", chunk=7, executor=dask), expected)


def test_dask_worker_killed(dask, tmp_path):
    """A worker that is killed in the middle of a chunk: Dask gives its chunks to another."""
    # Chunks of a second, so that one is being evaluated at any time.
    slow = nw.Scenario("paper", time_step_s=120, **KEYS)
    here = slow.sweep(store=tmp_path / "here", chunk=25)
    store = tmp_path / "dask"
    pids = list(dask.run(os.getpid).values())

    def kill():
        while not list(store.glob("chunks/*.parquet")):
            time.sleep(0.01)
        os.kill(pids[0], signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    same(slow.sweep(store=store, chunk=25, executor=dask), here)
    killer.join()
    assert pids[0] not in dask.run(os.getpid).values()


class Failing:
    """An executor that fails with some error after so many chunks."""

    def __init__(self, good, error):
        self.good, self.error, self.done = good, error, 0

    def submit(self, work, /, *args):
        future = Future()
        if self.done == self.good:
            future.set_exception(self.error)
        else:
            self.done += 1
            future.set_result(work(*args))
        return future


def test_failure_says_what_is_missing_and_is_continued(space, expected, tmp_path):
    executor = Failing(3, OSError(28, "No space left on device"))
    with pytest.raises(nw.SweepError, match=r"chunk 4: OSError: .*No space left") as raised:
        space.sweep(store=tmp_path / "sweep", chunk=7, executor=executor)
    chunks = len(expected.index["chunks"])
    assert raised.value.missing == list(range(4, chunks + 1))
    assert f"{chunks - 3} of {chunks} chunks are missing" in str(raised.value)
    assert pickle.loads(pickle.dumps(raised.value)).missing == raised.value.missing
    with pytest.raises(nw.FileError, match="holds no merged sweep"):
        nw.Sweep(tmp_path / "sweep")
    rest = Failing(chunks - 3, AssertionError("no chunk is evaluated twice"))
    same(space.sweep(store=tmp_path / "sweep", chunk=7, executor=rest), expected)


def test_executors_that_do_not_work(space, tmp_path):
    with ThreadPoolExecutor(1) as pool:
        pass
    with pytest.raises(nw.SweepError, match="the executor takes no work: cannot schedule new futures after shutdown"):
        space.sweep(store=tmp_path / "sweep", executor=pool)
    with pytest.raises(nw.NavwalkerError, match="executor is a int, expected a Client of Dask or an executor"):
        space.sweep(store=tmp_path / "sweep", executor=3)
    missing = ModuleNotFoundError("No module named 'navwalker'", name="navwalker")
    with pytest.raises(nw.SweepError, match="a worker has no navwalker, or an older one: .*; install 0"):
        space.sweep(store=tmp_path / "sweep", executor=Failing(0, missing))


def test_dask_client_that_is_closed(space, dask, tmp_path):
    distributed = pytest.importorskip("distributed")
    client = distributed.Client(dask.scheduler.address)
    client.close()
    with pytest.raises(nw.SweepError, match="the client of Dask is closed, expected one that is running"):
        space.sweep(store=tmp_path / "sweep", executor=client)


def end_process(*_):
    os._exit(9)


class Ending:
    """An executor whose process ends in its third chunk."""

    def __init__(self, pool):
        self.pool, self.given = pool, 0
        self._max_workers = 1

    def submit(self, work, /, *args):
        self.given += 1
        return self.pool.submit(end_process if self.given == 3 else work, *args)


def test_process_that_ends(space, expected, tmp_path):
    """A pool of processes is broken by one that ends; another one goes on."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        with pytest.raises(nw.SweepError, match="the executor is broken, a process of it has ended"):
            space.sweep(store=tmp_path / "sweep", chunk=7, executor=Ending(pool))
    same(space.sweep(store=tmp_path / "sweep", chunk=7), expected)


def test_versions(space, tmp_path, monkeypatch):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        monkeypatch.setattr(_native, "__version__", "9.9.9")
        own = r"the client has navwalker 9\.9\.9 and the worker .*:\d+ has \d+\.\d+\.\d+; install one version on both"
        with pytest.raises(nw.NavwalkerError, match=own):
            space.sweep(store=tmp_path / "sweep", executor=pool)


def test_files_go_with_the_scenario(tmp_path):
    """A worker that does not see the files of a scenario evaluates what is in them."""
    sites = tmp_path / "sites.csv"
    sites.write_text("latitude_deg,longitude_deg\n10,20\n")
    scenario = nw.Scenario(f'region.points = "{sites}"\ntime.step-s = 3600\n')
    expected = [scenario.evaluate(one).mean_pdop for one in LIST]

    class Elsewhere(Failing):
        def submit(self, work, /, *args):
            sites.unlink(missing_ok=True)
            return super().submit(work, *args)

    sweep = scenario.sweep(LIST, store=tmp_path / "sweep", executor=Elsewhere(99, None))
    assert sweep.table()["mean_pdop"].tolist() == expected


def test_sweeps_that_are_large(tmp_path):
    large = nw.Scenario("paper", search_inclination_step_deg=1e-6)
    with pytest.raises(nw.FileError, match="the sweep would have .* designs and take .* h on one thread; more than 20000000"):
        large.sweep(store=tmp_path / "sweep")


def test_damaged_and_duplicate_chunks(space, expected, tmp_path):
    """A chunk that was cut short is computed again; one that comes twice is the same."""
    store = tmp_path / "sweep"
    space.sweep(store=store, chunk=7)
    first, second = sorted((store / "chunks").iterdir())[:2]
    whole = first.read_bytes()
    first.write_bytes(whole[:-20])
    second.write_bytes(whole)
    with pytest.warns(nw.NavwalkerWarning, match=r"chunk \d+: .*; it is computed again"):
        same(space.sweep(store=store, chunk=7), expected)
    assert first.read_bytes() == whole
    native = _native.begin_sweep(space._engine, str(store), None, 7, None, False, False)
    number = next(n for n in range(native.chunks) if native.chunk(n)[0] in first.name)
    native.put(number, whole)
    with pytest.raises(nw.FileError, match="cannot be used"):
        native.put((number + 1) % native.chunks, whole)
    with pytest.raises(nw.FileError, match="cannot be used"):
        native.put(number, whole[:-20])


def test_stores_of_others(space, expected, tmp_path):
    store = expected.directory
    other = space.replace(visibility_mask_deg=10)
    with pytest.raises(nw.FileError, match="holds another sweep: the scenario is another"):
        other.sweep(store=store, chunk=7)
    with pytest.raises(nw.FileError, match="holds another sweep: the designs are others"):
        space.sweep(LIST, store=store, chunk=7)
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(nw.FileError, match="holds something other than a sweep"):
        space.sweep(store=tmp_path)
    same(space.replace(optimizer_seed=7).sweep(store=store, chunk=7), expected)
    with pytest.raises(nw.NavwalkerError, match="there is no design to sweep"):
        space.sweep([], store=tmp_path / "sweep")
    with pytest.raises(nw.DesignError, match="delta:55:5/2/1@925"):
        space.sweep(["delta:55:5/2/1@925"], store=tmp_path / "sweep")
    with pytest.raises(nw.DesignError, match="a sweep is of designs"):
        space.sweep([nw.Constellation(LIST[0]).without("NW-P01")], store=tmp_path / "sweep")


INTERRUPTED = """
    import sys
    import navwalker as nw
    scenario = nw.Scenario("paper", time_step_s=120, **{keys})
    try:
        scenario.sweep(store=sys.argv[1], chunk=10, progress=True)
    except KeyboardInterrupt:
        print("interrupted", flush=True)
"""


def test_interrupt(tmp_path):
    """Ctrl-C leaves a store that is continued."""
    store = tmp_path / "sweep"
    script = textwrap.dedent(INTERRUPTED).replace("{keys}", repr(KEYS))
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True}
    with subprocess.Popen([sys.executable, "-c", script, str(store)], **pipes) as process:
        while not list(store.glob("chunks/*.parquet")):
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
    assert not (store / "index.json").exists()
    slow = nw.Scenario("paper", time_step_s=120, **KEYS)
    done = {file.name: file.stat().st_mtime_ns for file in store.glob("chunks/*.parquet")}
    sweep = slow.sweep(store=store, chunk=10)
    assert all((store / "chunks" / name).stat().st_mtime_ns == at for name, at in done.items())
    assert len(done) < len(sweep.index["chunks"])
    same(sweep, slow.sweep(store=tmp_path / "again", chunk=10))


def test_progress(space, expected, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "stderr", stream := io.StringIO())
    space.sweep(store=tmp_path / "sweep", chunk=7, progress=True)
    assert stream.getvalue() == f"design {expected.designs}/{expected.designs}\n"


def test_index_is_json(expected):
    with open(expected.directory / "index.json") as file:
        assert json.load(file) == expected.index
