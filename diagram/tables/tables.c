#include "diagram/tables/tables.h"

#include "diagram/scene/copies.h"
#include "diagram/overview/guide.h"
#include "diagram/tables/kinds.h"
#include "diagram/tables/supplies.h"
#include "graph/angle.h"
#include "graph/framework/frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What all tables are made from. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  thr_guide guide;
  thr_supplies supplies;
  thr_copy *copy; /* [n_cords] */
  thr_text *out;
} table;

/* ---- fields ---- */

/* Would a spreadsheet take this text for a formula? Numbers with a sign are numbers. */
static bool is_formula(const char *s)
{
  char *end;
  s += strspn(s, " ");
  if (!*s || !strchr("=+-@", *s)) return false;
  double value = strtod(s, &end);
  return s[strspn(s, "+-.0123456789eE")] || !isfinite(value) || *end;
}

/* A name of the framework's file, or a word: cleaned, with an apostrophe before what would be a formula, in quotes if needed. */
static void put_text(table *t, const char *s)
{
  thr_text word = {0};
  thr_text_append_clean(&word, s);
  const char *c = word.data && !word.failed ? word.data : "";
  bool quoted = c[strcspn(c, ",\"")] != '\0';
  thr_text_append(t->out, quoted ? "\"" : "");
  if (is_formula(c)) thr_text_append(t->out, "'");
  for (; *c; c++) {
    if (*c == '"') thr_text_append(t->out, "\"");
    thr_text_append_bytes(t->out, c, 1);
  }
  thr_text_append(t->out, quoted ? "\"," : ",");
  if (word.failed) t->out->failed = true;
  thr_text_destroy(&word);
}

static void put_int(table *t, int i)
{
  thr_text_printf(t->out, "%d,", i);
}

/* Nine digits: exact enough to add up, without what rounding leaves behind. */
static void put_number(table *t, double value)
{
  thr_text_printf(t->out, "%.9g,", value);
}

static void put_angle(table *t, double angle)
{
  put_number(t, nearbyint(angle * (180 / THR_PI) * 100) / 100);
}

static void put_yes(table *t, bool yes)
{
  put_text(t, yes ? "yes" : "no");
}

/* The last field of every row. */
static void put_unit(table *t)
{
  put_text(t, t->f->units);
  if (!t->out->failed) t->out->data[t->out->length - 1] = '\n';
}

/* ---- what they share ---- */

static thr_status table_make(table *t, const thr_plan *p, thr_text *out, thr_err *err)
{
  *t = (table){.plan = p, .f = &p->frame, .out = out};
  thr_status st = thr_supplies_make(&t->supplies, p, err);
  if (st) return st;
  t->copy = thr_calloc((size_t)p->n_cords, sizeof *t->copy);
  if (!t->copy) return thr_nomem(err);
  st = thr_copies_find(p, t->copy, err);
  return st ? st : thr_guide_make(&t->guide, t->f, err);
}

/* Takes the text over into out, if all went well. */
static thr_status table_close(table *t, thr_status st, thr_text *out, thr_err *err)
{
  if (!st && !t->out->failed) thr_text_append_bytes(out, t->out->data, t->out->length);
  if (!st && (t->out->failed || out->failed)) st = thr_nomem(err);
  thr_text_destroy(t->out);
  thr_guide_destroy(&t->guide);
  thr_supplies_destroy(&t->supplies);
  free(t->copy);
  return st;
}

static const char *place(const table *t, int v)
{
  return t->guide.label[v];
}

/* ---- steps.csv ---- */

static const char *way_name(thr_way way)
{
  static const char *const name[] = {"straight on", "left", "right", "over the curve", "turn", "back"};
  return name[way];
}

/* Step of the unique path that pass k of cord c repeats, counted from 1. */
static int path_step(const table *t, int c, int k)
{
  const thr_copy *how = &t->copy[c];
  int n = t->plan->cord[c].n_passes;
  if (how->of == c) return k + 1;
  return (how->backward ? how->start - k + n : how->start + k) % n + 1;
}

static void put_step(table *t, int c, int k, double *used, double length, thr_held *held)
{
  const thr_cord *cord = &t->plan->cord[c];
  int h = cord->half[k], e = h >> 1, from = thr_tail(t->f, h), to = thr_head(t->f, h);
  put_text(t, cord->id);
  put_int(t, k + 1);
  put_text(t, place(t, from));
  put_text(t, place(t, to));
  put_text(t, thr_deed_words(thr_held_pass(held, h)));
  put_int(t, held->cords[e]);
  if (k) {
    put_text(t, way_name(thr_guide_way(&t->guide, cord->half[k - 1], h)));
    put_angle(t, thr_turn_angle(t->f, cord->half[k - 1], h));
  } else
    thr_text_append(t->out, "start,,");
  *used += t->f->length[e];
  put_number(t, t->f->length[e]);
  put_number(t, *used);
  put_number(t, k + 1 < cord->n_passes ? length - *used : 0);
  put_text(t, t->plan->cord[t->copy[c].of].id);
  put_int(t, path_step(t, c, k));
  put_int(t, e);
  put_int(t, from);
  put_int(t, to);
  put_unit(t);
}

thr_status thr_table_steps(const thr_plan *p, thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, &text, err);
  thr_held held = {0};
  if (!st) st = thr_held_make(&held, p->frame.n_edges, err);
  thr_text_append(&text,
                  "cord,step,from,to,how,visit,turn,degrees,length,used,left,path,path_step,edge,from_node,to_node,unit\n");
  for (int path = 0; path < p->n_cords && !st; path++)
    for (int c = path; c < p->n_cords && t.copy[path].of == path; c++) {
      double used = 0, length = thr_cord_length(t.f, &p->cord[c]);
      for (int k = 0; k < p->cord[c].n_passes && t.copy[c].of == path; k++)
        put_step(&t, c, k, &used, length, &held);
    }
  thr_held_destroy(&held);
  return table_close(&t, st, out, err);
}

/* ---- cords.csv ---- */

static void put_cord(table *t, int c, const char *const *motion)
{
  const thr_cord *cord = &t->plan->cord[c];
  thr_cut_length cut = thr_supplies_cut(&t->supplies, c);
  char words[192];
  put_text(t, cord->id);
  put_yes(t, cord->closed);
  put_text(t, place(t, thr_cord_start(t->f, cord)));
  put_text(t, place(t, thr_cord_end(t->f, cord)));
  put_int(t, cord->n_passes);
  put_number(t, cut.length);
  if (t->supplies.mm > 0) {
    put_number(t, cut.tails);
    put_number(t, cut.knots);
    put_number(t, cut.turns);
    put_number(t, cut.cut);
  } else
    thr_text_append(t->out, ",,,,");
  put_angle(t, thr_cord_turning(t->f, cord, t->plan->options.ends == THR_ENDS_CLOSED));
  put_text(t, t->plan->cord[t->copy[c].of].id);
  thr_copies_words(t->plan, t->copy, c, t->copy[c].of == c ? NULL : motion, words);
  put_text(t, words[0] ? words + strlen(", ") : words);
  put_unit(t);
}

thr_status thr_table_cords(const thr_plan *p, const char *const *motion, thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, &text, err);
  if (!st) st = thr_supplies_find_sizes(&t.supplies, err);
  thr_text_append(&text, "cord,closed,start,end,passes,length,tails,knots,turns,cut,turning_degrees,path,repeated,unit\n");
  for (int c = 0; c < p->n_cords && !st; c++)
    put_cord(&t, c, motion);
  return table_close(&t, st, out, err);
}

/* ---- beads.csv ---- */

static void put_bore(table *t, double cords)
{
  put_number(t, cords);
  if (t->supplies.mm > 0)
    put_number(t, thr_supplies_bore_mm(&t->supplies, cords));
  else
    thr_text_append(t->out, ",");
}

static void put_edge(table *t, int e, int kind)
{
  const int *end = t->f->edge[e];
  thr_text_append(t->out, "edge,");
  put_int(t, e);
  put_int(t, kind);
  for (int i = 0; i < 2; i++)
    put_text(t, place(t, end[i]));
  put_number(t, t->f->length[e]);
  put_int(t, t->supplies.passes[e]);
  put_bore(t, thr_supplies_bore(&t->supplies, e));
  for (int i = 0; i < 2; i++)
    put_int(t, thr_degree(t->f, end[i]));
  for (int i = 0; i < 2; i++)
    put_yes(t, t->f->foot[end[i]]);
  put_unit(t);
}

/* visits: of cords that run through it, start or end in it. */
static void put_node(table *t, int v, int kind, int visits)
{
  double length = 0;
  for (int i = t->f->first[v]; i < t->f->first[v + 1]; i++)
    length += t->f->length[t->f->half[i] >> 1] / 2;
  thr_text_append(t->out, "node,");
  put_int(t, v);
  put_int(t, kind);
  put_text(t, place(t, v));
  put_text(t, "");
  put_number(t, length);
  put_int(t, visits);
  put_bore(t, thr_supplies_node_bore(&t->supplies, v));
  put_int(t, thr_degree(t->f, v));
  put_text(t, "");
  put_yes(t, t->f->foot[v]);
  put_text(t, "");
  put_unit(t);
}

thr_status thr_table_beads(const thr_plan *p, thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, &text, err);
  if (!st) st = thr_supplies_find_sizes(&t.supplies, err);
  int n = p->frame.n_nodes;
  int *edge_kind = st ? NULL : thr_calloc((size_t)p->frame.n_edges, sizeof *edge_kind);
  int *node_kind = st ? NULL : thr_calloc((size_t)n, sizeof *node_kind);
  int *visits = st ? NULL : thr_calloc((size_t)n, sizeof *visits);
  if (!st && (!edge_kind || !node_kind || !visits)) st = thr_nomem(err);
  if (!st) st = thr_kinds_find(t.f, edge_kind, node_kind, err);
  if (!st) thr_supplies_visits(p, visits);
  thr_text_append(&text,
                  "bead,number,kind,from,to,length,passes,bore_cords,bore_mm,from_degree,to_degree,from_foot,to_foot,unit\n");
  for (int e = 0; e < p->frame.n_edges && !st; e++)
    put_edge(&t, e, edge_kind[e]);
  for (int v = 0; v < n && p->options.joint == THR_JOINT_SOLID && !st; v++)
    put_node(&t, v, node_kind[v], visits[v]);
  free(edge_kind);
  free(node_kind);
  free(visits);
  return table_close(&t, st, out, err);
}
