"""What a sweep of 10^8 designs of `paper` takes on 1, 32 and 1024 cores: simulated from the times of chunks that were measured.

    python scaling.py --measure chunk_times.csv      # a tenth of 25 chunks on one thread
    python scaling.py chunk_times.csv                # the table

Measured is the processor time of a tenth of a chunk of the default size for each number of planes and of satellites in a plane, and what its client takes.
Each core takes the next chunk as soon as it has done one; a chunk takes the time of one of those that were measured, at random. One chunk of a hundred is a
straggler: it takes five times as long, as on a node that others use. One client hands out the chunks and puts away their results, one after the
other, and never more than three for each core are given out. A job array has no client: there each core takes every N-th chunk.
"""

import argparse
import csv
import heapq
import random
import resource
import tempfile
from collections import deque
from concurrent.futures import Future

# Designs in a chunk by the fixed model of the cost, in the middle of the space of `paper` (`navwalker sweep --status`).
DEFAULT, TENTH = 550, 10
DESIGNS = 10**8
CORES = (1, 32, 1024)
STRAGGLERS, LONGER = 0.01, 5.0
AHEAD = 3
SEED = 1


def processor_s():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


class Timed:
    """An executor that does the work at once and notes the processor time that it takes."""

    def __init__(self):
        self.times_s = []

    def submit(self, work, *arguments):
        began = processor_s()
        future = Future()
        future.set_result(work(*arguments))
        self.times_s.append(processor_s() - began)
        return future


def measure(path):
    """A tenth of a chunk for each number of planes and of satellites in a plane of the search space, and the client."""
    import navwalker as nw

    draw = random.Random(SEED)
    scenario = nw.Scenario("paper", threads=1)
    scenario.evaluate(scenario.reference_design)
    shapes = [(planes, each) for planes in range(11, 16) for each in range(11, 16)]
    size = DEFAULT // TENTH
    designs = [
        f"delta:{draw.uniform(40, 60):.3f}:{planes * each}/{planes}/1@{draw.uniform(400, 1000):.2f}"
        for planes, each in shapes
        for _ in range(size)
    ]
    timed = Timed()
    with tempfile.TemporaryDirectory() as place:
        began = processor_s()
        scenario.sweep(designs, store=f"{place}/sweep", executor=timed, chunk=size)
        client_s = (processor_s() - began - sum(timed.times_s)) / len(shapes)
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["satellites", "designs", "chunk_s", "client_s"])
        for (planes, each), chunk_s in zip(shapes, timed.times_s):
            writer.writerow([planes * each, DEFAULT, f"{TENTH * chunk_s:.3f}", f"{client_s:.5f}"])


def elapsed_with_client(times_s, cores, client_s):
    """The time until a client has put away all results."""
    given = min(AHEAD * cores, len(times_s))
    ready = deque((number + 1) * client_s for number in range(given))
    client = given * client_s
    done, idle, next_time = [], [0.0] * cores, iter(times_s)

    def begin():
        while ready and idle:
            start = max(heapq.heappop(idle), ready.popleft())
            heapq.heappush(done, start + next(next_time))

    begin()
    while done:
        at = heapq.heappop(done)
        heapq.heappush(idle, at)
        client = max(client, at) + client_s
        if given < len(times_s):
            given += 1
            client += client_s
            ready.append(client)
        begin()
    return client


def elapsed_of_array(times_s, cores):
    """The time until the last of the cores has done its part."""
    return max(sum(times_s[core::cores]) for core in range(cores))


def shown(seconds):
    for unit, length in (("days", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 2 * length:
            return f"{seconds / length:.1f} {unit}"
    return f"{seconds:.0f} s"


def table(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    measured = [float(row["chunk_s"]) for row in rows]
    client_s = float(rows[0]["client_s"])
    draw = random.Random(SEED)
    chunks = -(-DESIGNS // int(rows[0]["designs"]))
    times_s = [
        draw.choice(measured) * (LONGER if draw.random() < STRAGGLERS else 1.0) for _ in range(chunks)
    ]
    work_s = sum(times_s)
    print(f"{len(measured)} chunks measured: {min(measured):.2f} to {max(measured):.2f} s, {1e3 * client_s:.1f} ms of the client each")
    print(f"{DESIGNS:.0e} designs in {chunks} chunks, {shown(work_s)} of one core with stragglers")
    print("| cores | with a client | of the work | job array | of the work |\n| ---: | ---: | ---: | ---: | ---: |")
    for cores in CORES:
        with_client, of_array = elapsed_with_client(times_s, cores, client_s / 2), elapsed_of_array(times_s, cores)
        shares = [f"{work_s / cores / elapsed_s:.1%}" for elapsed_s in (with_client, of_array)]
        print(f"| {cores} | {shown(with_client)} | {shares[0]} | {shown(of_array)} | {shares[1]} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--measure", action="store_true", help="measure the chunks, and write their times to the file")
    parser.add_argument("file", help="times of chunks")
    arguments = parser.parse_args()
    (measure if arguments.measure else table)(arguments.file)


if __name__ == "__main__":
    main()
