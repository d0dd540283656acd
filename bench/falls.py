#!/usr/bin/env python3
"""Bullet as a witness for the limit analysis: at which pull does each structure fall, and what does the limit analysis say?

bench/falls.py PROGRAM [--seeds 1,2,3] [--steps 1,0.5] [-j N] [--only REGEX] [--append FILE.md] [PLAN ..] > table.tsv
bench/falls.py --read table.tsv .. --append FILE.md

Every plan is simulated with every seed and every factor on the time step (`thread eval --method structure --dynamics --json`); without PLANs
those of PLANS below are made first. A line of the table: plan, beads, the pulls between which it must fall (below the first
nothing holds it, at the second an equilibrium exists), seed, step, what came out, the fall and its error in newtons, the fall as a
part of either pull, processor seconds. The last lines count. --append writes a summary, a row
for each plan, at the end of a file, also from tables that were written before. Exit code 1 if any fall is told that is not within
[0.95 lower, 1.05 upper]: the program promises to say "not settled" instead.
"""
import argparse
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

TURNING = "--objective tortuosity --minimize turning --tune nodes=50"
PLANS = {  # name: (what to make, how to plan)
    "dome 3": ("dome --size 3", ""),
    "dome 4": ("dome --size 4", ""),
    "dome 5": ("dome --size 5", ""),
    "dome 5, 2 cords": ("dome --size 5", "--cords 2"),
    "dome 6": ("dome --size 6", ""),
    "dome 6, 3 cords": ("dome --size 6", "--cords 3 --ends any"),
    "dome 7": ("dome --size 7", ""),
    "dome 7, 4 cords": ("dome --size 7", "--cords 4 --ends any"),
    "dome 8, straight": ("dome --size 8", TURNING + " --ends any --cords 16"),
    "dome 10, straight": ("dome --size 10", TURNING + " --ends any --cords 20"),
    "dome 14, straight": ("dome --size 14", TURNING + " --ends any --cords 28"),
    "dome 20, straight": ("dome --size 20", TURNING + " --ends any --cords 40"),
    "honeycomb 2": ("honeycomb --size 2", ""),
    "honeycomb 2, 8 cords": ("honeycomb --size 2", TURNING + " --ends any --cords 8"),
    "honeycomb 3": ("honeycomb --size 3", "--cords 4 --ends any"),
    "honeycomb 3, 12 cords": ("honeycomb --size 3", TURNING + " --ends any --cords 12"),
    "sphere 1": ("sphere --size 1", ""),
    "sphere 2, 3 cords": ("sphere --size 2", "--cords 3 --ends any"),
    "lines": ("data/dome7-lines.json", None),
    "stairs": ("data/dome7-stairs.json", None),
    "snake": ("data/dome7-snake.json", None),
}
LARGE = {  # ten minutes and more a run: only where --only names them
    "dome 31, 62 cords": ("dome --size 31", TURNING + " --ends any --cords 62"),
    "dome 31, 60 cords": ("dome --size 31", TURNING + " --ends any --cords 60"),
    "dome 31, 56 cords": ("dome --size 31", TURNING + " --ends any --cords 56"),
}


def make_plans(program, folder, only):
    """The plans' names and files."""
    made = []
    for name, (shape, options) in {**PLANS, **(LARGE if only else {})}.items():
        if not re.search(only, name):
            continue
        if options is None:
            made.append((name, shape))
            continue
        frame, plan = os.path.join(folder, "frame.json"), os.path.join(folder, name.replace(" ", "-") + ".json")
        subprocess.run([program, "make", *shlex.split(shape), "-o", frame], check=True)
        subprocess.run([program, "plan", frame, *shlex.split(options or "--cords 1"), "-q", "-o", plan], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        made.append((name, plan))
    return made


def simulate(program, plan, seed, step):
    """What the program answers, and its processor seconds; None if it cannot say."""
    command = [program, "eval", plan, "--method", "structure", "--dynamics", "--json", "-q", "--seed", seed, "--tune", "time-step=" + str(step)]
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read()
    return (json.loads(text) if process.returncode == 0 else None), usage.ru_utime + usage.ru_stime


def beads_of(plan):
    with open(plan, encoding="utf-8") as file:
        return len(json.load(file)["framework"]["nodes"])


def line_of(name, plan, seed, step, answer, seconds):
    """A line of the table, and whether its fall is where it may be (None: no fall is told)."""
    if answer is None or "simulation" not in answer:
        return "\t".join([name, str(beads_of(plan)), "-", "-", seed, step, "no pull holds it, or none is needed"]), None
    holding, found = answer["holding"], answer["simulation"]
    lower, upper = holding["lower"], holding["upper"] if holding["upper"] is not None else float("inf")
    said = [name, str(beads_of(plan)), "%.5g" % lower, "%.5g" % upper, seed, step]
    if found["status"] != "fell":
        return "\t".join(said + [found["status"] + (": " + found["why"] if "why" in found else ""), "", "", "", "", "%.0f" % seconds]), None
    fall = found["falls_at"]
    ratios = ["%.3f" % (fall / lower) if lower > 0 else "", "%.3f" % (fall / upper)]
    inside = 0.95 * lower <= fall <= 1.05 * upper
    return "\t".join(said + ["fell", "%.5g" % fall, "%.2g" % found["falls_error"]] + ratios + ["%.0f" % seconds]), inside


def section(rows):
    """What the rows of a table say of each plan, as a section of docs/validation.md."""
    plans = {}
    for row in rows:
        plans.setdefault(row[0], []).append(row)
    lines = ["", "## Bullet as a witness, by the command line", "",
             "`bench/falls.py`: the pull at which the structure falls in Bullet as a part of that below which nothing holds it and of that at which an equilibrium exists (friction pyramids of 8 rays), "
             "over seeds and time steps. Told must be within [0.95 lower, 1.05 upper]; what is not told is \"not settled\".", "",
             "| plan | beads | lower, N | upper, N | runs | told | / lower | / upper | s each | |", "|---|---|---|---|---|---|---|---|---|---|"]
    for name, of in plans.items():
        told = [row for row in of if row[6] == "fell"]
        spread = ["%s .. %s" % (min(row[k] for row in told), max(row[k] for row in told)) if told else "" for k in (9, 10)]
        ok = all(0.95 * float(row[2]) <= float(row[7]) <= 1.05 * float(row[3]) for row in told)
        seconds = "%.0f" % (sum(float(row[-1]) for row in of) / len(of))
        lines.append("| " + " | ".join([name, of[0][1], of[0][2], of[0][3], str(len(of)), str(len(told)), *spread, seconds, "ok" if ok else "OUTSIDE"]) + " |")
    told = sum(row[6] == "fell" for row in rows)
    silent = ["%s, seed %s, step %s" % (row[0], row[4], row[5]) for row in rows if row[6] != "fell"]
    whole = [name for name, of in plans.items() if len({(row[4], row[5]) for row in of}) >= 20]
    lines += ["", "%d runs, %d told, %d not settled%s. %d of %d plans went through 10 seeds and 2 time steps or more." % (
        len(rows), told, len(silent), ": " * bool(silent) + "; ".join(silent), len(whole), len(plans)), ""]
    return "\n".join(lines)


def append(path, rows):
    with open(path, "a", encoding="utf-8") as file:
        file.write(section(rows))


def read_tables(paths):
    rows = []
    for path in paths:
        with open(path, encoding="utf-8") as file:
            rows += [line.rstrip("\n").split("\t") for line in file if line.count("\t") == 11 and not line.startswith("plan\t")]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--read", nargs="+", metavar="TABLE", help="tables written before, instead of simulating")
    parser.add_argument("--append", metavar="FILE.md")
    parser.add_argument("--seeds", default="1,2,3")
    parser.add_argument("--steps", default="1,0.5")
    parser.add_argument("-j", type=int, default=1)
    parser.add_argument("--only", default="", help="those whose names have it, the largest too")
    parser.add_argument("plans", nargs="*", metavar="PLAN")
    a = parser.parse_args()
    if a.read:
        append(a.append, read_tables(a.read))
        return 0
    if not a.program:
        parser.error("which program?")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        plans = [(os.path.basename(p), p) for p in a.plans] or make_plans(a.program, folder, a.only)
        jobs = [(name, plan, seed, step) for name, plan in plans for seed in a.seeds.split(",") for step in a.steps.split(",")]
        print("\t".join(["plan", "beads", "lower", "upper", "seed", "step", "found", "falls at", "+-", "/ lower", "/ upper", "s"]))
        told, outside, silent = 0, 0, 0
        with concurrent.futures.ThreadPoolExecutor(a.j) as pool:
            answers = pool.map(lambda job: simulate(a.program, *job[1:]), jobs)
            for (name, plan, seed, step), (answer, seconds) in zip(jobs, answers):
                line, inside = line_of(name, plan, seed, step, answer, seconds)
                print(line, flush=True)
                rows.append(line.split("\t"))
                told += inside is not None
                outside += inside is False
                silent += inside is None
    if a.append:
        append(a.append, [row for row in rows if len(row) == 12])
    print("%d falls told, %d of them outside [0.95 lower, 1.05 upper]; %d not told" % (told, outside, silent))
    return 1 if outside else 0


if __name__ == "__main__":
    sys.exit(main())
