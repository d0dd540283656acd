#include "diagram/tables.h"

#include "diagram/copies.h"
#include "diagram/guide.h"
#include "diagram/kinds.h"
#include "diagram/scene.h"
#include "graph/bore.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* What all tables are made from. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  thr_guide guide;
  thr_copy *copy;    /* [n_cords] */
  int *passes;       /* [n_edges] */
  double mm;         /* per unit; 0 = sizes in mm are not known */
  double cord;       /* mm, diameter; > 0 if mm is */
  double bore;       /* mm, of the plan */
  double *narrowest; /* [most passes of an edge + 1] bore for so many, in cord diameters; 0 = not asked for yet */
  thr_text *out;
} table;

/* ---- fields ---- */

static void put_text(table *t, const char *s)
{
  bool quoted = s[strcspn(s, ",\"\r\n")] != '\0';
  thr_text_append(t->out, quoted ? "\"" : "");
  for (; *s; s++) {
    if (*s == '"') thr_text_append(t->out, "\"");
    thr_text_append_bytes(t->out, s, 1);
  }
  thr_text_append(t->out, quoted ? "\"," : ",");
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
  put_number(t, nearbyint(angle * (180 / PI) * 100) / 100);
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

/* Cord and bores as the plan was evaluated, else as asked for or worked out. Where nothing was said of them, a framework whose
 * size is not known, or is no bead's, leaves them open. */
static thr_status find_sizes(table *t, thr_err *err)
{
  const thr_plan *p = t->plan;
  const thr_physics *asked = &p->options.physics;
  thr_physics sizes = p->evaluation.physics;
  double mm;
  if (thr_units_in_mm(t->f->units, &mm, NULL)) return THR_OK;
  if (!p->evaluation.present) {
    thr_err why = {0};
    bool said = asked->cord_diameter > 0 || asked->bore > 0 || asked->bead_diameter > 0;
    thr_status st = thr_physics_resolve(asked, t->f, &sizes, &why);
    if (st) return st == THR_EINPUT && !said ? THR_OK : thr_fail(err, st, "%s", why.text);
  }
  t->mm = mm;
  t->cord = sizes.cord_diameter;
  t->bore = sizes.bore;
  return THR_OK;
}

static thr_status table_make(table *t, const thr_plan *p, thr_text *out, thr_err *err)
{
  int n, most = 0;
  *t = (table){.plan = p, .f = &p->frame, .out = out};
  thr_status st = thr_scene_check_cords(p, &n, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;
  t->copy = thr_calloc((size_t)p->n_cords, sizeof *t->copy);
  t->passes = thr_calloc((size_t)t->f->n_edges, sizeof *t->passes);
  if (!t->copy || !t->passes) return thr_nomem(err);
  for (int c = 0; c < p->n_cords; c++)
    for (int k = 0; k < p->cord[c].n_passes; k++)
      t->passes[p->cord[c].half[k] >> 1]++;
  for (int e = 0; e < t->f->n_edges; e++)
    if (t->passes[e] > most) most = t->passes[e];
  t->narrowest = thr_calloc((size_t)most + 1, sizeof *t->narrowest);
  if (!t->narrowest) return thr_nomem(err);
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
  free(t->copy);
  free(t->passes);
  free(t->narrowest);
  return st;
}

/* In cord diameters, for the passes of edge e. */
static double bore_of(table *t, int e)
{
  double *bore = &t->narrowest[t->passes[e]];
  if (*bore == 0 && t->passes[e]) *bore = thr_bore_for(t->passes[e]);
  return *bore;
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

/* visits[e]: passes of edge e so far; last[e]: half-edge of the latest. */
static void put_step(table *t, int c, int k, double *used, double length, int *visits, int *last)
{
  const thr_cord *cord = &t->plan->cord[c];
  int h = cord->half[k], e = h >> 1, from = thr_tail(t->f, h), to = thr_head(t->f, h);
  const char *how = !visits[e] ? "pick up" : last[e] == h ? "pass through" : "pass back through";
  put_text(t, cord->id);
  put_int(t, k + 1);
  put_text(t, place(t, from));
  put_text(t, place(t, to));
  put_text(t, how);
  put_int(t, ++visits[e]);
  last[e] = h;
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
  int *visits = st ? NULL : thr_calloc((size_t)p->frame.n_edges, sizeof *visits);
  int *last = st ? NULL : thr_calloc((size_t)p->frame.n_edges, sizeof *last);
  if (!st && (!visits || !last)) st = thr_nomem(err);
  thr_text_append(&text,
                  "cord,step,from,to,how,visit,turn,degrees,length,used,left,path,path_step,edge,from_node,to_node,unit\n");
  for (int path = 0; path < p->n_cords && !st; path++)
    for (int c = path; c < p->n_cords && t.copy[path].of == path; c++) {
      double used = 0, length = thr_cord_length(t.f, &p->cord[c]);
      for (int k = 0; k < p->cord[c].n_passes && t.copy[c].of == path; k++)
        put_step(&t, c, k, &used, length, visits, last);
    }
  free(visits);
  free(last);
  return table_close(&t, st, out, err);
}

/* ---- cords.csv ---- */

/* Cord that turns take at most beside the way through the middles, mm. */
static double in_turns(table *t, const thr_cord *c)
{
  double sum = 0;
  int turns = thr_cord_turns(&t->plan->options, c);
  for (int k = 0; k < turns; k++) {
    int in = c->half[k], out = c->half[(k + 1) % c->n_passes];
    double bore = fmax(t->bore, t->cord * fmax(bore_of(t, in >> 1), bore_of(t, out >> 1)));
    sum += (bore - t->cord) / 2 * thr_turn_angle(t->f, in, out);
  }
  return sum;
}

static void put_cord(table *t, int c, const char *const *motion)
{
  const thr_cord *cord = &t->plan->cord[c];
  double length = thr_cord_length(t->f, cord), tails = 2 * THR_TABLE_TAIL, knots = 2 * THR_TABLE_KNOT * t->cord;
  char words[192];
  put_text(t, cord->id);
  put_yes(t, cord->closed);
  put_text(t, place(t, thr_cord_start(t->f, cord)));
  put_text(t, place(t, thr_cord_end(t->f, cord)));
  put_int(t, cord->n_passes);
  put_number(t, length);
  if (t->mm > 0) {
    double turns = in_turns(t, cord);
    put_number(t, tails / t->mm);
    put_number(t, knots / t->mm);
    put_number(t, turns / t->mm);
    put_number(t, length + (tails + knots + turns) / t->mm);
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
  if (!st) st = find_sizes(&t, err);
  thr_text_append(&text, "cord,closed,start,end,passes,length,tails,knots,turns,cut,turning_degrees,path,repeated,unit\n");
  for (int c = 0; c < p->n_cords && !st; c++)
    put_cord(&t, c, motion);
  return table_close(&t, st, out, err);
}

/* ---- beads.csv ---- */

/* Rounded up: a hundredth of a mm too narrow is too narrow. */
static void put_bore(table *t, double cords)
{
  put_number(t, cords);
  if (t->mm > 0)
    put_number(t, ceil(cords * t->cord * 100 - 1e-6) / 100);
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
  put_int(t, t->passes[e]);
  put_bore(t, bore_of(t, e));
  for (int i = 0; i < 2; i++)
    put_int(t, thr_degree(t->f, end[i]));
  for (int i = 0; i < 2; i++)
    put_yes(t, t->f->foot[end[i]]);
  put_unit(t);
}

/* visits: of cords that run through it, start or end in it. */
static void put_node(table *t, int v, int kind, int visits)
{
  double length = 0, bore = 0;
  for (int i = t->f->first[v]; i < t->f->first[v + 1]; i++) {
    length += t->f->length[t->f->half[i] >> 1] / 2;
    bore = fmax(bore, bore_of(t, t->f->half[i] >> 1));
  }
  thr_text_append(t->out, "node,");
  put_int(t, v);
  put_int(t, kind);
  put_text(t, place(t, v));
  put_text(t, "");
  put_number(t, length);
  put_int(t, visits);
  put_bore(t, bore);
  put_int(t, thr_degree(t->f, v));
  put_text(t, "");
  put_yes(t, t->f->foot[v]);
  put_text(t, "");
  put_unit(t);
}

/* visits[n_nodes], all 0. */
static void count_visits(const thr_plan *p, int *visits)
{
  for (int c = 0; c < p->n_cords; c++) {
    const thr_cord *cord = &p->cord[c];
    for (int k = 0; k < cord->n_passes; k++)
      visits[thr_tail(&p->frame, cord->half[k])]++;
    if (!cord->closed) visits[thr_cord_end(&p->frame, cord)]++;
  }
}

thr_status thr_table_beads(const thr_plan *p, thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, &text, err);
  if (!st) st = find_sizes(&t, err);
  int n = p->frame.n_nodes;
  int *edge_kind = st ? NULL : thr_calloc((size_t)p->frame.n_edges, sizeof *edge_kind);
  int *node_kind = st ? NULL : thr_calloc((size_t)n, sizeof *node_kind);
  int *visits = st ? NULL : thr_calloc((size_t)n, sizeof *visits);
  if (!st && (!edge_kind || !node_kind || !visits)) st = thr_nomem(err);
  if (!st) st = thr_kinds_find(t.f, edge_kind, node_kind, err);
  if (!st) count_visits(p, visits);
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
