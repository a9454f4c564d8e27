#!/usr/bin/env python3
"""Mutation testing: small errors planted in the science, one at a time, that the tests of their own module must catch.

    python3 tests/mutants.py [--count 200] [--seed 1] [--list]

needs cargo-mutants 27 or later (`cargo install cargo-mutants --locked`). It draws a sample of the mutants of the modules
below, the same for a seed, and works in a copy of the last commit in target/mutants with a target directory of its own.
Results go to target/mutants/results.jsonl, one line for each mutant; what stands there is not run again, so that a run
goes on where it was stopped.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

MODULES = ["evaluate", "dop", "visibility", "constellation", "orbit", "stats", "optimize"]
ROOT = Path(__file__).resolve().parent.parent
PLACE = ROOT / "target" / "mutants"
TREE = PLACE / "tree"
RESULTS = PLACE / "results.jsonl"
# Seconds for a build or a run of tests; a mutant may never end.
TIMEOUT_S = 900


def module_of(file):
    """The module whose tests a source file belongs to."""
    return Path(file).parts[1].removesuffix(".rs")


def copy_of_last_commit():
    """Fills the tree, unless an earlier run has."""
    if TREE.exists():
        return
    TREE.mkdir(parents=True)
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True)
    subprocess.run(["tar", "-x", "-C", TREE], input=archive.stdout, check=True)


def cargo_mutants(*arguments, **options):
    environment = os.environ | {"CARGO_TARGET_DIR": str(PLACE / "build")}
    command = ["cargo", "mutants", "--dir", str(TREE), *arguments]
    return subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, **options)


def sample(count, seed):
    """The mutants in the order of a hash, so that the sample of another seed is another and a new mutant moves few."""
    files = [f"--file=src/{module}{end}" for module in MODULES for end in (".rs", "/**/*.rs")]
    listed = json.loads(cargo_mutants("--list", "--json", *files, check=True).stdout)
    listed = [mutant for mutant in listed if "/tests" not in mutant["file"] and "/testing" not in mutant["file"]]
    order = lambda mutant: hashlib.sha256(f"{seed} {mutant['name']}".encode()).digest()
    return len(listed), sorted(listed, key=order)[:count]


def run(mutant):
    """What the tests of its module say of a mutant: caught, missed, timeout or unviable."""
    output = PLACE / "one"
    cargo_mutants(
        "--in-place", "--baseline=skip", f"--timeout={TIMEOUT_S}", f"--build-timeout={TIMEOUT_S}",
        f"--output={output}", f"--file={mutant['file']}", f"--re=^{re.escape(mutant['name'])}$",
        "--", "--", f"{module_of(mutant['file'])}::",
        stderr=subprocess.DEVNULL,
    )
    outcomes = json.loads((output / "mutants.out" / "outcomes.json").read_text())
    kinds = [kind for kind in ("caught", "missed", "timeout", "unviable") if outcomes[kind]]
    return kinds[0] if len(kinds) == 1 else f"not run: {kinds}"


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
    known = {result["name"]: result["outcome"] for result in map(json.loads, known)}
    for mutant in mutants:
        name = mutant["name"]
        if name not in known:
            known[name] = run(mutant)
            with RESULTS.open("a") as file:
                file.write(json.dumps({"name": name, "outcome": known[name]}) + "\n")
    drawn = [(mutant["name"], known[mutant["name"]]) for mutant in mutants]
    for name, outcome in drawn:
        if outcome not in ("caught", "unviable"):
            print(f"{outcome}: {name}")
    print(dict(Counter(outcome for _, outcome in drawn)))


if __name__ == "__main__":
    main()
