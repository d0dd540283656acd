/* The cords as lines through the nodes, for CAD and for pictures made elsewhere. Objects are called "cord-A" by the cord's id as
 * elements of the overview are; docs/outputs.md says more. The same plan gives the same bytes. THR_EINPUT for a plan without
 * cords and for cords that do not fit the framework; out is then unchanged. O(nodes + passes). */
#ifndef THR_POLYLINES_H
#define THR_POLYLINES_H

#include "diagram/scene/cord_lines.h"
#include "graph/text.h"

/* Wavefront OBJ in the framework's units: all nodes, then per cord an object with a two-vertex l record per pass, in order
 * (Blender takes no more than the first two vertices of an l for an edge); with lanes the points of the cords instead of the
 * nodes. The reader of frameworks reads it back, turned if y is up, which a comment says. */
thr_status thr_polylines_obj(const thr_plan *plan, const thr_line_options *options, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* glTF 2.0 (Khronos 2021) in one JSON file with its buffer inside: a node, a mesh of one LINE_STRIP and a material per cord, in
 * metres, y upwards whatever the options say: (x, y, z) of the framework becomes (x, z, -y), a quarter turn about x. Units that
 * thr_units_in_mm does not know count as mm; asset.extras says how many metres a unit was. Colours as in the overview. THR_EINPUT
 * also for coordinates that are too large for its 32-bit numbers. */
thr_status thr_polylines_gltf(const thr_plan *plan, const thr_line_options *options, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* DXF of release 12 with $INSUNITS: per cord a layer in the colour nearest to the overview's and a polyline in space, its
 * vertices in the order of the passes. */
thr_status thr_polylines_dxf(const thr_plan *plan, const thr_line_options *options, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* JSON as COMPAS loads it: {"units": .., "up": .., "cords": [ .. ]}, each cord a compas.geometry/Polyline with its name. */
thr_status thr_polylines_compas(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                                thr_err *err) THR_MUST_CHECK;

#endif
