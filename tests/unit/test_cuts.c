/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forests of cuts against their sets written out. */
#include "graph/plan/plan.h"
#include "lp/tjoin/tjoin.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

enum { NODES = 12, MOST = 40 };

/* A set as a mask with its value. */
typedef struct {
  uint32_t set;
  int64_t value;
} valued;

static int by_set(const void *pa, const void *pb)
{
  const valued *a = pa, *b = pb;
  if (a->set != b->set) return a->set < b->set ? -1 : 1;
  return (a->value > b->value) - (a->value < b->value);
}

/* The sets, sorted; asserts that children come first, that own nodes ascend, and that no node is
 * twice in a tree. */
static int written_out(const thr_cuts *c, valued *out)
{
  for (int i = 0; i < c->n; i++)
    out[i] = (valued){0, c->cut[i].value};
  for (int i = 0; i < c->n; i++) {
    const thr_cut *cut = &c->cut[i];
    uint32_t own = 0;
    for (int j = 0; j < cut->n_nodes; j++) {
      ck_assert(cut->node[j] >= 0 && cut->node[j] < c->n_nodes &&
                (j == 0 || cut->node[j] > cut->node[j - 1]));
      own |= UINT32_C(1) << cut->node[j];
    }
    ck_assert_uint_eq(out[i].set & own, 0);
    out[i].set |= own;
    ck_assert(cut->parent == -1 || (cut->parent > i && cut->parent < c->n));
    if (cut->parent < 0) continue;
    ck_assert_uint_eq(out[cut->parent].set & out[i].set, 0);
    out[cut->parent].set |= out[i].set;
  }
  qsort(out, (size_t)c->n, sizeof *out, by_set);
  return c->n;
}

static void assert_same_sets(const thr_cuts *c, valued *expected, int n)
{
  valued found[MOST];
  qsort(expected, (size_t)n, sizeof *expected, by_set);
  ck_assert_int_eq(written_out(c, found), n);
  for (int i = 0; i < n; i++) {
    ck_assert_uint_eq(found[i].set, expected[i].set);
    ck_assert_int_eq(found[i].value, expected[i].value);
  }
}

static void add_set(thr_cuts *c, uint32_t set, int64_t value)
{
  thr_cut *cut = &c->cut[c->n++];
  *cut = (thr_cut){
      .parent = -1, .node = calloc((size_t)c->n_nodes, sizeof *cut->node), .value = value};
  ck_assert(cut->node != NULL);
  for (int v = 0; v < c->n_nodes; v++)
    if (set >> v & 1) cut->node[cut->n_nodes++] = v;
}

static thr_cuts cuts_make(void)
{
  thr_cuts c = {.n_nodes = NODES, .cut = calloc(MOST, sizeof *c.cut)};
  ck_assert(c.cut != NULL);
  return c;
}

/* Different sets at random; laminar: each is inside or outside of every other. */
static int random_sets(rng *r, bool laminar, valued *out)
{
  int n = 0;
  for (int tries = 0; tries < 400 && n < MOST / 2; tries++) {
    uint32_t set = 0;
    bool good = true;
    for (int k = rng_between(r, 1, NODES - 1); k > 0; k--)
      set |= UINT32_C(1) << rng_below(r, NODES);
    for (int i = 0; i < n; i++) {
      uint32_t both = set & out[i].set;
      good &= set != out[i].set && (!laminar || both == 0 || both == set || both == out[i].set);
    }
    if (good) out[n++] = (valued){set, rng_between(r, 1, 1000)};
  }
  return n;
}

static thr_cuts cuts_of(const valued *set, int n)
{
  thr_cuts c = cuts_make();
  for (int i = 0; i < n; i++)
    add_set(&c, set[i].set, set[i].value);
  return c;
}

static int size_of(const thr_cuts *c)
{
  int size = 0;
  for (int i = 0; i < c->n; i++)
    size += c->cut[i].n_nodes;
  return size;
}

START_TEST(nesting_keeps_every_set)
{
  rng r = rng_make((uint64_t)_i);
  valued set[MOST];
  bool laminar = _i % 2;
  int n = random_sets(&r, laminar, set);
  thr_cuts c = cuts_of(set, n);
  int before = size_of(&c);
  ck_assert_int_eq(thr_cuts_nest(&c, NULL), THR_OK);
  assert_same_sets(&c, set, n);
  ck_assert_int_le(size_of(&c), laminar ? NODES : before);
  ck_assert_int_eq(thr_cuts_nest(&c, NULL), THR_OK); /* again: nothing more to nest */
  assert_same_sets(&c, set, n);
  thr_cuts_destroy(&c);
}
END_TEST

START_TEST(sets_avoid_the_last_node)
{
  rng r = rng_make((uint64_t)_i);
  valued set[MOST];
  const uint32_t all = (UINT32_C(1) << NODES) - 1;
  bool laminar = _i % 2;
  int n = random_sets(&r, laminar, set);
  thr_cuts c = cuts_of(set, n);
  if (_i % 4 < 2) ck_assert_int_eq(thr_cuts_nest(&c, NULL), THR_OK);
  ck_assert_int_eq(thr_cuts_avoid_last(&c, NULL), THR_OK);
  ck_assert_int_eq(c.n_nodes, NODES - 1);
  ck_assert_int_eq(thr_cuts_nest(&c, NULL), THR_OK);
  for (int i = 0; i < n; i++)
    if (set[i].set >> (NODES - 1) & 1) set[i].set = all & ~set[i].set;
  assert_same_sets(&c, set, n);
  if (laminar) ck_assert_int_le(size_of(&c), NODES - 1);
  thr_cuts_destroy(&c);
}
END_TEST

START_TEST(dropped_sets_leave_the_others)
{
  rng r = rng_make((uint64_t)_i);
  valued set[MOST], kept[MOST], found[MOST];
  bool drop[MOST] = {false};
  int n = random_sets(&r, _i % 2, set), n_kept = 0;
  thr_cuts c = cuts_of(set, n);
  ck_assert_int_eq(thr_cuts_nest(&c, NULL), THR_OK);
  for (int i = 0; i < n; i++) /* by value, as nesting changes their order; values may be shared */
    drop[i] = c.cut[i].value % 3 == 0;
  for (int i = 0; i < n; i++)
    if (set[i].value % 3) kept[n_kept++] = set[i];
  ck_assert_int_eq(thr_cuts_drop(&c, drop, NULL), THR_OK);
  assert_same_sets(&c, kept, n_kept);
  int64_t held[NODES] = {0};
  ck_assert_int_eq(thr_cuts_held(&c, held, NULL), THR_OK);
  for (int i = written_out(&c, found) - 1; i >= 0; i--)
    for (int v = 0; v < NODES; v++)
      if (found[i].set >> v & 1) held[v] -= found[i].value;
  for (int v = 0; v < NODES; v++)
    ck_assert_int_eq(held[v], 0);
  thr_cuts_destroy(&c);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  rng r = rng_make(3);
  valued set[MOST];
  int n = random_sets(&r, false, set);
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    bool drop[MOST] = {false};
    int64_t held[NODES] = {0};
    thr_cuts c = cuts_of(set, n);
    drop[0] = drop[n / 2] = true;
    thr_alloc_fail_at(k);
    st = thr_cuts_nest(&c, NULL);
    if (!st) st = thr_cuts_drop(&c, drop, NULL);
    if (!st) st = thr_cuts_avoid_last(&c, NULL);
    if (!st) st = thr_cuts_nest(&c, NULL);
    if (!st) st = thr_cuts_held(&c, held, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
    thr_cuts_destroy(&c);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("forests of cuts");
  ADD_EXAMPLES(s, 10, nesting_keeps_every_set, 200);
  ADD_EXAMPLES(s, 10, sets_avoid_the_last_node, 200);
  ADD_EXAMPLES(s, 10, dropped_sets_leave_the_others, 200);
  ADD_TEST(s, 10, every_allocation_fails_once);
  return run_suite(s);
}
