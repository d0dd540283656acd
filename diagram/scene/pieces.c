/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names the pieces of a plan, groups them into kinds, and follows the needle from piece to piece.
 *
 * A piece is what a hand picks up: with solid joints a node, with an arm to the middle of each of
 * its edges; with tube joints an edge. Every picture, table and sentence takes names from here, so
 * that all of them call a piece alike.
 *
 * Example: node B5 with four arms, of the tenth kind, is "X-10 (B5)"; with tube joints edge A1-A2
 * of the second kind is "tube 2 (A1-A2)". */
#include "diagram/scene/scene.h"

#include "diagram/tables/tables.h"
#include "graph/number.h"
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

/* Returns whether two of the node's arms are in line: whether a cord turns little from one to the
 * other. */
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

/* A kind to be sorted by its shape. */
typedef struct {
  int arms;
  char letter;
  int model, kind;
} kind_shape;

/* Compares kinds by number of arms, then letter, then first piece. */
static int by_shape(const void *a, const void *b)
{
  const kind_shape *first = a, *second = b;
  if (first->arms != second->arms) return first->arms - second->arms;
  if (first->letter != second->letter) return first->letter - second->letter;
  return first->model - second->model;
}

/* Numbers the kinds by shape, which so far are numbered by their first piece; counts their members
 * and finds their first pieces. */
static thr_status order_kinds(thr_pieces *pieces, thr_err *err)
{
  int n = 0;
  for (int i = 0; i < pieces->n; i++)
    n = pieces->kind[i] > n ? pieces->kind[i] : n;

  kind_shape *shapes = thr_calloc((size_t)n + 1, sizeof *shapes);
  int *number = thr_calloc((size_t)n + 1, sizeof *number);
  pieces->n_kinds = n;
  pieces->members = thr_calloc((size_t)n + 1, sizeof *pieces->members);
  pieces->model = thr_calloc((size_t)n + 1, sizeof *pieces->model);

  thr_status st = shapes && number && pieces->members && pieces->model ? THR_OK : thr_nomem(err);

  /* From the last piece to the first one, so that the first piece of each kind is its model. */
  for (int i = pieces->n - 1; i >= 0 && !st; i--)
    shapes[pieces->kind[i] - 1] =
        (kind_shape){thr_pieces_arms(pieces, i), thr_pieces_letter(pieces, i), i, pieces->kind[i]};
  if (!st && pieces->solid) qsort(shapes, (size_t)n, sizeof *shapes, by_shape);

  /* New numbers from 1, in the order of the shapes. */
  for (int k = 0; k < n && !st; k++) {
    number[shapes[k].kind] = k + 1;
    pieces->model[k + 1] = shapes[k].model;
  }

  /* The pieces take over the new numbers. */
  for (int i = 0; i < pieces->n && !st; i++) {
    pieces->kind[i] = number[pieces->kind[i]];
    pieces->members[pieces->kind[i]]++;
  }
  for (int k = 1; k <= n && !st; k++)
    pieces->single += pieces->members[k] == 1;

  free(shapes);
  free(number);
  return st;
}

thr_status thr_pieces_make(thr_pieces *pieces, const thr_plan *plan, double tolerance, thr_err *err)
{
  /* The kinds of nodes for solid joints, of edges for tubes. */
  *pieces = (thr_pieces){
      .plan = plan, .f = &plan->frame, .solid = plan->options.joint == THR_JOINT_SOLID};
  pieces->n = thr_pieces_count(plan);
  pieces->kind = thr_calloc((size_t)pieces->n, sizeof *pieces->kind);
  if (!pieces->kind) return thr_nomem(err);

  /* Kinds of congruent pieces, from the geometry. */
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

bool thr_pieces_alone(const thr_pieces *pieces, int kind)
{
  return pieces->solid && pieces->members[kind] == 1 && pieces->single > THR_PIECES_SINGLE;
}

void thr_pieces_kind_name(const thr_pieces *pieces, int kind, char name[24])
{
  /* Tubes have no letter; five arms and more are a number. */
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
  bool alone = thr_pieces_alone(pieces, pieces->kind[piece]);

  thr_pieces_kind_name(pieces, pieces->kind[piece], name);

  /* Of very many kinds with one member no number helps to find it in the box. */
  if (!alone) thr_text_printf(text, "%s%s (", pieces->solid ? "" : "tube ", name);
  thr_pieces_name(pieces, label, piece, text);

  /* It says its shape instead. */
  if (!alone)
    thr_text_append(text, ")");
  else if (letter)
    thr_text_printf(text, " (%s %c)", letter == 'P' || letter == 'T' || letter == 'Y' ? "a" : "an",
                    letter);
  else
    thr_text_printf(text, " (with %d arms)", thr_pieces_arms(pieces, piece));
}

void thr_pieces_shapes(const thr_pieces *pieces, thr_text *text)
{
  int said = 0;

  /* Kinds are sorted by shape: each run of kinds is one shape. */
  for (int k = 1, count; k <= pieces->n_kinds && pieces->solid; k += count) {
    int arms = thr_pieces_arms(pieces, pieces->model[k]), members = 0;
    char letter = thr_pieces_letter(pieces, pieces->model[k]);

    for (count = 0; k + count <= pieces->n_kinds &&
                    thr_pieces_arms(pieces, pieces->model[k + count]) == arms &&
                    thr_pieces_letter(pieces, pieces->model[k + count]) == letter;
         count++)
      members += pieces->members[k + count];

    /* The number of pieces with this shape, and how it is called. */
    thr_text_printf(text, said++ ? ", %d " : "%d ", members);
    if (letter)
      thr_text_printf(text, "%c", letter);
    else
      thr_text_printf(text, "with %d arms", arms);
  }
}

/* ---- threading ---- */

/* The state while the needle is followed. */
typedef struct {
  const thr_pieces *pieces;
  thr_visit *visit;
  int n;
  int *times, *since, *last; /* [pieces->n] visits so far, the first of them, the half-edge by which
                                the last one came in */
} needle_state;

/* Adds a visit: the needle comes in by one half-edge and goes out by another (-1: it starts or ends
 * here). Of a tube both are its own. */
static void enter(needle_state *needle, int cord, int number, int in, int out)
{
  const thr_frame *frame = needle->pieces->f;

  /* The piece is the tube itself, or the node between the two half-edges. */
  int piece = !needle->pieces->solid ? in >> 1
              : in >= 0              ? thr_head(frame, in)
                                     : thr_tail(frame, out);
  bool back = !needle->pieces->solid && needle->times[piece] && needle->last[piece] != in;

  /* The first visit picks the piece up. */
  if (needle->times[piece]++ == 0) needle->since[piece] = needle->n;
  needle->last[piece] = in;

  /* A number of 0 says that the cord begins here. */
  needle->visit[needle->n++] = (thr_visit){.cord = cord,
                                           .number = number,
                                           .piece = piece,
                                           .in = in,
                                           .out = out,
                                           .nth = needle->times[piece],
                                           .since = needle->since[piece],
                                           .back = back};
}

/* Adds the visits of a part: one for each pass, and with solid joints one before the first pass if
 * the part begins its cord. */
static void follow_part(needle_state *needle, const thr_part *part)
{
  const int *half = needle->pieces->plan->cord[part->cord].half;
  int n = part->end - part->first;

  for (int i = part->begins && needle->pieces->solid ? -1 : 0; i < n; i++) {
    int k = part->backward ? part->end - 1 - i : part->first + i,
        next = part->backward ? k - 1 : k + 1;

    /* Against the plan's direction every half-edge is the opposite one. */
    int in = i < 0 ? -1 : half[k] ^ part->backward,
        out = i + 1 < n ? half[next] ^ part->backward : -1;

    enter(needle, part->cord, i < 0 ? 0 : k + 1, in, needle->pieces->solid ? out : in);
  }
}

thr_status thr_pieces_follow(const thr_pieces *pieces, const thr_part *parts, int n_parts,
                             thr_visit **visits, int *n, thr_err *err)
{
  /* A visit more than passes for each part is enough. */
  int total = 0;
  for (int i = 0; i < n_parts; i++)
    total += parts[i].end - parts[i].first + 1;

  needle_state followed = {.pieces = pieces,
                           .visit = thr_calloc((size_t)total, sizeof *followed.visit),
                           .times = thr_calloc((size_t)pieces->n, sizeof *followed.times),
                           .since = thr_calloc((size_t)pieces->n, sizeof *followed.since),
                           .last = thr_calloc((size_t)pieces->n, sizeof *followed.last)};
  thr_status st =
      followed.visit && followed.times && followed.since && followed.last ? THR_OK : thr_nomem(err);

  for (int i = 0; i < n_parts && !st; i++)
    follow_part(&followed, &parts[i]);
  free(followed.times);
  free(followed.since);
  free(followed.last);

  /* On failure nothing is handed over. */
  if (st) free(followed.visit);
  *visits = st ? NULL : followed.visit;
  *n = st ? 0 : followed.n;
  return st;
}

/* Appends the parts in which a cord is threaded: one, or, if the cord is threaded from its fold,
 * two: from the fold to the end, and from the fold back to the start. Returns how many. */
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

  /* Each unique path, and its copies behind it. */
  for (int path = 0; path < plan->n_cords; path++) {
    if (copy[path].of != path) continue;
    n += add_parts(plan, path, needles, part + n);
    for (int c = 0; c < plan->n_cords; c++)
      if (c != path && copy[c].of == path) n += add_parts(plan, c, needles, part + n);
  }

  return n;
}

/* ---- words ---- */

/* Appends since when the piece is on a cord: ", on cord A since its row 3", ", on the cord since
 * its start". */
static void say_since(const thr_pieces *pieces, const thr_visit *visits, int i, const int *step,
                      thr_text *text)
{
  const thr_visit *visit = &visits[i], *first = &visits[visit->since];

  bool same = visit->cord == first->cord;

  /* Pages with steps: another cord, an earlier step, or a row of this one. */
  if (step && !same)
    thr_text_printf(text, ", on cord %s", pieces->plan->cord[first->cord].id);
  else if (step && step[visit->since] != step[i])
    thr_text_printf(text, ", on since step %d", step[visit->since]);
  else if (step && first->number)
    thr_text_printf(text, ", your row %d", first->number);
  if (step && (!same || step[visit->since] != step[i] || first->number)) return;

  /* Without steps: the cord, and the row or its start. */
  if (same)
    thr_text_append(text, ", on the cord since ");
  else
    thr_text_printf(text, ", on cord %s since its ", pieces->plan->cord[first->cord].id);

  if (first->number)
    thr_text_printf(text, "row %d", first->number);
  else
    thr_text_append(text, same ? "its start" : "start");
}

/* Appends the arms of a visit: "in from A5, out to C5". */
static void say_arms(const thr_pieces *pieces, const char (*label)[THR_LABEL],
                     const thr_visit *visit, thr_text *text)
{
  const thr_frame *frame = pieces->f;

  /* A tube is called by its own ends. */
  if (!pieces->solid) {
    thr_text_printf(text, "in at %s, out at %s", label[thr_tail(frame, visit->in)],
                    label[thr_head(frame, visit->in)]);
    return;
  }

  /* An arm is called by the piece that it faces. */
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

  /* Picked up now, or on a cord already. */
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
