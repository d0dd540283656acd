# SPDX-License-Identifier: MIT
"""libthread through ctypes: its structs, its functions, and its failures as exceptions.

include/thread.h says what each function does; nothing here does more than hand values over.
"""
from __future__ import annotations

import ctypes
import json
import operator
import os
from ctypes import POINTER, byref, c_char, c_char_p, c_double, c_int, c_size_t, c_void_p
from typing import Any, Iterable, Mapping

OK, NO_MEMORY, IO, BAD_INPUT, INFEASIBLE, NOT_PROVED, SOLVER, VIOLATED = range(8)
Progress = ctypes.CFUNCTYPE(c_int, c_void_p, c_char_p, c_double, c_double)


class Error(Exception):
    """What a call could not do. The text is one line: where, what, and what to do."""

    status: int

    def __init__(self, status: int, text: str) -> None:
        super().__init__(text)
        self.status = status

    def __reduce__(self) -> Any:
        return type(self), (self.status, str(self))


class BadInput(Error, ValueError):
    """A file, a frame or an option is wrong."""


class Infeasible(Error):
    """There is no threading with these options."""


class NotProved(Error):
    """The search was stopped before it had found any threading."""


class Violated(Error):
    """A claim of the plan is not true."""


_classes = {BAD_INPUT: BadInput, INFEASIBLE: Infeasible, NOT_PROVED: NotProved, VIOLATED: Violated}


class Text(ctypes.Structure):
    _fields_ = [("text", c_char * 512)]


class ReadOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("edges", c_char_p), ("units", c_char_p), ("weld", c_double), ("scale", c_double),
                ("flat", c_double), ("up", c_char), ("split", c_char), ("pick", c_int), ("part", c_char_p),
                ("all_layers", c_char), ("parallel", c_char), ("columns", c_char_p)]


class PlanOptions(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("aims", c_char_p), ("request", c_char_p), ("cords_least", c_int), ("cords", c_int),
                ("cover", c_int), ("capacity", c_int), ("distinct", c_int), ("max_length", c_double),
                ("max_pull", c_double), ("tube", c_int), ("ends", c_int), ("n_end_nodes", c_int),
                ("end_node", POINTER(c_int)), ("physics", c_char_p), ("seconds", c_double), ("threads", c_int),
                ("progress", Progress), ("user", c_void_p), ("gap", c_double),
                ("end_count", POINTER(c_int)), ("hand", c_double)]


class CordFacts(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("name", c_char_p), ("passes", c_int), ("start", c_int), ("end", c_int),
                ("length", c_double), ("turning", c_double), ("pull_start", c_double), ("pull_end", c_double),
                ("tension", POINTER(c_double)), ("node", POINTER(c_int)), ("grips", c_int)]


class SummaryFacts(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("length", c_double), ("bound", c_double), ("overlap", c_double),
                ("turning", c_double), ("largest_turning", c_double), ("pull", c_double), ("passes", c_int),
                ("u_turns", c_int), ("shortest", c_int), ("straightest", c_int), ("stopped", c_int)]


def _load() -> ctypes.CDLL:
    """The library named by LIBTHREAD, else the one of this package, else of the prefix that it is in, else the system's."""
    here = os.path.dirname(os.path.abspath(__file__))
    beside = [os.path.join(here, "lib", "libthread.so.0"), os.path.join(here, "..", "..", "..", "libthread.so.0")]
    named = os.environ.get("LIBTHREAD")
    try:
        return ctypes.CDLL(named or next((path for path in beside if os.path.exists(path)), "libthread.so.0"))
    except OSError as reason:
        raise ImportError("libthread is not installed: `make install`, or LIBTHREAD=/path/to/libthread.so.0 (%s)" % reason) from None


lib = _load()
for _name in ["thread_libraries", "thread_frame_name", "thread_frame_notes"]:
    getattr(lib, _name).restype = c_char_p
lib.thread_plan_frame.restype = c_void_p


def encoded(value: Any) -> Any:
    """Text as bytes, a mapping as its JSON, a list of words with commas."""
    if isinstance(value, Mapping):
        # NaN and infinity become texts, so that the library says at which key there is no number.
        value = json.dumps(json.loads(json.dumps(value), parse_constant=str))
    elif isinstance(value, (list, tuple)) and all(isinstance(word, str) for word in value):
        value = ",".join(value)
    return value.encode() if isinstance(value, str) else value


def whole(name: str, value: Any) -> int:
    """The integer, of any type that has integers, if a C int holds it. TypeError, BadInput."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError("%s: %r is no integer" % (name, value)) from None
    if type(value).__name__ in ("bool", "bool_") or not -2**31 <= number < 2**31:
        raise BadInput(BAD_INPUT, "%s: %r is no number of anything" % (name, value))
    return number


def ints(name: str, values: Iterable[Any]) -> Any:
    """An array of C ints."""
    numbers = [whole("%s[%d]" % (name, i), value) for i, value in enumerate(values)]
    return (c_int * len(numbers))(*numbers)


def call(function: Any, *args: Any) -> None:
    """Calls a function whose last argument is the error."""
    error = Text()
    status = function(*args, byref(error))
    if status != OK:
        raise failure(status, error)


# What texts for C name otherwise than this package.
_names = [("thread_frame_set_feet", "set_feet"), ("thread_plan_options.", ""), ("cords_least", "the least of cords"), ("end_node", "ends"),
          ("end_count", "ends"), ("stopped by progress", "stopped")]


def failure(status: int, error: Text) -> Exception:
    """The exception for a status, with the text of the error."""
    text = str(error.text.decode())
    for name, here in _names:
        text = text.replace(name, here)
    if status == NO_MEMORY:
        return MemoryError(text)
    if status == IO:
        return OSError(text)
    return _classes.get(status, Error)(status, text)


def received(function: Any, handle: c_void_p, *args: Any) -> bytes:
    """The bytes that a function gives to be freed."""
    data, n = c_void_p(), c_size_t()
    call(function, handle, *args, byref(data), byref(n))
    return taken(data, n)


def taken(data: c_void_p, n: c_size_t) -> bytes:
    """A copy of bytes that the library gave, which are freed."""
    try:
        return ctypes.string_at(data, n.value)
    finally:
        lib.thread_free(data)


def filled(options: Any, init: Any, given: Mapping[str, Any]) -> Any:
    """The struct with its usual values, and those that are given and not None."""
    init(byref(options), c_size_t(ctypes.sizeof(options)))
    known = dict(options._fields_)
    for name, value in given.items():
        if value is None:
            continue
        kind, usual = known[name], getattr(options, name)
        try:
            if kind is c_int and name != "tube":
                value = whole(name, value)
            if kind in (c_int, c_double) and usual < 0 and value < 0:  # which says nothing in C
                raise BadInput(BAD_INPUT, "%s: %r is below 0; without it what is usual is taken" % (name, value))
            if kind is c_double and isinstance(value, bool):
                raise BadInput(BAD_INPUT, "%s: %r is no number of anything" % (name, value))
            setattr(options, name, bytes([value]) if kind is c_char and isinstance(value, bool) else encoded(value))
        except TypeError:
            raise TypeError("option %s: %r is no value for it" % (name, value)) from None
    return options
