/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Instructions of the rows of the table of symmetries, against all threadings that turn out the
 * same in every aim. */
#include "graph/plan/plan_measures.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_HALVES = 26, MOST_ORDER = 48 };

/* Every edge is passed once: a threading is a partner for every half-edge that leaves a node, or
 * none where a cord ends. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_symmetry_row *row;
  int image[MOST_ORDER][MOST_HALVES];
  int partner[MOST_HALVES]; /* -1 = open, -2 = an end */
  thr_cord cord[MOST_HALVES];
  int half[MOST_HALVES];
  int unique[MOST_HALVES], element[MOST_HALVES];
  thr_symmetry_record record;
  long leaves;
  int least; /* instructions */
} exhaustive;

static int image_of(const thr_frame *f, const int *image, int h)
{
  const int a = image[thr_tail(f, h)], e = thr_frame_edge_between(f, a, image[thr_head(f, h)]);
  return 2 * e + (f->edge[e][0] != a);
}

/* Follows the cords; returns how many. on[e]: the cord over edge e. */
static int follow(exhaustive *x, int *on)
{
  int n = 0, used = 0;
  for (int e = 0; e < x->f->n_edges; e++)
    on[e] = -1;
  for (int pass = 0; pass < 2; pass++) /* from ends; then closed ones */
    for (int h = 0; h < 2 * x->f->n_edges; h++) {
      if (on[h >> 1] >= 0 || (pass == 0 && x->partner[h] != -2)) continue;
      x->cord[n] = (thr_cord){.closed = pass == 1, .half = x->half + used};
      for (int k = h; k >= 0 && on[k >> 1] < 0; k = x->partner[k ^ 1]) {
        x->half[used++] = k;
        x->cord[n].n_passes++;
        on[k >> 1] = n;
      }
      x->cord[n].closed = thr_tail(x->f, h) == thr_head(x->f, x->half[used - 1]);
      n++;
    }
  return n;
}

/* A closed cord of ends anywhere comes out where it turns most, as the program's do: that turn is
 * none. */
static void start_sharpest(exhaustive *x, thr_cord *c)
{
  int start = 0, n = c->n_passes, turned[MOST_HALVES];
  double most = -1;
  for (int k = 0; k < n; k++) {
    const double turn = thr_turn_angle(x->f, c->half[(k + n - 1) % n], c->half[k]);
    if (turn > most + 1e-9) start = k, most = turn;
  }
  for (int k = 0; k < n; k++)
    turned[k] = c->half[(start + k) % n];
  memcpy(c->half, turned, (size_t)n * sizeof *turned);
}

/* The cords of an orbit are copies of the first of them. */
static void find_copies(exhaustive *x, int n, const int *on)
{
  for (int i = 0; i < n; i++)
    x->unique[i] = -1;
  for (int i = 0; i < n; i++)
    for (int g = 0; g < x->row->order;
         g++) { /* element 0 is the identity: a path is its own first copy */
      const int other = on[x->image[g][x->cord[i].half[0]] >> 1];
      if (x->unique[i] >= 0 && x->unique[i] != i) break;
      if (x->unique[other] >= 0) continue;
      x->unique[other] = i;
      x->element[other] = g;
    }
}

/* What has to be learned of a path and its copies. */
static double steps_of(const exhaustive *x, int path, int n)
{
  const thr_cord *c = &x->cord[path];
  int copies = 0, fixing = 0;
  for (int i = 0; i < n; i++)
    copies += x->unique[i] == path;
  for (int g = 0; g < x->row->order; g++) {
    bool fixes = true;
    for (int k = 0; k < c->n_passes; k++)
      fixes = fixes && x->image[g][c->half[k]] == c->half[k];
    fixing += fixes;
  }
  const int ends = x->o->ends == THR_ENDS_ANY && !c->closed ? 2 : 0;
  return (double)(c->n_passes + ends) * fixing * copies / x->row->order;
}

/* All half-edges have partners: is it as good as the row's threading, and what is there to read? */
static void weigh(exhaustive *x)
{
  int on[MOST_HALVES], paths = 0;
  double turning = 0, steps = 0;
  const int n = follow(x, on);
  x->leaves++;
  if (n != x->row->n_cords) return;
  for (int i = 0; i < n; i++) {
    if (x->cord[i].closed) start_sharpest(x, &x->cord[i]);
    turning += thr_cord_turning(x->f, &x->cord[i], x->o->ends == THR_ENDS_CLOSED);
  }
  find_copies(x, n, on);
  for (int i = 0; i < n; i++) {
    if (x->unique[i] != i) continue;
    paths++;
    steps += steps_of(x, i, n);
  }
  if (paths != x->row->record.unique_paths || fabs(steps - x->row->record.steps) > 1e-6) return;
  if (turning > x->row->metrics.turning + 1e-6) return;
  if (thr_cords_pulled_turning(x->f, x->cord, n) > x->row->pulled + 1e-6) return;
  thr_plan p = {
      .frame = *x->f, .options = *x->o, .cord = x->cord, .n_cords = n, .symmetry = x->record};
  p.symmetry.unique = x->unique;
  p.symmetry.element = x->element;
  const int instructions = thr_reading_of(&p).instructions;
  if (x->least < 0 || instructions < x->least) x->least = instructions;
}

/* Gives the images of a the images of b as partners (-2: ends); false if that contradicts what is
 * there. */
static bool pair_all(exhaustive *x, int a, int b)
{
  for (int g = 0; g < x->row->order; g++) {
    const int p = x->image[g][a], q = b < 0 ? -2 : x->image[g][b];
    if (p == q || (x->partner[p] != -1 && x->partner[p] != q)) return false;
    x->partner[p] = q;
    if (q < 0) continue;
    if (x->partner[q] != -1 && x->partner[q] != p) return false;
    x->partner[q] = p;
  }
  return true;
}

static void choose_partners(exhaustive *x)
{
  const int n = 2 * x->f->n_edges;
  int a = 0, before[MOST_HALVES];
  while (a < n && x->partner[a] != -1)
    a++;
  if (a == n) {
    weigh(x);
    return;
  }
  memcpy(before, x->partner, sizeof before);
  const bool end = x->o->ends == THR_ENDS_ANY;
  for (int b = end ? -2 : 0; b < n; b++) {
    if (b == -1 || b == a ||
        (b >= 0 && (x->partner[b] != -1 || thr_tail(x->f, b) != thr_tail(x->f, a))))
      continue;
    if (pair_all(x, a, b)) choose_partners(x);
    memcpy(x->partner, before, sizeof before);
  }
}

/* The images are all elements of the row's group, which its record's generators make. */
static void try_all(exhaustive *x, const thr_symmetries *t)
{
  const thr_group *all = &t->group[x->row->group].all;
  const int n = x->f->n_nodes;
  x->record = x->row->record;
  x->record.n_images = x->row->order;
  x->record.image = calloc((size_t)(x->row->order * n), sizeof(int));
  for (int g = 0; g < x->row->order; g++) {
    memcpy(x->record.image + g * n, all->image + x->row->elements.element[g] * n,
           (size_t)n * sizeof(int));
    for (int h = 0; h < 2 * x->f->n_edges; h++)
      x->image[g][h] = image_of(x->f, x->record.image + g * n, h);
  }
  for (int h = 0; h < 2 * x->f->n_edges; h++)
    x->partner[h] = -1;
  x->least = -1;
  choose_partners(x);
  free(x->record.image);
}

typedef struct {
  int rows, least, read, could; /* rows compared; with the fewest instructions; instructions in all,
                                   of theirs and the fewest */
} tally;

static void compare_rows(thr_frame f, thr_ends ends, tally *sum)
{
  const thr_limits none = {0};
  thr_request o = options_for(ends, 1);
  thr_symmetries t;
  o.aims = thr_aims_symmetric;
  ck_assert_int_le(2 * f.n_edges, MOST_HALVES);
  ck_assert_int_ne(thr_symmetries_find(&f, &o, false, &none, &t, NULL), THR_ENOMEM);
  for (int i = 0; i < t.n; i++) {
    exhaustive x = {.f = &f, .o = &o, .row = &t.row[i]};
    if (x.row->n_cords == 0 || x.row->metrics.overlap > 1e-9 || x.row->order > MOST_ORDER) continue;
    try_all(&x, &t);
    ck_assert_msg(x.least >= 0 && x.least <= x.row->instructions,
                  "%d of %d edges, order %d: %d instructions, of all %d", i, f.n_edges,
                  x.row->order, x.row->instructions, x.least);
    sum->rows++;
    sum->least += x.least == x.row->instructions;
    sum->read += x.row->instructions;
    sum->could += x.least;
  }
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}

/* None can have fewer than the fewest; 96 of 100 have as many (150 of 156, none pulled harder). */
START_TEST(few_threadings_of_the_same_aims_are_read_in_fewer_instructions)
{
  tally sum = {0};
  compare_rows(grid_make(3, 2), THR_ENDS_ANY, &sum);
  compare_rows(grid_make(4, 2), THR_ENDS_ANY, &sum);
  compare_rows(grid_make(3, 3), THR_ENDS_ANY, &sum);
  compare_rows(no_feet(shape_make(THR_MAKE_TUBE, 3, 2)), THR_ENDS_ANY, &sum);
  compare_rows(no_feet(shape_make(THR_MAKE_TUBE, 4, 2)), THR_ENDS_ANY, &sum);
  compare_rows(no_feet(solid_make(TETRAHEDRON)), THR_ENDS_ANY, &sum);
  compare_rows(no_feet(solid_make(CUBE)), THR_ENDS_ANY, &sum);
  compare_rows(no_feet(solid_make(OCTAHEDRON)), THR_ENDS_CLOSED, &sum);
  compare_rows(wheel_make(4), THR_ENDS_ANY, &sum);
  compare_rows(triangles_make(4), THR_ENDS_CLOSED, &sum);
  ck_assert_msg(sum.rows >= 150 && 100 * sum.least >= 96 * sum.rows,
                "%d of %d rows have the fewest instructions, %d of %d", sum.least, sum.rows,
                sum.read, sum.could);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("legible");
  ADD_TEST(s, 120, few_threadings_of_the_same_aims_are_read_in_fewer_instructions);
  return run_suite(s);
}
