#!/usr/bin/env python3
"""A tube of X pieces that is dented and let go (thesis, figure 16): tube_repair.py PROGRAM FOLDER prints the section.

A hand pushes one X piece inwards by the same force at several pulls. At a pull that holds its shape the tube comes back to it; at one
that is too low it does not.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

FORCE = 4  # N, on one piece of a tube that weighs 0.2 N
PULLS, FILMED = [0.3, 2, 8], 2  # N at every end
BACK = 1.0  # mm, of edges of 20 mm: the shape it has come back to
DENTED = 2.0  # mm, a dent that is to be seen
COMMANDS = [["make", "tube", "--size", "5", "--rings", "3", "-o", "tube.json"],
            ["plan", "tube.json", "--ends", "any", "--objective", "tortuosity", "--cords", "8", "-o", "tube-plan.json"]]


def must(right, what):
    if not right:
        raise ValueError("tube repair: " + what)


def run(program, folder, command, codes=(0,)):
    done = subprocess.run([os.path.abspath(program), *command], capture_output=True, text=True, cwd=folder)
    must(done.returncode in codes, f"thread {' '.join(command)}: exit {done.returncode}: {done.stderr}")
    return done.stdout


def rise(program, folder, pull):
    """Largest distances from the drawn shape, mm: while dented, and after."""
    command = ["rise", "tube-plan.json", "--start", "shape", "--pull", str(pull), "--dent", f"B1={FORCE}", "--tune", "time-step=2",
               "-o", f"tube-{pull}N.json", *(["--film", "tube.png", "--size", "320x240"] if pull == FILMED else [])]
    run(program, folder, command)
    with open(os.path.join(folder, f"tube-{pull}N.json"), encoding="utf-8") as text:
        seen = json.load(text)["runs"][0]
    return command, seen["dented"], seen["off"]


def said(mm):
    return f"{mm:.2g} mm" if mm < 100 else "it comes apart"


def section(program, folder):
    os.makedirs(folder, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        text = found(program, work)
        shutil.copy(os.path.join(work, "tube.png"), os.path.join(folder, "fig-16-tube.png"))
    return text


def found(program, folder):
    for command in COMMANDS:
        run(program, folder, command, codes=(0, 5))  # 5: the plan is made, not all is proved
    lines = ["## A tube that repairs itself (Fig. 16)", "",
             f"A tube of 15 pieces, those of the middle ring X pieces, in its shape on the ground. While the pull is held a hand pushes one "
             f"X piece inwards with {FORCE} N, and lets go. Told is the largest distance of a node from the drawn shape. The film shows it.",
             "", "```", *["thread " + " ".join(command) for command in COMMANDS], "```", "",
             "| pull at every end | command | while dented | let go |", "|---|---|---|---|"]
    left = []
    for pull in PULLS:
        command, dented, off = rise(program, folder, pull)
        lines.append(f"| {pull} N | `thread {' '.join(command)}` | {said(dented)} | {said(off)} |")
        left.append((dented, off))
    must(left[-1][0] > DENTED, "the hand made no dent at the highest pull")
    must(left[-1][1] < BACK, "it did not come back at the highest pull")
    must(left[0][1] > BACK, "it came back at the lowest pull, too")
    return "\n".join([*lines, "", f"![a film: pulled with {FILMED} N, dented, let go](pictures/experiments/fig-16-tube.png)", ""])


if __name__ == "__main__":
    print(section(sys.argv[1], sys.argv[2]))
