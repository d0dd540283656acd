# SPDX-License-Identifier: MIT
"""libthread through ctypes: its structs, its functions, and its failures as exceptions.

include/thread.h says what each function does; nothing here does more than hand values over.
"""
from __future__ import annotations

import ctypes
import json
import numbers
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


# What an option that is text for C may be.
_texts = {"aims": 'aims are words, as "length,pull" or ["length", "pull"]',
          "physics": '%s are a mapping, as {"mu": 0.3}, or its JSON', "request": "%s is a mapping, or its JSON"}


def _number(value: Any) -> Any:
    """A number of numpy, or a mapping, as json knows it."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        return float(value)
    raise TypeError("%r is neither number nor text" % (value,))


def text(name: str, value: Any) -> bytes:
    """Text for C. TypeError."""
    if not isinstance(value, str):
        raise TypeError("%s: %r is no text" % (name, value))
    return value.encode()


def encoded(name: str, value: Any) -> bytes:
    """Text for an option: a mapping as its JSON, a list of words with commas. TypeError."""
    if isinstance(value, Mapping) and name in ("physics", "request"):
        try:  # NaN and infinity become texts, so that the library says at which key there is no number
            value = json.dumps(json.loads(json.dumps(dict(value), default=_number), parse_constant=str))
        except TypeError as reason:
            raise TypeError("%s: %s" % (name, reason)) from None
    elif isinstance(value, (list, tuple)) and name == "aims" and all(isinstance(word, str) for word in value):
        value = ",".join(value)
    if isinstance(value, bytes) and name in _texts:
        return value
    if not isinstance(value, str) and name in _texts:
        raise TypeError("%s: %r is none: %s" % (name, value, _texts[name].replace("%s", name)))
    return text(name, value)


def is_flag(value: Any) -> bool:
    """True or False, of numpy, too."""
    return type(value).__name__ in ("bool", "bool_")


def whole(name: str, value: Any) -> int:
    """The integer, of any type that has integers, if a C int holds it. TypeError, BadInput."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError("%s: %r is no integer" % (name, value)) from None
    if is_flag(value):
        raise BadInput(BAD_INPUT, "%s: %r is no number" % (name, value))
    if not -2**31 <= number < 2**31:
        raise BadInput(BAD_INPUT, "%s: %r is beyond what counts here" % (name, value))
    return number


def real(name: str, value: Any) -> float:
    """The number, of any type that has numbers. TypeError, BadInput."""
    if is_flag(value):
        raise BadInput(BAD_INPUT, "%s: %r is no number" % (name, value))
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        return float(value)
    except TypeError:
        raise TypeError("%s: %r is no number" % (name, value)) from None


def ints(name: str, values: Iterable[Any]) -> Any:
    """An array of C ints."""
    found = [whole("%s[%d]" % (name, i), value) for i, value in enumerate(values)]
    return (c_int * len(found))(*found)


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
        if name == "tube" and is_flag(value):
            value = int(value)
        if kind is c_int:
            value = whole(name, value)
        elif kind is c_double:
            value = real(name, value)
        elif kind is c_char and name == "up":
            value = text(name, value)[:2]
            if len(value) != 1:
                raise BadInput(BAD_INPUT, 'up: "y" or "z"')
        elif kind is c_char:
            if not is_flag(value):
                raise TypeError("%s: %r is neither True nor False" % (name, value))
            value = bytes([value])
        else:
            value = encoded(name, value)
        if kind in (c_int, c_double) and usual < 0 and value < 0:  # which says nothing in C
            raise BadInput(BAD_INPUT, "%s: %r is below 0; without it what is usual is taken" % (name, value))
        setattr(options, name, value)
    return options
