# SPDX-License-Identifier: MIT
"""Plans how cord is threaded through bead structures, proves the plan, draws it.

    import thread_plan

    frame = thread_plan.Frame.shape("dome", 7)          # or Frame(xyz, edges), read("shell.obj"), parse(bytes, "a.dxf")
    plan = frame.plan()                                  # what is recommended, or cords=4, ends="feet", aims="turning"
    for cord in plan.cords:
        print(cord.name, cord.length, cord.pull_start, cord.tension)
    plan.check()
    plan.write("plan.json")
    plan.draw("svg", "overview.svg")

Lengths are in the frame's units, angles in rad, forces in N, nodes are numbers from 0. Coordinates and edges may be lists or numpy
arrays; `Frame.array()` and `Frame.edge_array()` give arrays where numpy is installed. Frames and plans are freed with their last
reference, or at the end of a `with` block. A failure is an exception with one line of text: BadInput (a ValueError), Infeasible,
NotProved, Violated, OSError, MemoryError, or Error.
"""
from __future__ import annotations

import json
import operator
import os
import signal
import threading
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_void_p, sizeof
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, TypeVar, Union

from . import _library
from ._library import BadInput, Error, Infeasible, NotProved, Violated

__all__ = ["BadInput", "Cord", "Error", "Frame", "Infeasible", "NotProved", "Plan", "Summary", "Violated", "libraries", "parse",
           "read", "version"]

Heard = Callable[[str, float, float], Optional[bool]]
Ends = Union[str, Iterable[int], Mapping[int, int]]
_ends = {"closed": 0, "any": 1, "feet": 2}


@dataclass(frozen=True)
class Cord:
    """A cord of a plan. Forces are those of the plan's evaluation; without one, of the closed form while both ends are pulled."""

    name: str
    nodes: List[int]
    length: float
    turning: float
    pull_start: float
    pull_end: float
    tension: Optional[List[float]]
    grips: Optional[int] = None
    """On the way, the fewest by which a hand of 10 N seats every pass; None: not known."""

    @property
    def ends(self) -> Tuple[int, int]:
        """The nodes where it comes out; the same for a closed cord."""
        return self.nodes[0], self.nodes[-1]

    @property
    def passes(self) -> int:
        return len(self.nodes) - 1


@dataclass(frozen=True)
class Summary:
    """A plan in numbers: bound is what no such plan goes below, pull that of the cord that needs most."""

    length: float
    bound: float
    overlap: float
    turning: float
    largest_turning: float
    pull: float
    passes: int
    u_turns: int
    shortest: bool
    straightest: bool


_Owned = TypeVar("_Owned", bound="_Owner")


class _Owner:
    """Holds a handle of the library, and frees it once."""

    _handle: c_void_p
    _free: Any

    def close(self) -> None:
        """Frees it now; nothing else can be done with it then."""
        handle, self._handle = getattr(self, "_handle", None), c_void_p()
        if handle:
            type(self)._free(handle)

    def __enter__(self: _Owned) -> _Owned:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def _open(self) -> c_void_p:
        if not self._handle:
            raise ValueError("this %s is closed" % type(self).__name__.lower())
        return self._handle


class Frame(_Owner):
    """Nodes in space and edges between them.

    xyz: n points of three numbers; edges: pairs of nodes from 0. Both are copied, and may be numpy arrays. units: "mm", "m", ..
    """

    _free = _library.lib.thread_frame_free

    def __init__(self, xyz: Iterable[Sequence[float]], edges: Iterable[Sequence[int]], units: str = "mm") -> None:
        points, pairs = [tuple(p) for p in xyz], [tuple(e) for e in edges]
        if any(len(p) != 3 for p in points) or any(len(e) != 2 for e in pairs):
            raise BadInput(_library.BAD_INPUT, "a point has three coordinates, and an edge two nodes")
        flat = [float(x) for p in points for x in p]
        nodes = [operator.index(v) for e in pairs for v in e]
        self._handle = c_void_p()
        _library.call(_library.lib.thread_frame_make, c_int(len(points)), (c_double * len(flat))(*flat), c_int(len(pairs)),
                      (c_int * len(nodes))(*nodes), units.encode(), byref(self._handle))

    def __reduce__(self) -> Any:
        return parse, (self.write("json"), "frame.json")

    @classmethod
    def _made(cls, function: Any, *args: Any) -> "Frame":
        frame = cls.__new__(cls)
        frame._handle = c_void_p()
        _library.call(function, *args, byref(frame._handle))
        return frame

    @classmethod
    def shape(cls, shape: str, size: int = 0) -> "Frame":
        """An example: "dome", "geodesic", "sphere", "tube", "honeycomb", ..; size 0 is the usual one."""
        return cls._made(_library.lib.thread_frame_shape, shape.encode(), c_int(size))

    @property
    def nodes(self) -> List[Tuple[float, float, float]]:
        xyz = POINTER(c_double)()
        n = _library.lib.thread_frame_nodes(self._open(), byref(xyz))
        flat = xyz[:3 * n]
        return list(zip(flat[0::3], flat[1::3], flat[2::3]))

    @property
    def edges(self) -> List[Tuple[int, int]]:
        ends = POINTER(c_int)()
        n = _library.lib.thread_frame_edges(self._open(), byref(ends))
        flat = ends[:2 * n]
        return list(zip(flat[0::2], flat[1::2]))

    def array(self) -> Any:
        """The nodes as a numpy array of n x 3."""
        import numpy

        return numpy.array(self.nodes, dtype=float).reshape(-1, 3)

    def edge_array(self) -> Any:
        """The edges as a numpy array of n x 2."""
        import numpy

        return numpy.array(self.edges, dtype=int).reshape(-1, 2)

    @property
    def names(self) -> List[str]:
        return [_library.lib.thread_frame_name(self._open(), c_int(i)).decode() for i in range(len(self.nodes))]

    @property
    def notes(self) -> List[str]:
        """What reading merged, dropped or found odd."""
        return _library.lib.thread_frame_notes(self._open()).decode().splitlines()

    def set_feet(self, nodes: Union[str, Iterable[int]] = "lowest") -> "Frame":
        """Says where cord ends may come out with ends="feet": at these nodes, at the "lowest" ones, all round the "rim" of a
        shell, or up to a height, "below=200mm". A mask, True or False for every node, does as well. Returns the frame."""
        if isinstance(nodes, str):
            _library.call(_library.lib.thread_frame_set_feet_where, self._open(), nodes.encode())
            return self
        feet = list(nodes)
        if feet and all(type(v).__name__ in ("bool", "bool_") for v in feet) and len(feet) == len(self.nodes):
            feet = [v for v, is_foot in enumerate(feet) if is_foot]
        feet = [operator.index(v) for v in feet]
        _library.call(_library.lib.thread_frame_set_feet, self._open(), c_int(len(feet)), (c_int * len(feet))(*feet))
        return self

    def set_passes(self, edge: int, cover: int, capacity: int = 0) -> None:
        """Says how many passes an edge needs, and how many fit through it (0 = any number)."""
        _library.call(_library.lib.thread_frame_set_passes, self._open(), c_int(edge), c_int(cover), c_int(capacity))

    def write(self, format: str = "json", path: Optional[Union[str, "os.PathLike[str]"]] = None) -> bytes:
        """The frame as "json", "obj", "csv", "ply", "dxf" or "graphml"; it is also written to path, if there is one."""
        return _kept(_library.received(_library.lib.thread_frame_write, self._open(), format.encode()), path)

    def plan(self, ends: Optional[Ends] = None, cords: Optional[Union[int, Tuple[int, int]]] = None,
             progress: Optional[Heard] = None, **options: Any) -> "Plan":
        """Makes the best plan that the time allows; Plan.proved says whether nothing is better.

        ends: "closed", "any", "feet", a list of nodes, or {node: number of ends}. cords: exactly so many, or (least, most). If
        neither cords nor aims are said, it is the recommended plan, as of `thread plan FRAME`. progress hears, in this thread and
        at least every 0.1 s, what is done, the best value and the bound, and stops the search by returning True; an exception in
        it does so, too, and is raised here. options are those of thread_plan_options in thread.h: aims="length,turning", cover,
        capacity, max_length, max_pull, physics, seconds, hand, ..
        """
        given = self._asked(ends, cords, options)
        plan = Plan.__new__(Plan)
        plan._handle = c_void_p()
        status, error = _heard(given, progress, lambda text: _library.lib.thread_plan_make(
            self._open(), byref(given), byref(plan._handle), byref(text)))
        if not plan._handle:
            raise _library.failure(status, error)
        return plan

    def advice(self, progress: Optional[Heard] = None, **options: Any) -> Dict[str, Any]:
        """Plans for every number of cords and kind of ends that may be worth it, in numbers, and which row is recommended, as
        `thread advise --json` says it. options: hand, cover, physics, seconds, ..
        """
        return self._report("advice", None, progress, options)

    def symmetries(self, ends: Optional[Ends] = None, progress: Optional[Heard] = None, **options: Any) -> Dict[str, Any]:
        """The groups of the frame's symmetries and the best threading under each, as `thread symmetries --json` says it."""
        return self._report("symmetries", ends, progress, options)

    def _asked(self, ends: Optional[Ends], cords: Optional[Union[int, Tuple[int, int]]], options: Dict[str, Any]) -> Any:
        given = _library.filled(_library.PlanOptions(), _library.lib.thread_plan_options_init, options)
        if cords is not None:
            least, most = cords if isinstance(cords, (list, tuple)) else (cords, cords)
            given.cords_least, given.cords = operator.index(least), operator.index(most)
        if isinstance(ends, str):
            if ends not in _ends:
                raise BadInput(_library.BAD_INPUT, 'ends: %r is not "closed", "any", "feet", a list of nodes or numbers of ends' % ends)
            given.ends = _ends[ends]
        elif isinstance(ends, Mapping):
            count = [int(ends.get(v, 0)) for v in range(len(self.nodes))]
            given.ends, given.end_count = 4, (c_int * len(count))(*count)
        elif ends is not None:
            node = [operator.index(v) for v in ends]
            given.ends, given.n_end_nodes, given.end_node = 3, len(node), (c_int * len(node))(*node)
        return given

    def _report(self, what: str, ends: Optional[Ends], progress: Optional[Heard], options: Dict[str, Any]) -> Dict[str, Any]:
        given = self._asked(ends, None, options)
        data, n = c_void_p(), c_size_t()
        status, error = _heard(given, progress, lambda text: _library.lib.thread_report(
            self._open(), what.encode(), byref(given), byref(data), byref(n), byref(text)))
        if not data:
            raise _library.failure(status, error)
        return json.loads(_library.taken(data, n))


class Plan(_Owner):
    """Cords through a frame, and what is proved of them."""

    _free = _library.lib.thread_plan_free

    def __init__(self, json: Union[str, bytes], name: str = "plan") -> None:
        """Reads a plan from its JSON; name is for messages."""
        text = json.encode() if isinstance(json, str) else json
        self._handle = c_void_p()
        _library.call(_library.lib.thread_plan_parse, text, c_size_t(len(text)), name.encode(), byref(self._handle))

    def __reduce__(self) -> Any:
        return Plan, (self.json(),)

    @classmethod
    def read(cls, path: Union[str, "os.PathLike[str]"]) -> "Plan":
        """Reads a plan from a file."""
        with open(path, "rb") as file:
            return cls(file.read(), os.fspath(path))

    @property
    def frame(self) -> Frame:
        """A copy of the frame of this plan."""
        return parse(_library.received(_library.lib.thread_frame_write, c_void_p(_library.lib.thread_plan_frame(self._open())), b"json"),
                     "plan.json")

    @property
    def cords(self) -> List[Cord]:
        return [self._cord(i) for i in range(_library.lib.thread_plan_cords(self._open()))]

    def _cord(self, i: int) -> Cord:
        facts = _library.CordFacts()
        _library.call(_library.lib.thread_plan_cord_summary, self._open(), c_int(i), byref(facts), c_size_t(sizeof(facts)))
        return Cord(name=facts.name.decode(), nodes=facts.node[:facts.passes + 1], length=facts.length, turning=facts.turning,
                    pull_start=facts.pull_start, pull_end=facts.pull_end,
                    tension=facts.tension[:facts.passes] if facts.tension else None, grips=facts.grips if facts.grips >= 0 else None)

    @property
    def summary(self) -> Summary:
        facts = _library.SummaryFacts()
        _library.call(_library.lib.thread_plan_summary, self._open(), byref(facts), c_size_t(sizeof(facts)))
        return Summary(length=facts.length, bound=facts.bound, overlap=facts.overlap, turning=facts.turning,
                       largest_turning=facts.largest_turning, pull=facts.pull, passes=facts.passes, u_turns=facts.u_turns,
                       shortest=bool(facts.shortest), straightest=bool(facts.straightest))

    @property
    def proved(self) -> bool:
        """Has no such plan less cord, or does none turn less?"""
        return self.summary.shortest or self.summary.straightest

    def check(self) -> None:
        """Verifies every claim of the plan without a solver; raises Violated, which says what is not true."""
        _library.call(_library.lib.thread_check, self._open())

    def eval(self, method: str = "capstan", seconds: float = 0.0, progress: Optional[Heard] = None) -> "Plan":
        """Puts pulls and tensions by "capstan", "joint" or "structure" into the plan; seconds 0 = as long as it takes."""
        given = _library.filled(_library.PlanOptions(), _library.lib.thread_plan_options_init, {"seconds": float(seconds)})
        status, error = _heard(given, progress, lambda text: _library.lib.thread_eval_with(
            self._open(), method.encode(), byref(given), byref(text)))
        if status != _library.OK:
            raise _library.failure(status, error)
        return self

    def json(self) -> bytes:
        """The plan as its file has it (docs/plan-format.md)."""
        return _library.received(_library.lib.thread_plan_write, self._open())

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the plan to a file."""
        _kept(self.json(), path)

    def draw(self, type: str = "svg", path: Optional[Union[str, "os.PathLike[str]"]] = None,
             progress: Optional[Heard] = None) -> bytes:
        """A document as `thread draw --type` makes it: "svg", "pdf", "html", "kit", "obj", ..; it is also written to path."""
        given = _library.filled(_library.PlanOptions(), _library.lib.thread_plan_options_init, {})
        data, n = c_void_p(), c_size_t()
        status, error = _heard(given, progress, lambda text: _library.lib.thread_draw_with(
            self._open(), type.encode(), byref(given), byref(data), byref(n), byref(text)))
        if status != _library.OK:
            raise _library.failure(status, error)
        return _kept(_library.taken(data, n), path)


def _heard(given: Any, progress: Optional[Heard], call: Callable[[Any], int]) -> Tuple[int, Any]:
    """Status and text of a call with these options, while progress hears how far it is. Raises what that raised."""
    raised: List[BaseException] = []

    def hear(_: Any, what: bytes, best: float, bound: float) -> int:
        try:
            return 1 if raised or progress(what.decode(), best, bound) else 0  # type: ignore[misc]
        except BaseException as reason:
            raised.append(reason)
            return 1

    # What Ctrl-C raises between two lines of a callback is lost: the search is stopped first.
    caught = progress is not None and threading.current_thread() is threading.main_thread() and (
        signal.getsignal(signal.SIGINT) is signal.default_int_handler)
    if caught:
        signal.signal(signal.SIGINT, lambda *_: raised.append(KeyboardInterrupt()))
    if progress is not None:
        given.progress = _library.Progress(hear)
    error = _library.Text()
    try:
        status = call(error)
    finally:
        if caught:
            signal.signal(signal.SIGINT, signal.default_int_handler)
    if raised:
        raise raised[0]
    return status, error


def _kept(data: bytes, path: Optional[Union[str, "os.PathLike[str]"]]) -> bytes:
    if path is not None:
        with open(path, "wb") as file:
            file.write(data)
    return data


def _read_options(options: Any) -> Any:
    return byref(_library.filled(_library.ReadOptions(), _library.lib.thread_read_options_init, options))


def read(path: Union[str, "os.PathLike[str]"], **options: Any) -> Frame:
    """Reads a frame from a file (OBJ, DXF, PLY, STL, CSV, JSON, ..). options are those of thread_read_options in thread.h:
    units="m", scale, weld, up="y", split=True, pick, ..
    """
    return Frame._made(_library.lib.thread_frame_read, os.fsencode(path), _read_options(options))


def parse(data: Union[str, bytes], name: str, **options: Any) -> Frame:
    """Reads a frame from the text of a file; name is for messages, and its ending says what it is: "shell.obj"."""
    text = data.encode() if isinstance(data, str) else bytes(data)
    return Frame._made(_library.lib.thread_frame_parse, c_char_p(text), c_size_t(len(text)), name.encode(), _read_options(options))


def version() -> str:
    """The version of the library: "0.1.0"."""
    number = _library.lib.thread_version()
    return "%d.%d.%d" % (number // 10000, number // 100 % 100, number % 100)


def libraries() -> str:
    """The versions of what is in it."""
    return _library.lib.thread_libraries().decode()
