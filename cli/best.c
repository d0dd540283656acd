#include "cli/best.h"
#include "cli/cli.h"
#include "cli/guard.h"
#include "graph/check/check.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_CORDS = 1000 };      /* that a plan may have in a component */
static const double OFTEN = 0.2; /* s between two plans that are kept */

static struct {
  const thr_frame *f;
  const thr_plan_options *o;
  double value, at; /* of the last one: what is minimized, thr_clock() */
} best;

void best_begin(const thr_frame *f, const thr_plan_options *o)
{
  best.f = f;
  best.o = o;
  best.value = INFINITY;
  best.at = -INFINITY;
}

/* What is minimized first. */
static double value_of(const thr_plan *p)
{
  double longest = 0;
  for (int i = 0; i < p->n_cords; i++)
    longest = fmax(longest, thr_cord_length(&p->frame, &p->cord[i]));
  if (thr_wants_symmetry(&p->options)) return p->symmetry.steps;
  if (thr_wants_balance(&p->options)) return longest;
  if (thr_wants_turning(&p->options)) return thr_wants_largest(&p->options) ? p->metrics.max_turning : p->metrics.turning;
  return p->metrics.length;
}

/* Cords in the component that has most, and in the one that has fewest; false without memory. */
static bool count_cords(const thr_plan *p, int *fewest, int *most)
{
  int *count = thr_calloc((size_t)p->frame.n_nodes, sizeof *count);
  *most = 0;
  for (int i = 0; count && i < p->n_cords; i++)
    count[p->cord[i].component]++;
  *fewest = count ? count[0] : 0;
  for (int k = 0; count && k < p->frame.n_nodes; k++) {
    if (count[k] > *most) *most = count[k];
    if (count[k] > 0 && count[k] < *fewest) *fewest = count[k]; /* components are numbered without gaps, and all have cords */
  }
  free(count);
  return count != NULL;
}

/* As many cords as asked for, none too long? Of a symmetric plan they are as many as they are. */
static bool fits(thr_plan *p)
{
  int fewest, most;
  if (!count_cords(p, &fewest, &most) || most > MOST_CORDS) return false;
  if (thr_wants_symmetry(&p->options)) p->options.cords = most;
  bool few_enough = most <= p->options.cords, enough = fewest >= p->options.cords_least;
  for (int i = 0; p->options.max_length > 0 && i < p->n_cords; i++)
    few_enough = few_enough && thr_cord_length(&p->frame, &p->cord[i]) <= p->options.max_length * (1 + 1e-12);
  return few_enough && (enough || thr_wants_symmetry(&p->options) || p->options.ends == THR_ENDS_COUNTS);
}

/* Every cord a copy of itself, by the identity. */
static thr_status identity_record(const thr_plan *p, thr_symmetry_record *r)
{
  *r = (thr_symmetry_record){.present = true, .order = 1, .n_images = 1, .unique_paths = p->n_cords};
  r->image = thr_calloc((size_t)p->frame.n_nodes, sizeof *r->image);
  r->unique = thr_calloc((size_t)p->n_cords, sizeof *r->unique);
  r->element = thr_calloc((size_t)p->n_cords, sizeof *r->element);
  if (!r->image || !r->unique || !r->element) return THR_ENOMEM;
  for (int v = 0; v < p->frame.n_nodes; v++)
    r->image[v] = v;
  for (int i = 0; i < p->n_cords; i++) {
    r->unique[i] = i;
    r->steps += p->cord[i].n_passes;
  }
  return THR_OK;
}

static bool is_wanted(thr_plan *p)
{
  if (!fits(p) || thr_plan_measure(&p->frame, &p->options, p->cord, p->n_cords, &p->metrics, NULL)) return false;
  return value_of(p) < best.value * (1 - 1e-9) && thr_check_plan(p, NULL) == THR_OK;
}

/* p: of borrowed parts. */
static void keep_better(thr_plan *p, double now)
{
  thr_text t = {0};
  if (!is_wanted(p)) return;
  thr_plan_write(p, &t);
  guard_keep(&t);
  thr_text_destroy(&t);
  best.value = value_of(p);
  best.at = now;
}

void best_found(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry)
{
  (void)user;
  double now = thr_clock();
  thr_symmetry_record own = {0};
  if (!best.f || n_cords == 0 || now - best.at < OFTEN) return;
  thr_plan p = {.frame = *best.f, .options = *best.o, .n_cords = n_cords};
  p.cord = thr_calloc((size_t)n_cords, sizeof *p.cord);
  for (int i = 0; p.cord && i < n_cords; i++) {
    p.cord[i] = cord[i];
    thr_cord_id(i, p.cord[i].id);
  }
  bool copies = thr_wants_symmetry(best.o), sound = p.cord != NULL;
  if (sound && copies && !symmetry) sound = !*best.o->symmetry.group && identity_record(&p, &own) == THR_OK;
  if (copies) p.symmetry = symmetry ? *symmetry : own;
  if (sound) keep_better(&p, now);
  thr_symmetry_record_destroy(&own);
  free(p.cord);
}
