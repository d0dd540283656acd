#!/usr/bin/env python3
"""Does thr_json_parse read what Python's json module reads, and refuse what that refuses?

tests/second/read_json.py DUMP_JSON [--texts N] [--seed S]

Texts are mutants of the fuzzers' seeds and of some with every kind of value. Where the two are meant to differ (graph/io/json.h) Python is
told so: a document is a list or an object, keys are not repeated, integers fit 64 bits, numbers are finite, no text holds a NUL, and a
byte order mark may come first; the sign of zero is left out. Prints what differs, then "N passed, N failed".
"""
import argparse
import json
import math
import os
import random
import re
import struct
import subprocess
import sys

SEEDS = [b'{"a":[1,2.5,-3e10,true,false,null,"x\\u00e9\\n\\ud83d\\ude00"],"b":{"c":[]},"d":{}}', b"[]", b" \t\n\r[ 1 , 2 ]\n", b"[1e400]",
         b"[0.1,1e-320,123456789012345678,-0,-0.0,9007199254740993,9223372036854775808,9223372036854775807]",
         '{"é":"ü€😀"}'.encode()]
PIECES = [b"{", b"}", b"[", b"]", b",", b":", b'"', b"\\", b"\\u", b"\\ud800", b"\\udc00", b"\\u0000", b"0", b"1", b"-", b"+", b".", b"e",
          b"E5", b"01", b"1.", b".5", b"1e", b"true", b"nul", b"\0", b"\xff", b"\xc3\xa9", b"\xed\xa0\x80", b"\xf4\x90\x80\x80",
          b"\xc0\x80", b"\x7f", b"\x1f", b"/", b"\\/", b"\xef\xbb\xbf", b"NaN", b"Infinity", b"1e309", b"1e-400", b" ", b"\n",
          b'"a":1,"a":2']


def mutant(text, draw):
    text = bytearray(text)
    for _ in range(draw.choice([1, 1, 1, 2, 3, 6])):
        i, way = draw.randrange(len(text) + 1), draw.randrange(4)
        if way == 0:
            del text[i:i + draw.randrange(1, 6)]
        elif way == 1:
            text[i:i + 1] = bytes([draw.randrange(256)])
        elif way == 2:
            j = draw.randrange(len(text) + 1)
            text[i:i] = text[min(i, j):max(i, j)][:50]
        else:
            text[i:i + draw.randrange(2)] = draw.choice(PIECES)
    return bytes(text)


def refuse(_):
    raise ValueError


def no_repeated_keys(members):
    if len(dict(members)) < len(members):
        raise ValueError
    return dict(members)


def integer(digits):
    return float(int(digits)) if -2**63 <= int(digits) < 2**63 else refuse(digits)


def finite(digits):
    return refuse(digits) if math.isinf(float(digits)) else float(digits)


def written(value):
    """As dump_json writes it."""
    if isinstance(value, str):
        return '"' + value.encode().hex() + '"' if "\0" not in value else refuse(value)
    if isinstance(value, list):
        return "[" + ",".join(written(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{" + ",".join(written(k) + ":" + written(v) for k, v in value.items()) + "}"
    return {None: "null", True: "true", False: "false"}[value] if not isinstance(value, float) else repr(value + 0.0)


def by_python(text):
    try:
        value = json.loads(text.decode().removeprefix("\ufeff"), object_pairs_hook=no_repeated_keys, parse_constant=refuse,
                           parse_float=finite, parse_int=integer)
        return written(value) if isinstance(value, (list, dict)) else "error"
    except ValueError:
        return "error"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dump")
    parser.add_argument("--texts", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    draw, seeds, corpus = random.Random(a.seed), list(SEEDS), os.path.join(os.path.dirname(__file__), "..", "fuzz", "corpus")
    for folder in sorted(os.listdir(corpus)):
        for name in sorted(os.listdir(os.path.join(corpus, folder))):
            with open(os.path.join(corpus, folder, name), "rb") as file:
                text = file.read(3001)
            if len(text) <= 3000 and text.lstrip()[:1] in (b"{", b"["):
                seeds.append(text)
    texts = seeds + [mutant(draw.choice(seeds), draw) for _ in range(a.texts)]
    lines = subprocess.run([a.dump], input=b"".join(struct.pack("=I", len(t)) + t for t in texts), stdout=subprocess.PIPE,
                           check=True).stdout.decode().split("\n")
    failed = 0
    for text, line in zip(texts, lines):
        ours = re.sub(r"-?0x[0-9a-f.]+p[+-]\d+", lambda m: repr(float.fromhex(m.group(0)) + 0.0), line)
        if ours != by_python(text):
            failed += 1
            print(f"{text!r}\n  thread: {ours}\n  Python: {by_python(text)}")
    print(f"{len(texts) - failed} passed, {failed} failed")
    return 1 if failed or len(lines) != len(texts) + 1 else 0


if __name__ == "__main__":
    sys.exit(main())
