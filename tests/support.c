/* Builders and oracles of the tests. */
#include "tests/support.h"
#include "graph/angle.h"
#include "graph/io/read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- running ---- */

int run_suite(Suite *s)
{
  SRunner *runner = srunner_create(s);
  srunner_run_all(runner, CK_NORMAL);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

void add_case(Suite *s, const char *name, double seconds, const TTest *test, int first, int end)
{
  TCase *t = tcase_create(name);
  tcase_set_timeout(t, seconds);
  tcase_add_loop_test(t, test, first, end);
  suite_add_tcase(s, t);
}

static int share(void)
{
  const char *text = getenv("THREAD_TEST_SHARE");
  int n = text ? atoi(text) : 1;
  return n > 1 ? n : 1;
}

int share_of(int n)
{
  return (n + share() - 1) / share();
}

/* One of each run of share() numbers, its place in the run another each time: kinds that take turns all have theirs. */
void add_examples(Suite *s, const char *name, double seconds, const TTest *test, int end)
{
  TCase *t = tcase_create(name);
  tcase_set_timeout(t, seconds);
  for (int first = 0, run = 0; first < end; first += share(), run++) {
    int i = first + 7 * run % (end - first < share() ? end - first : share());
    tcase_add_loop_test(t, test, i, i + 1);
  }
  suite_add_tcase(s, t);
}

void add_large(Suite *s, const char *name, double seconds, const TTest *test, int first, int end)
{
  if (share() == 1) add_case(s, name, seconds, test, first, end);
}

void assert_one_line(const thr_err *err, const char *word)
{
  ck_assert_int_ne(err->code, THR_OK);
  ck_assert_int_gt((int)strlen(err->text), 3);
  ck_assert_msg(!strchr(err->text, '\n'), "%s", err->text);
  ck_assert_msg(!word || strstr(err->text, word), "\"%s\" does not name \"%s\"", err->text, word);
}

/* ---- random numbers: xorshift64* ---- */

rng rng_make(uint64_t seed)
{
  return (rng){seed * UINT64_C(0x9e3779b97f4a7c15) | 1};
}

static uint64_t rng_next(rng *r)
{
  r->state ^= r->state >> 12;
  r->state ^= r->state << 25;
  r->state ^= r->state >> 27;
  return r->state * UINT64_C(0x2545f4914f6cdd1d);
}

double rng_unit(rng *r)
{
  return (double)(rng_next(r) >> 11) / 9007199254740992.0;
}

int rng_below(rng *r, int n)
{
  return (int)(rng_unit(r) * n);
}

int rng_between(rng *r, int low, int high)
{
  return low + rng_below(r, high - low + 1);
}

void rng_shuffle(rng *r, int *a, int n)
{
  for (int i = n - 1; i > 0; i--) {
    int j = rng_below(r, i + 1), kept = a[i];
    a[i] = a[j];
    a[j] = kept;
  }
}

/* ---- requests ---- */

void want(thr_request *o, const char *aims)
{
  thr_err err = {0};
  const thr_turning_options turning = o->turning;
  ck_assert_msg(thr_aims_parse(aims, o, &err) == THR_OK, "%s: %s", aims, err.text);
  o->turning = turning;
}

thr_status length_plan(const thr_frame *f, const thr_request *o, const thr_limits *limits, thr_plan *p, thr_cords_word *word,
                       thr_err *err)
{
  thr_report r = {0};
  thr_status st = thr_planner_length(f, o, limits, p, &r, err);
  if (word) *word = r.word;
  return st;
}

/* ---- frameworks ---- */

thr_frame frame_make(int n, const double (*xyz)[3], int m, const int (*edge)[2], const double *length, const int *feet)
{
  thr_draft d = {0};
  thr_frame f;
  thr_read_report report;
  thr_err err = {0};
  for (int v = 0; v < n; v++)
    ck_assert_int_eq(thr_draft_add_node(&d, xyz[v], NULL, false, NULL), THR_OK);
  for (int e = 0; e < m; e++)
    ck_assert_int_eq(thr_draft_add_edge(&d, edge[e][0], edge[e][1], length ? length[e] : 0, NULL), THR_OK);
  for (int i = 0; feet && feet[i] >= 0; i++)
    d.node[feet[i]].foot = true;
  ck_assert_msg(thr_draft_build(&d, 0, &f, &report, &err) == THR_OK, "%s", err.text);
  ck_assert_int_eq(f.n_nodes, n);
  ck_assert_int_eq(f.n_edges, m);
  thr_draft_destroy(&d);
  return f;
}

thr_frame frame_load(const char *path, const char *edges_path)
{
  thr_frame f;
  thr_read_report report;
  thr_err err = {0};
  thr_read_options o = thr_read_options_default();
  o.edges_path = edges_path;
  ck_assert_msg(thr_frame_read(&f, &report, path, &o, NULL, 0, &err) == THR_OK, "%s", err.text);
  return f;
}

/* Joins the points that are nearest to each other and scales their distance to 1. */
static thr_frame nearest_frame(int n, double (*xyz)[3])
{
  int edge[64][2], m = 0;
  double near = INFINITY;
  for (int pass = 0; pass < 2; pass++)
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++) {
        double d = hypot(hypot(xyz[a][0] - xyz[b][0], xyz[a][1] - xyz[b][1]), xyz[a][2] - xyz[b][2]);
        if (pass == 0)
          near = fmin(near, d);
        else if (d < 1.001 * near)
          edge[m][0] = a, edge[m++][1] = b;
      }
  for (int v = 0; v < n; v++)
    for (int i = 0; i < 3; i++)
      xyz[v][i] /= near;
  return frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL);
}

thr_frame solid_make(solid s)
{
  const double g = (1 + sqrt(5)) / 2;
  double xyz[20][3];
  int n = 0;
  if (s == TETRAHEDRON || s == CUBE || s == DODECAHEDRON)
    for (int i = 0; i < 8; i++) {
      double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
      if (s == TETRAHEDRON && x * y * z < 0) continue;
      xyz[n][0] = x, xyz[n][1] = y, xyz[n++][2] = z;
    }
  if (s == OCTAHEDRON)
    for (int i = 0; i < 6; i++, n++)
      for (int k = 0; k < 3; k++)
        xyz[n][k] = k == i / 2 ? (i % 2 ? 1 : -1) : 0;
  if (s == DODECAHEDRON || s == ICOSAHEDRON)
    for (int i = 0; i < 12; i++, n++) {
      double a = i & 1 ? 1 : -1, b = i & 2 ? g : -g;
      if (s == DODECAHEDRON) a /= g;
      xyz[n][i / 4] = 0, xyz[n][(i / 4 + 1) % 3] = a, xyz[n][(i / 4 + 2) % 3] = b;
    }
  return nearest_frame(n, xyz);
}

/* Arrays of a generated framework, freed by finish. */
typedef struct {
  int n, m;
  double (*xyz)[3];
  int (*edge)[2];
  int *feet, n_feet;
} sketch;

static sketch sketch_make(int max_nodes, int max_edges)
{
  sketch s = {0};
  s.xyz = calloc((size_t)max_nodes, sizeof *s.xyz);
  s.edge = calloc((size_t)max_edges, sizeof *s.edge);
  s.feet = calloc((size_t)max_nodes + 1, sizeof *s.feet);
  ck_assert(s.xyz && s.edge && s.feet);
  return s;
}

static int put_node(sketch *s, double x, double y, double z)
{
  s->xyz[s->n][0] = x, s->xyz[s->n][1] = y, s->xyz[s->n][2] = z;
  return s->n++;
}

static void put_edge(sketch *s, int a, int b)
{
  s->edge[s->m][0] = a;
  s->edge[s->m++][1] = b;
}

static void put_foot(sketch *s, int v)
{
  s->feet[s->n_feet++] = v;
}

static thr_frame sketch_finish(sketch *s, const double *length)
{
  s->feet[s->n_feet] = -1;
  thr_frame f = frame_make(s->n, (const double(*)[3])s->xyz, s->m, (const int(*)[2])s->edge, length, s->feet);
  free(s->xyz);
  free(s->edge);
  free(s->feet);
  return f;
}

thr_frame path_make(int n)
{
  sketch s = sketch_make(n, n);
  for (int v = 0; v < n; v++)
    put_node(&s, v, 0, 0);
  for (int v = 1; v < n; v++)
    put_edge(&s, v - 1, v);
  put_foot(&s, 0);
  return sketch_finish(&s, NULL);
}

static void put_rim(sketch *s, int n, double radius)
{
  for (int v = 0; v < n; v++)
    put_node(s, radius * cos(2 * THR_PI * v / n), radius * sin(2 * THR_PI * v / n), 0);
}

thr_frame chain_make(int n, const double *length)
{
  double xyz[9][3] = {{0}};
  int edge[8][2];
  ck_assert_int_le(n, 8);
  for (int e = 0; e < n; e++) {
    xyz[e + 1][0] = xyz[e][0] + length[e];
    edge[e][0] = e, edge[e][1] = e + 1;
  }
  return frame_make(n + 1, (const double(*)[3])xyz, n, (const int(*)[2])edge, NULL, NULL);
}

thr_frame ring_make(int n)
{
  sketch s = sketch_make(n, n);
  put_rim(&s, n, 0.5 / sin(THR_PI / n));
  for (int v = 0; v < n; v++)
    put_edge(&s, v, (v + 1) % n);
  put_foot(&s, 0);
  return sketch_finish(&s, NULL);
}

static thr_frame spokes(int n, bool rim)
{
  sketch s = sketch_make(n + 1, 2 * n);
  put_node(&s, 0, 0, 0);
  put_rim(&s, n, 1);
  for (int v = 1; v <= n; v++)
    put_edge(&s, 0, v);
  for (int v = 1; v <= n && rim; v++)
    put_edge(&s, v, v % n + 1);
  put_foot(&s, 1);
  return sketch_finish(&s, NULL);
}

thr_frame star_make(int n)
{
  return spokes(n, false);
}

thr_frame wheel_make(int n)
{
  return spokes(n, true);
}

thr_frame grid_make(int w, int h)
{
  sketch s = sketch_make(w * h, 2 * w * h);
  for (int y = 0; y < h; y++)
    for (int x = 0; x < w; x++) {
      int v = put_node(&s, x, y, 0);
      if (x > 0) put_edge(&s, v - 1, v);
      if (y > 0) put_edge(&s, v - w, v);
      if ((x == 0 || x == w - 1) && (y == 0 || y == h - 1)) put_foot(&s, v);
    }
  return sketch_finish(&s, NULL);
}

thr_frame triangles_make(int n)
{
  sketch s = sketch_make(3 * n, 3 * n);
  for (int i = 0; i < n; i++) {
    int a = put_node(&s, 2 * i, 0, 0), b = put_node(&s, 2 * i + 1, 0, 0), c = put_node(&s, 2 * i + 0.5, sqrt(0.75), 0);
    put_edge(&s, a, b);
    put_edge(&s, b, c);
    put_edge(&s, c, a);
    put_foot(&s, b);
  }
  return sketch_finish(&s, NULL);
}

thr_frame side_by_side(const thr_frame *a, const thr_frame *b)
{
  const thr_frame *part[] = {a, b};
  sketch s = sketch_make(a->n_nodes + b->n_nodes, a->n_edges + b->n_edges);
  for (int k = 0; k < 2; k++) {
    int first = s.n;
    for (int v = 0; v < part[k]->n_nodes; v++) {
      const double *x = part[k]->xyz[v];
      put_node(&s, x[0] + 1000 * k, x[1] + 1000 * k, x[2] + 1000 * k);
      if (part[k]->foot[v]) put_foot(&s, first + v);
    }
    for (int e = 0; e < part[k]->n_edges; e++)
      put_edge(&s, first + part[k]->edge[e][0], first + part[k]->edge[e][1]);
  }
  return sketch_finish(&s, NULL);
}

static bool joined(const sketch *s, int a, int b)
{
  for (int e = 0; e < s->m; e++)
    if ((s->edge[e][0] == a && s->edge[e][1] == b) || (s->edge[e][0] == b && s->edge[e][1] == a)) return true;
  return false;
}

/* Nodes of odd degree into list; how many. */
static int odd_nodes(const sketch *s, int *list)
{
  int count = 0;
  for (int v = 0; v < s->n; v++) {
    int degree = 0;
    for (int e = 0; e < s->m; e++)
      degree += (s->edge[e][0] == v) + (s->edge[e][1] == v);
    if (degree % 2) list[count++] = v;
  }
  return count;
}

static void join_odd_nodes(rng *r, sketch *s, int most_odd)
{
  int *list = calloc((size_t)s->n, sizeof *list), k;
  ck_assert(list != NULL);
  for (int tries = 0; tries < 4 * s->n && (k = odd_nodes(s, list)) > most_odd; tries++) {
    int a = list[rng_below(r, k)], b = list[rng_below(r, k)];
    if (a != b && !joined(s, a, b)) put_edge(s, a, b);
  }
  free(list);
}

thr_frame random_frame(rng *r, int n, int extra, length_kind kind)
{
  return random_frame_few_odd(r, n, extra, kind, n);
}

thr_frame random_frame_few_odd(rng *r, int n, int extra, length_kind kind, int most_odd)
{
  int room = 2 * n + extra; /* joining takes at most n / 2 */
  sketch s = sketch_make(n, room);
  double *length = calloc((size_t)room, sizeof *length);
  ck_assert(length);
  for (int v = 0; v < n; v++)
    put_node(&s, 100 * rng_unit(r), 100 * rng_unit(r), 100 * rng_unit(r));
  for (int v = 1; v < n; v++)
    put_edge(&s, rng_below(r, v), v);
  for (int i = 0; i < extra; i++) {
    int a = rng_below(r, n), b = rng_below(r, n);
    if (a != b && !joined(&s, a, b)) put_edge(&s, a, b);
  }
  join_odd_nodes(r, &s, most_odd);
  for (int e = 0; e < s.m; e++)
    length[e] = kind == LENGTHS_EQUAL            ? 7.3
                : kind == LENGTHS_SMALL_INTEGERS ? rng_between(r, 1, 4)
                : kind == LENGTHS_RANDOM         ? 0.01 + 10 * rng_unit(r)
                : kind == LENGTHS_SURDS          ? rng_between(r, 1, 3) * sqrt(rng_between(r, 1, 3)) /* no common measure */
                                                 : 0;
  int some = rng_below(r, n);
  for (int v = 0; v < n; v++)
    if (v == some || rng_below(r, 4) == 0) put_foot(&s, v);
  thr_frame f = sketch_finish(&s, length);
  free(length);
  return f;
}

thr_frame shuffled_frame(rng *r, const thr_frame *f, int *to)
{
  sketch s = sketch_make(f->n_nodes, f->n_edges);
  int *order = calloc((size_t)f->n_edges, sizeof *order);
  double *length = calloc((size_t)f->n_edges, sizeof *length);
  ck_assert(order && length);
  for (int v = 0; v < f->n_nodes; v++)
    to[v] = v;
  for (int e = 0; e < f->n_edges; e++)
    order[e] = e;
  rng_shuffle(r, to, f->n_nodes);
  rng_shuffle(r, order, f->n_edges);
  s.n = f->n_nodes;
  for (int v = 0; v < f->n_nodes; v++) {
    memcpy(s.xyz[to[v]], f->xyz[v], sizeof *s.xyz);
    if (f->foot[v]) put_foot(&s, to[v]);
  }
  for (int e = 0; e < f->n_edges; e++) {
    int flip = rng_below(r, 2), old = order[e];
    length[e] = f->own_lengths ? f->length[old] : 0;
    put_edge(&s, to[f->edge[old][flip]], to[f->edge[old][1 - flip]]);
  }
  thr_frame g = sketch_finish(&s, length);
  free(order);
  free(length);
  return g;
}

/* ---- plans ---- */

thr_request options_for(thr_ends ends, int cover)
{
  thr_request o = thr_request_default();
  o.ends = ends;
  o.cover = cover;
  return o;
}

thr_plan plan_make(const thr_frame *f, const thr_request *o)
{
  thr_plan p;
  thr_err err = {0};
  thr_limits none = {0};
  thr_status st = thr_postman_plan(f, o, &none, &p, &err);
  ck_assert_msg(st == THR_OK, "status %d: %s", (int)st, err.text);
  return p;
}

thr_plan plan_simple(const thr_frame *f, thr_ends ends, int cover)
{
  thr_request o = options_for(ends, cover);
  return plan_make(f, &o);
}

static bool allowed(const thr_frame *f, const thr_request *o, int v)
{
  if (o->ends == THR_ENDS_FEET) return f->foot[v];
  if (o->ends == THR_ENDS_NODES) return o->end_node[v];
  if (o->ends == THR_ENDS_COUNTS) return o->end_count[v] > 0;
  return true;
}

/* One closed walk (Hierholzer) over passes and links: from odd node v a link leads to link[v], which is -1 elsewhere. walk
 * receives half-edges, and -1 for a link; left and link are used up. Returns how many. */
static int euler_walk(const thr_frame *f, int *left, int *link, int start, int room, int *walk)
{
  int *node = calloc((size_t)room + 1, sizeof *node), *came = calloc((size_t)room + 1, sizeof *came), top = 0, n = 0;
  ck_assert(node && came);
  node[0] = start;
  while (top >= 0) {
    int v = node[top], next = link[v], h = -1;
    if (next >= 0) {
      link[v] = link[next] = -1;
    } else {
      for (int i = f->first[v]; i < f->first[v + 1] && next < 0; i++)
        if (left[f->half[i] / 2] > 0) h = f->half[i], next = thr_head(f, h);
      if (next >= 0) left[h / 2]--;
    }
    if (next < 0) {
      if (top > 0) walk[n++] = came[top] < 0 ? -1 : came[top] ^ 1; /* the walk comes out backwards */
      top--;
      continue;
    }
    ck_assert_int_lt(top, room);
    node[++top] = next;
    came[top] = h;
  }
  free(node);
  free(came);
  return n;
}

static void add_piece(thr_plan *p, const int *half, int n)
{
  thr_cord *c = &p->cord[p->n_cords];
  ck_assert_int_gt(n, 0);
  *c = (thr_cord){.n_passes = n, .half = calloc((size_t)n, sizeof *c->half)};
  ck_assert(c->half != NULL);
  memcpy(c->half, half, (size_t)n * sizeof *half);
  c->closed = thr_cord_start(&p->frame, c) == thr_cord_end(&p->frame, c);
  thr_cord_id(p->n_cords++, c->id);
}

/* Cuts the walk at its links and, as long as more pieces are wanted, at the first places where an end may be. */
static void cut_walk(thr_plan *p, const int *walk, int n, int n_links)
{
  int more = p->options.cords - (n_links ? n_links : 1), from = 0;
  for (int i = 0; i < n; i++) {
    bool link = i + 1 < n && walk[i + 1] < 0, last = i + 1 == n;
    if (walk[i] < 0) {
      from = i + 1;
    } else if (link || last || (more > 0 && allowed(&p->frame, &p->options, thr_head(&p->frame, walk[i])))) {
      more -= !link && !last;
      add_piece(p, walk + from, i + 1 - from);
      from = i + 1;
    }
  }
}

thr_plan plan_of_cords(const thr_frame *f, const thr_request *o)
{
  thr_plan p = {0};
  thr_shortest s;
  thr_err err = {0};
  int n_links = 0, room = 0, start = -1, *link = calloc((size_t)f->n_nodes, sizeof *link);
  ck_assert_msg(thr_postman_shortest(f, o, &(thr_limits){0}, &s, &err) == THR_OK, "%s", err.text);
  ck_assert(link && thr_plan_request(&p, f, o, NULL) == THR_OK);
  for (int e = 0; e < f->n_edges; e++)
    room += s.passes[e];
  for (int v = 0, odd = -1; v < f->n_nodes; v++) {
    int sum = 0;
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      sum += s.passes[f->half[i] / 2];
    link[v] = -1;
    if (start < 0 && allowed(f, o, v)) start = v;
    if (sum % 2 == 0) continue;
    if (odd >= 0)
      link[v] = odd, link[odd] = v, n_links++, odd = -1;
    else
      odd = v;
    start = v;
  }
  int *walk = calloc((size_t)(room + n_links) + 1, sizeof *walk), *left = calloc((size_t)f->n_edges, sizeof *left);
  p.cord = calloc((size_t)o->cords, sizeof *p.cord);
  ck_assert(walk && left && p.cord);
  memcpy(left, s.passes, (size_t)f->n_edges * sizeof *left);
  cut_walk(&p, walk, euler_walk(f, left, link, start, room + n_links, walk), n_links);
  ck_assert_int_eq(p.n_cords, o->cords);
  p.options.cords_least = o->cords;
  ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL), THR_OK);
  ck_assert_msg(thr_postman_prove(&p.frame, &p.options, p.cord, p.n_cords, &s, &p.proof, &err) == THR_OK, "%s", err.text);
  thr_shortest_destroy(&s);
  free(walk);
  free(left);
  free(link);
  return p;
}

void add_loops(thr_cord *cord, int *n, int edge, int count)
{
  for (int i = 0; i < count; i++) {
    cord[*n] = (thr_cord){.closed = true, .n_passes = 2, .half = calloc(2, sizeof(int))};
    ck_assert_ptr_nonnull(cord[*n].half);
    thr_cord_id(*n, cord[*n].id);
    cord[*n].half[0] = 2 * edge;
    cord[(*n)++].half[1] = 2 * edge + 1;
  }
}

thr_text plan_text(const thr_plan *p)
{
  thr_text t = {0};
  thr_plan_write(p, &t);
  ck_assert(!t.failed && t.length > 0);
  return t;
}

thr_plan plan_from(const char *text)
{
  thr_plan p;
  thr_err err = {0};
  ck_assert_msg(thr_plan_parse(&p, text, strlen(text), "plan", &err) == THR_OK, "%s", err.text);
  return p;
}

void assert_same_text(const thr_text *a, const thr_text *b)
{
  size_t i = 0;
  while (a->data[i] && a->data[i] == b->data[i])
    i++;
  ck_assert_msg(a->length == b->length && i == a->length, "texts differ from byte %d on: %.60s | %.60s", (int)i, a->data + i,
                b->data + i);
}

void assert_plan_sound(const thr_plan *p)
{
  thr_err err = {0};
  ck_assert_msg(thr_check_plan(p, &err) == THR_OK, "%s", err.text);
  thr_text once = plan_text(p);
  thr_plan back = plan_from(once.data);
  ck_assert_msg(thr_check_plan(&back, &err) == THR_OK, "%s", err.text);
  thr_text twice = plan_text(&back);
  assert_same_text(&once, &twice);
  thr_plan_destroy(&back);
  thr_text_destroy(&once);
  thr_text_destroy(&twice);
}

thr_status judge_text(const char *text, size_t n, thr_err *err)
{
  thr_plan p;
  thr_status st = thr_plan_parse(&p, text, n, "plan", err);
  if (!st) st = thr_check_plan(&p, err);
  thr_plan_destroy(&p);
  return st;
}

thr_status judge_plan(const thr_plan *p, thr_err *err)
{
  thr_text t = plan_text(p);
  thr_status st = judge_text(t.data, t.length, err);
  thr_text_destroy(&t);
  return st;
}

/* ---- oracles ---- */

/* Passes that an edge needs, and may it have more? */
static int needed(const thr_frame *f, const thr_request *o, int e)
{
  int own = f->cover ? f->cover[e] : 1;
  return own > o->cover ? own : o->cover;
}

static bool roomy(const thr_frame *f, const thr_request *o, int e)
{
  int n = needed(f, o, e), own = f->capacity ? f->capacity[e] : 0;
  return (o->capacity == 0 || o->capacity > n) && (own == 0 || own > n);
}

/* Is the number of passes at v that its edges need, together with the ends that it is to have, odd? */
static bool odd_need(const thr_frame *f, const thr_request *o, int v)
{
  int sum = o->ends == THR_ENDS_COUNTS ? o->end_count[v] : 0;
  for (int e = 0; e < f->n_edges; e++)
    if (f->edge[e][0] == v || f->edge[e][1] == v) sum += needed(f, o, e);
  return sum % 2;
}

/* Ends of cords in a component, as many as may be anywhere. */
static int ends_of(const thr_request *o)
{
  return o->ends == THR_ENDS_CLOSED || o->ends == THR_ENDS_COUNTS ? 0 : 2 * o->cords;
}

/* May cords end so that exactly the nodes of this set are left odd? */
static bool ends_fit(const thr_frame *f, const thr_request *o, uint64_t odd)
{
  int n = 0;
  bool any = false;
  for (int v = 0; v < f->n_nodes; v++) {
    any |= allowed(f, o, v);
    if (!(odd >> v & 1)) continue;
    if (!allowed(f, o, v)) return false;
    n++;
  }
  return any && n <= ends_of(o);
}

double least_extra_by_subsets(const thr_frame *f, const thr_request *o)
{
  ck_assert(f->n_nodes <= 64 && f->n_edges <= 20);
  double best = INFINITY;
  uint64_t odd_before = 0;
  for (int v = 0; v < f->n_nodes; v++)
    odd_before |= (uint64_t)odd_need(f, o, v) << v;
  for (uint32_t s = 0; s < UINT32_C(1) << f->n_edges; s++) {
    uint64_t odd = odd_before;
    double length = 0;
    for (int e = 0; e < f->n_edges; e++)
      if (s >> e & 1) {
        length += roomy(f, o, e) ? f->length[e] : INFINITY;
        odd ^= UINT64_C(1) << f->edge[e][0] ^ UINT64_C(1) << f->edge[e][1];
      }
    if (length < best && ends_fit(f, o, odd)) best = length;
  }
  return best;
}

/* Floyd and Warshall, over edges with room; [n * n], freed by the caller. */
static double *distances(const thr_frame *f, const thr_request *o)
{
  int n = f->n_nodes;
  double *d = calloc((size_t)(n * n), sizeof *d);
  ck_assert(d != NULL);
  for (int i = 0; i < n * n; i++)
    d[i] = i % n == i / n ? 0 : INFINITY;
  for (int e = 0; e < f->n_edges; e++) {
    int a = f->edge[e][0], b = f->edge[e][1];
    if (roomy(f, o, e)) d[a * n + b] = d[b * n + a] = fmin(d[a * n + b], f->length[e]);
  }
  for (int k = 0; k < n; k++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        d[i * n + j] = fmin(d[i * n + j], d[i * n + k] + d[k * n + j]);
  return d;
}

/* least[s] = least total distance of pairing the odd nodes of subset s where free_ends of them may instead run to an
 * end of a cord: end[i] = distance of odd node i to the nearest allowed end. */
static double pair_subsets(const double *d, int n, const int *odd, int k, const double *end, int free_ends)
{
  double *least = calloc((size_t)(free_ends + 1) << k, sizeof *least);
  ck_assert(least != NULL);
  for (int used = 0; used <= free_ends; used++)
    for (uint32_t s = 0; s < UINT32_C(1) << k; s++) {
      double *at = &least[((uint32_t)used << k) + s];
      *at = s ? INFINITY : 0;
      if (!s) continue;
      int i = 0;
      while (!(s >> i & 1))
        i++;
      for (int j = i + 1; j < k; j++)
        if (s >> j & 1) *at = fmin(*at, d[odd[i] * n + odd[j]] + least[((uint32_t)used << k) + (s ^ 1u << i ^ 1u << j)]);
      if (used > 0) *at = fmin(*at, end[i] + least[((uint32_t)(used - 1) << k) + (s ^ 1u << i)]);
    }
  double found = least[((size_t)(free_ends + 1) << k) - 1];
  free(least);
  return found;
}

double least_extra_by_matching(const thr_frame *f, const thr_request *o)
{
  int odd[18], k = 0, n = f->n_nodes;
  double end[18], *d = distances(f, o);
  for (int v = 0; v < n; v++)
    if (odd_need(f, o, v)) {
      ck_assert_int_lt(k, 18);
      odd[k++] = v;
    }
  for (int i = 0; i < k; i++) {
    end[i] = INFINITY;
    for (int v = 0; v < n; v++)
      if (allowed(f, o, v)) end[i] = fmin(end[i], d[odd[i] * n + v]);
  }
  double best = pair_subsets(d, n, odd, k, end, ends_of(o));
  free(d);
  return best;
}

int forced_u_turns(const thr_plan *p)
{
  const thr_frame *f = &p->frame;
  int *passes = calloc((size_t)f->n_edges, sizeof *passes), *ends = calloc((size_t)f->n_nodes, sizeof *ends), forced = 0;
  ck_assert(passes && ends);
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    for (int k = 0; k < c->n_passes; k++)
      passes[c->half[k] / 2]++;
    if (p->options.ends == THR_ENDS_CLOSED) continue; /* the measure counts the turn where it closes */
    ends[f->edge[c->half[0] / 2][c->half[0] % 2]]++;
    ends[f->edge[c->half[c->n_passes - 1] / 2][1 - c->half[c->n_passes - 1] % 2]]++;
  }
  for (int v = 0; v < f->n_nodes; v++) {
    int all = ends[v], most = 0;
    for (int e = 0; e < f->n_edges; e++) {
      if (f->edge[e][0] != v && f->edge[e][1] != v) continue;
      all += passes[e];
      if (passes[e] > most) most = passes[e];
    }
    if (2 * most > all) forced += (2 * most - all) / 2;
  }
  free(passes);
  free(ends);
  return forced;
}

/* ---- certificates in plain sums ---- */

__extension__ typedef __int128 big;

/* Which sets hold which node, set after set, written out: [n_cuts * n_nodes], freed by the caller. NULL if the cuts are no forest
 * of sets. */
static bool *written_out(const thr_certificate *c, int n)
{
  bool *in = calloc((size_t)c->n_cuts * (size_t)n + 1, sizeof *in), good = true;
  ck_assert(in != NULL);
  for (int i = 0; i < c->n_cuts; i++)
    good &= c->cut[i].parent == -1 || (c->cut[i].parent > i && c->cut[i].parent < c->n_cuts);
  for (int i = 0; i < c->n_cuts && good; i++)
    for (int j = 0; j < c->cut[i].n_nodes; j++) {
      good &= j == 0 || c->cut[i].node[j - 1] < c->cut[i].node[j];
      for (int k = i; k >= 0; k = c->cut[k].parent) {
        bool *at = &in[k * n + c->cut[i].node[j]];
        good &= !*at;
        *at = true;
      }
    }
  if (good) return in;
  free(in);
  return NULL;
}

static int verdict_of_sets(const thr_plan *p, const thr_certificate *c, const bool *in, const int *component, const int *passes)
{
  const thr_frame *f = &p->frame;
  const thr_request *o = &p->options;
  int n = f->n_nodes;
  bool more = false, weightless = false;
  big sum = 0, join = 0, d = c->denominator;
  double up[2] = {0}, total = 0, extra_length = 0; /* up: what lengths are rounded up by, in all and beyond 5e-10 */
  for (int i = 0; i < c->n_cuts; i++) {
    int odd = 0;
    for (int v = 0; v < n; v++) {
      if (in[i * n + v] && component[v] != c->component) return 0;
      odd += in[i * n + v] && odd_need(f, o, v);
    }
    if (odd % 2 == 0 || c->cut[i].value < 0) return 0;
    sum += c->cut[i].value;
  }
  for (int e = 0; e < f->n_edges; e++) {
    if (component[f->edge[e][0]] != c->component) continue;
    big w = (big)nearbyint(f->length[e] * c->scale), load = 0;
    int extra = passes[e] - needed(f, o, e);
    for (int i = 0; i < c->n_cuts; i++)
      if (in[i * n + f->edge[e][0]] != in[i * n + f->edge[e][1]]) load += c->cut[i].value;
    if (roomy(f, o, e) && load > w * d) return 0;
    join += w * extra;
    more |= extra > 0;
    weightless |= extra > 0 && w == 0;
    for (int k = 0; k < 2 && roomy(f, o, e); k++)
      up[k] += fmax(0, (double)w / c->scale * (k ? 1 - 5e-10 : 1) - f->length[e]);
    extra_length += extra * f->length[e];
    total += f->length[e];
  }
  if (c->end_price < 0 || (ends_of(o) == 0 && c->end_price != 0)) return 0;
  for (int v = 0; v < n && ends_of(o) > 0; v++) {
    big held = 0;
    for (int i = 0; i < c->n_cuts; i++)
      if (in[i * n + v]) held += c->cut[i].value;
    if (component[v] == c->component && allowed(f, o, v) && held > c->end_price) return 0;
  }
  if (sum != c->sum || join != c->join) return 0;
  big proved = sum - (big)ends_of(o) * c->end_price; /* multiplied out: at most what the join weighs, optimal above 1 less */
  if (proved > join * d) return 0;
  double least = fmax((double)join / c->scale - up[0], (double)join / c->scale * (1 - 5e-10) - up[1]);
  bool all = proved > (join - 1) * d && !weightless && extra_length - fmax(0, least) <= 1e-9 * total;
  return !more || all ? 2 : 1;
}

static int verdict_of(const thr_plan *p, const thr_certificate *c, const int *component, const int *passes)
{
  bool *in = written_out(c, p->frame.n_nodes);
  int verdict = in ? verdict_of_sets(p, c, in, component, passes) : 0;
  free(in);
  return verdict;
}

int verdict_by_sums(const thr_plan *p)
{
  const thr_frame *f = &p->frame;
  int *passes = calloc((size_t)f->n_edges, sizeof *passes), *component = calloc((size_t)f->n_nodes, sizeof *component);
  int count, verdict = 2;
  ck_assert(passes && component);
  ck_assert_int_eq(thr_frame_components(f, component, &count, NULL), THR_OK);
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < p->cord[i].n_passes; k++)
      passes[p->cord[i].half[k] / 2]++;
  for (int i = 0; i < p->proof.n_certificates && verdict; i++) {
    int one = verdict_of(p, &p->proof.certificate[i], component, passes);
    if (one < verdict) verdict = one;
  }
  free(passes);
  free(component);
  return verdict;
}

void assert_allocations_may_fail(thr_status (*make)(const void *user, thr_text *t, thr_err *err), const void *user, long most)
{
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    thr_text t = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = make(user, &t, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_int_eq(st, THR_ENOMEM);
      ck_assert_uint_eq(t.length, 0);
      assert_one_line(&err, "memory");
    }
    thr_text_destroy(&t);
    ck_assert_int_lt(k, most);
  }
}
