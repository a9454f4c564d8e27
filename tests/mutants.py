#!/usr/bin/env python3
"""Mutation testing: small errors planted in the science, one at a time, that the tests of their own module must catch.

    python3 tests/mutants.py [--count 200] [--seed 1] [--list]

draws a sample of the mutants of the modules below, the same for a seed. cargo-mutants 27 or later lists them
(`cargo install cargo-mutants --locked`); they are planted here, in a copy of the last commit in target/mutants, cut to
what these modules and their tests need. A build then takes seconds, and a run of tests stops at the first that fails.
Results go to target/mutants/results.jsonl, one line for each mutant: what stands there is not run again, so that a run
goes on where it was stopped. Remove target/mutants to begin with another commit.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

MODULES = ["evaluate", "dop", "visibility", "constellation", "orbit", "stats", "optimize"]
# Modules above these, which none of their tests needs.
ABOVE = ["search", "exchange", "scenario", "study", "validate", "run", "report", "cli"]
ROOT = Path(__file__).resolve().parent.parent
PLACE = ROOT / "target" / "mutants"
TREE = PLACE / "tree"
RESULTS = PLACE / "results.jsonl"
# At level 0 a build takes as long, and whole days take minutes.
BUILD = ["cargo", "test", "--locked", "--lib", "--no-run", "--no-default-features", "--message-format=json"]
BUILD += [f"--config=profile.test.package.navwalker.{key}" for key in ("opt-level=1", "debug=0")]
# Seconds for a run of tests; a mutant may never end.
TIMEOUT_S = 300


def copy_of_last_commit():
    """Fills the tree, unless an earlier run has."""
    if TREE.exists():
        return
    TREE.mkdir(parents=True)
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True)
    subprocess.run(["tar", "-x", "-C", TREE], input=archive.stdout, check=True)
    root = TREE / "src" / "lib.rs"
    cut = re.sub(rf"^pub mod ({'|'.join(ABOVE)});", "", root.read_text(), flags=re.MULTILINE)
    root.write_text(cut)


def sample(count, seed):
    """The mutants in the order of a hash: another seed draws another sample."""
    files = [f"--file=src/{module}{end}" for module in MODULES for end in (".rs", "/**/*.rs")]
    command = ["cargo", "mutants", "--dir", str(TREE), "--list", "--json", *files]
    listed = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    listed = [mutant for mutant in listed if "/tests" not in mutant["file"] and "/testing" not in mutant["file"]]
    order = lambda mutant: hashlib.sha256(f"{seed} {mutant['name']}".encode()).digest()
    return len(listed), sorted(listed, key=order)[:count]


def planted(source, mutant):
    """The source with the span of a mutant replaced; columns count characters from 1."""
    lines = source.split("\n")
    start, end = mutant["span"]["start"], mutant["span"]["end"]
    before = lines[: start["line"] - 1] + [lines[start["line"] - 1][: start["column"] - 1]]
    after = [lines[end["line"] - 1][end["column"] - 1 :]] + lines[end["line"] :]
    return "\n".join(before) + mutant["replacement"] + "\n".join(after)


def build():
    """The program of the tests, or nothing if it does not compile."""
    environment = os.environ | {"CARGO_TARGET_DIR": str(PLACE / "build")}
    built = subprocess.run(BUILD, cwd=TREE, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    messages = [json.loads(line) for line in built.stdout.splitlines() if line.startswith("{")]
    programs = [message["executable"] for message in messages if message.get("executable")]
    return programs[-1] if built.returncode == 0 else None


def verdict(program, module):
    """What the tests of a module say: caught with the first that failed, missed, or timeout."""
    names = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout.splitlines()
    names = [name.removesuffix(": test") for name in names if name.startswith(f"{module}::") and name.endswith(": test")]
    running = subprocess.Popen([program, "--exact", *names], cwd=TREE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    late = threading.Timer(TIMEOUT_S, running.kill)
    late.start()
    failed = next((line.split()[1] for line in running.stdout if line.startswith("test ") and line.endswith("FAILED\n")), None)
    if failed:
        running.kill()
    running.stdout.read()
    status, is_late = running.wait(), not late.is_alive()
    late.cancel()
    if failed:
        return "caught", failed
    if is_late:
        return "timeout", None
    # A test that ends the process (an overflow of the stack) is as good as one that fails.
    return ("missed", None) if status == 0 else ("caught", f"status {status}")


def run(mutant):
    """Plants a mutant, runs the tests of its module, and takes it out again."""
    file = TREE / mutant["file"]
    source = file.read_text()
    began = time.monotonic()
    file.write_text(planted(source, mutant))
    try:
        program = build()
        built = time.monotonic()
        outcome, by = verdict(program, Path(mutant["file"]).parts[1].removesuffix(".rs")) if program else ("unviable", None)
    finally:
        file.write_text(source)
    seconds = {"build_s": round(built - began, 1), "test_s": round(time.monotonic() - built, 1)}
    return {"name": mutant["name"], "outcome": outcome, "by": by} | seconds


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--count", type=int, default=200)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--list", action="store_true", help="print the sample and end")
    chosen = arguments.parse_args()
    copy_of_last_commit()
    total, mutants = sample(chosen.count, chosen.seed)
    if chosen.list:
        print(*(mutant["name"] for mutant in mutants), sep="\n")
        return
    print(f"{len(mutants)} of {total} mutants", file=sys.stderr)
    known = RESULTS.read_text().splitlines() if RESULTS.exists() else []
    known = {result["name"]: result for result in map(json.loads, known)}
    program = build()
    assert program and all(verdict(program, module) == ("missed", None) for module in MODULES), "the tests fail as they are"
    for mutant in mutants:
        name = mutant["name"]
        if name not in known:
            known[name] = run(mutant)
            with RESULTS.open("a") as file:
                file.write(json.dumps(known[name]) + "\n")
    drawn = [known[mutant["name"]] for mutant in mutants]
    for result in drawn:
        if result["outcome"] not in ("caught", "unviable"):
            print(f"{result['outcome']}: {result['name']}")
    print(dict(Counter(result["outcome"] for result in drawn)))


if __name__ == "__main__":
    main()
