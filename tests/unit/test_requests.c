/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a plan can ask for beside its objective: written, read back, and checked. */
#include "graph/check/check.h"
#include "graph/plan/turning_proof.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void set_cords(thr_plan *p, const thr_frame *f, const thr_request *o, int n,
                      const int *const *node, const int *length)
{
  *p = (thr_plan){0};
  ck_assert_int_eq(thr_plan_request(p, f, o, NULL), THR_OK);
  p->n_cords = n;
  p->cord = calloc((size_t)n, sizeof *p->cord);
  ck_assert(p->cord != NULL);
  for (int i = 0; i < n; i++) {
    thr_cord *c = &p->cord[i];
    *c = (thr_cord){.n_passes = length[i] - 1, .half = calloc((size_t)length[i], sizeof *c->half)};
    ck_assert(c->half != NULL);
    thr_cord_id(i, c->id);
    for (int k = 0; k + 1 < length[i]; k++) {
      int e = thr_frame_edge_between(f, node[i][k], node[i][k + 1]);
      ck_assert_int_ge(e, 0);
      c->half[k] = 2 * e + (f->edge[e][0] != node[i][k]);
    }
    c->closed = node[i][0] == node[i][length[i] - 1];
  }
  ck_assert_int_eq(thr_plan_measure(&p->frame, &p->options, p->cord, n, &p->metrics, NULL), THR_OK);
}

START_TEST(everything_asked_for_survives_json)
{
  thr_frame f = grid_make(3, 3);
  f.cover = calloc((size_t)f.n_edges, sizeof *f.cover);
  f.capacity = calloc((size_t)f.n_edges, sizeof *f.capacity);
  for (int e = 0; e < f.n_edges; e++)
    f.cover[e] = 1 + e % 2, f.capacity[e] = e % 3 ? 4 : 0;
  int end_count[9] = {1, 0, 1, 0, 0, 0, 2, 0, 0};
  thr_request o = options_for(THR_ENDS_COUNTS, 1);
  o.end_count = end_count;
  o.capacity = 3;
  o.cords_least = 2, o.cords = 5;
  o.max_length = 12.5, want(&o, "longest"), o.joint = THR_JOINT_TUBE;
  o.engine = THR_ENGINE_LP, o.confirm = THR_CONFIRM_NEVER;
  thr_plan p, q;
  const int walk[] = {0, 1, 2};
  const int *const node[] = {walk};
  set_cords(&p, &f, &o, 1, node, &(int){3});
  p.cords_claim = (thr_cords_claim){true, 2, 1.5, true, 7, true};
  thr_text t = plan_text(&p);
  q = plan_from(t.data);
  ck_assert(memcmp(q.frame.cover, f.cover, (size_t)f.n_edges * sizeof *f.cover) == 0);
  ck_assert(memcmp(q.frame.capacity, f.capacity, (size_t)f.n_edges * sizeof *f.capacity) == 0);
  ck_assert(q.options.ends == THR_ENDS_COUNTS &&
            memcmp(q.options.end_count, end_count, sizeof end_count) == 0);
  ck_assert(q.options.capacity == 3 && q.options.cords_least == 2 && q.options.cords == 5 &&
            thr_wants_balance(&q.options));
  ck_assert(q.options.max_length == 12.5 && q.options.joint == THR_JOINT_TUBE);
  ck_assert(q.options.engine == THR_ENGINE_LP && q.options.confirm == THR_CONFIRM_NEVER);
  ck_assert(q.cords_claim.present && q.cords_claim.longest == 2 &&
            q.cords_claim.longest_bound == 1.5);
  ck_assert(q.cords_claim.longest_optimal && q.cords_claim.fewest == 7 &&
            q.cords_claim.fewest_optimal);
  thr_text again = plan_text(&q);
  assert_same_text(&t, &again);
  thr_text_destroy(&t);
  thr_text_destroy(&again);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

/* The text with `from` replaced is refused, and the message has `word`. */
static void assert_refused(const char *text, const char *from, const char *to, const char *word)
{
  const char *at = strstr(text, from);
  ck_assert_msg(at != NULL, "%s", from);
  char *out = calloc(strlen(text) + strlen(to) + 1, 1);
  ck_assert(out != NULL);
  memcpy(out, text, (size_t)(at - text));
  strcpy(out + (at - text), to);
  strcat(out, at + strlen(from));
  thr_err err = {0};
  thr_plan p;
  thr_status st = thr_plan_parse(&p, out, strlen(out), "plan", &err);
  ck_assert_msg(st == THR_EINPUT || st == THR_EVIOLATED, "%s: status %d", to, (int)st);
  assert_one_line(&err, word);
  thr_plan_destroy(&p);
  free(out);
}

START_TEST(nonsense_is_refused)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p = plan_make(&f, &o);
  thr_text t = plan_text(&p);
  static const struct {
    const char *from, *to, *word;
  } wrong[] = {
      {"\"cords\": 1", "\"cords\": {\"least\": 3, \"most\": 2}", "least"},
      {"\"cords\": 1", "\"cords\": {\"least\": 0, \"most\": 2}", "least"},
      {"\"cords\": 1", "\"cords\": {\"least\": 1, \"most\": 1001}", "most"},
      {"\"cords\": 1", "\"cords\": {\"least\": 1}", "most"},
      {"\"cords\": 1", "\"cords\": {\"least\": 1, \"most\": 2, \"best\": 1}", "best"},
      {"\"cords\": 1", "\"cords\": true", "cords"},
      {"\"cover\": 1", "\"cover\": 1, \"capacity\": 0", "capacity"},
      {"\"cover\": 1", "\"cover\": 1, \"max_length\": 0", "max_length"},
      {"\"cover\": 1", "\"cover\": 1, \"max_length\": -1", "max_length"},
      {"\"cover\": 1", "\"cover\": 1, \"balance\": 1", "balance"},
      {"\"cover\": 1", "\"cover\": 1, \"engine\": \"magic\"", "engine"},
      {"\"cover\": 1", "\"cover\": 1, \"engine\": null", "engine"},
      {"\"cover\": 1", "\"cover\": 1, \"confirm\": true", "confirm"},
      {"\"cover\": 1", "\"cover\": 1, \"confirm\": \"sometimes\"", "confirm"},
      {"\"closed\"", "\"counts\"", "end_counts"},
      {"\"ends\": \"closed\"", "\"ends\": \"counts\", \"end_counts\": [[0]]", "end_counts"},
      {"\"ends\": \"closed\"", "\"ends\": \"counts\", \"end_counts\": [[8,1]]", "end_counts"},
      {"\"ends\": \"closed\"", "\"ends\": \"counts\", \"end_counts\": [[0,0]]", "end_counts"},
      {"\"ends\": \"closed\"", "\"ends\": \"counts\", \"end_counts\": [[0,1],[0,1]]", "end_counts"},
      {"\"feet\"", "\"covers\": [1], \"feet\"", "covers"},
      {"\"feet\"", "\"capacities\": 3, \"feet\"", "capacities"},
      {"\"feet\"", "\"covers\": [0,1,1,1,1,1,1,1,1,1,1,1], \"feet\"", "framework"},
      {"\"feet\"", "\"covers\": [1,1,1,1,1,1,1,1,1,1,1,2], \"feet\"", "hash"},
      {"\"end_price\": 0", "\"end_price\": -1", "end_price"},
      {"\"end_price\": 0", "\"end_price\": 0, \"slots\": 0", "slots"},
      {"\"nodes\": [0]", "\"nodes\": [0], \"parent\": 0", "parent"},
      {"\"nodes\": [0]", "\"nodes\": [0], \"parent\": 99", "parent"},
      {"\"nodes\": [0]", "\"nodes\": [0], \"parent\": -1", "parent"},
      {"\"nodes\": [0]", "\"nodes\": [0], \"child\": 2", "child"},
      {"\"proof\": {", "\"proof\": {\"cords\": {}, ", "longest"},
      {"\"proof\": {",
       "\"proof\": {\"cords\": {\"longest\": {\"status\": \"bound\", \"length\": 1, "
       "\"lower_bound\": -1}}, ",
       "lower_bound"},
      {"\"proof\": {",
       "\"proof\": {\"cords\": {\"longest\": {\"status\": \"bound\", \"length\": 1, "
       "\"lower_bound\": 1}, \"fewest\": "
       "{\"status\": "
       "\"bound\", \"lower_bound\": 0}}, ",
       "lower_bound"},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_refused(t.data, wrong[i].from, wrong[i].to, wrong[i].word);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A cube's edges with one extra pass each over a perfect matching of its nodes: capacities, covers,
 * ends. */
START_TEST(capacity_and_cover_of_edges)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p = plan_make(&f, &o);
  p.options.capacity = 2;
  assert_plan_sound(&p);
  p.options.capacity = 1;
  assert_violated(&p, "only 1 fit");
  p.options.capacity = 0;
  int doubled = 0, passes[12] = {0};
  for (int k = 0; k < p.cord[0].n_passes; k++)
    if (++passes[p.cord[0].half[k] / 2] == 2) doubled = p.cord[0].half[k] / 2;
  p.frame.capacity = calloc(12, sizeof *p.frame.capacity);
  p.frame.capacity[doubled] = 1;
  assert_violated(&p, "2 passes, but only 1 fit");
  p.frame.capacity[doubled] = 2;
  assert_plan_sound(&p);
  p.frame.cover = calloc(12, sizeof *p.frame.cover);
  for (int e = 0; e < 12; e++)
    p.frame.cover[e] = 1 + (e == doubled);
  assert_violated(&p, "base_length");
  p.frame.capacity[doubled] = 0;
  for (int e = 0; e < 12; e++)
    p.frame.cover[e] = 3;
  assert_violated(&p, "of 3 passes");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(given_numbers_of_ends)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_COUNTS, 1);
  int end_count[8] = {1, 0, 0, 1, 0, 0, 0, 0};
  o.end_count = end_count;
  thr_plan p = plan_make(&f, &o);
  ck_assert(p.proof.optimal && !p.cord[0].closed);
  assert_plan_sound(&p);
  p.options.end_count[0] = 2;
  assert_violated(&p, "node 0: has 1 cord end");
  p.options.end_count[0] = 0;
  assert_violated(&p, "node 0");
  p.options.end_count[0] = 1;
  p.options.end_count[7] = 1;
  assert_violated(&p, "node 7: has 0 cord ends; the plan's options say 1");
  p.options.end_count[7] = 0;
  p.proof.certificate[0].end_price = 1;
  assert_violated(&p, "end price");
  p.proof.certificate[0].end_price = 0;
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(cords_that_are_too_long)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.cords = 4;
  thr_plan p = plan_of_cords(&f, &o);
  double longest = 0;
  for (int i = 0; i < 4; i++)
    longest = fmax(longest, thr_cord_length(&f, &p.cord[i]));
  p.options.max_length = longest;
  assert_plan_sound(&p);
  p.options.max_length = longest * (1 - 1e-6);
  assert_violated(&p, "the plan's options allow");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Two triangles with a corner in common, each passed twice. Twice from the one into the other at
 * the same edges leaves that corner in two; once at others ties it. */
START_TEST(tube_joints)
{
  static const double xyz[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  static const int tied[] = {0, 1, 2, 0, 3, 4, 0, 1, 2, 0, 4, 3, 0},
                   loose[] = {0, 1, 2, 0, 3, 4, 0, 1, 2, 0, 3, 4, 0},
                   back[] = {0, 1, 2, 0, 2, 1, 0, 3, 4, 0, 4, 3, 0};
  static const struct {
    const int *walk;
    const char *word;
  } plans[] = {
      {tied, NULL}, {loose, "node 0: the cords do not tie"}, {back, "turns back at node 0"}};
  thr_frame f = frame_make(5, xyz, 6, edge, NULL, NULL);
  thr_request o = options_for(THR_ENDS_CLOSED, 2);
  for (int i = 0; i < 3; i++) {
    thr_plan p;
    o.joint = THR_JOINT_TUBE;
    set_cords(&p, &f, &o, 1, &plans[i].walk, &(int){13});
    if (plans[i].word)
      assert_violated(&p, plans[i].word);
    else
      assert_plan_sound(&p);
    p.options.joint = THR_JOINT_SOLID;
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  /* Two ends at the corner do not turn there: the closing turn is not counted. */
  o.ends = THR_ENDS_ANY;
  o.joint = THR_JOINT_TUBE;
  thr_plan p;
  set_cords(&p, &f, &o, 1, &(const int *){tied}, &(int){13});
  assert_plan_sound(&p); /* 2-3, 4-1 and 2-4 are left, and tie all four */
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- claims about several cords ---- */

/* Two unit squares side by side: seven edges, two odd nodes. */
static thr_plan two_squares(int n_cords)
{
  thr_frame f = grid_make(3, 2);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.cords = n_cords;
  thr_plan p = plan_of_cords(&f, &o);
  thr_err err = {0};
  assert_ok(thr_check_cords(&p.frame, &p.options, p.cord, p.n_cords, p.proof.certificate, 1, NULL,
                            &p.cords_claim, &err),
            &err);
  thr_frame_destroy(&f);
  return p;
}

START_TEST(a_claim_about_one_cord)
{
  thr_plan p = two_squares(1);
  ck_assert(p.cords_claim.longest_optimal && p.cords_claim.fewest == 0);
  ck_assert_double_eq_tol(p.cords_claim.longest, 7, 1e-12);
  ck_assert_double_eq_tol(p.cords_claim.longest_bound, 7, 1e-9);
  assert_plan_sound(&p);
  thr_cords_claim kept = p.cords_claim;
  p.cords_claim.longest = 6.999;
  assert_violated(&p, "longest");
  p.cords_claim = kept;
  p.cords_claim.longest_bound = 7.001;
  assert_violated(&p, "lower_bound");
  p.cords_claim.longest_bound = 6;
  assert_violated(&p, "optimal");
  p.cords_claim.longest_optimal = false;
  assert_plan_sound(&p);
  p.cords_claim.fewest = 1;
  assert_violated(&p, "fewest");
  thr_plan_destroy(&p);
}
END_TEST

/* 7 edges of one length in two cords: one has 4 of them. */
START_TEST(a_bound_in_whole_edges)
{
  thr_plan p = two_squares(2);
  ck_assert_double_eq_tol(p.cords_claim.longest_bound, 4, 1e-9);
  ck_assert(p.cords_claim.longest >= 4);
  assert_plan_sound(&p);
  p.cords_claim.longest_bound = 4.001;
  assert_violated(&p, "lower_bound");
  thr_plan_destroy(&p);
}
END_TEST

/* 7 units in cords of at most 4: two at least; of at most 3: three. */
START_TEST(a_claim_about_the_fewest)
{
  for (int n = 2; n <= 3; n++) {
    thr_plan p = two_squares(n);
    double longest = p.cords_claim.longest;
    p.options.cords_least = 1;
    p.options.cords = 5;
    p.options.max_length = longest;
    int least = (int)ceil(7 / longest - 1e-9);
    thr_err err = {0};
    thr_shortest s;
    ck_assert_int_eq(thr_postman_shortest(&p.frame, &p.options, &(thr_limits){0}, &s, NULL),
                     THR_OK);
    thr_certificate_destroy(&p.proof.certificate[0]);
    free(p.proof.certificate);
    ck_assert_int_eq(thr_postman_prove(&p.frame, &p.options, p.cord, p.n_cords, &s, &p.proof, &err),
                     THR_OK);
    thr_shortest_destroy(&s);
    ck_assert_int_eq(thr_check_cords(&p.frame, &p.options, p.cord, n, p.proof.certificate, 1, NULL,
                                     &p.cords_claim, &err),
                     THR_OK);
    ck_assert_int_eq(p.cords_claim.fewest, least < n ? least : n);
    ck_assert_int_eq(p.cords_claim.fewest_optimal, p.cords_claim.fewest == n);
    ck_assert_double_eq_tol(p.cords_claim.longest_bound, 2, 1e-9);
    assert_plan_sound(&p);
    p.cords_claim.fewest++;
    assert_violated(&p, "fewest");
    p.cords_claim.fewest = 1;
    p.cords_claim.fewest_optimal = true;
    assert_violated(&p, "fewest");
    thr_plan_destroy(&p);
  }
}
END_TEST

/* A path whose only foot is at its start: a cord over the last edge goes there and back. */
START_TEST(the_longest_forced_detour)
{
  thr_frame f = path_make(6);
  for (int ends = 0; ends < 3; ends++) {
    thr_request o = options_for(ends == 0   ? THR_ENDS_FEET
                                : ends == 1 ? THR_ENDS_CLOSED
                                            : THR_ENDS_ANY,
                                1);
    thr_plan p = plan_make(&f, &o);
    p.options.cords = 10;
    thr_cords_claim found;
    thr_err err = {0};
    ck_assert_int_eq(
        thr_check_cords(&f, &p.options, p.cord, p.n_cords, NULL, 0, NULL, &found, &err), THR_OK);
    ck_assert_double_eq_tol(found.longest_bound, ends == 0 ? 10 : ends == 1 ? 2 : 1, 1e-12);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_allocation_of_the_check_fails_once)
{
  thr_plan p = two_squares(2), closed = plan_simple(&p.frame, THR_ENDS_CLOSED, 1);
  for (int i = 0; i < 2; i++) {
    const thr_plan *q = i ? &closed : &p;
    thr_status st = THR_ENOMEM;
    for (long k = 1; st; k++) {
      thr_cords_claim found;
      thr_alloc_fail_at(k);
      st = thr_check_cords(&q->frame, &q->options, q->cord, q->n_cords, q->proof.certificate, 1,
                           NULL, &found, NULL);
      thr_alloc_fail_at(0);
      ck_assert(st == THR_OK || st == THR_ENOMEM);
    }
  }
  thr_plan_destroy(&p);
  thr_plan_destroy(&closed);
}
END_TEST

/* What the list comes to, written again; NULL and a word of the message where it is refused. */
static const struct {
  const char *list, *settled, *word;
} lists[] = {
    {"length", "length", NULL},
    {"overlap", "length", NULL},
    {"longest", "longest,length", NULL},
    {"longest,overlap", "longest,length", NULL},
    {"turning", "turning", NULL},
    {"turning:angle", "turning", NULL},
    {"max-turning:step", "max-turning:step", NULL},
    {"length,turning", "length,turning", NULL},
    {"length+12.5%,turning:sine", "length+12.5%,turning:sine", NULL},
    {"length+5,max-turning", "length+5%,max-turning", NULL},
    {"steps", "steps,overlap,paths,turning", NULL},
    {"turning,paths", "turning,paths,overlap,steps", NULL},
    {"length,steps", "overlap,steps,paths,turning", NULL},
    {"", NULL, "no aim"},
    {"length,", NULL, "no aim"},
    {"short", NULL, "no aim"},
    {"turning,turning", NULL, "twice"},
    {"length,overlap", NULL, "same"},
    {"turning,max-turning", NULL, "not both"},
    {"turning,length", NULL, "before"},
    {"length,longest", NULL, "before"},
    {"longest,turning", "longest,turning", NULL},
    {"longest,length+5%,turning:sine", "length+5%,longest,turning:sine", NULL},
    {"turning,longest", NULL, "before"},
    {"steps,longest", NULL, "longest"},
    {"steps,max-turning", NULL, "max-turning"},
    {"steps,turning:sine", NULL, "cost"},
    {"length+5%", NULL, "beyond"},
    {"length+5%,steps", NULL, "beyond"},
    {"length+x,turning", NULL, "percentage"},
    {"length+-1%,turning", NULL, "percentage"},
    {"turning+5%", NULL, "percentage"},
    {"turning:dear", NULL, "cost"},
    {"length:sine,turning", NULL, "cost"},
};
enum { N_LISTS = sizeof lists / sizeof *lists };

/* Writes the aims of options as such a list. */
static void write_aims(const thr_request *options, thr_text *out)
{
  bool turning = thr_wants_turning(options),
       limited = turning && options->turning.length_slack >= 0;

  /* A limit on the length comes before the turning that it limits. */
  if (limited && options->turning.length_slack > 0)
    thr_text_printf(out, "length+%.15g%%,", 100 * options->turning.length_slack);
  else if (limited)
    thr_text_append(out, "length,");

  /* The aims; costs other than the angle are named. */
  for (int i = 0; i < options->aims.n; i++) {
    thr_text_printf(out, i ? ",%s" : "%s", thr_aim_name(options->aims.aim[i]));
    if (turning && options->aims.aim[i] != THR_AIM_LONGEST &&
        options->turning.cost != THR_TURN_ANGLE)
      thr_text_printf(out, ":%s", thr_turn_cost_name(options->turning.cost));
  }
}

START_TEST(aims_are_read_and_written)
{
  thr_request o = thr_request_default(), again = o;
  thr_err err = {0};
  o.turning.cost = THR_TURN_SINE; /* which the list takes back */
  o.turning.length_slack = 3;
  const thr_request before = o;
  thr_status st = thr_aims_parse(lists[_i].list, &o, &err);
  if (!lists[_i].settled) {
    ck_assert_int_eq(st, THR_EINPUT);
    assert_one_line(&err, lists[_i].word);
    ck_assert(memcmp(&o, &before, sizeof o) == 0);
    return;
  }
  thr_text t = {0};
  assert_ok(st, &err);
  write_aims(&o, &t);
  ck_assert_str_eq(t.data, lists[_i].settled);
  ck_assert_int_eq(thr_aims_parse(t.data, &again, &err), THR_OK);
  ck_assert(memcmp(&again.aims, &o.aims, sizeof o.aims) == 0);
  ck_assert(again.turning.cost == o.turning.cost &&
            again.turning.length_slack == o.turning.length_slack);
  ck_assert_int_eq(thr_wants_length(&o) + thr_wants_turning(&o) + thr_wants_symmetry(&o), 1);
  thr_text_destroy(&t);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("requests");
  ADD_TEST(s, 10, everything_asked_for_survives_json);
  ADD_TEST(s, 10, nonsense_is_refused);
  ADD_TEST(s, 10, capacity_and_cover_of_edges);
  ADD_TEST(s, 10, given_numbers_of_ends);
  ADD_TEST(s, 10, cords_that_are_too_long);
  ADD_TEST(s, 10, tube_joints);
  ADD_TEST(s, 10, a_claim_about_one_cord);
  ADD_TEST(s, 10, a_bound_in_whole_edges);
  ADD_TEST(s, 10, a_claim_about_the_fewest);
  ADD_TEST(s, 10, the_longest_forced_detour);
  ADD_TEST(s, 10, every_allocation_of_the_check_fails_once);
  ADD_LOOP(s, 10, aims_are_read_and_written, 0, N_LISTS);
  return run_suite(s);
}
