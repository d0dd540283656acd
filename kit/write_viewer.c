/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the pieces of a kit as the viewer's page reads them: JSON with the meshes as base64.
 *
 * Points are whole numbers of two bytes, the lowest first, that count steps from the lowest corner
 * of the mesh's box; triangles are three numbers of points of four bytes each. */
#include "kit/files.h"

#include "graph/io/json.h"

#include <math.h>

enum { STEPS = 65535 };

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

void thr_kit_viewer(const thr_kit *kit, thr_text *out)
{
  thr_writer writer = {.out = out, .compact = true};
  thr_write_object(&writer, NULL);
  thr_write_printf(&writer, "mm", "%.9g", kit->mm);
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
