# SPDX-License-Identifier: MIT
"""libthread from Python, through ctypes: no compiler, no other package.

    import libthread
    frame = libthread.Frame.shape("dome", 7)          # or Frame(xyz, edges), Frame.read("shell.obj")
    plan = frame.plan(cords=4, ends=libthread.FEET)   # options as in thread.h
    plan.check()
    print(plan.summary().length, plan.cords())
    open("overview.svg", "wb").write(plan.draw("svg"))

A failure is an Error with the library's line of text.
"""
import ctypes
import os
from ctypes import POINTER, byref, c_char, c_char_p, c_double, c_int, c_size_t, c_void_p

CLOSED, ANY, FEET, NODES = range(4)
OK, NOT_PROVED = 0, 5

_lib = ctypes.CDLL(os.environ.get("LIBTHREAD", "libthread.so.0"))


class Error(Exception):
    def __init__(self, status, text):
        super().__init__(text)
        self.status = status


class _Text(ctypes.Structure):
    _fields_ = [("text", c_char * 512)]


class ReadOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("edges", c_char_p), ("units", c_char_p), ("weld", c_double), ("scale", c_double),
                ("flat", c_double), ("up", c_char), ("split", c_char), ("pick", c_int), ("part", c_char_p)]


_Progress = ctypes.CFUNCTYPE(c_int, c_void_p, c_char_p, c_double, c_double)


class PlanOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("aims", c_char_p), ("request", c_char_p), ("cords_least", c_int), ("cords", c_int),
                ("cover", c_int), ("capacity", c_int), ("distinct", c_int), ("max_length", c_double), ("max_pull", c_double),
                ("tube", c_int), ("ends", c_int), ("n_end_nodes", c_int), ("end_node", POINTER(c_int)), ("physics", c_char_p),
                ("seconds", c_double), ("threads", c_int), ("progress", _Progress), ("user", c_void_p),
                ("gap", c_double)]


class Summary(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("length", c_double), ("bound", c_double), ("overlap", c_double), ("turning", c_double),
                ("largest_turning", c_double), ("pull", c_double), ("passes", c_int), ("u_turns", c_int), ("shortest", c_int),
                ("straightest", c_int)]


for _name in ["thread_libraries", "thread_frame_name", "thread_frame_notes"]:
    getattr(_lib, _name).restype = c_char_p
_lib.thread_plan_frame.restype = c_void_p


def _call(function, *args, allowed=(OK,)):
    """Calls a function whose last argument is the error; its status."""
    err = _Text()
    status = function(*args, byref(err))
    if status not in allowed:
        raise Error(status, err.text.decode())
    return status


def _bytes(function, handle, *args):
    """What a function gives as bytes to be freed."""
    data, n = c_void_p(), c_size_t()
    _call(function, handle, *args, byref(data), byref(n))
    try:
        return ctypes.string_at(data, n.value)
    finally:
        _lib.thread_free(data)


def _encoded(value):
    return value.encode() if isinstance(value, str) else value


def _filled(options, init, given):
    init(byref(options), c_size_t(ctypes.sizeof(options)))
    for name, value in given.items():
        if name not in dict(options._fields_):
            raise TypeError("there is no option " + name)
        setattr(options, name, _encoded(value))
    return options


class Frame:
    """Nodes in space and edges between them."""

    def __init__(self, xyz, edges, units="mm"):
        flat = [float(x) for point in xyz for x in point]
        ends = [v for edge in edges for v in edge]
        self._handle = c_void_p()
        _call(_lib.thread_frame_make, c_int(len(flat) // 3), (c_double * len(flat))(*flat), c_int(len(ends) // 2),
              (c_int * len(ends))(*ends), _encoded(units), byref(self._handle))

    @classmethod
    def _made(cls, function, *args):
        frame = cls.__new__(cls)
        frame._handle = c_void_p()
        _call(function, *args, byref(frame._handle))
        return frame

    @classmethod
    def shape(cls, shape, size=0):
        return cls._made(_lib.thread_frame_shape, _encoded(shape), c_int(size))

    @classmethod
    def read(cls, path, **options):
        return cls._made(_lib.thread_frame_read, os.fsencode(path),
                         byref(_filled(ReadOptions(), _lib.thread_read_options_init, options)))

    def __del__(self):
        if getattr(self, "_handle", None):
            _lib.thread_frame_free(self._handle)

    def nodes(self):
        xyz = POINTER(c_double)()
        n = _lib.thread_frame_nodes(self._handle, byref(xyz))
        return [tuple(xyz[3 * i: 3 * i + 3]) for i in range(n)]

    def edges(self):
        ends = POINTER(c_int)()
        n = _lib.thread_frame_edges(self._handle, byref(ends))
        return [tuple(ends[2 * i: 2 * i + 2]) for i in range(n)]

    def set_feet(self, nodes=None):
        """None: the lowest nodes."""
        node = (c_int * len(nodes or []))(*(nodes or []))
        _call(_lib.thread_frame_set_feet, self._handle, c_int(-1 if nodes is None else len(nodes)), node)

    def notes(self):
        return _lib.thread_frame_notes(self._handle).decode()

    def write(self, format="json"):
        return _bytes(_lib.thread_frame_write, self._handle, _encoded(format))

    def plan(self, end_nodes=None, **options):
        """The best plan in the time; plan.proved says whether nothing is better."""
        given = _filled(PlanOptions(), _lib.thread_plan_options_init, options)
        if end_nodes is not None:
            given.ends, given.n_end_nodes, given.end_node = NODES, len(end_nodes), (c_int * len(end_nodes))(*end_nodes)
        plan = Plan.__new__(Plan)
        plan._handle = c_void_p()
        err = _Text()
        status = _lib.thread_plan_make(self._handle, byref(given), byref(plan._handle), byref(err))
        if not plan._handle:
            raise Error(status, err.text.decode())
        plan.proved = status == OK
        return plan


class Plan:
    """Cords through a frame, and what is proved of them."""

    def __init__(self, json):
        json = _encoded(json)
        self._handle = c_void_p()
        _call(_lib.thread_plan_parse, json, c_size_t(len(json)), None, byref(self._handle))

    def __del__(self):
        if getattr(self, "_handle", None):
            _lib.thread_plan_free(self._handle)

    def cords(self):
        """Nodes along each cord."""
        out = []
        for i in range(_lib.thread_plan_cords(self._handle)):
            node = POINTER(c_int)()
            passes = _lib.thread_plan_cord(self._handle, c_int(i), byref(node))
            out.append(node[:passes + 1])
        return out

    def summary(self):
        out = Summary()
        _call(_lib.thread_plan_summary, self._handle, byref(out), c_size_t(ctypes.sizeof(out)))
        return out

    def check(self):
        _call(_lib.thread_check, self._handle)

    def eval(self, method="capstan", seconds=0.0):
        _call(_lib.thread_eval, self._handle, _encoded(method), c_double(seconds))

    def json(self):
        return _bytes(_lib.thread_plan_write, self._handle)

    def draw(self, type="svg"):
        return _bytes(_lib.thread_draw, self._handle, _encoded(type))


def libraries():
    return _lib.thread_libraries().decode()
