/* The best symmetric cover, one aim after the other. */
#include "symmetry/cover.h"
#include "symmetry/contraction.h"
#include "symmetry/relaxation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_cover_destroy(thr_cover *c)
{
  free(c->copies);
  free(c->pairs);
  free(c->ends);
  *c = (thr_cover){0};
}

typedef struct {
  const thr_programme *p;
  const thr_limits *limits;
  thr_relaxation r; /* made when it is needed */
  int kept;         /* so many aims, the first ones, have rows in r that keep them */
  bool found;
  int *best;  /* [p->n] the best so far, if found */
  int *other; /* [p->n] scratch */
  double worth[THR_N_AIMS], bound[THR_N_AIMS];
} search;

static void search_destroy(search *s)
{
  thr_relaxation_destroy(&s->r);
  free(s->best);
  free(s->other);
}

static thr_status search_init(search *s, const thr_programme *p, const thr_limits *limits, thr_err *err)
{
  *s = (search){.p = p, .limits = limits};
  s->best = thr_calloc((size_t)p->n, sizeof *s->best);
  s->other = thr_calloc((size_t)p->n, sizeof *s->other);
  if (s->best && s->other) return THR_OK;
  search_destroy(s);
  *s = (search){0};
  return thr_nomem(err);
}

/* Keeps s->other if it can be made concrete and is better than the best so far. */
static thr_status offer(search *s, thr_err *err)
{
  double worth[THR_N_AIMS];
  bool valid;
  thr_status st = thr_programme_value(s->p, s->other, worth, &valid, err);
  if (st || !valid || (s->found && thr_programme_compare(s->p, worth, s->worth) >= 0)) return st;
  memcpy(s->best, s->other, (size_t)s->p->n * sizeof *s->best);
  memcpy(s->worth, worth, sizeof worth);
  s->found = true;
  return THR_OK;
}

/* Offers the whole point of the relaxation, as it is and mended. */
static thr_status consider(search *s, thr_err *err)
{
  for (int j = 0; j < s->p->n; j++)
    s->other[j] = (int)lround(s->r.x[j]);
  thr_status st = offer(s, err);
  if (!st) st = thr_programme_mend(s->p, s->other, err);
  return st ? st : offer(s, err);
}

/* Is the best so far as good as this bound? */
static bool beaten(const search *s, thr_aim aim, double bound)
{
  return s->found && s->worth[aim] <= bound + thr_programme_tolerance(s->p, aim);
}

/* A node of the search tree: its parent's with other bounds on one column. */
typedef struct {
  int parent, column; /* the root: -1 */
  double low, high, bound;
} node;

typedef struct {
  node *node;
  int n, capacity;
  int *open; /* nodes still to be solved */
  int n_open, open_capacity;
  int at;     /* node whose bounds are in force */
  int *chain; /* scratch */
  int chain_capacity;
} tree;

static void tree_destroy(tree *t)
{
  free(t->node);
  free(t->open);
  free(t->chain);
}

static thr_status add_node(tree *t, node made, thr_err *err)
{
  thr_status st = thr_grow(&t->node, t->n, &t->capacity, sizeof *t->node, err);
  if (!st) st = thr_grow(&t->open, t->n_open, &t->open_capacity, sizeof *t->open, err);
  if (!st) st = thr_grow(&t->chain, t->n, &t->chain_capacity, sizeof *t->chain, err); /* no path is longer */
  if (st) return st;
  t->open[t->n_open++] = t->n;
  t->node[t->n++] = made;
  return THR_OK;
}

/* Puts the bounds of a node in force. */
static thr_status move_to(search *s, tree *t, int to, thr_err *err)
{
  thr_status st = THR_OK;
  int n = 0;
  for (int k = t->at; k > 0 && !st; k = t->node[k].parent) {
    int j = t->node[k].column, most = s->p->most[j];
    st = thr_relaxation_bound(&s->r, j, s->p->least[j], most < 0 ? (double)INFINITY : most, err);
  }
  for (int k = to; k > 0; k = t->node[k].parent)
    t->chain[n++] = k;
  while (n > 0 && !st) {
    const node *b = &t->node[t->chain[--n]];
    st = thr_relaxation_bound(&s->r, b->column, b->low, b->high, err);
  }
  t->at = to;
  return st;
}

/* Two nodes instead of the present one; the one that is nearer to x comes first, the lower one if both are. */
static thr_status split(search *s, tree *t, thr_err *err)
{
  const thr_relaxation *r = &s->r;
  int j = thr_relaxation_branch(r), at = t->at;
  double whole = floor(r->x[j]);
  node lower = {at, j, r->low[j], whole, r->objective}, upper = {at, j, whole + 1, r->high[j], r->objective};
  bool up = r->x[j] - whole > 0.5 + 1e-6;
  thr_status st = add_node(t, up ? lower : upper, err);
  return st ? st : add_node(t, up ? upper : lower, err);
}

/* Takes the open node of least bound, the latest of several; -1: none is better than the best so far. */
static int take(const search *s, tree *t, thr_aim aim)
{
  int best = -1;
  for (int i = 0; i < t->n_open; i++)
    if (best < 0 || t->node[t->open[i]].bound <= t->node[t->open[best]].bound + 1e-9 * s->p->scale[aim]) best = i;
  if (best < 0 || beaten(s, aim, t->node[t->open[best]].bound)) return -1;
  int taken = t->open[best];
  memmove(&t->open[best], &t->open[best + 1], (size_t)(--t->n_open - best) * sizeof *t->open);
  return taken;
}

/* Solves a node with all rows that its optima violate. *open: it is to be branched on. THR_ELIMIT: stopped. */
static thr_status solve_node(search *s, thr_aim aim, bool root, bool *open, thr_err *err)
{
  thr_relaxation *r = &s->r;
  *open = false;
  for (int added = 1; added > 0;) {
    thr_lp_outcome outcome;
    thr_status st = thr_relaxation_solve(r, s->limits, &outcome, err);
    if (st) return st;
    if (outcome == THR_LP_STOPPED) return THR_ELIMIT;
    if (outcome != THR_LP_OPTIMAL) return THR_OK;
    if (root) s->bound[aim] = fmax(s->bound[aim], r->objective);
    if (r->whole) st = consider(s, err);
    if (!st && beaten(s, aim, r->objective)) return THR_OK;
    if (!st) st = thr_relaxation_separate(r, s->limits, &added, err);
    if (st) return st;
  }
  *open = !r->whole;
  return THR_OK;
}

/* The relaxation for the aim of that number, with the aims before it kept. */
static thr_status prepare(search *s, int number, thr_err *err)
{
  const thr_aim *prefer = s->p->o->prefer;
  thr_status st = s->r.p ? THR_OK : thr_relaxation_init(&s->r, s->p, s->limits, err);
  for (; s->kept < number && !st; s->kept++) {
    st = thr_relaxation_aim(&s->r, prefer[s->kept], err);
    if (!st) st = thr_relaxation_fix(&s->r, s->worth[prefer[s->kept]], err);
  }
  return st ? st : thr_relaxation_aim(&s->r, prefer[number], err);
}

/* Minimizes one aim by branch and cut, best bound first. THR_ELIMIT: stopped; the bounds on columns are as before in any case. */
static thr_status minimize(search *s, int number, thr_err *err)
{
  tree t = {0};
  bool open;
  thr_aim aim = s->p->o->prefer[number];
  if (beaten(s, aim, s->bound[aim])) return THR_OK;
  thr_status st = prepare(s, number, err);
  if (!st) st = add_node(&t, (node){-1, -1, 0, 0, s->bound[aim]}, err);
  for (int next; !st && (next = take(s, &t, aim)) >= 0;) {
    s->bound[aim] = fmax(s->bound[aim], t.node[next].bound);
    st = move_to(s, &t, next, err);
    if (!st) st = solve_node(s, aim, next == 0, &open, err);
    if (!st && open) st = split(s, &t, err);
  }
  if (!st && !s->found)
    st = thr_fail(err, THR_EINFEASIBLE, "no threading with ends %s is symmetric under this group of order %d",
                  thr_ends_name(s->p->o->ends), s->p->q->h->order);
  if (!st) s->bound[aim] = s->worth[aim];
  if (!st || st == THR_ELIMIT) {
    thr_status moved = move_to(s, &t, 0, err);
    if (moved) st = moved;
  }
  tree_destroy(&t);
  return st;
}

/* A component of the framework without a node where its cords may end. */
static thr_status check_ends(const thr_programme *p, thr_err *err)
{
  const thr_quotient *q = p->q;
  int count = 0, *component = thr_calloc((size_t)q->f->n_nodes, sizeof *component);
  bool *has_end = thr_calloc((size_t)q->f->n_nodes, sizeof *has_end);
  thr_status st = component && has_end ? thr_frame_components(q->f, component, &count, err) : thr_nomem(err);
  for (int d = 0; d < q->n_darts && !st; d++) {
    if (p->most[p->first_end + d] == 0) continue;
    for (int i = 0; i < q->h->order; i++)
      has_end[component[thr_tail(q->f, q->half_image[(size_t)i * 2 * (size_t)q->f->n_edges + (size_t)q->dart[d].half])]] = true;
  }
  for (int v = 0; v < q->f->n_nodes && p->open && !st; v++)
    if (!has_end[component[v]])
      st = thr_fail(err, THR_EINFEASIBLE, "no cord may end in the component of node %s, with ends %s", q->f->name[v],
                    thr_ends_name(p->o->ends));
  free(component);
  free(has_end);
  return st;
}

static thr_status hand_over(const search *s, thr_cover *out, thr_err *err)
{
  const thr_quotient *q = s->p->q;
  memcpy(out->value, s->worth, sizeof out->value);
  for (int a = 0; a < THR_N_AIMS; a++)
    out->bound[a] = fmin(s->bound[a], s->worth[a]); /* a later aim may win by rounding in an earlier one */
  out->copies = thr_calloc((size_t)q->n_copies, sizeof *out->copies);
  out->pairs = thr_calloc((size_t)q->n_pairs, sizeof *out->pairs);
  out->ends = thr_calloc((size_t)q->n_darts, sizeof *out->ends);
  if (!out->copies || !out->pairs || !out->ends) return thr_nomem(err);
  memcpy(out->copies, s->best, (size_t)q->n_copies * sizeof *s->best);
  if (q->n_pairs > 0) memcpy(out->pairs, s->best + s->p->first_pair, (size_t)q->n_pairs * sizeof *s->best);
  memcpy(out->ends, s->best + s->p->first_end, (size_t)q->n_darts * sizeof *s->best);
  return THR_OK;
}

/* The first so many aims, one after the other. */
static thr_status search_aims(search *s, int n, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < n && !st; k++)
    st = minimize(s, k, err);
  return st;
}

/* Keeps a lifted solution, mended and improved. */
static thr_status offer_lifted(search *s, thr_err *err)
{
  thr_status st = thr_programme_mend(s->p, s->other, err);
  if (!st) st = thr_programme_open(s->p, s->other, err);
  if (!st) st = thr_programme_improve(s->p, s->limits, s->other, err);
  return st ? st : offer(s, err);
}

/* A cover that needs no programme, the first of three kinds that there is. */
static thr_status start(search *s, thr_err *err)
{
  thr_contraction c;
  thr_status st = thr_contraction_init(&c, s->p, true, err);
  if (st) return st;
  int *small = thr_calloc((size_t)c.p.n, sizeof *small);
  if (!small) st = thr_nomem(err);
  for (int kind = 0; kind < THR_CONTRACTION_KINDS && !s->found && !st; kind++) {
    bool found;
    int failed = 0;
    st = thr_contraction_start(&c, (thr_contraction_kind)kind, small, &found, err);
    if (!st && found) st = thr_contraction_lift(&c, small, s->other, &failed, err);
    if (!st && found && !failed) st = offer_lifted(s, err);
    memset(c.keep, 0, (size_t)s->p->q->n_darts * sizeof *c.keep);
  }
  free(small);
  thr_contraction_destroy(&c);
  return st;
}

/* Bounds of the contracted programme: with the aims before at the same values. */
static void take_bounds(search *s, const search *small, int n)
{
  for (int k = 0; k < n; k++) {
    thr_aim aim = s->p->o->prefer[k];
    s->bound[aim] = fmax(s->bound[aim], small->bound[aim]);
    if (!beaten(s, aim, s->bound[aim])) break;
  }
}

/* The aims before turning in the contracted programme, whose cells are left as they are where its solution cannot be lifted. */
static thr_status search_contracted(search *s, thr_err *err)
{
  static const double part = 0.7; /* of the time: the rest is for lifting and for turning */
  thr_contraction c;
  thr_limits limits = *s->limits;
  int n = 0, failed = 1;
  if (limits.deadline > 0) limits.deadline -= (1 - part) * thr_limits_left(&limits, INFINITY);
  while (s->p->o->prefer[n] != THR_AIM_TURNING)
    n++;
  thr_status st = thr_contraction_init(&c, s->p, false, err);
  if (st) return st;
  while (failed > 0 && !st) {
    search small;
    st = search_init(&small, &c.p, &limits, err);
    if (st) break;
    thr_status searched = search_aims(&small, n, err);
    if (searched && searched != THR_ELIMIT) st = searched;
    failed = 0;
    if (!st && small.found) st = thr_contraction_lift(&c, small.best, s->other, &failed, err);
    if (!st && small.found && !failed) st = offer_lifted(s, err);
    if (!st && !failed) take_bounds(s, &small, n);
    search_destroy(&small);
    if (!st && failed) st = thr_contraction_make(&c, err);
  }
  thr_contraction_destroy(&c);
  return st;
}

static thr_status search_all(search *s, thr_cover *out, thr_err *err)
{
  thr_status st = start(s, err);
  if (!st) st = search_contracted(s, err);
  if (!st) st = search_aims(s, THR_N_AIMS, err);
  if (st && st != THR_ELIMIT) return st;
  if (!s->found) return thr_fail(err, THR_ELIMIT, "the time was too short to find a symmetric cover");
  out->optimal = !st;
  thr_status given = hand_over(s, out, err);
  if (given || !st) return given;
  return thr_fail(err, THR_ELIMIT, "the time was too short to prove that no symmetric cover is better");
}

thr_status thr_cover_find(const thr_quotient *q, const thr_cover_options *o, const thr_limits *limits, thr_cover *out,
                          thr_err *err)
{
  thr_programme p = {0};
  thr_cover c = {0};
  search s = {0};
  *out = (thr_cover){0};
  thr_status st = thr_programme_init(&p, q, o, err);
  if (!st) st = check_ends(&p, err);
  if (!st) st = search_init(&s, &p, limits, err);
  if (!st) st = search_all(&s, &c, err);
  search_destroy(&s);
  thr_programme_destroy(&p);
  if (st && st != THR_ELIMIT) thr_cover_destroy(&c);
  *out = c;
  return st;
}
