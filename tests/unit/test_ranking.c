/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rankings: ties are what the intervals allow, and no more. */
#include "lib/compare_rises.c"
#include "lib/ranking.c"
#include "graph/io/json.h"
#include "lib/comparison.h"
#include "tests/support.h"

enum { MOST = 7 };

static thr_ranking ranking_of(int n, const double (*interval)[3])
{
  thr_ranking r = {.title = "nothing", .key = "nothing", .unit = " N"};
  ck_assert_int_eq(thr_ranking_init(&r, n, NULL), THR_OK);
  for (int i = 0; i < n; i++) {
    r.low[i] = interval[i][0];
    r.value[i] = interval[i][1];
    r.high[i] = interval[i][2];
  }
  thr_ranking_make(&r);
  return r;
}

/* An interval that reaches past its neighbours ties with each of them, and they are told apart all
 * the same. */
START_TEST(a_wide_interval_ties_with_all_it_reaches)
{
  const double interval[4][3] = {
      {60.6, 100, 165}, {148.5, 150, 151.5}, {153.5, 155, 156.5}, {170, 171, 172}};
  const int rank[4] = {1, 1, 2, 4};
  const char *const name[4] = {"wide", "b", "c", "d"};
  thr_ranking r = ranking_of(4, interval);
  thr_text t = {0};
  for (int i = 0; i < 4; i++)
    ck_assert_int_eq(r.rank[i], rank[i]);
  thr_ranking_put_text(&r, name, &t);
  ck_assert_ptr_nonnull(
      strstr(t.data, "2. c    155 N (153.5 .. 156.5 N)  tie with wide, within the error\n"));
  ck_assert_ptr_nonnull(strstr(t.data, "4. d    171 N (170 .. 172 N)  more, beyond the error\n"));
  thr_text_destroy(&t);
  thr_ranking_destroy(&r);
}
END_TEST

/* No upper end: all that follow tie. No value: no rank. */
START_TEST(open_ends_and_unknown_plans)
{
  const double interval[4][3] = {{9, 10, INFINITY}, {NAN, NAN, NAN}, {49, 50, 51}, {1, 2, 3}};
  const int rank[4] = {2, 0, 2, 1};
  thr_ranking r = ranking_of(4, interval);
  thr_text t = {0};
  thr_writer w = {.out = &t};
  const char *const name[4] = {"a", "b", "c", "d"};
  ck_assert_int_eq(r.n_ranked, 3);
  for (int i = 0; i < 4; i++)
    ck_assert_int_eq(r.rank[i], rank[i]);
  r.open = "why not";
  thr_ranking_put_text(&r, name, &t);
  ck_assert_ptr_nonnull(
      strstr(t.data, "2. a 10 N (at least 9 N: why not)  more, beyond the error\n"));
  ck_assert_ptr_nonnull(strstr(t.data, "2. c 50 N (49 .. 51 N)  tie, within the error\n"));
  ck_assert_ptr_nonnull(strstr(t.data, "-  b not known\n"));
  thr_text_destroy(&t);
  thr_ranking_put_json(&r, name, &w);
  ck_assert_ptr_nonnull(
      strstr(t.data, "{\"plan\": \"a\", \"value\": 10, \"low\": 9, \"high\": null, \"rank\": 2}"));
  thr_text_destroy(&t);
  thr_ranking_destroy(&r);
}
END_TEST

/* By the definition, from the intervals as they were drawn; and whoever comes later is nowhere
 * surely less. */
START_TEST(ranks_count_what_is_surely_less)
{
  rng g = rng_make(7);
  double interval[MOST][3];
  for (int trial = 0; trial < 300; trial++) {
    int n = 1 + rng_below(&g, MOST);
    for (int i = 0; i < n; i++) {
      interval[i][1] = 1 + rng_below(&g, 30);
      interval[i][0] = interval[i][1] - rng_below(&g, 4);
      interval[i][2] =
          interval[i][1] + (rng_below(&g, 8) == 0 ? INFINITY : (double)rng_below(&g, 4));
    }
    thr_ranking r = ranking_of(n, (const double(*)[3])interval);
    ck_assert_int_eq(r.n_ranked, n);
    for (int i = 0; i < n; i++) {
      int less = 0;
      for (int k = 0; k < n; k++)
        if (interval[k][2] < interval[i][0]) less++;
      ck_assert_int_eq(r.rank[i], 1 + less);
    }
    for (int late = 0; late < n; late++)
      for (int early = 0; early < late; early++)
        ck_assert(interval[r.order[late]][2] >= interval[r.order[early]][0]);
    thr_ranking_destroy(&r);
  }
}
END_TEST

/* Contradiction needs intervals apart in both, in opposite orders. */
START_TEST(only_sure_orders_contradict)
{
  int pair[2];
  const double apart[2][3] = {{1, 2, 3}, {4, 5, 6}}, other_way[2][3] = {{4, 5, 6}, {1, 2, 3}},
               near[2][3] = {{3, 5, 6}, {1, 2, 3}};
  thr_ranking a = ranking_of(2, apart), b = ranking_of(2, other_way), c = ranking_of(2, near);
  ck_assert(thr_ranking_disagree(&a, &b, pair));
  ck_assert(pair[0] == 0 && pair[1] == 1);
  ck_assert(!thr_ranking_disagree(&a, &c, pair));
  ck_assert(!thr_ranking_disagree(&a, &a, pair));
  thr_ranking_destroy(&a);
  thr_ranking_destroy(&b);
  thr_ranking_destroy(&c);
}
END_TEST

/* Of loads the most comes first, with its interval the right way round; and where there is proved
 * to be none, it is last. */
/* Plans that are surely apart and change places at an end of a band are told; ties may do what they
 * like. */
START_TEST(orders_over_a_band)
{
  const double interval[4][3] = {{1, 1, 1}, {2, 2, 2}, {1.5, 2.5, 3.5}, {9, 9, 9}};
  const double low[4] = {1, 3, 2.5, 9}, high[4] = {5, 4, 4.5, 8};
  const char *const name[4] = {"a", "b", "c", "d"};
  char at[THR_RANKING_ENDS][40] = {"p", "q", "r", "s"};
  for (int most = 0; most < 2; most++) {
    thr_text t = {0};
    thr_writer w = {.out = &t};
    thr_ranking r = ranking_of(4, interval);
    r.most = most;
    for (int i = 0; i < 4; i++) {
      r.end[0][i] = low[i];
      r.end[1][i] = high[i];
      r.end[2][i] = r.end[3][i] = i == 1 ? NAN : low[i];
    }
    thr_ranking_put_bands(&r, name, at, &t);
    ck_assert_str_eq(
        t.data,
        "     at q: b before a\n     at q: c before a\n     the same order at r and at s\n");
    thr_text_destroy(&t);
    thr_ranking_put_json(&r, name, &w);
    ck_assert_ptr_nonnull(strstr(t.data, most ? "\"band\": [-1, -5]" : "\"band\": [1, 5]"));
    ck_assert_ptr_nonnull(strstr(t.data, "\"same_over_band\": false"));
    ck_assert_ptr_nonnull(strstr(t.data, "\"same_over_band_beads\": true"));
    thr_text_destroy(&t);
    thr_ranking_destroy(&r);
  }
}
END_TEST

START_TEST(the_most_first)
{
  const double most[2][3] = {{-4, -3, -3}, {-9, -8, -8}},
               need[2][3] = {{INFINITY, INFINITY, INFINITY}, {1, 1, 2}};
  const char *const name[2] = {"a", "b"};
  thr_ranking r = ranking_of(2, most), q = ranking_of(2, need);
  thr_text t = {0};
  r.most = true;
  ck_assert_int_eq(r.order[0], 1);
  thr_ranking_put_text(&r, name, &t);
  ck_assert_ptr_nonnull(
      strstr(t.data, "1. b 8 N (8 .. 9 N)\n  2. a 3 N (3 .. 4 N)  less, beyond the error\n"));
  thr_ranking_put_text(&q, name, &t);
  ck_assert_ptr_nonnull(
      strstr(t.data, "1. b 1 N (1 .. 2 N)\n  2. a none, proved  more, beyond the error\n"));
  thr_text_destroy(&t);
  thr_ranking_destroy(&r);
  thr_ranking_destroy(&q);
}
END_TEST

/* Plans that rise: those that always come up by their pulls, then by how many runs come up, then by
 * closed faces; runs that overlap tie. */
START_TEST(what_comes_up_comes_first)
{
  enum { N = 6 };
  static const thr_compare_rise seen[N] = {
      {.runs = 3, .faces = 12, .closed = {4, 5, 8}, .jam = {"A1", "A2"}, .jams = 2},
      {.runs = 3, .up = 3, .faces = 12, .pull = {2, 2.5, 3}, .closed = {12, 12, 12}},
      {.runs = 3,
       .up = 2,
       .faces = 12,
       .pull = {0.1, 0.1, 0.2},
       .closed = {6, 12, 12},
       .jam = {"B1", "B2"},
       .jams = 1},
      {.runs = 0},
      {.runs = 3, .faces = 12, .closed = {9, 9, 10}, .jam = {"C1", "C2"}, .jams = 3},
      {.runs = 3,
       .up = 3,
       .faces = 12,
       .pull = {1, 2.2, 2.4},
       .closed = {12, 12, 12},
       .fell = 2,
       .fall = {0.5, 0.5, 0.6}}};
  static const int rank[N] = {5, 1, 3, 0, 4, 1}, order[] = {5, 1, 2, 4, 0};
  const char *const name[N] = {"a", "b", "c", "d", "e", "f"};
  thr_compare_entry *entry = calloc(N, sizeof *entry);
  thr_ranking r = {.title = "nothing", .key = "rise", .unit = " N"};
  thr_err err = {0};
  thr_text t = {0};
  thr_writer w = {.out = &t};
  ck_assert_ptr_nonnull(entry);
  for (int i = 0; i < N; i++)
    entry[i].rise = seen[i];
  ck_assert_int_eq(thr_ranking_init(&r, N, NULL), THR_OK);
  assert_ok(thr_compare_rank_rises(&r, entry, &err), &err);
  thr_ranking_make(&r);
  ck_assert_int_eq(r.n_ranked, 5);
  for (int i = 0; i < N; i++)
    ck_assert_int_eq(r.rank[i], rank[i]);
  for (int k = 0; k < 5; k++)
    ck_assert_int_eq(r.order[k], order[k]);

  thr_ranking_put_text(&r, name, &t);
  ck_assert_ptr_nonnull(strstr(t.data, "1. f comes up in 3 of 3 runs, at 2.2 N (1 to 2.4); let "
                                       "down, it falls below 0.5 N (0.5 to 0.6)\n"));
  ck_assert_ptr_nonnull(
      strstr(t.data, "1. b comes up in 3 of 3 runs, at 2.5 N (2 to 3)  tie, the runs overlap\n"));
  ck_assert_ptr_nonnull(
      strstr(t.data, "3. c comes up in 2 of 3 runs, at 0.1 N (0.1 to 0.2); 12 of 12 faces closed "
                     "at most (6 to 12); jams between B1 and B2\n"));
  ck_assert_ptr_nonnull(strstr(t.data, "5. a comes up in 0 of 3 runs; 5 of 12 faces closed at most "
                                       "(4 to 8); jams between A1 and A2 in 2 of 3\n"));
  ck_assert_ptr_nonnull(strstr(t.data, "-  d not known\n"));
  thr_text_destroy(&t);
  thr_ranking_put_json(&r, name, &w);
  ck_assert_ptr_nonnull(strstr(
      t.data, "{\"plan\": \"e\", \"value\": null, \"low\": null, \"high\": null, \"rank\": 4}"));
  thr_text_destroy(&t);
  thr_ranking_destroy(&r);
  free(entry);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("ranking");
  ADD_TEST(s, 10, orders_over_a_band);
  ADD_TEST(s, 10, a_wide_interval_ties_with_all_it_reaches);
  ADD_TEST(s, 10, open_ends_and_unknown_plans);
  ADD_TEST(s, 10, ranks_count_what_is_surely_less);
  ADD_TEST(s, 10, only_sure_orders_contradict);
  ADD_TEST(s, 10, the_most_first);
  ADD_TEST(s, 10, what_comes_up_comes_first);
  return run_suite(s);
}
