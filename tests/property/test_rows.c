/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every row of the table of symmetries, made a plan, written, read and checked, is what the row
 * said of it. */
#include "tests/symmetric.h"
#include "graph/check/check.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *path; /* NULL = a cube */
  bool feet;
} source;

static const source sources[] = {{"data/dome7.json", true},
                                 {"data/conmech/four-frame.json", true},
                                 {"data/conmech/tower_3D.json", true},
                                 {"data/jax_fdm/monkey_saddle.json", false},
                                 {NULL, false}};
enum { N_SOURCES = sizeof sources / sizeof *sources };

static thr_frame frame_of(const source *s)
{
  return s->path ? frame_load(s->path, NULL) : no_feet(solid_make(CUBE));
}

/* Nothing is less than what is said to be proved; and a row that is proved leaves no gap. */
static void check_bounds(const thr_symmetry_row *row)
{
  const double has[THR_N_AIMS] = {[THR_AIM_OVERLAP] = row->metrics.overlap,
                                  [THR_AIM_STEPS] = row->record.steps,
                                  [THR_AIM_PATHS] = row->record.unique_paths,
                                  [THR_AIM_TURNING] = row->metrics.turning};
  for (int a = 0; a < THR_N_AIMS; a++) {
    double rounding = 1e-5 * fmax(1, has[a]);
    ck_assert_msg(has[a] >= row->bound[a] - rounding, "order %d, %s: %g, but at least %g",
                  row->order, thr_aim_name(a), has[a], row->bound[a]);
    ck_assert(row->why.code || has[a] <= row->bound[a] + rounding);
  }
}

/* The plan as read back; figures of the row are looked up in it, copies counted. */
static void check_plan_of_row(const thr_symmetry_row *row, const thr_plan *p)
{
  const thr_symmetry_record *r = &p->symmetry;
  int least = p->n_cords, most = 0;
  ck_assert(r->order == row->order && strcmp(r->name, row->name) == 0);
  ck_assert(r->steps == row->record.steps && r->unique_paths == row->record.unique_paths);
  ck_assert_int_eq(p->n_cords, row->n_cords);
  ck_assert(p->metrics.overlap == row->metrics.overlap &&
            p->metrics.turning == row->metrics.turning);
  ck_assert(p->metrics.max_turning == row->metrics.max_turning &&
            p->metrics.passes == row->metrics.passes);
  for (int u = 0; u < p->n_cords; u++) {
    int copies = 0;
    for (int i = 0; i < p->n_cords; i++)
      copies += r->unique[i] == u;
    if (copies == 0) continue;
    if (copies < least) least = copies;
    if (copies > most) most = copies;
  }
  ck_assert(least == row->least_copies && most == row->most_copies);
}

/* Asked for by number it is the same, if it is proved. */
static void check_alone(const thr_frame *f, thr_request o, int number, const thr_symmetry_row *row)
{
  const thr_limits none = {0};
  thr_symmetries t;
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "%d", number);
  ck_assert_int_ne(thr_symmetries_find(f, &o, false, &none, &t, NULL), THR_ENOMEM);
  ck_assert_int_eq(t.chosen, number - 1);
  const thr_symmetry_row *alone = &t.row[t.chosen];
  ck_assert(alone->metrics.overlap == row->metrics.overlap &&
            alone->metrics.turning == row->metrics.turning);
  ck_assert(alone->record.steps == row->record.steps && alone->n_cords == row->n_cords);
  thr_symmetries_destroy(&t);
}

/* What is left out when only the choice is wanted could not be chosen: the table of all rows has
 * the same. */
static void check_choice(const thr_frame *f, const thr_request *o, const thr_symmetries *all)
{
  const thr_limits none = {0};
  thr_symmetries t;
  const double within = all->shortest * (1 + thr_symmetry_slack);
  ck_assert_int_ne(thr_symmetries_find(f, o, true, &none, &t, NULL), THR_ENOMEM);
  ck_assert(t.n == all->n && t.chosen == all->chosen && t.within == all->within);
  const thr_symmetry_row *best = &all->row[all->chosen];
  for (int i = 0; i < t.n; i++) {
    const thr_symmetry_row *row = &all->row[i];
    ck_assert((t.row[i].n_cords == 0) == (t.row[i].behind > 0));
    if (!t.row[i].behind) continue;
    ck_assert(t.row[t.row[i].behind - 1].n_cords > 0);
    ck_assert(all->within
                  ? row->metrics.length > within || row->record.steps > best->record.steps - 1e-9
                  : row->metrics.overlap > best->metrics.overlap);
  }
  ck_assert(t.row[t.chosen].metrics.turning == best->metrics.turning &&
            t.row[t.chosen].record.steps == best->record.steps);
  thr_symmetries_destroy(&t);
}

START_TEST(rows_and_their_plans)
{
  const source *s = &sources[_i / 3];
  thr_ends ends = (thr_ends)(_i % 3);
  const thr_limits none = {0};
  thr_frame f = frame_of(s);
  thr_request o = options_for(ends, 1);
  thr_symmetries t;
  thr_err err = {0};
  want(&o, "overlap,steps");
  thr_status found = thr_symmetries_find(&f, &o, false, &none, &t, &err);
  if (ends == THR_ENDS_FEET && !s->feet) {
    ck_assert_int_eq(found, THR_EINFEASIBLE);
    thr_frame_destroy(&f);
    return;
  }
  ck_assert_msg(found == THR_OK || found == THR_ELIMIT, "%s", err.text);
  check_choice(&f, &o, &t);
  for (int i = 0; i < t.n; i++) {
    thr_symmetry_row *row = &t.row[i];
    thr_plan p;
    ck_assert_int_gt(row->n_cords, 0);
    check_bounds(row);
    thr_status st = thr_symmetries_plan(&t, i, &f, &o, &none, &p, &err);
    ck_assert_msg(st == row->why.code, "row %d: %s", i + 1, err.text);
    thr_text text = plan_text(&p);
    thr_plan read = plan_from(text.data);
    assert_plan_sound(&read);
    check_plan_of_row(row, &read);
    if (i % 5 == 0) check_alone(&f, o, i + 1, row);
    thr_plan_destroy(&read);
    thr_text_destroy(&text);
    thr_plan_destroy(&p);
  }
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rows");
  ADD_EXAMPLES(s, 120, rows_and_their_plans, 3 * N_SOURCES);
  return run_suite(s);
}
