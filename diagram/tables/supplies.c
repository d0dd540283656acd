#include "diagram/tables/supplies.h"

#include "diagram/scene/scene.h"
#include "graph/framework/bore.h"
#include "graph/framework/frame.h"
#include "graph/framework/units.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

thr_status thr_supplies_make(thr_supplies *s, const thr_plan *p, thr_err *err)
{
  int n, most = 0;
  *s = (thr_supplies){.plan = p};
  thr_status st = thr_scene_check_cords(p, &n, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;
  s->passes = thr_calloc((size_t)p->frame.n_edges, sizeof *s->passes);
  if (!s->passes) return thr_nomem(err);
  for (int c = 0; c < p->n_cords; c++)
    for (int k = 0; k < p->cord[c].n_passes; k++)
      s->passes[p->cord[c].half[k] >> 1]++;
  for (int e = 0; e < p->frame.n_edges; e++)
    if (s->passes[e] > most) most = s->passes[e];
  s->narrowest = thr_calloc((size_t)most + 1, sizeof *s->narrowest);
  return s->narrowest ? THR_OK : thr_nomem(err);
}

void thr_supplies_destroy(thr_supplies *s)
{
  free(s->passes);
  free(s->narrowest);
  *s = (thr_supplies){0};
}

thr_status thr_supplies_find_sizes(thr_supplies *s, thr_err *err)
{
  const thr_plan *p = s->plan;
  const thr_physics *asked = &p->options.physics;
  thr_physics sizes = p->evaluation.physics;
  double mm;
  if (thr_units_in_mm(p->frame.units, &mm, NULL)) return THR_OK;
  if (!p->evaluation.present) {
    thr_err why = {0};
    bool said = asked->cord_diameter > 0 || asked->bore > 0 || asked->bead_diameter > 0;
    thr_status st = thr_physics_resolve(asked, &p->frame, &sizes, &why);
    if (st) return st == THR_EINPUT && !said ? THR_OK : thr_fail(err, st, "%s", why.text);
  }
  s->mm = mm;
  s->cord = sizes.cord_diameter;
  s->bore = sizes.bore;
  return THR_OK;
}

double thr_supplies_bore(thr_supplies *s, int e)
{
  double *bore = &s->narrowest[s->passes[e]];
  if (*bore == 0 && s->passes[e]) *bore = thr_bore_for(s->passes[e]);
  return *bore;
}

double thr_supplies_node_bore(thr_supplies *s, int v)
{
  const thr_frame *f = &s->plan->frame;
  double bore = 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    bore = fmax(bore, thr_supplies_bore(s, f->half[i] >> 1));
  return bore;
}

double thr_supplies_bore_mm(const thr_supplies *s, double cords)
{
  return s->mm > 0 ? ceil(cords * s->cord * 100 - 1e-6) / 100 : 0;
}

/* Cord that turns take at most beside the way through the middles, mm. */
static double in_turns(thr_supplies *s, const thr_cord *c)
{
  double sum = 0;
  int turns = thr_cord_turns(&s->plan->options, c);
  for (int k = 0; k < turns; k++) {
    int in = c->half[k], out = c->half[(k + 1) % c->n_passes];
    double bore = fmax(s->bore, s->cord * fmax(thr_supplies_bore(s, in >> 1), thr_supplies_bore(s, out >> 1)));
    sum += (bore - s->cord) / 2 * thr_turn_angle(&s->plan->frame, in, out);
  }
  return sum;
}

thr_cut_length thr_supplies_cut(thr_supplies *s, int c)
{
  const thr_cord *cord = &s->plan->cord[c];
  thr_cut_length cut = {.length = thr_cord_length(&s->plan->frame, cord)};
  if (!(s->mm > 0)) return cut;
  double tails = 2 * THR_SUPPLIES_TAIL, knots = 2 * THR_SUPPLIES_KNOT * s->cord, turns = in_turns(s, cord);
  cut.tails = tails / s->mm;
  cut.knots = knots / s->mm;
  cut.turns = turns / s->mm;
  cut.cut = cut.length + (tails + knots + turns) / s->mm;
  return cut;
}

void thr_supplies_visits(const thr_plan *p, int *visits)
{
  for (int c = 0; c < p->n_cords; c++) {
    const thr_cord *cord = &p->cord[c];
    for (int k = 0; k < cord->n_passes; k++)
      visits[thr_tail(&p->frame, cord->half[k])]++;
    if (!cord->closed) visits[thr_cord_end(&p->frame, cord)]++;
  }
}

static int by_sort(const void *a, const void *b)
{
  const thr_bead *p = a, *q = b;
  if (p->kind != q->kind) return p->kind - q->kind;
  return p->passes != q->passes ? p->passes - q->passes : p->item - q->item;
}

void thr_beads_sort(thr_bead *b, int n)
{
  qsort(b, (size_t)n, sizeof *b, by_sort);
  for (int i = 0, next; i < n; i = next) {
    for (next = i; next < n && b[next].kind == b[i].kind; next++)
      b[next].sort = next == i ? 1 : b[next - 1].sort + (b[next].passes != b[next - 1].passes);
    for (int k = i; k < next && b[next - 1].sort == 1; k++)
      b[k].sort = 0;
  }
}

void thr_bead_name(int kind, int sort, char name[16])
{
  char letters[8], *first = letters + sizeof letters - 1;
  *first = '\0';
  for (int rest = sort; rest > 0; rest = (rest - 1) / 26)
    *--first = (char)('a' + (rest - 1) % 26);
  snprintf(name, 16, "%d%s", kind, first);
}
