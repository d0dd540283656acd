# SPDX-License-Identifier: MIT
"""Blender add-on: Object > Thread cords through edges. A curve for each cord through the edges of the active mesh, by the program
thread. Preferences > Add-ons > Install, this file; the place of the program is in its preferences."""
import json
import os
import shlex
import subprocess
import tempfile

import bpy

bl_info = {"name": "Thread cords", "author": "the authors of thread", "version": (0, 1, 0), "blender": (2, 93, 0), "category": "Object",
           "location": "Object > Thread cords through edges", "description": "Cords through the edges of a mesh, planned by thread"}


def plan_cords(nodes, edges, options="", program="thread"):
    """Points along each cord, and the summary. RuntimeError: there is no plan; its text says why."""
    frame = {"format": "thread-frame", "version": 1, "units": "unit", "nodes": nodes, "edges": edges}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plan.json")
        run = subprocess.run([program, "plan", "-", "-o", path, "--json"] + shlex.split(options), input=json.dumps(frame),
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if not os.path.exists(path):  # exit code 5 with a plan: not all is proved
            raise RuntimeError(run.stderr.strip())
        with open(path) as file:
            plan = json.load(file)
    xyz = plan["framework"]["nodes"]
    return [[xyz[v] for v in cord["nodes"]] for cord in plan["cords"]], json.loads(run.stdout)


class ThreadPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH", default="thread")

    def draw(self, context):
        self.layout.prop(self, "program")


class OBJECT_OT_thread_cords(bpy.types.Operator):
    """Plan cords through all edges of the active mesh"""
    bl_idname = "object.thread_cords"
    bl_label = "Thread cords through edges"
    bl_options = {"REGISTER", "UNDO"}

    options: bpy.props.StringProperty(name="Options", description="as on the command line", default="")
    program: bpy.props.StringProperty(name="Program", description="empty: as in the preferences", default="")

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == "MESH"

    def execute(self, context):
        source = context.active_object
        addon = context.preferences.addons.get(__name__)
        program = self.program or (addon.preferences.program if addon else "thread")
        nodes = [list(source.matrix_world @ v.co) for v in source.data.vertices]
        edges = [list(e.vertices) for e in source.data.edges]
        try:
            cords, summary = plan_cords(nodes, edges, self.options, program)
        except (OSError, RuntimeError, ValueError) as why:
            self.report({"ERROR"}, str(why))
            return {"CANCELLED"}
        for number, points in enumerate(cords):
            curve = bpy.data.curves.new("Cord %d" % (number + 1), "CURVE")
            curve.dimensions = "3D"
            spline = curve.splines.new("POLY")
            spline.points.add(len(points) - 1)
            for point, xyz in zip(spline.points, points):
                point.co = (*xyz, 1)
            context.collection.objects.link(bpy.data.objects.new(curve.name, curve))
        self.report({"INFO"}, "%d cords, %.6g long together" % (len(cords), summary["length"]))
        return {"FINISHED"}


def menu(self, context):
    self.layout.operator(OBJECT_OT_thread_cords.bl_idname)


def register():
    bpy.utils.register_class(ThreadPreferences)
    bpy.utils.register_class(OBJECT_OT_thread_cords)
    bpy.types.VIEW3D_MT_object.append(menu)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(menu)
    bpy.utils.unregister_class(OBJECT_OT_thread_cords)
    bpy.utils.unregister_class(ThreadPreferences)


if __name__ == "__main__":
    register()
