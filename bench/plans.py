#!/usr/bin/env python3
"""Plans of two programs side by side: is any of the second worse, is a proof lost, does it take more processor time?

bench/plans.py OLD NEW [--limit S] [--cases N] FRAME.. > table.tsv

Each framework meets CASES requests out of all combinations of objective x ends x joint x cords, chosen so that each framework meets
every option, and each objective every pair of options somewhere. Both programs plan at the same time, one on each of two
processors, with the same limit of seconds; what seems worse is planned thrice more by both, and counts as worse only if no run
of the new program reaches the worst of the old one's.

A line of the table: framework, options, then for each program exit code, value, lower bound, status, processor seconds (with
children), and the verdict: better, equal, worse, lost (a proof that the old program had), refused (by both), new (refused before).
The value is what the request asks to be small: with an objective length, turning (rad), largest turning (rad) or, for symmetry,
overlap, then steps, then paths; with --balance the longest cord; with --max-length the number of cords. The last lines are sums.
`thread check` of the new program must accept every plan of both: a line "check" says where it does not, and the exit code is 1.
"""
import argparse
import concurrent.futures
import functools
import itertools
import json
import os
import subprocess
import sys
import tempfile

OBJECTIVES = ["--objective length", "--objective tortuosity --minimize turning", "--objective tortuosity --minimize max-turning", "--objective symmetry"]
ENDS = ["", "--ends any", "--ends feet"]
JOINTS = ["", "--joint tube"]
CORDS = ["", "--cords 3", "--cords 3 --balance", "--max-length LENGTH", "--cover 2"]
ALL = list(itertools.product(range(4), range(3), range(2), range(5)))
SHAPES = [("dome", "4"), ("dome", "9"), ("dome", "20"), ("geodesic", "2"), ("geodesic", "4"), ("geodesic", "8"), ("sphere", "2"),
          ("sphere", "4"), ("sphere", "7"), ("tube", "5"), ("tube", "10"), ("tube", "20"), ("honeycomb", "2"), ("honeycomb", "4"),
          ("honeycomb", "10")]
CLOSE = 1e-9


def cases_of(frame, number):
    """number combinations for this framework: a walk through all of them whose steps change every option."""
    return [ALL[(frame * number + k) * 37 % len(ALL)] for k in range(number)]


def options_of(case, shortest):
    """A limit that takes a few cords: six tenths of the framework's length."""
    text = " ".join([OBJECTIVES[case[0]], ENDS[case[1]], JOINTS[case[2]], CORDS[case[3]]])
    return text.replace("LENGTH", "%.6g" % (0.6 * shortest)).split()


def value_of(plan, case):
    metrics, proof = plan["metrics"], plan.get("proof", {})
    part, value = proof.get("length", {}), [metrics["length"]]
    if CORDS[case[3]].endswith("--balance") and case[0] == 0:
        part = proof.get("cords", {}).get("longest", {})
        value = [part.get("length", metrics["length"])]
    elif CORDS[case[3]].startswith("--max") and case[0] == 0:
        part = proof.get("cords", {}).get("fewest", {})
        value = [len(plan["cords"])]
    elif case[0] == 1:
        part, value = proof.get("turning", {}), [proof.get("turning", {}).get("price", metrics["turning"])]
    elif case[0] == 2:
        part, value = proof.get("turning", {}).get("largest", {}), [metrics["max_turning"]]
    elif case[0] == 3:
        of = plan.get("symmetry", {})
        value = [metrics["overlap"], of.get("steps", 0), of.get("unique_paths", 0)]
    if CORDS[case[3]].endswith("--balance") and case[0] in (1, 2):  # the longest cord comes first
        value.insert(0, proof.get("cords", {}).get("longest", {}).get("length", 0))
    return value, part.get("lower_bound"), part.get("status", "none")


@functools.cache
def to_the_proof(program):
    """Options with which a search goes on to the proof: older programs know no --gap, and do so anyway."""
    said = subprocess.run([program, "plan", "--help"], stdout=subprocess.PIPE, check=True).stdout
    return ["--gap", "0"] if b"--gap" in said else []


def run(program, frame, options, limit, case, checker):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plan.json")
        command = [program, "plan", frame, *options, *to_the_proof(program), "--time-limit", str(limit), "-q", "-o", path]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        said = process.stderr.read().decode(errors="replace").strip()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = 0
        out = {"code": os.waitstatus_to_exitcode(status), "seconds": usage.ru_utime + usage.ru_stime, "value": None, "bound": None,
               "status": "-", "check": None, "said": said}
        if os.path.exists(path):
            with open(path, encoding="utf-8") as f:
                out["value"], out["bound"], out["status"] = value_of(json.load(f), case)
            check = subprocess.run([checker, "check", path], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
            if check.returncode not in (0, 5):
                out["check"] = check.stderr.decode(errors="replace").strip()
        return out


def less(a, b):
    """Is a smaller than b, as lists, by more than rounding?"""
    for x, y in zip(a, b):
        if abs(x - y) > CLOSE * max(abs(x), abs(y), 1e-9):
            return x < y
    return False


def verdict(old, new):
    if old["value"] is None or new["value"] is None:
        if old["value"] is None and new["value"] is None:
            return "refused" if old["code"] == 2 else "equal"
        return ("new" if old["code"] == 2 else "better") if old["value"] is None else "lost"
    if old["status"] == "optimal" and new["status"] != "optimal":
        return "lost"
    if less(new["value"], old["value"]):
        return "better"
    return "worse" if less(old["value"], new["value"]) else "equal"


def both(a, frame, options, case, pool):
    runs = [pool.submit(run, program, frame, options, a.limit, case, a.new) for program in (a.old, a.new)]
    return [r.result() for r in runs]


def again(a, frame, options, case, pool, old, new):
    """What seems worse, thrice more: what two runs of the old program differ by is no difference."""
    olds, news = [old], [new]
    for _ in range(3):
        x, y = both(a, frame, options, case, pool)
        olds.append(x)
        news.append(y)
    for y in news:
        if all(verdict(x, y) in ("worse", "lost") for x in olds):
            continue
        return "equal"
    return verdict(old, new)


def show(r):
    value = "-" if r["value"] is None else ",".join("%.10g" % v for v in r["value"])
    return [str(r["code"]), value, "-" if r["bound"] is None else "%.10g" % r["bound"], r["status"], "%.2f" % r["seconds"]]


def frames_of(a, folder):
    paths = list(a.frames)
    for shape, size in SHAPES:
        path = os.path.join(folder, "%s-%s.json" % (shape, size))
        subprocess.run([a.new, "make", shape, "--size", size, "-o", path], check=True)
        paths.append(path)
    return paths


def length_of(program, frame):
    info = subprocess.run([program, "info", frame, "--json"], stdout=subprocess.PIPE, check=True)
    return json.loads(info.stdout)["length"]


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--limit", type=float, default=5)
    p.add_argument("--cases", type=int, default=8)
    p.add_argument("old")
    p.add_argument("new")
    p.add_argument("frames", nargs="*")
    a = p.parse_intermixed_args()
    tally, seconds, bad = {}, [0.0, 0.0], 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        for i, frame in enumerate(frames_of(a, folder)):
            name, length = os.path.basename(frame), length_of(a.new, frame)
            for case in cases_of(i, a.cases):
                options = options_of(case, length)
                old, new = both(a, frame, options, case, pool)
                what = verdict(old, new)
                if what in ("worse", "lost"):
                    what = again(a, frame, options, case, pool, old, new)
                tally[what] = tally.get(what, 0) + 1
                seconds = [seconds[0] + old["seconds"], seconds[1] + new["seconds"]]
                print("\t".join([name, " ".join(options), *show(old), *show(new), what]), flush=True)
                for who, r in (("old", old), ("new", new)):
                    if r["check"] is not None:
                        bad += 1
                        print("check\t%s plan refused: %s" % (who, r["check"]), flush=True)
    print("# %d plans: %s; processor time %.1f s before, %.1f s now" %
          (sum(tally.values()), ", ".join("%d %s" % (n, k) for k, n in sorted(tally.items())), *seconds))
    sys.exit(1 if bad or tally.get("worse", 0) + tally.get("lost", 0) else 0)


if __name__ == "__main__":
    main()
