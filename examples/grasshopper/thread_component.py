# SPDX-License-Identifier: MIT
"""Grasshopper component (Python 3 of Rhino 8): lines in, cords out, by the package thread_plan or the program thread.

Inputs:  lines    list of lines, the framework (type hint Line, list access)
         options  text, as JSON: {"cords": 4, "ends": "feet"}; empty: the recommended plan. ends "feet" are the lowest nodes
         program  path of thread, which is run then; empty: the package thread_plan (it needs libthread)
Outputs: cords    a polyline for each cord, from where it starts to where it ends
         length   of all cords, in units of the document
         messages notes, or why there is no plan

The part above "Rhino" knows no Rhino: thread_lines takes and gives tuples.
"""
import json
import os
import shutil
import subprocess
import tempfile


def thread_lines(lines, units="mm", options="", program=""):
    """[((x, y, z), (x, y, z)), ..] -> (cords as lists of points, length of all, messages). An exception says why there is no plan."""
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
    frame = json.dumps({"format": "thread-frame", "version": 1, "units": units, "nodes": nodes, "edges": edges})
    asked = json.loads(options) if options else {}
    if program:
        plan, messages = _run(program, frame, asked)
        xyz, walks, length = plan["framework"]["nodes"], [cord["nodes"] for cord in plan["cords"]], plan["metrics"]["length"]
    else:
        import thread_plan

        read = thread_plan.parse(frame, "lines.json")
        messages = "\n".join(read.notes)
        plan = read.set_feet().plan(**asked)
        xyz, walks, length = plan.frame.nodes, [cord.nodes for cord in plan.cords], plan.summary.length
    return [[tuple(xyz[v]) for v in walk] for walk in walks], length, messages


def _run(program, frame, asked):
    """The plan by the program, and what it says. {"max_length": 900} is --max-length 900."""
    folder = tempfile.mkdtemp()
    try:
        given, made = os.path.join(folder, "frame.json"), os.path.join(folder, "plan.json")
        with open(given, "w") as file:
            file.write(frame)
        words = ["--%s=%s" % (name.replace("_", "-"), value) for name, value in asked.items()]
        run = subprocess.Popen([program, "plan", given, "--feet", "lowest", "-o", made] + words, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, universal_newlines=True)
        messages = run.communicate()[1].strip()
        if not os.path.exists(made):  # exit code 5 with a plan: not all is proved
            raise RuntimeError(messages)
        with open(made) as file:
            return json.load(file), messages
    finally:
        shutil.rmtree(folder)


try:
    import Rhino
except ImportError:
    Rhino = None
if Rhino and "lines" in globals():
    names = {"Millimeters": "mm", "Centimeters": "cm", "Decimeters": "dm", "Meters": "m", "Kilometers": "km", "Inches": "in", "Feet": "ft",
             "Yards": "yd"}
    unit = names.get(str(Rhino.RhinoDoc.ActiveDoc.ModelUnitSystem), "unit")
    given = [((l.FromX, l.FromY, l.FromZ), (l.ToX, l.ToY, l.ToZ)) for l in lines]  # noqa: F821
    found, length, messages = thread_lines(given, unit, options or "", program or "")  # noqa: F821
    cords = [Rhino.Geometry.Polyline([Rhino.Geometry.Point3d(*point) for point in cord]) for cord in found]
