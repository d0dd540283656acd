# SPDX-License-Identifier: MIT
"""Grasshopper component (GhPython or Python 3 of Rhino 8): lines in, cords out, by the program thread.

Inputs:  lines    list of lines, the framework (type hint Line, list access)
         options  text, as on the command line: --cords 4 --ends feet --feet lowest
         program  path of thread; empty: it is found in PATH
Outputs: cords    a polyline for each cord, from where it starts to where it ends
         summary  what thread says of the plan: length, bound, pull, ..
         messages notes, or why there is no plan

The part above "Rhino" knows no Rhino: thread_lines takes and gives tuples.
"""
import json
import os
import shlex
import shutil
import subprocess
import tempfile


def thread_lines(lines, options="", program=""):
    """[((x, y, z), (x, y, z)), ..] -> (cords as lists of points, summary, messages). RuntimeError: there is no plan."""
    # Ends of lines that agree to the last digit are one node here; thread merges those that only nearly do.
    index, nodes, edges = {}, [], []
    for line in lines:
        ends = []
        for point in line:
            point = tuple(float(x) for x in point)
            if point not in index:
                index[point] = len(nodes)
                nodes.append(point)
            ends.append(index[point])
        edges.append(ends)
    folder = tempfile.mkdtemp()
    try:
        frame, plan = os.path.join(folder, "frame.json"), os.path.join(folder, "plan.json")
        with open(frame, "w") as file:
            json.dump({"format": "thread-frame", "version": 1, "nodes": nodes, "edges": edges}, file)
        run = subprocess.Popen([program or "thread", "plan", frame, "-o", plan, "--json"] + shlex.split(options),
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        out, messages = run.communicate()
        if not os.path.exists(plan):  # exit code 5 with a plan: not all is proved
            raise RuntimeError(messages.strip())
        with open(plan) as file:
            made = json.load(file)
    finally:
        shutil.rmtree(folder)
    xyz = made["framework"]["nodes"]
    return [[tuple(xyz[v]) for v in cord["nodes"]] for cord in made["cords"]], json.loads(out), messages.strip()


try:
    import Rhino.Geometry as rg
except ImportError:
    rg = None
if rg and "lines" in globals():
    given = [((l.FromX, l.FromY, l.FromZ), (l.ToX, l.ToY, l.ToZ)) for l in lines]  # noqa: F821
    found, summary, messages = thread_lines(given, options or "", program or "")  # noqa: F821
    cords = [rg.Polyline([rg.Point3d(*point) for point in cord]) for cord in found]
