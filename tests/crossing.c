/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small frameworks and options at random, by pairs. */
#include "tests/crossing.h"
#include "graph/plan/turning_proof.h"
#include "tests/plans.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const crossing_name[N_CHOICES] = {
    "objective",  "joint",   "ends",   "pieces", "cords",     "cover", "capacity",
    "own passes", "lengths", "shape",  "limit",  "balance",   "slack", "turn cost",
    "minimize",   "tour",    "engine", "prefer", "geometric", "cords"};

enum { LENGTH, TORTUOSITY, SYMMETRY };
enum { CORDS_UNSAID, CORDS_2, CORDS_3, CORDS_1_TO_3, CORDS_2_TO_4, CORDS_UP_TO_8, CORDS_AUTO };
enum { ENDS_COUNTED = 4 };
enum { SHAPE_RANDOM, SHAPE_GRID, SHAPE_REGULAR };

const char *const crossing_value[N_CHOICES][CROSSING_VALUES] = {
    {"length", "tortuosity", "symmetry"},
    {"solid", "tube"},
    {"closed", "any", "feet", "list", "counts"},
    {"1", "2", "3"},
    {"unsaid", "2", "3", "1..3", "2..4", "..8", "auto"},
    {"1", "2"},
    {"none", "1", "2", "3"},
    {"none", "covers", "capacities", "both"},
    {"euclid", "equal", "random", "integers"},
    {"random", "grid", "regular"},
    {"none", "max-length"},
    {"no", "yes"},
    {"unsaid", "0", "10", "40"},
    {"angle", "sine", "step", "uturn"},
    {"turning", "max-turning"},
    {"least", "fleury", "hierholzer"},
    {"auto", "lp", "matching"},
    {"unsaid", "paths", "turning", "steps"},
    {"unsaid", "0.01"},
    {"any", "distinct"},
};

/* What is about turning or symmetry alone, and how cords are counted. */
const crossing_refused crossing_refusals[] = {
    {BY_OBJECTIVE, TORTUOSITY, BY_PREFER, 1},
    {BY_OBJECTIVE, TORTUOSITY, BY_PREFER, 2},
    {BY_OBJECTIVE, TORTUOSITY, BY_PREFER, 3},
    {BY_OBJECTIVE, TORTUOSITY, BY_GEOMETRIC, 1},
    {BY_OBJECTIVE, SYMMETRY, BY_SLACK, 1},
    {BY_OBJECTIVE, SYMMETRY, BY_SLACK, 2},
    {BY_OBJECTIVE, SYMMETRY, BY_SLACK, 3},
    {BY_OBJECTIVE, SYMMETRY, BY_COST, 1},
    {BY_OBJECTIVE, SYMMETRY, BY_COST, 2},
    {BY_OBJECTIVE, SYMMETRY, BY_COST, 3},
    {BY_OBJECTIVE, SYMMETRY, BY_MINIMIZE, 1},
    {BY_OBJECTIVE, SYMMETRY, BY_TOUR, 1},
    {BY_OBJECTIVE, SYMMETRY, BY_TOUR, 2},
    {BY_OBJECTIVE, LENGTH, BY_SLACK, 1},
    {BY_OBJECTIVE, LENGTH, BY_SLACK, 2},
    {BY_OBJECTIVE, LENGTH, BY_SLACK, 3},
    {BY_OBJECTIVE, LENGTH, BY_COST, 1},
    {BY_OBJECTIVE, LENGTH, BY_COST, 2},
    {BY_OBJECTIVE, LENGTH, BY_COST, 3},
    {BY_OBJECTIVE, LENGTH, BY_MINIMIZE, 1},
    {BY_OBJECTIVE, LENGTH, BY_TOUR, 1},
    {BY_OBJECTIVE, LENGTH, BY_TOUR, 2},
    {BY_OBJECTIVE, LENGTH, BY_PREFER, 1},
    {BY_OBJECTIVE, LENGTH, BY_PREFER, 2},
    {BY_OBJECTIVE, LENGTH, BY_PREFER, 3},
    {BY_OBJECTIVE, LENGTH, BY_GEOMETRIC, 1},
    {BY_OBJECTIVE, SYMMETRY, BY_ENDS, ENDS_COUNTED},
    {BY_BALANCE, 1, BY_CORDS, CORDS_UNSAID},
    {BY_BALANCE, 1, BY_CORDS, CORDS_AUTO},
    {BY_BALANCE, 1, BY_LIMIT, 1},
    {BY_CORDS, CORDS_AUTO, BY_LIMIT, 0},
    {BY_COVER, 1, BY_CAPACITY, 1},
    {BY_TOUR, 1, BY_JOINT, 1},
    {BY_TOUR, 2, BY_JOINT, 1},
    {BY_TOUR, 1, BY_CORDS, CORDS_2},
    {BY_TOUR, 2, BY_CORDS, CORDS_2},
    {BY_TOUR, 1, BY_CORDS, CORDS_3},
    {BY_TOUR, 2, BY_CORDS, CORDS_3},
    {BY_SLACK, 1, BY_LIMIT, 1},
    {BY_SLACK, 1, BY_BALANCE, 1},
    {BY_SLACK, 1, BY_CORDS, CORDS_1_TO_3},
    {BY_SLACK, 1, BY_CORDS, CORDS_2_TO_4},
    {BY_SLACK, 1, BY_CORDS, CORDS_UP_TO_8},
    {BY_SLACK, 1, BY_CORDS, CORDS_AUTO},
    {BY_SLACK, 2, BY_LIMIT, 1},
    {BY_SLACK, 2, BY_BALANCE, 1},
    {BY_SLACK, 2, BY_CORDS, CORDS_1_TO_3},
    {BY_SLACK, 2, BY_CORDS, CORDS_2_TO_4},
    {BY_SLACK, 2, BY_CORDS, CORDS_UP_TO_8},
    {BY_SLACK, 2, BY_CORDS, CORDS_AUTO},
    {BY_SLACK, 3, BY_LIMIT, 1},
    {BY_SLACK, 3, BY_BALANCE, 1},
    {BY_SLACK, 3, BY_CORDS, CORDS_1_TO_3},
    {BY_SLACK, 3, BY_CORDS, CORDS_2_TO_4},
    {BY_SLACK, 3, BY_CORDS, CORDS_UP_TO_8},
    {BY_SLACK, 3, BY_CORDS, CORDS_AUTO},
    {BY_TOUR, 1, BY_CORDS, CORDS_1_TO_3},
    {BY_TOUR, 2, BY_CORDS, CORDS_1_TO_3},
    {BY_TOUR, 1, BY_CORDS, CORDS_2_TO_4},
    {BY_TOUR, 2, BY_CORDS, CORDS_2_TO_4},
    {BY_TOUR, 1, BY_CORDS, CORDS_UP_TO_8},
    {BY_TOUR, 2, BY_CORDS, CORDS_UP_TO_8},
    {BY_TOUR, 1, BY_CORDS, CORDS_AUTO},
    {BY_TOUR, 2, BY_CORDS, CORDS_AUTO},
    {BY_TOUR, 1, BY_LIMIT, 1},
    {BY_TOUR, 2, BY_LIMIT, 1},
    {BY_TOUR, 1, BY_BALANCE, 1},
    {BY_TOUR, 2, BY_BALANCE, 1},
    {BY_TOUR, 1, BY_SLACK, 2},
    {BY_TOUR, 2, BY_SLACK, 2},
    {BY_TOUR, 1, BY_SLACK, 3},
    {BY_TOUR, 2, BY_SLACK, 3},
    {BY_TOUR, 1, BY_MINIMIZE, 1},
    {BY_TOUR, 2, BY_MINIMIZE, 1},
    {BY_TOUR, 1, BY_DISTINCT, 1},
    {BY_TOUR, 2, BY_DISTINCT, 1},
    {BY_CAPACITY, 1, BY_DISTINCT, 1},
};
const int n_crossing_refusals = sizeof crossing_refusals / sizeof *crossing_refusals;

int crossing_values(crossing_choice c)
{
  int n = 0;
  while (n < CROSSING_VALUES && crossing_value[c][n])
    n++;
  return n;
}

/* ---- pairs ---- */

bool crossing_is_refused(const int *value)
{
  for (int i = 0; i < n_crossing_refusals; i++) {
    const crossing_refused *r = &crossing_refusals[i];
    if (value[r->a] == r->value_a && value[r->b] == r->value_b) return true;
  }
  return false;
}

/* Values that only one objective takes. */
static int only_with(crossing_choice c, int value)
{
  if (value == 0) return -1;
  if (c == BY_SLACK || c == BY_COST || c == BY_MINIMIZE || c == BY_TOUR) return TORTUOSITY;
  if (c == BY_PREFER || c == BY_GEOMETRIC) return SYMMETRY;
  return -1;
}

bool crossing_never_meet(crossing_choice a, int value_a, crossing_choice b, int value_b)
{
  int objective[2] = {only_with(a, value_a), only_with(b, value_b)};
  if (objective[0] >= 0 && objective[1] >= 0 && objective[0] != objective[1]) return true;
  if ((a == BY_ENDS && value_a == ENDS_COUNTED && objective[1] == SYMMETRY) ||
      (b == BY_ENDS && value_b == ENDS_COUNTED && objective[0] == SYMMETRY))
    return true;
  int value[N_CHOICES] = {0};
  if (objective[0] >= 0) value[BY_OBJECTIVE] = objective[0];
  if (objective[1] >= 0) value[BY_OBJECTIVE] = objective[1];
  if (a == BY_BALANCE || b == BY_BALANCE) value[BY_CORDS] = CORDS_2;
  value[a] = value_a;
  value[b] = value_b;
  if (value[BY_CORDS] == CORDS_AUTO && a != BY_LIMIT && b != BY_LIMIT) value[BY_LIMIT] = 1;
  return crossing_is_refused(value);
}

static double score(const crossing_tally *t, const int *value)
{
  double sum = 0;
  for (int a = 0; a < N_CHOICES; a++)
    for (int b = 0; b < a; b++) {
      int n = 1 + t->met[a][value[a]][b][value[b]];
      sum += 1.0 / n / n;
    }
  return sum;
}

/* Has it the values that are asked for, "tube symmetry"? NULL: any. */
static bool wanted(const int *value, const char *only)
{
  for (const char *word = only; word && *word; word += strcspn(word, " ")) {
    bool has = false;
    word += strspn(word, " ");
    size_t n = strcspn(word, " ");
    for (int c = 0; c < N_CHOICES; c++) {
      const char *name = crossing_value[c][value[c]];
      has |= strlen(name) == n && strncmp(name, word, n) == 0;
    }
    if (!has) return false;
  }
  return true;
}

void crossing_choose(rng *r, const crossing_tally *t, const char *only, int *value)
{
  enum { TRIES = 60 };
  int try[N_CHOICES];
  double best = -1;
  for (int i = 0; i < TRIES; i++) {
    do {
      for (int c = 0; c < N_CHOICES; c++)
        try[c] = rng_below(r, 3) ? rng_below(r, crossing_values((crossing_choice)c)) : 0;
      if (try[BY_OBJECTIVE] != TORTUOSITY)
        try[BY_SLACK] = try[BY_COST] = try[BY_MINIMIZE] = try[BY_TOUR] = 0;
      if (try[BY_OBJECTIVE] != SYMMETRY) try[BY_PREFER] = try[BY_GEOMETRIC] = 0;
    } while (crossing_is_refused(try) || !wanted(try, only));
    double found = score(t, try);
    if (found <= best) continue;
    best = found;
    memcpy(value, try, sizeof try);
  }
}

void crossing_count(crossing_tally *t, const int *value)
{
  for (int a = 0; a < N_CHOICES; a++)
    for (int b = 0; b < N_CHOICES; b++)
      t->met[a][value[a]][b][value[b]]++;
}

void crossing_print(const crossing_tally *t)
{
  for (int a = 0; a < N_CHOICES; a++)
    for (int i = 0; i < crossing_values((crossing_choice)a); i++) {
      printf("%s %s: %d\n ", crossing_name[a], crossing_value[a][i], t->met[a][i][a][i]);
      for (int b = 0; b < a; b++) {
        printf(" %s", crossing_name[b]);
        for (int k = 0; k < crossing_values((crossing_choice)b); k++)
          printf("%s%s %d", k ? ", " : " ", crossing_value[b][k], t->met[a][i][b][k]);
        printf(";");
      }
      printf("\n");
    }
}

/* ---- frameworks ---- */

enum { MOST_NODES = 30, MOST_EDGES = 24 };

typedef struct {
  int n, m, pieces;
  double xyz[MOST_NODES][3];
  int edge[MOST_EDGES][2], piece[MOST_NODES];
} sketch;

static bool joined(const sketch *s, int a, int b)
{
  for (int e = 0; e < s->m; e++)
    if ((s->edge[e][0] == a && s->edge[e][1] == b) || (s->edge[e][0] == b && s->edge[e][1] == a))
      return true;
  return false;
}

static int degree(const sketch *s, int v)
{
  int d = 0;
  for (int e = 0; e < s->m; e++)
    d += (s->edge[e][0] == v) + (s->edge[e][1] == v);
  return d;
}

static void join(rng *r, sketch *s, int a, int b)
{
  int turned = rng_below(r, 2);
  s->edge[s->m][turned] = a;
  s->edge[s->m++][1 - turned] = b;
}

static bool taken(const sketch *s, const double *at)
{
  for (int v = 0; v < s->n; v++)
    if (memcmp(s->xyz[v], at, sizeof s->xyz[v]) == 0) return true;
  return false;
}

/* A node of piece k, on a small grid or anywhere; pieces are apart. */
static void place(rng *r, sketch *s, int k, bool grid)
{
  double at[3];
  do {
    for (int i = 0; i < 3; i++)
      at[i] = grid ? 50 * rng_below(r, i < 2 ? 3 : 2) : floor(rng_unit(r) * 1e5) / 1e3;
    at[0] += 400 * k;
  } while (taken(s, at));
  s->piece[s->n] = k;
  memcpy(s->xyz[s->n++], at, sizeof at);
}

/* A tree and further edges, no node with more than four. */
static void add_random(rng *r, sketch *s, int k, int m, bool grid)
{
  int first = s->n, n = rng_between(r, m < 3 ? m + 1 : m < 6 ? 3 : 4, m + 1);
  for (int i = 0; i < n; i++)
    place(r, s, k, grid);
  for (int v = first + 1, to; v < s->n; v++) {
    do
      to = first + rng_below(r, v - first);
    while (degree(s, to) > 3);
    join(r, s, to, v);
  }
  for (int tries = 0, made = n - 1; tries < 100 && made < m; tries++) {
    int a = first + rng_below(r, n), b = first + rng_below(r, n);
    if (a == b || joined(s, a, b) || degree(s, a) > 3 || degree(s, b) > 3) continue;
    join(r, s, a, b);
    made++;
  }
}

static int put(sketch *s, int k, double x, double y, double z)
{
  const double at[3] = {x + 400 * k, y, z};
  s->piece[s->n] = k;
  memcpy(s->xyz[s->n], at, sizeof at);
  return s->n++;
}

/* Ring, path, star, tetrahedron, ring with a diagonal or with a tail. */
static void add_regular(rng *r, sketch *s, int k, int m)
{
  int kind = rng_below(r, m > 3 ? 6 : 5), a = s->n;
  if (kind == 5) { /* tetrahedron */
    for (int i = 0; i < 4; i++)
      put(s, k, 50.0 * (i & 1), 50.0 * (i >> 1), i == 0 || i == 3 ? 0 : 50);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < i; j++)
        join(r, s, a + i, a + j);
    return;
  }
  if (kind == 0 || m < 3) { /* path */
    for (int i = 0; i <= m; i++)
      put(s, k, 40.0 * i, 0, 0);
    for (int i = 0; i < m; i++)
      join(r, s, a + i, a + i + 1);
    return;
  }
  bool star = kind == 1 && m <= 4, more = !star && kind > 2 && m > 3;
  int around = star ? m : more ? m - 1 : m;
  for (int i = 0; i < around; i++)
    put(s, k, 50 * cos(4 * acos(0) * i / around), 50 * sin(4 * acos(0) * i / around), 0);
  if (star || (more && (kind == 3 || around < 4))) put(s, k, star ? 0 : 90, 0, 0);
  for (int i = 0; i < around; i++)
    join(r, s, a + i, star ? a + around : a + (i + 1) % around);
  if (more) join(r, s, a, s->n - a > around ? a + around : a + around / 2);
}

static sketch sketch_make(rng *r, int pieces, int shape, int most_edges)
{
  sketch s = {.pieces = pieces};
  for (int k = 0; k < pieces; k++) {
    int m = rng_between(r, k ? 1 : 2, pieces > 1 && most_edges > 4 ? 4 : most_edges);
    if (k && rng_below(r, 3) == 0) m = rng_between(r, 1, most_edges);
    if (shape == SHAPE_REGULAR)
      add_regular(r, &s, k, m);
    else
      add_random(r, &s, k, m, shape == SHAPE_GRID);
  }
  return s;
}

/* ---- writing it ---- */

static void put_members(FILE *out, const char *name, int n, const char *const *text)
{
  fprintf(out, ",\n\"%s\": [", name);
  for (int i = 0; i < n; i++)
    fprintf(out, "%s%s", i ? "," : "", text[i]);
  fprintf(out, "]");
}

/* Nodes at random, in most pieces at least one. */
static void choose_nodes(rng *r, const sketch *s, bool *chosen)
{
  for (int v = 0; v < s->n; v++)
    chosen[v] = rng_below(r, 2);
  for (int k = 0; k < s->pieces; k++) {
    int v;
    do
      v = rng_below(r, s->n);
    while (s->piece[v] != k);
    if (rng_below(r, 15)) chosen[v] = true;
  }
}

static void write_sketch(rng *r, const sketch *s, const int *value, const char *path)
{
  static const double units[] = {0, 10, 0, 0};
  char text[3][MOST_EDGES][40];
  const char *list[3][MOST_EDGES];
  int capacity_least = value[BY_COVER] || value[BY_DISTINCT] ? 2 : 1;
  bool foot[MOST_NODES];
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  fprintf(out, "{\"format\": \"thread-frame\", \"version\": 1, \"units\": \"mm\",\n\"nodes\": [");
  for (int v = 0; v < s->n; v++)
    fprintf(out, "%s[%.17g,%.17g,%.17g]", v ? "," : "", s->xyz[v][0], s->xyz[v][1], s->xyz[v][2]);
  fprintf(out, "],\n\"edges\": [");
  for (int e = 0; e < s->m; e++) {
    fprintf(out, "%s[%d,%d]", e ? "," : "", s->edge[e][0], s->edge[e][1]);
    int cover = rng_below(r, 3) ? 1 : rng_between(r, 1, 3), room = rng_below(r, 3);
    double length =
        value[BY_LENGTHS] == 3 ? rng_between(r, 1, 5) : 10 + floor(rng_unit(r) * 90000) / 1000;
    if (value[BY_LENGTHS] == 1) length = units[1];
    if (value[BY_PASSES] == 2) cover = 1;
    int least = cover > capacity_least ? cover : capacity_least;
    snprintf(text[0][e], sizeof *text[0], "%.17g", length);
    snprintf(text[1][e], sizeof *text[1], "%d", cover);
    if (rng_below(r, 2))
      snprintf(text[2][e], sizeof *text[2], "null");
    else
      snprintf(text[2][e], sizeof *text[2], "%d", least + room);
    for (int i = 0; i < 3; i++)
      list[i][e] = text[i][e];
  }
  fprintf(out, "]");
  if (value[BY_LENGTHS]) put_members(out, "lengths", s->m, list[0]);
  if (value[BY_PASSES] & 1) put_members(out, "covers", s->m, list[1]);
  if (value[BY_PASSES] & 2) put_members(out, "capacities", s->m, list[2]);
  choose_nodes(r, s, foot);
  fprintf(out, ",\n\"feet\": [");
  for (int v = 0, n = 0; v < s->n; v++)
    if (foot[v]) fprintf(out, "%s%d", n++ ? "," : "", v);
  fprintf(out, "]}\n");
  ck_assert_int_eq(fclose(out), 0);
}

/* ---- options ---- */

__attribute__((format(printf, 2, 3))) static void say(crossing_case *c, const char *format, ...)
{
  size_t n = strlen(c->arguments);
  va_list list;
  va_start(list, format);
  vsnprintf(c->arguments + n, sizeof c->arguments - n, format, list);
  va_end(list);
}

static void say_list(crossing_case *c, const sketch *s, rng *r)
{
  int n = 0;
  c->o.ends = THR_ENDS_NODES;
  c->o.end_node = calloc((size_t)s->n, sizeof *c->o.end_node);
  ck_assert_ptr_nonnull(c->o.end_node);
  choose_nodes(r, s, c->o.end_node);
  for (int v = 0; v < s->n; v++)
    n += c->o.end_node[v];
  if (n == 0) c->o.end_node[0] = true;
  say(c, " --ends ");
  for (int v = 0, put_before = 0; v < s->n; v++)
    if (c->o.end_node[v]) say(c, "%s%d", put_before++ ? "," : "", v);
}

/* Ends of as many cords as asked for in every piece, at nodes at random. */
static void say_counts(crossing_case *c, const sketch *s, rng *r)
{
  int least = c->o.cords_least, most = c->o.cords, n = 0, fewest = 1000, greatest = 0;
  bool free_number = c->value[BY_CORDS] == CORDS_UNSAID || most > 4;
  c->o.ends = THR_ENDS_COUNTS;
  c->o.end_count = calloc((size_t)s->n, sizeof *c->o.end_count);
  ck_assert_ptr_nonnull(c->o.end_count);
  for (int k = 0; k < s->pieces; k++) {
    int one = c->o.distinct > 0 ? c->o.distinct : 1;
    int cords = c->value[BY_TOUR] ? 1
                : free_number     ? rng_between(r, one, 2)
                                  : rng_between(r, least, most < 3 ? most : 3);
    if (cords < fewest) fewest = cords;
    if (cords > greatest) greatest = cords;
    for (int i = 0; i < 2 * cords;) {
      int v = rng_below(r, s->n);
      if (s->piece[v] == k) c->o.end_count[v]++, i++;
    }
  }
  say(c, " --ends ");
  for (int v = 0; v < s->n; v++)
    if (c->o.end_count[v]) say(c, "%s%d:%d", n++ ? "," : "", v, c->o.end_count[v]);
  c->o.cords_least = fewest;
  c->o.cords = greatest;
}

static void say_cords(crossing_case *c)
{
  static const int least[] = {1, 2, 3, 1, 2, 1, 1}, most[] = {1, 2, 3, 3, 4, 8, 1000};
  int i = c->value[BY_CORDS];
  c->o.cords_least = least[i];
  c->o.cords = i == CORDS_UNSAID && c->value[BY_LIMIT] ? 1000 : most[i];
  if (c->o.cords_least < c->o.distinct) c->o.cords_least = c->o.distinct;
  if (c->o.cords < c->o.distinct) c->o.cords = c->o.distinct;
  if (i != CORDS_UNSAID) say(c, " --cords %s", crossing_value[BY_CORDS][i]);
}

/* A limit between the longest edge and all of the largest piece, at times exactly some edges. */
static void say_limit(crossing_case *c, const sketch *s, rng *r)
{
  double total[MOST_NODES] = {0}, most = 0;
  for (int e = 0; e < c->f.n_edges; e++) {
    int k = s->piece[c->f.edge[e][0]], cover = c->o.cover;
    if (c->f.cover && c->f.cover[e] > cover) cover = c->f.cover[e];
    total[k] += cover * c->f.length[e];
  }
  for (int k = 0; k < s->pieces; k++)
    most = fmax(most, total[k]);
  double limit = most * (0.35 + rng_unit(r));
  if (rng_below(r, 3) == 0) {
    limit = 0;
    for (int i = rng_between(r, 2, 2 + c->f.n_edges); i > 0; i--)
      limit += c->f.length[rng_below(r, c->f.n_edges)];
  }
  char text[32];
  snprintf(text, sizeof text, "%.9g", limit);
  c->o.max_length = strtod(text, NULL);
  say(c, " --max-length %s", text);
}

static void say_turning(crossing_case *c)
{
  static const double slack[] = {-1, 0, 0.1, 0.4};
  const int *v = c->value;
  c->o.turning.length_slack = slack[v[BY_SLACK]];
  c->o.turning.cost = (thr_turn_cost)v[BY_COST];
  if (v[BY_MINIMIZE] && v[BY_OBJECTIVE] == TORTUOSITY)
    c->o.aims.aim[c->o.aims.n - 1] = THR_AIM_MAX_TURNING;
  c->o.turning.tour = (thr_tour)v[BY_TOUR];
  if (v[BY_SLACK]) say(c, " --length-slack %s", crossing_value[BY_SLACK][v[BY_SLACK]]);
  if (v[BY_COST]) say(c, " --turn-cost %s", crossing_value[BY_COST][v[BY_COST]]);
  if (v[BY_MINIMIZE]) say(c, " --minimize max-turning");
  if (v[BY_TOUR]) say(c, " --tour %s", crossing_value[BY_TOUR][v[BY_TOUR]]);
}

static void say_options(crossing_case *c, const sketch *s, rng *r)
{
  enum { BALANCED = 3 };
  static const char *const aims[] = {"length",  "turning",         "overlap,steps",
                                     "longest", "longest,turning", "longest,overlap,steps"};
  const int *v = c->value;
  c->o = thr_request_default();
  want(&c->o, aims[v[BY_BALANCE] ? BALANCED + v[BY_OBJECTIVE] : v[BY_OBJECTIVE]]);
  c->o.joint = v[BY_JOINT] ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  c->o.cover = v[BY_COVER] || v[BY_DISTINCT] ? 2 : 1;
  c->o.distinct = v[BY_DISTINCT] ? 2 : 0;
  c->o.capacity = v[BY_CAPACITY];
  c->o.symmetry.counted = v[BY_CORDS] || v[BY_LIMIT];
  if (v[BY_OBJECTIVE]) say(c, " --objective %s", crossing_value[BY_OBJECTIVE][v[BY_OBJECTIVE]]);
  if (v[BY_JOINT]) say(c, " --joint tube");
  if (v[BY_COVER]) say(c, " --cover 2");
  if (v[BY_DISTINCT]) say(c, " --distinct 2");
  if (v[BY_CAPACITY]) say(c, " --capacity %d", v[BY_CAPACITY]);
  if (v[BY_BALANCE]) say(c, " --balance");
  if (v[BY_ENGINE]) say(c, " --tune engine=%s", crossing_value[BY_ENGINE][v[BY_ENGINE]]);
  if (v[BY_PREFER]) say(c, " --prefer %s", crossing_value[BY_PREFER][v[BY_PREFER]]);
  if (v[BY_GEOMETRIC]) say(c, " --geometric 0.01");
  say_cords(c);
  say_turning(c);
  if (v[BY_LIMIT]) say_limit(c, s, r);
  switch (v[BY_ENDS]) {
  case 0: c->o.ends = THR_ENDS_CLOSED; break;
  case 3: say_list(c, s, r); break;
  case 4: say_counts(c, s, r); break;
  default:
    c->o.ends = v[BY_ENDS] == 1 ? THR_ENDS_ANY : THR_ENDS_FEET;
    say(c, " --ends %s", crossing_value[BY_ENDS][v[BY_ENDS]]);
  }
}

crossing_case crossing_make(rng *r, const int *value, const char *path, int most_edges)
{
  crossing_case c = {0};
  sketch s = sketch_make(r, value[BY_PIECES] + 1, value[BY_SHAPE], most_edges);
  memcpy(c.value, value, sizeof c.value);
  snprintf(c.frame_path, sizeof c.frame_path, "%s", path);
  write_sketch(r, &s, value, path);
  c.f = frame_load(path, NULL);
  ck_assert_int_eq(c.f.n_nodes, s.n);
  ck_assert_int_eq(c.f.n_edges, s.m);
  say_options(&c, &s, r);
  return c;
}

void crossing_destroy(crossing_case *c)
{
  thr_frame_destroy(&c->f);
  free(c->o.end_node);
  free(c->o.end_count);
  *c = (crossing_case){0};
}
