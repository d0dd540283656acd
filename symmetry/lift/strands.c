/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A symmetric cover made concrete: orbits of darts as cosets of their stabilizers, linked over the
 * edges and at the nodes (symmetry/group/quotient.c), and followed from end to end.
 *
 * The copies of a dart type with stabilizer S are the cosets gS; an element maps gS to hgS. A link
 * is an element: which coset of the one orbit the first coset of the other continues into.
 *
 * Example: under C4 with trivial stabilizers an orbit has four darts 1, g, g^2, g^3; linked by g
 * they make one closed cord. */
#include "symmetry/lift/lift.h"
#include "graph/disjoint.h"

#include <stdlib.h>
#include <string.h>

static int product(const thr_quotient *quotient, int a, int b)
{
  return quotient->group->product[(size_t)a * (size_t)quotient->group->order + (size_t)b];
}

static int inverse(const thr_quotient *quotient, int a)
{
  return quotient->group->inverse[a];
}

static int half_image(const thr_quotient *quotient, int place, int h)
{
  return quotient->half_image[(size_t)place * 2 * (size_t)quotient->f->n_edges + (size_t)h];
}

/* Is t a t^-1 = b, for subgroups of one order? */
static bool conjugates(const thr_quotient *quotient, int t, const thr_subgroup *a,
                       const thr_subgroup *b)
{
  for (int i = 0; i < a->order; i++)
    if (!thr_subgroup_has(
            b, product(quotient, product(quotient, t, a->element[i]), inverse(quotient, t))))
      return false;
  return true;
}

/* Lowest element of H that takes half-edge a with stabilizer A to b with B; -1 if none does. */
static int carrier(const thr_quotient *quotient, int a, const thr_subgroup *A, int b,
                   const thr_subgroup *B)
{
  if (A->order != B->order) return -1;
  for (int i = 0; i < quotient->h->order; i++)
    if (half_image(quotient, i, a) == b && conjugates(quotient, quotient->h->element[i], A, B))
      return quotient->h->element[i];
  return -1;
}

/* ---- darts ---- */

static int coset_of(const thr_strands *strands, int type, int x)
{
  return strands->coset[(size_t)strands->row[type] * (size_t)strands->q->h->order +
                        (size_t)strands->place[x]];
}

/* Element of the coset that dart d is. */
static int element_of(const thr_strands *strands, int d)
{
  int o = strands->orbit[d];
  return strands->chosen[(size_t)strands->row[strands->type[o]] * (size_t)strands->q->h->order +
                         (size_t)(d - strands->first[o])];
}

static int dart_of(const thr_strands *strands, int o, int x)
{
  return strands->first[o] + coset_of(strands, strands->type[o], x);
}

int thr_strands_half(const thr_strands *strands, int d)
{
  return half_image(strands->q, strands->place[element_of(strands, d)],
                    strands->q->dart[strands->type[strands->orbit[d]]].half);
}

int thr_strands_across(const thr_strands *strands, int d)
{
  int o = strands->orbit[d];
  return dart_of(strands, strands->other[o],
                 product(strands->q, element_of(strands, d), strands->over[o]));
}

int thr_strands_mate(const thr_strands *strands, int d)
{
  int o = strands->orbit[d];
  return strands->partner[o] < 0
             ? -1
             : dart_of(strands, strands->partner[o],
                       product(strands->q, element_of(strands, d), strands->turn[o]));
}

int thr_strands_image(const thr_strands *strands, int x, int d)
{
  return dart_of(strands, strands->orbit[d], product(strands->q, x, element_of(strands, d)));
}

/* ---- tables ---- */

void thr_strands_destroy(thr_strands *strands)
{
  free(strands->type);
  free(strands->first);
  free(strands->orbit);
  free(strands->other);
  free(strands->over);
  free(strands->partner);
  free(strands->turn);
  free(strands->place);
  free(strands->row);
  free(strands->coset);
  free(strands->chosen);
  *strands = (thr_strands){0};
}

/* Rows of the two tables for the types that copies of the cover have; returns how many. */
static int number_rows(thr_strands *strands, const thr_cover *cover)
{
  const thr_quotient *quotient = strands->q;
  int rows = 0;
  for (int t = 0; t < quotient->n_darts; t++)
    strands->row[t] = -1;
  for (int i = 0; i < quotient->n_copies; i++)
    for (int side = 0; side < 2 && cover->copies[i] > 0; side++) {
      int t = quotient->copy[i].dart[side];
      if (t >= 0 && strands->row[t] < 0) strands->row[t] = rows++;
    }
  return rows;
}

static void list_cosets(thr_strands *strands, int t)
{
  const thr_quotient *quotient = strands->q;
  const thr_subgroup *S = &quotient->dart[t].stabilizer;
  size_t start = (size_t)strands->row[t] * (size_t)quotient->h->order;
  int *coset = strands->coset + start, n = 0;
  for (int i = 0; i < quotient->h->order; i++)
    coset[i] = -1;
  for (int i = 0; i < quotient->h->order; i++) {
    if (coset[i] >= 0) continue;
    for (int k = 0; k < S->order; k++)
      coset[strands->place[product(quotient, quotient->h->element[i], S->element[k])]] = n;
    strands->chosen[start + (size_t)n++] = quotient->h->element[i];
  }
}

static thr_status make_tables(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  strands->place = thr_calloc((size_t)quotient->group->order, sizeof *strands->place);
  strands->row = thr_calloc((size_t)quotient->n_darts, sizeof *strands->row);
  if (!strands->place || !strands->row) return thr_nomem(err);
  for (int x = 0; x < quotient->group->order; x++)
    strands->place[x] = -1;
  for (int i = 0; i < quotient->h->order; i++)
    strands->place[quotient->h->element[i]] = i;
  size_t room = (size_t)number_rows(strands, cover) * (size_t)quotient->h->order;
  strands->coset = thr_calloc(room, sizeof *strands->coset);
  strands->chosen = thr_calloc(room, sizeof *strands->chosen);
  if (!strands->coset || !strands->chosen) return thr_nomem(err);
  for (int t = 0; t < quotient->n_darts; t++)
    if (strands->row[t] >= 0) list_cosets(strands, t);
  return THR_OK;
}

/* ---- orbits of darts, linked over the edges ---- */

/* The lowest element of a fold's K that turns its edge round. */
static int turner(const thr_strands *strands, const thr_copy_type *type)
{
  int i = 0;
  while (i + 1 < type->stabilizer.order &&
         half_image(strands->q, strands->place[type->stabilizer.element[i]], 2 * type->edge) ==
             2 * type->edge)
    i++;
  return type->stabilizer.element[i];
}

/* Lowest element of H that takes the copy's end at half-edge 2 e to the representative of its type.
 * Of a fold, whose K turns the half-edge round, S goes into K. */
static int fold_carrier(const thr_quotient *quotient, const thr_copy_type *type)
{
  const thr_dart_type *dart_type = &quotient->dart[type->dart[0]];
  for (int i = 0; i < quotient->h->order; i++) {
    int x = quotient->h->element[i];
    bool fits = half_image(quotient, i, 2 * type->edge) == dart_type->half;
    for (int k = 0; k < dart_type->stabilizer.order && fits; k++)
      fits = thr_subgroup_has(
          &type->stabilizer,
          product(quotient,
                  product(quotient, inverse(quotient, x), dart_type->stabilizer.element[k]), x));
    if (fits) return x;
  }
  return -1;
}

/* Elements over of the two dart orbits of a copy type. The dart at end i of the copy K is the coset
 * of t[i]^-1, where t[i] takes it to its type's representative. */
static thr_status link_copy(const thr_strands *strands, const thr_copy_type *type, int over[2],
                            thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  int t[2], back;
  for (int i = 0; i < 2; i++) {
    const thr_dart_type *dart_type = &quotient->dart[type->dart[type->fold ? 0 : i]];
    t[i] = type->fold ? fold_carrier(quotient, type)
                      : carrier(quotient, 2 * type->edge + i, &type->stabilizer, dart_type->half,
                                &dart_type->stabilizer);
    if (t[i] < 0)
      return thr_fail(err, THR_ESOLVER, "edge %d: its darts are not of their types", type->edge);
  }
  back = inverse(quotient, t[1]);
  if (type->fold) back = product(quotient, turner(strands, type), back);
  over[0] = product(quotient, t[0], back);
  over[1] = inverse(quotient, over[0]);
  return THR_OK;
}

static thr_status orbits_init(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  for (int i = 0; i < quotient->n_copies; i++)
    strands->n_orbits += cover->copies[i] * (quotient->copy[i].fold ? 1 : 2);
  size_t n = (size_t)strands->n_orbits;
  strands->type = thr_calloc(n, sizeof *strands->type);
  strands->first = thr_calloc(n + 1, sizeof *strands->first);
  strands->other = thr_calloc(n, sizeof *strands->other);
  strands->over = thr_calloc(n, sizeof *strands->over);
  strands->partner = thr_calloc(n, sizeof *strands->partner);
  strands->turn = thr_calloc(n, sizeof *strands->turn);
  return strands->type && strands->first && strands->other && strands->over && strands->partner &&
                 strands->turn
             ? THR_OK
             : thr_nomem(err);
}

static thr_status make_orbits(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  thr_status st = orbits_init(strands, cover, err);
  for (int i = 0, o = 0; i < quotient->n_copies && !st; i++) {
    int sides = quotient->copy[i].fold ? 1 : 2, over[2] = {0};
    if (cover->copies[i] > 0) st = link_copy(strands, &quotient->copy[i], over, err);
    for (int k = 0; k < cover->copies[i] && !st; k++, o += sides)
      for (int side = 0; side < sides; side++) {
        strands->type[o + side] = quotient->copy[i].dart[side];
        strands->other[o + side] = o + sides - 1 - side;
        strands->over[o + side] = over[side];
      }
  }
  for (int o = 0; o < strands->n_orbits && !st; o++)
    strands->first[o + 1] = strands->first[o] + quotient->dart[strands->type[o]].darts;
  if (st) return st;
  strands->n_darts = strands->first[strands->n_orbits];
  if (!(strands->orbit = thr_calloc((size_t)strands->n_darts, sizeof *strands->orbit)))
    return thr_nomem(err);
  for (int o = 0; o < strands->n_orbits; o++)
    for (int d = strands->first[o]; d < strands->first[o + 1]; d++)
      strands->orbit[d] = o;
  return THR_OK;
}

/* ---- orbits paired at the nodes ---- */

/* Orbits of each type as a list: of those that are not paired yet, or of all. */
typedef struct {
  int *head, *next; /* [q->n_darts], [n_orbits]; -1 ends a list */
} type_lists;

static void type_lists_destroy(type_lists *l)
{
  free(l->head);
  free(l->next);
}

static thr_status type_lists_init(type_lists *l, const thr_strands *strands, thr_err *err)
{
  l->head = thr_calloc((size_t)strands->q->n_darts, sizeof *l->head);
  l->next = thr_calloc((size_t)strands->n_orbits, sizeof *l->next);
  if (!l->head || !l->next) return thr_nomem(err);
  for (int t = 0; t < strands->q->n_darts; t++)
    l->head[t] = -1;
  for (int o = strands->n_orbits - 1; o >= 0; o--) {
    l->next[o] = l->head[strands->type[o]];
    l->head[strands->type[o]] = o;
  }
  return THR_OK;
}

static int take(type_lists *l, int type)
{
  int o = l->head[type];
  if (o >= 0) l->head[type] = l->next[o];
  return o;
}

/* Element turn of a pair type: takes the dart type's representative to its partner. */
static int pair_element(const thr_quotient *quotient, const thr_pair_type *type)
{
  if (type->self) return type->element;
  const thr_dart_type *a = &quotient->dart[type->dart[0]], *b = &quotient->dart[type->dart[1]];
  return carrier(quotient, b->half, &b->stabilizer, type->half[1], &a->stabilizer);
}

static thr_status pair_orbits(thr_strands *strands, type_lists *unpaired, const thr_pair_type *type,
                              int count, thr_err *err)
{
  int turn = count > 0 ? pair_element(strands->q, type) : 0;
  for (int k = 0; k < count; k++) {
    int a = take(unpaired, type->dart[0]), b = type->self ? a : take(unpaired, type->dart[1]);
    if (turn < 0 || a < 0 || b < 0)
      return thr_fail(err, THR_ESOLVER, "a turn of the cover joins no two of its passes");
    strands->partner[a] = b;
    strands->turn[a] = turn;
    strands->partner[b] = a;
    if (b != a) strands->turn[b] = inverse(strands->q, turn);
  }
  return THR_OK;
}

static thr_status make_pairs(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  type_lists unpaired = {0};
  thr_status st = type_lists_init(&unpaired, strands, err);
  for (int i = 0; i < quotient->n_pairs && !st; i++)
    st = pair_orbits(strands, &unpaired, &quotient->pair[i], cover->pairs[i], err);
  for (int t = 0; t < quotient->n_darts && !st; t++) {
    int ends = 0;
    for (int o = take(&unpaired, t); o >= 0; o = take(&unpaired, t), ends++)
      strands->partner[o] = -1;
    if (ends != cover->ends[t])
      st = thr_fail(err, THR_ESOLVER, "a cover with %d cord ends of a kind instead of %d", ends,
                    cover->ends[t]);
  }
  type_lists_destroy(&unpaired);
  return st;
}

/* ---- trails of the quotient ---- */

/* Trails as sets of orbits (union-find), with how many of their two terminals are cord ends and how
 * many folds. */
typedef struct {
  int *parent, *ends, *folds; /* [n_orbits] the counts at roots */
} trails;

static int root(const trails *t, int o)
{
  return thr_disjoint_find(t->parent, o);
}

/* The counts of both stay with the root. */
static void join(trails *t, int a, int b)
{
  int ra = root(t, a), rb = root(t, b), ends = t->ends[ra] + t->ends[rb],
      folds = t->folds[ra] + t->folds[rb];
  if (!thr_disjoint_join(t->parent, ra, rb)) return;
  t->ends[root(t, ra)] = ends;
  t->folds[root(t, ra)] = folds;
}

static void find_trails(const thr_strands *strands, trails *t)
{
  for (int o = 0; o < strands->n_orbits; o++) {
    t->parent[o] = o;
    t->ends[o] = strands->partner[o] < 0;
    t->folds[o] = (strands->partner[o] == o) + (strands->other[o] == o);
  }
  for (int o = 0; o < strands->n_orbits; o++) {
    join(t, o, strands->other[o]);
    if (strands->partner[o] >= 0) join(t, o, strands->partner[o]);
  }
}

static bool is_circle(const trails *t, int at_root)
{
  return t->ends[at_root] + t->folds[at_root] == 0;
}

void thr_strands_exchange(thr_strands *strands, int a, int b)
{
  int pa = strands->partner[a], pb = strands->partner[b], turn = strands->turn[a];
  strands->turn[a] = strands->turn[b];
  strands->turn[b] = turn;
  if (pa == b) return; /* with each other */
  strands->partner[a] = pb == b ? a : pb;
  strands->partner[b] = pa == a ? b : pa;
  if (pa >= 0 && pa != a) strands->partner[pa] = b;
  if (pb >= 0 && pb != b) strands->partner[pb] = a;
}

/* Joins circles to whatever trail shares a type with them. */
static void join_circles(thr_strands *strands, trails *t, const type_lists *all)
{
  for (int type = 0; type < strands->q->n_darts; type++) {
    int a = all->head[type];
    for (int b = a < 0 ? -1 : all->next[a]; b >= 0; b = all->next[b]) {
      int ra = root(t, a), rb = root(t, b);
      if (ra == rb || (!is_circle(t, ra) && !is_circle(t, rb))) continue;
      thr_strands_exchange(strands, a, b);
      join(t, ra, rb);
    }
  }
}

static thr_status all_have_ends(const thr_strands *strands, const trails *t, thr_err *err)
{
  for (int o = 0; o < strands->n_orbits; o++)
    if (t->ends[root(t, o)] == 0) {
      int e = strands->q->dart[strands->type[o]].half >> 1;
      return thr_fail(
          err, THR_ESOLVER,
          "the cords over edge %d and its images would be closed, where ends are asked for", e);
    }
  return THR_OK;
}

/* Passes from a dart of a closed cord round to it again. */
static int walk_length(const thr_strands *strands, int start)
{
  int n = 0, d = start;
  do {
    d = thr_strands_mate(strands, thr_strands_across(strands, d));
    n++;
  } while (d >= 0 && d != start);
  return n;
}

/* Could orbit o be paired by this element instead, at the same two half-edges? A fold must stay
 * one. */
static bool may_turn(const thr_strands *strands, int o, int turn)
{
  const thr_quotient *quotient = strands->q;
  const thr_dart_type *a = &quotient->dart[strands->type[o]],
                      *b = &quotient->dart[strands->type[strands->partner[o]]];
  if (half_image(quotient, strands->place[turn], b->half) !=
      half_image(quotient, strands->place[strands->turn[o]], b->half))
    return false;
  if (!conjugates(quotient, turn, &b->stabilizer, &a->stabilizer)) return false;
  return strands->partner[o] != o ||
         (!thr_subgroup_has(&a->stabilizer, turn) &&
          thr_subgroup_has(&a->stabilizer, product(quotient, turn, turn)));
}

static void set_turn(thr_strands *strands, int o, int turn)
{
  strands->turn[o] = turn;
  if (strands->partner[o] != o) strands->turn[strands->partner[o]] = inverse(strands->q, turn);
}

/* Of the partners that orbit o has in the other orbit at the same half-edge, takes the one with the
 * longest cord; least > 0: with the shortest of so many passes or more. */
static void turn_best(thr_strands *strands, int o, int start, int least, int *best)
{
  const thr_quotient *quotient = strands->q;
  int type = strands->type[strands->partner[o]], kept = strands->turn[o];
  size_t row = (size_t)strands->row[type] * (size_t)quotient->h->order;
  for (int k = 0; k < quotient->dart[type].darts; k++) {
    int turn = strands->chosen[row + (size_t)k];
    if (coset_of(strands, type, turn) == coset_of(strands, type, kept) ||
        !may_turn(strands, o, turn))
      continue;
    set_turn(strands, o, turn);
    int length = walk_length(strands, strands->first[start]);
    if (least > 0 ? length >= least && length < *best : length > *best) {
      *best = length;
      kept = turn;
    } else
      set_turn(strands, o, kept);
  }
}

/* The lengths of closed cords depend on where the walk round the quotient's trail comes back. */
static void turn_trail(thr_strands *strands, const trails *t, int start, int least)
{
  int best = walk_length(strands, strands->first[start]);
  for (int o = start; o < strands->n_orbits; o++)
    if (root(t, o) == start && strands->partner[o] <= o) turn_best(strands, o, start, least, &best);
}

static void lengthen_cords(thr_strands *strands, const trails *t)
{
  for (int start = 0; start < strands->n_orbits; start++)
    if (root(t, start) == start && !t->ends[start]) turn_trail(strands, t, start, 0);
}

/* ---- as many closed cords as may be ---- */

/* Darts of orbit o that are in this component. */
static int darts_within(const thr_strands *strands, int o, const int *component, int within)
{
  int n = 0;
  for (int d = strands->first[o]; d < strands->first[o + 1]; d++)
    n += component[thr_tail(strands->q->f, thr_strands_half(strands, d))] == within;
  return n;
}

/* Passes, or the ends of open cords, that the trail from orbit start has in this component. */
static int passes_within(const thr_strands *strands, const trails *t, int start,
                         const int *component, int within, int *ends)
{
  int darts = 0;
  *ends = 0;
  for (int o = start; o < strands->n_orbits; o++) {
    if (root(t, o) != start) continue;
    int n = darts_within(strands, o, component, within);
    darts += n;
    if (strands->partner[o] < 0) *ends += n;
  }
  return darts / 2;
}

/* Makes the cords of every trail without ends as many as can be, with all others at most so many in
 * a component. */
static void shorten_cords(thr_strands *strands, const trails *t, const int *component, int most)
{
  for (int start = 0; start < strands->n_orbits; start++) {
    if (root(t, start) != start || t->ends[start]) continue;
    int own = 0, ends, others = 0,
        within =
            component[thr_tail(strands->q->f, thr_strands_half(strands, strands->first[start]))];
    for (int o = 0; o < strands->n_orbits; o++) {
      if (root(t, o) != o) continue;
      int passes = passes_within(strands, t, o, component, within, &ends);
      if (o == start)
        own = passes;
      else if (passes > 0)
        others += t->ends[o] ? ends / 2 : passes / walk_length(strands, strands->first[o]);
    }
    if (most > others) turn_trail(strands, t, start, (own + most - others - 1) / (most - others));
  }
}

static thr_status arrange(thr_strands *strands, bool all_open, const int *component, int most,
                          thr_err *err)
{
  size_t n = (size_t)strands->n_orbits;
  trails t = {0};
  type_lists all = {0};
  thr_status st = type_lists_init(&all, strands, err);
  t.parent = thr_calloc(n, sizeof *t.parent);
  t.ends = thr_calloc(n, sizeof *t.ends);
  t.folds = thr_calloc(n, sizeof *t.folds);
  if (!st && (!t.parent || !t.ends || !t.folds)) st = thr_nomem(err);
  if (!st && all_open) st = thr_strands_open(strands, err);
  if (!st) {
    find_trails(strands, &t);
    if (most == 0 || all_open) join_circles(strands, &t, &all);
    if (all_open) st = all_have_ends(strands, &t, err);
    if (!st) lengthen_cords(strands, &t);
    if (!st && most > 0) shorten_cords(strands, &t, component, most);
  }
  type_lists_destroy(&all);
  free(t.parent);
  free(t.ends);
  free(t.folds);
  return st;
}

thr_status thr_strands_init(thr_strands *strands, const thr_quotient *quotient,
                            const thr_cover *cover, bool all_open, const int *component, int most,
                            thr_err *err)
{
  *strands = (thr_strands){.q = quotient};
  thr_status st = make_tables(strands, cover, err);
  if (!st) st = make_orbits(strands, cover, err);
  if (!st) st = make_pairs(strands, cover, err);
  if (!st) st = arrange(strands, all_open, component, most, err);
  if (st) thr_strands_destroy(strands);
  return st;
}
