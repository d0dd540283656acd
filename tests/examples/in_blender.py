"""Run by Blender: the add-on makes curves as long as the least cord. PROGRAM and a framework as OBJ come after "--"."""
import math
import os
import sys

import bpy

program, dome = sys.argv[sys.argv.index("--") + 1:]
root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(root, "examples", "blender"))
import thread_cords  # noqa: E402

with open(dome) as file:
    words = [line.split() for line in file]
mesh = bpy.data.meshes.new("dome")
mesh.from_pydata([tuple(float(x) for x in w[1:4]) for w in words if w and w[0] == "v"],
                 [(int(w[1]) - 1, int(w[2]) - 1) for w in words if w and w[0] == "l"], [])
source = bpy.data.objects.new("dome", mesh)
bpy.context.collection.objects.link(source)
bpy.context.view_layer.objects.active = source
thread_cords.register()
assert bpy.ops.object.thread_cords(program=program) == {"FINISHED"}
curves = [o for o in bpy.data.objects if o.type == "CURVE"]
length = sum(math.dist(a.co[:3], b.co[:3]) for o in curves for s in o.data.splines for a, b in zip(s.points, s.points[1:]))
assert len(curves) == 1 and abs(length - 1995.248611) < 1e-3, (len(curves), length)  # Blender's numbers are floats
thread_cords.unregister()
print("blender: curves of %.3f" % length)
