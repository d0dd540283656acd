/* Symmetric covers against exhaustive search and against published figures. */
#include "graph/plan/junction.h"
#include "graph/framework/make.h"
#include "symmetry/group/automorphisms.h"
#include "symmetry/cover/claims.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/isometry.h"
#include "symmetry/cover/turning_bound.h"
#include "tests/symmetric.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "symmetry/cover/contraction.h"
#include "symmetry/cover/programme.h"
#include "symmetry/cover/relaxation.h"
#include "symmetry/group/quotient.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/lift/keep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COPIES = 72, MOST_TYPES = 64, MOST_ORBITS = 16, MOST_NODES = 6, LEAVES = 400000 };

/* ---- frameworks and their groups ---- */

static thr_frame frame_from(int n, int m, const int (*edge)[2], const int *feet)
{
  static const double xyz[MOST_NODES][3] = {{0, 0, 0}, {10, 1, 0}, {3, 9, 1}, {-4, 5, 7}, {2, -6, 3}, {6, 4, -8}};
  return frame_make(n, xyz, m, edge, NULL, feet);
}

/* All automorphisms that keep feet, by trying every permutation. */
static thr_group automorphisms_by_hand(const thr_frame *f)
{
  int n = f->n_nodes, count = 0, at[MOST_NODES], *list = thr_calloc((size_t)720 * MOST_NODES, sizeof *list);
  thr_group g;
  ck_assert_ptr_nonnull(list);
  for (int i = 0, all = (int)lround(pow(n, n)); i < all; i++) {
    bool good = true;
    for (int v = 0, rest = i; v < n; v++, rest /= n)
      at[v] = rest % n;
    for (int v = 0; v < n && good; v++)
      for (int w = 0; w < v && good; w++)
        good = at[v] != at[w] && (thr_frame_edge_between(f, v, w) < 0) == (thr_frame_edge_between(f, at[v], at[w]) < 0);
    for (int v = 0; v < n && good; v++)
      good = f->foot[v] == f->foot[at[v]];
    if (good) memcpy(&list[n * count++], at, (size_t)n * sizeof *at);
  }
  ck_assert_int_eq(thr_group_generate(n, list, count, THR_GROUP_CAP, &g, NULL), THR_OK);
  ck_assert_int_eq(g.order, count);
  free(list);
  return g;
}

/* ---- exhaustive search ----
 * Copies are cosets of subgroups of H, darts are (copy, half-edge), and H permutes them; partners are chosen dart by dart. */

typedef struct {
  uint64_t set; /* of elements of H: a subgroup of an edge's stabilizer */
  int orbit, passes, copies;
} kind;

typedef struct {
  const thr_frame *f;
  const thr_cover_options *o;
  int most_cords; /* 0 = any number */
  int order;
  int image[48][MOST_NODES], product[48][48];
  int n_orbits, first_edge[MOST_ORBITS], size[MOST_ORBITS];
  double orbit_length[MOST_ORBITS];
  double angle[2 * MOST_ORBITS][2 * MOST_ORBITS]; /* from half-edge to half-edge that leave one node */
  int n_kinds;
  kind kind[MOST_TYPES];
  /* one choice of copies */
  int n_copies, copy_kind[MOST_COPIES], copy_member[MOST_COPIES]; /* an element that takes the representative there */
  int copy_orbit[MOST_COPIES];
  int copy_image[48][MOST_COPIES];
  int half[2 * MOST_COPIES]; /* dart 2 * copy + side */
  int node[2 * MOST_COPIES]; /* where it begins */
  int dart_image[48][2 * MOST_COPIES];
  int partner[2 * MOST_COPIES]; /* -1 = open, -2 = an end */
  long leaves;
  bool found;
  double best[THR_N_AIMS];
  double turning; /* least of those with the other aims at best, as a plan counts it: with ends anywhere, less the sharpest turn
                     of every closed cord */
} exhaustive;

static int half_image(const exhaustive *x, int g, int h)
{
  int a = x->image[g][thr_tail(x->f, h)], b = x->image[g][thr_head(x->f, h)], e = thr_frame_edge_between(x->f, a, b);
  return 2 * e + (x->f->edge[e][0] != a);
}

static uint64_t coset(const exhaustive *x, int g, uint64_t set)
{
  uint64_t made = 0;
  for (int k = 0; k < x->order; k++)
    if (set >> k & 1) made |= UINT64_C(1) << x->product[g][k];
  return made;
}

/* Subgroups of the stabilizer of edge e, one of each class of conjugates. */
static void list_kinds(exhaustive *x, int orbit, int e)
{
  int n = 0, at[48];
  for (int g = 0; g < x->order; g++)
    if (half_image(x, g, 2 * e) >> 1 == e) at[n++] = g;
  ck_assert_int_le(n, 12);
  for (int bits = 1; bits < 1 << n; bits += 2) { /* with the identity, which is element 0 */
    uint64_t set = 0;
    bool good = true;
    int count = 0;
    for (int i = 0; i < n; i++)
      if (bits >> i & 1) {
        set |= UINT64_C(1) << at[i];
        count++;
      }
    for (int i = 0; i < n && good; i++)
      if (bits >> i & 1) good = coset(x, at[i], set) == set;
    for (int i = 0; i < n && good; i++) { /* least of its conjugates */
      uint64_t left = coset(x, at[i], set), other = 0;
      for (int k = 0; k < x->order; k++)
        if (left >> k & 1)
          for (int inverse = 0; inverse < x->order; inverse++)
            if (x->product[at[i]][inverse] == 0) other |= UINT64_C(1) << x->product[k][inverse];
      good = other >= set;
    }
    if (!good) continue;
    ck_assert_int_lt(x->n_kinds, MOST_TYPES);
    x->kind[x->n_kinds++] = (kind){set, orbit, n / count, x->order / count};
  }
}

static void exhaustive_init(exhaustive *x, const thr_frame *f, const thr_group *g, const thr_subgroup *h,
                            const thr_cover_options *o)
{
  bool done[32] = {false};
  memset(x, 0, sizeof *x);
  x->f = f;
  x->o = o;
  x->order = h->order;
  for (int i = 0; i < h->order; i++) {
    memcpy(x->image[i], &g->image[h->element[i] * g->degree], (size_t)g->degree * sizeof(int));
    for (int k = 0; k < h->order; k++)
      for (int p = 0; p < h->order; p++)
        if (g->product[h->element[i] * g->order + h->element[k]] == h->element[p]) x->product[i][k] = p;
  }
  ck_assert_int_le(f->n_edges, MOST_ORBITS);
  for (int a = 0; a < 2 * f->n_edges; a++)
    for (int b = 0; b < 2 * f->n_edges; b++)
      if (thr_tail(f, a) == thr_tail(f, b)) x->angle[a][b] = thr_turn_angle(f, a ^ 1, b);
  for (int e = 0; e < f->n_edges; e++) {
    if (done[e]) continue;
    int orbit = x->n_orbits++;
    x->first_edge[orbit] = e;
    for (int i = 0; i < x->order; i++) {
      int to = half_image(x, i, 2 * e) >> 1;
      if (!done[to]) x->orbit_length[orbit] += f->length[to];
      if (!done[to]) x->size[orbit]++;
      done[to] = true;
    }
    list_kinds(x, orbit, e);
  }
}

static int root_of(const int *parent, int v)
{
  while (parent[v] != v)
    v = parent[v];
  return v;
}

static void join(int *parent, int a, int b)
{
  parent[root_of(parent, a)] = root_of(parent, b);
}

/* Do the turns connect the half-edges of every node? */
static bool is_tied(const exhaustive *x)
{
  int tube[2 * MOST_ORBITS];
  for (int h = 0; h < 2 * x->f->n_edges; h++)
    tube[h] = h;
  for (int d = 0; d < 2 * x->n_copies; d++)
    if (x->partner[d] > d && root_of(tube, x->half[d]) != root_of(tube, x->half[x->partner[d]]))
      join(tube, x->half[d], x->half[x->partner[d]]);
  for (int a = 0; a < 2 * x->f->n_edges; a++)
    for (int b = 0; b < a; b++)
      if (thr_tail(x->f, a) == thr_tail(x->f, b) && root_of(tube, a) != root_of(tube, b)) return false;
  return true;
}

static int count_ends(const exhaustive *x)
{
  int ends = 0;
  for (int d = 0; d < 2 * x->n_copies; d++)
    ends += x->partner[d] == -2;
  return ends;
}

/* Orbits of ends: each is one step, where they may be anywhere. */
static int count_end_orbits(const exhaustive *x)
{
  int orbits = 0;
  for (int d = 0; d < 2 * x->n_copies && x->o->ends == THR_ENDS_ANY; d++) {
    bool lowest = x->partner[d] == -2;
    for (int g = 0; g < x->order && lowest; g++)
      lowest = x->dart_image[g][d] >= d;
    orbits += lowest;
  }
  return orbits;
}

/* Everything has a partner: which cords are there, and which are copies of each other? */
static void weigh(exhaustive *x, double overlap, double steps)
{
  int cord[MOST_COPIES], unique[MOST_COPIES];
  double left_out = 0, sharpest[MOST_COPIES] = {0};
  bool open[MOST_COPIES] = {false}, counted[MOST_COPIES] = {false}, used[MOST_COPIES] = {false};
  double worth[THR_N_AIMS] = {overlap, steps + count_end_orbits(x), 0, 0};
  x->leaves++;
  if (x->o->tube && !is_tied(x)) return;
  if (x->o->most_ends > 0 && count_ends(x) > x->o->most_ends) return;
  for (int c = 0; c < x->n_copies; c++)
    cord[c] = unique[c] = c;
  for (int d = 0; d < 2 * x->n_copies; d++)
    if (x->partner[d] > d) {
      join(cord, d / 2, x->partner[d] / 2);
      worth[THR_AIM_TURNING] += x->angle[x->half[d]][x->half[x->partner[d]]];
    }
  int cords = 0;
  for (int c = 0; c < x->n_copies; c++)
    cords += cord[c] == c;
  if (x->most_cords > 0 && cords > x->most_cords) return;
  for (int d = 0; d < 2 * x->n_copies; d++)
    if (x->partner[d] == -2) open[root_of(cord, d / 2)] = true;
  for (int c = 0; c < x->n_copies; c++) {
    bool all_open = x->o->ends == THR_ENDS_FEET || (x->o->tube && x->o->ends == THR_ENDS_ANY);
    if (all_open && !open[root_of(cord, c)]) return;
    for (int g = 0; g < x->order; g++)
      join(unique, root_of(cord, c), root_of(cord, x->copy_image[g][c]));
  }
  for (int c = 0; c < x->n_copies; c++)
    used[root_of(unique, root_of(cord, c))] = true;
  for (int c = 0; c < x->n_copies; c++)
    worth[THR_AIM_PATHS] += used[c] && !counted[c];
  for (int d = 0; d < 2 * x->n_copies; d++)
    if (x->partner[d] > d) {
      double *most = &sharpest[root_of(cord, d / 2)];
      *most = fmax(*most, x->angle[x->half[d]][x->half[x->partner[d]]]);
    }
  for (int c = 0; c < x->n_copies && x->o->ends == THR_ENDS_ANY; c++)
    if (cord[c] == c && !open[c]) left_out += sharpest[c];
  bool equal = x->found;
  for (int a = 0; a < THR_AIM_TURNING && equal; a++)
    equal = fabs(worth[a] - x->best[a]) < 1e-6;
  if (equal) x->turning = fmin(x->turning, worth[THR_AIM_TURNING] - left_out);
  for (int a = 0; a < THR_N_AIMS && x->found; a++) {
    if (worth[a] < x->best[a] - 1e-6) break;
    if (worth[a] > x->best[a] + 1e-6) return;
  }
  memcpy(x->best, worth, sizeof worth);
  if (!equal) x->turning = worth[THR_AIM_TURNING] - left_out;
  x->found = true;
}

/* Gives all images of dart a the images of b (-2: ends) as partners; false if that contradicts itself. Undo by the old partners.
 */
static bool pair_all(exhaustive *x, int a, int b)
{
  for (int g = 0; g < x->order; g++) {
    int p = x->dart_image[g][a], q = b < 0 ? -2 : x->dart_image[g][b];
    if ((x->partner[p] != -1 && x->partner[p] != q) || p == q) return false;
    x->partner[p] = q;
    if (q < 0) continue;
    if (x->partner[q] != -1 && x->partner[q] != p) return false;
    x->partner[q] = p;
  }
  return true;
}

static void choose_partners(exhaustive *x, double overlap, double steps)
{
  int a = 0, before[2 * MOST_COPIES];
  const size_t bytes = 2 * (size_t)x->n_copies * sizeof *before;
  const thr_frame *f = x->f;
  while (a < 2 * x->n_copies && x->partner[a] != -1)
    a++;
  if (x->leaves > LEAVES) return;
  if (a == 2 * x->n_copies) {
    weigh(x, overlap, steps);
    return;
  }
  memcpy(before, x->partner, bytes);
  int v = x->node[a];
  bool end = x->o->ends == THR_ENDS_ANY || (x->o->ends == THR_ENDS_FEET && f->foot[v]);
  for (int b = end ? -2 : 0; b < 2 * x->n_copies; b++) {
    if (b == -1 || b == a) continue;
    if (b >= 0 && (x->partner[b] != -1 || x->node[b] != v)) continue;
    if (b >= 0 && (x->half[b] == x->half[a]) != (thr_degree(f, v) == 1 && !end && !x->o->tube)) continue;
    if (pair_all(x, a, b)) choose_partners(x, overlap, steps);
    memcpy(x->partner, before, bytes);
  }
}

/* Makes the orbits of copies concrete; number[k]: orbits of kind k. */
static void make_copies(exhaustive *x, const int *number)
{
  uint64_t set[MOST_COPIES];
  int n = 0, orbit = 0;
  for (int k = 0; k < x->n_kinds; k++)
    for (int i = 0; i < number[k]; i++, orbit++)
      for (int g = 0, first = n; g < x->order; g++) {
        uint64_t made = coset(x, g, x->kind[k].set);
        bool is_new = true;
        for (int c = first; c < n; c++)
          if (set[c] == made) is_new = false;
        if (!is_new) continue;
        x->copy_kind[n] = k;
        x->copy_member[n] = g;
        x->copy_orbit[n] = orbit;
        for (int side = 0; side < 2; side++) {
          x->half[2 * n + side] = half_image(x, g, 2 * x->first_edge[x->kind[k].orbit] + side);
          x->node[2 * n + side] = thr_tail(x->f, x->half[2 * n + side]);
        }
        set[n++] = made;
      }
  x->n_copies = n;
  for (int g = 0; g < x->order; g++)
    for (int c = 0; c < n; c++)
      for (int to = 0; to < n; to++)
        if (x->copy_orbit[to] == x->copy_orbit[c] && set[to] == coset(x, g, set[c])) {
          x->copy_image[g][c] = to;
          for (int side = 0; side < 2; side++)
            x->dart_image[g][2 * c + side] = 2 * to + (x->half[2 * to] != half_image(x, g, x->half[2 * c + side]));
        }
}

typedef struct {
  int number[MOST_TYPES];
  double overlap, steps;
} choice;

static int by_worth(const void *a, const void *b)
{
  const choice *p = a, *q = b;
  if (fabs(p->overlap - q->overlap) > 1e-6) return p->overlap < q->overlap ? -1 : 1;
  return p->steps < q->steps ? -1 : p->steps > q->steps;
}

static bool turns_round(const exhaustive *x, const kind *k)
{
  for (int g = 0; g < x->order; g++)
    if (k->set >> g & 1 && half_image(x, g, 2 * x->first_edge[k->orbit]) & 1) return true;
  return false;
}

/* Passes over an edge that are tried. */
static int most_passes(const exhaustive *x)
{
  if (x->o->edge_capacity) return x->o->edge_capacity[0];
  return x->o->cover + (x->n_orbits <= 3 && x->n_kinds <= 10 ? 6 : 2);
}

/* All choices of copies with cover .. most_passes passes over every edge. */
static void list_choices(const exhaustive *x, int k, choice *now, const int *passes, choice **list, int *n, int *capacity)
{
  if (k == x->n_kinds) {
    int copies = 0;
    for (int i = 0; i < x->n_orbits; i++)
      if (passes[i] < x->o->cover) return;
    for (int i = 0; i < x->n_kinds; i++)
      copies += now->number[i] * x->kind[i].copies;
    if (copies > MOST_COPIES) return;
    ck_assert_int_eq(thr_grow(list, *n, capacity, sizeof **list, NULL), THR_OK);
    (*list)[(*n)++] = *now;
    return;
  }
  const kind *t = &x->kind[k];
  int left[MOST_ORBITS];
  choice next = *now;
  memcpy(left, passes, sizeof left);
  for (int i = 0; left[t->orbit] <= most_passes(x); i++) {
    next.number[k] = i;
    list_choices(x, k + 1, &next, left, list, n, capacity);
    left[t->orbit] += t->passes;
    next.overlap += t->passes * x->orbit_length[t->orbit];
    next.steps += turns_round(x, t) ? 0.5 : 1;
  }
}

/* Has every node passes enough to be tied? */
static bool may_tie(const exhaustive *x)
{
  for (int v = 0; v < x->f->n_nodes; v++) {
    int passes = 0;
    for (int d = 0; d < 2 * x->n_copies; d++)
      passes += thr_tail(x->f, x->half[d]) == v;
    if (passes < 2 * (thr_degree(x->f, v) - 1)) return false;
  }
  return true;
}

/* Best cover by exhaustion; false if that takes too long. */
static bool exhaust(exhaustive *x)
{
  choice *list = NULL, none = {{0}, -x->o->cover * thr_frame_total_length(x->f), 0};
  int n = 0, capacity = 0, passes[MOST_ORBITS] = {0};
  list_choices(x, 0, &none, passes, &list, &n, &capacity);
  if (n > 0) qsort(list, (size_t)n, sizeof *list, by_worth);
  for (int i = 0; i < n && x->leaves <= LEAVES; i++) {
    if (x->found && (list[i].overlap > x->best[0] + 1e-6 || list[i].steps > x->best[1] + 1e-6)) break;
    make_copies(x, list[i].number);
    if (x->o->tube && !may_tie(x)) continue;
    for (int d = 0; d < 2 * x->n_copies; d++)
      x->partner[d] = -1;
    choose_partners(x, list[i].overlap, list[i].steps);
  }
  free(list);
  return x->leaves <= LEAVES;
}

typedef struct {
  const char *name;
  int n, m, edge[12][2], feet[MOST_NODES + 1];
} example;

/* K113: two hubs 0 and 1 and their axis, three arms between them. */
static const example examples[] = {
    {"path", 3, 2, {{0, 1}, {1, 2}}, {0, 2, -1}},
    {"edge", 2, 1, {{0, 1}}, {0, 1, -1}},
    {"longer path", 4, 3, {{0, 1}, {1, 2}, {2, 3}}, {0, 3, -1}},
    {"triangle", 3, 3, {{0, 1}, {1, 2}, {2, 0}}, {0, -1}},
    {"square", 4, 4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {0, 2, -1}},
    {"star of three", 4, 3, {{0, 1}, {0, 2}, {0, 3}}, {1, 2, 3, -1}},
    {"star of four", 5, 4, {{0, 1}, {0, 2}, {0, 3}, {0, 4}}, {0, -1}},
    {"diamond", 4, 5, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}}, {2, 3, -1}},
    {"K113", 5, 7, {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}}, {0, 1, -1}},
    {"tetrahedron", 4, 6, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}, {0, -1}},
    {"bow tie", 5, 6, {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {0, 4}, {3, 4}}, {0, -1}},
    {"ladder", 6, 7, {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {0, 3}, {1, 4}, {2, 5}}, {0, 2, 3, 5, -1}},
    {"wheel", 5, 8, {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {2, 3}, {3, 4}, {4, 1}}, {1, 2, 3, 4, -1}},
    {"prism", 6, 9, {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}, {0, 1, 2, 3, 4, 5, -1}},
    {"kite with a tail", 5, 6, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {1, 3}, {2, 4}}, {0, 4, -1}},
    {"K33", 6, 9, {{0, 3}, {0, 4}, {0, 5}, {1, 3}, {1, 4}, {1, 5}, {2, 3}, {2, 4}, {2, 5}}, {0, 1, 2, -1}},
};
enum { EXAMPLES = sizeof examples / sizeof *examples };

typedef struct {
  int compared, beyond; /* covers */
  int bounds, near;     /* bounds on turning; within 1 % of the optimum */
  int repeats, exact;   /* where cords may run alike; otherwise, claims of the least turning itself */
} tally;

/* Most passes of a cover over one edge. */
static int passes_of(const thr_quotient *q, const thr_cover *c)
{
  int most = 0, sum[32] = {0};
  for (int k = 0; k < q->n_copies; k++) {
    int *passes = &sum[q->copy[k].edge_orbit];
    *passes += c->copies[k] * q->copy[k].passes;
    if (*passes > most) most = *passes;
  }
  return most;
}

/* The bounds on turning by themselves, from the best cover on: whole, and stopped after some microseconds. */
static void check_turning_bounds(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c, bool all, tally *n)
{
  thr_programme p;
  thr_contraction k;
  double best = c->value[THR_AIM_TURNING], quick;
  ck_assert_int_eq(thr_programme_init(&p, q, o, NULL), THR_OK);
  ck_assert_int_eq(thr_contraction_init(&k, &p, all, NULL), THR_OK);
  int *cover = thr_calloc((size_t)p.n, sizeof *cover);
  ck_assert_ptr_nonnull(cover);
  memcpy(cover, c->copies, (size_t)q->n_copies * sizeof *cover);
  if (q->n_pairs > 0) memcpy(cover + p.first_pair, c->pairs, (size_t)q->n_pairs * sizeof *cover);
  memcpy(cover + p.first_end, c->ends, (size_t)q->n_darts * sizeof *cover);
  ck_assert_int_eq(thr_turning_quick_bound(&p, c->value, &quick, NULL), THR_OK);
  ck_assert_double_le(quick, best + 1e-6 * (1 + best));
  for (int micro = 10; micro <= 100000; micro *= 10) {
    thr_limits limits = {.deadline = micro < 100000 ? thr_clock() + 1e-6 * micro : 0};
    thr_relaxation r = {0};
    double bound = 0;
    thr_status st = thr_turning_bound(&k, &r, 0, cover, c->value, &limits, &bound, NULL);
    ck_assert(st == THR_OK || (st == THR_ELIMIT && limits.deadline > 0));
    ck_assert_msg(bound <= best + 1e-6 * (1 + best), "bound %g after %d microseconds, optimum %g", bound, micro, best);
    if (st == THR_OK) ck_assert_msg(all || bound >= quick - 1e-4, "bound %g, at once %g, optimum %g", bound, quick, best);
    if (limits.deadline == 0) n->bounds++;
    if (limits.deadline == 0 && bound > 0.99 * best - 1e-6) n->near++;
    thr_relaxation_destroy(&r);
  }
  free(cover);
  thr_contraction_destroy(&k);
  thr_programme_destroy(&p);
}

/* Searches stopped after some microseconds: what they find and say must leave room for the best cover. */
static void check_stopped(const thr_quotient *q, const thr_cover_options *o, const double *best)
{
  for (int micro = 20; micro < 20000; micro *= 3) {
    thr_limits limits = {.deadline = thr_clock() + 1e-6 * micro};
    thr_cover c;
    thr_status st = thr_cover_find(q, o, &limits, &c, NULL);
    bool fits = c.copies;
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    for (int k = 0; k < THR_N_AIMS && fits; k++) {
      thr_aim a = o->prefer[k];
      ck_assert_msg(c.bound[a] <= best[a] + 1e-4, "%s: bound %g after %d microseconds, best %g", thr_aim_name(a), c.bound[a],
                    micro, best[a]);
      fits = best[a] <= c.value[a] + 1e-4; /* a bound is for the aims before at most at their values */
    }
    thr_cover_destroy(&c);
  }
}

/* Is this cover's threading, as a plan counts it, at least what is claimed of all that have no more in the aims before? */
static void check_claim(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c, const thr_claims *claims,
                        const double has[THR_N_AIMS])
{
  thr_request plan = options_for(o->ends, o->cover);
  thr_cord *cord;
  int n;
  thr_symmetry_record record;
  thr_metrics m;
  ck_assert_int_eq(thr_cover_cords(q, o, c, &cord, &n, &record, NULL), THR_OK);
  ck_assert_int_eq(thr_plan_measure(q->f, &plan, cord, n, &m, NULL), THR_OK);
  const double counted[] = {m.overlap, record.steps, record.unique_paths, m.turning};
  for (int k = 0; k < THR_N_AIMS; k++) {
    thr_aim a = o->prefer[k];
    ck_assert_msg(counted[a] >= claims->least[a] - 1e-5, "ends %s, cover %d, order %d: %s %g, claimed at least %g",
                  thr_ends_name(o->ends), o->cover, q->h->order, thr_aim_name(a), counted[a], claims->least[a]);
    if (has && counted[a] > has[a] + 1e-6) break;
  }
  thr_cords_destroy(cord, n);
  thr_symmetry_record_destroy(&record);
}

/* What is claimed of the best cover c: against its own threading, those that other aims make, and the best for half the passes
 * threaded twice, whose cords all run alike. */
static void check_claims(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c, double turning, tally *n)
{
  static const thr_aim orders[][THR_N_AIMS] = {{THR_AIM_OVERLAP, THR_AIM_TURNING, THR_AIM_PATHS, THR_AIM_STEPS},
                                               {THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_STEPS, THR_AIM_TURNING},
                                               {THR_AIM_STEPS, THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_TURNING}};
  thr_claims claims;
  ck_assert_int_eq(thr_claims_make(q, o, c, &claims, NULL), THR_OK);
  check_claim(q, o, c, &claims, NULL);
  ck_assert_msg(claims.least[THR_AIM_TURNING] <= turning + 1e-5, "ends %s, cover %d, order %d: at least %g claimed, there is %g",
                thr_ends_name(o->ends), o->cover, q->h->order, claims.least[THR_AIM_TURNING], turning);
  n->repeats += claims.repeats;
  n->exact += !claims.repeats && claims.least[THR_AIM_TURNING] > turning - 1e-4;
  for (int k = 0; k < 4; k++) {
    const thr_limits limits = {.deadline = thr_clock() + 0.2};
    thr_cover_options other = *o;
    thr_cover d;
    if (k == 3 && o->cover != 2) continue;
    if (k == 3)
      other.cover = 1;
    else
      memcpy(other.prefer, orders[k], sizeof other.prefer);
    thr_status st = thr_cover_find(q, &other, &limits, &d, NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    for (int i = 0; k == 3 && d.copies && i < q->n_copies; i++)
      d.copies[i] *= 2;
    for (int i = 0; k == 3 && d.copies && i < q->n_pairs; i++)
      d.pairs[i] *= 2;
    for (int i = 0; k == 3 && d.copies && i < q->n_darts; i++)
      d.ends[i] *= 2;
    const double has[] = {c->value[THR_AIM_OVERLAP], c->value[THR_AIM_STEPS], c->value[THR_AIM_PATHS], INFINITY};
    if (d.copies) check_claim(q, o, &d, &claims, has);
    thr_cover_destroy(&d);
  }
}

/* The cover's cords, by the checker's own look at junctions. */
static void check_ties(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c)
{
  thr_cord *cord;
  int n;
  thr_symmetry_record record;
  bool tied[MOST_NODES];
  ck_assert_int_eq(thr_cover_cords(q, o, c, &cord, &n, &record, NULL), THR_OK);
  ck_assert_int_eq(thr_junction_tied(q->f, cord, n, o->ends == THR_ENDS_CLOSED, tied, NULL), THR_OK);
  for (int v = 0; v < q->f->n_nodes; v++)
    ck_assert_msg(tied[v], "ends %s, order %d: node %d", thr_ends_name(o->ends), q->h->order, v);
  thr_cords_destroy(cord, n);
  thr_symmetry_record_destroy(&record);
}

static void compare_with_exhaustion(const example *t, const thr_frame *f, const thr_group *g, const thr_subgroup *h,
                                    const thr_cover_options *o, tally *n)
{
  static exhaustive x;
  thr_quotient q;
  thr_cover c;
  thr_err err = {0};
  exhaustive_init(&x, f, g, h, o);
  if (!exhaust(&x)) return;
  ck_assert_int_eq(thr_quotient_init(&q, f, g, h, 10000, NULL), THR_OK);
  thr_limits limits = {.deadline = thr_clock() + 20};
  thr_status st = thr_cover_find(&q, o, &limits, &c, &err);
  ck_assert(st || !o->edge_capacity || passes_of(&q, &c) <= most_passes(&x));
  if (!st && passes_of(&q, &c) > most_passes(&x)) { /* beyond what was tried */
    ck_assert(!x.found || c.value[THR_AIM_OVERLAP] < x.best[THR_AIM_OVERLAP] + 1e-6);
    n->beyond++;
    goto done;
  }
  ck_assert_msg(st == (x.found ? THR_OK : THR_EINFEASIBLE),
                "%s, order %d, ends %s, cover %d, capacity %d: status %d (%s), found %d", t->name, h->order,
                thr_ends_name(o->ends), o->cover, o->edge_capacity ? o->edge_capacity[0] : 0, st, err.text, x.found);
  for (int a = 0; a < THR_N_AIMS && !st; a++)
    ck_assert_msg(fabs(c.value[a] - x.best[a]) < 1e-4 && fabs(c.bound[a] - c.value[a]) < 1e-4,
                  "%s, order %d, ends %s, cover %d%s: %s %g, bound %g, by exhaustion %g", t->name, h->order,
                  thr_ends_name(o->ends), o->cover, o->tube ? ", tied" : "", thr_aim_name(a), c.value[a], c.bound[a], x.best[a]);
  if (!st && o->tube) check_ties(&q, o, &c);
  if (!st) {
    check_turning_bounds(&q, o, &c, false, n);
    check_turning_bounds(&q, o, &c, true, n);
    check_stopped(&q, o, x.best);
    check_claims(&q, o, &c, x.turning, n);
  }
  n->compared++;
done:
  thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
}

START_TEST(covers_match_exhaustion)
{
  const example *t = &examples[_i];
  tally n = {0};
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    static const int nowhere = -1;
    thr_frame f = frame_from(t->n, t->m, t->edge, ends == THR_ENDS_FEET ? t->feet : &nowhere);
    thr_group g = automorphisms_by_hand(&f);
    thr_subgroup_classes classes;
    ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
    for (int k = 0; k < classes.n; k++)
      for (int cover = 1; cover <= 2; cover++) {
        thr_cover_options o = cover_options((thr_ends)ends, cover);
        if (classes.subgroup[k].order <= 48) compare_with_exhaustion(t, &f, &g, &classes.subgroup[k], &o, &n);
      }
    thr_subgroup_classes_destroy(&classes);
    thr_group_destroy(&g);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(n.compared, 10);
  ck_assert_int_le(n.beyond, 40);
  ck_assert_int_ge(2 * n.near, n.bounds); /* of no use otherwise */
  ck_assert_int_ge(4 * n.exact, n.compared - n.repeats);
}
END_TEST

/* Tube joints, with and without a limit on passes: the same comparison. */
START_TEST(tied_covers_match_exhaustion)
{
  const example *t = &examples[_i];
  tally n = {0};
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    static const int nowhere = -1;
    int capacity[MOST_ORBITS];
    thr_frame f = frame_from(t->n, t->m, t->edge, ends == THR_ENDS_FEET ? t->feet : &nowhere);
    thr_group g = automorphisms_by_hand(&f);
    thr_subgroup_classes classes;
    ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
    for (int k = 0; k < classes.n; k++)
      for (int most = 2; most <= 4; most += 2) {
        thr_cover_options o = cover_options((thr_ends)ends, 1);
        o.tube = true;
        if (most == 2) o.edge_capacity = capacity;
        for (int e = 0; e < f.n_edges; e++)
          capacity[e] = most;
        if (classes.subgroup[k].order <= 48) compare_with_exhaustion(t, &f, &g, &classes.subgroup[k], &o, &n);
      }
    thr_subgroup_classes_destroy(&classes);
    thr_group_destroy(&g);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(n.compared, 10);
}
END_TEST

/* Capacities, and edges that need more passes than others: the same comparison. */
START_TEST(capacities_match_exhaustion)
{
  const example *t = &examples[_i];
  tally n = {0};
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    static const int nowhere = -1;
    int needed[MOST_ORBITS], capacity[MOST_ORBITS];
    thr_frame f = frame_from(t->n, t->m, t->edge, ends == THR_ENDS_FEET ? t->feet : &nowhere);
    thr_group g = automorphisms_by_hand(&f);
    thr_subgroup_classes classes;
    ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
    for (int k = 0; k < classes.n; k++)
      for (int most = 1; most <= 3; most++) {
        thr_cover_options o = cover_options((thr_ends)ends, 1);
        o.edge_cover = needed;
        o.edge_capacity = capacity;
        for (int e = 0; e < f.n_edges; e++) {
          needed[e] = 1;
          capacity[e] = most;
        }
        if (classes.subgroup[k].order <= 48) compare_with_exhaustion(t, &f, &g, &classes.subgroup[k], &o, &n);
      }
    thr_subgroup_classes_destroy(&classes);
    thr_group_destroy(&g);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(n.compared, 10);
  ck_assert_int_eq(n.beyond, 0);
}
END_TEST

/* At most so many cords: the bounds of the limited cover hold, and what is made of it keeps to the number; where it is said to be
 * optimal it is. */
static void compare_cords(const example *t, const thr_frame *f, const thr_group *g, const thr_subgroup *h, thr_ends ends,
                          int cords, tally *n)
{
  static exhaustive x;
  thr_cover_options o = cover_options(ends, 1);
  thr_request asked = options_for(ends, 1);
  const thr_limits limits = {.deadline = thr_clock() + 20};
  thr_quotient q;
  thr_cover c;
  thr_cord *cord = NULL;
  thr_symmetry_record record = {0};
  int n_cords = 0;
  bool kept = false;
  asked.aims = thr_aims_symmetric;
  asked.symmetry.counted = true;
  asked.cords = cords;
  exhaustive_init(&x, f, g, h, &o);
  x.most_cords = cords;
  bool known = exhaust(&x);
  o.most_ends = 2 * cords;
  ck_assert_int_eq(thr_quotient_init(&q, f, g, h, 10000, NULL), THR_OK);
  thr_status st = known ? thr_cover_find(&q, &o, &limits, &c, NULL) : THR_ELIMIT;
  if (!st) st = thr_keep_cords(&q, &o, &asked, &limits, &c, &cord, &n_cords, &record, &kept, NULL);
  const bool beyond = !st && passes_of(&q, &c) > most_passes(&x);
  if (known && st) ck_assert_msg(!x.found, "%s, order %d, %d cords: there are some", t->name, h->order, cords);
  if (known && !st && !beyond) {
    const double worth[] = {c.value[THR_AIM_OVERLAP], record.steps, record.unique_paths};
    ck_assert_msg(!x.found || c.bound[THR_AIM_OVERLAP] <= x.best[THR_AIM_OVERLAP] + 1e-4, "%s, order %d, %d cords: bound %g, %g",
                  t->name, h->order, cords, c.bound[THR_AIM_OVERLAP], x.best[THR_AIM_OVERLAP]);
    ck_assert(!kept || (x.found && n_cords <= cords));
    for (int a = 0; a < 3 && kept && c.optimal; a++)
      ck_assert_msg(fabs(worth[a] - x.best[a]) < 1e-4, "%s, order %d, ends %s, %d cords: %s %g, by exhaustion %g", t->name,
                    h->order, thr_ends_name(ends), cords, thr_aim_name((thr_aim)a), worth[a], x.best[a]);
    n->compared++;
    n->near += kept;
    n->bounds += x.found;
  }
  n->beyond += beyond;
  if (known && !st) thr_symmetry_record_destroy(&record);
  if (known && !st) thr_cords_destroy(cord, n_cords);
  if (known) thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
}

/* Fewer ends than a cover without a limit may have: the same comparison, and that of cords. */
START_TEST(limited_ends_match_exhaustion)
{
  const example *t = &examples[_i];
  tally n = {0}, cords = {0};
  for (int ends = THR_ENDS_ANY; ends <= THR_ENDS_FEET; ends++) {
    static const int nowhere = -1;
    thr_frame f = frame_from(t->n, t->m, t->edge, ends == THR_ENDS_FEET ? t->feet : &nowhere);
    thr_group g = automorphisms_by_hand(&f);
    thr_subgroup_classes classes;
    ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
    for (int k = 0; k < classes.n; k++)
      for (int most = 1; most <= 2; most++) {
        thr_cover_options o = cover_options((thr_ends)ends, 1);
        o.most_ends = 2 * most;
        if (classes.subgroup[k].order > 48) continue;
        if (most == 1 && ends == THR_ENDS_ANY) compare_with_exhaustion(t, &f, &g, &classes.subgroup[k], &o, &n);
        compare_cords(t, &f, &g, &classes.subgroup[k], (thr_ends)ends, most, &cords);
      }
    thr_subgroup_classes_destroy(&classes);
    thr_group_destroy(&g);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(n.compared, 2);
  ck_assert_int_ge(cords.compared, 4);
  ck_assert_msg(2 * cords.near >= cords.bounds, "%s: %d of %d", t->name, cords.near, cords.bounds);
}
END_TEST

/* Every other edge of a square twice, under all groups that keep those edges. */
START_TEST(covers_by_edge)
{
  thr_frame f = frame_from(4, 4, (const int[][2]){{0, 1}, {1, 2}, {2, 3}, {3, 0}}, &(int){-1});
  thr_group g = automorphisms_by_hand(&f);
  thr_subgroup_classes classes;
  int needed[] = {2, 1, 2, 1}, capacity[] = {2, 3, 2, 3}, asked = 0;
  ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
  for (int k = 0; k < classes.n; k++) {
    thr_cover_options o = cover_options(THR_ENDS_CLOSED, 1);
    o.edge_cover = needed;
    o.edge_capacity = capacity;
    const thr_limits limits = {.deadline = thr_clock() + 20};
    thr_quotient q;
    thr_cover c;
    thr_err err;
    ck_assert_int_eq(thr_quotient_init(&q, &f, &g, &classes.subgroup[k], 10000, NULL), THR_OK);
    bool keeps = q.edge_orbit[0] != q.edge_orbit[1] && q.edge_orbit[0] != q.edge_orbit[3] && q.edge_orbit[2] != q.edge_orbit[1] &&
                 q.edge_orbit[2] != q.edge_orbit[3];
    thr_status st = thr_cover_find(&q, &o, &limits, &c, &err);
    /* closed cords go round the square: as often over every edge */
    ck_assert_msg(st == (keeps ? THR_OK : THR_EINPUT), "status %d, %s", st, err.text);
    if (!st) ck_assert_double_eq_tol(c.value[THR_AIM_OVERLAP], f.length[1] + f.length[3], 1e-6);
    asked += !st;
    thr_cover_destroy(&c);
    thr_quotient_destroy(&q);
  }
  ck_assert_int_ge(asked, 3);
  thr_subgroup_classes_destroy(&classes);
  thr_group_destroy(&g);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- published figures ---- */

static thr_frame made(thr_shape shape, int size)
{
  thr_make_options o = thr_make_options_default(shape);
  thr_draft d = {0};
  thr_frame f;
  thr_read_report report;
  o.size = size;
  ck_assert_int_eq(thr_make(&d, &o, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &report, NULL), THR_OK);
  thr_draft_destroy(&d);
  return f;
}

/* Rings of n nodes, each ring turned by half a step, with diagonals only; the lowest are the feet. */
static thr_frame diagonal_tube(int n, int rings)
{
  thr_draft d = {0};
  thr_frame f;
  thr_read_report report;
  for (int r = 0; r < rings; r++)
    for (int i = 0; i < n; i++) {
      double angle = 2 * acos(-1) * (i + 0.5 * r) / n, xyz[3] = {cos(angle), sin(angle), 0.3 * r};
      ck_assert_int_eq(thr_draft_add_node(&d, xyz, NULL, r == 0, NULL), THR_OK);
    }
  for (int r = 0; r + 1 < rings; r++)
    for (int i = 0; i < n; i++) {
      ck_assert_int_eq(thr_draft_add_edge(&d, r * n + i, (r + 1) * n + i, 0, NULL), THR_OK);
      ck_assert_int_eq(thr_draft_add_edge(&d, r * n + i, (r + 1) * n + (i + n - 1) % n, 0, NULL), THR_OK);
    }
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &report, NULL), THR_OK);
  thr_draft_destroy(&d);
  return f;
}

typedef struct {
  int order;
  const char *group; /* NULL: any of that order */
  thr_ends ends;
  int cover;
  double overlap, steps; /* per cent; learned */
  int paths;
} row;

/* Is the figure reached by one of the classes of subgroups of this order and name, and proved? */
static void expect(thr_frame f, const row *list, int n)
{
  thr_automorphism_options plain = {0};
  thr_automorphisms a;
  thr_group g;
  thr_subgroup_classes classes;
  ck_assert_int_eq(thr_automorphisms_find(&f, &plain, &a, NULL), THR_OK);
  ck_assert_int_eq(thr_group_generate(f.n_nodes, a.generator, a.n_generators, THR_GROUP_CAP, &g, NULL), THR_OK);
  ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
  for (int i = 0; i < n; i++) {
    bool hit = false;
    for (int k = 0; k < classes.n && !hit; k++) {
      const thr_subgroup *h = &classes.subgroup[k];
      thr_isometry *element = thr_calloc((size_t)h->order, sizeof *element);
      char name[16];
      for (int x = 0; x < h->order; x++)
        thr_isometry_of(&f, &g.image[h->element[x] * g.degree], 0.01, &element[x]);
      thr_point_group_name(element, h->order, name);
      free(element);
      if (h->order != list[i].order || (list[i].group && strcmp(name, list[i].group) != 0)) continue;
      thr_cover_options o = cover_options(list[i].ends, list[i].cover);
      thr_limits limits = {.deadline = thr_clock() + 60};
      thr_quotient q;
      thr_cover c;
      ck_assert_int_eq(thr_quotient_init(&q, &f, &g, h, 100000, NULL), THR_OK);
      ck_assert_int_eq(thr_cover_find(&q, &o, &limits, &c, NULL), THR_OK);
      double overlap = 100 * c.value[THR_AIM_OVERLAP] / (o.cover * thr_frame_total_length(&f));
      hit = fabs(overlap - list[i].overlap) < 0.1 && fabs(c.value[THR_AIM_STEPS] - list[i].steps) < 1e-9 &&
            fabs(c.value[THR_AIM_PATHS] - list[i].paths) < 1e-9 && c.optimal;
      thr_cover_destroy(&c);
      thr_quotient_destroy(&q);
    }
    ck_assert_msg(hit, "order %d %s: no overlap of %g %% with %g steps in %d paths", list[i].order,
                  list[i].group ? list[i].group : "", list[i].overlap, list[i].steps, list[i].paths);
  }
  thr_subgroup_classes_destroy(&classes);
  thr_group_destroy(&g);
  thr_automorphisms_destroy(&a);
  thr_frame_destroy(&f);
}

#define EXPECT(frame, ...) expect(frame, (const row[]){__VA_ARGS__}, (int)(sizeof((const row[]){__VA_ARGS__}) / sizeof(row)))

START_TEST(domes)
{
  EXPECT(made(THR_MAKE_DOME, 6), {4, "C2v", THR_ENDS_FEET, 1, 13.0, 17, 1}, {4, "C4", THR_ENDS_FEET, 1, 13.0, 17, 1},
         {8, "C4v", THR_ENDS_FEET, 1, 20.3, 9, 2});
  EXPECT(made(THR_MAKE_DOME, 8), {8, "C4v", THR_ENDS_FEET, 2, 0, 28, 1});
  EXPECT(made(THR_MAKE_DOME, 20), {4, "C4", THR_ENDS_FEET, 1, 4.7, 199, 1});
  EXPECT(diagonal_tube(12, 7), {24, "C12v", THR_ENDS_FEET, 1, 0, 6, 1});
}
END_TEST

START_TEST(solids)
{
  EXPECT(solid_make(CUBE), {48, "Oh", THR_ENDS_CLOSED, 1, 100, 0.5, 1}, {16, NULL, THR_ENDS_CLOSED, 1, 33.33, 1, 1});
  EXPECT(truncated_icosahedron(), {120, "Ih", THR_ENDS_CLOSED, 1, 33.33, 1, 1});
  EXPECT(made(THR_MAKE_SPHERE, 3), {12, "T", THR_ENDS_CLOSED, 1, 6.2, 24, 1}, {60, "I", THR_ENDS_CLOSED, 1, 30.9, 6, 1});
}
END_TEST

START_TEST(large_sphere)
{
  EXPECT(made(THR_MAKE_SPHERE, 6), {12, "T", THR_ENDS_CLOSED, 1, 3.07, 93, 1});
}
END_TEST

/* Without symmetry the overlap is that of Route Inspection: least extra cord by matching odd nodes. */
START_TEST(trivial_group_is_route_inspection)
{
  rng r = rng_make(31);
  for (int i = 0; i < 60; i++) {
    thr_frame f = random_frame(&r, rng_between(&r, 4, 16), rng_between(&r, 0, 14), (length_kind)(i % LENGTH_KINDS));
    thr_request plan = options_for(THR_ENDS_CLOSED, 1 + i % 2);
    thr_cover_options o = {
        .cover = plan.cover, .ends = THR_ENDS_CLOSED, .prefer = {THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_STEPS, THR_AIM_TURNING}};
    thr_limits limits = {.deadline = thr_clock() + 2};
    thr_group g;
    thr_quotient q;
    thr_cover c;
    int one = 0;
    thr_subgroup trivial = {1, &one};
    ck_assert_int_eq(thr_group_generate(f.n_nodes, NULL, 0, 1, &g, NULL), THR_OK);
    ck_assert_int_eq(thr_quotient_init(&q, &f, &g, &trivial, 10000, NULL), THR_OK);
    thr_status st = thr_cover_find(&q, &o, &limits, &c, NULL);
    double extra = least_extra_by_matching(&f, &plan);
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    ck_assert_double_eq_tol(c.value[THR_AIM_OVERLAP], extra, 1e-5 * (1 + extra));
    ck_assert_double_eq_tol(c.bound[THR_AIM_OVERLAP], extra, 1e-5 * (1 + extra));
    ck_assert_double_eq_tol(c.value[THR_AIM_PATHS], 1, 1e-9);
    thr_cover_destroy(&c);
    thr_quotient_destroy(&q);
    thr_group_destroy(&g);
    thr_frame_destroy(&f);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("cover");
  ADD_EXAMPLES(s, 120, covers_match_exhaustion, EXAMPLES);
  ADD_EXAMPLES(s, 120, capacities_match_exhaustion, EXAMPLES);
  ADD_EXAMPLES(s, 240, tied_covers_match_exhaustion, EXAMPLES);
  ADD_EXAMPLES(s, 240, limited_ends_match_exhaustion, EXAMPLES);
  ADD_TEST(s, 20, covers_by_edge);
  ADD_TEST(s, 60, domes);
  ADD_TEST(s, 60, solids);
  ADD_LARGE(s, 120, large_sphere, 0, 1);
  ADD_TEST(s, 60, trivial_group_is_route_inspection);
  return run_suite(s);
}
