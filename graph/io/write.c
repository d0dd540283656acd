/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes frameworks as JSON (our own frame), OBJ and CSV text. What readers would assume anyway is
 * left out: lengths that are distances, covers of 1, names that are indices. Numbers are written so
 * that they are read back as the same doubles. */
#include "graph/io/read_parts.h"

/* Writes three coordinates. */
static void write_point(const double xyz[3], const char *separator, thr_text *out)
{
  for (int i = 0; i < 3; i++) {
    thr_text_append(out, i ? separator : "");
    thr_text_double(out, xyz[i]);
  }
}

/* Writes the nodes, a row of coordinates for each. */
static void put_rows_of_nodes(const thr_frame *frame, thr_writer *writer)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, "nodes");

  /* A line for each node keeps differences of two files readable. */
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_write_line(writer, 0);
    thr_write_array(writer, NULL);
    for (int i = 0; i < 3; i++)
      thr_write_number(writer, NULL, frame->xyz[v][i]);
    thr_write_close(writer);
  }

  thr_write_line(writer, 0);
  thr_write_close(writer);
}

/* Writes the edges, a row of two nodes for each. */
static void put_rows_of_edges(const thr_frame *frame, thr_writer *writer)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, "edges");

  /* As with nodes, a line for each edge. */
  for (int e = 0; e < frame->n_edges; e++) {
    thr_write_line(writer, 0);
    thr_write_array(writer, NULL);
    thr_write_int(writer, NULL, frame->edge[e][0]);
    thr_write_int(writer, NULL, frame->edge[e][1]);
    thr_write_close(writer);
  }

  thr_write_line(writer, 0);
  thr_write_close(writer);
}

/* Writes the lengths of all edges, in units. */
static void put_lengths(const thr_frame *frame, thr_writer *writer)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, "lengths");

  /* In the order of the edges. */
  for (int e = 0; e < frame->n_edges; e++) {
    thr_write_line(writer, 0);
    thr_write_number(writer, NULL, frame->length[e]);
  }

  thr_write_line(writer, 0);
  thr_write_close(writer);
}

/* Writes covers or capacities of all n edges. */
static void put_passes(const char *key, const int *passes, int n, thr_writer *writer)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, key);
  for (int e = 0; e < n; e++)
    thr_write_int(writer, NULL, passes[e]);
  thr_write_close(writer);
}

/* Writes the numbers of the nodes that are feet. */
static void put_feet(const thr_frame *frame, thr_writer *writer)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, "feet");
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot[v]) thr_write_int(writer, NULL, v);
  thr_write_close(writer);
}

/* Writes what the nodes are called. */
static void put_names(const thr_frame *frame, thr_writer *writer)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, "names");

  /* In the order of the nodes. */
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_write_line(writer, 0);
    thr_write_string(writer, NULL, frame->name[v]);
  }

  thr_write_line(writer, 0);
  thr_write_close(writer);
}

/* Writes our own JSON, which read_json_own.c reads. */
void thr_json_frame_write(const thr_frame *frame, thr_text *out)
{
  thr_writer writer = {.out = out};

  /* The head. */
  thr_write_object(&writer, NULL);
  thr_write_line(&writer, 0);
  thr_write_string(&writer, "format", "thread-frame");
  thr_write_line(&writer, 0);
  thr_write_int(&writer, "version", 1);
  thr_write_line(&writer, 0);
  thr_write_string(&writer, "units", frame->units);

  /* Nodes and edges. */
  put_rows_of_nodes(frame, &writer);
  put_rows_of_edges(frame, &writer);

  /* What only some frameworks have. */
  if (frame->own_lengths) put_lengths(frame, &writer);
  if (frame->cover) put_passes("covers", frame->cover, frame->n_edges, &writer);
  if (frame->capacity) put_passes("capacities", frame->capacity, frame->n_edges, &writer);
  if (thr_frame_feet(frame) > 0) put_feet(frame, &writer);
  if (!thr_frame_names_are_indices(frame)) put_names(frame, &writer);

  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_text_append(out, "\n");
}

/* Writes units and feet as comments, and the nodes as v records. */
void thr_obj_write_nodes(const thr_frame *frame, bool up_y, thr_text *out)
{
  /* What OBJ has no records for is in comments, which read_obj.c reads back. */
  thr_text_append(out, "# units: ");
  thr_text_append_clean(out, frame->units);
  thr_text_append(out, "\n");

  if (thr_frame_feet(frame) > 0) {
    thr_text_append(out, "# feet:");
    for (int v = 0; v < frame->n_nodes; v++)
      if (frame->foot[v]) thr_text_printf(out, " %d", v + 1);
    thr_text_append(out, "\n");
  }

  /* A quarter turn about x makes y point up. */
  for (int v = 0; v < frame->n_nodes; v++) {
    const double *at = frame->xyz[v], turned[3] = {at[0], at[2], at[1] == 0 ? 0 : -at[1]};
    thr_text_append(out, "v ");
    write_point(up_y ? turned : at, " ", out);
    thr_text_append(out, "\n");
  }
}

void thr_obj_write(const thr_frame *frame, thr_text *out)
{
  thr_text_printf(out, "# thread framework: %d nodes, %d edges\n", frame->n_nodes, frame->n_edges);
  thr_obj_write_nodes(frame, false, out);
  for (int e = 0; e < frame->n_edges; e++) /* Blender reads a longer l as one edge */
    thr_text_printf(out, "l %d %d\n", frame->edge[e][0] + 1, frame->edge[e][1] + 1);
}

/* Writes one edge per line, as six coordinates and what only some frameworks have. */
void thr_csv_write(const thr_frame *frame, thr_text *out)
{
  thr_text_printf(out, "x1,y1,z1,x2,y2,z2%s%s%s\n", frame->own_lengths ? ",length" : "",
                  frame->cover ? ",cover" : "", frame->capacity ? ",capacity" : "");
  for (int e = 0; e < frame->n_edges; e++) {
    write_point(frame->xyz[frame->edge[e][0]], ",", out);
    thr_text_append(out, ",");
    write_point(frame->xyz[frame->edge[e][1]], ",", out);

    /* The columns that the header names. */
    if (frame->own_lengths) {
      thr_text_append(out, ",");
      thr_text_double(out, frame->length[e]);
    }
    if (frame->cover) thr_text_printf(out, ",%d", frame->cover[e]);

    /* No limit is an empty field. */
    if (frame->capacity) thr_text_append(out, ",");
    if (frame->capacity && frame->capacity[e]) thr_text_printf(out, "%d", frame->capacity[e]);
    thr_text_append(out, "\n");
  }
}
