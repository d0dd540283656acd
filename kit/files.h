/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that a kit is written to: how its pieces stand on the bed of a printer, and what
 * slicers, spreadsheets, workshops and OpenSCAD read.
 *
 * Everything is appended to a text; the same kit gives the same bytes. The kit has its meshes. A
 * text that ran out of memory says so itself (thr_text.failed) where a function returns nothing. */
#ifndef THR_KIT_FILES_H
#define THR_KIT_FILES_H

#include "diagram/scene/movement.h"
#include "kit/kit.h"

/* ---- plates.c: pieces on the bed of a printer. */

/* How a mesh stands. Directions are those of the mesh. */
typedef struct {
  double down[3]; /* unit vector towards the bed */
  int arm;        /* whose face or cut end lies on the bed; -1 = none */
  bool base;      /* its foot's base lies there */
  double contact; /* mm2 that lie on the bed */
  double
      overhang;   /* mm2 of faces above it that are nearer to level than 45 degrees and look down */
  double turn[9]; /* rotation by rows, from the mesh to the bed */
  double low[3], size[3]; /* its box when turned: lowest corner, edges */
} thr_kit_stand;

/* All pieces of a kit on beds. {0} is valid and empty. Arrays are owned, the kit is borrowed. */
typedef struct {
  const thr_kit *kit;
  int n_plates;
  thr_kit_stand *stand; /* [n_pieces] of those that have a mesh */
  int *plate;           /* [n_pieces] from 0 */
  double (*at)[2];      /* [n_pieces] lowest corner of its box on the bed, whose corner is at 0 */
} thr_kit_plates;

/* Returns THR_EINPUT for a kit, with or without meshes, of which some piece is larger than the bed
 * however it is laid; names the largest, and a bed for all. What is a little larger is left to
 * thr_kit_plates_make. O(pieces arms^3). */
thr_status thr_kit_plates_check(const thr_kit *kit, thr_err *err) THR_MUST_CHECK;

/* Finds for each mesh how it prints best, and gives every piece a place on a bed. THR_EINPUT names
 * a piece that is larger than the bed, and the bed that would do. Release with
 * thr_kit_plates_destroy, after a failure too. O(triangles arms^2 + pieces^2). */
thr_status thr_kit_plates_make(thr_kit_plates *plates, const thr_kit *kit,
                               thr_err *err) THR_MUST_CHECK;
void thr_kit_plates_destroy(thr_kit_plates *plates);

/* ---- write_3mf.c, write_stl.c: meshes. */

/* Appends kit.3mf: an object for each mesh, and an item for each piece where it stands on its
 * plate. plate: the only one, from 0, as slicers know one bed; -1: all, beside each other. O(points
 * log points). */
thr_status thr_kit_3mf(const thr_kit_plates *plates, int plate, thr_text *out,
                       thr_err *err) THR_MUST_CHECK;

/* Fills normal with the unit normal of a triangle, outwards; returns its area in mm2. */
double thr_kit_normal(const thr_mesh *mesh, int triangle, double normal[3]);

/* Returns the cyclic redundancy check (ISO 3309) of bytes that follow those of `sum`; 0: of none.
 */
uint32_t thr_kit_checksum(uint32_t sum, const char *bytes, size_t n);

/* Appends a number of so many bytes, the lowest first. */
void thr_kit_number(thr_text *out, uint64_t value, int bytes);

/* Appends the mesh of a piece as binary STL, turned as it stands on the bed, whose corner is at 0.
 */
void thr_kit_stl(const thr_kit_plates *plates, int piece, thr_text *out);

/* Writes the name of that file, "X-7-print-4x.stl": as the kind is called, with "_" for what not
 * all systems allow in names, and how many of it there are. */
void thr_kit_stl_name(const thr_kit *kit, int piece, char name[64]);

/* ---- read_me.c */

/* What is beside the plates and kit.csv in a kit's folder. */
typedef struct {
  bool stl, scad, pictures;
} thr_kit_written;

/* Appends README.txt: what the files are for, how many to print, and how. */
void thr_kit_read_me(const thr_kit_plates *plates, const thr_kit_written *written, thr_text *out);

/* Appends how many kinds there are: "13 kinds (49 with their channels and names)" (kit_tables.c).
 */
void thr_kit_kinds(const thr_kit *kit, thr_text *out);

/* ---- write_viewer.c: what the viewer's page needs to show the pieces themselves. */

/* Appends one JSON object, for thr_viewer_html. The kit has meshes. moves: of thr_kit_moves, the
 * page plays it instead of the threading; NULL: none. */
void thr_kit_viewer(const thr_kit *kit, const thr_text *moves, thr_text *out);

/* Appends a movement of the kit's pieces and of its cords as one JSON object. Places are exact to
 * 1/65535 of the box of all of them, turns to 1/32767; the same movement gives the same bytes, some
 * 19 for each piece in a frame. title: what moves; note: how it ends. THR_EINPUT as for
 * thr_film_open, THR_ENOMEM; out may be incomplete then. O(frames (pieces + points)). */
thr_status thr_kit_moves(const thr_kit *kit, const thr_movement *movement, const char *title,
                         const char *note, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* ---- kit_tables.c: CSV, in the manner of diagram/tables/tables.h, which says what layout is. */

/* Appends kit.csv: a row per piece: what it weighs, how it is printed. */
thr_status thr_kit_table(const thr_kit_plates *plates, const thr_layout *layout, thr_text *out,
                         thr_err *err) THR_MUST_CHECK;

/* Appends tubes.csv: a row per tube with what a workshop saws. THR_EINPUT for a kit of nodes. */
thr_status thr_kit_tubes_table(const thr_kit *kit, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* ---- write_scad.c */

/* Appends kit.scad: the pieces as a programme for OpenSCAD whose sizes can be changed, without
 * letters; fillets are flat there and feet have none. Needs no meshes. */
void thr_kit_scad(const thr_kit *kit, thr_text *out);

#endif
