/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes how short the longest of K cords can be that pass few edges each. Gives no certificate.
 * Private to the checker and the planner.
 *
 * First, Dijkstra's method lists the sets of edges that one cord within a limit can pass. Its
 * labels are (set of edges passed so far, node), settled by length. A label is dropped if the
 * shortest path from its node to a possible end makes the cord longer than the limit. There are few
 * labels if a cord passes some dozen edges and nodes have three or four.
 *
 * Second, a depth-first search decides whether K of these sets cover all edges. It branches over
 * the sets that hold the uncovered edge with the fewest sets; only maximal sets are tried, and
 * uncovered sets that failed are kept in a hash table. j cords cannot cover a set of edges
 *   - if its weight is more than j times that of the heaviest listed set. Any weights are valid;
 * those used come from the multiplicative updates of S. Plotkin, D. Shmoys & E. Tardos (1995).
 *   - if the length of its edges and half of the shortest edge at each of its odd nodes are
 * together more than j times the limit. (The half edges round a node are an odd cut.) Of the odd
 * nodes where cords may end, the 2 j with the longest halves do not count.
 *
 * The tables in graph/check/few_edges.c limit the number of edges of the framework, but not of a
 * cord; this file limits the edges of a cord.
 *
 * Example: four closed cords through robarch_tree_S (45 edges, three at each node) have 37,260 sets
 * of at most 780 mm, and no four of them cover all edges. A quarter of the least total length is
 * only 741.5 mm. */
#include "graph/check/check_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NONE = -1, SLOTS = 2 * THR_SHORT_STATES, STATES_PER_CHECK = 1024 };

/* Returns whether the set holds edge e. */
static bool holds(thr_edge_set set, int e)
{
  return set >> e & 1u;
}

/* Returns the set that holds edge e alone. */
static thr_edge_set edge_set(int e)
{
  return (thr_edge_set)1 << e;
}

/* Returns the number of edges in the set. */
static int count_edges(thr_edge_set set)
{
  int n = 0;
  for (; set != 0; set &= set - 1)
    n++;
  return n;
}

/* Returns the slot of a hash table where probing for (set, node) begins. */
static size_t slot_of(thr_edge_set set, int node)
{
  uint64_t low = (uint64_t)set + (uint64_t)node, high = (uint64_t)(set >> 64);
  low = (low ^ low >> 29) * UINT64_C(0xBF58476D1CE4E5B9) + high * UINT64_C(0x9E3779B97F4A7C15);
  return (size_t)((low ^ low >> 32) % SLOTS);
}

/* ---- listing the sets of edges of single cords ---- */

/* The search for all sets. Closed cords take one run for each node `first`, which then is the
 * lowest node of the cord; open cords take a single run from all ends. */
typedef struct {
  thr_short_cords *out;
  bool closed;
  int first;               /* closed: the node where cords begin and end; open: 0 */
  int n_before;            /* labels of earlier runs */
  double *distance_to_end; /* [n_nodes] from a node to the nearest one where a cord may end */
  int *state_at;       /* [SLOTS] hash table of labels; one of an earlier run is an empty slot */
  int *set_at;         /* [SLOTS] hash table of the sets found */
  int n_queue, *queue; /* [THR_SHORT_STATES] a binary heap of labels by length */
  bool given_up;       /* there are too many labels, or the limits stopped the search */
} set_search;

/* Returns whether a cord of this run may end at node v. */
static bool ends_at(const set_search *search, int v)
{
  return search->closed ? v == search->first
                        : thr_plan_end_allowed(search->out->f, search->out->o, v);
}

/* Computes the distance from every node to the nearest node where a cord may end. Uses Bellman's
 * iteration, which is enough for so few nodes. */
static void compute_distances_to_ends(set_search *search)
{
  const thr_frame *frame = search->out->f;
  bool changed = true;
  for (int v = 0; v < frame->n_nodes; v++)
    search->distance_to_end[v] = ends_at(search, v) ? 0 : INFINITY;

  /* Relax every half-edge until nothing changes. Nodes below `first` belong to earlier runs. */
  while (changed) {
    changed = false;
    for (int h = 0; h < 2 * frame->n_edges; h++) {
      const int v = thr_tail(frame, h);
      const double length = search->distance_to_end[thr_head(frame, h)] + frame->length[h >> 1];
      if (v < search->first || length >= search->distance_to_end[v]) continue;
      search->distance_to_end[v] = length;
      changed = true;
    }
  }
}

/* Puts a label at position i of the heap. */
static void place_in_heap(set_search *search, int i, int state)
{
  search->queue[i] = state;
  search->out->state[state].at = i;
}

/* Moves the label at position i of the heap up as long as its parent is longer. */
static void sift_up(set_search *search, int i)
{
  const thr_short_state *state = search->out->state;
  const int number = search->queue[i];
  for (; i > 0 && state[number].length < state[search->queue[(i - 1) / 2]].length; i = (i - 1) / 2)
    place_in_heap(search, i, search->queue[(i - 1) / 2]);
  place_in_heap(search, i, number);
}

/* Takes the shortest label out of the heap and returns it. */
static int pop_shortest(set_search *search)
{
  const thr_short_state *state = search->out->state;
  const int top = search->queue[0], last = search->queue[--search->n_queue];

  /* Sift the last label down from the top, into which a hole was made. */
  int i = 0;
  for (int child; (child = 2 * i + 1) < search->n_queue; i = child) {
    if (child + 1 < search->n_queue &&
        state[search->queue[child + 1]].length < state[search->queue[child]].length)
      child++;
    if (state[last].length <= state[search->queue[child]].length) break;
    place_in_heap(search, i, search->queue[child]);
  }

  place_in_heap(search, i, last);
  search->out->state[top].at = NONE;
  return top;
}

/* Relaxes the label (set, node): a walk of this length, which continues label `from` by a
 * half-edge, passes the set and ends at the node. */
static void relax(set_search *search, thr_edge_set set, int node, double length, int from, int half)
{
  thr_short_cords *out = search->out;
  size_t at = slot_of(set, node);
  if (length + search->distance_to_end[node] > out->limit) return;

  /* A known label of this run keeps the shorter walk. */
  for (; search->state_at[at] >= search->n_before; at = (at + 1) % SLOTS) {
    thr_short_state *known = &out->state[search->state_at[at]];
    if (known->set != set || known->node != node) continue;
    if (length >= known->length) return;
    *known = (thr_short_state){set, length, node, from, half, known->at};
    sift_up(search, known->at);
    return;
  }

  /* Otherwise the label is new. */
  if ((search->given_up |= out->n_states == THR_SHORT_STATES)) return;
  search->state_at[at] = out->n_states;
  out->state[out->n_states] = (thr_short_state){set, length, node, from, half, search->n_queue};
  search->queue[search->n_queue++] = out->n_states++;
  sift_up(search, search->n_queue - 1);
}

/* Records that a cord can pass the set of a settled label and end there; keeps the shortest cord of
 * each set. */
static void record_set(set_search *search, int number)
{
  thr_short_cords *out = search->out;
  const thr_short_state *state = &out->state[number];
  size_t at = slot_of(state->set, 0);

  /* Find the set's slot, or the empty one where the set belongs. */
  while (search->set_at[at] != NONE && out->set[search->set_at[at]].set != state->set)
    at = (at + 1) % SLOTS;
  thr_short_set *set = &out->set[search->set_at[at] == NONE ? out->n : search->set_at[at]];
  if (search->set_at[at] == NONE)
    search->set_at[at] = out->n++;
  else if (set->length <= state->length)
    return;

  *set = (thr_short_set){state->set, state->length, number};
}

/* Settles labels in ascending order of length until none is left, and records the sets of all
 * cords. */
static void run_dijkstra(set_search *search)
{
  thr_short_cords *out = search->out;
  const thr_frame *frame = out->f;
  while (search->n_queue > 0 && !search->given_up) {
    const int number = pop_shortest(search);
    search->given_up |=
        number % STATES_PER_CHECK == 0 && out->limits && thr_limits_stop(out->limits);

    /* A settled label is a cord if a cord may end here. */
    const thr_short_state here = out->state[number];
    if (here.set != 0 && ends_at(search, here.node)) record_set(search, number);

    /* Continue along every half-edge to nodes of this run. */
    for (int i = frame->first[here.node]; i < frame->first[here.node + 1]; i++) {
      const int half = frame->half[i], to = thr_head(frame, half);
      if (to >= search->first)
        relax(search, here.set | edge_set(half >> 1), to, here.length + frame->length[half >> 1],
              number, half);
    }
  }
}

/* Lists the sets of edges that cords within the limit pass; none if there are too many. */
static void find_sets(set_search *search)
{
  thr_short_cords *out = search->out;
  for (size_t i = 0; i < SLOTS; i++)
    search->state_at[i] = search->set_at[i] = NONE;

  /* One run for each lowest node of closed cords, or one for all open cords. */
  const int runs = search->closed ? out->f->n_nodes : 1;
  for (int run = 0; run < runs && !search->given_up; run++) {
    search->first = search->closed ? run : 0;
    search->n_before = out->n_states;
    compute_distances_to_ends(search);
    for (int v = 0; v < out->f->n_nodes; v++)
      if (ends_at(search, v)) relax(search, 0, v, 0, NONE, NONE);
    run_dijkstra(search);
  }

  if (search->given_up) out->n = 0;
}

/* Finds whether this search serves the request: one component of at most THR_SHORT_EDGES edges,
 * solid joints, and no numbers of ends. */
static thr_status is_supported(const thr_frame *frame, const thr_request *options, bool *supported,
                               thr_err *err)
{
  int n = 0;
  const thr_status st = thr_frame_components(frame, NULL, &n, err);
  *supported = n == 1 && frame->n_edges <= THR_SHORT_EDGES && options->joint == THR_JOINT_SOLID &&
               options->ends != THR_ENDS_COUNTS;
  return st;
}

thr_status thr_short_cords_init(thr_short_cords *cords, const thr_frame *frame,
                                const thr_request *options, double limit, const thr_limits *limits,
                                thr_err *err)
{
  set_search search = {.out = cords, .closed = options->ends == THR_ENDS_CLOSED};
  thr_scratch own = {0};
  bool supported;
  *cords = (thr_short_cords){.f = frame, .o = options, .limits = limits, .limit = limit};
  thr_status st = is_supported(frame, options, &supported, err);
  if (st || !supported) return st;

  /* The sets and labels belong to the result, the rest to the search. */
  cords->set = thr_scratch_array(&cords->own, THR_SHORT_STATES, sizeof *cords->set);
  cords->state = thr_scratch_array(&cords->own, THR_SHORT_STATES, sizeof *cords->state);
  search.distance_to_end =
      thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *search.distance_to_end);
  search.state_at = thr_scratch_array(&own, SLOTS, sizeof *search.state_at);
  search.set_at = thr_scratch_array(&own, SLOTS, sizeof *search.set_at);
  search.queue = thr_scratch_array(&own, THR_SHORT_STATES, sizeof *search.queue);

  st = thr_scratch_check(&cords->own, err);
  if (!st) st = thr_scratch_check(&own, err);
  if (!st) find_sets(&search);
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
  /* Count the half-edges back to the label where the walk began. */
  int n = 0;
  for (int number = cords->set[i].state; cords->state[number].from != NONE;
       number = cords->state[number].from)
    n++;

  /* The labels name the half-edges from the last to the first. */
  *cord = (thr_cord){.n_passes = n, .half = thr_calloc((size_t)n, sizeof *cord->half)};
  if (!cord->half) return thr_nomem(err);
  for (int number = cords->set[i].state; n > 0; number = cords->state[number].from)
    cord->half[--n] = cords->state[number].half;

  cord->closed = thr_cord_start(cords->f, cord) == thr_cord_end(cords->f, cord);
  return THR_OK;
}

/* ---- deciding whether so many cords cover all edges ---- */

/* How many steps a decision may take for one limit, and for all limits together; what is not
 * decided by then stays open. */
static const double max_work = 1 << 23, max_total_work = 1 << 25;

/* A set of edges with its size. */
typedef struct {
  thr_edge_set set;
  int count; /* edges */
} sized_set;

/* A set of uncovered edges that so many cords cannot cover. cords = 0 marks an empty slot. */
typedef struct {
  thr_edge_set lacking;
  int cords;
} failure;

/* An element of the list of the sets that hold an edge. */
typedef struct {
  int set, next; /* next: link number, or NONE at the end of the list */
} set_link;

/* The depth-first search for sets that cover all edges. */
typedef struct {
  const thr_short_cords *table;
  const thr_frame *frame;
  bool closed;
  double limit, work, total_work; /* steps for this limit, and for earlier ones */
  double *half_shortest;          /* [n_nodes] half of the shortest edge at a node */
  double *odd_term;               /* [n_nodes] scratch of least_length */
  int *degree;                    /* [n_nodes] scratch of least_length */
  int n_maximal;
  sized_set *maximal; /* [table->n] sets within the limit that are part of no other one */
  set_link *link;     /* for every edge a list of the maximal sets that hold the edge */
  int first_link[THR_SHORT_EDGES], holders[THR_SHORT_EDGES]; /* head and length of an edge's list */
  int64_t weight[THR_SHORT_EDGES / 8][256]; /* of the subsets of eight edges at a time */
  int64_t heaviest;                         /* weight of the heaviest maximal set */
  sized_set *candidates; /* [(n_maximal + 1) * (cords + 1)] those tried at every depth, in turn */
  failure *failed;       /* [SLOTS] hash table */
  int n_failed;
  thr_edge_set *chosen; /* [cords] the sets of the cords, the last cord first */
  thr_scratch own;      /* arrays for all limits */
  thr_scratch tried;    /* arrays for one limit */
} cover_search;

/* Orders sets by size, the largest first, then by their bits. */
static int compare_sizes(const void *first_set, const void *second_set)
{
  const sized_set *a = first_set, *b = second_set;
  if (a->count != b->count) return b->count - a->count;
  return a->set < b->set ? -1 : a->set > b->set;
}

/* Removes the sets that are part of another one from list[n], and sorts the others by size.
 * Returns how many are left.
 */
static int keep_maximal(cover_search *search, sized_set *list, int n)
{
  int kept = 0;
  qsort(list, (size_t)n, sizeof *list, compare_sizes);

  /* A set can only be part of a larger one, which comes before. */
  for (int i = 0; i < n; i++) {
    bool part = false;
    int k = 0;
    for (; k < kept && !part; k++)
      part = (list[i].set & ~list[k].set) == 0;
    search->work += k;
    if (!part) list[kept++] = list[i];
  }

  return kept;
}

/* Appends maximal set number i to the lists of its edges. */
static void link_set(cover_search *search, int i, int *n_links)
{
  for (int e = 0; e < search->frame->n_edges; e++) {
    if (!holds(search->maximal[i].set, e)) continue;
    search->link[*n_links] = (set_link){i, search->first_link[e]};
    search->first_link[e] = (*n_links)++;
    search->holders[e]++;
  }
}

/* Returns the edge of a nonempty set that the fewest maximal sets hold. */
static int rarest_edge(const cover_search *search, thr_edge_set set)
{
  int best = NONE;
  for (int e = 0; e < search->frame->n_edges; e++)
    if (holds(set, e) && (best == NONE || search->holders[e] < search->holders[best])) best = e;
  return best;
}

/* Lists the sets within the limit that are part of no other one, and the lists of the sets that
 * hold an edge. */
static thr_status list_maximal_sets(cover_search *search, thr_err *err)
{
  const int m = search->frame->n_edges;
  size_t n_all = 0, n = 0;
  int n_links = 0;

  /* Collect all sets within the limit, and count their edges for the links. */
  for (int i = 0; i < search->table->n; i++) {
    if (search->table->set[i].length > search->limit) continue;
    search->maximal[n] =
        (sized_set){search->table->set[i].set, count_edges(search->table->set[i].set)};
    n_all += (size_t)search->maximal[n++].count;
  }
  if (!(search->link = thr_scratch_array(&search->tried, n_all + 1, sizeof *search->link)))
    return thr_nomem(err);

  qsort(search->maximal, n, sizeof *search->maximal, compare_sizes);
  for (int e = 0; e < m; e++) {
    search->holders[e] = 0;
    search->first_link[e] = NONE;
  }

  /* Keep a set, from the largest on, unless a set that was kept holds all of its edges. That one
   * would be in the list of its rarest edge. */
  search->n_maximal = 0;
  for (size_t i = 0; i < n; i++) {
    const sized_set set = search->maximal[i];
    int k = search->first_link[rarest_edge(search, set.set)];
    while (k != NONE && (set.set & ~search->maximal[search->link[k].set].set) != 0)
      k = search->link[k].next;
    if (k != NONE) continue; /* part of another */
    search->maximal[search->n_maximal] = set;
    link_set(search, search->n_maximal++, &n_links);
  }

  return THR_OK;
}

/* Returns the weight of a set of edges, by bytes of the set. */
static int64_t weight_of(const cover_search *search, thr_edge_set set)
{
  int64_t sum = 0;
  for (int i = 0; set != 0; i++, set >>= 8)
    sum += search->weight[i][(unsigned)set & 255];
  return sum;
}

/* Adds up the weights of all subsets of each eight edges. weight[THR_SHORT_EDGES]: of the edges.
 */
static void tabulate_weights(cover_search *search, const int64_t *weight)
{
  for (int i = 0; 8 * i < search->frame->n_edges; i++)
    for (unsigned k = 1; k < 256; k++) {
      int bit = 0;
      while (!(k >> bit & 1u))
        bit++;
      search->weight[i][k] = search->weight[i][k & (k - 1)] + weight[8 * i + bit];
    }
}

/* Finds weights of the edges by which many cords are needed: lowers those of the heaviest set
 * again and again, and keeps the weights for which the needed edges weigh most in units of the
 * heaviest set (S. Plotkin, D. Shmoys & E. Tardos 1995). */
static void weigh(cover_search *search, thr_edge_set needed)
{
  enum { ROUNDS = 400, LOOKS = 1 << 22, FIRST = 1 << 30, PART = 32 };
  const int looks = LOOKS / (search->n_maximal + 1), rounds = looks < ROUNDS ? looks : ROUNDS;
  int64_t weight[THR_SHORT_EDGES] = {0}, kept[THR_SHORT_EDGES];
  double best = -1;
  for (int e = 0; e < search->frame->n_edges; e++)
    weight[e] = holds(needed, e) ? FIRST : 0;

  for (int round = 0; round <= rounds; round++) {
    int64_t most = 0;
    thr_edge_set heaviest = 0;
    tabulate_weights(search, weight);

    /* Find the heaviest set. */
    for (int i = 0; i < search->n_maximal; i++) {
      const int64_t sum = weight_of(search, search->maximal[i].set);
      if (sum <= most) continue;
      most = sum;
      heaviest = search->maximal[i].set;
    }

    /* No fewer cords cover the needed edges: keep the best weights. */
    const double cords = most > 0 ? (double)weight_of(search, needed) / (double)most : 0;
    if (cords > best) {
      best = cords;
      search->heaviest = most;
      memcpy(kept, weight, sizeof kept);
    }

    for (int e = 0; e < search->frame->n_edges; e++)
      if (holds(heaviest, e)) weight[e] -= weight[e] / PART;
  }

  tabulate_weights(search, kept);
}

/* Returns a lower bound on the length of so many cords together that cover the lacking edges. */
static double least_length(const cover_search *search, thr_edge_set lacking, int cords)
{
  const thr_frame *frame = search->frame;
  double sum = 0;
  int n = 0;

  /* Add up the lengths, and count the degree of each node among these edges. */
  memset(search->degree, 0, (size_t)frame->n_nodes * sizeof *search->degree);
  for (int e = 0; e < frame->n_edges; e++) {
    if (!holds(lacking, e)) continue;
    sum += frame->length[e];
    search->degree[frame->edge[e][0]]++;
    search->degree[frame->edge[e][1]]++;
  }

  /* At an odd node an edge is passed once more, unless a cord ends there. Half of this edge counts
   * here. */
  for (int v = 0; v < frame->n_nodes; v++) {
    if (search->degree[v] % 2 == 0) continue;
    if (!search->closed && thr_plan_end_allowed(frame, search->table->o, v))
      search->odd_term[n++] = search->half_shortest[v];
    else
      sum += search->half_shortest[v];
  }

  /* The ends of the cords save the 2 * cords largest terms at most. */
  thr_sort_doubles(search->odd_term, (size_t)n);
  for (int i = 0; i < n - 2 * cords; i++)
    sum += search->odd_term[i];

  return sum;
}

/* Returns whether weights or lengths prove that so many cords cannot cover the lacking edges. */
static bool exceeds_bounds(cover_search *search, thr_edge_set lacking, int cords)
{
  search->work++;
  if (weight_of(search, lacking) > cords * search->heaviest) return true;
  search->work += search->frame->n_edges;
  return least_length(search, lacking, cords) > cords * search->limit * (1 + 1e-9);
}

/* Returns the slot of the hash table that holds these uncovered edges, or the empty one where
 * they belong. */
static failure *find_failure(const cover_search *search, thr_edge_set lacking)
{
  size_t at = slot_of(lacking, 0);
  while (search->failed[at].cords > 0 && search->failed[at].lacking != lacking)
    at = (at + 1) % SLOTS;
  return &search->failed[at];
}

/* Lists in candidates what the next cord may cover: the maximal subsets of the lacking edges that
 * hold the lacking edge with the fewest sets, and leave edges which the bounds do not forbid
 * `others` cords to cover. Returns how many there are. */
static int list_candidates(cover_search *search, thr_edge_set lacking, int others,
                           sized_set *candidates)
{
  int n = 0;
  for (int k = search->first_link[rarest_edge(search, lacking)]; k != NONE;
       k = search->link[k].next) {
    const thr_edge_set set = search->maximal[search->link[k].set].set & lacking;
    if (others == 0 ? set == lacking : !exceeds_bounds(search, lacking & ~set, others))
      candidates[n++] = (sized_set){set, count_edges(set)};
  }

  return keep_maximal(search, candidates, n);
}

/* Returns whether so many cords cover the lacking edges, with their sets in chosen. Returns
 * false, too, if this takes too much work. candidates: space for those of this depth and the
 * following ones. */
static bool can_cover(cover_search *search, thr_edge_set lacking, int cords, sized_set *candidates)
{
  if (lacking == 0) {
    memset(search->chosen, 0, (size_t)cords * sizeof *search->chosen);
    return true;
  }

  /* Stop where this is known to fail, or where time is up. */
  if (cords == 0 || find_failure(search, lacking)->cords >= cords) return false;
  if (search->table->limits && thr_limits_stop(search->table->limits)) search->work = INFINITY;

  /* Branch over what the next cord covers. */
  const int n = list_candidates(search, lacking, cords - 1, candidates);
  for (int i = 0; i < n && search->work <= max_work; i++) {
    search->chosen[cords - 1] = candidates[i].set;
    if (can_cover(search, lacking & ~candidates[i].set, cords - 1, candidates + n)) return true;
  }

  /* Remember the failure, or that more cords failed, while the table is at most half full. */
  failure *at = find_failure(search, lacking);
  if (search->work <= max_work && (at->cords > 0 || 2 * ++search->n_failed < SLOTS))
    *at = (failure){lacking, cords};

  return false;
}

/* What a decision finds: OPEN if the work did not suffice. */
typedef enum { IMPOSSIBLE, POSSIBLE, OPEN } verdict;

/* Decides whether so many cords of at most this length cover the needed edges. */
static thr_status decide(cover_search *search, double limit, thr_edge_set needed, int cords,
                         verdict *found, thr_err *err)
{
  *found = OPEN;
  if (search->total_work > max_total_work) return THR_OK;
  search->limit = limit;
  search->work = 0;
  search->n_failed = 0;

  /* The sets that count depend on the limit. */
  thr_status st = list_maximal_sets(search, err);
  search->candidates =
      thr_scratch_array(&search->tried, (size_t)(search->n_maximal + 1) * (size_t)(cords + 1),
                        sizeof *search->candidates);
  if (!st) st = thr_scratch_check(&search->tried, err);

  /* Bounds first; then the search, with no failures known. */
  if (!st) {
    weigh(search, needed);
    memset(search->failed, 0, SLOTS * sizeof *search->failed);
    const bool enough = !exceeds_bounds(search, needed, cords) &&
                        can_cover(search, needed, cords, search->candidates);
    *found = enough ? POSSIBLE : search->work <= max_work ? IMPOSSIBLE : OPEN;
  }

  search->total_work += search->work;
  thr_scratch_free(&search->tried);
  return st;
}

/* Allocates the arrays for all limits, and finds half of the shortest edge at every node. */
static thr_status cover_search_init(cover_search *search, int cords, thr_err *err)
{
  const thr_frame *frame = search->frame;
  const size_t n = (size_t)frame->n_nodes;
  search->half_shortest = thr_scratch_array(&search->own, n, sizeof *search->half_shortest);
  search->odd_term = thr_scratch_array(&search->own, n, sizeof *search->odd_term);
  search->degree = thr_scratch_array(&search->own, n, sizeof *search->degree);
  search->maximal =
      thr_scratch_array(&search->own, (size_t)search->table->n, sizeof *search->maximal);
  search->failed = thr_scratch_array(&search->own, SLOTS, sizeof *search->failed);
  search->chosen = thr_scratch_array(&search->own, (size_t)cords, sizeof *search->chosen);
  thr_status st = thr_scratch_check(&search->own, err);

  /* Either side of an edge may be counted at its nodes. */
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    search->half_shortest[v] = INFINITY;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      search->half_shortest[v] =
          fmin(search->half_shortest[v], frame->length[frame->half[i] >> 1] / 2);
  }

  return st;
}

/* Finds for each cord the number of the shortest listed set that holds the edges chosen for the
 * cord; NONE if there are no such edges. */
static void number_chosen(const cover_search *search, int cords, double limit, int *chosen)
{
  for (int k = 0; k < cords; k++) {
    chosen[k] = NONE;
    for (int i = 0; i < search->table->n && search->chosen[k] != 0; i++) {
      const thr_short_set *set = &search->table->set[i];
      if ((search->chosen[k] & ~set->set) != 0 || set->length > limit) continue;
      if (chosen[k] == NONE || set->length < search->table->set[chosen[k]].length) chosen[k] = i;
    }
  }
}

/* Lists the lengths of all sets in ascending order; the caller owns *value. */
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
  cover_search search = {
      .table = cords, .frame = cords->f, .closed = cords->o->ends == THR_ENDS_CLOSED};
  double *value = NULL;
  thr_edge_set needed = 0;
  int low = 0, open = cords->n, probe = 0;
  *proved = 0;
  *found = INFINITY;
  if (cords->n == 0) return THR_OK;

  /* The edges that need passes have to be covered. */
  for (int e = 0; e < cords->f->n_edges; e++)
    if (thr_plan_cover(cords->f, cords->o, e) > 0) needed |= edge_set(e);
  for (int k = 0; k < n && chosen; k++)
    chosen[k] = NONE;
  if (n > cords->f->n_edges) n = cords->f->n_edges; /* more cords than edges are no shorter */

  thr_status st = cover_search_init(&search, n, err);
  if (!st) st = list_lengths(cords, &value, err);

  /* Try first whether anything is just below the known length: mostly nothing is. */
  while (!st && probe < cords->n && value[probe] < known * (1 - 1e-9))
    probe++;

  /* Bisect: lengths below number low are impossible, and from number open on possible or
   * undecided. */
  while (!st && low < open) {
    const int middle = probe > 0 ? probe - 1 : low + (open - low) / 2;
    verdict is;
    probe = 0;
    st = decide(&search, value[middle], needed, n, &is, err);
    if (is == IMPOSSIBLE)
      low = middle + 1;
    else
      open = middle;

    if (st || is != POSSIBLE) continue;
    *found = value[middle];
    if (chosen) number_chosen(&search, n, value[middle], chosen);
  }

  if (!st) *proved = low < cords->n ? value[low] : cords->limit;
  free(value);
  thr_scratch_free(&search.own);
  return st;
}
