/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker against altered plans. Alterations of cords and metrics must always be caught; a
 * certificate may be altered into another valid one, so there the verdict is compared with plain
 * sums, and with what is known to be shortest. */
#include "graph/check/check.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL = 8, FRAMES = 16 };

/* The i-th framework that is altered: solids, several components, random ones; small ones have at
 * most 8 nodes. */
static thr_frame example(int i)
{
  rng r = rng_make((uint64_t)i + 1);
  switch (i) {
  case 0: return solid_make(TETRAHEDRON);
  case 1: return solid_make(CUBE);
  case 2: return solid_make(OCTAHEDRON);
  case 3: return triangles_make(2);
  case 4: return star_make(5);
  case 5: return wheel_make(7);
  case 6: return path_make(4);
  case 7: return solid_make(ICOSAHEDRON);
  case 8: return grid_make(5, 4);
  case 9: return frame_load("data/conmech/tower_3D.json", NULL);
  case 10: return frame_load("data/assembly-instances/klein_bottle_trail.json", NULL);
  default:
    return random_frame(&r, rng_between(&r, 3, 25), rng_below(&r, 25),
                        (length_kind)(i % LENGTH_KINDS));
  }
}

static thr_plan example_plan(int i)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = example(i / 3);
  thr_request o = options_for(ends[i % 3], i % 7 == 0 ? 3 : 1);
  thr_limits none = {0};
  thr_plan p;
  thr_status st = thr_postman_plan(&f, &o, &none, &p, NULL);
  if (st == THR_EINFEASIBLE) p = plan_simple(&f, THR_ENDS_ANY, 2); /* no feet here */
  thr_frame_destroy(&f);
  return p;
}

/* ---- numbers in the text ---- */

/* Calls for every number from the k-th mark on to the next ']': where it starts, and how long it
 * is. */
typedef struct {
  size_t at, length;
} token;

static int tokens_after(const char *text, const char *section, const char *key, int k, token *list,
                        int room)
{
  const char *s = strstr(text, section);
  for (int i = 0; i <= k && s; i++)
    s = strstr(i ? s + 1 : s, key);
  if (!s) return -1;
  int n = 0;
  for (s += strlen(key); *s != ']'; s++) {
    size_t length = strspn(s, "-0123456789");
    if (!length) continue;
    ck_assert_int_lt(n, room);
    list[n++] = (token){(size_t)(s - text), length};
    s += length - 1;
  }
  return n;
}

static void assert_caught(const char *text, size_t n, const char *what)
{
  thr_err err = {0};
  thr_status st = judge_text(text, n, &err);
  ck_assert_msg(st == THR_EVIOLATED || st == THR_EINPUT, "status %d after %s", (int)st, what);
  assert_one_line(&err, NULL);
}

static void replace_token(const thr_text *t, token at, int value)
{
  char *out = calloc(t->length + 16, 1), number[16];
  ck_assert(out != NULL);
  int n = snprintf(number, sizeof number, "%d", value);
  if (atoi(t->data + at.at) != value) {
    memcpy(out, t->data, at.at);
    memcpy(out + at.at, number, (size_t)n);
    strcpy(out + at.at + n, t->data + at.at + at.length);
    assert_caught(out, strlen(out), number);
  }
  free(out);
}

/* Every number of a list in every cord becomes every other on small plans; on larger ones some
 * become some. */
static void alter_lists(rng *r, const thr_plan *p, const char *key, int limit)
{
  thr_text t = plan_text(p);
  token *list = calloc((size_t)p->metrics.passes + 2, sizeof *list);
  ck_assert(list != NULL);
  for (int k = 0; k < p->n_cords; k++) {
    int n = tokens_after(t.data, "\"cords\"", key, k, list, p->metrics.passes + 2);
    ck_assert_int_ge(n, 1);
    if (p->frame.n_nodes <= SMALL)
      for (int i = 0; i < n; i++)
        for (int v = -1; v <= limit; v++)
          replace_token(&t, list[i], v);
    else
      for (int i = 0; i < 150 / p->n_cords; i++)
        replace_token(&t, list[rng_below(r, n)], rng_between(r, -1, limit));
  }
  free(list);
  thr_text_destroy(&t);
}

START_TEST(any_node_or_edge_of_a_cord)
{
  rng r = rng_make((uint64_t)_i);
  thr_plan p = example_plan(_i);
  alter_lists(&r, &p, "\"nodes\": [", p.frame.n_nodes);
  alter_lists(&r, &p, "\"edges\": [", p.frame.n_edges);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- whole passes ---- */

static void assert_plan_caught(const thr_plan *p, const char *what)
{
  thr_err err = {0};
  thr_status st = thr_check_plan(p, &err);
  ck_assert_msg(st == THR_EVIOLATED, "status %d after %s", (int)st, what);
  assert_one_line(&err, NULL);
  err = (thr_err){0};
  st = judge_plan(p, &err);
  ck_assert_msg(st == THR_EVIOLATED || st == THR_EINPUT, "status %d after %s, by way of JSON",
                (int)st, what);
  assert_one_line(&err, NULL);
}

static void drop_pass(thr_plan *p, thr_cord *c, int i)
{
  int n = c->n_passes, *kept = c->half, *half = calloc((size_t)n, sizeof *half);
  if (n < 2) {
    free(half);
    return;
  }
  memcpy(half, kept, (size_t)i * sizeof *half);
  memcpy(half + i, kept + i + 1, (size_t)(n - 1 - i) * sizeof *half);
  c->half = half;
  c->n_passes = n - 1;
  assert_plan_caught(p, "dropping a pass");
  c->half = kept;
  c->n_passes = n;
  free(half);
}

static void swap_passes(thr_plan *p, thr_cord *c, int i, int j)
{
  int a = c->half[i], b = c->half[j];
  if (a == b || c->n_passes == 2) return; /* there and back is a cord from the other end, too */
  c->half[i] = b, c->half[j] = a;
  assert_plan_caught(p, "swapping two passes");
  c->half[i] = a, c->half[j] = b;
}

START_TEST(any_pass_dropped_turned_or_swapped)
{
  rng r = rng_make((uint64_t)_i);
  thr_plan p = example_plan(_i);
  for (int k = 0; k < p.n_cords; k++) {
    thr_cord *c = &p.cord[k];
    for (int i = 0; i<c->n_passes; i += c->n_passes> 40 ? 7 : 1) {
      drop_pass(&p, c, i);
      if (c->n_passes > 1) {
        c->half[i] ^= 1;
        assert_plan_caught(&p, "turning a pass round");
        c->half[i] ^= 1;
      }
      swap_passes(&p, c, i, rng_below(&r, c->n_passes));
    }
  }
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(any_word_about_a_cord)
{
  thr_plan p = example_plan(_i);
  for (int k = 0; k < p.n_cords; k++) {
    thr_cord *c = &p.cord[k], kept = *c;
    c->closed = !c->closed;
    assert_plan_caught(&p, "closed");
    *c = kept;
    for (int i = 0; i < p.frame.n_nodes; i++)
      if (i != kept.component) {
        c->component = i;
        assert_plan_caught(&p, "component");
      }
    *c = kept;
    c->id[0]++;
    assert_plan_caught(&p, "id");
    *c = kept;
  }
  thr_plan_destroy(&p);
}
END_TEST

/* ---- metrics and claims ---- */

static void alter_real(thr_plan *p, double *x, const char *what)
{
  double kept = *x;
  const double other[] = {
      kept + 1e-5, kept - 1e-5, kept * 2 + 1, -kept - 1, kept * (1 + 1e-6) + 1e-6, 1e300};
  for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
    *x = other[i];
    if (fabs(kept) > 1e3 && i < 2) continue;
    assert_plan_caught(p, what);
  }
  *x = kept;
}

static void alter_whole(thr_plan *p, int *x, const char *what)
{
  int kept = *x;
  const int other[] = {kept + 1, kept - 1, kept + 1000000, -kept - 1};
  for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
    *x = other[i];
    assert_plan_caught(p, what);
  }
  *x = kept;
}

START_TEST(any_metric_and_claim)
{
  thr_plan p = example_plan(_i);
  alter_real(&p, &p.metrics.length, "length");
  alter_real(&p, &p.metrics.base_length, "base length");
  alter_real(&p, &p.metrics.overlap, "overlap");
  alter_real(&p, &p.metrics.turning, "turning");
  alter_real(&p, &p.metrics.max_turning, "largest turning");
  alter_real(&p, &p.metrics.worst_turn, "worst turn");
  alter_real(&p, &p.proof.gap, "gap");
  alter_whole(&p, &p.metrics.passes, "passes");
  alter_whole(&p, &p.metrics.most_passes, "most passes");
  alter_whole(&p, &p.metrics.u_turns, "U-turns");
  double bound = p.proof.lower_bound, gap = p.proof.gap;
  p.proof.lower_bound = bound * (1 + 1e-6);
  p.proof.gap = (p.metrics.length - p.proof.lower_bound) / p.metrics.length;
  assert_plan_caught(&p, "raising the bound");
  p.proof.lower_bound = bound;
  p.proof.gap = gap;
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- certificates ---- */

/* The plan is shortest, and says so: the checker must agree if and only if plain sums do, and must
 * never prove more. */
static void compare_verdicts(const thr_plan *p, const char *what)
{
  bool optimal;
  double bound;
  thr_err err = {0};
  int expected = verdict_by_sums(p);
  thr_status whole = thr_check_plan(p, &err);
  ck_assert_msg(whole == (expected == 2 ? THR_OK : THR_EVIOLATED),
                "status %d, but the sums say %d after %s: %s", (int)whole, expected, what,
                err.text);
  if (whole) assert_one_line(&err, expected ? "proof" : "certificate");
  thr_status st =
      thr_check_length_proof(&p->frame, &p->options, p->cord, p->n_cords, p->proof.certificate,
                             p->proof.n_certificates, NULL, &optimal, &bound, NULL);
  ck_assert_int_eq(st, expected ? THR_OK : THR_EVIOLATED);
  if (st) return;
  ck_assert_int_eq(optimal, expected == 2);
  ck_assert(bound <= p->metrics.length * (1 + 1e-9) &&
            bound >= p->metrics.base_length * (1 - 1e-9));
}

static void alter_values(rng *r, thr_plan *p, thr_certificate *c)
{
  const int64_t step[] = {1,
                          -1,
                          c->denominator,
                          -c->denominator,
                          INT64_C(1) << 40,
                          rng_between(r, -100000, 100000),
                          -INT64_MAX / 2};
  for (int i = 0; i<c->n_cuts; i += c->n_cuts> 30 ? 5 : 1)
    for (size_t k = 0; k < sizeof step / sizeof *step; k++) {
      int64_t value = c->cut[i].value, sum = c->sum;
      c->cut[i].value += step[k];
      assert_plan_caught(p, "altering a multiplier");
      c->sum += step[k]; /* now the sum fits */
      compare_verdicts(p, "altering a multiplier and the sum");
      c->cut[i].value = value;
      c->sum = sum;
    }
}

/* Puts node v into the set, or takes it out. */
static void toggle(thr_cut *cut, int v)
{
  int i = 0;
  while (i < cut->n_nodes && cut->node[i] < v)
    i++;
  if (i < cut->n_nodes && cut->node[i] == v) {
    memmove(cut->node + i, cut->node + i + 1, (size_t)(--cut->n_nodes - i) * sizeof *cut->node);
    return;
  }
  memmove(cut->node + i + 1, cut->node + i, (size_t)(cut->n_nodes++ - i) * sizeof *cut->node);
  cut->node[i] = v;
}

static void alter_sets(rng *r, thr_plan *p, thr_certificate *c)
{
  int n = p->frame.n_nodes;
  for (int i = 0; i<c->n_cuts; i += c->n_cuts> 30 ? 5 : 1) {
    int *node = calloc((size_t)n, sizeof *node), *kept = c->cut[i].node, n_kept = c->cut[i].n_nodes;
    ck_assert(node != NULL);
    c->cut[i].node = node;
    for (int k = 0; k < (n <= 12 ? n : 12); k++) {
      memcpy(node, kept, (size_t)n_kept * sizeof *node);
      c->cut[i].n_nodes = n_kept;
      toggle(&c->cut[i], n <= 12 ? k : rng_below(r, n));
      compare_verdicts(p, "adding or removing a node");
      toggle(&c->cut[i], rng_below(r, n)); /* parity may be right again */
      if (c->cut[i].n_nodes) compare_verdicts(p, "adding or removing two nodes");
    }
    c->cut[i].node = kept;
    c->cut[i].n_nodes = n_kept;
    free(node);
  }
}

static int64_t weigh_join(const thr_plan *p, const thr_certificate *c)
{
  int64_t join = 0;
  for (int k = 0; k < p->n_cords; k++)
    for (int i = 0; p->cord[k].component == c->component && i < p->cord[k].n_passes; i++)
      join += thr_certificate_weight(&p->frame, c, p->cord[k].half[i] / 2);
  int *component = calloc((size_t)p->frame.n_nodes, sizeof *component), count;
  ck_assert(component && thr_frame_components(&p->frame, component, &count, NULL) == THR_OK);
  for (int e = 0; e < p->frame.n_edges; e++)
    if (component[p->frame.edge[e][0]] == c->component)
      join -= p->options.cover * thr_certificate_weight(&p->frame, c, e);
  free(component);
  return join;
}

/* Puts cuts under other parents: any, even where none can be. */
static void alter_parents(rng *r, thr_plan *p, thr_certificate *c)
{
  for (int i = 0; i<c->n_cuts; i += c->n_cuts> 30 ? 5 : 1) {
    int kept = c->cut[i].parent;
    for (int k = 0; k < 8; k++) {
      c->cut[i].parent = rng_between(r, -2, c->n_cuts);
      compare_verdicts(p, "altering a parent");
    }
    c->cut[i].parent = kept;
  }
}

static void alter_numbers(rng *r, thr_plan *p, thr_certificate *c)
{
  thr_certificate kept = *c;
  const double factor[] = {0.5, 2, 1 + 1e-7, 1 - 1e-7, 1e-20, 1e-5, 0.1 + rng_unit(r)};
  for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
    c->scale = kept.scale * factor[i];
    compare_verdicts(p, "altering the scale");
    c->join = weigh_join(p, c);
    compare_verdicts(p, "altering the scale and the join");
    *c = kept;
  }
  const int64_t step[] = {1, -1, 1000, -1000, INT64_C(1) << 39};
  for (size_t i = 0; i < sizeof step / sizeof *step; i++) {
    int64_t *number[] = {&c->denominator, &c->end_price, &c->join, &c->sum};
    for (int k = 0; k < 4; k++) {
      if (*number[k] + step[i] < (k == 0)) continue;
      *number[k] += step[i];
      if (k >= 2)
        assert_plan_caught(p, k == 2 ? "altering the join" : "altering the sum");
      else
        compare_verdicts(p, k ? "altering the end price" : "altering the denominator");
      *c = kept;
    }
  }
}

START_TEST(any_number_and_set_of_a_certificate)
{
  rng r = rng_make((uint64_t)_i);
  thr_plan p = example_plan(_i);
  compare_verdicts(&p, "nothing");
  for (int k = 0; k < p.proof.n_certificates; k++) {
    alter_values(&r, &p, &p.proof.certificate[k]);
    alter_sets(&r, &p, &p.proof.certificate[k]);
    alter_parents(&r, &p, &p.proof.certificate[k]);
    alter_numbers(&r, &p, &p.proof.certificate[k]);
  }
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- certificates of several cords ---- */

/* Sets that no solver would make, in trees at random. */
static void replace_cuts(rng *r, thr_plan *p, thr_certificate *c)
{
  enum { CUTS = 6 };
  thr_certificate kept = *c;
  int n = p->frame.n_nodes;
  thr_cut cut[CUTS];
  c->cut = cut;
  c->n_cuts = CUTS;
  c->sum = 0;
  for (int i = 0; i < CUTS; i++) {
    int up = rng_between(r, i, CUTS - 1);
    cut[i] = (thr_cut){.parent = up > i ? up : -1,
                       .node = calloc((size_t)n, sizeof(int)),
                       .value = rng_between(r, 1, 3)};
    ck_assert(cut[i].node != NULL);
    for (int k = rng_between(r, 1, 6); k > 0; k--)
      toggle(&cut[i], rng_below(r, n));
    c->sum += cut[i].value;
  }
  c->denominator = rng_between(r, 1, 4);
  for (c->end_price = 0; c->end_price < 24;
       c->end_price++) /* small enough for the loads to matter */
    compare_verdicts(p, "replacing all sets");
  for (int i = 0; i < CUTS; i++)
    free(cut[i].node);
  *c = kept;
}

START_TEST(any_number_and_set_with_several_cords)
{
  static const thr_ends ends[] = {THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i);
  int which = 11 + _i % 5; /* the random ones */
  thr_frame f =
      _i % 7 ? example(which) : solid_make(DODECAHEDRON); /* too many edges for all sets of them */
  thr_request o = options_for(_i % 7 ? ends[_i % 2] : THR_ENDS_ANY, 1);
  o.cords = 2 + _i % 3;
  thr_plan p = plan_of_cords(&f, &o);
  assert_plan_sound(&p);
  compare_verdicts(&p, "nothing");
  thr_certificate *c = &p.proof.certificate[0];
  alter_values(&r, &p, c);
  alter_sets(&r, &p, c);
  alter_parents(&r, &p, c);
  alter_numbers(&r, &p, c);
  for (int i = 0; i < 20; i++)
    replace_cuts(&r, &p, c);
  p.options.cords++, p.options.cords_least++;
  assert_plan_caught(&p, "a cord less than the options say");
  p.options.cords -= 2, p.options.cords_least -= 2;
  assert_plan_caught(&p, "a cord more than the options say");
  p.options.cords++, p.options.cords_least++;
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- plans that are longer than need be ---- */

/* Goes once more there and back over a random edge of the cord. */
static void add_detour(rng *r, thr_plan *p)
{
  thr_cord *c = &p->cord[rng_below(r, p->n_cords)];
  int at = rng_below(r, c->n_passes), n = c->n_passes, *half = calloc((size_t)n + 2, sizeof *half);
  ck_assert(half != NULL);
  memcpy(half, c->half, (size_t)at * sizeof *half);
  half[at] = c->half[at], half[at + 1] = c->half[at] ^ 1;
  memcpy(half + at + 2, c->half + at, (size_t)(n - at) * sizeof *half);
  free(c->half);
  c->half = half;
  c->n_passes += 2;
  ck_assert_int_eq(thr_plan_measure(&p->frame, &p->options, p->cord, p->n_cords, &p->metrics, NULL),
                   THR_OK);
}

START_TEST(a_longer_cord_is_never_proved)
{
  rng r = rng_make((uint64_t)_i);
  thr_plan p = example_plan(_i);
  double shortest = p.metrics.length;
  add_detour(&r, &p);
  for (int i = 0; i < 60; i++) {
    for (int k = 0; k < p.proof.n_certificates; k++) {
      thr_certificate *c = &p.proof.certificate[k];
      if (i) c->scale *= pow(10, rng_between(&r, -3, 1));
      c->join = weigh_join(&p, c);
      for (int j = 0; i && j < c->n_cuts; j++) {
        int64_t less = (int64_t)((double)c->cut[j].value * rng_unit(&r));
        c->sum -= less;
        c->cut[j].value -= less;
      }
    }
    assert_plan_caught(&p, "a detour");
    p.proof.lower_bound = p.metrics.length;
    p.proof.gap = 0;
    assert_plan_caught(&p, "a detour and a forged bound");
    bool optimal;
    double bound;
    thr_status st =
        thr_check_length_proof(&p.frame, &p.options, p.cord, p.n_cords, p.proof.certificate,
                               p.proof.n_certificates, NULL, &optimal, &bound, NULL);
    ck_assert(st == THR_EVIOLATED || (!optimal && bound <= shortest * (1 + 1e-9)));
    if (st) continue;
    p.proof.optimal = false; /* said honestly, it passes */
    p.proof.lower_bound = bound;
    p.proof.gap = (p.metrics.length - bound) / p.metrics.length;
    assert_plan_sound(&p);
    p.proof.optimal = true;
  }
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("altered plans");
  ADD_EXAMPLES(s, 60, any_node_or_edge_of_a_cord, 3 * FRAMES);
  ADD_EXAMPLES(s, 60, any_pass_dropped_turned_or_swapped, 3 * FRAMES);
  ADD_EXAMPLES(s, 60, any_word_about_a_cord, 3 * FRAMES);
  ADD_EXAMPLES(s, 60, any_metric_and_claim, 3 * FRAMES);
  ADD_EXAMPLES(s, 60, any_number_and_set_of_a_certificate, 3 * FRAMES);
  ADD_EXAMPLES(s, 60, any_number_and_set_with_several_cords, 28);
  ADD_EXAMPLES(s, 60, a_longer_cord_is_never_proved, 3 * FRAMES);
  return run_suite(s);
}
