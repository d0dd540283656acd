/* Frameworks as JSON, OBJ and CSV text. */
#include "graph/io/formats.h"

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

/* Numbers of the feet, counted from base. */
static void write_feet(const thr_frame *f, int base, const char *separator, thr_text *out)
{
  bool first = true;
  for (int v = 0; v < f->n_nodes; v++) {
    if (!f->foot[v]) continue;
    thr_text_printf(out, "%s%d", first ? "" : separator, v + base);
    first = false;
  }
}

static void write_passes(const char *key, const int *passes, int n, thr_text *out)
{
  for (int e = 0; passes && e < n; e++) {
    if (e == 0) thr_text_printf(out, ",\n\"%s\": [", key);
    thr_text_printf(out, e ? ", %d" : "%d", passes[e]);
    if (e + 1 == n) thr_text_append(out, "]");
  }
}

void thr_json_write(const thr_frame *f, thr_text *out)
{
  thr_text_append(out, "{\n\"format\": \"thread-frame\",\n\"version\": 1,\n\"units\": ");
  thr_text_json_string(out, f->units);
  thr_text_append(out, ",\n\"nodes\": [");
  for (int v = 0; v < f->n_nodes; v++) {
    thr_text_append(out, v ? ",\n[" : "\n[");
    write_point(f->xyz[v], ", ", out);
    thr_text_append(out, "]");
  }
  thr_text_append(out, "\n],\n\"edges\": [");
  for (int e = 0; e < f->n_edges; e++)
    thr_text_printf(out, "%s[%d, %d]", e ? ",\n" : "\n", f->edge[e][0], f->edge[e][1]);
  thr_text_append(out, "\n]");
  for (int e = 0; f->own_lengths && e < f->n_edges; e++) {
    thr_text_append(out, e ? ",\n" : ",\n\"lengths\": [\n");
    thr_text_double(out, f->length[e]);
    if (e + 1 == f->n_edges) thr_text_append(out, "\n]");
  }
  write_passes("covers", f->cover, f->n_edges, out);
  write_passes("capacities", f->capacity, f->n_edges, out);
  if (has_feet(f)) {
    thr_text_append(out, ",\n\"feet\": [");
    write_feet(f, 0, ", ", out);
    thr_text_append(out, "]");
  }
  if (!thr_frame_names_are_indices(f)) {
    thr_text_append(out, ",\n\"names\": [");
    for (int v = 0; v < f->n_nodes; v++) {
      thr_text_append(out, v ? ",\n" : "\n");
      thr_text_json_string(out, f->name[v]);
    }
    thr_text_append(out, "\n]");
  }
  thr_text_append(out, "\n}\n");
}

void thr_obj_write_nodes(const thr_frame *f, thr_text *out)
{
  thr_text_append(out, "# units: ");
  thr_text_append_clean(out, f->units);
  thr_text_append(out, "\n");
  if (has_feet(f)) {
    thr_text_append(out, "# feet: ");
    write_feet(f, 1, " ", out);
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
