/* Plans that are made in two threads at once are those that one thread makes. */
#define _POSIX_C_SOURCE 200809L
#include "planner/make_plan.h"
#include "tests/support.h"
#include "tests/frameworks.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"

#include <pthread.h>
#include <string.h>

/* What is planned: of every objective and joint, several cords, cut trees, symmetries, linear programmes in children. */
static void request_number(int i, thr_frame *f, thr_request *o)
{
  *o = thr_request_default();
  o->confirm = THR_CONFIRM_NEVER; /* for a second at most: which second is not ours to say */
  *f = i % 2 ? solid_make(CUBE) : wheel_make(7);
  o->ends = i % 3 ? THR_ENDS_ANY : THR_ENDS_CLOSED;
  switch (i % 5) {
  case 0: break;
  case 1: o->aims = thr_aims_straightest; break;
  case 2: o->aims = thr_aims_symmetric; break;
  case 3: o->joint = THR_JOINT_TUBE; break;
  default: o->cords = o->cords_least = 3; ck_assert_int_eq(thr_aims_parse("longest", o, NULL), THR_OK);
  }
}
enum { N_REQUESTS = 10 };

/* As it is written; "" if there is none. */
static void plan_number(int i, thr_text *t)
{
  thr_frame f;
  thr_request o;
  thr_plan p;
  request_number(i, &f, &o);
  thr_status st = thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, NULL);
  if (st == THR_OK || st == THR_ELIMIT) thr_plan_write(&p, t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}

typedef struct {
  int first;
  thr_text plan[N_REQUESTS];
} work;

static void *plan_all(void *user)
{
  work *w = user;
  for (int i = 0; i < N_REQUESTS; i++)
    plan_number((w->first + i) % N_REQUESTS, &w->plan[(w->first + i) % N_REQUESTS]);
  return NULL;
}

START_TEST(two_threads_plan_as_one)
{
  work w[3] = {{.first = 0}, {.first = 0}, {.first = N_REQUESTS / 2}};
  pthread_t thread[2];
  plan_all(&w[0]);
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(pthread_create(&thread[k], NULL, plan_all, &w[k + 1]), 0);
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(pthread_join(thread[k], NULL), 0);
  for (int i = 0; i < N_REQUESTS; i++) {
    ck_assert(w[0].plan[i].length > 100);
    for (int k = 1; k < 3; k++)
      ck_assert_str_eq(w[k].plan[i].data, w[0].plan[i].data);
    for (int k = 0; k < 3; k++)
      thr_text_destroy(&w[k].plan[i]);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("threads");
  ADD_TEST(s, 120, two_threads_plan_as_one);
  return run_suite(s);
}
