#!/usr/bin/env python3
"""Kills navwalker at each system call that changes a file, and looks at what is left.

usage: tests/kill_injection.py [--program PATH] [--jobs N] [--most N] [--seed N] [CASE...]

Each case runs one command under `strace --inject=CALL:signal=KILL:when=N`, for every system call that
changes a file and N = 1, 2, ... until the command ends by itself. strace counts the calls of each thread
by themselves, so this is done twice: over all threads, where the first that gets to N is killed, and in
the main thread alone. Of a system call that is made more than `--most` times, that many are drawn, one
from each of as many equal parts of the command, the same for a seed. After each kill:

- every result is the old one or the new one, whole, by the SHA-256 of its files;
- the next start ends with status 0 and leaves exactly what an uninterrupted command leaves: the same
  bytes, no staged file, no mark of a process.

Needs strace and Linux. Prints one line a case; exits with 1 if anything is wrong.
"""

import argparse
import hashlib
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

# Those that can change a file, a name or a directory; flock, since what is unlocked counts as stale.
CALLS = """openat open creat write writev pwrite64 rename renameat renameat2 unlink unlinkat rmdir mkdir mkdirat
link linkat symlink symlinkat ftruncate truncate fsync fdatasync fchmod chmod copy_file_range sendfile flock""".split()

SMALL = """--set region.step-deg=30 --set time.step-s=14400 --set optimizer.population=4
--set search.planes=[3,4] --set search.satellites-per-plane=[3,4] --set search.inclination-step-deg=20
--set search.altitude-step-km=600""".split()
OPTIMIZE = ["optimize", "--out", "run", *SMALL]


def generations(count):
    return ["--set", f"optimizer.generations={count}"]


@dataclass
class Case:
    """A command under fire."""

    name: str
    command: list
    # The commands that make what is there before.
    before: list = field(default_factory=list)
    # The next start, if it is not the command itself.
    then: list = None
    # The results: each pattern of paths is one, old or new as a whole; others may be of the work.
    results: list = field(default_factory=list)
    # Whether old results may be gone before the new ones are there, because that was asked for.
    may_be_gone: bool = False


RUN = ["front.json", "front.csv", "history.json", "history.csv", "scenario.toml", "run.json"]
TABLES = [["run/seeds.csv"], ["run/seeds.json"], ["run/joint-front.csv"]]


def run_in(place):
    return [f"{place}/{name}" for name in RUN]


EXPORT = ["export", "--as", "tle,oem,csv", "--set", "time.step-s=14400", "--out", "out", "--design"]
VALIDATE = ["validate", "--run", "run", "--against", "geographiclib", "--out", "run/validation"]
SERIES = ["evaluate", *SMALL[:4], "--series", "out", "--design"]
PLOT = ["plot", "run", "--figure", "pareto", "--out", "run/figures/pareto.svg"]
FINISHED = [[*OPTIMIZE, *generations(3)]]

# What is repeated or resumed has two generations more than before: of one more, the state before the last is the last
# of before, which holds the number of generations of its own command.
CASES = [
    Case("optimize", [*OPTIMIZE, *generations(3)], then=["--resume"], results=[run_in("run")]),
    Case(
        "optimize, repeated",
        [*OPTIMIZE, *generations(5)],
        before=FINISHED,
        then=["--resume"],
        results=[run_in("run")],
    ),
    Case(
        "optimize, fewer generations",
        [*OPTIMIZE, *generations(2)],
        before=FINISHED,
        then=[],
        results=[run_in("run")],
    ),
    Case(
        "optimize, resumed",
        [*OPTIMIZE, *generations(5), "--resume"],
        before=FINISHED,
        results=[run_in("run")],
    ),
    Case(
        "optimize, another seed by force",
        [*OPTIMIZE, *generations(3), "--seed", "2", "--force"],
        before=FINISHED,
        results=[run_in("run")],
        may_be_gone=True,
    ),
    Case(
        "seeds",
        [*OPTIMIZE, *generations(2), "--seeds", "2"],
        then=["--resume"],
        results=[run_in("run/seed-1"), run_in("run/seed-2"), *TABLES],
    ),
    Case(
        "seeds, repeated",
        [*OPTIMIZE, *generations(4), "--seeds", "2"],
        before=[[*OPTIMIZE, *generations(2), "--seeds", "2"]],
        then=["--resume"],
        results=[run_in("run/seed-1"), run_in("run/seed-2"), *TABLES],
    ),
    Case(
        "certify",
        [*OPTIMIZE, *generations(2), "--certify"],
        then=["--resume"],
        results=[run_in("run"), run_in("run-sweep")],
    ),
    Case(
        "certify, repeated",
        [*OPTIMIZE, *generations(4), "--certify"],
        before=[[*OPTIMIZE, *generations(2), "--certify"]],
        then=["--resume"],
        results=[run_in("run"), run_in("run-sweep")],
    ),
    Case("export", [*EXPORT, "delta:55:4/2/1@925"], then=["--force"], results=[["out"]]),
    Case(
        "export, by force",
        [*EXPORT, "delta:55:4/2/1@925", "--force"],
        before=[[*EXPORT, "delta:60:6/2/1@900"]],
        results=[["out"]],
    ),
    Case("report", ["report", "run"], before=FINISHED, results=[["run/report.html"]]),
    Case(
        "report, replaced",
        ["report", "run", "--design", "delta:55:4/2/1@925"],
        before=[*FINISHED, ["report", "run"]],
        results=[["run/report.html"]],
    ),
    Case(
        "plot",
        PLOT,
        before=FINISHED,
        results=[["run/figures/pareto.svg"], ["run/figures/pareto.csv"]],
    ),
    Case(
        "plot, replaced",
        [*PLOT, "--design", "delta:55:4/2/1@925", "--force"],
        before=[*FINISHED, PLOT],
        results=[["run/figures/pareto.svg"], ["run/figures/pareto.csv"]],
    ),
    Case("validate", VALIDATE, before=FINISHED, then=["--force"], results=[["run/validation"]]),
    Case(
        "validate, by force",
        [*VALIDATE, "--pick", "1", "--format", "json", "--force"],
        before=[*FINISHED, [*VALIDATE, "--pick", "1", "--set", "region.step-deg=20"]],
        results=[["run/validation"]],
    ),
    Case(
        "sweep",
        ["sweep", "--out", "store", "--chunk", "3", *SMALL],
        then=["--resume"],
        results=[["store/table.parquet"], ["store/index.json"]],
    ),
    Case("evaluate --series", [*SERIES, "delta:55:4/2/1@925"], then=["--force"], results=[["out"]]),
    Case(
        "evaluate --series, by force",
        [*SERIES, "delta:55:4/2/1@925", "--force"],
        before=[[*SERIES, "delta:60:6/2/1@900"]],
        results=[["out"]],
    ),
]


def is_transient(name):
    """Whether a name is that of a staged file, or the mark of a process."""
    return name == ".lock" or bool(re.fullmatch(r"\..*\.navwalker-(old|[A-Za-z0-9]{12})", name))


def tree(place, transient=False):
    """The checksum of each file below a place, and each directory."""
    found = {}
    for directory, directories, files in os.walk(place):
        if not transient:
            directories[:] = [name for name in directories if not is_transient(name)]
            files = [name for name in files if not is_transient(name)]
        for name in directories:
            found[os.path.relpath(os.path.join(directory, name), place)] = "directory"
        for name in files:
            path = os.path.join(directory, name)
            digest = hashlib.sha256(Path(path).read_bytes()).hexdigest()
            found[os.path.relpath(path, place)] = digest
    return found


def part(of, result):
    """The part of a tree that is one result: its paths, and what is below them."""
    prefixes = tuple(f"{path}/" for path in result)
    return {path: sum for path, sum in of.items() if path in result or path.startswith(prefixes)}


class Fire:
    """Runs the cases with one program."""

    def __init__(self, program, work, limit, seed):
        self.program = str(program)
        self.work = Path(work)
        self.limit = limit
        self.seed = seed

    def call(self, arguments):
        return [self.program, *arguments, "--threads", "1", "--quiet"]

    def run(self, place, command):
        return subprocess.run(command, cwd=place, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def must(self, place, arguments):
        ran = self.run(place, self.call(arguments))
        if ran.returncode != 0:
            raise RuntimeError(f"{' '.join(arguments)}: status {ran.returncode}\n{ran.stderr}")

    def case(self, case):
        """The kills of a case, and what is wrong."""
        base = Path(tempfile.mkdtemp(dir=self.work))
        old = base / "old"
        old.mkdir()
        for arguments in case.before:
            self.must(old, arguments)
        new = base / "new"
        shutil.copytree(old, new)
        log = base / "log"
        traced = ["strace", "-f", "-qq", "-o", str(log), "-e", "trace=" + ",".join(CALLS)]
        ran = self.run(new, traced + self.call(case.command))
        if ran.returncode != 0:
            raise RuntimeError(f"{case.name}: status {ran.returncode}\n{ran.stderr}")
        before, after = tree(old, transient=True), tree(new, transient=True)
        for result in case.results:
            if case.before and part(before, result) == part(after, result):
                print(f"  note: {case.name}: {result[0]} is the same before and after")
        used = {}
        for line in log.read_text().splitlines():
            found = re.match(r"(\d+)\s+(\w+)\((.*)", line)
            if found:
                thread, call, rest = found.groups()
                used.setdefault(call, {}).setdefault(thread, []).append(rest)
        kills, wrong = 0, []
        for call, follow in [(call, follow) for call in sorted(used) for follow in (["-f"], [])]:
            for number in self.numbers(case, call, used[call]):
                place = base / "place"
                shutil.copytree(old, place)
                injected = [*follow, "-e", f"trace={call}", "-e", f"inject={call}:signal=KILL:when={number}"]
                killed = self.kill(place, injected, case, before, after, wrong)
                shutil.rmtree(place)
                kills += killed
                if not killed and (not follow or number > self.most(used[call])):
                    break
        shutil.rmtree(base)
        return kills, wrong

    @staticmethod
    def most(threads):
        """The most calls of one thread."""
        return max(len(lines) for lines in threads.values())

    def numbers(self, case, call, threads):
        """Which calls to kill at: those of `openat` only that can create a file, and a sample of many."""
        most = self.most(threads)
        numbers = range(1, most + 1)
        if call == "openat":
            creating = {
                number
                for lines in threads.values()
                for number, rest in enumerate(lines, 1)
                if "O_CREAT" in rest or "O_WRONLY" in rest or "O_RDWR" in rest
            }
            numbers = sorted(creating)
        if len(numbers) > self.limit:
            drawn = random.Random(f"{self.seed} {case.name} {call}")
            bounds = [part * len(numbers) // self.limit for part in range(self.limit + 1)]
            numbers = [drawn.choice(numbers[start:end]) for start, end in zip(bounds, bounds[1:])]
        yield from numbers
        # Threads share the calls in another way each time.
        yield from range(most + 1, most + (2 if call == "openat" else 50))

    def kill(self, place, injected, case, before, after, wrong):
        """One kill; whether the program was killed."""
        strace = ["strace", "-qq", "-o", "/dev/null", *injected]
        ran = self.run(place, strace + self.call(case.command))
        where = f"{case.name}, {' '.join(injected)}"
        left = tree(place)
        if ran.returncode == 0:
            if left != after:
                wrong.append(f"{where}: it ended, but with other files: {differing(left, after)}")
            return False
        for result in case.results:
            found = part(left, result)
            allowed = [part(before, result), part(after, result)]
            # What a run begins with comes before any result.
            begun = {path: sum for path, sum in found.items() if not re.search("front|history", path)}
            is_begun = found == begun and (case.may_be_gone or not allowed[0])
            if found not in allowed and not is_begun:
                wrong.append(f"{where}: {result[0]} is neither old nor new: {differing(found, allowed[1])}")
        again = self.run(place, self.call(case.command + (case.then or [])))
        if again.returncode != 0:
            wrong.append(f"{where}: the next start: status {again.returncode}: {again.stderr}")
        left = tree(place, transient=True)
        if left != after:
            wrong.append(f"{where}: the next start left other files: {differing(left, after)}")
        return True


def differing(one, other):
    paths = {path for path in one.keys() | other.keys() if one.get(path) != other.get(path)}
    return ", ".join(sorted(paths))


def main():
    root = Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=root / "target/debug/navwalker", type=Path)
    parser.add_argument("--jobs", default=os.cpu_count(), type=int)
    parser.add_argument("--most", default=20, type=int, help="kills at one system call of a case, in each way")
    parser.add_argument("--seed", default=1, type=int, help="of the sample of system calls")
    parser.add_argument("cases", nargs="*", metavar="CASE", help="beginning of the name of a case")
    arguments = parser.parse_args()
    chosen = [
        case
        for case in CASES
        if not arguments.cases or any(case.name.startswith(name) for name in arguments.cases)
    ]
    if not chosen:
        parser.error("no such case")
    failed = 0
    with tempfile.TemporaryDirectory() as work, ThreadPoolExecutor(arguments.jobs) as pool:
        fire = Fire(arguments.program.resolve(), work, arguments.most, arguments.seed)
        total = 0
        for case, (kills, wrong) in zip(chosen, pool.map(fire.case, chosen)):
            print(f"{case.name}: {kills} kills, {len(wrong)} wrong", flush=True)
            for line in wrong[:10]:
                print(f"  {line}")
            failed += len(wrong)
            total += kills
    print(f"{total} kills, {failed} wrong")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
