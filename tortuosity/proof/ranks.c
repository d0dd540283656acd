/* The volume algorithm over forests at the nodes. */
#include "tortuosity/proof/ranks.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/turning_ranks.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "tortuosity/proof/connect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 2000, PATIENCE = 20, ROWS = 8 };
static const double first_step = 0.3, least_step = 1e-4, most_new = 0.2;
static const double most_value = 0x1p54; /* of a multiplier: all of them stay within what a proof may have */

/* Edges, and the turns that leave them. */
typedef struct {
  int n_edges, *edge;   /* owned */
  int n, room, *column; /* owned */
} group;

/* Multipliers: 0 .. m - 1 what half-edge 2e has more than 2e + 1, halved; m .. 2 m - 1 what both have together and the price of
 * an extra pass, halved, >= 0; then those of the ranks and of the groups, >= 0. */
typedef struct {
  const thr_turning_columns *c;
  thr_scratch own; /* the arrays */
  int m, n, n_rows, n_groups, group_room;
  int *row[ROWS], connections[ROWS]; /* row: [n_edges] blocks of a partition; owned */
  group *group;
  int *scratch;                      /* [n_edges + n_components] */
  double *at, *best, *rise, *uphill; /* [n] */
  double *count;                     /* [2 * m] turns at a half-edge */
  double *left, *taken;              /* [first_extra] of the price of a turn; how often it is taken */
  int64_t value[ROWS];               /* of the ranks */
  int block[ROWS][THR_RANK_DEGREE];  /* of the node at hand */
} ranks;

/* ---- the bound at a point ---- */

static bool is_ranked(const ranks *s, int v)
{
  int d = thr_degree(s->c->f, v);
  return d >= 2 && d <= THR_RANK_DEGREE;
}

static double potential(const ranks *s, const double *u, int h)
{
  int e = h >> 1;
  double half = u[s->m + e] - (double)s->c->weight[s->c->first_extra + e] / 2;
  return h & 1 ? half - u[e] : half + u[e];
}

/* Takes the multipliers of the groups off all prices; returns what they ask for. */
static double take_groups(ranks *s, const double *u)
{
  double sum = 0;
  for (int j = 0; j < s->c->first_extra; j++)
    s->left[j] = (double)s->c->weight[j];
  for (int i = 0; i < s->n_groups; i++) {
    double value = u[2 * s->m + s->n_rows + i];
    sum += 2 * value;
    for (int k = 0; k < s->group[i].n && value > 0; k++)
      s->left[s->group[i].column[k]] -= value;
  }
  return sum;
}

/* A node's forest. */
static double add_node(ranks *s, int v)
{
  const int *half = s->c->f->half + s->c->f->first[v];
  double *rise = s->rise + 2 * s->m;
  thr_rank_node node = {.degree = thr_degree(s->c->f, v), .n_rows = s->n_rows, .value = s->value, .block = s->block};
  thr_rank_turns turns;
  for (int a = 0; a < node.degree; a++) {
    for (int i = 0; i < s->n_rows; i++)
      s->block[i][a] = s->row[i][half[a] >> 1];
    for (int b = 0; b < a; b++) {
      double left = s->left[thr_turning_column(s->c, half[a], half[b])];
      node.price[a][b] = node.price[b][a] = (int64_t)fmax(0, left);
    }
  }
  double worth = (double)thr_rank_least(&node, &turns);
  for (int i = 0; i < turns.n_turns; i++)
    s->taken[thr_turning_column(s->c, half[turns.turn[i][0]], half[turns.turn[i][1]])]++;
  for (int i = 0; i < s->n_rows; i++)
    rise[i] -= thr_rank_of(&node, i, &turns);
  return worth;
}

/* The slope, from how often every turn is taken. */
static void set_rise(ranks *s)
{
  const thr_turning_columns *c = s->c;
  memset(s->count, 0, 2 * (size_t)s->m * sizeof *s->count);
  for (int j = 0; j < c->first_extra; j++) {
    s->count[c->half[j][0]] += s->taken[j];
    s->count[c->half[j][1]] += s->taken[j];
  }
  for (int e = 0; e < s->m; e++) {
    s->rise[e] = s->count[2 * e + 1] - s->count[2 * e];
    s->rise[s->m + e] = 2 * c->cover[e] - s->count[2 * e] - s->count[2 * e + 1];
  }
  for (int i = 0; i < s->n_groups; i++) {
    double lack = 2;
    for (int k = 0; k < s->group[i].n; k++)
      lack -= s->taken[s->group[i].column[k]];
    s->rise[2 * s->m + s->n_rows + i] = lack;
  }
}

/* The bound at u; rise receives its slope there. */
static double bound_at(ranks *s, const double *u)
{
  const thr_turning_columns *c = s->c;
  double bound = take_groups(s, u);
  for (int i = 0; i < s->n_rows; i++) {
    s->rise[2 * s->m + i] = s->connections[i];
    bound += s->connections[i] * u[2 * s->m + i];
    s->value[i] = (int64_t)u[2 * s->m + i];
  }
  for (int j = 0; j < c->first_extra; j++) {
    s->left[j] -= potential(s, u, c->half[j][0]) + potential(s, u, c->half[j][1]);
    s->taken[j] = s->left[j] < 0 ? thr_turning_most(c, j) : 0;
    bound += s->taken[j] * s->left[j];
  }
  for (int v = 0; v < c->f->n_nodes; v++)
    if (is_ranked(s, v)) bound += add_node(s, v);
  for (int e = 0; e < s->m; e++)
    bound += c->cover[e] * (potential(s, u, 2 * e) + potential(s, u, 2 * e + 1));
  set_rise(s);
  return bound;
}

/* ---- steps ---- */

static double product(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* Takes the new slope into the mean, by as much as makes the mean small. */
static void take_mean(ranks *s, double steep, double along)
{
  double apart = product(s->rise, s->rise, s->n) - 2 * along + steep;
  double part = apart > 0 ? (steep - along) / apart : most_new;
  part = fmin(most_new, fmax(most_new / 10, part));
  for (int i = 0; i < s->n; i++)
    s->uphill[i] += part * (s->rise[i] - s->uphill[i]);
}

static void climb(ranks *s, double target, const thr_limits *limits)
{
  double bound = bound_at(s, s->best), part = first_step;
  memcpy(s->uphill, s->rise, (size_t)s->n * sizeof *s->rise);
  for (int i = 0, failed = 0; i < STEPS && bound < target && !thr_limits_stop(limits); i++) {
    double steep = product(s->uphill, s->uphill, s->n);
    if (steep < 1e-12) break;
    for (int k = 0; k < s->n; k++) {
      double to = s->best[k] + part * (target - bound) / steep * s->uphill[k];
      s->at[k] = fmin(most_value, fmax(k < s->m ? -most_value : 0, to));
    }
    double now = bound_at(s, s->at), along = product(s->uphill, s->rise, s->n);
    take_mean(s, steep, along);
    if (now > bound) {
      bound = now;
      memcpy(s->best, s->at, (size_t)s->n * sizeof *s->at);
      part = fmin(2, along >= 0 ? 1.1 * part : part);
      failed = 0;
    } else if (++failed > PATIENCE) {
      part = fmax(least_step, 0.66 * part);
      failed = 0;
    }
  }
}

/* ---- rows and groups ---- */

/* A partition on the way of Kruskal's method. */
static thr_status add_row(void *user, const int *part, int n, thr_err *err)
{
  ranks *s = user;
  size_t m = (size_t)s->m;
  int connections = thr_turning_connections(s->c, part, s->scratch), *block;
  (void)n;
  if (s->n_rows == ROWS || connections < 1) return THR_OK;
  if (!(block = thr_calloc(m, sizeof *block))) return thr_nomem(err);
  memcpy(block, part, m * sizeof *part);
  s->row[s->n_rows] = block;
  s->connections[s->n_rows++] = connections;
  return THR_OK;
}

static thr_status add_column(group *g, int column, thr_err *err)
{
  thr_status st = thr_grow(&g->column, g->n, &g->room, sizeof *g->column, err);
  if (!st) g->column[g->n++] = column;
  return st;
}

/* Lists the turns that leave a group, whose edges are marked for that. inside: [n_edges] all false. */
static thr_status list_turns(const thr_turning_columns *c, group *g, bool *inside, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < g->n_edges; i++)
    inside[g->edge[i]] = true;
  for (int j = 0; j < c->first_extra && !st; j++)
    if (inside[c->half[j][0] >> 1] != inside[c->half[j][1] >> 1]) st = add_column(g, j, err);
  return st;
}

static void group_destroy(group *g)
{
  free(g->edge);
  free(g->column);
}

static thr_status add_group(ranks *s, const int *edge, int n, thr_err *err)
{
  for (int i = 0; i < s->n_groups; i++)
    if (s->group[i].n_edges == n && !memcmp(s->group[i].edge, edge, (size_t)n * sizeof *edge)) return THR_OK;
  group g = {.n_edges = n, .edge = thr_calloc((size_t)n, sizeof *g.edge)};
  bool *inside = thr_calloc((size_t)s->m, sizeof *inside);
  thr_status st = g.edge && inside ? thr_grow(&s->group, s->n_groups, &s->group_room, sizeof *s->group, err) : thr_nomem(err);
  if (!st) {
    memcpy(g.edge, edge, (size_t)n * sizeof *edge);
    st = list_turns(s->c, &g, inside, err);
  }
  free(inside);
  if (st)
    group_destroy(&g);
  else
    s->group[s->n_groups++] = g;
  return st;
}

/* The groups of another proof; and every block of the rows, if a single closed cord goes through all of the framework. */
static thr_status add_groups(ranks *s, const thr_turning_dual *from, int *edge, thr_err *err)
{
  const thr_turning_columns *c = s->c;
  const bool blocks = c->task->cords == 1 && c->n_components == 1;
  thr_status st = THR_OK;
  for (int i = 0; i < from->n_groups && !st; i++)
    st = add_group(s, from->group[i].member, from->group[i].n, err);
  for (int i = 0; i < s->n_rows && blocks; i++)
    for (int block = 0; block <= s->connections[i] && !st; block++) {
      int n = 0;
      for (int e = 0; e < s->m; e++)
        if (s->row[i][e] == block) edge[n++] = e;
      st = add_group(s, edge, n, err);
    }
  return st;
}

/* Begins with the multipliers of another proof: where nodes are counted exactly its odd sets are of little use. */
static void begin(ranks *s, const thr_turning_dual *from)
{
  for (int e = 0; e < s->m; e++)
    s->best[e] = (double)(from->potential[2 * e] - from->potential[2 * e + 1]) / 2;
  for (int i = 0; i < from->n_groups; i++)
    s->best[2 * s->m + s->n_rows + i] = (double)from->group[i].value;
}

static thr_status ranks_init(ranks *s, const thr_turning_columns *turning_columns, const int *x, const thr_turning_dual *from,
                             thr_err *err)
{
  const thr_turning_columns *c = turning_columns;
  size_t m = (size_t)c->f->n_edges;
  *s = (ranks){.c = c, .m = (int)m};
  int *part = thr_scratch_array(&s->own, m, sizeof *part);
  s->scratch = thr_scratch_array(&s->own, m + (size_t)c->n_components, sizeof *s->scratch);
  s->count = thr_scratch_array(&s->own, 2 * m, sizeof *s->count);
  s->left = thr_scratch_array(&s->own, (size_t)c->first_extra, sizeof *s->left);
  s->taken = thr_scratch_array(&s->own, (size_t)c->first_extra, sizeof *s->taken);
  thr_status st = thr_scratch_check(&s->own, err);
  if (!st) st = thr_connect_chain(c, x, part, thr_connect_parts(c, x, part), add_row, s, err);
  if (!st) st = add_groups(s, from, part, err);
  s->n = 2 * s->m + s->n_rows + s->n_groups;
  double **arrays[] = {&s->at, &s->best, &s->rise, &s->uphill};
  for (int i = 0; i < 4; i++)
    *arrays[i] = thr_scratch_array(&s->own, (size_t)s->n, sizeof **arrays[i]);
  if (!st) st = thr_scratch_check(&s->own, err);
  if (!st) begin(s, from);
  return st;
}

static void ranks_destroy(ranks *s)
{
  for (int i = 0; i < s->n_rows; i++)
    free(s->row[i]);
  for (int i = 0; i < s->n_groups; i++)
    group_destroy(&s->group[i]);
  free(s->group);
  thr_scratch_free(&s->own);
}

/* ---- multipliers as integers ---- */

/* No extra pass is left a price below 0. */
static void round_potentials(const ranks *s, thr_turning_dual *dual)
{
  for (int e = 0; e < s->m; e++) {
    int64_t both = (int64_t)nearbyint(2 * s->best[s->m + e]) - s->c->weight[s->c->first_extra + e];
    dual->potential[2 * e] = (int64_t)nearbyint(potential(s, s->best, 2 * e));
    dual->potential[2 * e + 1] = both - dual->potential[2 * e];
  }
}

static thr_status round_all(ranks *s, thr_turning_dual *dual, thr_err *err)
{
  const double *value = s->best + 2 * s->m;
  dual->group = thr_calloc((size_t)s->n_groups, sizeof *dual->group);
  dual->rank = thr_calloc((size_t)s->n_rows, sizeof *dual->rank);
  if (!dual->group || !dual->rank) return thr_nomem(err);
  round_potentials(s, dual);
  for (int i = 0; i < s->n_rows; i++) {
    dual->rank[dual->n_ranks++] = (thr_turning_partition){s->row[i], (int64_t)value[i]};
    s->row[i] = NULL;
  }
  for (int i = 0; i < s->n_groups; i++) {
    if (value[s->n_rows + i] < 1) continue;
    dual->group[dual->n_groups++] = (thr_turning_set){s->group[i].n_edges, s->group[i].edge, (int64_t)value[s->n_rows + i]};
    s->group[i].edge = NULL;
  }
  return THR_OK;
}

thr_status thr_ranks_run(const thr_turning_columns *turning_columns, const int *x, const thr_turning_dual *from, double target,
                         const thr_limits *limits, thr_turning_dual *dual, thr_err *err)
{
  ranks s;
  thr_status st = ranks_init(&s, turning_columns, x, from, err);
  if (!st) {
    climb(&s, target, limits);
    st = round_all(&s, dual, err);
  }
  ranks_destroy(&s);
  return st;
}
