"""The examples for Grasshopper and COMPAS, run without their hosts: tests/examples/hosts.py PROGRAM. COMPAS is stood in for by what
the example asks of its classes. Closes with "N passed, N failed"."""
import json
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
for folder in ["grasshopper", "compas"]:
    sys.path.insert(0, os.path.join(ROOT, "examples", folder))
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
cords, summary, _ = thread_lines(lines, "--cords 1", PROGRAM)
holds("Grasshopper: one closed cord", len(cords) == 1 and cords[0][0] == cords[0][-1])
holds("Grasshopper: the least length", abs(length(cords[0]) - LENGTH) < 5e-7 and abs(summary["length"] - LENGTH) < 5e-7)
holds("Grasshopper: every line has cord", {frozenset(l) for l in lines} == {frozenset(s) for s in zip(cords[0], cords[0][1:])})
try:
    thread_lines(lines, "--capacity 1", PROGRAM)
    holds("Grasshopper: what cannot be threaded is an error", False)
except RuntimeError as why:
    holds("Grasshopper: what cannot be threaded is an error in one line", "\n" not in str(why) and str(why).startswith("thread: "))

keys, summary = thread(Graph(), PROGRAM, cords=4, ends="feet", feet="lowest", balance=True)
graph = Graph()
xyz = {key: [graph.node_attribute(key, axis) for axis in "xyz"] for key in graph.nodes()}
holds("COMPAS: four cords between feet", len(keys) == 4 and {cord[i] for cord in keys for i in (0, -1)} <= {"A1", "A7", "G1", "G7"})
holds("COMPAS: every edge has cord", {frozenset(e) for e in graph.edges()} == {frozenset(s) for c in keys for s in zip(c, c[1:])})
holds("COMPAS: the length", abs(sum(length([xyz[k] for k in cord]) for cord in keys) - summary["length"]) < 1e-6)
keys, summary = thread(Mesh(), PROGRAM, cords=1)
holds("COMPAS: a mesh", abs(length([Mesh().vertex_coordinates(k) for k in keys[0]]) - LENGTH) < 5e-7)

print("%d passed, %d failed" % (counts[True], counts[False]))
sys.exit(counts[False] > 0)
