/* Frameworks as JSON, OBJ and CSV text. */
#include "graph/framework/frame.h"
#include "graph/io/formats.h"
#include "graph/io/read.h"
#include "graph/io/scan.h"
#include "graph/io/writer.h"
#include "graph/text.h"

static void write_point(const double xyz[3], const char *separator, thr_text *out)
{
  for (int i = 0; i < 3; i++) {
    thr_text_append(out, i ? separator : "");
    thr_text_double(out, xyz[i]);
  }
}

static bool has_feet(const thr_frame *f)
{
  for (int v = 0; v < f->n_nodes; v++)
    if (f->foot[v]) return true;
  return false;
}

static void put_rows_of_nodes(const thr_frame *f, thr_writer *w)
{
  thr_write_line(w, 0);
  thr_write_array(w, "nodes");
  for (int v = 0; v < f->n_nodes; v++) {
    thr_write_line(w, 0);
    thr_write_array(w, NULL);
    for (int i = 0; i < 3; i++)
      thr_write_number(w, NULL, f->xyz[v][i]);
    thr_write_close(w);
  }
  thr_write_line(w, 0);
  thr_write_close(w);
}

static void put_rows_of_edges(const thr_frame *f, thr_writer *w)
{
  thr_write_line(w, 0);
  thr_write_array(w, "edges");
  for (int e = 0; e < f->n_edges; e++) {
    thr_write_line(w, 0);
    thr_write_array(w, NULL);
    thr_write_int(w, NULL, f->edge[e][0]);
    thr_write_int(w, NULL, f->edge[e][1]);
    thr_write_close(w);
  }
  thr_write_line(w, 0);
  thr_write_close(w);
}

static void put_lengths(const thr_frame *f, thr_writer *w)
{
  thr_write_line(w, 0);
  thr_write_array(w, "lengths");
  for (int e = 0; e < f->n_edges; e++) {
    thr_write_line(w, 0);
    thr_write_number(w, NULL, f->length[e]);
  }
  thr_write_line(w, 0);
  thr_write_close(w);
}

static void put_passes(const char *key, const int *passes, int n, thr_writer *w)
{
  thr_write_line(w, 0);
  thr_write_array(w, key);
  for (int e = 0; e < n; e++)
    thr_write_int(w, NULL, passes[e]);
  thr_write_close(w);
}

static void put_feet(const thr_frame *f, thr_writer *w)
{
  thr_write_line(w, 0);
  thr_write_array(w, "feet");
  for (int v = 0; v < f->n_nodes; v++)
    if (f->foot[v]) thr_write_int(w, NULL, v);
  thr_write_close(w);
}

static void put_names(const thr_frame *f, thr_writer *w)
{
  thr_write_line(w, 0);
  thr_write_array(w, "names");
  for (int v = 0; v < f->n_nodes; v++) {
    thr_write_line(w, 0);
    thr_write_string(w, NULL, f->name[v]);
  }
  thr_write_line(w, 0);
  thr_write_close(w);
}

void thr_json_frame_write(const thr_frame *f, thr_text *out)
{
  thr_writer w = {.out = out};
  thr_write_object(&w, NULL);
  thr_write_line(&w, 0);
  thr_write_string(&w, "format", "thread-frame");
  thr_write_line(&w, 0);
  thr_write_int(&w, "version", 1);
  thr_write_line(&w, 0);
  thr_write_string(&w, "units", f->units);
  put_rows_of_nodes(f, &w);
  put_rows_of_edges(f, &w);
  if (f->own_lengths) put_lengths(f, &w);
  if (f->cover) put_passes("covers", f->cover, f->n_edges, &w);
  if (f->capacity) put_passes("capacities", f->capacity, f->n_edges, &w);
  if (has_feet(f)) put_feet(f, &w);
  if (!thr_frame_names_are_indices(f)) put_names(f, &w);
  thr_write_line(&w, 0);
  thr_write_close(&w);
  thr_text_append(out, "\n");
}

void thr_obj_write_nodes(const thr_frame *f, thr_text *out)
{
  thr_text_append(out, "# units: ");
  thr_text_append_clean(out, f->units);
  thr_text_append(out, "\n");
  if (has_feet(f)) {
    thr_text_append(out, "# feet:");
    for (int v = 0; v < f->n_nodes; v++)
      if (f->foot[v]) thr_text_printf(out, " %d", v + 1);
    thr_text_append(out, "\n");
  }
  for (int v = 0; v < f->n_nodes; v++) {
    thr_text_append(out, "v ");
    write_point(f->xyz[v], " ", out);
    thr_text_append(out, "\n");
  }
}

void thr_obj_write(const thr_frame *f, thr_text *out)
{
  thr_text_printf(out, "# thread framework: %d nodes, %d edges\n", f->n_nodes, f->n_edges);
  thr_obj_write_nodes(f, out);
  for (int e = 0; e < f->n_edges; e++) /* Blender reads a longer l as one edge */
    thr_text_printf(out, "l %d %d\n", f->edge[e][0] + 1, f->edge[e][1] + 1);
}

void thr_csv_write(const thr_frame *f, thr_text *out)
{
  thr_text_printf(out, "x1,y1,z1,x2,y2,z2%s%s%s\n", f->own_lengths ? ",length" : "", f->cover ? ",cover" : "",
                  f->capacity ? ",capacity" : "");
  for (int e = 0; e < f->n_edges; e++) {
    write_point(f->xyz[f->edge[e][0]], ",", out);
    thr_text_append(out, ",");
    write_point(f->xyz[f->edge[e][1]], ",", out);
    if (f->own_lengths) {
      thr_text_append(out, ",");
      thr_text_double(out, f->length[e]);
    }
    if (f->cover) thr_text_printf(out, ",%d", f->cover[e]);
    if (f->capacity) thr_text_append(out, ",");
    if (f->capacity && f->capacity[e]) thr_text_printf(out, "%d", f->capacity[e]);
    thr_text_append(out, "\n");
  }
}
