#!/usr/bin/env python3
"""Judges plans and mutants of them by `thread check` and by tools/check_plan.py, which must agree.

    tests/second/compare.py THREAD [--mutants N] [--seed N] [--all] [--keep DIR] [PLAN..]

Of plans that hold they must say the same, line by line. Plans: those named, the readers' seeds, and what THREAD makes of the frames and options in plans.txt (every pair with --all, else
a share of them). Closes with "N passed, N failed". Plans about which the two differ are left in DIR.
"""
import argparse
import glob
import importlib.util
import json
import os
import random
import signal
import subprocess
import sys
import tempfile

import mutate

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BATCH = 200


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
    """The same for many plans, in their order."""
    run = subprocess.run([thread, "check", "--json", *paths], capture_output=True, text=True, check=False, timeout=600)
    said = {}
    for line in run.stdout.splitlines():
        row = json.loads(line)
        said[row["plan"]] = ("ok" if row["ok"] else "no", row.get("violation") or row.get("error") or "")
    good = [path for path in paths if said.get(path, "no")[0] == "ok"]
    words = subprocess.run([thread, "check", *good], capture_output=True, text=True, check=False, timeout=600).stdout.splitlines() if good else []
    for path in good:  # "PATH: holds: ..", and lines that are indented
        words[0] = words[0].removeprefix(f"{path}: ")
        n = next((i for i, line in enumerate(words[1:], 1) if not line.startswith("  ")), len(words))
        said[path] = ("ok", [line.strip() for line in words[:n]])
        words = words[n:]
    return [said.get(path, ("fault", f"exit code {run.returncode}: {run.stderr[-200:]}")) for path in paths]


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
            if one[0] != two[0] or "fault" in (one[0], two[0]) or one[0] == "ok" and one != two:
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
        chosen = random.Random(seed).sample(pairs, 80)
        pairs = [p for p in pairs if p in chosen]
    return pairs


def make_plans(thread, folder, everything, seed):
    made = []
    for i, (frame, options) in enumerate(requests(everything, seed)):
        source = os.path.join(folder, "frame.json")
        if frame.startswith("make "):
            subprocess.run([thread, *frame.split(), "-o", source], check=True)
        else:
            source = os.path.join(ROOT, frame)
        target = os.path.join(folder, f"plan-{i}.json")
        run = subprocess.run([thread, "plan", source, "-q", "--time-limit", "5", "-o", target, *options.split()], capture_output=True, text=True, check=False,
                             timeout=300)
        if run.returncode not in (0, 4, 5):
            print(f"thread plan {frame} {options}: exit code {run.returncode}: {run.stderr.strip()}")
        if os.path.exists(target):
            made.append(target)
    return made


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("thread")
    parser.add_argument("plans", nargs="*")
    parser.add_argument("--mutants", type=int, default=8000)
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
        changed = Comparison(a.thread, a.keep)
        chance = random.Random(a.seed)
        for i in range(a.mutants):
            plan = mutate.mutant(chance, chance.choice(small), frame_hash)
            path = os.path.join(folder, f"mutant-{i % BATCH}.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(plan, file)
            changed.add(path)
        changed.flush()
        print(f"{changed.count} mutants, {changed.accepted} of them accepted, {len(changed.differences)} differences")
    failed = len(whole.differences) + len(changed.differences)
    print(f"{whole.count + changed.count - failed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.exit(main())
