#!/usr/bin/env python3
"""How far plans of several cords may be above the optimum: their gaps for many frameworks, numbers of cords and kinds of ends.

bench/gaps.py PROGRAM [--limit S] [--cords 2,4,8,12] [--ends feet,any,closed] [--aims turning,length] [--gap PERCENT] [-j N] [FRAME..] > table.tsv

The aims: the cord that turns most (--objective tortuosity; turning) and the longest cord (--balance; length). Without FRAMEs all
those of data/. With --limit 0 plans end as they do without --time-limit, and with --gap 0, which is usual here, only at a proof or
when their counted work is done. Where a framework has no feet its lowest nodes are its
feet. A line of the table: framework, aim, ends, cords, exit code, value (degrees, or units of length), lower bound, gap in % of
the bound, status, seconds by the clock. `thread check` must accept every plan: exit code 1 if it does not. Lines come as the runs
end; gaps above 5 % (turning) or 3 % (length) are marked *.
"""
import argparse
import concurrent.futures
import itertools
import json
import math
import os
import subprocess
import sys
import tempfile
import time

LARGE = {"turning": 5, "length": 3}


def frames_of_data():
    """All frameworks below data/; of a pair of CSV files that of the nodes, with its other file as an option."""
    out = []
    for folder, _, names in sorted(os.walk("data")):
        for name in sorted(names):
            path = os.path.join(folder, name)
            if name.endswith("-nodes.csv"):
                out.append((path, ["--edges", path.replace("-nodes", "-edges")]))
            elif name.endswith((".json", ".obj")) and not name.startswith("dome7-"):
                out.append((path, []))
    return out


def has_feet(program, frame):
    said = subprocess.run([program, "info", frame[0], *frame[1], "--json"], capture_output=True, text=True, check=False).stdout
    feet = json.loads(said).get("feet", 0)
    return bool(feet)


def run(program, frame, aim, ends, cords, limit, enough):
    with tempfile.TemporaryDirectory() as folder:
        plan = os.path.join(folder, "plan.json")
        options = ["--objective", "tortuosity"] if aim == "turning" else ["--balance"]
        options += frame[1] + ([] if frame[2] else ["--feet", "lowest"])
        options += ["--ends", ends, "--cords", str(cords), "--gap", enough, "-q", "-o", plan]
        options += ["--time-limit", str(limit)] if limit else []
        start = time.time()
        done = subprocess.run([program, "plan", frame[0], *options], capture_output=True, text=True, check=False)
        spent = time.time() - start
        row = [os.path.basename(frame[0]).split(".")[0], aim, ends, cords, done.returncode]
        if not os.path.exists(plan):
            return row + ["-", "-", "-", done.stderr.strip()[:90], f"{spent:.1f}"], True
        with open(plan, encoding="utf-8") as f:
            proof = json.load(f).get("proof", {})
        part = proof.get("turning", {}).get("largest", {}) if aim == "turning" else proof.get("cords", {}).get("longest", {})
        unit = 180 / math.pi if aim == "turning" else 1
        value = part.get("turning", part.get("price", part.get("length", math.nan))) * unit
        bound = part.get("lower_bound", 0) * unit
        gap = 100 * (value - bound) / bound if bound > 0 else 0 if value == 0 else math.inf  # nan: no such cords were found
        status = part.get("status", "none")
        right = subprocess.run([program, "check", plan, "-q"], capture_output=True, check=False).returncode == 0
        mark = "*" if gap > LARGE[aim] and status != "optimal" else ""
        return row + [f"{value:.2f}", f"{bound:.2f}", f"{gap:.2f}{mark}", status if right else "REFUSED", f"{spent:.1f}"], right


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("frame", nargs="*")
    arguments.add_argument("--limit", type=float, default=20)
    arguments.add_argument("--cords", default="2,4,8,12")
    arguments.add_argument("--ends", default="feet,any,closed")
    arguments.add_argument("--aims", default="turning,length")
    arguments.add_argument("--gap", default="0")
    arguments.add_argument("-j", type=int, default=1)
    given = arguments.parse_args()
    frames = [(f, []) for f in given.frame] or frames_of_data()
    frames = [(f, options, has_feet(given.program, (f, options))) for f, options in frames]
    cases = list(itertools.product(given.aims.split(","), map(int, given.cords.split(",")), given.ends.split(","), frames))
    good = True
    with concurrent.futures.ThreadPoolExecutor(given.j) as pool:
        runs = [pool.submit(run, given.program, frame, aim, ends, cords, given.limit, given.gap) for aim, cords, ends, frame in cases]
        for each in runs:
            row, right = each.result()
            good = good and right
            print("\t".join(map(str, row)), flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
