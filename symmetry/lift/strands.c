/* Dart orbits as cosets, their links, and the choices among them. */
#include "symmetry/lift/strands.h"
#include "graph/disjoint.h"
#include "symmetry/group/group.h"

#include <stdlib.h>
#include <string.h>

static int product(const thr_quotient *q, int a, int b)
{
  return q->group->product[(size_t)a * (size_t)q->group->order + (size_t)b];
}

static int inverse(const thr_quotient *q, int a)
{
  return q->group->inverse[a];
}

static int half_image(const thr_quotient *q, int place, int h)
{
  return q->half_image[(size_t)place * 2 * (size_t)q->f->n_edges + (size_t)h];
}

/* Is t a t^-1 = b, for subgroups of one order? */
static bool conjugates(const thr_quotient *q, int t, const thr_subgroup *a, const thr_subgroup *b)
{
  for (int i = 0; i < a->order; i++)
    if (!thr_subgroup_has(b, product(q, product(q, t, a->element[i]), inverse(q, t)))) return false;
  return true;
}

/* Lowest element of H that takes half-edge a with stabilizer A to b with B; -1 if none does. */
static int carrier(const thr_quotient *q, int a, const thr_subgroup *A, int b, const thr_subgroup *B)
{
  if (A->order != B->order) return -1;
  for (int i = 0; i < q->h->order; i++)
    if (half_image(q, i, a) == b && conjugates(q, q->h->element[i], A, B)) return q->h->element[i];
  return -1;
}

/* ---- darts ---- */

static int coset_of(const thr_strands *s, int type, int x)
{
  return s->coset[(size_t)s->row[type] * (size_t)s->q->h->order + (size_t)s->place[x]];
}

/* Element of the coset that dart d is. */
static int element_of(const thr_strands *s, int d)
{
  int o = s->orbit[d];
  return s->chosen[(size_t)s->row[s->type[o]] * (size_t)s->q->h->order + (size_t)(d - s->first[o])];
}

static int dart_of(const thr_strands *s, int o, int x)
{
  return s->first[o] + coset_of(s, s->type[o], x);
}

int thr_strands_half(const thr_strands *s, int d)
{
  return half_image(s->q, s->place[element_of(s, d)], s->q->dart[s->type[s->orbit[d]]].half);
}

int thr_strands_across(const thr_strands *s, int d)
{
  int o = s->orbit[d];
  return dart_of(s, s->other[o], product(s->q, element_of(s, d), s->over[o]));
}

int thr_strands_mate(const thr_strands *s, int d)
{
  int o = s->orbit[d];
  return s->partner[o] < 0 ? -1 : dart_of(s, s->partner[o], product(s->q, element_of(s, d), s->turn[o]));
}

int thr_strands_image(const thr_strands *s, int x, int d)
{
  return dart_of(s, s->orbit[d], product(s->q, x, element_of(s, d)));
}

/* ---- tables ---- */

void thr_strands_destroy(thr_strands *s)
{
  free(s->type);
  free(s->first);
  free(s->orbit);
  free(s->other);
  free(s->over);
  free(s->partner);
  free(s->turn);
  free(s->place);
  free(s->row);
  free(s->coset);
  free(s->chosen);
  *s = (thr_strands){0};
}

/* Rows of the two tables for the types that copies of the cover have; returns how many. */
static int number_rows(thr_strands *s, const thr_cover *c)
{
  const thr_quotient *q = s->q;
  int rows = 0;
  for (int t = 0; t < q->n_darts; t++)
    s->row[t] = -1;
  for (int i = 0; i < q->n_copies; i++)
    for (int side = 0; side < 2 && c->copies[i] > 0; side++) {
      int t = q->copy[i].dart[side];
      if (t >= 0 && s->row[t] < 0) s->row[t] = rows++;
    }
  return rows;
}

static void list_cosets(thr_strands *s, int t)
{
  const thr_quotient *q = s->q;
  const thr_subgroup *S = &q->dart[t].stabilizer;
  size_t start = (size_t)s->row[t] * (size_t)q->h->order;
  int *coset = s->coset + start, n = 0;
  for (int i = 0; i < q->h->order; i++)
    coset[i] = -1;
  for (int i = 0; i < q->h->order; i++) {
    if (coset[i] >= 0) continue;
    for (int k = 0; k < S->order; k++)
      coset[s->place[product(q, q->h->element[i], S->element[k])]] = n;
    s->chosen[start + (size_t)n++] = q->h->element[i];
  }
}

static thr_status make_tables(thr_strands *s, const thr_cover *c, thr_err *err)
{
  const thr_quotient *q = s->q;
  s->place = thr_calloc((size_t)q->group->order, sizeof *s->place);
  s->row = thr_calloc((size_t)q->n_darts, sizeof *s->row);
  if (!s->place || !s->row) return thr_nomem(err);
  for (int x = 0; x < q->group->order; x++)
    s->place[x] = -1;
  for (int i = 0; i < q->h->order; i++)
    s->place[q->h->element[i]] = i;
  size_t room = (size_t)number_rows(s, c) * (size_t)q->h->order;
  s->coset = thr_calloc(room, sizeof *s->coset);
  s->chosen = thr_calloc(room, sizeof *s->chosen);
  if (!s->coset || !s->chosen) return thr_nomem(err);
  for (int t = 0; t < q->n_darts; t++)
    if (s->row[t] >= 0) list_cosets(s, t);
  return THR_OK;
}

/* ---- orbits of darts, linked over the edges ---- */

/* The lowest element of a fold's K that turns its edge round. */
static int turner(const thr_strands *s, const thr_copy_type *c)
{
  int i = 0;
  while (i + 1 < c->stabilizer.order && half_image(s->q, s->place[c->stabilizer.element[i]], 2 * c->edge) == 2 * c->edge)
    i++;
  return c->stabilizer.element[i];
}

/* Lowest element of H that takes the copy's end at half-edge 2 e to the representative of its type. Of a fold, whose K turns the
 * half-edge round, S goes into K. */
static int fold_carrier(const thr_quotient *q, const thr_copy_type *c)
{
  const thr_dart_type *d = &q->dart[c->dart[0]];
  for (int i = 0; i < q->h->order; i++) {
    int x = q->h->element[i];
    bool fits = half_image(q, i, 2 * c->edge) == d->half;
    for (int k = 0; k < d->stabilizer.order && fits; k++)
      fits = thr_subgroup_has(&c->stabilizer, product(q, product(q, inverse(q, x), d->stabilizer.element[k]), x));
    if (fits) return x;
  }
  return -1;
}

/* Elements over of the two dart orbits of a copy type. The dart at end i of the copy K is the coset of t[i]^-1, where t[i] takes
 * it to its type's representative. */
static thr_status link_copy(const thr_strands *s, const thr_copy_type *c, int over[2], thr_err *err)
{
  const thr_quotient *q = s->q;
  int t[2], back;
  for (int i = 0; i < 2; i++) {
    const thr_dart_type *d = &q->dart[c->dart[c->fold ? 0 : i]];
    t[i] = c->fold ? fold_carrier(q, c) : carrier(q, 2 * c->edge + i, &c->stabilizer, d->half, &d->stabilizer);
    if (t[i] < 0) return thr_fail(err, THR_ESOLVER, "edge %d: its darts are not of their types", c->edge);
  }
  back = inverse(q, t[1]);
  if (c->fold) back = product(q, turner(s, c), back);
  over[0] = product(q, t[0], back);
  over[1] = inverse(q, over[0]);
  return THR_OK;
}

static thr_status orbits_init(thr_strands *s, const thr_cover *c, thr_err *err)
{
  const thr_quotient *q = s->q;
  for (int i = 0; i < q->n_copies; i++)
    s->n_orbits += c->copies[i] * (q->copy[i].fold ? 1 : 2);
  size_t n = (size_t)s->n_orbits;
  s->type = thr_calloc(n, sizeof *s->type);
  s->first = thr_calloc(n + 1, sizeof *s->first);
  s->other = thr_calloc(n, sizeof *s->other);
  s->over = thr_calloc(n, sizeof *s->over);
  s->partner = thr_calloc(n, sizeof *s->partner);
  s->turn = thr_calloc(n, sizeof *s->turn);
  return s->type && s->first && s->other && s->over && s->partner && s->turn ? THR_OK : thr_nomem(err);
}

static thr_status make_orbits(thr_strands *s, const thr_cover *c, thr_err *err)
{
  const thr_quotient *q = s->q;
  thr_status st = orbits_init(s, c, err);
  for (int i = 0, o = 0; i < q->n_copies && !st; i++) {
    int sides = q->copy[i].fold ? 1 : 2, over[2] = {0};
    if (c->copies[i] > 0) st = link_copy(s, &q->copy[i], over, err);
    for (int k = 0; k < c->copies[i] && !st; k++, o += sides)
      for (int side = 0; side < sides; side++) {
        s->type[o + side] = q->copy[i].dart[side];
        s->other[o + side] = o + sides - 1 - side;
        s->over[o + side] = over[side];
      }
  }
  for (int o = 0; o < s->n_orbits && !st; o++)
    s->first[o + 1] = s->first[o] + q->dart[s->type[o]].darts;
  if (st) return st;
  s->n_darts = s->first[s->n_orbits];
  if (!(s->orbit = thr_calloc((size_t)s->n_darts, sizeof *s->orbit))) return thr_nomem(err);
  for (int o = 0; o < s->n_orbits; o++)
    for (int d = s->first[o]; d < s->first[o + 1]; d++)
      s->orbit[d] = o;
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

static thr_status type_lists_init(type_lists *l, const thr_strands *s, thr_err *err)
{
  l->head = thr_calloc((size_t)s->q->n_darts, sizeof *l->head);
  l->next = thr_calloc((size_t)s->n_orbits, sizeof *l->next);
  if (!l->head || !l->next) return thr_nomem(err);
  for (int t = 0; t < s->q->n_darts; t++)
    l->head[t] = -1;
  for (int o = s->n_orbits - 1; o >= 0; o--) {
    l->next[o] = l->head[s->type[o]];
    l->head[s->type[o]] = o;
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
static int pair_element(const thr_quotient *q, const thr_pair_type *p)
{
  if (p->self) return p->element;
  const thr_dart_type *a = &q->dart[p->dart[0]], *b = &q->dart[p->dart[1]];
  return carrier(q, b->half, &b->stabilizer, p->half[1], &a->stabilizer);
}

static thr_status pair_orbits(thr_strands *s, type_lists *unpaired, const thr_pair_type *p, int count, thr_err *err)
{
  int turn = count > 0 ? pair_element(s->q, p) : 0;
  for (int k = 0; k < count; k++) {
    int a = take(unpaired, p->dart[0]), b = p->self ? a : take(unpaired, p->dart[1]);
    if (turn < 0 || a < 0 || b < 0) return thr_fail(err, THR_ESOLVER, "a turn of the cover joins no two of its passes");
    s->partner[a] = b;
    s->turn[a] = turn;
    s->partner[b] = a;
    if (b != a) s->turn[b] = inverse(s->q, turn);
  }
  return THR_OK;
}

static thr_status make_pairs(thr_strands *s, const thr_cover *c, thr_err *err)
{
  const thr_quotient *q = s->q;
  type_lists unpaired = {0};
  thr_status st = type_lists_init(&unpaired, s, err);
  for (int i = 0; i < q->n_pairs && !st; i++)
    st = pair_orbits(s, &unpaired, &q->pair[i], c->pairs[i], err);
  for (int t = 0; t < q->n_darts && !st; t++) {
    int ends = 0;
    for (int o = take(&unpaired, t); o >= 0; o = take(&unpaired, t), ends++)
      s->partner[o] = -1;
    if (ends != c->ends[t])
      st = thr_fail(err, THR_ESOLVER, "a cover with %d cord ends of a kind instead of %d", ends, c->ends[t]);
  }
  type_lists_destroy(&unpaired);
  return st;
}

/* ---- trails of the quotient ---- */

/* Trails as sets of orbits (union-find), with how many of their two terminals are cord ends and how many folds. */
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
  int ra = root(t, a), rb = root(t, b), ends = t->ends[ra] + t->ends[rb], folds = t->folds[ra] + t->folds[rb];
  if (!thr_disjoint_join(t->parent, ra, rb)) return;
  t->ends[root(t, ra)] = ends;
  t->folds[root(t, ra)] = folds;
}

static void find_trails(const thr_strands *s, trails *t)
{
  for (int o = 0; o < s->n_orbits; o++) {
    t->parent[o] = o;
    t->ends[o] = s->partner[o] < 0;
    t->folds[o] = (s->partner[o] == o) + (s->other[o] == o);
  }
  for (int o = 0; o < s->n_orbits; o++) {
    join(t, o, s->other[o]);
    if (s->partner[o] >= 0) join(t, o, s->partner[o]);
  }
}

static bool is_circle(const trails *t, int at_root)
{
  return t->ends[at_root] + t->folds[at_root] == 0;
}

void thr_strands_exchange(thr_strands *s, int a, int b)
{
  int pa = s->partner[a], pb = s->partner[b], turn = s->turn[a];
  s->turn[a] = s->turn[b];
  s->turn[b] = turn;
  if (pa == b) return; /* with each other */
  s->partner[a] = pb == b ? a : pb;
  s->partner[b] = pa == a ? b : pa;
  if (pa >= 0 && pa != a) s->partner[pa] = b;
  if (pb >= 0 && pb != b) s->partner[pb] = a;
}

/* Joins circles to whatever trail shares a type with them. */
static void join_circles(thr_strands *s, trails *t, const type_lists *all)
{
  for (int type = 0; type < s->q->n_darts; type++) {
    int a = all->head[type];
    for (int b = a < 0 ? -1 : all->next[a]; b >= 0; b = all->next[b]) {
      int ra = root(t, a), rb = root(t, b);
      if (ra == rb || (!is_circle(t, ra) && !is_circle(t, rb))) continue;
      thr_strands_exchange(s, a, b);
      join(t, ra, rb);
    }
  }
}

static thr_status all_have_ends(const thr_strands *s, const trails *t, thr_err *err)
{
  for (int o = 0; o < s->n_orbits; o++)
    if (t->ends[root(t, o)] == 0) {
      int e = s->q->dart[s->type[o]].half >> 1;
      return thr_fail(err, THR_ESOLVER, "the cords over edge %d and its images would be closed, where ends are asked for", e);
    }
  return THR_OK;
}

/* Passes from a dart of a closed cord round to it again. */
static int walk_length(const thr_strands *s, int start)
{
  int n = 0, d = start;
  do {
    d = thr_strands_mate(s, thr_strands_across(s, d));
    n++;
  } while (d >= 0 && d != start);
  return n;
}

/* Could orbit o be paired by this element instead, at the same two half-edges? A fold must stay one. */
static bool may_turn(const thr_strands *s, int o, int turn)
{
  const thr_quotient *q = s->q;
  const thr_dart_type *a = &q->dart[s->type[o]], *b = &q->dart[s->type[s->partner[o]]];
  if (half_image(q, s->place[turn], b->half) != half_image(q, s->place[s->turn[o]], b->half)) return false;
  if (!conjugates(q, turn, &b->stabilizer, &a->stabilizer)) return false;
  return s->partner[o] != o ||
         (!thr_subgroup_has(&a->stabilizer, turn) && thr_subgroup_has(&a->stabilizer, product(q, turn, turn)));
}

static void set_turn(thr_strands *s, int o, int turn)
{
  s->turn[o] = turn;
  if (s->partner[o] != o) s->turn[s->partner[o]] = inverse(s->q, turn);
}

/* Of the partners that orbit o has in the other orbit at the same half-edge, takes the one with the longest cord. */
static void lengthen(thr_strands *s, int o, int start, int *best)
{
  const thr_quotient *q = s->q;
  int type = s->type[s->partner[o]], kept = s->turn[o];
  size_t row = (size_t)s->row[type] * (size_t)q->h->order;
  for (int k = 0; k < q->dart[type].darts; k++) {
    int turn = s->chosen[row + (size_t)k];
    if (coset_of(s, type, turn) == coset_of(s, type, kept) || !may_turn(s, o, turn)) continue;
    set_turn(s, o, turn);
    int length = walk_length(s, s->first[start]);
    if (length > *best) {
      *best = length;
      kept = turn;
    } else
      set_turn(s, o, kept);
  }
}

/* The lengths of closed cords depend on where the walk round the quotient's trail comes back. */
static void lengthen_cords(thr_strands *s, const trails *t)
{
  for (int start = 0; start < s->n_orbits; start++) {
    if (root(t, start) != start || t->ends[start]) continue;
    int best = walk_length(s, s->first[start]);
    for (int o = start; o < s->n_orbits; o++)
      if (root(t, o) == start && s->partner[o] <= o) lengthen(s, o, start, &best);
  }
}

static thr_status arrange(thr_strands *s, bool all_open, thr_err *err)
{
  size_t n = (size_t)s->n_orbits;
  trails t = {0};
  type_lists all = {0};
  thr_status st = type_lists_init(&all, s, err);
  t.parent = thr_calloc(n, sizeof *t.parent);
  t.ends = thr_calloc(n, sizeof *t.ends);
  t.folds = thr_calloc(n, sizeof *t.folds);
  if (!st && (!t.parent || !t.ends || !t.folds)) st = thr_nomem(err);
  if (!st && all_open) st = thr_strands_open(s, err);
  if (!st) {
    find_trails(s, &t);
    join_circles(s, &t, &all);
    if (all_open) st = all_have_ends(s, &t, err);
    if (!st) lengthen_cords(s, &t);
  }
  type_lists_destroy(&all);
  free(t.parent);
  free(t.ends);
  free(t.folds);
  return st;
}

thr_status thr_strands_init(thr_strands *s, const thr_quotient *q, const thr_cover *c, bool all_open, thr_err *err)
{
  *s = (thr_strands){.q = q};
  thr_status st = make_tables(s, c, err);
  if (!st) st = make_orbits(s, c, err);
  if (!st) st = make_pairs(s, c, err);
  if (!st) st = arrange(s, all_open, err);
  if (st) thr_strands_destroy(s);
  return st;
}
