/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the pieces of a kit as the viewer's page reads them: JSON with the meshes as base64.
 *
 * Points are whole numbers of two bytes, the lowest first, that count steps from the lowest corner
 * of the mesh's box; triangles are three numbers of points of four bytes each. */
#include "kit/files.h"

#include "graph/io/json.h"

#include <math.h>
#include <stdlib.h>

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

void thr_kit_viewer(const thr_kit *kit, thr_text *out)
{
  thr_writer writer = {.out = out, .compact = true};
  thr_write_object(&writer, NULL);
  thr_write_printf(&writer, "mm", "%.9g", kit->mm);
  thr_write_printf(&writer, "cord", "%.5g", kit->cord);
  put_lanes(kit, &writer);
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
