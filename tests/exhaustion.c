/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every choice of copies, and of partners for their ends. */
#include "tests/exhaustion.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan_measures.h"
#include "symmetry/cover/cover_parts.h"
#include "tests/plans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- frameworks and their groups ---- */

thr_frame frame_from(int n, int m, const int (*edge)[2], const int *feet)
{
  static const double xyz[MOST_NODES][3] = {{0, 0, 0},  {10, 1, 0}, {3, 9, 1},
                                            {-4, 5, 7}, {2, -6, 3}, {6, 4, -8}};
  return frame_make(n, xyz, m, edge, NULL, feet);
}

thr_group automorphisms_by_hand(const thr_frame *f)
{
  int n = f->n_nodes, count = 0, at[MOST_NODES],
      *list = thr_calloc((size_t)720 * MOST_NODES, sizeof *list);
  thr_group g;
  ck_assert_ptr_nonnull(list);
  for (int i = 0, all = (int)lround(pow(n, n)); i < all; i++) {
    bool good = true;
    for (int v = 0, rest = i; v < n; v++, rest /= n)
      at[v] = rest % n;
    for (int v = 0; v < n && good; v++)
      for (int w = 0; w < v && good; w++)
        good = at[v] != at[w] && (thr_frame_edge_between(f, v, w) < 0) ==
                                     (thr_frame_edge_between(f, at[v], at[w]) < 0);
    for (int v = 0; v < n && good; v++)
      good = f->foot[v] == f->foot[at[v]];
    if (good) memcpy(&list[n * count++], at, (size_t)n * sizeof *at);
  }
  ck_assert_int_eq(thr_group_generate(n, list, count, THR_GROUP_CAP, &g, NULL), THR_OK);
  ck_assert_int_eq(g.order, count);
  free(list);
  return g;
}

/* ---- all covers ---- */

static int half_image(const exhaustive *x, int g, int h)
{
  int a = x->image[g][thr_tail(x->f, h)], b = x->image[g][thr_head(x->f, h)],
      e = thr_frame_edge_between(x->f, a, b);
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

void exhaustive_init(exhaustive *x, const thr_frame *f, const thr_group *g, const thr_subgroup *h,
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
        if (g->product[h->element[i] * g->order + h->element[k]] == h->element[p])
          x->product[i][k] = p;
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
      if (thr_tail(x->f, a) == thr_tail(x->f, b) && root_of(tube, a) != root_of(tube, b))
        return false;
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

/* Gives all images of dart a the images of b (-2: ends) as partners; false if that contradicts
 * itself. Undo by the old partners.
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
    if (b >= 0 && x->half[b] == x->half[a] && x->o->tube) continue;
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
            x->dart_image[g][2 * c + side] =
                2 * to + (x->half[2 * to] != half_image(x, g, x->half[2 * c + side]));
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

int exhaustive_most_passes(const exhaustive *x)
{
  if (x->o->edge_capacity) return x->o->edge_capacity[0];
  return x->o->cover + (x->n_orbits <= 3 && x->n_kinds <= 10 ? 6 : 2);
}

/* All choices of copies with cover .. most_passes passes over every edge. */
static void list_choices(const exhaustive *x, int k, choice *now, const int *passes, choice **list,
                         int *n, int *capacity)
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
  for (int i = 0; left[t->orbit] <= exhaustive_most_passes(x); i++) {
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

bool exhaustive_search(exhaustive *x)
{
  choice *list = NULL, none = {{0}, -x->o->cover * thr_frame_total_length(x->f), 0};
  int n = 0, capacity = 0, passes[MOST_ORBITS] = {0};
  list_choices(x, 0, &none, passes, &list, &n, &capacity);
  if (n > 0) qsort(list, (size_t)n, sizeof *list, by_worth);
  for (int i = 0; i < n && x->leaves <= LEAVES; i++) {
    if (x->found && (list[i].overlap > x->best[0] + 1e-6 || list[i].steps > x->best[1] + 1e-6))
      break;
    make_copies(x, list[i].number);
    if (x->o->tube && !may_tie(x)) continue;
    for (int d = 0; d < 2 * x->n_copies; d++)
      x->partner[d] = -1;
    choose_partners(x, list[i].overlap, list[i].steps);
  }
  free(list);
  return x->leaves <= LEAVES;
}

/* ---- frameworks ---- */

/* K113: two hubs 0 and 1 and their axis, three arms between them. */
const example cover_examples[] = {
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
    {"wheel",
     5,
     8,
     {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {2, 3}, {3, 4}, {4, 1}},
     {1, 2, 3, 4, -1}},
    {"prism",
     6,
     9,
     {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
     {0, 1, 2, 3, 4, 5, -1}},
    {"kite with a tail", 5, 6, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {1, 3}, {2, 4}}, {0, 4, -1}},
    {"K33",
     6,
     9,
     {{0, 3}, {0, 4}, {0, 5}, {1, 3}, {1, 4}, {1, 5}, {2, 3}, {2, 4}, {2, 5}},
     {0, 1, 2, -1}},
};
