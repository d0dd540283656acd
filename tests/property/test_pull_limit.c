/* The fewest cords within a limit on the pull: plans against all sets of cords of small frameworks, and forged claims. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/make_plan.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/truth.h"

#include <math.h>
#include <stdlib.h>

enum { NODES = 8, MOST = 6 };

typedef struct {
  thr_frame frame;
  thr_request o;
  bool end_node[NODES];
  long double
      least[MOST + 1]; /* the truth: turning of the cord that turns most, by the number of cords; with a closed one's last */
} instance;

/* false: too large to try. */
static bool instance_make(rng *r, instance *x)
{
  static const char *const aims[] = {"length", "turning", "max-turning", "longest,length", "turning:sine"};
  *x = (instance){.frame = random_frame(r, rng_between(r, 2, 5), rng_below(r, 3), LENGTHS_EUCLID)};
  bool small = x->frame.n_edges <= TRUTH_TABLE_EDGES;
  static const thr_ends ends[] = {THR_ENDS_ANY, THR_ENDS_NODES, THR_ENDS_CLOSED};
  x->o = options_for(ends[rng_below(r, 3)], 1);
  want(&x->o, aims[rng_below(r, 5)]);
  x->o.cords = MOST;
  x->o.max_pull = 1 + 3 * rng_unit(r) * rng_unit(r);
  for (int v = 0; v < x->frame.n_nodes; v++)
    x->end_node[v] = v == 0 || rng_below(r, 2);
  if (x->o.ends == THR_ENDS_NODES) x->o.end_node = x->end_node;
  if (!small) return false;
  thr_request angles = x->o;
  angles.turning.cost = THR_TURN_ANGLE;
  truth_table table = truth_table_make(&x->frame, &angles, 3);
  for (int n = 1; n <= MOST; n++)
    x->least[n] = truth_price(&table, n, true, -1);
  truth_table_destroy(&table);
  return true;
}

/* No number below has cords that turn little enough: the fewest that there may be. Of closed cords the last turn counts for
 * nothing, at most pi. */
static int fewest_possible(const instance *x, const thr_request *o)
{
  double most = thr_request_most_turning(o) + (o->ends == THR_ENDS_CLOSED ? acos(-1) : 0);
  int n = 1;
  while (n <= MOST && x->least[n] > most)
    n++;
  return n;
}

/* The larger part of the turning, by trying every pass for the slackest. */
static double pull_of(const thr_frame *f, const thr_cord *cord, double mu)
{
  double least = INFINITY;
  for (int slack = 0; slack < cord->n_passes; slack++) {
    double pull[2] = {1, 1};
    for (int k = 0; k + 1 < cord->n_passes; k++)
      pull[k >= slack] *= exp(mu * thr_turn_angle(f, cord->half[k], cord->half[k + 1]));
    least = fmin(least, fmax(pull[0], pull[1]));
  }
  return least;
}

START_TEST(plans_keep_to_the_pull_and_claim_what_is_true)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x;
  thr_plan p;
  thr_err err = {0};
  if (instance_make(&r, &x)) {
    int fewest = fewest_possible(&x, &x.o);
    thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){0}, &p, NULL, &err);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
    ck_assert(st != THR_EINFEASIBLE || fewest > MOST);
    ck_assert(st != THR_OK || p.n_cords > 0);
    if (p.n_cords > 0) {
      assert_plan_sound(&p);
      ck_assert_int_le(p.pull_claim.fewest, p.n_cords);
      ck_assert_int_le(p.pull_claim.fewest, fewest);
      ck_assert(!p.pull_claim.optimal || p.pull_claim.fewest == p.n_cords);
      for (int i = 0; i < p.n_cords; i++) {
        double pull = pull_of(&x.frame, &p.cord[i], x.o.physics.mu);
        ck_assert_double_le(pull, x.o.max_pull * (1 + 1e-8));
        ck_assert_double_eq_tol(exp(x.o.physics.mu * thr_cord_pulled_turning(&x.frame, &p.cord[i])), pull, 1e-9 * pull);
      }
    }
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&x.frame);
}
END_TEST

/* Changes to what a plan claims, or to what it is about: whatever the checker lets pass is true. */
START_TEST(no_forged_claim_is_verified)
{
  rng r = rng_make((uint64_t)_i + 5000);
  instance x;
  thr_plan p;
  if (instance_make(&r, &x)) {
    thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){0}, &p, NULL, NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE);
    for (int i = 0; i < 300 && p.n_cords > 0; i++) {
      thr_request asked = p.options;
      thr_pull_claim claim = p.pull_claim;
      p.turning.present = p.proof.present = p.cords_claim.present = false;
      for (int k = rng_between(&r, 1, 3); k > 0; k--)
        switch (rng_below(&r, 6)) {
        case 0: p.pull_claim.fewest += rng_between(&r, -1, 2); break;
        case 1: p.pull_claim.excluded = rng_between(&r, 1, MOST); break;
        case 2: p.options.max_pull = fmax(1, p.options.max_pull * (1 + (rng_unit(&r) - .5) * .2)); break;
        case 3: p.options.cords_least = rng_between(&r, 1, p.options.cords); break;
        case 4: p.pull_claim.most_passes += rng_between(&r, -4, 4); break;
        default: p.pull_claim.optimal = rng_below(&r, 2);
        }
      if (thr_check_plan(&p, NULL) == THR_OK) {
        int least = p.options.cords_least, fewest = fewest_possible(&x, &p.options);
        ck_assert_int_le(p.pull_claim.fewest, fewest > least ? fewest : least);
        ck_assert(!p.pull_claim.optimal || p.pull_claim.fewest == p.n_cords);
        for (int k = 0; k < p.n_cords; k++)
          ck_assert_double_le(pull_of(&x.frame, &p.cord[k], x.o.physics.mu), p.options.max_pull * (1 + 1e-8));
      }
      p.options = asked;
      p.pull_claim = claim;
    }
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&x.frame);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("pull limit");
  ADD_EXAMPLES(s, 60, plans_keep_to_the_pull_and_claim_what_is_true, 300);
  ADD_EXAMPLES(s, 40, no_forged_claim_is_verified, 150);
  return run_suite(s);
}
