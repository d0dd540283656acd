#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plans a dome with libthread, checks the plan and draws it: dome.py [PICTURE.svg] prints the length of cord in mm."""
import sys

import libthread

plan = libthread.Frame.shape("dome", 7).plan()
plan.check()
print("%.6f" % plan.summary().length)
if len(sys.argv) > 1:
    with open(sys.argv[1], "wb") as picture:
        picture.write(plan.draw("svg"))
