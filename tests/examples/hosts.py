"""The examples for Grasshopper, COMPAS and Blender, run without their hosts: tests/examples/hosts.py PROGRAM, with LIBTHREAD. COMPAS
and Blender are stood in for by what the examples ask of their classes. Closes with "N passed, N failed"."""
import json
import math
import os
import subprocess
import sys
import time
import types

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
for folder in ["examples/grasshopper", "examples/compas", "examples/blender", "python"]:
    sys.path.insert(0, os.path.join(ROOT, folder))


class Anything:
    """As bpy: whatever is asked for is there, and does nothing."""

    def __init__(self, *_, **__):
        pass

    def __getattr__(self, name):
        return Anything()

    def __call__(self, *_, **__):
        return Anything()


bpy = types.ModuleType("bpy")
bpy.props = bpy.data = bpy.path = bpy.utils = Anything()
bpy.types = types.SimpleNamespace(PropertyGroup=object, AddonPreferences=object, Operator=object, Panel=object, Scene=object)
sys.modules["bpy"] = bpy
import thread_plan  # noqa: E402
import thread_cords  # noqa: E402
from compas_thread import thread  # noqa: E402
from thread_component import thread_lines  # noqa: E402

PROGRAM = sys.argv[1]
LENGTH = 1995.248611  # mm, the least length of the dome with 7 x 7 nodes (data/README.md)
DOME = json.loads(subprocess.run([PROGRAM, "make", "dome"], stdout=subprocess.PIPE, check=True).stdout)
counts = {True: 0, False: 0}


def holds(what, is_so):
    counts[bool(is_so)] += 1
    if not is_so:
        print("not so: " + what)


def length(points):
    return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


class Graph:
    """As compas.datastructures.Graph, with keys that are no numbers from 0."""

    def nodes(self):
        return iter(DOME["names"])

    def node_attribute(self, key, axis):
        return DOME["nodes"][DOME["names"].index(key)]["xyz".index(axis)]

    def edges(self):
        return ((DOME["names"][a], DOME["names"][b]) for a, b in DOME["edges"])


class Mesh:
    """As compas.datastructures.Mesh."""

    def vertices(self):
        return iter(range(10, 10 + len(DOME["nodes"])))

    def vertex_coordinates(self, key):
        return DOME["nodes"][key - 10]

    def edges(self):
        return ((a + 10, b + 10) for a, b in DOME["edges"])


lines = [(tuple(DOME["nodes"][a]), tuple(DOME["nodes"][b])) for a, b in DOME["edges"]]
for program in ["", PROGRAM]:
    cords, whole, _ = thread_lines(lines, "mm", '{"cords": 1}', program)
    holds("Grasshopper: one closed cord", len(cords) == 1 and cords[0][0] == cords[0][-1])
    holds("Grasshopper: the least length", abs(length(cords[0]) - LENGTH) < 5e-7 and abs(whole - LENGTH) < 5e-7)
    holds("Grasshopper: every line has cord", {frozenset(l) for l in lines} == {frozenset(s) for s in zip(cords[0], cords[0][1:])})
    try:
        thread_lines(lines, "mm", '{"cords": 1, "capacity": 1}', program)
        holds("Grasshopper: what cannot be threaded is an error", False)
    except Exception as why:
        holds("Grasshopper: what cannot be threaded is an error in one line", str(why) and "\n" not in str(why))
try:
    thread_lines(lines, "furlong", "", "")
    holds("Grasshopper: an unknown unit is an error", False)
except ValueError as why:
    holds("Grasshopper: an unknown unit is an error", "furlong" in str(why))

keys, plan = thread(Graph(), units="m", cords=4, ends="feet", aims="longest,length", seconds=2)
graph = Graph()
xyz = {key: [graph.node_attribute(key, axis) for axis in "xyz"] for key in graph.nodes()}
holds("COMPAS: four cords between feet", len(keys) == 4 and {cord[i] for cord in keys for i in (0, -1)} <= {"A1", "A7", "G1", "G7"})
holds("COMPAS: every edge has cord", {frozenset(e) for e in graph.edges()} == {frozenset(s) for c in keys for s in zip(c, c[1:])})
holds("COMPAS: the length", abs(sum(length([xyz[k] for k in cord]) for cord in keys) - plan.summary.length) < 1e-6)
holds("COMPAS: the unit", b'"units": "m"' in plan.json())
keys, _ = thread(Graph(), feet=["D4"], cords=1, ends="feet")
holds("COMPAS: other feet", {keys[0][0], keys[0][-1]} == {"D4"})
keys, _ = thread(Mesh(), cords=1)
holds("COMPAS: a mesh", abs(length([Mesh().vertex_coordinates(k) for k in keys[0]]) - LENGTH) < 5e-7)

nodes, edges = [list(p) for p in DOME["nodes"]], [list(e) for e in DOME["edges"]]
for program in ["", PROGRAM]:
    search = thread_cords.Search(nodes, edges, "mm", program, {"cords": 1})
    search.start()
    search.join(60)
    holds("Blender: a search beside it", not search.why and len(search.cords) == 1 and abs(length(search.cords[0]) - LENGTH) < 5e-7)
    search = thread_cords.Search(nodes, edges, "mm", program, {"cords": 4, "ends": "any", "aims": "turning", "seconds": 600})
    search.start()
    time.sleep(2)
    search.ended = True
    search.join(60)
    holds("Blender: Esc ends it with what there is", not search.is_alive() and (len(search.cords) == 4 or search.why))
search = thread_cords.Search(nodes, edges, "mm", "", {"cords": 1, "capacity": 1})
search.run()
holds("Blender: what cannot be threaded is said in one line", search.why and "\n" not in search.why)
holds("the package says what it is", thread_plan.version().count(".") == 2)

print("%d passed, %d failed" % (counts[True], counts[False]))
sys.exit(counts[False] > 0)
