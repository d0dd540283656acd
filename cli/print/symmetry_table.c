/* Groups and copies in words and in JSON. */
#include "cli/print/symmetry_table.h"
#include "cli/print/turning_summary.h"
#include "graph/angle.h"
#include "symmetry/group/automorphisms.h"
#include "symmetry/group/isometry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- words ---- */

/* "8", "1.2e+40". */
static void put_order(thr_text *t, double mantissa, int exponent)
{
  double digits = floor(log10(mantissa));
  if (exponent == 0 && mantissa < 1e15)
    thr_text_printf(t, "%.0f", mantissa);
  else
    thr_text_printf(t, "%.3ge+%d", mantissa / pow(10, digits), exponent + (int)digits);
}

/* "identity, 3 rotations, 4 mirrors". */
static void put_kinds(thr_text *t, const thr_symmetry_row *row)
{
  static const char *const word[][2] = {[THR_ISO_ROTATION] = {"rotation", "rotations"},
                                        [THR_ISO_MIRROR] = {"mirror", "mirrors"},
                                        [THR_ISO_INVERSION] = {"inversion", "inversions"},
                                        [THR_ISO_ROTOREFLECTION] = {"rotoreflection", "rotoreflections"},
                                        [THR_ISO_NONE] = {"of the graph only", "of the graph only"}};
  const char *comma = "";
  if (row->order == 1) thr_text_append(t, "identity");
  for (int k = THR_ISO_IDENTITY + 1; k <= THR_ISO_NONE; k++) {
    if (row->kinds[k] == 0) continue;
    thr_text_printf(t, "%s%d %s", comma, row->kinds[k], cli_plural(row->kinds[k], word[k][0], word[k][1]));
    comma = ", ";
  }
}

/* "C4v", or what else to call it. */
static void put_name(thr_text *t, const thr_symmetry_row *row)
{
  if (*row->name)
    thr_text_append(t, row->name);
  else
    thr_text_printf(t, "order %d of the graph", row->order);
}

/* Paths and the copies of each, itself among them: "2 x 4", or "3 x 4-8" if some have more than others. */
static void copies_of(const thr_symmetry_row *row, char out[40])
{
  int paths = row->record.unique_paths;
  if (row->least_copies == row->most_copies)
    snprintf(out, 40, "%d x %d", paths, row->most_copies);
  else
    snprintf(out, 40, "%d x %d-%d", paths, row->least_copies, row->most_copies);
}

/* The solver's word, which no checker verifies: "optimal", or the first aim that may not be as low as can be. */
static const char *solvers_word(const thr_plan_options *o, const thr_symmetry_row *row)
{
  static const char *const no[] = {[THR_AIM_OVERLAP] = "not overlap",
                                   [THR_AIM_STEPS] = "not steps",
                                   [THR_AIM_PATHS] = "not paths",
                                   [THR_AIM_TURNING] = "not turning"};
  thr_aim order[THR_N_AIMS];
  if (row->why.code == THR_OK) return "optimal";
  thr_aims_order(o, order);
  for (int k = 0; k < THR_N_AIMS - 1; k++) {
    thr_aim aim = order[k];
    if (row->value[aim] > row->bound[aim] + 1e-6 * fmax(1, fabs(row->value[aim]))) return no[aim];
  }
  return no[order[THR_N_AIMS - 1]];
}

/* ---- text ---- */

void symmetry_put_head(thr_text *t, const thr_frame *f, const thr_plan_options *o, const thr_symmetries *s)
{
  bool shape = o->symmetry.geometric >= 0;
  double kept = shape ? s->keep_lengths[0] : s->mantissa;
  int exponent = shape ? (int)s->keep_lengths[1] : s->exponent;
  const char *automorphisms = exponent == 0 && kept == 1 ? "automorphism" : "automorphisms";
  if (shape)
    thr_text_printf(t, "%.0f %s within %g, of ", s->mantissa, s->mantissa == 1 ? "isometry" : "isometries",
                    o->symmetry.geometric);
  put_order(t, kept, exponent);
  thr_text_printf(t, " %s by nauty %s%s", automorphisms, thr_nauty_version(), shape ? " that keep edge lengths" : "");
  thr_text_printf(t, "; %d %s of %d nodes, %d of %d edges; %d %s of groups%s\n", s->node_orbits,
                  cli_plural(s->node_orbits, "orbit", "orbits"), f->n_nodes, s->edge_orbits, f->n_edges, s->n,
                  cli_plural(s->n, "class", "classes"), s->listed ? "" : ", not all:");
  if (!s->listed) thr_text_printf(t, "%s\n", s->note);
  double base = 0;
  for (int e = 0; e < f->n_edges; e++)
    base += thr_plan_cover(f, o, e) * f->length[e];
  thr_text_printf(t, "ends: %s; %d %s per edge%s; the shortest plan with one cord in each component has %.1f %% overlap%s\n\n",
                  thr_ends_name(o->ends), o->cover, cli_plural(o->cover, "pass", "passes"),
                  o->joint == THR_JOINT_TUBE ? "; joints: tube" : "", 100 * (s->shortest - base) / base,
                  s->shortest_optimal ? "" : " (not proved)");
}

static void put_row(thr_text *t, const thr_plan_options *o, const thr_symmetries *s, int i)
{
  const thr_symmetry_row *row = &s->row[i];
  const thr_metrics *m = &row->metrics;
  char copies[40], factor[24];
  thr_text_printf(t, "%c %4d %6d  %-6s ", i == s->chosen ? '*' : ' ', i + 1, row->order, *row->name ? row->name : "graph");
  if (row->n_cords > 0) {
    copies_of(row, copies);
    thr_text_printf(t, "%7.1f %% %11s %8.6g %6d %8.0f deg %8.0f deg %12s %11s", 100 * m->overlap / m->base_length, copies,
                    row->record.steps, row->n_cords, thr_degrees(m->turning), thr_degrees(m->max_turning),
                    turning_factor(turning_capstan(o->physics.mu, m->max_turning), factor), solvers_word(o, row));
  } else {
    bool open = row->why.code == THR_ELIMIT || row->why.code == THR_ESOLVER;
    thr_text_printf(t, "  %-79.79s", open ? row->why.text : row->why.code ? "no threading" : "not asked for");
  }
  thr_text_printf(t, " %8.3f  ", row->residual);
  put_kinds(t, row);
  thr_text_append(t, "\n");
}

static void put_reason(thr_text *t, const thr_plan_options *o, const thr_symmetries *s)
{
  double percent = 100 * thr_symmetry_slack;
  const thr_symmetry_row *row = &s->row[s->chosen];
  thr_text_printf(t, "* group %d, ", s->chosen + 1);
  put_name(t, row);
  if (*o->symmetry.group)
    thr_text_printf(t, ": asked for as --group %s", o->symmetry.group);
  else if (s->within)
    thr_text_printf(t, ": the fewest learned steps (%g) with at most %g %% more cord than the shortest plan", row->record.steps,
                    percent);
  else
    thr_text_printf(t, ": the least cord; none has at most %g %% more than the shortest plan", percent);
  thr_text_append(t, "\n");
}

void symmetry_put_table(thr_text *t, const thr_plan_options *o, const thr_symmetries *s, int most)
{
  int first = 0, last = s->n;
  bool only = *o->symmetry.group != '\0';
  if (s->n > most && !only) {
    first = s->chosen - most / 2 < 0 ? 0 : s->chosen - most / 2;
    if (first > s->n - most) first = s->n - most;
    last = first + most;
  }
  thr_text_printf(t, "%6s %6s  %-6s %9s %11s %8s %6s %12s %12s %12s %11s %8s  %s\n", "number", "order", "group", "overlap",
                  "unique x", "steps", "cords", "turning", "largest", "capstan", "solver says", "residual", "elements");
  if (first > 0) thr_text_printf(t, "    ..  %d larger\n", first);
  for (int i = first; i < last; i++)
    if (!only || s->row[i].n_cords > 0 || s->row[i].why.code) put_row(t, o, s, i);
  if (last < s->n) thr_text_printf(t, "    ..  %d smaller\n", s->n - last);
  if (s->chosen >= 0) put_reason(t, o, s);
}

/* ---- copies ---- */

static void put_isometry(thr_text *t, const thr_plan *p, int image)
{
  thr_isometry iso;
  thr_isometry_of(&p->frame, &p->symmetry.image[(size_t)image * (size_t)p->frame.n_nodes], thr_symmetry_near, &iso);
  thr_text_append(t, iso.name);
}

static void put_copies_of(thr_text *t, const thr_plan *p, int path)
{
  enum { MOST = 24 };
  const thr_symmetry_record *r = &p->symmetry;
  int n = 0;
  thr_text_printf(t, "         %s: unique", p->cord[path].id);
  for (int i = 0; i < p->n_cords; i++)
    if (i != path && r->unique[i] == path && n++ < MOST) thr_text_printf(t, n == 1 ? "; %s" : ", %s", p->cord[i].id);
  if (n > MOST) thr_text_printf(t, " and %d more", n - MOST);
  if (n > 0) thr_text_printf(t, ": %s of %s by ", cli_plural(n, "copy", "copies"), p->cord[path].id);
  n = 0;
  for (int i = 0; i < p->n_cords; i++)
    if (i != path && r->unique[i] == path && n++ < MOST) {
      if (n > 1) thr_text_append(t, ", ");
      put_isometry(t, p, r->element[i]);
    }
  thr_text_append(t, n > MOST ? ", ..\n" : "\n");
}

void symmetry_put_paths(thr_text *t, const thr_plan *p)
{
  enum { MOST = 12 };
  const thr_symmetry_record *r = &p->symmetry;
  int n = 0;
  thr_text_printf(t, "\npaths    %d unique, %g learned %s of %d passes", r->unique_paths, r->steps,
                  r->steps == 1 ? "step" : "steps", p->metrics.passes);
  thr_text_printf(t, "; group %s%s of order %d\n", *r->name ? r->name : "of the graph", *r->name ? "" : ",", r->order);
  for (int i = 0; i < p->n_cords; i++)
    if (r->unique[i] == i && n++ < MOST) put_copies_of(t, p, i);
  if (n > MOST) thr_text_printf(t, "         .. and %d more unique paths\n", n - MOST);
}

/* ---- JSON ---- */

static void put_order_json(thr_writer *w, const char *key, double mantissa, int exponent)
{
  thr_text digits = {0};
  put_order(&digits, mantissa, exponent);
  thr_write_printf(w, key, "%s", digits.data ? digits.data : "0");
  w->out->failed |= digits.failed;
  thr_text_destroy(&digits);
}

/* Text, or null if there is none. */
static void put_name_json(thr_writer *w, const char *name)
{
  if (*name)
    thr_write_string(w, "name", name);
  else
    thr_write_null(w, "name");
}

static const char *row_status(const thr_symmetry_row *row)
{
  switch (row->why.code) {
  case THR_OK: return row->n_cords > 0 ? "optimal by the solver's word" : "not asked for";
  case THR_ELIMIT: return row->n_cords > 0 ? "bound" : "stopped";
  case THR_EINFEASIBLE: return "infeasible";
  default: return "failed";
  }
}

static void put_threading_json(thr_writer *w, const thr_plan_options *o, const thr_symmetry_row *row)
{
  const thr_metrics *m = &row->metrics;
  thr_write_number(w, "overlap", m->overlap);
  thr_write_number(w, "overlap_percent", 100 * m->overlap / m->base_length);
  thr_write_number(w, "length", m->length);
  thr_write_int(w, "unique_paths", row->record.unique_paths);
  thr_write_int(w, "least_copies", row->least_copies);
  thr_write_int(w, "most_copies", row->most_copies);
  thr_write_int(w, "cords", row->n_cords);
  thr_write_number(w, "steps", row->record.steps);
  thr_write_number(w, "turning", m->turning);
  thr_write_number(w, "max_turning", m->max_turning);
  thr_write_number(w, "max_capstan", turning_capstan(o->physics.mu, m->max_turning));
  thr_write_object(w, "bound");
  for (int a = 0; a < THR_N_AIMS; a++)
    thr_write_number(w, thr_aim_name(a), row->bound[a]);
  thr_write_close(w);
}

static void put_row_json(thr_writer *w, const thr_plan_options *o, const thr_symmetries *s, int i)
{
  static const char *const kind[] = {[THR_ISO_IDENTITY] = "identity",
                                     [THR_ISO_ROTATION] = "rotation",
                                     [THR_ISO_MIRROR] = "mirror",
                                     [THR_ISO_INVERSION] = "inversion",
                                     [THR_ISO_ROTOREFLECTION] = "rotoreflection",
                                     [THR_ISO_NONE] = "none"};
  const thr_symmetry_row *row = &s->row[i];
  thr_write_line(w, 1);
  thr_write_object(w, NULL);
  thr_write_int(w, "number", i + 1);
  thr_write_int(w, "order", row->order);
  put_name_json(w, row->name);
  thr_write_number(w, "conjugates", row->conjugates > 0 ? (double)row->conjugates : NAN);
  thr_write_number(w, "residual", row->residual);
  thr_write_object(w, "elements");
  for (int k = 0; k <= THR_ISO_NONE; k++)
    thr_write_int(w, kind[k], row->kinds[k]);
  thr_write_close(w);
  thr_write_string(w, "status", row_status(row));
  if (row->why.code) thr_write_string(w, "why", row->why.text);
  if (row->n_cords > 0) put_threading_json(w, o, row);
  thr_write_close(w);
}

void symmetry_put_table_json(thr_writer *w, const thr_plan_options *o, const thr_symmetries *s)
{
  const bool geometric = o->symmetry.geometric >= 0;
  put_order_json(w, "order", s->mantissa, s->exponent);
  thr_write_int(w, "node_orbits", s->node_orbits);
  thr_write_int(w, "edge_orbits", s->edge_orbits);
  thr_write_bool(w, "listed", s->listed);
  thr_write_string(w, "note", s->note);
  thr_write_number(w, "geometric", geometric ? o->symmetry.geometric : NAN);
  if (geometric) put_order_json(w, "length_keeping", s->keep_lengths[0], (int)s->keep_lengths[1]);
  thr_write_number(w, "mu", o->physics.mu);
  thr_write_number(w, "shortest", s->shortest);
  thr_write_string(w, "shortest_status", s->shortest_optimal ? "optimal" : "bound");
  thr_write_number(w, "chosen", s->chosen >= 0 ? (double)s->chosen + 1 : NAN);
  thr_write_bool(w, "within_slack", s->within);
  thr_write_array(w, "groups");
  for (int i = 0; i < s->n; i++)
    put_row_json(w, o, s, i);
  thr_write_close(w);
}

void symmetry_put_json(thr_writer *w, const thr_plan *p)
{
  const thr_symmetry_record *r = &p->symmetry;
  thr_write_object(w, "group");
  thr_write_int(w, "order", r->order);
  put_name_json(w, r->name);
  thr_write_close(w);
  thr_write_int(w, "unique_paths", r->unique_paths);
  thr_write_number(w, "steps", r->steps);
  thr_write_array(w, "copies");
  for (int i = 0; i < p->n_cords; i++) {
    thr_text by = {0};
    put_isometry(&by, p, r->element[i]);
    thr_write_object(w, NULL);
    thr_write_string(w, "cord", p->cord[i].id);
    thr_write_string(w, "of", p->cord[r->unique[i]].id);
    thr_write_words(w, "by", &by);
    thr_write_close(w);
  }
  thr_write_close(w);
}
