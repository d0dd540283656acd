/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the pieces of a kit as the viewer's page reads them: JSON with the meshes as base64.
 *
 * Points are whole numbers of two bytes, the lowest first, that count steps from the lowest corner
 * of the mesh's box; triangles are three numbers of points of four bytes each.
 *
 * A movement is seven such numbers for each piece in each frame: x, y and z as steps from the
 * lowest corner of the box of all places, and the quaternion x, y, z, w as 32767 (1 + q). A tension
 * is one byte, the number of its colour. */
#include "kit/files.h"

#include "diagram/overview/overview.h"
#include "graph/io/json.h"
#include "kit/film.h"

#include <math.h>
#include <stdlib.h>

enum { STEPS = 65535, HALF = 32767 };

/* Appends bytes as base64: a multiple of three, which needs no padding. */
static void put_base64(const thr_text *bytes, thr_text *out)
{
  for (size_t i = 0; i + 2 < bytes->length; i += 3)
    thr_text_base64(out, (const unsigned char *)bytes->data + i);
}

/* Writes a mesh: its box's corner, the step, points and triangles. */
static void put_mesh(const thr_mesh *mesh, const thr_mesh_report *report, thr_writer *writer)
{
  thr_text bytes = {0}, words = {0};
  double step = 0;
  for (int k = 0; k < 3; k++)
    step = fmax(step, (report->high[k] - report->low[k]) / STEPS);

  thr_write_object(writer, NULL);
  thr_write_array(writer, "low");
  for (int k = 0; k < 3; k++)
    thr_write_printf(writer, NULL, "%.7g", report->low[k]);
  thr_write_close(writer);
  thr_write_printf(writer, "step", "%.9g", step);

  for (int v = 0; v < mesh->n_points; v++)
    for (int k = 0; k < 3; k++)
      thr_kit_number(&bytes, (uint64_t)lround((mesh->point[v][k] - report->low[k]) / step), 2);
  put_base64(&bytes, &words);
  thr_write_words(writer, "points", &words);

  thr_text_destroy(&bytes);
  words = (thr_text){0};
  for (int t = 0; t < mesh->n_triangles; t++)
    for (int k = 0; k < 3; k++)
      thr_kit_number(&bytes, (uint64_t)mesh->triangle[t][k], 4);
  put_base64(&bytes, &words);
  thr_write_words(writer, "triangles", &words);
  thr_text_destroy(&bytes);
  thr_write_close(writer);
}

/* Writes where the passes of each cord lie beside the axes of their edges, mm. */
static void put_lanes(const thr_kit *kit, thr_writer *writer)
{
  const thr_kit_edges *edges = &kit->edges;
  const thr_plan *plan = kit->plan;
  thr_err err = {0};
  double(*off)[3] = thr_calloc((size_t)edges->first_pass[plan->n_cords] + 1, sizeof *off);
  bool known = off && !thr_kit_edges_share(edges, plan, kit->cord, off, &err);
  writer->out->failed |= !known;

  thr_write_array(writer, "lanes");
  for (int c = 0; c < plan->n_cords && known; c++) {
    thr_write_array(writer, NULL);
    for (int k = 0; k < plan->cord[c].n_passes; k++) {
      int pass = edges->first_pass[c] + k;
      const thr_kit_edge *edge = &edges->edge[plan->cord[c].half[k] >> 1];
      const double *lane = edge->lane[edge->n_lanes > 1 ? edges->lane[pass] : 0];
      thr_write_array(writer, NULL);
      for (int i = 0; i < 3; i++)
        thr_write_printf(writer, NULL, "%.4g",
                         off[pass][i] + lane[0] * edge->up[i] + lane[1] * edge->side[i]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);
  free(off);
}

/* Writes bytes as a string of base64, filled up with zeros, and releases them. */
static void put_bytes(const char *key, thr_text *bytes, thr_writer *writer)
{
  thr_text words = {0};
  while (bytes->length % 3)
    thr_kit_number(bytes, 0, 1);
  put_base64(bytes, &words);
  writer->out->failed |= bytes->failed;
  thr_text_destroy(bytes);
  thr_write_words(writer, key, &words);
}

/* Writes the poses of all pieces, frame by frame, with the corner and the step of the places. */
static void put_poses(const thr_movement *movement, thr_writer *writer)
{
  const size_t n = (size_t)movement->n_frames * (size_t)movement->n_pieces;
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, step = 1e-6;
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++)
      low[k] = fmin(low[k], movement->pose[i][k]);
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++)
      step = fmax(step, (movement->pose[i][k] - low[k]) / STEPS);

  thr_write_numbers(writer, "low", low, 3);
  thr_write_printf(writer, "step", "%.9g", step);

  thr_text bytes = {0};
  for (size_t i = 0; i < n; i++) {
    const double *pose = movement->pose[i];
    double square = 0;
    for (int k = 3; k < 7; k++)
      square += pose[k] * pose[k];
    for (int k = 0; k < 3; k++)
      thr_kit_number(&bytes, (uint64_t)lround((pose[k] - low[k]) / step), 2);
    for (int k = 3; k < 7; k++)
      thr_kit_number(&bytes, (uint64_t)lround(HALF * (1 + pose[k] / sqrt(square))), 2);
  }
  put_bytes("poses", &bytes, writer);
}

/* Writes the points of each cord, [piece, x, y, z], and the colours of the tensions between them.
 */
static void put_cords(const thr_movement *movement, double most, thr_writer *writer)
{
  const int n_points = movement->first[movement->n_cords];
  thr_write_array(writer, "cords");
  for (int c = 0; c < movement->n_cords; c++) {
    thr_write_array(writer, NULL);
    for (int i = movement->first[c]; i < movement->first[c + 1]; i++) {
      thr_write_array(writer, NULL);
      thr_write_int(writer, NULL, movement->point[i].piece);
      for (int k = 0; k < 3; k++)
        thr_write_printf(writer, NULL, "%.5g", movement->point[i].at[k]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);

  thr_text bytes = {0};
  for (int f = 0; f < movement->n_frames; f++)
    for (int i = 0; i < n_points; i++) {
      const double tension = movement->tension[(size_t)f * (size_t)n_points + (size_t)i];
      thr_kit_number(&bytes, (uint64_t)thr_film_tension(tension, most), 1);
    }
  put_bytes("tensions", &bytes, writer);
}

/* Writes the colours of tensions, the last one for what is not known, and their scale, as a plan
 * with an evaluation has one. */
static void put_colours(double most, thr_writer *writer)
{
  double colour[THR_FILM_TENSIONS][3];
  thr_film_tensions(colour);
  thr_write_array(writer, "colours");
  for (int i = 0; i < THR_FILM_TENSIONS; i++) {
    long byte[3];
    for (int k = 0; k < 3; k++)
      byte[k] = lround(255 * colour[i][k]);
    thr_write_printf(writer, NULL, "\"#%02lx%02lx%02lx\"", byte[0], byte[1], byte[2]);
  }
  thr_write_close(writer);
  if (most <= 0) return;

  thr_write_object(writer, "scale");
  thr_write_number(writer, "low", 0);
  thr_write_number(writer, "high", most);
  thr_write_array(writer, "ticks");
  for (int i = 0; i < 2; i++) { /* both ends */
    char words[32] = "0 N";
    if (i) thr_svg_force(most, words);
    thr_write_array(writer, NULL);
    thr_write_printf(writer, NULL, "%.7g", i ? most : 0);
    thr_write_string(writer, NULL, words);
    thr_write_close(writer);
  }
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes what each frame says in words. */
static void put_states(const thr_movement *movement, thr_writer *writer)
{
  thr_write_array(writer, "words");
  for (int f = 0; f < movement->n_frames; f++) {
    const thr_movement_state *state = &movement->state[f];
    thr_text words = {0};
    thr_text_printf(&words, "%.2f s", state->time);
    if (isfinite(state->pull)) thr_text_printf(&words, ", pull %.2f N", state->pull);
    if (movement->n_faces)
      thr_text_printf(&words, ", %d of %d faces closed", state->closed, movement->n_faces);
    if (isfinite(state->drawn))
      thr_text_printf(&words, ", %.0f mm %s", fabs(state->drawn),
                      state->drawn < 0 ? "given out" : "drawn in");
    thr_write_words(writer, NULL, &words);
  }
  thr_write_close(writer);
}

thr_status thr_kit_moves(const thr_kit *kit, const thr_movement *movement, const char *title,
                         const char *note, thr_text *out, thr_err *err)
{
  thr_writer writer = {.out = out, .compact = true};
  thr_status st = thr_film_check(kit, movement, err);
  if (st) return st;
  const double most = thr_film_most(movement);
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "title", title);
  thr_write_string(&writer, "note", note);
  thr_write_printf(&writer, "seconds", "%.6g", movement->seconds);
  thr_write_printf(&writer, "floor", "%.6g", movement->floor);
  put_states(movement, &writer);
  put_colours(most, &writer);
  put_cords(movement, most, &writer);
  put_poses(movement, &writer);
  thr_write_close(&writer);
  return out->failed ? thr_nomem(err) : THR_OK;
}

void thr_kit_viewer(const thr_kit *kit, const thr_text *moves, thr_text *out)
{
  thr_writer writer = {.out = out, .compact = true};
  thr_write_object(&writer, NULL);
  thr_write_printf(&writer, "mm", "%.9g", kit->mm);
  thr_write_printf(&writer, "cord", "%.5g", kit->cord);
  put_lanes(kit, &writer);
  if (moves) thr_write_json(&writer, "moves", moves);
  thr_write_array(&writer, "meshes");
  for (int p = 0; p < kit->n_pieces; p++)
    if (kit->piece[p].like == p) put_mesh(&kit->mesh[p], &kit->report[p], &writer);
  thr_write_close(&writer);

  /* Of every piece: its mesh, how that is turned, and where its middle is. Kinds are numbered as
   * the meshes are. */
  thr_write_array(&writer, "pieces");
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_kit_piece *piece = &kit->piece[p];
    thr_write_array(&writer, NULL);
    thr_write_int(&writer, NULL, piece->kind - 1);
    for (int k = 0; k < 9; k++)
      thr_write_printf(&writer, NULL, "%.7g", piece->place[k]);
    for (int k = 0; k < 3; k++)
      thr_write_printf(&writer, NULL, "%.7g", piece->centre[k]);
    thr_write_close(&writer);
  }
  thr_write_close(&writer);
  thr_write_close(&writer);
}
