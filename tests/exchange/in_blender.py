"""Run by Blender: reads FILE, which was drawn of PLAN with cords.csv CSV, plain or with lanes, and compares every cord."""
import os
import sys

import bpy
import numpy

numpy.bool = bool  # asked for by Blender 3.4's reader of glTF, and no longer in Debian 12's numpy
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from expected import Cords  # noqa: E402

path, plan, table, how = sys.argv[sys.argv.index("--") + 1:]
cords = Cords(plan, table)
if path.endswith(".obj") and bpy.app.version < (4, 0):
    print("blender: takes two vertices of a line only, not compared")
    sys.exit(0)
bpy.ops.wm.read_factory_settings(use_empty=True)
if path.endswith(".gltf"):
    bpy.ops.import_scene.gltf(filepath=path)
    units = 1000  # of a metre
else:
    bpy.ops.wm.obj_import(filepath=path)  # y up unless told otherwise
    units = 1
found = {o.name: o for o in bpy.data.objects if o.type == "MESH"}
assert set(found) == set(cords.path), (sorted(found), sorted(cords.path))
for name, o in found.items():
    place = [[x * units for x in o.matrix_world @ v.co] for v in o.data.vertices]
    edges = [tuple(e.vertices) for e in o.data.edges]
    if path.endswith(".obj") and how == "plain":  # through the nodes, where a mesh has no order of its edges
        cords.compare_passes(name, [(place[a], place[b]) for a, b in edges], 1e-6)
        continue
    after = {i: [] for i in range(len(place))}
    for a, b in edges:
        after[a].append(b)
        after[b].append(a)
    chain = [0]
    while len(chain) <= len(edges):
        chain.append(next(i for i in after[chain[-1]] if len(chain) < 2 or i != chain[-2]))
    cords.compare(name, [place[i] for i in chain], how == "lanes", 1e-6)
print("blender: %d cords" % len(found))
