/* Plans: names, ends, turning angles, metrics. */
#include "graph/plan/plan.h"
#include "graph/angle.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_certificate_destroy(thr_certificate *c)
{
  for (int i = 0; i < c->n_cuts; i++)
    free(c->cut[i].node);
  free(c->cut);
  free(c->place_price);
  *c = (thr_certificate){0};
}

void thr_symmetry_record_destroy(thr_symmetry_record *r)
{
  free(r->generator);
  free(r->image);
  free(r->unique);
  free(r->element);
  *r = (thr_symmetry_record){0};
}

void thr_cords_destroy(thr_cord *cord, int n)
{
  for (int i = 0; cord && i < n; i++)
    free(cord[i].half);
  free(cord);
}

void thr_plan_destroy(thr_plan *p)
{
  thr_cords_destroy(p->cord, p->n_cords);
  for (int i = 0; i < p->proof.n_certificates; i++)
    thr_certificate_destroy(&p->proof.certificate[i]);
  free(p->proof.certificate);
  thr_turning_proof_destroy(&p->proof.tied);
  thr_turning_proof_destroy(&p->turning.tree);
  thr_symmetry_record_destroy(&p->symmetry);
  thr_evaluation_destroy(&p->evaluation);
  free(p->options.end_node);
  free(p->options.end_count);
  free(p->generator);
  thr_frame_destroy(&p->frame);
  *p = (thr_plan){0};
}

thr_status thr_plan_request(thr_plan *p, const thr_frame *f, const thr_plan_options *o, thr_err *err)
{
  thr_status st = thr_frame_copy(&p->frame, f, err);
  if (st) return st;
  size_t n = (size_t)f->n_nodes;
  p->options = *o;
  p->options.end_node = NULL;
  p->options.end_count = NULL;
  if (o->end_node) {
    if (!(p->options.end_node = thr_calloc(n, sizeof *p->options.end_node))) return thr_nomem(err);
    memcpy(p->options.end_node, o->end_node, n * sizeof *p->options.end_node);
  }
  if (o->end_count) {
    if (!(p->options.end_count = thr_calloc(n, sizeof *p->options.end_count))) return thr_nomem(err);
    memcpy(p->options.end_count, o->end_count, n * sizeof *p->options.end_count);
  }
  return THR_OK;
}

void thr_cord_id(int i, char id[12])
{
  char reversed[12];
  int n = 0;
  for (i++; i > 0; i = (i - 1) / 26)
    reversed[n++] = (char)('A' + (i - 1) % 26);
  for (int k = 0; k < n; k++)
    id[k] = reversed[n - 1 - k];
  id[n] = '\0';
}

int thr_length_proof_cuts(const thr_length_proof *proof)
{
  int cuts = 0;
  for (int i = 0; i < proof->n_certificates; i++)
    cuts += proof->certificate[i].n_cuts;
  for (int i = 0; i < proof->tied.n_duals; i++)
    cuts += proof->tied.dual[i].n_odd + proof->tied.dual[i].n_junctions;
  return cuts;
}

/* Euclid's algorithm on lengths with rounding. */
static double common_step(double a, double b, double rounding)
{
  while (b > rounding) {
    double rest = fmod(a, b);
    a = b;
    b = rest > b - rounding ? 0 : rest;
  }
  return a;
}

double thr_plan_unit(const thr_frame *f)
{
  enum { STEPS_MOST = 1000 };
  double longest = 0, unit = 0;
  for (int e = 0; e < f->n_edges; e++)
    longest = fmax(longest, f->length[e]);
  for (int e = 0; e < f->n_edges; e++) {
    unit = common_step(fmax(unit, f->length[e]), fmin(unit, f->length[e]), 1e-12 * longest);
    if (unit * STEPS_MOST < longest) return 0;
  }
  if (unit > 0) unit = longest / round(longest / unit);
  for (int e = 0; e < f->n_edges; e++)
    if (fabs(f->length[e] - unit * round(f->length[e] / unit)) > 1e-10 * f->length[e]) return 0;
  return unit;
}

int thr_cord_start(const thr_frame *f, const thr_cord *c)
{
  return thr_tail(f, c->half[0]);
}

int thr_cord_end(const thr_frame *f, const thr_cord *c)
{
  return thr_head(f, c->half[c->n_passes - 1]);
}

double thr_cord_length(const thr_frame *f, const thr_cord *c)
{
  double sum = 0;
  for (int i = 0; i < c->n_passes; i++)
    sum += f->length[c->half[i] >> 1];
  return sum;
}

double thr_turn_angle(const thr_frame *f, int in, int out)
{
  double a[3], b[3];
  thr_direction(f, in, a);
  thr_direction(f, out, b);
  return thr_angle_between(a, b);
}

double thr_cord_turning(const thr_frame *f, const thr_cord *c, bool with_closure)
{
  double sum = 0;
  for (int i = 0; i + 1 < c->n_passes; i++)
    sum += thr_turn_angle(f, c->half[i], c->half[i + 1]);
  if (with_closure && c->closed) sum += thr_turn_angle(f, c->half[c->n_passes - 1], c->half[0]);
  return sum;
}

int thr_cord_turns(const thr_plan_options *o, const thr_cord *c)
{
  return o->ends == THR_ENDS_CLOSED ? c->n_passes : c->n_passes - 1;
}

bool thr_turn_over(double turn, double angle)
{
  return turn > angle + 1e-9;
}

int thr_plan_turns_over(const thr_plan *p, double angle)
{
  int n = 0;
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    for (int k = 0; k < thr_cord_turns(&p->options, c); k++)
      n += thr_turn_over(thr_turn_angle(&p->frame, c->half[k], c->half[(k + 1) % c->n_passes]), angle);
  }
  return n;
}

double thr_cord_price(const thr_frame *f, const thr_plan_options *o, const thr_cord *c)
{
  double sum = 0;
  for (int k = 0; k < thr_cord_turns(o, c); k++)
    sum += thr_turn_price(f, o->turning.cost, c->half[k], c->half[(k + 1) % c->n_passes]);
  return sum;
}

static void measure_cord(const thr_frame *f, const thr_plan_options *o, const thr_cord *c, int *passes, thr_metrics *m)
{
  double turning = thr_cord_turning(f, c, o->ends == THR_ENDS_CLOSED);
  m->length += thr_cord_length(f, c);
  m->passes += c->n_passes;
  m->turning += turning;
  if (turning > m->max_turning) m->max_turning = turning;
  for (int i = 0; i < c->n_passes; i++)
    if (++passes[c->half[i] >> 1] > m->most_passes) m->most_passes = passes[c->half[i] >> 1];
  for (int i = 0; i < thr_cord_turns(o, c); i++) {
    int next = c->half[(i + 1) % c->n_passes];
    double angle = thr_turn_angle(f, c->half[i], next);
    if (angle > m->worst_turn) m->worst_turn = angle;
    if (next == (c->half[i] ^ 1)) m->u_turns++;
  }
}

thr_status thr_plan_measure(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_metrics *m,
                            thr_err *err)
{
  *m = (thr_metrics){0};
  int *passes = thr_calloc((size_t)f->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  for (int i = 0; i < n_cords; i++)
    measure_cord(f, o, &cord[i], passes, m);
  for (int e = 0; e < f->n_edges; e++) {
    int cover = thr_plan_cover(f, o, e);
    m->base_length += cover * f->length[e];
    m->overlap += (passes[e] - cover) * f->length[e]; /* not a difference of two sums: exactly 0 without overlap */
  }
  free(passes);
  return THR_OK;
}
