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
import resource
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

MODULES = ["evaluate", "dop", "visibility", "constellation", "orbit", "stats", "optimize"]
# Modules above these, which none of their tests needs.
ABOVE = ["search", "exchange", "scenario", "study", "validate", "run", "report", "cli"]
ROOT = Path(__file__).resolve().parent.parent
PLACE = ROOT / "target" / "mutants"
TREE = PLACE / "tree"
COMMIT = PLACE / "commit"
TESTS = PLACE / "tests.json"
RESULTS = PLACE / "results.jsonl"
# At level 0 a build takes as long, and whole days take minutes.
BUILD = ["cargo", "test", "--locked", "--lib", "--no-run", "--no-default-features", "--message-format=json"]
BUILD += [f"--config=profile.test.package.navwalker.{key}" for key in ("opt-level=1", "debug=0")]
# Processor seconds for a test, ten times what the slowest takes; a mutant may never end.
LIMIT_S = 100


def copy_of_commit():
    """Fills the tree: with the commit of an earlier run, of which it may hold a mutant, or the last one."""
    TREE.mkdir(parents=True, exist_ok=True)
    if not COMMIT.exists():
        COMMIT.write_bytes(subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout)
    command = ["git", "archive", COMMIT.read_text().strip()]
    archive = subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    # With the present time (-m), or Cargo would not build anew what was a mutant.
    subprocess.run(["tar", "-x", "-m", "-C", TREE], input=archive.stdout, check=True)
    root = TREE / "src" / "lib.rs"
    cut = re.sub(rf"^pub mod ({'|'.join(ABOVE)});", r"pub mod \1 {}", root.read_text(), flags=re.MULTILINE)
    root.write_text(cut)
    for file in (TREE / "src" / "formats").rglob("tests.rs"):
        file.write_text("")


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


def outcome(program, test):
    """What one test says of the tree as it is: caught, missed or timeout."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S))
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    status = subprocess.run([program, "--exact", test], cwd=TREE, preexec_fn=limit, **quiet).returncode
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return "timeout"
    # A test that ends the process, by an overflow of the stack, is as good as one that fails.
    return "caught" if status else "missed"


def tests_by_module():
    """The tests of each module, those first that end soonest; all must pass without a mutant."""
    if TESTS.exists():
        return json.loads(TESTS.read_text())
    program, seconds = build(), {}
    listed = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout
    for test in re.findall(rf"^((?:{'|'.join(MODULES)})::.*): test$", listed, flags=re.MULTILINE):
        began = time.monotonic()
        if outcome(program, test) != "missed":
            sys.exit(f"{test} fails as it is")
        seconds[test] = time.monotonic() - began
    soonest = sorted(seconds, key=seconds.get)
    tests = {module: [test for test in soonest if test.startswith(f"{module}::")] for module in MODULES}
    TESTS.write_text(json.dumps(tests, indent=2))
    return tests


def run(mutant, tests):
    """Plants a mutant, runs tests until one fails, and takes the mutant out again."""
    file = TREE / mutant["file"]
    source = file.read_text()
    file.write_text(planted(source, mutant))
    try:
        program = build()
        if program is None:
            return {"name": mutant["name"], "outcome": "unviable"}
        for test in tests:
            said = outcome(program, test)
            if said != "missed":
                return {"name": mutant["name"], "outcome": said, "by": test}
        return {"name": mutant["name"], "outcome": "missed"}
    finally:
        file.write_text(source)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--count", type=int, default=200)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--list", action="store_true", help="print the sample and end")
    chosen = arguments.parse_args()
    copy_of_commit()
    total, mutants = sample(chosen.count, chosen.seed)
    if chosen.list:
        print(*(mutant["name"] for mutant in mutants), sep="\n")
        return
    print(f"{len(mutants)} of {total} mutants", file=sys.stderr)
    known = RESULTS.read_text().splitlines() if RESULTS.exists() else []
    known = {result["name"]: result for result in map(json.loads, known)}
    tests = tests_by_module()
    for mutant in mutants:
        name = mutant["name"]
        if name not in known:
            known[name] = run(mutant, tests[Path(mutant["file"]).parts[1].removesuffix(".rs")])
            with RESULTS.open("a") as file:
                file.write(json.dumps(known[name]) + "\n")
    drawn = [known[mutant["name"]] for mutant in mutants]
    for result in drawn:
        if result["outcome"] not in ("caught", "unviable"):
            print(f"{result['outcome']}: {result['name']}")
    print(dict(Counter(result["outcome"] for result in drawn)))


if __name__ == "__main__":
    main()
