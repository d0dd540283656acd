#!/usr/bin/env python3
"""Frame.plan() and `thread plan` answer a question alike, byte for byte: plans.py PROGRAM. Says nothing if all is well."""
import os
import subprocess
import sys
import tempfile

from thread_plan import Frame

PROGRAM = sys.argv[1]
QUESTIONS = [
    ("", {}),
    ("--cords 3", {"cords": 3}),
    ("--cords 1..3", {"cords": (1, 3)}),
    ("--cover 2", {"cover": 2}),
    ("--distinct 2", {"distinct": 2}),
    ("--ends any", {"ends": "any"}),
    ("--joint tube", {"tube": True}),
    ("--gap 1", {"gap": 1}),
    ("--max-length 300 --ends any", {"max_length": 300, "ends": "any"}),
    ("--max-pull 30x", {"max_pull": 30}),
    ("--aims longest,length --cords 2", {"aims": "longest,length", "cords": 2}),
    ("--mu 0.1 --cord-diameter 1 --bore 2", {"physics": {"mu": 0.1, "cord_diameter": 1, "bore": 2}}),
]

with tempfile.TemporaryDirectory() as folder:
    path, out = os.path.join(folder, "frame.json"), os.path.join(folder, "plan.json")
    for shape, size in (("dome", 4), ("honeycomb", 1)):
        frame = Frame.shape(shape, size)
        for feet in ([], ["--feet", "lowest"]):
            if feet:
                frame.set_feet()
            frame.write("json", path)
            for words, asked in QUESTIONS:
                if os.path.exists(out):
                    os.remove(out)
                ran = subprocess.run([PROGRAM, "plan", path, "-o", out, *feet, *words.split()], capture_output=True, text=True)
                with open(out, "rb") as file:  # there is one, whatever was proved
                    assert frame.plan(**asked).json() == file.read(), (shape, feet, words, ran.stderr)
