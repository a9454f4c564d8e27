#!/usr/bin/env python3
"""Mutation testing: small errors planted in the science, one at a time, that the tests of their own module must catch.

    python3 tests/mutants.py [--count 200] [--seed 1] [--list]

draws a sample of the mutants of the modules below, the same for a seed. cargo-mutants 27 or later lists them
(`cargo install cargo-mutants --locked`). All are planted at once in a copy of the last commit in target/mutants, cut to
what these modules and their tests need, each behind a switch that compares its number with the variable NAVWALKER_MUTANT:
one build serves them all. A run without a mutant tells which tests meet which switch; of these, a mutant is run against one
after the other until one fails. Where an expression ends is told by
tree-sitter (`pip install tree-sitter tree-sitter-rust`). A mutant that does not compile behind its switch is built alone.
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

import tree_sitter
import tree_sitter_rust

MODULES = ["evaluate", "dop", "visibility", "constellation", "orbit", "stats", "optimize"]
# Modules above these, which none of their tests needs.
ABOVE = ["search", "exchange", "scenario", "study", "validate", "run", "report", "cli"]
ROOT = Path(__file__).resolve().parent.parent
PLACE = ROOT / "target" / "mutants"
TREE = PLACE / "tree"
COMMIT = PLACE / "commit"
RESULTS = PLACE / "results.jsonl"
# At level 0 whole days take minutes.
BUILD = ["cargo", "test", "--locked", "--lib", "--no-run", "--no-default-features", "--message-format=json"]
BUILD += [f"--config=profile.test.package.navwalker.{key}" for key in ("opt-level=1", "debug=0")]
# Processor seconds for a test, ten times what the slowest takes; a mutant may never end. Twelve times that on the clock.
LIMIT_S = 100
VARIABLE = "NAVWALKER_MUTANT"
SWITCH = """//! The switch of each mutant that is planted. Without a number, the first time that each switch is met is told.

use std::io::Write;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

static PLANTED: LazyLock<Option<u32>> = LazyLock::new(|| std::env::var("VARIABLE").ok()?.parse().ok());
static MET: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];

#[inline(always)]
pub(crate) fn on(number: u32) -> bool {
    match *PLANTED {
        Some(planted) => planted == number,
        None => tell(number),
    }
}

#[inline(never)]
fn tell(number: u32) -> bool {
    let met = &MET[number as usize];
    if !met.load(Relaxed) && !met.swap(true, Relaxed) {
        let _ = writeln!(std::io::stderr(), "met mutant {number}");
    }
    false
}
"""
PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language()))


def copy_of_commit():
    """Fills the tree: with the commit of an earlier run, of which it may hold mutants, or the last one."""
    TREE.mkdir(parents=True, exist_ok=True)
    if not COMMIT.exists():
        COMMIT.write_bytes(subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout)
    command = ["git", "archive", COMMIT.read_text().strip()]
    archive = subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    # With the present time (-m), or Cargo would not build anew what was a mutant.
    subprocess.run(["tar", "-x", "-m", "-C", TREE], input=archive.stdout, check=True)
    root = TREE / "src" / "lib.rs"
    cut = re.sub(rf"^pub mod ({'|'.join(ABOVE)});", r"pub mod \1 {}", root.read_text(), flags=re.MULTILINE)
    root.write_text(cut + "\nmod mutant;\n")
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


class Planting:
    """What a mutant changes, in bytes of its file: from `start` to `end` stands `mutated` instead. An operator keeps its
    operands."""

    def __init__(self, number, mutant, source, tree):
        self.number, self.file, self.genre = number, mutant["file"], mutant["genre"]
        self.start, self.end = (offset(source, mutant["span"][end]) for end in ("start", "end"))
        self.mutated = mutant["replacement"].encode()
        node = tree.root_node.descendant_for_byte_range(self.start, self.start + 1)
        on, name = b"crate::mutant::on(%d)" % number, b""
        if self.genre in ("BinaryOperator", "UnaryOperator") and node.parent.type != "let_chain":
            self.widen(source, node.parent)
        elif self.genre == "StructField":
            name = self.take_from_base(node)
        if node.parent.type == "let_chain":
            # Its parts are conditions and bindings, no expression.
            self.switch = None
        elif self.genre == "FnValue":
            self.switch = b"if %s { return %s; } " % (on, self.mutated), b""
        elif self.genre == "MatchArm":
            self.close(source, node, on)
        else:
            self.switch = b"%s(if %s { %s } else { " % (name, on, self.mutated), b" })"
        self.mutated = name + self.mutated

    def widen(self, source, expression):
        """From the operator to its expression."""
        whole = source[expression.start_byte : self.start] + self.mutated + source[self.end : expression.end_byte]
        self.start, self.end, self.mutated = expression.start_byte, expression.end_byte, whole

    def take_from_base(self, node):
        """A field that is deleted is that of the base. What a shorthand lacks before its value."""
        while not node.type.endswith("field_initializer"):
            node = node.parent
        base = next(other for other in node.parent.children if other.type == "base_field_initializer")
        name = node.child_by_field_name("field") or node
        value = node.child_by_field_name("value") or node
        self.start, self.end = value.start_byte, value.end_byte
        self.mutated = b"(%s).%s" % (base.named_children[0].text, name.text)
        return name.text + b": " if name == value else b""

    def close(self, source, node, on):
        """An arm that is deleted is one whose guard is false."""
        while node.type != "match_arm":
            node = node.parent
        pattern = node.child_by_field_name("pattern")
        condition = pattern.child_by_field_name("condition")
        self.start, self.end = (condition or pattern).start_byte, pattern.end_byte
        self.mutated = b"false" if condition else source[self.start : self.end] + b" if false"
        self.switch = (b"!%s && (" % on, b")") if condition else (b"", b" if !%s" % on)

    def alone(self, source):
        """The source with this mutant only."""
        return source[: self.start] + self.mutated + source[self.end :]


def offset(source, place):
    """The byte at a line and a column, which counts characters; both from 1."""
    lines = source.split(b"\n")[: place["line"]]
    return sum(len(line) + 1 for line in lines[:-1]) + len(lines[-1].decode()[: place["column"] - 1].encode())


def switched(source, plantings):
    """The source with each mutant behind its switch, and where in it each one is."""
    outer_first = sorted(plantings, key=lambda one: (one.start, -one.end, one.genre != "FnValue", one.number))
    # What ends at a byte comes before what begins there.
    texts = [(one.end, 0, -place, one.switch[1], one.number) for place, one in enumerate(outer_first)]
    texts += [(one.start, 1, place, one.switch[0], one.number) for place, one in enumerate(outer_first)]
    result, done, spans = b"", 0, {}
    for at, _, _, text, number in sorted(texts):
        result, done = result + source[done:at], at
        begin = spans.get(number, (len(result), 0))[0]
        result += text
        spans[number] = (begin, len(result))
    return result + source[done:], spans


def build():
    """The program of the tests, or nothing if it does not compile; and the places of the errors."""
    environment = os.environ | {"CARGO_TARGET_DIR": str(PLACE / "build")}
    built = subprocess.run(BUILD, cwd=TREE, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    messages = [json.loads(line) for line in built.stdout.splitlines() if line.startswith("{")]
    programs = [message["executable"] for message in messages if message.get("executable")]
    errors = [message["message"] for message in messages if message.get("message", {}).get("level") == "error"]
    places = [(span["file_name"], span["byte_start"], error["rendered"])
              for error in errors for span in error["spans"] if span["is_primary"]]
    return programs[-1] if built.returncode == 0 else None, places


def planted(mutants):
    """The plantings by number, and the sources as they are."""
    sources = {file: (TREE / file).read_bytes() for file in {mutant["file"] for mutant in mutants}}
    trees = {file: PARSER.parse(source) for file, source in sources.items()}
    plantings = {number: Planting(number, mutant, sources[mutant["file"]], trees[mutant["file"]])
                 for number, mutant in enumerate(mutants, 1)}
    return plantings, sources


def build_switched(plantings, sources):
    """The program with a switch for each mutant that compiles so, and the numbers of these."""
    left = {number: planting for number, planting in plantings.items() if planting.switch}
    switch = SWITCH.replace("VARIABLE", VARIABLE).replace("COUNT", str(len(plantings) + 1))
    (TREE / "src" / "mutant.rs").write_text(switch)
    while True:
        spans = {}
        for file, source in sources.items():
            text, spans[file] = switched(source, [one for one in left.values() if one.file == file])
            if (TREE / file).read_bytes() != text:
                (TREE / file).write_bytes(text)
        program, errors = build()
        if program:
            return program, set(left)
        for file, at, rendered in errors:
            around = [(end - begin, number) for number, (begin, end) in spans.get(file, {}).items() if begin <= at < end]
            if not around:
                sys.exit(f"an error outside all mutants:\n{rendered}")
            left.pop(min(around)[1], None)
        print(f"{len(plantings) - len(left)} do not compile behind a switch", file=sys.stderr)


def run_of(program, test, number):
    """One test, of a mutant or of none."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S))
    environment = os.environ | ({} if number is None else {VARIABLE: str(number)})
    command = [program, "--exact", test]
    return subprocess.run(command, cwd=TREE, env=environment, preexec_fn=limit, capture_output=True, timeout=12 * LIMIT_S)


def outcome(program, test, number):
    """What one test says of a mutant: caught, missed or timeout."""
    try:
        status = run_of(program, test, number).returncode
    except subprocess.TimeoutExpired:
        return "timeout"
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return "timeout"
    # A test that ends the process, by an overflow of the stack, is as good as one that fails.
    return "caught" if status else "missed"


def tests_by_module(program, place):
    """The tests of each module, those first that end soonest, each with the switches that it meets; all must pass without a
    mutant."""
    if place.exists():
        return json.loads(place.read_text())
    tests = {module: [] for module in MODULES}
    listed = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout
    for test in re.findall(rf"^((?:{'|'.join(MODULES)})::.*): test$", listed, flags=re.MULTILINE):
        began = time.monotonic()
        run = run_of(program, test, None)
        if run.returncode:
            sys.exit(f"{test} fails as it is")
        met = [int(number) for number in re.findall(rb"met mutant (\d+)", run.stderr)]
        tests[test.split("::")[0]].append((time.monotonic() - began, test, met))
    tests = {module: [(test, met) for _, test, met in sorted(rows)] for module, rows in tests.items()}
    place.write_text(json.dumps(tests, indent=2))
    return tests


def judged(program, planting, tests, number):
    """Runs the tests of the module of a mutant until one fails; those that do not meet its switch, if it has one, cannot."""
    for test, met in tests[Path(planting.file).parts[1].removesuffix(".rs")]:
        if number == 0 or number in met:
            said = outcome(program, test, number)
            if said != "missed":
                return {"outcome": said, "by": test}
    return {"outcome": "missed"}


def judged_alone(planting, sources, tests):
    """The same of a mutant that is built alone; every file must be as it is."""
    file = TREE / planting.file
    file.write_bytes(planting.alone(sources[planting.file]))
    try:
        program, _ = build()
        return judged(program, planting, tests, 0) if program else {"outcome": "unviable"}
    finally:
        file.write_bytes(sources[planting.file])


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
    lines = RESULTS.read_text().splitlines() if RESULTS.exists() else []
    known = {result["name"]: result for result in map(json.loads, lines)}
    plantings, sources = planted(mutants)

    def keep(number, result):
        name = mutants[number - 1]["name"]
        known[name] = {"name": name, **result}
        with RESULTS.open("a") as file:
            file.write(json.dumps(known[name]) + "\n")

    program, behind_switch = build_switched(plantings, sources)
    tests = tests_by_module(program, PLACE / f"tests-{chosen.count}-{chosen.seed}.json")
    unknown = [number for number in plantings if mutants[number - 1]["name"] not in known]
    for number in sorted(behind_switch.intersection(unknown)):
        keep(number, judged(program, plantings[number], tests, number))
    for file, source in sources.items():
        (TREE / file).write_bytes(source)
    for number in sorted(set(unknown) - behind_switch):
        keep(number, judged_alone(plantings[number], sources, tests))
    drawn = [known[mutant["name"]] for mutant in mutants]
    for result in drawn:
        if result["outcome"] not in ("caught", "unviable"):
            print(f"{result['outcome']}: {result['name']}")
    print(dict(Counter(result["outcome"] for result in drawn)))


if __name__ == "__main__":
    main()
