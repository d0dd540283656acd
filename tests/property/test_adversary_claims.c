/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adversary of test_adversary_turning.c against the claims of whole plans: of the turning, in
 * all and of the cord that turns most, and of length, longest cord and fewest cords with tube
 * joints. */
#include "graph/check/check.h"
#include "graph/limits.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/turning_proof.h"
#include "planner/planner.h"
#include "tests/attack.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/truth.h"
#include "tests/turning_targets.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static built scratch;

/* ---- claims of turning ---- */

enum { MOST_CORDS = 3 };

typedef struct {
  candidate c;
  int raise;       /* how far above what is proved the plan's words are */
  int more_passes; /* beyond the least number that a claim is about */
} claim;

/* The program's own proof for exactly so many cords, to start from; nothing if there is none. */
static void take_proof_of_so_many(const target *t, candidate *c)
{
  target own = *t;
  thr_request o = t->plan.options;
  thr_limits limits = {.deadline = thr_clock() + 5};
  o.cords = o.cords_least = t->plan.n_cords;
  *c = (candidate){.n_nodes = 1};
  thr_status st = thr_tortuosity_plan(&t->plan.frame, &o, &limits, &own.plan, NULL);
  if (st && st != THR_ELIMIT) return;
  candidate_take_own(&own, c);
  thr_plan_destroy(&own.plan);
}

/* Sums and largest prices of all cords with few passes. */
static void find_prices(target *t)
{
  const thr_request *o = &t->plan.options;
  truth_table table = truth_table_make(&t->plan.frame, o, 2);
  for (int n = o->cords_least; n <= o->cords; n++) {
    t->least = fminl(t->least, truth_price(&table, n, false, -1));
    t->largest = fminl(t->largest, truth_price(&table, n, true, -1));
  }
  truth_table_destroy(&table);
}

/* The same of plans that the program finds: witnesses. */
static void find_prices_of_plans(target *t)
{
  for (int n = t->plan.options.cords_least; n <= t->plan.options.cords; n++)
    for (int largest = 0; largest < 2; largest++) {
      thr_request o = t->plan.options;
      thr_plan p;
      thr_limits limits = {.deadline = thr_clock() + 5};
      o.cords = o.cords_least = n;
      want(&o, largest ? "max-turning" : "turning");
      thr_status st = thr_tortuosity_plan(&t->plan.frame, &o, &limits, &p, NULL);
      if (st && st != THR_ELIMIT) continue;
      t->least = fminl(t->least, p.turning.price);
      t->largest = fminl(t->largest, p.turning.largest);
      thr_plan_destroy(&p);
    }
}

/* The shortest cords, which turn more than they must, as a plan for the least turning of a range of
 * numbers of cords. */
static bool claim_target_make(rng *r, target *t)
{
  thr_request o;
  *t = (target){.least = INFINITY, .largest = INFINITY};
  thr_frame f = rng_below(r, 3) ? target_frame(r) : target_bowtie(r);
  target_options(r, t, &f, &o);
  o.joint = THR_JOINT_SOLID;
  want(&o, "length");
  o.turning.length_slack = -1;
  bool fits =
      o.ends != THR_ENDS_COUNTS && f.n_edges <= (target_pieces(&f) > 1 ? EDGES : TRUTH_TABLE_EDGES);
  thr_status st =
      fits ? length_plan(&f, &o, &(thr_limits){0}, &t->plan, NULL, NULL) : THR_EINFEASIBLE;
  thr_frame_destroy(&f);
  if (st && st != THR_ELIMIT) return false;
  thr_plan *p = &t->plan;
  want(&p->options, "turning");
  p->options.cords_least = rng_between(r, 1, o.cords);
  p->options.cords = rng_between(r, o.cords, MOST_CORDS - 1);
  for (int i = 0; i < p->proof.n_certificates; i++)
    thr_certificate_destroy(&p->proof.certificate[i]);
  free(p->proof.certificate);
  p->proof = (thr_length_proof){0};
  p->cords_claim = (thr_cords_claim){0};
  t->n_pieces = t->n_ends = target_pieces(&p->frame);
  if (t->n_pieces > 1)
    find_prices_of_plans(t);
  else
    find_prices(t);
  if (t->least < INFINITY) return true;
  target_destroy(t);
  return false;
}

static void change_claim(rng *r, const void *what, void *of)
{
  claim *c = of;
  switch (rng_below(r, 20)) {
  case 0: c->raise = rng_below(r, 5); break;
  case 1: c->more_passes = rng_below(r, 2) ? 0 : rng_between(r, -5, 1000); break;
  default: candidate_change(r, what, &c->c);
  }
}

static thr_status state(thr_plan *p, const claim *c)
{
  static const double part[] = {0, 9e-10, 1e-8, 3e-7, 1e-4};
  thr_turning_claim said = {.present = true, .length_limit = -1, .tree = scratch.proof};
  said.most_passes = thr_turning_most_passes(&p->frame, p->options.cover) + c->more_passes;
  thr_status st =
      thr_check_turning(&p->frame, &p->options, p->cord, p->n_cords, &said, &p->turning, NULL);
  thr_turning_claim *t = &p->turning;
  t->tree = scratch.proof;
  if (!t->optimal) t->lower_bound *= 1 + part[c->raise];
  if (!t->largest_optimal) t->largest_bound *= 1 + part[c->raise];
  t->gap = t->price > 0 ? (t->price - t->lower_bound) / t->price : 0;
  return st;
}

static double judge_claim(const void *what, const void *of)
{
  const target *t = what;
  const claim *c = of;
  thr_plan p = t->plan;
  candidate_build(t, &c->c, &scratch);
  if (state(&p, c) || thr_check_plan(&p, NULL)) return -INFINITY;
  long double above = (p.turning.lower_bound - t->least) / (1 + t->least),
              largest = (p.turning.largest_bound - t->largest) / (1 + t->largest);
  return (double)(above > largest ? above : largest);
}

static const attack_kind of_claims = {sizeof(claim), change_claim, judge_claim, 4e-9};

START_TEST(no_claim_of_turning_is_above_the_truth)
{
  enum { STEPS = 600, MOST_SAID = 10 };
  attack_tally tally = {.name = "turning claims", .best = -INFINITY};
  for (uint64_t seed = attack_seed(); tally.judged < attack_number(100000); seed++) {
    rng r = rng_make(seed);
    target t;
    if (!claim_target_make(&r, &t)) continue;
    claim *c = calloc(1, sizeof *c);
    ck_assert(c != NULL);
    take_proof_of_so_many(&t, &c->c);
    bool hole = attack_climb(&r, &of_claims, &t, c, STEPS, &tally);
    if (hole && tally.holes < MOST_SAID)
      printf("hole: seed %lld, %g above %.17Lg or %.17Lg: ends %d, cords %d..%d (%d), cost %d, "
             "raise %d\n",
             (long long)seed, judge_claim(&t, c), t.least, t.largest, (int)t.plan.options.ends,
             t.plan.options.cords_least, t.plan.options.cords, t.plan.n_cords,
             (int)t.plan.options.turning.cost, c->raise);
    free(c);
    target_destroy(&t);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 10);
}
END_TEST

/* ---- claims of tied plans ---- */

/* A framework with tube joints, one component or two, whose plan states options that it was not
 * made for. */
typedef struct {
  target t;       /* least: length of the shortest cords found */
  double longest; /* the least length found of the longest cord */
  int fewest;     /* fewest cords found, none longer than allowed */
} tied_target;

static bool tied_plan(const thr_frame *f, const thr_request *o, int cords, bool balance,
                      thr_plan *p)
{
  thr_request exactly = *o;
  thr_limits limits = {.deadline = thr_clock() + 5};
  exactly.cords = exactly.cords_least = cords;
  want(&exactly, balance ? "longest" : "length");
  exactly.max_length = 0;
  thr_status st = length_plan(f, &exactly, &limits, p, NULL, NULL);
  return st == THR_OK || st == THR_ELIMIT;
}

static double longest_of(const thr_plan *p)
{
  double longest = 0;
  for (int i = 0; i < p->n_cords; i++)
    longest = fmax(longest, thr_cord_length(&p->frame, &p->cord[i]));
  return longest;
}

/* Plans that the program finds for every number of cords are witnesses. */
static void find_witnesses(tied_target *x, const thr_frame *f, const thr_request *o)
{
  x->t.least = x->longest = INFINITY;
  x->fewest = INT_MAX;
  for (int n = o->cords; n >= o->cords_least; n--)
    for (int balance = 0; balance < 2; balance++) {
      thr_plan p;
      if (!tied_plan(f, o, n, balance, &p)) continue;
      x->t.least = fminl(x->t.least, p.metrics.length);
      x->longest = fmin(x->longest, longest_of(&p));
      if (longest_of(&p) <= o->max_length * (1 + 1e-9) && p.n_cords < x->fewest)
        x->fewest = p.n_cords;
      thr_plan_destroy(&p);
    }
}

static bool tied_target_make(rng *r, tied_target *x)
{
  thr_request o;
  *x = (tied_target){.t = {.tied = true}};
  target *t = &x->t;
  thr_frame f = target_frame(r);
  target_options(r, t, &f, &o);
  bool fits = o.ends != THR_ENDS_COUNTS && o.ends != THR_ENDS_NODES && f.n_edges <= EDGES &&
              tied_plan(&f, &o, o.cords, false, &t->plan);
  if (fits) {
    t->n_ends = target_pieces(&f);
    o.cords_least = rng_between(r, 1, o.cords);
    o.cords = rng_between(r, o.cords, MOST_CORDS);
    if (rng_below(r, 4))
      o.max_length = longest_of(&t->plan) * (rng_below(r, 2) ? 1 : 1 + rng_unit(r));
    want(&t->plan.options, rng_below(r, 3) ? "length" : "turning");
    t->plan.options.turning.length_slack = -1;
    t->plan.options.cords = o.cords;
    t->plan.options.cords_least = o.cords_least;
    t->plan.options.max_length = o.max_length;
    find_witnesses(x, &f, &o);
  }
  thr_frame_destroy(&f);
  return fits;
}

static thr_status state_tied(thr_plan *p, const claim *c)
{
  thr_cords_claim *said = &p->cords_claim;
  p->proof = (thr_length_proof){.present = true, .tied = scratch.proof};
  thr_status st =
      thr_check_tied_cords(&p->frame, &p->options, p->cord, p->n_cords, &scratch.proof, said, NULL);
  if (!st) st = thr_tied_least(&p->frame, &p->options, &scratch.proof, &p->proof.lower_bound, NULL);
  p->proof.lower_bound *= 1 + 9e-10 * c->raise;
  if (!said->longest_optimal) said->longest_bound *= 1 + 9e-10 * c->raise;
  p->proof.gap = (p->metrics.length - p->proof.lower_bound) / p->metrics.length;
  return st;
}

static double judge_tied(const void *what, const void *of)
{
  const tied_target *x = what;
  const claim *c = of;
  thr_plan p = x->t.plan;
  candidate_build(&x->t, &c->c, &scratch);
  if (state_tied(&p, c) || thr_check_plan(&p, NULL)) return -INFINITY;
  double above = (double)(p.proof.lower_bound / x->t.least - 1),
         longest = p.cords_claim.longest_bound / x->longest - 1;
  return p.cords_claim.fewest > x->fewest ? 1 : fmax(above, longest);
}

static void change_tied(rng *r, const void *what, void *of)
{
  change_claim(r, &((const tied_target *)what)->t, of);
}

static const attack_kind of_tied_claims = {sizeof(claim), change_tied, judge_tied, 4e-9};

START_TEST(no_claim_of_a_tied_plan_is_above_the_truth)
{
  enum { STEPS = 600, MOST_SAID = 10 };
  attack_tally tally = {.name = "tied claims", .best = -INFINITY};
  for (uint64_t seed = attack_seed(); tally.judged < attack_number(40000); seed++) {
    rng r = rng_make(seed);
    tied_target x;
    if (!tied_target_make(&r, &x)) continue;
    claim *c = calloc(1, sizeof *c);
    ck_assert(c != NULL);
    candidate_take_own(&x.t, &c->c);
    bool hole = attack_climb(&r, &of_tied_claims, &x, c, STEPS, &tally);
    if (hole && tally.holes < MOST_SAID)
      printf("hole: seed %lld, %g above %.17Lg, longest %.17g, fewest %d: ends %d, cords %d..%d "
             "(%d), max_length %.17g, raise %d\n",
             (long long)seed, judge_tied(&x, c), x.t.least, x.longest, x.fewest,
             (int)x.t.plan.options.ends, x.t.plan.options.cords_least, x.t.plan.options.cords,
             x.t.plan.n_cords, x.t.plan.options.max_length, c->raise);
    free(c);
    target_destroy(&x.t);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 10);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("adversary of claims");
  ADD_TEST(s, 100000, no_claim_of_turning_is_above_the_truth);
  ADD_TEST(s, 100000, no_claim_of_a_tied_plan_is_above_the_truth);
  return run_suite(s);
}
