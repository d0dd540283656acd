# SPDX-License-Identifier: MIT
"""Blender add-on: a curve for each cord through the edges of the active mesh, as its modifiers leave it. Sidebar of the 3D view, tab
Thread, or Object > Thread cords through edges. The search runs beside Blender, which stays usable; Esc ends it with what there is.

Preferences > Add-ons > Install, this file. It uses the Python package thread_plan, from Blender's own Python or from the folder that is
named in its preferences; with the path of the program thread there, that is run instead (where there is no libthread)."""
import colorsys
import json
import os
import subprocess
import sys
import tempfile
import threading

import bpy

bl_info = {"name": "Thread cords", "author": "the authors of thread", "version": (0, 2, 0), "blender": (2, 93, 0), "category": "Object",
           "location": "View3D > Sidebar > Thread", "description": "Cords through the edges of a mesh, planned by thread"}

ENDS = [("best", "Best", "the feet, or anywhere, whichever takes less cord; closed if a number of cords is said"),
        ("closed", "Closed", "both ends of a cord at one node"), ("any", "Anywhere", "ends where they serve"),
        ("feet", "Feet", "ends at the lowest nodes")]
AIMS = [("usual", "Usual", "short cords that a hand can pull"), ("length", "Length", "the least cord"),
        ("turning", "Turning", "cords that turn little, and pull easily"), ("longest,length", "Even", "a short longest cord")]


def plan_cords(nodes, edges, units="mm", progress=None, program="", **options):
    """Points along each cord, and the length of all. options: cords, ends, aims, seconds, .. as Frame.plan of thread_plan has them.
    progress hears what is done and stops the search by returning True. An exception says why there is no plan."""
    frame = json.dumps({"format": "thread-frame", "version": 1, "units": units, "nodes": nodes, "edges": edges})
    if program:
        plan = _run(program, frame, progress, options)
        points, walks, length = plan["framework"]["nodes"], [c["nodes"] for c in plan["cords"]], plan["metrics"]["length"]
    else:
        import thread_plan

        read = thread_plan.parse(frame, "mesh.json").set_feet()
        plan = read.plan(progress=progress, **options)
        points, walks, length = plan.frame.nodes, [c.nodes for c in plan.cords], plan.summary.length
    return [[tuple(points[v]) for v in walk] for walk in walks], length


def _run(program, frame, progress, options):
    """The plan as the program makes it, which is ended when progress says so."""
    words = ["--%s=%s" % (name.replace("_", "-").replace("seconds", "time-limit"), value) for name, value in options.items()]
    with tempfile.TemporaryDirectory() as folder:
        given, made = os.path.join(folder, "frame.json"), os.path.join(folder, "plan.json")
        with open(given, "w") as file:
            file.write(frame)
        said = os.path.join(folder, "said")
        with open(said, "w") as words_out:
            run = subprocess.Popen([program, "plan", given, "--feet", "lowest", "-q", "-o", made] + words, stdout=subprocess.DEVNULL,
                                   stderr=words_out)
        while run.poll() is None:
            if progress and progress("planning", float("inf"), 0.0):
                run.terminate()  # the best plan so far is written
                progress = None
            try:
                run.wait(0.05)
            except subprocess.TimeoutExpired:
                pass
        if not os.path.exists(made):  # exit code 5 with a plan: not all is proved
            with open(said) as file:
                raise RuntimeError(file.read().strip() or "thread made no plan")
        with open(made) as file:
            return json.load(file)


class Search(threading.Thread):
    """A search beside Blender: nothing in it touches Blender's data."""

    def __init__(self, nodes, edges, units, program, options):
        super().__init__(daemon=True)
        self.asked = (nodes, edges, units, self.hear, program)
        self.options = options
        self.says, self.why, self.ended = "planning", "", False
        self.cords, self.length = [], 0.0

    def hear(self, what, best, bound):
        self.says = what if best == float("inf") else "%s %.6g, at least %.6g" % (what, best, bound)
        return self.ended

    def run(self):
        try:
            self.cords, self.length = plan_cords(*self.asked, **self.options)
        except Exception as why:  # of whatever kind: the operator tells it
            self.why = str(why) or type(why).__name__


class ThreadSettings(bpy.types.PropertyGroup):
    cords: bpy.props.IntProperty(name="Cords", description="in every part of the mesh; 0: as few as a hand can pull", default=0, min=0, max=1000)
    ends: bpy.props.EnumProperty(name="Ends", description="where cords end", items=ENDS, default="best")
    aims: bpy.props.EnumProperty(name="Aim", description="what the cords have little of", items=AIMS, default="usual")
    seconds: bpy.props.FloatProperty(name="Seconds", description="for the search; 0: as long as it usually takes", default=0, min=0)
    thickness: bpy.props.FloatProperty(name="Thickness", description="of the curves; 0: a tenth of the shortest edge", default=0, min=0,
                                       subtype="DISTANCE")

    def options(self):
        """What of this is said, for plan_cords."""
        said = {"cords": self.cords, "ends": self.ends if self.ends != "best" else "", "seconds": self.seconds,
                "aims": self.aims if self.aims != "usual" else ""}
        return {name: value for name, value in said.items() if value}


class ThreadPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    package: bpy.props.StringProperty(name="Folder of thread_plan", subtype="DIR_PATH", default="",
                                      description="empty: Blender's Python has it")
    program: bpy.props.StringProperty(name="Program", subtype="FILE_PATH", default="",
                                      description="thread, to be run instead of the package; empty: the package")

    def draw(self, context):
        self.layout.prop(self, "package")
        self.layout.prop(self, "program")


class OBJECT_OT_thread_cords(bpy.types.Operator):
    """Plan cords through all edges of the active mesh"""
    bl_idname = "object.thread_cords"
    bl_label = "Thread cords through edges"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == "MESH"

    def prepare(self, context):
        """A search for the active mesh, as its modifiers leave it, in metres or whatever the scene's unit is."""
        addon = context.preferences.addons.get(__name__)
        package = bpy.path.abspath(addon.preferences.package) if addon and addon.preferences.package else ""
        if package and package not in sys.path:
            sys.path.append(package)
        self.source = context.active_object
        shaped = self.source.evaluated_get(context.evaluated_depsgraph_get())
        mesh = shaped.to_mesh()
        unit = context.scene.unit_settings
        self.scale = 1.0 if unit.system == "NONE" else unit.scale_length
        nodes = [[x * self.scale for x in self.source.matrix_world @ v.co] for v in mesh.vertices]
        edges = [list(e.vertices) for e in mesh.edges]
        shaped.to_mesh_clear()
        settings = context.scene.thread_cords
        self.thickness = settings.thickness
        return Search(nodes, edges, "unit" if unit.system == "NONE" else "m", addon.preferences.program if addon else "",
                      settings.options())

    def execute(self, context):  # a script waits for it
        search = self.prepare(context)
        search.run()
        return self.finish(context, search)

    def invoke(self, context, event):  # a person does not
        self.search = self.prepare(context)
        self.search.start()
        self.timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.search.ended = True
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self.search.is_alive():
            context.workspace.status_text_set("Thread: %s (Esc: enough)" % self.search.says)
            return {"PASS_THROUGH"}
        context.workspace.status_text_set(None)
        context.window_manager.event_timer_remove(self.timer)
        return self.finish(context, self.search)

    def finish(self, context, search):
        if search.why:
            self.report({"ERROR"}, search.why)
            return {"CANCELLED"}
        thickness = self.thickness or 0.1 * min(_length(p, q) for c in search.cords for p, q in zip(c, c[1:])) / self.scale
        for number, points in enumerate(search.cords):
            curve = bpy.data.curves.new("Cord %d" % (number + 1), "CURVE")
            curve.dimensions = "3D"
            curve.bevel_depth = thickness / 2
            colour = bpy.data.materials.new(curve.name)
            colour.diffuse_color = (*colorsys.hsv_to_rgb(0.618 * number % 1, 0.7, 0.8), 1)  # golden section: no two near each other
            curve.materials.append(colour)
            spline = curve.splines.new("POLY")
            spline.points.add(len(points) - 1)
            for point, xyz in zip(spline.points, points):
                point.co = (*(x / self.scale for x in xyz), 1)
            context.collection.objects.link(bpy.data.objects.new(curve.name, curve))
        self.report({"INFO"}, "%d cords, %.6g long together" % (len(search.cords), search.length))
        return {"FINISHED"}


def _length(p, q):
    return sum((a - b) ** 2 for a, b in zip(p, q)) ** 0.5


class VIEW3D_PT_thread_cords(bpy.types.Panel):
    bl_label = "Thread cords"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Thread"

    def draw(self, context):
        for name in ["cords", "ends", "aims", "seconds", "thickness"]:
            self.layout.prop(context.scene.thread_cords, name)
        self.layout.operator(OBJECT_OT_thread_cords.bl_idname)


def menu(self, context):
    self.layout.operator(OBJECT_OT_thread_cords.bl_idname)


CLASSES = [ThreadSettings, ThreadPreferences, OBJECT_OT_thread_cords, VIEW3D_PT_thread_cords]


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.thread_cords = bpy.props.PointerProperty(type=ThreadSettings)
    bpy.types.VIEW3D_MT_object.append(menu)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(menu)
    del bpy.types.Scene.thread_cords
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)


if __name__ == "__main__":
    register()
