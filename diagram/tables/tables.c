/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "diagram/tables/tables.h"

#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/tables/supplies.h"
#include "graph/angle.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What all tables are made from. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  thr_guide guide;
  thr_supplies supplies;
  thr_pieces pieces;
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

/* A name of the framework's file, or a word: cleaned, with an apostrophe before what would be a
 * formula, in quotes if needed. */
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

/* A text that is made for the field; destroys it. */
static void put_words(table *t, thr_text *words)
{
  if (words->failed) t->out->failed = true;
  put_text(t, words->data && !words->failed ? words->data : "");
  thr_text_destroy(words);
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

static thr_status table_make(table *t, const thr_plan *p, double tolerance,
                             const thr_layout *layout, thr_text *out, thr_err *err)
{
  *t = (table){.plan = p, .f = &p->frame, .out = out};
  thr_status st = thr_supplies_make(&t->supplies, p, err);
  if (st) return st;
  t->copy = thr_calloc((size_t)p->n_cords, sizeof *t->copy);
  if (!t->copy) return thr_nomem(err);
  st = thr_copies_find(p, t->copy, err);
  if (!st) st = thr_pieces_make(&t->pieces, p, tolerance, err);
  return st ? st : thr_guide_make(&t->guide, t->f, layout, err);
}

/* Takes the text over into out, if all went well. */
static thr_status table_close(table *t, thr_status st, thr_text *out, thr_err *err)
{
  if (!st && !t->out->failed) thr_text_append_bytes(out, t->out->data, t->out->length);
  if (!st && (t->out->failed || out->failed)) st = thr_nomem(err);
  thr_text_destroy(t->out);
  thr_guide_destroy(&t->guide);
  thr_supplies_destroy(&t->supplies);
  thr_pieces_destroy(&t->pieces);
  free(t->copy);
  return st;
}

static const char *place(const table *t, int v)
{
  return t->guide.label[v];
}

static void put_name(table *t, int piece)
{
  thr_text name = {0};
  thr_pieces_name(&t->pieces, (const char(*)[THR_LABEL])t->guide.label, piece, &name);
  put_words(t, &name);
}

static void put_kind(table *t, int piece)
{
  char name[24];
  thr_pieces_kind_name(&t->pieces, t->pieces.kind[piece], name);
  put_text(t, name);
}

/* What the arm of a half-edge that leaves a piece faces; with tube joints the place at that end. -1
 * = no arm. */
static void put_arm(table *t, int half)
{
  put_text(t,
           half < 0 ? "" : place(t, t->pieces.solid ? thr_head(t->f, half) : thr_tail(t->f, half)));
}

/* ---- steps.csv ---- */

static const char *way_name(thr_way way)
{
  static const char *const name[] = {"straight on",    "left", "right",
                                     "over the curve", "turn", "back"};
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

/* The arms that a visit comes in and goes out by, as half-edges that leave the piece. */
static int arm_in(const thr_visit *visit, bool solid)
{
  return visit->in < 0 ? -1 : solid ? visit->in ^ 1 : visit->in;
}

static int arm_out(const thr_visit *visit, bool solid)
{
  return visit->out < 0 ? -1 : solid ? visit->out : visit->out ^ 1;
}

/* What a needle has behind it; whether it is the one that goes back from the fold, or the only one.
 */
typedef struct {
  bool left, alone;
  double used, length; /* of its part of the cord */
} needle;

/* The half-edge by which the needle came through the tube before this one; -1 = there is none. */
static int tube_before(const thr_cord *cord, const thr_visit *visit, bool left)
{
  if (left) return visit->number < cord->n_passes ? cord->half[visit->number] ^ 1 : -1;
  return visit->number > 1 ? cord->half[visit->number - 2] : -1;
}

/* How the cord turns: in a solid piece, or from the tube before into this one. */
static void put_turn(table *t, const thr_visit *visit, bool left)
{
  int in = t->pieces.solid ? visit->in : tube_before(&t->plan->cord[visit->cord], visit, left);
  int out = t->pieces.solid ? visit->out : visit->in;
  if (in >= 0 && out >= 0) {
    put_text(t, way_name(thr_guide_way(&t->guide, in, out)));
    put_angle(t, thr_turn_angle(t->f, in, out));
  } else
    thr_text_printf(t->out, "%s,,", in < 0 ? "start" : "end");
}

static void put_step(table *t, const thr_visit *visit, needle *now)
{
  const thr_cord *cord = &t->plan->cord[visit->cord];
  bool solid = t->pieces.solid;
  double pass = visit->number ? t->f->length[visit->in >> 1] : 0;
  now->used += pass;
  put_text(t, cord->id);
  put_int(t, visit->number);
  put_name(t, visit->piece);
  put_kind(t, visit->piece);
  put_text(t, visit->nth == 1 ? "pick up" : visit->back ? "back through" : "through");
  put_int(t, visit->nth);
  put_arm(t, arm_in(visit, solid));
  put_arm(t, arm_out(visit, solid));
  put_turn(t, visit, now->left);
  put_number(t, pass);
  put_number(t, now->used);
  put_number(t, visit->number == (now->left ? 1 : cord->n_passes) ? 0 : now->length - now->used);
  put_text(t, t->plan->cord[t->copy[visit->cord].of].id);
  put_int(t, visit->number ? path_step(t, visit->cord, visit->number - 1) : 0);
  if (visit->number)
    put_int(t, visit->in >> 1);
  else
    put_text(t, "");
  if (visit->number)
    put_int(t, thr_tail(t->f, visit->in));
  else
    put_text(t, "");
  put_int(t, visit->number ? thr_head(t->f, visit->in) : thr_tail(t->f, visit->out));
  put_text(t, now->alone ? "" : now->left ? "left" : "right");
  put_unit(t);
}

/* The rows of one needle; returns how many. */
static int put_part(table *t, const thr_part *part, const thr_visit *visit)
{
  const thr_cord *cord = &t->plan->cord[part->cord];
  const int n = part->end - part->first + (part->begins && t->pieces.solid);
  needle now = {.left = part->backward, .alone = part->end - part->first == cord->n_passes};
  for (int k = part->first; k < part->end; k++)
    now.length += t->f->length[cord->half[k] >> 1];
  for (int i = 0; i < n; i++)
    put_step(t, &visit[i], &now);
  return n;
}

thr_status thr_table_steps(const thr_plan *p, double tolerance, int needles,
                           const thr_layout *layout, thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, tolerance, layout, &text, err);
  thr_part *part = st ? NULL : thr_calloc(2 * (size_t)p->n_cords, sizeof *part);
  thr_visit *visit = NULL;
  int n = 0, parts = 0;
  if (!st && !part) st = thr_nomem(err);
  if (!st) {
    parts = thr_pieces_parts(p, t.copy, needles, part);
    st = thr_pieces_follow(&t.pieces, part, parts, &visit, &n, err);
  }
  thr_text_append(&text, "cord,step,piece,kind,how,visit,in,out,turn,degrees,length,used,left,path,"
                         "path_step,edge,from_node,to_node,"
                         "needle,unit\n");
  for (int k = 0, i = 0; k < parts && !st; k++)
    i += put_part(&t, &part[k], visit + i);
  free(part);
  free(visit);
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

thr_status thr_table_cords(const thr_plan *p, const char *const *motion, const thr_layout *layout,
                           thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, 0, layout, &text, err);
  if (!st) st = thr_supplies_find_sizes(&t.supplies, err);
  thr_text_append(&text, "cord,closed,start,end,passes,length,tails,knots,turns,cut,turning_"
                         "degrees,path,repeated,unit\n");
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

/* What the arms of a piece face and how many cords are in each, in the order of thr_guide_around;
 * of a tube its two places and the cords in it. */
static void put_arms(table *t, int piece, const int *around)
{
  thr_text faces = {0}, cords = {0};
  if (!t->pieces.solid) {
    thr_text_printf(&faces, "%s %s", place(t, t->f->edge[piece][0]),
                    place(t, t->f->edge[piece][1]));
    thr_text_printf(&cords, "%d", t->supplies.passes[piece]);
  } else
    for (int i = t->f->first[piece]; i < t->f->first[piece + 1]; i++) {
      const char *blank = i > t->f->first[piece] ? " " : "";
      thr_text_printf(&faces, "%s%s", blank, place(t, thr_head(t->f, around[i])));
      thr_text_printf(&cords, "%s%d", blank, t->supplies.passes[around[i] >> 1]);
    }
  put_words(t, &faces);
  put_words(t, &cords);
}

/* Of its arms together, in units. */
static double length_of(const table *t, int piece)
{
  double length = 0;
  if (!t->pieces.solid) return t->f->length[piece];
  for (int i = t->f->first[piece]; i < t->f->first[piece + 1]; i++)
    length += t->f->length[t->f->half[i] >> 1] / 2;
  return length;
}

static bool is_foot(const table *t, int piece)
{
  const bool *foot = t->f->foot;
  return t->pieces.solid ? foot[piece] : foot[t->f->edge[piece][0]] || foot[t->f->edge[piece][1]];
}

static void put_piece(table *t, int piece, const int *around, const int *visits)
{
  bool solid = t->pieces.solid;
  put_name(t, piece);
  put_kind(t, piece);
  put_int(t, piece);
  put_int(t, thr_pieces_arms(&t->pieces, piece));
  put_arms(t, piece, around);
  put_number(t, length_of(t, piece));
  put_int(t, solid ? visits[piece] : t->supplies.passes[piece]);
  put_bore(t, solid ? thr_supplies_node_bore(&t->supplies, piece)
                    : thr_supplies_bore(&t->supplies, piece));
  put_yes(t, is_foot(t, piece));
  put_unit(t);
}

thr_status thr_table_beads(const thr_plan *p, double tolerance, const thr_layout *layout,
                           thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_status st = table_make(&t, p, tolerance, layout, &text, err);
  if (!st) st = thr_supplies_find_sizes(&t.supplies, err);
  int *visits = st ? NULL : thr_calloc((size_t)p->frame.n_nodes, sizeof *visits);
  int *around = st ? NULL : thr_calloc(2 * (size_t)p->frame.n_edges, sizeof *around);
  if (!st && (!visits || !around)) st = thr_nomem(err);
  if (!st) st = thr_guide_around(&t.guide, around, err);
  if (!st) thr_supplies_visits(p, visits);
  thr_text_append(
      &text, "piece,kind,number,arms,faces,cords,length,visits,bore_cords,bore_mm,foot,unit\n");
  for (int i = 0; i < t.pieces.n && !st; i++)
    put_piece(&t, i, around, visits);
  free(visits);
  free(around);
  return table_close(&t, st, out, err);
}

/* ---- channels.csv ---- */

static void put_channel(table *t, const thr_channel *channel, int piece)
{
  const int *passes = t->supplies.passes;
  put_name(t, piece);
  put_kind(t, piece);
  put_text(t, t->plan->cord[channel->cord].id);
  put_int(t, channel->pass + 1);
  put_arm(t, channel->in);
  put_arm(t, channel->out);
  put_int(t, channel->in < 0 ? 0 : passes[channel->in >> 1]);
  put_int(t, channel->out < 0 ? 0 : passes[channel->out >> 1]);
  put_int(t, channel->crosses);
  put_angle(t, channel->in < 0 || channel->out < 0 || !t->pieces.solid
                   ? 0
                   : thr_turn_angle(t->f, channel->in ^ 1, channel->out));
  if (!t->out->failed) t->out->data[t->out->length - 1] = '\n';
}

static void put_tube_channels(table *t)
{
  for (int c = 0; c < t->plan->n_cords; c++)
    for (int k = 0; k < t->plan->cord[c].n_passes; k++) {
      int h = t->plan->cord[c].half[k];
      put_channel(t, &(thr_channel){.cord = c, .pass = k, .in = h, .out = h ^ 1}, h >> 1);
    }
}

thr_status thr_table_channels(const thr_plan *p, double tolerance, const thr_layout *layout,
                              thr_text *out, thr_err *err)
{
  table t;
  thr_text text = {0};
  thr_channels channels = {0};
  thr_status st = table_make(&t, p, tolerance, layout, &text, err);
  if (!st) st = thr_channels_make(&channels, p, err);
  thr_text_append(&text, "piece,kind,cord,step,in,out,cords_in,cords_out,crosses,degrees\n");
  for (int v = 0; v < p->frame.n_nodes && !st && t.pieces.solid; v++)
    for (int i = channels.first[v]; i < channels.first[v + 1]; i++)
      put_channel(&t, &channels.channel[i], v);
  if (!st && !t.pieces.solid) put_tube_channels(&t);
  thr_channels_destroy(&channels);
  return table_close(&t, st, out, err);
}
