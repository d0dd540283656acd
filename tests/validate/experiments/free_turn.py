#!/usr/bin/env python3
"""How far two beads on a cord can turn (thesis, chapter 2, figures 5, 7 and 10): free_turn.py PROGRAM FOLDER prints the section.

Closed forms beside two bodies in Bullet, which are turned until they stop. The kinks, the jump and the limits that the thesis names
are asked of both.
"""
import json
import math
import os
import subprocess
import sys

BOUND, FOLDED = 3, 7  # degrees between closed form and simulation; the latter from 150 on, where bodies side by side slip off
RADIUS = 10  # mm
PIECES = [("Fig. 5", "cylinder", []), ("Fig. 7", "tube", ["--wall", "0.5"]), ("Fig. 7", "tube", ["--wall", "2"]),
          ("Fig. 10", "cone", ["--tip", "60"]), ("Fig. 10", "cone", ["--tip", "30"])]


def cylinder(part):
    """The equations of figure 5: the angle for a cord of so many radii, in degrees."""
    return math.degrees(math.asin(part) if part < 1 else math.acos(max(1 - part, -1)))


def must(right, what):
    if not right:
        raise ValueError("free turn: " + what)


def jumps(angles, side):
    """The largest simulated angle below the cone's side and the least above it."""
    return (max(found for cord, _, found in angles if cord < side), min(found for cord, _, found in angles if cord > side))


def section(program, folder):
    os.makedirs(folder, exist_ok=True)
    lines = ["## How far two beads can turn (Fig. 5, 7, 10)", "",
             "The largest angle between two beads that follow each other, against the cord that is free between them: closed form "
             "(docs/method.md) and two bodies without friction in Bullet, from three places each. Figure 5 has its kinks at one and two "
             "radii, figure 10 its jump where the cord is as long as the cone's side: the bead pops out of the hollow.", "",
             "| figure | command | cord of 180 degrees | largest difference | from 150 degrees on | |", "|---|---|---|---|---|---|"]
    pictures = []
    for figure, shape, options in PIECES:
        name = "turn-" + "-".join([shape, *options[1:]]) + ".svg"
        command = ["info", "--turn", shape, *options, "--plot", name]
        done = subprocess.run([os.path.abspath(program), *command, "--json"], capture_output=True, text=True, cwd=folder, check=True)
        angles = json.loads(done.stdout)["angles"]
        off = max(abs(found - closed) for _, closed, found in angles if closed < 150)
        folded_off = max(abs(found - closed) for _, closed, found in angles if closed >= 150)
        must(off < BOUND and folded_off < FOLDED, f"{' '.join(command)}: {off:.1f} and {folded_off:.1f} degrees off the closed form")
        note = ""
        if shape == "cylinder":
            must(all(abs(closed - cylinder(cord / RADIUS)) < 0.01 for cord, closed, _ in angles), "not the equations of figure 5")
        if shape == "cone":
            side = RADIUS / math.sin(math.radians(float(options[1])))
            below, above = jumps(angles, side)
            must(below < 90 < above, f"no jump at {side:.3g} mm")
            note = f"jumps from {below:.0f} to {above:.0f} degrees about {side:.3g} mm"
        folded = next(cord for cord, closed, _ in angles if closed > 180 - 1e-6)
        lines.append(f"| {figure} | `thread {' '.join(command)}` | below {folded:.3g} mm | {off:.1f} degrees | {folded_off:.1f} degrees | {note} |")
        pictures.append(f"![{shape}: largest angle against free cord](pictures/experiments/{name})")
    return "\n".join([*lines, "", *pictures, ""])


if __name__ == "__main__":
    print(section(sys.argv[1], sys.argv[2]))
