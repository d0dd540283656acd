#!/usr/bin/env python3
"""Judges plans and mutants of them by `thread check` and by tools/check_plan.py, which must agree.

    tests/second/compare.py THREAD [--mutants N] [--single N] [--seed N] [--all] [--keep DIR] [PLAN..]

Of plans that hold they must say the same, line by line. Plans: those named, the readers' seeds, and what THREAD makes of the frames and options in plans.txt (every pair with --all, else
a share of them). Mutants have several changes at random. Single changes go through every plan: a member left out, a number that is 0, -0.0, 1e-13 and 1e13 times itself, a value of another type; N of all
of them, or with --all each. Closes with "N passed, N failed". Plans about which the two differ are left in DIR.
"""
import argparse
import glob
import importlib.util
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile

import mutate

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BATCH = 200
MINUS_ZERO = re.compile(r"(?<![\w.])-0(?![\d.])")  # which nobody writes


def second_checker():
    spec = importlib.util.spec_from_file_location("check_plan", os.path.join(ROOT, "tools", "check_plan.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


CHECKER = second_checker()


def python_says(path):
    """("ok", lines) or ("no", violation)"""
    with open(path, "rb") as file:
        data = file.read()
    try:
        return "ok", CHECKER.check(data)
    except (CHECKER.Violation, CHECKER.Unreadable) as error:
        return "no", str(error)
    except Exception as error:  # a fault of the checker, which the comparison is to find
        return "fault", f"{type(error).__name__}: {error}"


def thread_says(thread, paths):
    """The same for many plans, in their order, by one process. What holds is on stdout: "PATH: holds: ..", and lines that are indented."""
    run = subprocess.run([thread, "check", "--time-limit", "0", *paths], capture_output=True, text=True, check=False, timeout=600)
    words, refused, said = run.stdout.splitlines(), run.stderr.splitlines(), []
    for path in paths:
        if words and words[0].startswith(f"{path}: "):
            words[0] = words[0].removeprefix(f"{path}: ")
            n = next((i for i, line in enumerate(words[1:], 1) if not line.startswith("  ")), len(words))
            said.append(("ok", [line.strip() for line in words[:n]]))
            words = words[n:]
        elif refused and refused[0].startswith(f"thread: {path}:"):
            said.append(("no", refused.pop(0)))
        else:
            said.append(("fault", f"exit code {run.returncode}: {run.stderr[-200:]}"))
    return said


def units_differ():
    """[(word, what units.c says of it, what the second checker says)] where they differ: short name and millimetres, None = unknown to it."""
    with open(os.path.join(ROOT, "graph/framework/units.c"), encoding="utf-8") as file:
        rows = re.findall(r"\{\{([^{}]*)\}, ([\w. /+-]*)\}", file.read())
    first, second = {}, {word: (CHECKER.SHORT[size], size) for word, size in CHECKER.UNITS.items()}
    for words, size in rows:
        words, (over, _, under) = re.findall('"([^"]*)"', words), size.partition(" / ")
        first.update({word.lower(): (words[0], float(over) / float(under or 1) or None) for word in words})
    return [(word, first.get(word), second.get(word)) for word in sorted({*first, *second}) if first.get(word) != second.get(word)]


def frame_hash(plan):
    """States the framework's hash."""
    try:
        CHECKER.Frame({**plan["framework"], "hash": ""})
    except CHECKER.Violation as error:
        word = str(error).rsplit(" ", 1)[1]
        if "framework.hash" in str(error):
            plan["framework"]["hash"] = word


def read_small(path):
    """A plan to change, if it is JSON and not large."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file) if os.path.getsize(path) < 40000 else None
    except ValueError:
        return None


def is_heavy(plan):
    """Does judging it take the second checker long? Prices of walks do, and several cords through 13 to 18 edges."""
    return '"walks"' in json.dumps(plan["proof"]) or plan["options"].get("cords") != 1 and 12 < len(plan["framework"]["edges"]) <= 18


class Comparison:
    def __init__(self, thread, keep):
        self.thread, self.keep = thread, keep
        self.waiting, self.count, self.accepted, self.differences = [], 0, 0, []

    def add(self, path):
        self.waiting.append(path)
        if len(self.waiting) >= BATCH:
            self.flush()

    def flush(self):
        for path, one in zip(self.waiting, thread_says(self.thread, self.waiting) if self.waiting else []):
            two = python_says(path)
            self.count += 1
            self.accepted += two[0] == "ok"
            minus_zero = two[0] == "ok" and any(MINUS_ZERO.search(line) for line in two[1])
            if one[0] != two[0] or "fault" in (one[0], two[0]) or one[0] == "ok" and one != two or minus_zero:
                self.differ(path, one, two)
        self.waiting = []

    def differ(self, path, one, two):
        name = path
        if self.keep:
            name = os.path.join(self.keep, f"{len(self.differences):05}-{os.path.basename(path)}")
            with open(path, "rb") as source, open(name, "wb") as target:
                target.write(source.read())
        self.differences.append(name)
        print(f"{name}\n    thread: {one[0]} {one[1]}\n    second: {two[0]} {two[1]}")


def requests(everything, seed):
    """Pairs (frame, options) of plans.txt."""
    frames, options = [], []
    with open(os.path.join(HERE, "plans.txt"), encoding="utf-8") as file:
        for line in file:
            kind, _, rest = line.strip().partition(" ")
            if kind in ("frame", "options"):
                (frames if kind == "frame" else options).append(rest.strip())
    pairs = [(f, o) for f in frames for o in options]
    if not everything:
        chosen = random.Random(seed).sample(pairs, 60)
        pairs = [p for p in pairs if p in chosen]
    return pairs


def make_plans(thread, folder, everything, seed):
    made, sources = [], {}
    for i, (frame, options) in enumerate(requests(everything, seed)):
        if frame not in sources:
            sources[frame] = os.path.join(folder, f"frame-{len(sources)}.json") if frame.startswith("make ") else os.path.join(ROOT, frame)
            if frame.startswith("make "):
                subprocess.run([thread, *frame.split(), "-o", sources[frame]], check=True)
        source = sources[frame]
        target = os.path.join(folder, f"plan-{i}.json")
        run = subprocess.run([thread, "plan", source, "-q", "--time-limit", "2", "-o", target, *options.split()], capture_output=True, text=True, check=False,
                             timeout=300)
        if run.returncode not in (0, 4, 5):
            print(f"thread plan {frame} {options}: exit code {run.returncode}: {run.stderr.strip()}")
        if os.path.exists(target):
            made.append(target)
    return made


def compare_changed(arguments, folder, plans, what):
    """Writes plans and compares what is said of them."""
    comparison = Comparison(arguments.thread, arguments.keep)
    for i, plan in enumerate(plans):
        path = os.path.join(folder, f"changed-{i % BATCH}.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(plan, file)
        comparison.add(path)
    comparison.flush()
    print(f"{comparison.count} {what}, {comparison.accepted} of them accepted, {len(comparison.differences)} differences")
    return comparison


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("thread")
    parser.add_argument("plans", nargs="*")
    parser.add_argument("--mutants", type=int, default=3000)
    parser.add_argument("--single", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--keep")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        plans = a.plans + sorted(glob.glob(os.path.join(ROOT, "tests/fuzz/corpus/plan/*.json")) + glob.glob(os.path.join(ROOT, "data/dome7-*.json")))
        plans += make_plans(os.path.abspath(a.thread), folder, a.all, a.seed)
        whole = Comparison(a.thread, a.keep)
        for path in plans:
            whole.add(path)
        whole.flush()
        print(f"{whole.count} plans, {whole.accepted} of them accepted, {len(whole.differences)} differences")
        small = [plan for plan in map(read_small, plans) if plan]
        chance = random.Random(a.seed)
        weights = [0.05 if is_heavy(plan) else 1 for plan in small]
        mutants = (mutate.mutant(chance, plan, frame_hash) for plan in chance.choices(small, weights, k=a.mutants))
        changed = compare_changed(a, folder, mutants, "mutants")
        every = [(plan, *change) for plan, weight in zip(small, weights) if a.all or weight == 1 for change in mutate.single_changes(plan)]
        chosen = every if a.all else chance.sample(every, min(len(every), a.single))
        single = compare_changed(a, folder, (mutate.changed_once(plan, path, way, frame_hash) for plan, path, way in chosen), f"of {len(every)} single changes")
        runs = [whole, changed, single]
    failed = sum(len(run.differences) for run in runs)
    passed = sum(run.count for run in runs) - failed
    for difference in units_differ():
        print("units:", *difference)
        failed += 1
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.exit(main())
