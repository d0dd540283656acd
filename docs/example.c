/* The library without the program: plans a framework for each objective, checks the plans and writes them. */
#include "graph/check/check.h"
#include "graph/io/read.h"
#include "planner/make_plan.h"

#include <stdio.h>

static const char *const aims[] = {"length", "turning", "steps"}; /* of three plans */

int main(int argc, char **argv) /* example FRAME [PLAN ..] */
{
  thr_frame frame;
  thr_read_report read;
  thr_err err = {0};
  const thr_read_options how = thr_read_options_default();
  thr_status st = thr_frame_read(&frame, &read, argc > 1 ? argv[1] : "-", &how, NULL, 0, &err);
  for (int i = 0; i < 3 && !st; i++) {
    thr_plan plan = {0};
    thr_text text = {0};
    const thr_limits limits = {.deadline = thr_clock() + 20};
    thr_request request = thr_request_default();
    st = thr_aims_parse(aims[i], &request, &err);
    if (!st) st = thr_plan_make(&frame, &request, &limits, &plan, NULL, &err);
    if (plan.n_cords > 0) st = thr_check_plan(&plan, &err); /* proved least or not, it holds its bounds */
    if (!st) thr_plan_write(&plan, &text);
    if (!st) st = thr_text_write(&text, i + 2 < argc ? argv[i + 2] : "-", &err);
    thr_text_destroy(&text);
    thr_plan_destroy(&plan);
  }
  if (st) fprintf(stderr, "example: %s\n", err.text);
  thr_frame_destroy(&frame);
  return st ? 1 : 0;
}
