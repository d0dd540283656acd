#!/usr/bin/env python3
"""How long everything takes, what it grows with, and how long others take for the same: tables in Markdown.

bench/run.py THREAD [--only PART] [--sizes M,M..] [--repeats N] [--limit S] [--smallest] [--output FILE]

THREAD is the program, beside its library. LEMON and Boost come from Debian; BLOSSOM5 and PYMATCHING in the environment name folders
with the sources of Blossom V and of PyMatching 2, which are compiled here. HOW below says what is measured, and how.
"""
import argparse
import contextlib
import datetime
import glob
import json
import math
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from frames import SHAPES, data, real_frameworks, shake, write_planar

HOW = """# How long it takes

Made by `make bench`, all in one run, on a machine that others use at the same time. Times are processor time, user and system,
children included, since the load of the machine changes them least; the least of %d runs (of one, if it takes two seconds and more).
What is compared runs in turns, and is given as the ratio of its times: ratios mean something elsewhere, seconds do not. *Growth*
is the exponent from the line above: logarithm of the ratio of the times over that of the edges. -: not measured, too short, or
not done in the time.

"""
SLOW = 2  # s: no second run
PEER_SECONDS = 10  # for each run of another code
HERE = os.path.dirname(os.path.abspath(__file__))

# Other codes: their name, the instance they take, where their sources are or how they are linked
PEERS = {
    "LEMON_PAIRS": ("LEMON, pairs", "pairs", "-llemon"),
    "BOOST": ("Boost, pairs", "pairs", ""),
    "BLOSSOM5": ("Blossom V, pairs", "pairs", ["*.cpp", "MinCost/*.cpp", "GEOM/*.cpp"]),
    "LEMON_PORTS": ("LEMON, whole", "graph", "-llemon"),
    "PYMATCHING": ("PyMatching, whole", "graph", ["src/pymatching/sparse_blossom/%s/*.cc" % d for d in
                                                  ("flooder", "flooder_matcher_interop", "matcher", "search", "tracker")]),
}


class Run:
    """A command that has ended: processor and wall seconds, MB at most, exit code, what it printed."""

    def __init__(self, command, folder):
        peak = os.path.join(folder, "peak")  # `time` starts it: the first memory of a child of Python is Python's
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run(["time", "-q", "-f", "%M", "-o", peak, *map(str, command)], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True, errors="replace", check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.wall = time.monotonic() - began
        self.seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        self.code, self.out, self.said = done.returncode, done.stdout, done.stderr
        with open(peak, encoding="ascii") as f:
            self.megabytes = int(f.read().split()[-1]) / 1024


class Failed(Exception):
    """A command that has not done what is measured; fault: nor what the program promises (its exit code 4 is an answer, too)."""

    def __init__(self, command, why, fault=True):
        super().__init__(why)
        self.fault, self.command = fault, " ".join(map(str, command))


class Bench:
    def __init__(self, a, folder):
        self.thread, self.folder, self.repeats, self.limit = os.path.abspath(a.thread), folder, a.repeats, a.limit
        self.smallest, self.sizes, self.output, self.frames = a.smallest, a.sizes, a.output, {}
        self.peers, self.missing, self.faults = {}, [], []

    def print(self, text):
        print(text, flush=True)
        if self.output:
            self.output.write(text + "\n")
            self.output.flush()

    def table(self, title, text, *head):
        self.print("\n## %s\n\n%s\n" % (title, text))
        self.row(*head)
        self.print("|---|" + "---:|" * (len(head) - 1))

    def row(self, *cells):
        self.print("| " + " | ".join(map(str, cells)) + " |")

    @contextlib.contextmanager
    def line(self, *cells):
        """Of a command in here that fails the row says so, after these cells; the next one goes on."""
        try:
            yield
        except Failed as failed:
            self.row(*cells, failed)
            if failed.fault:
                self.faults.append("%s: %s" % (failed.command, failed))

    def path(self, name):
        return os.path.join(self.folder, name)

    def once(self, command):
        """What a command is to write after -o is not there when it begins: to take an old file's place is the file system's work.
        Failed, if the program does not end with exit code 0 or 5, or has not written that."""
        written = command[command.index("-o") + 1] if "-o" in command else None
        if written and os.path.exists(written):
            (shutil.rmtree if os.path.isdir(written) else os.remove)(written)
        run = Run(command, self.folder)
        said = run.said.strip().split("\n")[-1] or "nothing said"
        if command[0] == self.thread and run.code not in (0, 5):
            raise Failed(command, "exit code %d: %s" % (run.code, said), run.code != 4)
        if written and not os.path.exists(written):
            raise Failed(command, "nothing found: %s" % said, run.code != 5)
        return run

    def least(self, *commands, keep=lambda run: run.seconds):
        """Runs them in turns; of each the run of which keep is least. Failed, if one of them does."""
        best = [None] * len(commands)
        for _ in range(self.repeats):
            for i, command in enumerate(commands):
                if best[i] and best[i].seconds > SLOW:
                    continue
                run = self.once(command)
                if not best[i] or keep(run) < keep(best[i]):
                    best[i] = run
        return best

    def plan(self, frame, *options, to="plan.json"):
        return [self.thread, "plan", frame, *(options or ("--cords", "1")), "-q", "-o", self.path(to)]

    def frame(self, family, edges):
        """Path and number of edges of a framework of this family, made once."""
        path = self.path("%s-%d.json" % (family, edges))
        if path not in self.frames:
            random.seed(1)
            if family == "planar":
                write_planar(path, edges)
            else:
                shape, size, *more = SHAPES["honeycomb" if family == "shaken" else family](edges)
                subprocess.run([self.thread, "make", shape, "--size", str(max(size, 2)), *map(str, more), "-o", path], check=True)
                if family == "shaken":
                    shake(path)
            self.frames[path] = self.info(path)["edges"]
        return path, self.frames[path]

    def info(self, path):
        return json.loads(subprocess.run([self.thread, "info", path, "-q", "--json"], stdout=subprocess.PIPE, check=True).stdout)

    def lines(self, families, sizes, real):
        """(name, path, edges, whether the family is that of the line before) of made and of real frameworks."""
        for family in list(families)[:1] if self.smallest else families:
            for k, size in enumerate(sizes[:1] if self.smallest else sizes):
                path, edges = self.frame(family, size)
                yield family, path, edges, k > 0
        for path in [] if self.smallest else real:
            yield re.split(r"\.|-nodes|_S1_", os.path.basename(path))[0], path, self.info(path)["edges"], False

    def compile(self):
        """matching.c, and peers.cpp once for every other code that is here."""
        need = subprocess.run(["pkg-config", "--libs", "nauty", "bullet-float64"], stdout=subprocess.PIPE, text=True, check=True)
        library = os.path.join(os.path.dirname(self.thread), "modules.a")
        make = ["cc", "-std=c11", "-O2", "-Wall", "-Wextra", "-D_DEFAULT_SOURCE", "-I" + os.path.dirname(HERE),
                os.path.join(HERE, "matching.c"), library, *need.stdout.split(), "-lglpk", "-lm", "-lstdc++", "-o", self.path("matching")]
        subprocess.run(make, check=True)
        for code, (name, _, how) in {} if self.smallest else PEERS.items():
            own = os.environ.get(code, "") if isinstance(how, list) else ""
            if isinstance(how, list) and not own:
                self.missing.append("%s (no folder named by %s)" % (name, code))
                continue
            sources = [s for part in how for s in glob.glob(os.path.join(own, part)) if not re.search(r"(test|perf)\.cc|example", s)] \
                if own else []
            make = ["c++", "-std=c++20" if code == "PYMATCHING" else "-std=c++17", "-O2", "-w", "-DNDEBUG", "-D" + code, "-I" + own,
                    "-I" + os.path.join(own, "src"), os.path.join(HERE, "peers.cpp"), *sources, "-o", self.path(code)]
            done = subprocess.run(make + ([how] if how and not own else []), stderr=subprocess.PIPE, text=True, check=False)
            if done.returncode:
                self.missing.append("%s (does not compile: %s)" % (name, next(iter(done.stderr.split("\n")))))
            else:
                self.peers[code] = PEERS[code]


# ---- cells ----

def figure(x, digits=2):
    return "-" if x is None else "%.2g" % x if 0 < x < 0.1 else "%.*f" % (0 if x >= 100 else digits - 1 if x >= 10 else digits, x)


def ratio(a, b):
    return figure(a / b if a is not None and b and b > 2e-5 else None)


def end_ratio(run, proved):
    """End of the process over the proof, where starting it is not most of that."""
    return ratio(run.seconds, proved if proved and proved >= 0.02 else None)


def seconds(x):
    return "-" if x is None else "%.3g" % x


class Growth:
    def __init__(self):
        self.last = None

    def __call__(self, edges, value, goes_on):
        last, self.last = self.last if goes_on else None, (edges, value)
        return figure(math.log(value / last[1]) / math.log(edges / last[0])) if last and last[1] and value and edges > last[0] else "-"


# ---- parts ----

def solver_times(b, path):
    """Of the whole T-join, of the matching alone, odd nodes, {code: seconds}; least of all runs, in turns."""
    ours, alone, others = math.inf, math.inf, {}
    for _ in range(b.repeats):
        own = Run([b.path("matching"), path, b.folder], b.folder)
        whole, length, match, weight, odd = own.out.split()
        ours, alone = min(ours, float(whole)), min(alone, float(match))
        for code, (_, instance, _) in b.peers.items():
            if others.get(code, 0) is None or others.get(code, 0) > SLOW:
                continue
            run = Run(["prlimit", "--cpu=%d" % PEER_SECONDS, b.path(code), b.path(instance)], b.folder)
            if run.code:
                others[code] = None
                continue
            spent, value = run.out.split()
            if value != (weight if instance == "pairs" else length):
                raise Failed([code, path], "%s finds %s, not %s" % (code, value, weight if instance == "pairs" else length))
            others[code] = min(others.get(code, math.inf), float(spent))
    return ours, alone, odd, others


def length(b):
    b.compile()
    text = """`thread plan` (*whole*, seconds and MB) with a closed cord, with ends anywhere as a ratio to it; the T-join alone beside the
whole; `thread check` of the plan beside the whole; the matching alone on its first candidate pairs beside the T-join. Other codes
beside ours on the same instance: on these pairs, or on the whole graph. They must find the same length. %d s for each run of
theirs. *shaken*: a honeycomb with every node moved; *planar*: triangles and quadrangles at random.""" % PEER_SECONDS
    if b.missing:
        text += "\nNot here: %s." % "; ".join(b.missing)
    b.table("Shortest cord", text, "framework", "edges", "odd", "whole s", "growth", "MB", "any / closed", "check / whole",
            "T-join / whole", "growth", "matching / T-join",
            *("%s / %s" % (name, "matching" if kind == "pairs" else "T-join") for name, kind, _ in b.peers.values()))
    grows, join_grows = Growth(), Growth()
    for name, path, edges, goes_on in b.lines([*SHAPES, "shaken", "planar"], b.sizes, real_frameworks()):
        with b.line(name, edges):
            whole, other, check = b.least(b.plan(path), b.plan(path, "--ends", "any", to="any.json"), [b.thread, "check", b.path("plan.json")])
            ours, alone, odd, others = solver_times(b, path)
            b.row(name, edges, odd, seconds(whole.seconds), grows(edges, whole.seconds, goes_on), figure(whole.megabytes),
                  ratio(other.seconds, whole.seconds), ratio(check.seconds, whole.seconds), ratio(ours, whole.seconds),
                  join_grows(edges, ours, goes_on), ratio(alone, ours),
                  *(ratio(others.get(c), alone if b.peers[c][1] == "pairs" else ours) for c in b.peers))


def milestones(run, plan, part):
    """Processor seconds to the first plan and to the proof, None = none, as -v says; and that part of the plan's proof, None: what
    the exit code says."""
    stamps = [(line, float(m.group(1))) for line in run.said.split("\n") for m in [re.search(r", ([0-9.]+) CPU s$", line)] if m]
    first = next((at for line, at in stamps if line.startswith("thread: plan:")), None)
    ended = next((at for line, at in stamps if line.startswith("thread: search:")), None)
    with open(plan, encoding="utf-8") as f:
        proof = json.load(f).get("proof", {}).get(part, {}) if part else {"status": "optimal" if run.code == 0 else "bound"}
    closed = next((at for line, at in stamps if "turning:" in line and float(line.split("gap ")[1].split()[0]) < 1e-7), ended)
    return first, closed if proof.get("status") == "optimal" else None, proof


def said_plan(b, path, *options):
    return [b.thread, "plan", path, *options, "-v", "-o", b.path("plan.json"), "--time-limit", b.limit]


def turning(b):
    text = """`thread plan --objective tortuosity`, one closed cord, %g s at most: seconds to the first plan and to the proof (`-v` says
both), the end of the process beside the proof, the gap where nothing is proved; then the turning of the classical tours and of the
shortest cord beside the proven bound.""" % b.limit
    b.table("Least turning", text, "framework", "edges", "first plan s", "proved s", "growth", "end / proved", "gap %", "MB",
            "Fleury / bound", "Hierholzer / bound", "shortest / bound")
    grows = Growth()
    for name, path, edges, goes_on in b.lines(SHAPES, (150, 700, 3000, 8000), data("fandisk", "creased_shell", "liew_dome", "barrel")):
        with b.line(name, edges):
            run = b.least(said_plan(b, path, "--objective", "tortuosity"))[0]
            first, proved, proof = milestones(run, b.path("plan.json"), "turning")
            bound, price = proof.get("lower_bound"), proof.get("price")
            rivals = []
            for options in (["tortuosity", "--tour", "fleury"], ["tortuosity", "--tour", "hierholzer"], ["length"]):
                b.once(b.plan(path, "--objective", *options, "--time-limit", b.limit))
                with open(b.path("plan.json"), encoding="utf-8") as f:
                    rivals.append(json.load(f)["metrics"]["turning"])
            b.row(name, edges, seconds(first), seconds(proved), grows(edges, proved, goes_on), end_ratio(run, proved),
                  "0" if proved is not None else figure(100 * (1 - bound / price)) if bound and price else "-", figure(run.megabytes),
                  *(ratio(r, bound) for r in rivals))


def symmetry(b):
    text = """`thread symmetries` (%g s by the clock at most; *: not all rows in that time), closed cords: seconds on one processor, and on
two beside that, of the processor and of the clock (2 at best, less on a loaded machine); then the plan of the marked row: seconds to
the first plan and to the proof, and the end of the process beside the proof.""" % b.limit
    b.table("Symmetry", text, "framework", "edges", "group", "classes", "table s", "MB", "-j 2 / -j 1, processor",
            "-j 1 / -j 2, clock", "first plan s", "proved s", "end / proved")
    frames = list(b.lines(SHAPES, (84, 480), data("fandisk", "liew_dome", "barrel")))
    for name, path, edges, _ in frames:
        with b.line(name, edges):
            how = [b.thread, "symmetries", path, "-q", "--json", "--time-limit", b.limit]
            one, two = b.least([*how, "-j", "1"], [*how, "-j", "2"], keep=lambda run: run.wall)
            run = b.least(said_plan(b, path, "--objective", "symmetry"))[0]
            first, proved, _ = milestones(run, b.path("plan.json"), None)
            found = json.loads(one.out)
            b.row(name, edges, "%.4g" % found["order"], len(found["groups"]), seconds(one.seconds) + ("" if one.code == 0 else "*"),
                  figure(one.megabytes), ratio(two.seconds, one.seconds), ratio(one.wall, two.wall), seconds(first), seconds(proved),
                  end_ratio(run, proved))


def same_work(b, cells, one, two, outputs):
    """A row: these cells, and one command beside the other, which does the same in two threads. outputs: what they write, or None:
    what they print."""
    first, second = b.least(one, two, keep=lambda run: run.wall)
    made = [first.out, second.out]
    if outputs:
        made = []
        for path in outputs:
            with open(path, encoding="utf-8") as f:
                made.append(f.read())
    if made[0] != made[1]:
        raise Failed(two, "-j 1 and -j 2 do not make the same")
    b.row(*cells, seconds(first.wall), ratio(second.seconds, first.seconds), ratio(first.wall, second.wall))


def threads(b):
    text = """The same work by one thread and by two, to the clock (2 at best; less where others use the machine): the least turning, with a
number of tree nodes instead of a time limit, and `thread symmetries`, with so much counted work for each row. What comes out must
be the same, byte for byte."""
    b.table("Two threads", text, "framework", "edges", "what", "-j 1 s", "-j 2 / -j 1, processor", "-j 1 / -j 2, clock")
    turns = (("geodesic", 135, 5),) if b.smallest else (("sphere", 480, 31), ("sphere", 1920, 11), ("sphere", 1920, 31), ("geodesic", 540, 31))
    for family, size, nodes in turns:
        path, edges = b.frame(family, size)
        cells = [family, edges, "turning, %d nodes" % nodes]
        with b.line(*cells):
            how, to = ["--objective", "tortuosity", "--tune", "nodes=%s" % nodes, "--time-limit", 0], ["threads-1.json", "threads-2.json"]
            one, two = [b.plan(path, *how, "-j", j + 1, to=to[j]) for j in (0, 1)]
            same_work(b, cells, one, two, [b.path(name) for name in to])
    rows = (("grid", 84, 0.01),) if b.smallest else (("sphere", 270, 0.5), ("sphere", 480, 0.2), ("tube", 435, 0.2))
    for family, size, work in rows:
        path, edges = b.frame(family, size)
        cells = [family, edges, "symmetries, work %g" % work]
        with b.line(*cells):
            how = [b.thread, "symmetries", path, "-q", "--json", "--tune", "row-work=%s" % work]
            same_work(b, cells, [*how, "-j", 1], [*how, "-j", 2], None)


def balance(b):
    text = """`thread plan --balance`, %g s at most: how far the longest cord is above its proven bound, %%, and seconds of the processor.""" % b.limit
    b.table("Cords of even length", text, "framework", "edges", "cords", "ends", "above the bound %", "s")
    cases = (("grid", 84, 4),) if b.smallest else (("honeycomb", 1000, 16), ("honeycomb", 2862, 16), ("honeycomb", 2862, 32), ("honeycomb", 2862, 64))
    for family, size, cords in cases:
        path, edges = b.frame(family, size)
        with b.line(family, edges, cords):
            run = b.least(b.plan(path, "--cords", cords, "--balance", "--ends", "any", "--time-limit", b.limit))[0]
            with open(b.path("plan.json"), encoding="utf-8") as f:
                longest = json.load(f)["proof"]["cords"]["longest"]
            b.row(family, edges, cords, "any", figure(100 * (longest["length"] / longest["lower_bound"] - 1)), seconds(run.seconds))


def pull(b):
    text = """`thread eval` of the shortest cord: simulated joints with an empty cache and a full one, and the limit analysis of the
structure, each beside the closed form."""
    b.table("Pull", text, "framework", "edges", "closed form s", "joints, cold / closed form", "warm / closed form",
            "limit analysis s", "/ closed form", "growth")
    grows = Growth()
    for name, path, edges, goes_on in b.lines(["grid"], (84, 364, 760), data("fandisk")):
        with b.line(name, edges):
            b.once(b.plan(path))
            evaluate, cache = [b.thread, "eval", b.path("plan.json")], b.path("cache-%s-%d" % (name, edges))
            cold = None if b.smallest else b.once([*evaluate, "--method", "joint", "--cache", cache]).seconds
            warm = None if b.smallest else b.least([*evaluate, "--method", "joint", "--cache", cache])[0].seconds
            closed, limit = b.least(evaluate, [*evaluate, "--method", "structure"])
            b.row(name, edges, seconds(closed.seconds), ratio(cold, closed.seconds), ratio(warm, closed.seconds),
                  seconds(limit.seconds), ratio(limit.seconds, closed.seconds), grows(edges, limit.seconds, goes_on))


def structure(b):
    text = """`thread eval --method structure`: the limit analysis of square domes on straight cords, two for each row, while
they are drawn in and in any state.

The factors of the normal equations (`lp/solver/normal.c`) are our own. CHOLMOD 3.0.14 in their place (AMD order, one thread) has as many
entries in its factors, and all bounds agree to 3e-7. But whole processes take up to 4.3 times as long: its simplicial factors 1.2 to
1.3 times on the 7 x 7 domes, 2.0 to 2.3 at 400 pieces, 2.9 at 900, 4.3 at 1,521; its supernodal ones with OpenBLAS 1.4 to 2.4, 1.6 to 2.3,
2.3 and 2.5, with the BLAS that Debian installs 1.5 to 2.2, and 2.9 at 400. It was to be taken at 1.5 times at most.
Supernodal factors need BLAS and LAPACK, too, for which Emscripten has no Fortran; and Debian's static library needs METIS, which is not there as a static one."""
    b.table("Limit analysis of large structures", text, "framework", "pieces", "cords", "s", "growth")
    grows = Growth()
    for side in (7,) if b.smallest else (20, 39, 45):
        path, edges = b.frame("grid", 2 * side * (side - 1))
        with b.line("grid", edges):
            b.once(b.plan(path, *"--objective tortuosity --minimize turning --tune nodes=50 --ends any --cords".split(), 2 * side))
            run = b.least([b.thread, "eval", b.path("plan.json"), "--method", "structure"])[0]
            b.row("grid", side * side, 2 * side, seconds(run.seconds), grows(side * side, run.seconds, side > 20))


def drawings(b):
    kinds = ["svg", "steps", "html", "gltf", "pdf"]
    text = """`thread draw` of the shortest cord, each kind beside `thread plan`.

The PDF is written by our own code (`diagram/export`). libharu 2.3.0 in its place, as a trial on step sheets, gives the same bytes each time, without
dates or ids, has opacities, and takes TrueType fonts in part, as ours does. But poppler warns of what it writes to find letters by (ToUnicode);
letters beyond the basic plane are neither drawn nor found; dashes are whole numbers. One page takes 188 kB where ours takes 50, 12 pages 262
and 149, 54 pages, packed by zlib at level 6 instead of 1, 1,019 and 1,109; and these 0.30 s of the processor where ours take 0.12. Some 680 lines
would go, but a table of 40 functions and a layer over them would come. Debian has no static library of it; Windows and browsers make no PDF."""
    b.table("Drawings", text, "framework", "edges", "plan s", *(k + " / plan" for k in kinds), "growth of svg", "of pdf")
    svg_grows, pdf_grows = Growth(), Growth()
    for name, path, edges, goes_on in b.lines(["grid", "sphere", "honeycomb"], (84, 480, 3000), data("fandisk", "liew_dome")):
        with b.line(name, edges):
            kinds_now = [k for k in kinds if k != "pdf" or not b.smallest]
            draw = [[b.thread, "draw", b.path("plan.json"), "-T", k, "-o", b.path("drawn." + ("txt" if k == "steps" else k))] for k in kinds_now]
            plan, *drawn = b.least(b.plan(path), *draw)
            spent = {k: d.seconds for k, d in zip(kinds_now, drawn)}
            b.row(name, edges, seconds(plan.seconds), *(ratio(spent.get(k), plan.seconds) for k in kinds),
                  svg_grows(edges, spent["svg"], goes_on), pdf_grows(edges, spent.get("pdf"), goes_on))


def kit(b):
    text = """`thread kit` of the shortest cord, one thread, whole: meshes, 3MF, table, picture and viewer, without names; beside it with names
engraved, without picture and viewer, and in two threads, to the clock. *MB*: of kit.3mf with names."""
    b.table("Pieces to print", text, "framework", "pieces", "s", "ms a piece", "growth", "names / none", "no picture / picture",
            "-j 1 / -j 2, clock", "MB")
    grows = Growth()
    for name, path, _, goes_on in b.lines(["grid", "sphere", "honeycomb"], (84, 480), []):
        pieces = b.info(path)["nodes"]
        with b.line(name, pieces):
            b.once(b.plan(path))
            made = [b.thread, "kit", b.path("plan.json"), "-q"]
            how = (["--names", "none", "-j", 1], ["-j", 1], ["--names", "none", "-j", 1, "--no-picture"], ["--names", "none", "-j", 2])
            none, named, bare, two = b.least(*([*made, *options, "-o", b.path("kit-%d" % i)] for i, options in enumerate(how)))
            b.row(name, pieces, seconds(none.seconds), figure(1000 * none.seconds / pieces), grows(pieces, none.seconds, goes_on),
                  ratio(named.seconds, none.seconds), ratio(bare.seconds, none.seconds), ratio(none.wall, two.wall),
                  figure(os.path.getsize(b.path("kit-1/kit.3mf")) / 1e6))


def joints(b):
    b.table("Tube joints", "`thread plan` with tube joints beside solid ones.", "framework", "edges", "solid s", "tube / solid")
    for name, path, edges, _ in b.lines(SHAPES, (100,) if b.smallest else (10000,), []):
        with b.line(name, edges):
            solid, tube = b.least(b.plan(path), b.plan(path, "--joint", "tube", to="tube.json"))
            b.row(name, edges, seconds(solid.seconds), ratio(tube.seconds, solid.seconds) + (" (not proved)" if tube.code else ""))


def files(b):
    text = """Whole processes from file to file: `thread plan` and `thread check` beside Python's json module (written in C) reading
the same files and, for a plan, writing plan.json: what moving the text alone takes."""
    b.table("Reading and writing", text, "framework", "edges", "plan s", "growth", "plan / json", "MB", "check s", "growth",
            "check / json", "MB", "plan + check s")
    plan_grows, check_grows = Growth(), Growth()
    for name, path, edges, goes_on in b.lines(["grid"], (10000, 100000, 1000000), []):
        with b.line(name, edges):
            load = "import json; d = [json.load(open(name)) for name in %r]; " % [path, b.path("plan.json")]
            write = "open(%r, 'w').write(json.dumps(d[1]))" % b.path("copy.json")
            read = "import json; json.load(open(%r))" % b.path("plan.json")
            plan, moved, check, seen = b.least(b.plan(path), [sys.executable, "-c", load + write],
                                               [b.thread, "check", "-q", b.path("plan.json")], [sys.executable, "-c", read])
            b.row(name, edges, seconds(plan.seconds), plan_grows(edges, plan.seconds, goes_on), ratio(plan.seconds, moved.seconds),
                  figure(plan.megabytes), seconds(check.seconds), check_grows(edges, check.seconds, goes_on),
                  ratio(check.seconds, seen.seconds), figure(check.megabytes), seconds(plan.seconds + check.seconds))
    formats(b)


def formats(b):
    text = """`thread info` of the same framework in other formats: reading and what is counted in it; and `thread convert` from each to a
file of frame JSON."""
    b.table("Reading other formats", text, "format", "edges", "info s", "MB", "/ info of JSON", "convert s", "MB")
    path, edges = b.frame("grid", 100 if b.smallest else 1000000)
    base = None
    for kind in ("json", "obj", "csv", "ply"):
        with b.line(kind, edges):
            other = b.path("other." + kind)
            b.once([b.thread, "convert", path, "-q", "-o", other])
            info, convert = b.least([b.thread, "info", other, "-q", "--json"],
                                    [b.thread, "convert", other, "-q", "-o", b.path("back.json")])
            if json.loads(info.out)["edges"] != edges:
                raise Failed([other], "not all edges were read")
            base = base or info
            b.row(kind, edges, seconds(info.seconds), figure(info.megabytes), ratio(info.seconds, base.seconds),
                  seconds(convert.seconds), figure(convert.megabytes))


PARTS = {f.__name__: f for f in (length, files, turning, symmetry, threads, balance, pull, structure, drawings, joints, kit)}


def machine(b):
    with open("/proc/cpuinfo", encoding="utf-8") as f:
        model = re.search(r"model name\s*: (.*)", f.read())
    start = b.least(["true"], [b.thread, "--version"])
    version = subprocess.run([b.thread, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout.split("\n")[0]
    commit = subprocess.run(["git", "-C", HERE, "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            text=True, check=False).stdout.strip()
    return "%s%s. %d processors (%s), %.0f GB, load %.1f before the run. %s.\n\
Starting any program takes %.1f ms here, starting `thread` %.1f ms: they are in all times of whole processes." % (
        datetime.date.today(), ", commit " + commit if commit else "", os.cpu_count(), model.group(1) if model else "unknown",
        os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30, os.getloadavg()[0], version,
        *(1000 * run.seconds for run in start))


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("thread")
    p.add_argument("--only", choices=PARTS, action="append", help="this part (more than once: these)")
    p.add_argument("--sizes", type=lambda s: [int(m) for m in s.split(",")], default=[1000, 10000, 100000],
                   help="edges, for the shortest cord")
    p.add_argument("--repeats", type=int, default=3)
    p.add_argument("--limit", type=float, default=10, help="s for a plan or table that may not be proved")
    p.add_argument("--smallest", action="store_true", help="the smallest framework of each part, no other codes: does it run?")
    p.add_argument("--output", type=argparse.FileType("w", encoding="utf-8"), metavar="FILE", help="write the tables there, too")
    a = p.parse_args()
    if a.smallest:
        a.sizes, a.repeats, a.limit = [100], 1, 1
    with tempfile.TemporaryDirectory() as folder:
        b = Bench(a, folder)
        b.print(HOW % a.repeats + machine(b))
        spent = []
        for part in a.only or PARTS:
            began = time.monotonic()
            PARTS[part](b)
            spent.append("%s %.0f s" % (part, time.monotonic() - began))
        b.print("\nBy the clock: %s." % ", ".join(spent))
    if b.faults:
        sys.exit("bench: %d rows are faults: %s" % (len(b.faults), "; ".join(b.faults)))


if __name__ == "__main__":
    main()
