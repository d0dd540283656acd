/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a symmetric cover concrete: orbits of darts as cosets of their stabilizers, linked over the
 * edges and at the nodes (symmetry/group/quotient.c), so that cords can be followed from end to
 * end.
 *
 * The darts of an orbit whose type has stabilizer S are the cosets gS; an element h maps gS to hgS.
 * A link between two orbits is an element: which coset of the one orbit the first coset of the
 * other continues into. Orbits of one type may exchange their partners at no price. Exchanges join
 * circles of the quotient to other trails, and part trails between two folds
 * (symmetry/cover/opening.c); the choice among several links decides how long closed cords are.
 *
 * Example: under C4 with trivial stabilizers an orbit has four darts 1, g, g^2, g^3; linked by g
 * they make one closed cord, linked by 1 four. */
#include "symmetry/lift/lift.h"
#include "graph/arrays.h"

#include <stdlib.h>

/* Returns a after b. */
static int product(const thr_quotient *quotient, int a, int b)
{
  return thr_group_product(quotient->group, a, b);
}

static int inverse(const thr_quotient *quotient, int a)
{
  return quotient->group->inverse[a];
}

/* Tells whether transport a transport^-1 = b, for subgroups a and b of one order. */
static bool conjugates(const thr_quotient *quotient, int transport, const thr_subgroup *a,
                       const thr_subgroup *b)
{
  for (int i = 0; i < a->order; i++)
    if (!thr_subgroup_has(b, product(quotient, product(quotient, transport, a->element[i]),
                                     inverse(quotient, transport))))
      return false;
  return true;
}

/* Returns the lowest element of H that takes half-edge `from` with its stabilizer to half-edge `to`
 * with its; -1 if none does. */
static int carrier(const thr_quotient *quotient, int from, const thr_subgroup *from_stabilizer,
                   int to, const thr_subgroup *to_stabilizer)
{
  if (from_stabilizer->order != to_stabilizer->order) return -1;
  for (int i = 0; i < quotient->h->order; i++)
    if (thr_quotient_image(quotient, i, from) == to &&
        conjugates(quotient, quotient->h->element[i], from_stabilizer, to_stabilizer))
      return quotient->h->element[i];
  return -1;
}

/* ---- darts ---- */

/* Returns the number of the coset of a dart type that an element belongs to. */
static int coset_of(const thr_strands *strands, int type, int element)
{
  return strands->coset[(size_t)strands->row[type] * (size_t)strands->q->h->order +
                        (size_t)strands->place[element]];
}

/* Returns the element that was chosen for the coset that a dart is. */
static int element_of(const thr_strands *strands, int dart)
{
  int orbit = strands->orbit[dart];
  return strands->chosen[(size_t)strands->row[strands->type[orbit]] * (size_t)strands->q->h->order +
                         (size_t)(dart - strands->first[orbit])];
}

/* Returns the dart of an orbit that the coset of an element is. */
static int dart_of(const thr_strands *strands, int orbit, int element)
{
  return strands->first[orbit] + coset_of(strands, strands->type[orbit], element);
}

int thr_strands_half(const thr_strands *strands, int dart)
{
  return thr_quotient_image(strands->q, strands->place[element_of(strands, dart)],
                            strands->q->dart[strands->type[strands->orbit[dart]]].half);
}

int thr_strands_across(const thr_strands *strands, int dart)
{
  int orbit = strands->orbit[dart];
  return dart_of(strands, strands->other[orbit],
                 product(strands->q, element_of(strands, dart), strands->over[orbit]));
}

int thr_strands_mate(const thr_strands *strands, int dart)
{
  int orbit = strands->orbit[dart];
  return strands->partner[orbit] < 0
             ? -1
             : dart_of(strands, strands->partner[orbit],
                       product(strands->q, element_of(strands, dart), strands->turn[orbit]));
}

int thr_strands_image(const thr_strands *strands, int element, int dart)
{
  return dart_of(strands, strands->orbit[dart],
                 product(strands->q, element, element_of(strands, dart)));
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

/* Numbers the rows of the two tables, one for each dart type of the cover's copies; returns how
 * many. */
static int number_rows(thr_strands *strands, const thr_cover *cover)
{
  const thr_quotient *quotient = strands->q;
  int rows = 0;

  /* Types that occur, in the order of the copies. */
  for (int type = 0; type < quotient->n_darts; type++)
    strands->row[type] = -1;
  for (int i = 0; i < quotient->n_copies; i++)
    for (int side = 0; side < 2 && cover->copies[i] > 0; side++) {
      int type = quotient->copy[i].dart[side];
      if (type >= 0 && strands->row[type] < 0) strands->row[type] = rows++;
    }
  return rows;
}

/* Lists the cosets of a dart type's stabilizer in H, by their lowest elements. */
static void list_cosets(thr_strands *strands, int type)
{
  const thr_quotient *quotient = strands->q;
  const thr_subgroup *stabilizer = &quotient->dart[type].stabilizer;
  size_t start = (size_t)strands->row[type] * (size_t)quotient->h->order;
  int *coset = strands->coset + start, coset_number = 0;

  /* No element is in a coset yet. */
  for (int i = 0; i < quotient->h->order; i++)
    coset[i] = -1;

  /* The first element that is in no coset yet makes a new one. */
  for (int i = 0; i < quotient->h->order; i++) {
    if (coset[i] >= 0) continue;
    for (int k = 0; k < stabilizer->order; k++)
      coset[strands->place[product(quotient, quotient->h->element[i], stabilizer->element[k])]] =
          coset_number;
    strands->chosen[start + (size_t)coset_number++] = quotient->h->element[i];
  }
}

/* Makes the tables of places and cosets. */
static thr_status make_tables(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  strands->place = thr_calloc((size_t)quotient->group->order, sizeof *strands->place);
  strands->row = thr_calloc((size_t)quotient->n_darts, sizeof *strands->row);
  if (!strands->place || !strands->row) return thr_nomem(err);

  /* Places of the elements of H. */
  for (int element = 0; element < quotient->group->order; element++)
    strands->place[element] = -1;
  for (int i = 0; i < quotient->h->order; i++)
    strands->place[quotient->h->element[i]] = i;

  /* A row of cosets for every dart type in use. */
  size_t entries = (size_t)number_rows(strands, cover) * (size_t)quotient->h->order;
  strands->coset = thr_calloc(entries, sizeof *strands->coset);
  strands->chosen = thr_calloc(entries, sizeof *strands->chosen);
  if (!strands->coset || !strands->chosen) return thr_nomem(err);

  for (int type = 0; type < quotient->n_darts; type++)
    if (strands->row[type] >= 0) list_cosets(strands, type);
  return THR_OK;
}

/* ---- orbits of darts, linked over the edges ---- */

/* Returns the lowest element of a fold's stabilizer that turns its edge round. */
static int turner(const thr_strands *strands, const thr_copy_type *type)
{
  int i = 0;
  while (i + 1 < type->stabilizer.order &&
         thr_quotient_image(strands->q, strands->place[type->stabilizer.element[i]],
                            2 * type->edge) == 2 * type->edge)
    i++;
  return type->stabilizer.element[i];
}

/* Returns the lowest element of H that takes the copy's end at half-edge 2 e to the representative
 * of its type, or -1. The stabilizer of a fold also turns the half-edge round: it has that of its
 * dart among its elements. */
static int fold_carrier(const thr_quotient *quotient, const thr_copy_type *type)
{
  const thr_dart_type *dart_type = &quotient->dart[type->dart[0]];
  for (int i = 0; i < quotient->h->order; i++) {
    /* The half-edge fits, and every element of the dart's stabilizer, seen from the edge, is in the
     * copy's. */
    int element = quotient->h->element[i];
    bool fits = thr_quotient_image(quotient, i, 2 * type->edge) == dart_type->half;
    for (int k = 0; k < dart_type->stabilizer.order && fits; k++)
      fits = thr_subgroup_has(
          &type->stabilizer,
          product(quotient,
                  product(quotient, inverse(quotient, element), dart_type->stabilizer.element[k]),
                  element));

    if (fits) return element;
  }
  return -1;
}

/* Computes over[] of the two dart orbits of a copy type. The dart at end i of the copy is the coset
 * of to_type[i]^-1, where to_type[i] takes it to the representative of its type. */
static thr_status link_copy(const thr_strands *strands, const thr_copy_type *type, int over[2],
                            thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  int to_type[2], back;
  /* The elements that take both ends to their types. */
  for (int i = 0; i < 2; i++) {
    const thr_dart_type *dart_type = &quotient->dart[type->dart[type->fold ? 0 : i]];
    to_type[i] = type->fold ? fold_carrier(quotient, type)
                            : carrier(quotient, 2 * type->edge + i, &type->stabilizer,
                                      dart_type->half, &dart_type->stabilizer);
    if (to_type[i] < 0)
      return thr_fail(err, THR_ESOLVER, "edge %d: its darts are not of their types", type->edge);
  }

  /* From one end to the other; of a fold to the image of the only end. */
  back = inverse(quotient, to_type[1]);
  if (type->fold) back = product(quotient, turner(strands, type), back);
  over[0] = product(quotient, to_type[0], back);
  over[1] = inverse(quotient, over[0]);
  return THR_OK;
}

/* Allocates the orbits of all copies. */
static thr_status orbits_init(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  /* A fold has one orbit of darts, any other copy two. */
  for (int i = 0; i < quotient->n_copies; i++)
    strands->n_orbits += cover->copies[i] * (quotient->copy[i].fold ? 1 : 2);

  size_t n_orbits = (size_t)strands->n_orbits;
  strands->type = thr_calloc(n_orbits, sizeof *strands->type);
  strands->first = thr_calloc(n_orbits + 1, sizeof *strands->first);
  strands->other = thr_calloc(n_orbits, sizeof *strands->other);
  strands->over = thr_calloc(n_orbits, sizeof *strands->over);
  strands->partner = thr_calloc(n_orbits, sizeof *strands->partner);
  strands->turn = thr_calloc(n_orbits, sizeof *strands->turn);

  return strands->type && strands->first && strands->other && strands->over && strands->partner &&
                 strands->turn
             ? THR_OK
             : thr_nomem(err);
}

/* Makes the orbits of darts, linked over the edges: one for a fold, two for any other orbit of
 * copies. */
static thr_status make_orbits(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  thr_status st = orbits_init(strands, cover, err);

  /* Orbits of the copies, and their links. */
  for (int i = 0, orbit = 0; i < quotient->n_copies && !st; i++) {
    int sides = quotient->copy[i].fold ? 1 : 2, over[2] = {0};
    if (cover->copies[i] > 0) st = link_copy(strands, &quotient->copy[i], over, err);
    for (int k = 0; k < cover->copies[i] && !st; k++, orbit += sides)
      for (int side = 0; side < sides; side++) {
        strands->type[orbit + side] = quotient->copy[i].dart[side];
        strands->other[orbit + side] = orbit + sides - 1 - side;
        strands->over[orbit + side] = over[side];
      }
  }

  /* Darts of each orbit. */
  for (int orbit = 0; orbit < strands->n_orbits && !st; orbit++)
    strands->first[orbit + 1] = strands->first[orbit] + quotient->dart[strands->type[orbit]].darts;

  if (st) return st;
  strands->n_darts = strands->first[strands->n_orbits];
  if (!(strands->orbit = thr_calloc((size_t)strands->n_darts, sizeof *strands->orbit)))
    return thr_nomem(err);

  for (int orbit = 0; orbit < strands->n_orbits; orbit++)
    for (int d = strands->first[orbit]; d < strands->first[orbit + 1]; d++)
      strands->orbit[d] = orbit;
  return THR_OK;
}

/* ---- orbits linked at the nodes ---- */

/* Orbits of each type as a list: of the ones that are not paired yet, or of all. */
typedef struct {
  int *head, *next; /* [q->n_darts], [n_orbits]; -1 ends a list */
} orbit_lists;

static void type_lists_destroy(orbit_lists *lists)
{
  free(lists->head);
  free(lists->next);
}

/* Lists all orbits by type, in ascending order. */
static thr_status type_lists_init(orbit_lists *lists, const thr_strands *strands, thr_err *err)
{
  lists->head = thr_calloc((size_t)strands->q->n_darts, sizeof *lists->head);
  lists->next = thr_calloc((size_t)strands->n_orbits, sizeof *lists->next);
  if (!lists->head || !lists->next) return thr_nomem(err);

  /* From the last orbit on, so that the lists ascend. */
  for (int type = 0; type < strands->q->n_darts; type++)
    lists->head[type] = -1;
  for (int orbit = strands->n_orbits - 1; orbit >= 0; orbit--) {
    lists->next[orbit] = lists->head[strands->type[orbit]];
    lists->head[strands->type[orbit]] = orbit;
  }
  return THR_OK;
}

/* Takes the first orbit of a type from its list; -1 if there is none. */
static int take_orbit(orbit_lists *lists, int type)
{
  int orbit = lists->head[type];
  if (orbit >= 0) lists->head[type] = lists->next[orbit];
  return orbit;
}

/* Returns the element of a turn: it takes the dart type's representative to its partner. */
static int pair_element(const thr_quotient *quotient, const thr_pair_type *type)
{
  if (type->self) return type->element;
  const thr_dart_type *a = &quotient->dart[type->dart[0]], *b = &quotient->dart[type->dart[1]];
  return carrier(quotient, b->half, &b->stabilizer, type->half[1], &a->stabilizer);
}

/* Links so many pairs of orbits by turns of this pair type. THR_ESOLVER: there are too few orbits.
 */
static thr_status pair_orbits(thr_strands *strands, orbit_lists *unpaired,
                              const thr_pair_type *type, int count, thr_err *err)
{
  int turn = count > 0 ? pair_element(strands->q, type) : 0;

  /* The first orbits that are left. */
  for (int k = 0; k < count; k++) {
    int first = take_orbit(unpaired, type->dart[0]),
        second = type->self ? first : take_orbit(unpaired, type->dart[1]);
    if (turn < 0 || first < 0 || second < 0)
      return thr_fail(err, THR_ESOLVER, "a turn of the cover joins no two of its passes");

    strands->partner[first] = second;
    strands->turn[first] = turn;
    strands->partner[second] = first;
    if (second != first) strands->turn[second] = inverse(strands->q, turn);
  }
  return THR_OK;
}

/* Links the orbits of all types as the cover has turns; the rest ends. THR_ESOLVER: counts do not
 * balance. */
static thr_status make_pairs(thr_strands *strands, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = strands->q;
  orbit_lists unpaired = {0};
  thr_status st = type_lists_init(&unpaired, strands, err);

  /* Turns. */
  for (int i = 0; i < quotient->n_pairs && !st; i++)
    st = pair_orbits(strands, &unpaired, &quotient->pair[i], cover->pairs[i], err);

  /* Cord ends: as many as the cover says. */
  for (int type = 0; type < quotient->n_darts && !st; type++) {
    int ends = 0;
    for (int orbit = take_orbit(&unpaired, type); orbit >= 0;
         orbit = take_orbit(&unpaired, type), ends++)
      strands->partner[orbit] = -1;

    if (ends != cover->ends[type])
      st = thr_fail(err, THR_ESOLVER, "a cover with %d cord ends of a kind instead of %d", ends,
                    cover->ends[type]);
  }

  type_lists_destroy(&unpaired);
  return st;
}

/* ---- trails of the quotient ---- */

/* Trails of the quotient as sets of orbits (union-find), with how many of their two terminals are
 * cord ends and how many are folds. */
typedef struct {
  int *parent, *ends, *folds; /* [n_orbits] the counts at roots */
} trail_sets;

static int root(const trail_sets *trails, int orbit)
{
  return thr_disjoint_find(trails->parent, orbit);
}

/* Joins the sets of two orbits. The counts of both stay with the root. */
static void join(trail_sets *trails, int a, int b)
{
  int ra = root(trails, a), rb = root(trails, b), ends = trails->ends[ra] + trails->ends[rb],
      folds = trails->folds[ra] + trails->folds[rb];
  if (!thr_disjoint_join(trails->parent, ra, rb)) return;
  trails->ends[root(trails, ra)] = ends;
  trails->folds[root(trails, ra)] = folds;
}

/* Finds the trails: orbits that are linked over an edge or at a node. */
static void find_trails(const thr_strands *strands, trail_sets *trails)
{
  /* Every orbit for itself, with its terminals. */
  for (int orbit = 0; orbit < strands->n_orbits; orbit++) {
    trails->parent[orbit] = orbit;
    trails->ends[orbit] = strands->partner[orbit] < 0;
    trails->folds[orbit] = (strands->partner[orbit] == orbit) + (strands->other[orbit] == orbit);
  }

  /* Joined over the edge, and at the node. */
  for (int orbit = 0; orbit < strands->n_orbits; orbit++) {
    join(trails, orbit, strands->other[orbit]);
    if (strands->partner[orbit] >= 0) join(trails, orbit, strands->partner[orbit]);
  }
}

/* Tells whether a trail has no terminal. */
static bool is_circle(const trail_sets *trails, int at_root)
{
  return trails->ends[at_root] + trails->folds[at_root] == 0;
}

void thr_strands_exchange(thr_strands *strands, int a, int b)
{
  int pa = strands->partner[a], pb = strands->partner[b], turn = strands->turn[a];
  strands->turn[a] = strands->turn[b];
  strands->turn[b] = turn;

  if (pa == b) return; /* they are paired with each other */

  /* A fold at the node stays one, of the other orbit. */
  strands->partner[a] = pb == b ? a : pb;
  strands->partner[b] = pa == a ? b : pa;
  if (pa >= 0 && pa != a) strands->partner[pa] = b;
  if (pb >= 0 && pb != b) strands->partner[pb] = a;
}

/* Joins circles to any trail that shares a dart type with them, by exchanges of two orbits. */
static void join_circles(thr_strands *strands, trail_sets *trails, const orbit_lists *all)
{
  for (int type = 0; type < strands->q->n_darts; type++) {
    /* All orbits of a type against its first. */
    int a = all->head[type];
    for (int b = a < 0 ? -1 : all->next[a]; b >= 0; b = all->next[b]) {
      int ra = root(trails, a), rb = root(trails, b);
      if (ra == rb || (!is_circle(trails, ra) && !is_circle(trails, rb))) continue;

      thr_strands_exchange(strands, a, b);
      join(trails, ra, rb);
    }
  }
}

/* Fails with THR_ESOLVER if a trail has no cord end. */
static thr_status all_have_ends(const thr_strands *strands, const trail_sets *trails, thr_err *err)
{
  for (int orbit = 0; orbit < strands->n_orbits; orbit++)
    if (trails->ends[root(trails, orbit)] == 0) {
      int e = strands->q->dart[strands->type[orbit]].half >> 1;
      return thr_fail(
          err, THR_ESOLVER,
          "the cords over edge %d and its images would be closed, where ends are asked for", e);
    }
  return THR_OK;
}

/* Counts the passes of a cord from this dart on, until it ends or is back. */
static int walk_length(const thr_strands *strands, int start)
{
  int passes = 0, d = start;
  do {
    d = thr_strands_mate(strands, thr_strands_across(strands, d));
    passes++;
  } while (d >= 0 && d != start);
  return passes;
}

/* Tells whether an orbit can be linked to its partner by this element instead, at the same two
 * half-edges; a fold must stay one. */
static bool may_turn(const thr_strands *strands, int orbit, int turn)
{
  const thr_quotient *quotient = strands->q;
  const thr_dart_type *a = &quotient->dart[strands->type[orbit]],
                      *b = &quotient->dart[strands->type[strands->partner[orbit]]];

  /* The same half-edge of the partner. */
  if (thr_quotient_image(quotient, strands->place[turn], b->half) !=
      thr_quotient_image(quotient, strands->place[strands->turn[orbit]], b->half))
    return false;

  /* Stabilizers must fit, and a fold must be of order two. */
  if (!conjugates(quotient, turn, &b->stabilizer, &a->stabilizer)) return false;
  return strands->partner[orbit] != orbit ||
         (!thr_subgroup_has(&a->stabilizer, turn) &&
          thr_subgroup_has(&a->stabilizer, product(quotient, turn, turn)));
}

/* Links an orbit to its partner by this element. */
static void set_turn(thr_strands *strands, int orbit, int turn)
{
  strands->turn[orbit] = turn;
  if (strands->partner[orbit] != orbit)
    strands->turn[strands->partner[orbit]] = inverse(strands->q, turn);
}

/* Relinks an orbit at its node so that the cord from orbit start becomes the longest (least = 0),
 * or the shortest of at least `least` passes. *best: its passes. */
static void turn_best(thr_strands *strands, int orbit, int start, int least, int *best)
{
  const thr_quotient *quotient = strands->q;
  int type = strands->type[strands->partner[orbit]], kept = strands->turn[orbit];
  size_t row = (size_t)strands->row[type] * (size_t)quotient->h->order;

  /* Every coset of the partner's stabilizer is another image of the partner. */
  for (int k = 0; k < quotient->dart[type].darts; k++) {
    int turn = strands->chosen[row + (size_t)k];
    if (coset_of(strands, type, turn) == coset_of(strands, type, kept) ||
        !may_turn(strands, orbit, turn))
      continue;

    /* Try, and keep what is better. */
    set_turn(strands, orbit, turn);
    int length = walk_length(strands, strands->first[start]);
    if (least > 0 ? length >= least && length < *best : length > *best) {
      *best = length;
      kept = turn;
    } else
      set_turn(strands, orbit, kept);
  }
}

/* Relinks the orbits of a closed trail, one after the other, to make its cords long, or short: the
 * length of a closed cord depends on which image of itself a walk along the quotient's trail comes
 * back to. */
static void turn_trail(thr_strands *strands, const trail_sets *trails, int start, int least)
{
  int best = walk_length(strands, strands->first[start]);
  for (int orbit = start; orbit < strands->n_orbits; orbit++)
    if (root(trails, orbit) == start && strands->partner[orbit] <= orbit)
      turn_best(strands, orbit, start, least, &best);
}

/* Makes the closed cords of every trail as long as they can be: then they are few. */
static void lengthen_cords(thr_strands *strands, const trail_sets *trails)
{
  for (int start = 0; start < strands->n_orbits; start++)
    if (root(trails, start) == start && !trails->ends[start]) turn_trail(strands, trails, start, 0);
}

/* ---- as many closed cords as may be ---- */

/* Counts the darts of an orbit in a component. */
static int darts_within(const thr_strands *strands, int orbit, const int *component, int within)
{
  int n = 0;
  for (int dart = strands->first[orbit]; dart < strands->first[orbit + 1]; dart++)
    n += component[thr_tail(strands->q->f, thr_strands_half(strands, dart))] == within;
  return n;
}

/* Counts the passes that the trail from orbit start has in a component, and the ends of its open
 * cords there. */
static int passes_within(const thr_strands *strands, const trail_sets *trails, int start,
                         const int *component, int within, int *ends)
{
  int darts = 0;
  *ends = 0;
  /* The root of a trail is its lowest orbit. */
  for (int orbit = start; orbit < strands->n_orbits; orbit++) {
    if (root(trails, orbit) != start) continue;
    int n = darts_within(strands, orbit, component, within);
    darts += n;
    if (strands->partner[orbit] < 0) *ends += n;
  }

  return darts / 2;
}

/* Makes the cords of every trail without ends as many as can be, with all cords at most `most` in a
 * component. */
static void shorten_cords(thr_strands *strands, const trail_sets *trails, const int *component,
                          int most)
{
  for (int start = 0; start < strands->n_orbits; start++) {
    if (root(trails, start) != start || trails->ends[start]) continue;
    int own = 0, ends, others = 0,
        within =
            component[thr_tail(strands->q->f, thr_strands_half(strands, strands->first[start]))];

    /* Count passes of its own, and the cords of all other trails in the component. */
    for (int orbit = 0; orbit < strands->n_orbits; orbit++) {
      if (root(trails, orbit) != orbit) continue;
      int passes = passes_within(strands, trails, orbit, component, within, &ends);
      if (orbit == start)
        own = passes;
      else if (passes > 0)
        others +=
            trails->ends[orbit] ? ends / 2 : passes / walk_length(strands, strands->first[orbit]);
    }

    /* So many passes are needed for as few cords as are left. */
    if (most > others)
      turn_trail(strands, trails, start, (own + most - others - 1) / (most - others));
  }
}

/* Arranges the trails: parts trails between folds, joins circles, and makes closed cords long or
 * short. */
static thr_status arrange_trails(thr_strands *strands, bool all_open, const int *component,
                                 int most, thr_err *err)
{
  size_t n_orbits = (size_t)strands->n_orbits;
  trail_sets trails = {0};
  orbit_lists all = {0};
  thr_status st = type_lists_init(&all, strands, err);

  trails.parent = thr_calloc(n_orbits, sizeof *trails.parent);
  trails.ends = thr_calloc(n_orbits, sizeof *trails.ends);
  trails.folds = thr_calloc(n_orbits, sizeof *trails.folds);

  if (!st && (!trails.parent || !trails.ends || !trails.folds)) st = thr_nomem(err);

  /* Exchanges and new links, in this order. */
  if (!st && all_open) st = thr_strands_open(strands, err);
  if (!st) {
    find_trails(strands, &trails);
    if (most == 0 || all_open) join_circles(strands, &trails, &all);
    if (all_open) st = all_have_ends(strands, &trails, err);
    if (!st) lengthen_cords(strands, &trails);
    if (!st && most > 0) shorten_cords(strands, &trails, component, most);
  }

  type_lists_destroy(&all);
  free(trails.parent);
  free(trails.ends);
  free(trails.folds);
  return st;
}

thr_status thr_strands_init(thr_strands *strands, const thr_quotient *quotient,
                            const thr_cover *cover, bool all_open, const int *component, int most,
                            thr_err *err)
{
  *strands = (thr_strands){.q = quotient};
  thr_status st = make_tables(strands, cover, err);

  /* Darts over the edges, then links at the nodes. */
  if (!st) st = make_orbits(strands, cover, err);
  if (!st) st = make_pairs(strands, cover, err);
  if (!st) st = arrange_trails(strands, all_open, component, most, err);
  if (st) thr_strands_destroy(strands);
  return st;
}
