"""Run by Blender: the add-on makes curves as long as the least cord, of what modifiers leave. A framework as OBJ comes after "--"."""
import math
import os
import sys

import bpy

(dome,) = sys.argv[sys.argv.index("--") + 1:]
root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path[:0] = [os.path.join(root, "examples", "blender"), os.path.join(root, "python")]
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
settings = bpy.context.scene.thread_cords
settings.cords = 1
settings.thickness = 3
bpy.context.scene.unit_settings.scale_length = 0.001
assert bpy.ops.object.thread_cords() == {"FINISHED"}
curves = [o for o in bpy.data.objects if o.type == "CURVE"]
length = sum(math.dist(a.co[:3], b.co[:3]) for o in curves for s in o.data.splines for a, b in zip(s.points, s.points[1:]))
assert len(curves) == 1 and abs(length - 1995.248611) < 1e-2, (len(curves), length)  # Blender's numbers are floats
assert curves[0].data.bevel_depth == 1.5

# Modifiers are heeded: two copies are two parts, with a cord each.
bpy.data.objects.remove(curves[0])
array = source.modifiers.new("twice", "ARRAY")
array.use_relative_offset, array.use_constant_offset = False, True
array.constant_offset_displace = (0, 0, 1000)
bpy.context.view_layer.update()
assert bpy.ops.object.thread_cords() == {"FINISHED"}
curves = [o for o in bpy.data.objects if o.type == "CURVE"]
assert len(curves) == 2, len(curves)
thread_cords.unregister()
print("blender: curves of %.3f" % length)
