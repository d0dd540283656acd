/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least longest of several cords that pass few edges each, without a proof: all sets of edges
 * that a cord below a limit passes are looked at. Private to the checker and the planner.
 *
 *   States are (set passed so far, node); Dijkstra's method settles them by length, and goes on
 * only where the way back, or to an end, stays below the limit. Few are left where a cord passes
 * some dozen edges of a framework whose nodes have three or four. Whether K cords below a limit do
 * is decided by depth first search: the next one passes the edge that is lacking and in the fewest
 * sets; sets that are part of others are left out, and what failed before. What is lacking cannot
 * be passed by j cords
 *   - where it weighs more than j times the heaviest set, for weights of the edges that make many
 * cords (any would be right), and
 *   - where its length, and what its odd nodes add (half of the shortest edge there, but for 2 j of
 * them if cords may end there: half an edge from either side are odd cuts), is more than j times
 * the limit. A table over the sets of few edges (graph/check/few_edges.c) has no limit on the
 * cords; this one has none on the framework.
 *
 * Example: four closed cords through robarch_tree_S, 45 edges of three at a node: 37,260 sets of at
 * most 780 mm, none of which four pass all. Least length over four is 741.5. */
#include "graph/check/edge_sets.h"
#include "graph/sort.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { NONE = -1, PLACES = 2 * THR_SHORT_STATES, LOOK = 1024 };

static bool holds(thr_edge_set set, int e)
{
  return set >> e & 1u;
}

static thr_edge_set edge_set(int e)
{
  return (thr_edge_set)1 << e;
}

static int count_edges(thr_edge_set set)
{
  int n = 0;
  for (; set != 0; set &= set - 1)
    n++;
  return n;
}

static size_t place_of(thr_edge_set set, int node)
{
  uint64_t low = (uint64_t)set + (uint64_t)node, high = (uint64_t)(set >> 64);
  low = (low ^ low >> 29) * UINT64_C(0xBF58476D1CE4E5B9) + high * UINT64_C(0x9E3779B97F4A7C15);
  return (size_t)((low ^ low >> 32) % PLACES);
}

/* ---- all sets ---- */

/* Cords from one node, closed, through nodes from there on; or open ones from all ends. */
typedef struct {
  thr_short_cords *out;
  bool closed;
  int first;           /* closed: where they begin */
  int n_before;        /* states of runs before */
  double *back;        /* [n_nodes] length of the way to where a cord may end */
  int *place;          /* [PLACES] states; those of runs before stand for empty places */
  int *in_sets;        /* [PLACES] sets */
  int n_queue, *queue; /* [THR_SHORT_STATES] a heap of states */
  bool full;
} walker;

static bool ends_at(const walker *x, int v)
{
  return x->closed ? v == x->first : thr_plan_end_allowed(x->out->f, x->out->o, v);
}

/* By Bellman's iteration: there are few nodes. */
static void find_ways_back(walker *x)
{
  const thr_frame *frame = x->out->f;
  bool changed = true;
  for (int v = 0; v < frame->n_nodes; v++)
    x->back[v] = ends_at(x, v) ? 0 : INFINITY;
  while (changed) {
    changed = false;
    for (int h = 0; h < 2 * frame->n_edges; h++) {
      const int v = thr_tail(frame, h);
      const double length = x->back[thr_head(frame, h)] + frame->length[h >> 1];
      if (v < x->first || length >= x->back[v]) continue;
      x->back[v] = length;
      changed = true;
    }
  }
}

static void put(walker *x, int i, int state)
{
  x->queue[i] = state;
  x->out->state[state].at = i;
}

static void rise(walker *x, int i)
{
  const thr_short_state *state = x->out->state;
  const int s = x->queue[i];
  for (; i > 0 && state[s].length < state[x->queue[(i - 1) / 2]].length; i = (i - 1) / 2)
    put(x, i, x->queue[(i - 1) / 2]);
  put(x, i, s);
}

static int take_shortest(walker *x)
{
  const thr_short_state *state = x->out->state;
  const int top = x->queue[0], last = x->queue[--x->n_queue];
  int i = 0;
  for (int child; (child = 2 * i + 1) < x->n_queue; i = child) {
    if (child + 1 < x->n_queue && state[x->queue[child + 1]].length < state[x->queue[child]].length)
      child++;
    if (state[last].length <= state[x->queue[child]].length) break;
    put(x, i, x->queue[child]);
  }
  put(x, i, last);
  x->out->state[top].at = NONE;
  return top;
}

/* A walk with this set is here, so long. */
static void reach(walker *x, thr_edge_set set, int node, double length, int from, int half)
{
  thr_short_cords *out = x->out;
  size_t at = place_of(set, node);
  if (length + x->back[node] > out->limit) return;
  for (; x->place[at] >= x->n_before; at = (at + 1) % PLACES) {
    thr_short_state *known = &out->state[x->place[at]];
    if (known->set != set || known->node != node) continue;
    if (length >= known->length) return;
    *known = (thr_short_state){set, length, node, from, half, known->at};
    rise(x, known->at);
    return;
  }
  if ((x->full |= out->n_states == THR_SHORT_STATES)) return;
  x->place[at] = out->n_states;
  out->state[out->n_states] = (thr_short_state){set, length, node, from, half, x->n_queue};
  x->queue[x->n_queue++] = out->n_states++;
  rise(x, x->n_queue - 1);
}

/* A cord may end here. */
static void note_set(walker *x, int s)
{
  thr_short_cords *out = x->out;
  const thr_short_state *state = &out->state[s];
  size_t at = place_of(state->set, 0);
  while (x->in_sets[at] != NONE && out->set[x->in_sets[at]].set != state->set)
    at = (at + 1) % PLACES;
  thr_short_set *set = &out->set[x->in_sets[at] == NONE ? out->n : x->in_sets[at]];
  if (x->in_sets[at] == NONE)
    x->in_sets[at] = out->n++;
  else if (set->length <= state->length)
    return;
  *set = (thr_short_set){state->set, state->length, s};
}

static void walk_on(walker *x)
{
  thr_short_cords *out = x->out;
  const thr_frame *frame = out->f;
  while (x->n_queue > 0 && !x->full) {
    const int s = take_shortest(x);
    x->full |= s % LOOK == 0 && out->limits && thr_limits_stop(out->limits);
    const thr_short_state here = out->state[s];
    if (here.set != 0 && ends_at(x, here.node)) note_set(x, s);
    for (int i = frame->first[here.node]; i < frame->first[here.node + 1]; i++) {
      const int half = frame->half[i], to = thr_head(frame, half);
      if (to >= x->first)
        reach(x, here.set | edge_set(half >> 1), to, here.length + frame->length[half >> 1], s,
              half);
    }
  }
}

static void find_sets(walker *x)
{
  thr_short_cords *out = x->out;
  for (size_t i = 0; i < PLACES; i++)
    x->place[i] = x->in_sets[i] = NONE;
  const int runs = x->closed ? out->f->n_nodes : 1;
  for (int run = 0; run < runs && !x->full; run++) {
    x->first = x->closed ? run : 0;
    x->n_before = out->n_states;
    find_ways_back(x);
    for (int v = 0; v < out->f->n_nodes; v++)
      if (ends_at(x, v)) reach(x, 0, v, 0, NONE, NONE);
    walk_on(x);
  }
  if (x->full) out->n = 0;
}

static thr_status is_asked(const thr_frame *frame, const thr_request *options, bool *asked,
                           thr_err *err)
{
  int n = 0, *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  thr_status st = component ? thr_frame_components(frame, component, &n, err) : thr_nomem(err);
  free(component);
  *asked = n == 1 && frame->n_edges <= THR_SHORT_EDGES && options->joint == THR_JOINT_SOLID &&
           options->ends != THR_ENDS_COUNTS;
  return st;
}

thr_status thr_short_cords_init(thr_short_cords *cords, const thr_frame *frame,
                                const thr_request *options, double limit, const thr_limits *limits,
                                thr_err *err)
{
  walker x = {.out = cords, .closed = options->ends == THR_ENDS_CLOSED};
  thr_scratch own = {0};
  bool asked;
  *cords = (thr_short_cords){.f = frame, .o = options, .limits = limits, .limit = limit};
  thr_status st = is_asked(frame, options, &asked, err);
  if (st || !asked) return st;
  cords->set = thr_scratch_array(&cords->own, THR_SHORT_STATES, sizeof *cords->set);
  cords->state = thr_scratch_array(&cords->own, THR_SHORT_STATES, sizeof *cords->state);
  x.back = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *x.back);
  x.place = thr_scratch_array(&own, PLACES, sizeof *x.place);
  x.in_sets = thr_scratch_array(&own, PLACES, sizeof *x.in_sets);
  x.queue = thr_scratch_array(&own, THR_SHORT_STATES, sizeof *x.queue);
  st = thr_scratch_check(&cords->own, err);
  if (!st) st = thr_scratch_check(&own, err);
  if (!st) find_sets(&x);
  thr_scratch_free(&own);
  return st;
}

void thr_short_cords_destroy(thr_short_cords *cords)
{
  thr_scratch_free(&cords->own);
  cords->n = 0;
}

thr_status thr_short_cords_walk(const thr_short_cords *cords, int i, thr_cord *cord, thr_err *err)
{
  int n = 0;
  for (int s = cords->set[i].state; cords->state[s].from != NONE; s = cords->state[s].from)
    n++;
  *cord = (thr_cord){.n_passes = n, .half = thr_calloc((size_t)n, sizeof *cord->half)};
  if (!cord->half) return thr_nomem(err);
  for (int s = cords->set[i].state; n > 0; s = cords->state[s].from)
    cord->half[--n] = cords->state[s].half;
  cord->closed = thr_cord_start(cords->f, cord) == thr_cord_end(cords->f, cord);
  return THR_OK;
}

/* ---- are so many enough? ---- */

/* What is looked at, for one limit and for all; what is not decided then stays open. */
static const double most_work = 1 << 23, most_in_all = 1 << 25;

typedef struct {
  thr_edge_set set;
  int count; /* edges */
} counted;

/* What so many cords cannot pass; cords 0: an empty place. */
typedef struct {
  thr_edge_set lacking;
  int cords;
} failure;

typedef struct {
  int set, next; /* NONE: the list ends */
} link;

typedef struct {
  const thr_short_cords *all;
  const thr_frame *f;
  bool closed;
  double limit, work, in_all;
  double *half;  /* [n_nodes] of the shortest edge there: what an odd node adds */
  double *odd;   /* [n_nodes] */
  int *degree;   /* [n_nodes] */
  int n_most;    /* sets below the limit that are part of no other */
  counted *most; /* [all->n] */
  link *link;    /* lists of the sets that hold an edge */
  int last[THR_SHORT_EDGES],
      holders[THR_SHORT_EDGES]; /* of an edge: the last one of its list, and their number */
  int64_t weight[THR_SHORT_EDGES / 8][256], heaviest; /* of eight edges at a time */
  counted *next;   /* [room] the sets that are tried, of one cord after the other */
  failure *failed; /* [PLACES] */
  int n_failed;
  thr_edge_set *chosen;   /* [cords] the last cord first */
  thr_scratch own, tried; /* tried: what is for one limit */
} decision;

static int more_first(const void *pa, const void *pb)
{
  const counted *a = pa, *b = pb;
  if (a->count != b->count) return b->count - a->count;
  return a->set < b->set ? -1 : a->set > b->set;
}

/* Leaves out what is part of another. */
static int keep_largest(decision *x, counted *list, int n)
{
  int kept = 0;
  qsort(list, (size_t)n, sizeof *list, more_first);
  for (int i = 0; i < n; i++) {
    bool part = false;
    int k = 0;
    for (; k < kept && !part; k++)
      part = (list[i].set & ~list[k].set) == 0;
    x->work += k;
    if (!part) list[kept++] = list[i];
  }
  return kept;
}

/* The set joins the lists of its edges. */
static void add_most(decision *x, int i, int *n_links)
{
  for (int e = 0; e < x->f->n_edges; e++) {
    if (!holds(x->most[i].set, e)) continue;
    x->link[*n_links] = (link){i, x->last[e]};
    x->last[e] = (*n_links)++;
    x->holders[e]++;
  }
}

/* Of the edges of a set, which is not empty, one that is in the fewest sets. */
static int rarest_edge(const decision *x, thr_edge_set set)
{
  int best = NONE;
  for (int e = 0; e < x->f->n_edges; e++)
    if (holds(set, e) && (best == NONE || x->holders[e] < x->holders[best])) best = e;
  return best;
}

static thr_status list_most(decision *x, thr_err *err)
{
  const int m = x->f->n_edges;
  size_t n_all = 0, n = 0;
  int n_links = 0;
  for (int i = 0; i < x->all->n; i++) {
    if (x->all->set[i].length > x->limit) continue;
    x->most[n] = (counted){x->all->set[i].set, count_edges(x->all->set[i].set)};
    n_all += (size_t)x->most[n++].count;
  }
  if (!(x->link = thr_scratch_array(&x->tried, n_all + 1, sizeof *x->link))) return thr_nomem(err);
  qsort(x->most, n, sizeof *x->most, more_first);
  for (int e = 0; e < m; e++) {
    x->holders[e] = 0;
    x->last[e] = NONE;
  }
  x->n_most = 0;
  for (size_t i = 0; i < n; i++) {
    const counted set = x->most[i];
    int k = x->last[rarest_edge(x, set.set)];
    while (k != NONE && (set.set & ~x->most[x->link[k].set].set) != 0)
      k = x->link[k].next;
    if (k != NONE) continue; /* part of another */
    x->most[x->n_most] = set;
    add_most(x, x->n_most++, &n_links);
  }
  return THR_OK;
}

static int64_t weight_of(const decision *x, thr_edge_set set)
{
  int64_t sum = 0;
  for (int i = 0; set != 0; i++, set >>= 8)
    sum += x->weight[i][(unsigned)set & 255];
  return sum;
}

static void set_weights(decision *x, const int64_t *weight)
{
  for (int i = 0; 8 * i < x->f->n_edges; i++)
    for (unsigned k = 1; k < 256; k++) {
      int bit = 0;
      while (!(k >> bit & 1u))
        bit++;
      x->weight[i][k] = x->weight[i][k & (k - 1)] + weight[8 * i + bit];
    }
}

/* Edges of the heaviest set get lighter, again and again (S. Plotkin, D. Shmoys & E. Tardos 1995).
 */
static void weigh(decision *x, thr_edge_set needed)
{
  enum { ROUNDS = 400, LOOKS = 1 << 22, FIRST = 1 << 30, PART = 32 };
  const int looks = LOOKS / (x->n_most + 1), rounds = looks < ROUNDS ? looks : ROUNDS;
  int64_t weight[THR_SHORT_EDGES] = {0}, kept[THR_SHORT_EDGES];
  double best = -1;
  for (int e = 0; e < x->f->n_edges; e++)
    weight[e] = holds(needed, e) ? FIRST : 0;
  for (int round = 0; round <= rounds; round++) {
    int64_t most = 0;
    thr_edge_set heaviest = 0;
    set_weights(x, weight);
    for (int i = 0; i < x->n_most; i++) {
      const int64_t sum = weight_of(x, x->most[i].set);
      if (sum <= most) continue;
      most = sum;
      heaviest = x->most[i].set;
    }
    const double cords = most > 0 ? (double)weight_of(x, needed) / (double)most : 0;
    if (cords > best) {
      best = cords;
      x->heaviest = most;
      memcpy(kept, weight, sizeof kept);
    }
    for (int e = 0; e < x->f->n_edges; e++)
      if (holds(heaviest, e)) weight[e] -= weight[e] / PART;
  }
  set_weights(x, kept);
}

/* No so many cords over these edges are shorter together. */
static double least_length(const decision *x, thr_edge_set lacking, int cords)
{
  const thr_frame *frame = x->f;
  double sum = 0;
  int n = 0;
  memset(x->degree, 0, (size_t)frame->n_nodes * sizeof *x->degree);
  for (int e = 0; e < frame->n_edges; e++) {
    if (!holds(lacking, e)) continue;
    sum += frame->length[e];
    x->degree[frame->edge[e][0]]++;
    x->degree[frame->edge[e][1]]++;
  }
  for (int v = 0; v < frame->n_nodes; v++) {
    if (x->degree[v] % 2 == 0) continue;
    if (!x->closed && thr_plan_end_allowed(frame, x->all->o, v))
      x->odd[n++] = x->half[v];
    else
      sum += x->half[v];
  }
  thr_sort_doubles(x->odd, (size_t)n);
  for (int i = 0; i < n - 2 * cords; i++)
    sum += x->odd[i];
  return sum;
}

static bool is_too_much(decision *x, thr_edge_set lacking, int cords)
{
  x->work++;
  if (weight_of(x, lacking) > cords * x->heaviest) return true;
  x->work += x->f->n_edges;
  return least_length(x, lacking, cords) > cords * x->limit * (1 + 1e-9);
}

/* Where this is known to fail, or would be noted. */
static failure *find_failure(const decision *x, thr_edge_set lacking)
{
  size_t at = place_of(lacking, 0);
  while (x->failed[at].cords > 0 && x->failed[at].lacking != lacking)
    at = (at + 1) % PLACES;
  return &x->failed[at];
}

/* The sets of the lacking edges, one of which is in the fewest, that a cord may pass and leave not
 * too much to so many others. */
static int list_next(decision *x, thr_edge_set lacking, int others, counted *next)
{
  int n = 0;
  for (int k = x->last[rarest_edge(x, lacking)]; k != NONE; k = x->link[k].next) {
    const thr_edge_set set = x->most[x->link[k].set].set & lacking;
    if (others == 0 ? set == lacking : !is_too_much(x, lacking & ~set, others))
      next[n++] = (counted){set, count_edges(set)};
  }
  return keep_largest(x, next, n);
}

/* Do so many cords pass what is lacking? False also where that is too much work. next: room for the
 * sets that are tried. */
static bool suffice(decision *x, thr_edge_set lacking, int cords, counted *next)
{
  if (lacking == 0) {
    memset(x->chosen, 0, (size_t)cords * sizeof *x->chosen);
    return true;
  }
  if (cords == 0 || find_failure(x, lacking)->cords >= cords) return false;
  if (x->all->limits && thr_limits_stop(x->all->limits)) x->work = INFINITY;
  const int n = list_next(x, lacking, cords - 1, next);
  for (int i = 0; i < n && x->work <= most_work; i++) {
    x->chosen[cords - 1] = next[i].set;
    if (suffice(x, lacking & ~next[i].set, cords - 1, next + n)) return true;
  }
  failure *at = find_failure(x, lacking);
  if (x->work <= most_work && (at->cords > 0 || 2 * ++x->n_failed < PLACES))
    *at = (failure){lacking, cords};
  return false;
}

typedef enum { IMPOSSIBLE, POSSIBLE, OPEN } verdict;

static thr_status decide(decision *x, double limit, thr_edge_set needed, int cords, verdict *found,
                         thr_err *err)
{
  *found = OPEN;
  if (x->in_all > most_in_all) return THR_OK;
  x->limit = limit;
  x->work = 0;
  x->n_failed = 0;
  thr_status st = list_most(x, err);
  x->next =
      thr_scratch_array(&x->tried, (size_t)(x->n_most + 1) * (size_t)(cords + 1), sizeof *x->next);
  if (!st) st = thr_scratch_check(&x->tried, err);
  if (!st) {
    weigh(x, needed);
    memset(x->failed, 0, PLACES * sizeof *x->failed);
    const bool enough = !is_too_much(x, needed, cords) && suffice(x, needed, cords, x->next);
    *found = enough ? POSSIBLE : x->work <= most_work ? IMPOSSIBLE : OPEN;
  }
  x->in_all += x->work;
  thr_scratch_free(&x->tried);
  return st;
}

static thr_status decision_init(decision *x, int cords, thr_err *err)
{
  const thr_frame *frame = x->f;
  const size_t n = (size_t)frame->n_nodes;
  x->half = thr_scratch_array(&x->own, n, sizeof *x->half);
  x->odd = thr_scratch_array(&x->own, n, sizeof *x->odd);
  x->degree = thr_scratch_array(&x->own, n, sizeof *x->degree);
  x->most = thr_scratch_array(&x->own, (size_t)x->all->n, sizeof *x->most);
  x->failed = thr_scratch_array(&x->own, PLACES, sizeof *x->failed);
  x->chosen = thr_scratch_array(&x->own, (size_t)cords, sizeof *x->chosen);
  thr_status st = thr_scratch_check(&x->own, err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    x->half[v] = INFINITY;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      x->half[v] = fmin(x->half[v], frame->length[frame->half[i] >> 1] / 2);
  }
  return st;
}

/* Numbers of the shortest sets that hold what was chosen. */
static void number_chosen(const decision *x, int cords, double limit, int *chosen)
{
  for (int k = 0; k < cords; k++) {
    chosen[k] = NONE;
    for (int i = 0; i < x->all->n && x->chosen[k] != 0; i++) {
      const thr_short_set *set = &x->all->set[i];
      if ((x->chosen[k] & ~set->set) != 0 || set->length > limit) continue;
      if (chosen[k] == NONE || set->length < x->all->set[chosen[k]].length) chosen[k] = i;
    }
  }
}

/* Lengths of sets, ascending. */
static thr_status list_lengths(const thr_short_cords *cords, double **value, thr_err *err)
{
  if (!(*value = thr_calloc((size_t)cords->n, sizeof **value))) return thr_nomem(err);
  for (int i = 0; i < cords->n; i++)
    (*value)[i] = cords->set[i].length;
  thr_sort_doubles(*value, (size_t)cords->n);
  return THR_OK;
}

thr_status thr_short_cords_longest(const thr_short_cords *cords, int n, double known, int *chosen,
                                   double *proved, double *found, thr_err *err)
{
  decision x = {.all = cords, .f = cords->f, .closed = cords->o->ends == THR_ENDS_CLOSED};
  double *value = NULL;
  thr_edge_set needed = 0;
  int low = 0, open = cords->n, probe = 0;
  *proved = 0;
  *found = INFINITY;
  if (cords->n == 0) return THR_OK;
  for (int e = 0; e < cords->f->n_edges; e++)
    if (thr_plan_cover(cords->f, cords->o, e) > 0) needed |= edge_set(e);
  for (int k = 0; k < n && chosen; k++)
    chosen[k] = NONE;
  if (n > cords->f->n_edges) n = cords->f->n_edges; /* more cords than edges are no shorter */
  thr_status st = decision_init(&x, n, err);
  if (!st) st = list_lengths(cords, &value, err);
  while (!st && probe < cords->n && value[probe] < known * (1 - 1e-9))
    probe++;
  while (!st && low < open) {
    const int middle = probe > 0 ? probe - 1 : low + (open - low) / 2;
    verdict is;
    probe = 0;
    st = decide(&x, value[middle], needed, n, &is, err);
    if (is == IMPOSSIBLE)
      low = middle + 1;
    else
      open = middle;
    if (st || is != POSSIBLE) continue;
    *found = value[middle];
    if (chosen) number_chosen(&x, n, value[middle], chosen);
  }
  if (!st) *proved = low < cords->n ? value[low] : cords->limit;
  free(value);
  thr_scratch_free(&x.own);
  return st;
}
