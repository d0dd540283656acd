/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what has to be at hand before threading: cord to cut for each path, bores of the beads.
 *
 * cut = length + (1 + joins) (2 tails + 2 knots) + turns, where length is the way through the
 * middles of the beads, and joins says how often a new length is joined on. In a turn by an angle a
 * (rad) a cord that lies at the outer wall of its bores is longer by (bore - cord) / 2 * a: a
 * parallel curve at distance r is longer by r times the angle turned.
 *
 * Example: a cord of 1 mm in bores of 2 mm that turns by 90 degrees 80 times takes 0.5 * 1.571 * 80
 * = 63 mm more. */
#include "diagram/tables/tables.h"

#include "graph/arrays.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

thr_status thr_supplies_make(thr_supplies *supplies, const thr_plan *plan, thr_err *err)
{
  int n;
  *supplies = (thr_supplies){.plan = plan};

  /* Cords must fit the framework, and there must be one. */
  thr_status st = thr_scene_check_cords(plan, &n, err);
  if (!st && !plan->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;

  supplies->passes = thr_calloc((size_t)plan->frame.n_edges, sizeof *supplies->passes);
  if (!supplies->passes) return thr_nomem(err);

  /* An edge is passed as often as cords run through it, in both directions together. */
  for (int c = 0; c < plan->n_cords; c++)
    for (int k = 0; k < plan->cord[c].n_passes; k++)
      supplies->passes[plan->cord[c].half[k] >> 1]++;
  return THR_OK;
}

void thr_supplies_destroy(thr_supplies *supplies)
{
  free(supplies->passes);
  free(supplies->joined);
  free(supplies->joins);
  *supplies = (thr_supplies){0};
}

thr_status thr_supplies_find_sizes(thr_supplies *supplies, thr_err *err)
{
  const thr_plan *plan = supplies->plan;
  const thr_physics *asked = &plan->options.physics;
  thr_physics sizes = plan->evaluation.physics;
  double mm;

  /* Units without a length in mm leave all sizes open. */
  if (thr_units_in_mm(plan->frame.units, &mm, NULL)) return THR_OK;

  /* Not evaluated: sizes as asked for, or worked out from the framework. Where nothing was asked, a
   * framework without a sensible size is no mistake of the user. */
  if (!plan->evaluation.present) {
    thr_err why = {0};
    bool said = asked->cord_diameter > 0 || asked->bore > 0 || asked->bead_diameter > 0;
    thr_status st = thr_physics_resolve(asked, &plan->frame, &sizes, &why);
    if (st) return st == THR_EINPUT && !said ? THR_OK : thr_fail(err, st, "%s", why.text);
  }

  supplies->mm = mm;
  supplies->cord = sizes.cord_diameter;
  supplies->bore = sizes.bore;
  supplies->width = sizes.bead_diameter;
  return THR_OK;
}

bool thr_supplies_doubt(const thr_supplies *supplies, char line[160])
{
  const double thinnest = 0.4; /* mm: of pieces of 3.4 mm */
  const thr_physics *asked = &supplies->plan->options.physics;

  /* Sizes that the user gave are taken as they are. */
  bool said = asked->cord_diameter > 0 || asked->bore > 0 || asked->bead_diameter > 0;
  if (said || !(supplies->mm > 0) || supplies->cord >= thinnest) return false;

  snprintf(line, 160,
           "A cord of %.3g mm through bores of %.4g mm: is that the size to be built? Else plan it "
           "anew in its true units.",
           supplies->cord, supplies->bore);
  return true;
}

double thr_supplies_bore(const thr_supplies *supplies, int e)
{
  double planned = supplies->mm > 0 ? supplies->bore / supplies->cord : THR_BORE_CORDS;
  return supplies->passes[e] ? fmax(planned, thr_bore_clear(supplies->passes[e])) : 0;
}

double thr_supplies_node_bore(const thr_supplies *supplies, int v)
{
  const thr_frame *frame = &supplies->plan->frame;
  double bore = 0;

  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    bore = fmax(bore, thr_supplies_bore(supplies, frame->half[i] >> 1));
  return bore;
}

double thr_supplies_bore_mm(const thr_supplies *supplies, double cords)
{
  return supplies->mm > 0 ? ceil(cords * supplies->cord * 100 - 1e-6) / 100 : 0;
}

double thr_supplies_extreme_bore(const thr_supplies *supplies, bool narrowest)
{
  double found = 0;

  /* An edge without a pass has no bore. */
  for (int e = 0; e < supplies->plan->frame.n_edges; e++) {
    double bore = thr_supplies_bore(supplies, e);
    if (bore > 0 && (found == 0 || (narrowest ? bore < found : bore > found))) found = bore;
  }

  return thr_supplies_bore_mm(supplies, found);
}

/* Returns how much cord the turns of a cord take at most, in mm (see the head of this file). */
static double in_turns(const thr_supplies *supplies, const thr_cord *cord)
{
  double sum = 0;

  int turns = thr_cord_turns(&supplies->plan->options, cord);
  for (int k = 0; k < turns; k++) {
    /* A turn lies between two edges: the wider bore bounds both. */
    int in = cord->half[k], out = cord->half[(k + 1) % cord->n_passes];

    double bore = supplies->cord *
                  fmax(thr_supplies_bore(supplies, in >> 1), thr_supplies_bore(supplies, out >> 1));
    sum += (bore - supplies->cord) / 2 * thr_turn_angle(&supplies->plan->frame, in, out);
  }
  return sum;
}

double thr_supplies_tail(const thr_supplies *supplies)
{
  return THR_SUPPLIES_TAIL + (supplies->mm > 0 ? THR_SUPPLIES_KNOT * supplies->cord : 0);
}

thr_cut_length thr_supplies_cut(const thr_supplies *supplies, int c)
{
  const thr_cord *cord = &supplies->plan->cord[c];
  thr_cut_length cut = {.length = thr_cord_length(&supplies->plan->frame, cord)};

  /* Allowances are multiples of sizes in mm. */
  if (!(supplies->mm > 0)) return cut;

  /* Both ends have a tail and a knot, those of a closed cord too. All in mm, then in units. */
  double tails = 2 * THR_SUPPLIES_TAIL, knots = 2 * THR_SUPPLIES_KNOT * supplies->cord,
         turns = in_turns(supplies, cord);

  cut.tails = tails / supplies->mm;
  cut.knots = knots / supplies->mm;
  cut.turns = turns / supplies->mm;
  if (supplies->joins) cut.joins = supplies->joins[c] * (cut.tails + cut.knots);
  cut.cut = cut.length + (tails + knots + turns) / supplies->mm + cut.joins;

  return cut;
}

/* ---- lengths that are joined ---- */

/* Computes the cord that is worked with at a time unless asked for, mm. */
static thr_status find_working(thr_supplies *supplies, thr_err *err)
{
  const thr_frame *frame = &supplies->plan->frame;
  double *length = thr_calloc((size_t)frame->n_edges, sizeof *length);
  if (!length) return thr_nomem(err);

  for (int e = 0; e < frame->n_edges; e++)
    length[e] = frame->length[e];
  thr_sort_doubles(length, (size_t)frame->n_edges);
  supplies->working = fmax(THR_SUPPLIES_WORKING,
                           THR_SUPPLIES_WORKING_EDGES * supplies->mm * length[frame->n_edges / 2]);

  free(length);
  return THR_OK;
}

/* Finds the joins of a part, whose n visits are those from `first` on. */
static void join_part(thr_supplies *supplies, const thr_visit *visit, int first, int n)
{
  const thr_frame *frame = &supplies->plan->frame;
  double from = 0, used = 0, used_at_foot = 0;
  int foot = -1;

  for (int i = first; i < first + n; i++) {
    const int place = visit[i].number ? thr_head(frame, visit[i].in) : visit[i].piece;
    if (visit[i].number) used += frame->length[visit[i].in >> 1];

    /* The last foot behind the last join at which a length could end. */
    if (used > from && frame->foot[place]) foot = i, used_at_foot = used;

    /* The length still reaches the end of the next pass. */
    if (i + 1 == first + n ||
        used + frame->length[visit[i + 1].in >> 1] - from <= supplies->working / supplies->mm)
      continue;

    /* No foot within reach: nothing can be joined before the next one. */
    if (foot < 0) {
      supplies->late = true;
      continue;
    }

    /* The new length begins at that foot. */
    from = used_at_foot;
    supplies->joined[foot] = true;
    supplies->joins[visit[foot].cord]++;
    foot = -1;
  }
}

thr_status thr_supplies_join(thr_supplies *supplies, bool solid, const thr_part *part, int n_parts,
                             const thr_visit *visit, int n_visits, double working_mm, thr_err *err)
{
  thr_status st = THR_OK;
  supplies->joined = thr_calloc((size_t)n_visits, sizeof *supplies->joined);
  supplies->joins = thr_calloc((size_t)supplies->plan->n_cords, sizeof *supplies->joins);
  if (!supplies->joined || !supplies->joins) return thr_nomem(err);

  /* Without a size in mm no length of cord can be compared with an arm's reach. */
  if (!(supplies->mm > 0)) return THR_OK;
  supplies->working = working_mm;
  if (!(working_mm > 0)) st = find_working(supplies, err);

  /* With solid joints a part that begins a cord has one visit more than passes. */
  for (int k = 0, first = 0; k < n_parts && !st; k++) {
    const int n = part[k].end - part[k].first + (part[k].begins && solid);
    join_part(supplies, visit, first, n);
    first += n;
  }
  return st;
}

void thr_supplies_visits(const thr_plan *plan, int *visits)
{
  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cord *cord = &plan->cord[c];

    /* Each pass leaves its tail; the last head counts unless the cord closes there. */
    for (int k = 0; k < cord->n_passes; k++)
      visits[thr_tail(&plan->frame, cord->half[k])]++;
    if (!cord->closed) visits[thr_cord_end(&plan->frame, cord)]++;
  }
}
