#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Plans a dome with thread_plan, checks the plan and draws it: dome.py [PICTURE.svg] prints the length of cord in mm."""
import sys

import thread_plan

plan = thread_plan.Frame.shape("dome", 7).plan(cords=1)
plan.check()
print("%.6f" % plan.summary.length)
if len(sys.argv) > 1:
    plan.draw("svg", sys.argv[1])
