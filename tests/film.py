#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tests/film.py TEST_FILM FOLDER: has the unit test write a film's files into FOLDER, takes the animation apart with apngdis
(Debian: apngdis, and python3-pil, for Debian's own Python; Pillow itself lays indexed pictures over each other wrongly before
10): every picture has the pixels of the numbered file of its frame, and the time that it should. Closes with
"N passed, N failed"."""
import glob
import os
import shutil
import subprocess
import sys

from PIL import Image

program, folder = sys.argv[1:3]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
subprocess.run([program], check=True, stdout=subprocess.DEVNULL, env=dict(os.environ, THREAD_FILM_FOLDER=folder))
subprocess.run(["apngdis", os.path.join(folder, "film.png"), "part"], check=True, stdout=subprocess.DEVNULL)

passed = failed = 0
files = sorted(glob.glob(os.path.join(folder, "frame-*.png")))
parts = sorted(glob.glob(os.path.join(folder, "part*.png")))


def holds(what, true):
    global passed, failed
    passed, failed = passed + bool(true), failed + (not true)
    if not true:
        print("FAIL " + what)


holds("%d frames, %d files" % (len(parts), len(files)), len(parts) == len(files) > 1)
for path, part in zip(files, parts):
    frame = Image.open(path).convert("RGB")
    holds(path + ": other pixels", Image.open(part).convert("RGB").tobytes() == frame.tobytes())
    holds(path + ": hardly a colour", len(frame.getcolors(256)) > 16)
    with open(part[:-4] + ".txt") as lines:
        shown = lines.read().strip()
    holds("%s: %s" % (path, shown), shown == ("delay=2000/1000" if path == files[-1] else "delay=40/1000"))
print("%d passed, %d failed" % (passed, failed))
sys.exit(failed > 0)
