/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans: names, turning angles, metrics, JSON and what it refuses. */
#include "tests/support.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "graph/number.h"
#include "graph/check/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

START_TEST(cord_ids_count_like_columns)
{
  static const struct {
    int i;
    const char *id;
  } known[] = {{0, "A"}, {25, "Z"}, {26, "AA"}, {51, "AZ"}, {52, "BA"}, {701, "ZZ"}, {702, "AAA"}};
  char id[12];
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    thr_cord_id(known[i].i, id);
    ck_assert_str_eq(id, known[i].id);
  }
  thr_cord_id(2000000000, id);
  ck_assert_uint_lt(strlen(id), sizeof id);
}
END_TEST

START_TEST(turn_angles_have_closed_forms)
{
  static const double degrees[] = {0, 1e-5, 30, 45, 90, 120, 179.99999, 180};
  for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
    double a = degrees[i] * THR_PI / 180;
    const double xyz[3][3] = {{-3, 0, 1}, {0, 0, 1}, {5 * cos(a), 5 * sin(a), 1}};
    const int edge[2][2] = {{0, 1}, {2, 1}};
    thr_frame f = frame_make(3, xyz, 2, edge, NULL, NULL);
    ck_assert_double_eq_tol(thr_turn_angle(&f, 0, 3), a, 1e-12);
    ck_assert_double_eq_tol(thr_turn_angle(&f, 2, 1), a, 1e-12); /* the other way the same */
    ck_assert_double_eq_tol(thr_turn_angle(&f, 0, 1), THR_PI, 1e-12);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(ring_is_measured)
{
  thr_frame f = ring_make(8);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  const thr_metrics *m = &p.metrics;
  ck_assert_int_eq(m->passes, 8);
  ck_assert_int_eq(m->most_passes, 1);
  ck_assert_int_eq(m->u_turns, 0);
  ck_assert_double_eq_tol(m->length, 8, 1e-12);
  ck_assert_double_eq(m->overlap, 0);
  ck_assert_double_eq_tol(m->turning, 2 * THR_PI, 1e-12);
  ck_assert_double_eq_tol(m->max_turning, 2 * THR_PI, 1e-12);
  ck_assert_double_eq_tol(m->worst_turn, THR_PI / 4, 1e-12);
  ck_assert_double_eq_tol(thr_cord_turning(&f, &p.cord[0], false), 7 * THR_PI / 4, 1e-12);
  ck_assert_int_eq(thr_cord_start(&f, &p.cord[0]), 0); /* the foot */
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(path_there_and_back_is_measured)
{
  thr_frame f = path_make(4);
  thr_plan p = plan_simple(&f, THR_ENDS_FEET, 1); /* the only foot is one end: there and back */
  ck_assert(p.cord[0].closed && p.cord[0].n_passes == 6);
  ck_assert_double_eq(p.metrics.length, 6);
  ck_assert_double_eq(p.metrics.base_length, 3);
  ck_assert_double_eq(p.metrics.overlap, 3);
  ck_assert_int_eq(p.metrics.most_passes, 2);
  ck_assert_int_eq(p.metrics.u_turns,
                   1); /* at the far end; where both cord ends come out nothing turns */
  ck_assert_double_eq_tol(p.metrics.worst_turn, THR_PI, 1e-12);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  p = plan_simple(&f, THR_ENDS_ANY, 1);
  ck_assert(!p.cord[0].closed && p.cord[0].n_passes == 3 && p.metrics.turning == 0);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(everything_survives_json)
{
  rng r = rng_make((uint64_t)_i);
  thr_frame f = random_frame(&r, 8, 6, (length_kind)(_i % LENGTH_KINDS));
  name_nodes(&f,
             (const char *const[]){NULL, NULL, NULL, "K\"no\\ten \xc3\xa4", NULL, NULL, NULL, NULL},
             8);
  memcpy(f.units, "in", 3);
  thr_request o = options_for(THR_ENDS_NODES, 3);
  bool end_node[8] = {false, true, true, false, false, false, true, false};
  o.end_node = end_node;
  o.physics.mu = 1.0 / 3;
  o.time_limit = 2.5e9;
  thr_plan p = plan_make(&f, &o);
  assert_plan_sound(&p);
  thr_text t = plan_text(&p);
  thr_plan q = plan_from(t.data);
  ck_assert_str_eq(q.frame.name[3], f.name[3]);
  ck_assert_str_eq(q.frame.units, "in");
  ck_assert(thr_frame_hash(&q.frame) == thr_frame_hash(&f) && q.frame.own_lengths == f.own_lengths);
  ck_assert(q.options.physics.mu == o.physics.mu && q.options.time_limit == o.time_limit &&
            q.options.cover == 3);
  ck_assert(memcmp(q.options.end_node, end_node, sizeof end_node) == 0);
  ck_assert(memcmp(&q.metrics, &p.metrics, sizeof q.metrics) == 0);
  ck_assert(q.proof.optimal && q.proof.lower_bound == p.proof.lower_bound &&
            q.proof.certificate[0].scale == p.proof.certificate[0].scale);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

/* The text with the first `from` after the mark replaced; freed by the caller. */
static char *replaced(const char *text, const char *mark, const char *from, const char *to)
{
  const char *at = strstr(strstr(text, mark), from);
  ck_assert_msg(at != NULL, "%s", from);
  size_t head = (size_t)(at - text);
  char *out = calloc(strlen(text) + strlen(to) + 1, 1);
  ck_assert(out != NULL);
  memcpy(out, text, head);
  strcpy(out + head, to);
  strcat(out, at + strlen(from));
  return out;
}

/* A triangle with a tail, of which all is said that can be said of a framework. */
static thr_plan full_plan(void)
{
  thr_draft d = {0};
  thr_frame f;
  thr_read_report report = {0};
  static const double xyz[4][3] = {{0.1, 0, 0}, {7.25, 0.5, 0}, {3, 5, 1}, {9, 9, 2}};
  static const char *const name[] = {"a", "b", "c", "d"};
  static const int end[4][2] = {{0, 1}, {1, 2}, {2, 0}, {2, 3}};
  for (int v = 0; v < 4; v++)
    ck_assert_int_eq(thr_draft_add_node(&d, xyz[v], name[v], v == 3, NULL), THR_OK);
  for (int e = 0; e < 4; e++) {
    ck_assert_int_eq(thr_draft_add_edge(&d, end[e][0], end[e][1], 20 + e, NULL), THR_OK);
    ck_assert_int_eq(thr_draft_edge_passes(&d, e == 0 ? 1 : 0, e == 3 ? 4 : 0, NULL), THR_OK);
  }
  ck_assert_int_eq(thr_draft_set_units(&d, "cm", NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&d, 0, &f, &report, NULL), THR_OK);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p = plan_make(&f, &o);
  thr_draft_destroy(&d);
  thr_frame_destroy(&f);
  return p;
}

START_TEST(what_is_read_back_is_the_plan)
{
  thr_plan p = full_plan();
  thr_text once = plan_text(&p);
  ck_assert_int_eq(thr_plan_parse_back(&p, once.data, once.length, "plan", NULL), THR_OK);
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  thr_text twice = plan_text(&p);
  assert_same_text(&once, &twice);
  thr_text_destroy(&once);
  thr_text_destroy(&twice);
  thr_plan_destroy(&p);
}
END_TEST

static const struct {
  const char *from, *to;
} other_framework[] = {{"\"cm\"", "\"mm\""},
                       {"0.1,", "0.10000000000000002,"},
                       {"0,0]", "-0.0,0]"},
                       {"[9,9,2]", "[9,9,3]"},
                       {"[2,3]", "[3,2]"},
                       {",[2,3]", ""},
                       {"[20,21", "[20,21.000000000000004"},
                       {"\"lengths\"", "\"other\""},
                       {"[1,1,1,1]", "[1,2,1,1]"},
                       {"\"covers\"", "\"other\""},
                       {"[null,null,null,4]", "[null,null,null,5]"},
                       {"\"capacities\"", "\"other\""},
                       {"\"b\"", "\"B\""},
                       {"\"names\"", "\"other\""},
                       {"\"feet\": [3]", "\"feet\": [2]"},
                       {"\"feet\": [3]", "\"feet\": []"},
                       {"\"hash\": \"", "\"hash\": \"f"}};

START_TEST(another_framework_is_not_read_back)
{
  thr_plan p = full_plan();
  thr_text t = plan_text(&p);
  char *text = replaced(t.data, "\"framework\"", other_framework[_i].from, other_framework[_i].to);
  ck_assert_int_ne(thr_plan_parse_back(&p, text, strlen(text), "plan", NULL), THR_OK);
  ck_assert_int_eq(p.n_cords, 0);
  ck_assert_int_eq(p.frame.n_nodes, 0);
  thr_plan_destroy(&p);
  thr_text_destroy(&t);
  free(text);
}
END_TEST

START_TEST(nonsense_is_refused_with_its_place)
{
  static const struct {
    const char *mark, *from, *to;
    thr_status status;
    const char *word;
  } wrong[] = {
      {"", "thread-plan", "other", THR_EINPUT, "format"},
      {"", "\"version\": 2", "\"version\": 3", THR_EINPUT, "version"},
      {"framework", "\"nodes\"", "\"knots\"", THR_EINPUT, "nodes"},
      {"framework", "[0,0,0]", "[0,0]", THR_EINPUT, "nodes[0]"},
      {"framework", "[1,0,0]", "[0,0,0]", THR_EINPUT, "framework"},
      {"framework", "[0,0,0]", "[1e100,0,0]", THR_EINPUT, "node 0"},
      {"framework", "[0,1]", "[0,9]", THR_EINPUT, "edges[0]"},
      {"framework", "\"feet\"", "\"covers\": {\"a\": 2, \"b\": 2, \"c\": 2}, \"feet\"", THR_EINPUT,
       "covers"},
      {"framework", "[0,1]", "[1,2]", THR_EINPUT, "framework"},
      {"framework", "\"feet\": [0", "\"feet\": [77", THR_EINPUT, "feet"},
      {"framework", "\"hash\": \"", "\"hash\": \"0", THR_EVIOLATED, "hash"},
      {"framework", "[1,0,0]", "[1,0,1]", THR_EVIOLATED, "hash"},
      {"options", "\"length\"", "\"beauty\"", THR_EINPUT, "objective"},
      {"options", "\"solid\"", "\"wood\"", THR_EINPUT, "joint"},
      {"options", "\"mu\": ", "\"mu\": -", THR_EINPUT, "mu"},
      {"options", "\"cover\": 1", "\"cover\": 0", THR_EINPUT, "cover"},
      {"options", "\"cover\": 1", "\"cover\": 101", THR_EINPUT, "cover"},
      {"options", "\"any\"", "\"none\"", THR_EINPUT, "ends"},
      {"options", "\"any\"", "\"nodes\"", THR_EINPUT, "end_nodes"},
      {"cords", "\"A\"", "\"much too long a name\"", THR_EVIOLATED, "id"},
      {"cords", "\"closed\": false", "\"closed\": 0", THR_EVIOLATED, "closed"},
      {"cords", "\"edges\": [0,", "\"edges\": [", THR_EVIOLATED, "cords[0]"},
      {"cords", "\"edges\": [0,", "\"edges\": [99,", THR_EVIOLATED, "cords[0].edges[0]"},
      {"cords", "\"edges\": [0,", "\"edges\": [1,", THR_EVIOLATED, "pass 1"},
      {"cords", "\"edges\": [0,", "\"edges\": [0.5,", THR_EVIOLATED, "cords[0].edges[0]"},
      {"metrics", "\"passes\": 3", "\"passes\": -3", THR_EVIOLATED, "passes"},
      {"metrics", "\"turning\"", "\"burning\"", THR_EVIOLATED, "burning"},
      {"proof", "\"optimal\"", "\"perhaps\"", THR_EVIOLATED, "status"},
      {"proof", "\"denominator\": ", "\"denominator\": -", THR_EVIOLATED, "denominator"},
  };
  thr_frame f = path_make(4);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_text t = plan_text(&p);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_err err = {0};
    char *text = replaced(t.data, wrong[i].mark, wrong[i].from, wrong[i].to);
    ck_assert_msg(judge_text(text, strlen(text), &err) == wrong[i].status, "%s: status %d, %s",
                  wrong[i].to, (int)err.code, err.text);
    assert_one_line(&err, wrong[i].word);
    assert_one_line(&err, "plan:");
    free(text);
  }
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_cut_short_text_is_refused)
{
  thr_frame f = solid_make(TETRAHEDRON);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_text t = plan_text(&p);
  for (size_t n = 0; n + 2 < t.length; n++) {
    thr_err err = {0};
    assert_status(judge_text(t.data, n, &err), THR_EINPUT, &err, "plan:");
  }
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(plan_without_proof_is_a_plan)
{
  thr_frame f = solid_make(CUBE);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  p.proof.present = false;
  thr_err err = {0};
  ck_assert_int_eq(judge_plan(&p, &err), THR_OK);
  p.proof.present = true;
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(missing_file_is_named)
{
  thr_plan p;
  thr_err err = {0};
  assert_status(thr_plan_read(&p, "tests/no-such-plan.json", &err), THR_EIO, &err,
                "no-such-plan.json");
  thr_plan_destroy(&p); /* {0} */
}
END_TEST

START_TEST(common_unit_of_lengths)
{
  static const struct {
    double length[4], unit;
  } known[] = {
      {{1, 1, 1, 1}, 1},
      {{20, 25, 45, 5}, 5},
      {{0.3, 0.1 + 0.2, 0.7, 0.1}, 0.1}, /* in floating point */
      {{1. / 3, 1. / 7, 2. / 3, 5. / 7}, 1. / 21},
      {{1e9, 1.5e9, 2e9, 1e9}, 0.5e9},
      {{1, 1, 1.4142135623730951, 1}, 0},
      {{1, 1, 1, 1 + 1e-8}, 0},
      {{1, 2, 3, 3.0001}, 0}, /* a unit too small to tell */
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    thr_frame f = ring_make(4);
    memcpy(f.length, known[i].length, sizeof known[i].length);
    ck_assert_double_le(fabs(thr_plan_unit(&f) - known[i].unit), 1e-12 * known[i].unit);
    thr_frame_destroy(&f);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("plan");
  ADD_TEST(s, 10, cord_ids_count_like_columns);
  ADD_TEST(s, 10, common_unit_of_lengths);
  ADD_TEST(s, 10, turn_angles_have_closed_forms);
  ADD_TEST(s, 10, ring_is_measured);
  ADD_TEST(s, 10, path_there_and_back_is_measured);
  ADD_LOOP(s, 10, everything_survives_json, 1, 9);
  ADD_TEST(s, 10, what_is_read_back_is_the_plan);
  ADD_LOOP(s, 10, another_framework_is_not_read_back, 0,
           sizeof other_framework / sizeof *other_framework);
  ADD_TEST(s, 10, nonsense_is_refused_with_its_place);
  ADD_TEST(s, 10, every_cut_short_text_is_refused);
  ADD_TEST(s, 10, plan_without_proof_is_a_plan);
  ADD_TEST(s, 10, missing_file_is_named);
  return run_suite(s);
}
