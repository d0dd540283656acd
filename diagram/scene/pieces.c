/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a plan: what a hand picks up. With solid joints a piece is a node, with an arm to
 * the middle of each of its edges; with tube joints it is an edge. Every picture, table and
 * sentence speaks of these and calls them alike. Private to diagram/. */
#include "diagram/scene/scene.h"

#include "diagram/tables/kinds.h"
#include "graph/angle.h"
#include "graph/plan/plan_measures.h"

#include <stdio.h>
#include <stdlib.h>

int thr_pieces_count(const thr_plan *plan)
{
  return plan->options.joint == THR_JOINT_SOLID ? plan->frame.n_nodes : plan->frame.n_edges;
}

const char *thr_pieces_word(const thr_plan *plan, int n)
{
  if (plan->options.joint == THR_JOINT_SOLID) return n == 1 ? "piece" : "pieces";
  return n == 1 ? "tube" : "tubes";
}

/* ---- kinds ---- */

int thr_pieces_arms(const thr_pieces *pieces, int piece)
{
  return pieces->solid ? thr_degree(pieces->f, piece) : 2;
}

/* Are two of the node's arms in line? */
static bool has_line(const thr_frame *frame, int v)
{
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    for (int j = frame->first[v]; j < i; j++)
      if (thr_turn_angle(frame, frame->half[i] ^ 1, frame->half[j]) < THR_PI - THR_PIECES_IN_LINE)
        return true;
  return false;
}

char thr_pieces_letter(const thr_pieces *pieces, int piece)
{
  int arms = thr_pieces_arms(pieces, piece);
  if (!pieces->solid || arms > 4) return '\0';
  if (arms == 2) return has_line(pieces->f, piece) ? 'I' : 'L';
  if (arms == 3) return has_line(pieces->f, piece) ? 'T' : 'Y';
  return arms == 4 ? 'X' : 'P';
}

typedef struct {
  int arms;
  char letter;
  int model, kind;
} shape;

static int by_shape(const void *a, const void *b)
{
  const shape *p = a, *q = b;
  if (p->arms != q->arms) return p->arms - q->arms;
  if (p->letter != q->letter) return p->letter - q->letter;
  return p->model - q->model;
}

/* Kinds come numbered by their first piece; they are numbered again by shape. */
static thr_status order_kinds(thr_pieces *pieces, thr_err *err)
{
  int n = 0;
  for (int i = 0; i < pieces->n; i++)
    n = pieces->kind[i] > n ? pieces->kind[i] : n;
  shape *shapes = thr_calloc((size_t)n + 1, sizeof *shapes);
  int *number = thr_calloc((size_t)n + 1, sizeof *number);
  pieces->n_kinds = n;
  pieces->members = thr_calloc((size_t)n + 1, sizeof *pieces->members);
  pieces->model = thr_calloc((size_t)n + 1, sizeof *pieces->model);
  thr_status st = shapes && number && pieces->members && pieces->model ? THR_OK : thr_nomem(err);
  for (int i = pieces->n - 1; i >= 0 && !st; i--)
    shapes[pieces->kind[i] - 1] =
        (shape){thr_pieces_arms(pieces, i), thr_pieces_letter(pieces, i), i, pieces->kind[i]};
  if (!st && pieces->solid) qsort(shapes, (size_t)n, sizeof *shapes, by_shape);
  for (int k = 0; k < n && !st; k++) {
    number[shapes[k].kind] = k + 1;
    pieces->model[k + 1] = shapes[k].model;
  }
  for (int i = 0; i < pieces->n && !st; i++) {
    pieces->kind[i] = number[pieces->kind[i]];
    pieces->members[pieces->kind[i]]++;
  }
  free(shapes);
  free(number);
  return st;
}

thr_status thr_pieces_make(thr_pieces *pieces, const thr_plan *plan, double tolerance, thr_err *err)
{
  *pieces = (thr_pieces){
      .plan = plan, .f = &plan->frame, .solid = plan->options.joint == THR_JOINT_SOLID};
  pieces->n = thr_pieces_count(plan);
  pieces->kind = thr_calloc((size_t)pieces->n, sizeof *pieces->kind);
  if (!pieces->kind) return thr_nomem(err);
  thr_status st = thr_kinds_find(pieces->f, tolerance, pieces->solid ? NULL : pieces->kind,
                                 pieces->solid ? pieces->kind : NULL, err);
  return st ? st : order_kinds(pieces, err);
}

void thr_pieces_destroy(thr_pieces *pieces)
{
  free(pieces->kind);
  free(pieces->members);
  free(pieces->model);
  *pieces = (thr_pieces){0};
}

/* ---- names ---- */

void thr_pieces_kind_name(const thr_pieces *pieces, int kind, char name[24])
{
  int arms = thr_pieces_arms(pieces, pieces->model[kind]);
  char letter = thr_pieces_letter(pieces, pieces->model[kind]);
  if (!pieces->solid)
    snprintf(name, 24, "%d", kind);
  else if (letter)
    snprintf(name, 24, "%c-%d", letter, kind);
  else
    snprintf(name, 24, "%d-%d", arms, kind);
}

void thr_pieces_name(const thr_pieces *pieces, const char (*label)[THR_LABEL], int piece,
                     thr_text *text)
{
  const int *end = pieces->solid ? NULL : pieces->f->edge[piece];
  if (pieces->solid)
    thr_text_append(text, label[piece]);
  else
    thr_text_printf(text, "%s-%s", label[end[0]], label[end[1]]);
}

void thr_pieces_pick(const thr_pieces *pieces, const char (*label)[THR_LABEL], int piece,
                     thr_text *text)
{
  char name[24], letter = thr_pieces_letter(pieces, piece);
  bool alone = pieces->members[pieces->kind[piece]] == 1;
  thr_pieces_kind_name(pieces, pieces->kind[piece], name);
  if (!alone) thr_text_printf(text, "%s%s (", pieces->solid ? "" : "tube ", name);
  thr_pieces_name(pieces, label, piece, text);
  if (!alone)
    thr_text_append(text, ")");
  else if (letter)
    thr_text_printf(text, " (%s %c)", letter == 'P' || letter == 'T' || letter == 'Y' ? "a" : "an",
                    letter);
  else if (pieces->solid)
    thr_text_printf(text, " (with %d arms)", thr_pieces_arms(pieces, piece));
}

void thr_pieces_shapes(const thr_pieces *pieces, thr_text *text)
{
  int said = 0;
  for (int k = 1, count; k <= pieces->n_kinds && pieces->solid; k += count) {
    int arms = thr_pieces_arms(pieces, pieces->model[k]), members = 0;
    char letter = thr_pieces_letter(pieces, pieces->model[k]);
    for (count = 0; k + count <= pieces->n_kinds &&
                    thr_pieces_arms(pieces, pieces->model[k + count]) == arms &&
                    thr_pieces_letter(pieces, pieces->model[k + count]) == letter;
         count++)
      members += pieces->members[k + count];
    thr_text_printf(text, said++ ? ", %d " : "%d ", members);
    if (letter)
      thr_text_printf(text, "%c", letter);
    else
      thr_text_printf(text, "with %d arms", arms);
  }
}

/* ---- threading ---- */

/* What is known while the needle is followed. */
typedef struct {
  const thr_pieces *pieces;
  thr_visit *visit;
  int n;
  int *times, *since, *last; /* [pieces->n] visits so far, the first of them, the half-edge by which
                                the last one came in */
} follower;

static void enter(follower *to, int cord, int number, int in, int out)
{
  const thr_frame *frame = to->pieces->f;
  int piece = !to->pieces->solid ? in >> 1 : in >= 0 ? thr_head(frame, in) : thr_tail(frame, out);
  bool back = !to->pieces->solid && to->times[piece] && to->last[piece] != in;
  if (to->times[piece]++ == 0) to->since[piece] = to->n;
  to->last[piece] = in;
  to->visit[to->n++] = (thr_visit){.cord = cord,
                                   .number = number,
                                   .piece = piece,
                                   .in = in,
                                   .out = out,
                                   .nth = to->times[piece],
                                   .since = to->since[piece],
                                   .back = back};
}

static void follow_part(follower *to, const thr_part *part)
{
  const int *half = to->pieces->plan->cord[part->cord].half;
  int n = part->end - part->first;
  for (int i = part->begins && to->pieces->solid ? -1 : 0; i < n; i++) {
    int k = part->backward ? part->end - 1 - i : part->first + i,
        next = part->backward ? k - 1 : k + 1;
    int in = i < 0 ? -1 : half[k] ^ part->backward,
        out = i + 1 < n ? half[next] ^ part->backward : -1;
    enter(to, part->cord, i < 0 ? 0 : k + 1, in, to->pieces->solid ? out : in);
  }
}

thr_status thr_pieces_follow(const thr_pieces *pieces, const thr_part *parts, int n_parts,
                             thr_visit **visits, int *n, thr_err *err)
{
  int total = 0;
  for (int i = 0; i < n_parts; i++)
    total += parts[i].end - parts[i].first + 1;
  follower to = {.pieces = pieces,
                 .visit = thr_calloc((size_t)total, sizeof *to.visit),
                 .times = thr_calloc((size_t)pieces->n, sizeof *to.times),
                 .since = thr_calloc((size_t)pieces->n, sizeof *to.since),
                 .last = thr_calloc((size_t)pieces->n, sizeof *to.last)};
  thr_status st = to.visit && to.times && to.since && to.last ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_parts && !st; i++)
    follow_part(&to, &parts[i]);
  free(to.times);
  free(to.since);
  free(to.last);
  if (st) free(to.visit);
  *visits = st ? NULL : to.visit;
  *n = st ? 0 : to.n;
  return st;
}

static int add_parts(const thr_plan *plan, int c, int needles, thr_part *part)
{
  const thr_cord *cord = &plan->cord[c];
  int fold = thr_cord_fold(&plan->frame, needles, cord), n = 0;
  part[n++] = (thr_part){.cord = c, .first = fold, .end = cord->n_passes, .begins = true};
  if (fold) part[n++] = (thr_part){.cord = c, .first = 0, .end = fold, .backward = true};
  return n;
}

int thr_pieces_parts(const thr_plan *plan, const thr_copy *copy, int needles, thr_part *part)
{
  int n = 0;
  for (int path = 0; path < plan->n_cords; path++) {
    if (copy[path].of != path) continue;
    n += add_parts(plan, path, needles, part + n);
    for (int c = 0; c < plan->n_cords; c++)
      if (c != path && copy[c].of == path) n += add_parts(plan, c, needles, part + n);
  }
  return n;
}

/* ---- words ---- */

/* ", on cord A since its row 3", ", on the cord since its start" */
static void say_since(const thr_pieces *pieces, const thr_visit *visits, int i, const int *step,
                      thr_text *text)
{
  const thr_visit *visit = &visits[i], *first = &visits[visit->since];
  bool same = visit->cord == first->cord;
  if (step && !same)
    thr_text_printf(text, ", on cord %s", pieces->plan->cord[first->cord].id);
  else if (step && step[visit->since] != step[i])
    thr_text_printf(text, ", on since step %d", step[visit->since]);
  else if (step && first->number)
    thr_text_printf(text, ", your row %d", first->number);
  if (step && (!same || step[visit->since] != step[i] || first->number)) return;
  if (same)
    thr_text_append(text, ", on the cord since ");
  else
    thr_text_printf(text, ", on cord %s since its ", pieces->plan->cord[first->cord].id);
  if (first->number)
    thr_text_printf(text, "row %d", first->number);
  else
    thr_text_append(text, same ? "its start" : "start");
}

/* "in from A5, out to C5" */
static void say_arms(const thr_pieces *pieces, const char (*label)[THR_LABEL],
                     const thr_visit *visit, thr_text *text)
{
  const thr_frame *frame = pieces->f;
  if (!pieces->solid) {
    thr_text_printf(text, "in at %s, out at %s", label[thr_tail(frame, visit->in)],
                    label[thr_head(frame, visit->in)]);
    return;
  }
  if (visit->in >= 0) thr_text_printf(text, "in from %s, ", label[thr_tail(frame, visit->in)]);
  if (visit->out >= 0)
    thr_text_printf(text, "out to %s", label[thr_head(frame, visit->out)]);
  else
    thr_text_append(text, "here the end comes out");
}

void thr_pieces_say(const thr_pieces *pieces, const char (*label)[THR_LABEL],
                    const thr_visit *visits, int i, const int *step, thr_text *text)
{
  const thr_visit *visit = &visits[i];
  bool begins = pieces->solid && visit->in < 0;
  if (visit->nth == 1) {
    thr_text_append(text, begins ? "start, pick up " : "pick up ");
    thr_pieces_pick(pieces, label, visit->piece, text);
  } else {
    thr_text_append(text, begins ? "start in " : visit->back ? "back through " : "through ");
    thr_pieces_name(pieces, label, visit->piece, text);
    say_since(pieces, visits, i, step, text);
  }
  thr_text_append(text, ": ");
  say_arms(pieces, label, visit, text);
}
