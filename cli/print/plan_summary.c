/* The summary of `thread plan`, as text and as JSON. */
#include "cli/print/plan_summary.h"
#include "cli/print/symmetry_table.h"
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/angle.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool turns_least(const thr_plan *p)
{
  return thr_wants_turning(&p->options);
}

/* ---- cords ---- */

/* Of the turns that the plan counts; for other objectives than the least turning of those inside the cord. */
typedef struct {
  double turning, sharpest; /* rad */
  int u_turns;
} cord_turns;

static cord_turns turns_of(const thr_plan *p, const thr_cord *c)
{
  cord_turns x = {0};
  int n = turns_least(p) ? thr_cord_turns(&p->options, c) : c->n_passes - 1;
  for (int k = 0; k < n; k++) {
    int out = c->half[(k + 1) % c->n_passes];
    double angle = thr_turn_angle(&p->frame, c->half[k], out);
    x.turning += angle;
    x.sharpest = fmax(x.sharpest, angle);
    x.u_turns += out == (c->half[k] ^ 1);
  }
  return x;
}

static void put_cord(thr_text *t, const thr_plan *p, const thr_cord *c, double pull)
{
  const cord_turns x = turns_of(p, c);
  const char *from = p->frame.name[thr_cord_start(&p->frame, c)], *to = p->frame.name[thr_cord_end(&p->frame, c)];
  char factor[24];
  thr_text_printf(t, "%-5s %7d %14.3f %6.0f deg ", c->id, c->n_passes, thr_cord_length(&p->frame, c), thr_degrees(x.turning));
  if (turns_least(p)) thr_text_printf(t, "%6.0f deg ", thr_degrees(x.sharpest));
  thr_text_printf(t, "%8d ", x.u_turns);
  if (turns_least(p)) thr_text_printf(t, "%12s ", turning_factor(turning_capstan(p->options.physics.mu, x.turning), factor));
  thr_text_printf(t, "%12s", turning_factor(pull, factor));
  thr_text_printf(t, c->closed ? "  both at %s\n" : "  %s and %s\n", from, to);
}

static void put_cords(thr_text *t, const thr_plan *p, const double *pull)
{
  enum { MOST = 12 };
  thr_text_printf(t, "%-5s %7s %14s %10s ", "cord", "passes", "length", "turning");
  if (turns_least(p)) thr_text_printf(t, "%10s ", "sharpest");
  thr_text_printf(t, "%8s ", "U-turns");
  if (turns_least(p)) thr_text_printf(t, "%12s ", "capstan");
  thr_text_printf(t, "%12s  %s\n", "pull", "ends");
  for (int i = 0; i < p->n_cords && i < MOST; i++)
    put_cord(t, p, &p->cord[i], pull[i]);
  if (p->n_cords > MOST) thr_text_printf(t, "..    and %d more\n", p->n_cords - MOST);
}

/* ---- text ---- */

static int pieces_of(const thr_plan *p)
{
  int last = 0;
  for (int i = 0; i < p->n_cords; i++)
    if (p->cord[i].component > last) last = p->cord[i].component;
  return last + 1;
}

/* How many cords were asked for. */
static void put_number(thr_text *t, const thr_plan *p, int components)
{
  enum { NO_LIMIT = 1000 };
  const thr_plan_options *o = &p->options;
  const char *each = components > 1 ? " in each component" : "";
  if (thr_wants_symmetry(o) || o->ends == THR_ENDS_COUNTS)
    thr_text_printf(t, "; %d %s", p->n_cords, cli_plural(p->n_cords, "cord", "cords"));
  else if (o->cords_least < o->cords && o->cords < NO_LIMIT)
    thr_text_printf(t, "; %d to %d cords%s", o->cords_least, o->cords, each);
  else if (o->cords_least < o->cords && o->cords_least > 1)
    thr_text_printf(t, "; %d cords and more%s", o->cords_least, each);
  else if (o->cords_least == o->cords && o->cords > 1)
    thr_text_printf(t, "; %d cords%s", o->cords, each);
  if (thr_wants_balance(o)) thr_text_append(t, "; of even length");
  if (o->max_length > 0) thr_text_printf(t, "; none longer than %g %s", o->max_length, p->frame.units);
}

static void put_head(thr_text *t, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  int components = pieces_of(p);
  thr_text_printf(t, "%d nodes, %d %s, %d %s; %d %s per edge", p->frame.n_nodes, p->frame.n_edges,
                  cli_plural(p->frame.n_edges, "edge", "edges"), components, cli_plural(components, "component", "components"),
                  o->cover, cli_plural(o->cover, "pass", "passes"));
  if (p->frame.cover) thr_text_append(t, " or as the framework says");
  if (o->capacity) thr_text_printf(t, ", at most %d", o->capacity);
  thr_text_printf(t, "; ends: %s", thr_ends_name(o->ends));
  if (o->joint == THR_JOINT_TUBE) thr_text_append(t, "; joints: tube");
  put_number(t, p, components);
  thr_text_append(t, "\n\n");
}

/* How long the longest cord is, and whether fewer would do. */
static void put_claim(thr_text *t, const thr_plan *p, thr_cords_word word)
{
  const thr_cords_claim *c = &p->cords_claim;
  const char *units = p->frame.units;
  if (!c->present) return;
  thr_text_printf(t, "longest  %.6f %s", c->longest, units);
  if (c->longest_optimal)
    thr_text_append(t, "; optimal: with these options the longest cord is no shorter (verified)");
  else if (thr_wants_balance(&p->options))
    thr_text_printf(t, "; at least %.6f %s is needed (verified), gap %.3g %%%s", c->longest_bound, units,
                    100 * (c->longest - c->longest_bound) / c->longest,
                    word.longest_least ? ";\n         optimal by the solver's word (not verified): none shorter exists" : "");
  thr_text_append(t, "\n");
  if (c->fewest == 0) return;
  thr_text_printf(t, "cords    %d; ", p->n_cords);
  if (c->fewest_optimal)
    thr_text_append(t, "optimal: no fewer will do (verified)\n");
  else
    thr_text_printf(t, "at least %d are needed (verified)\n", c->fewest);
}

/* What the checker has verified, and whether GLPK's exact simplex finds the same minimum on these cuts. */
static void put_certificate(thr_text *t, const thr_plan *p)
{
  const thr_length_proof *proof = &p->proof;
  int cuts = thr_length_proof_cuts(proof);
  bool agreed = proof->confirmed > 0 && proof->unconfirmed == 0;
  bool missed = proof->unconfirmed > 0 && p->options.confirm == THR_CONFIRM_ALWAYS;
  thr_text_printf(t, "(certificate: %d %s, verified%s)", cuts, cli_cuts_word(p, cuts),
                  agreed   ? "; GLPK agrees"
                  : missed ? "; not confirmed by GLPK"
                           : "");
}

static void put_length_status(thr_text *t, const thr_plan *p, thr_cords_word word)
{
  const thr_length_proof *proof = &p->proof;
  if (proof->optimal) {
    thr_text_append(t, "optimal: no threading with these options uses less cord ");
    put_certificate(t, p);
    thr_text_append(t, "\n");
  } else if (!thr_wants_length(&p->options) || p->options.max_length > 0 ||
             thr_wants_balance(&p->options)) { /* which asks for more */
    thr_text_printf(t, "at least %.6f %s is needed ", proof->lower_bound, p->frame.units);
    put_certificate(t, p);
    thr_text_printf(t, "; this is %.2f %% more\n", 100 * (p->metrics.length / proof->lower_bound - 1));
  } else {
    thr_text_printf(t, "not proved optimal: at least %.6f %s is needed, gap %.3g %%\n", proof->lower_bound, p->frame.units,
                    100 * proof->gap);
  }
  if (!proof->optimal && word.passes_least && p->options.max_length == 0 && !thr_wants_balance(&p->options))
    thr_text_append(t,
                    "         optimal by the solver's word (not verified): all other passes were ruled out for so many cords\n");
}

static void put_text(thr_text *t, const thr_plan *p, const double *pull, const thr_rivals *r, thr_cords_word word)
{
  const thr_metrics *m = &p->metrics;
  double mu = p->options.physics.mu;
  put_head(t, p);
  put_cords(t, p, pull);
  if (p->symmetry.present) symmetry_put_paths(t, p);
  thr_text_printf(t, "\nlength   %.6f %s = %.6f for ", m->length, p->frame.units, m->base_length);
  if (p->frame.cover)
    thr_text_append(t, "the passes that every edge needs");
  else
    thr_text_printf(t, "%d %s over every edge", p->options.cover, cli_plural(p->options.cover, "pass", "passes"));
  thr_text_printf(t, " + %.6f overlap (%.1f %%)\n", m->overlap, 100 * m->overlap / m->base_length);
  thr_text_append(t, "         ");
  put_length_status(t, p, word);
  put_claim(t, p, word);
  if (r) turning_put_status(t, p, r);
  if (r) thr_text_printf(t, "capstan  exp(mu x turning): the factor from one end of a cord to the other (mu = %g)\n", mu);
  thr_text_printf(t, "pull     with both ends pulled, times the tension that must reach the slackest point (mu = %g)\n", mu);
  if (r) turning_put_table(t, p, r);
  if (r) turning_put_frontier(t, p, r);
}

static double *pulls_of(thr_text *t, const thr_plan *p, double *largest)
{
  double *pull = thr_calloc((size_t)p->n_cords, sizeof *pull);
  if (!pull) t->failed = true; /* which whoever writes the text reports */
  if (pull) *largest = turning_pull(p, pull);
  return pull;
}

void plan_put_summary(thr_text *t, const thr_plan *p, const thr_rivals *r, thr_cords_word word)
{
  double largest, *pull = pulls_of(t, p, &largest);
  if (pull) put_text(t, p, pull, r, word);
  free(pull);
}

/* ---- JSON ---- */

static void put_claim_json(thr_writer *w, const thr_plan *p, thr_cords_word word)
{
  const thr_cords_claim *c = &p->cords_claim;
  thr_write_number(w, "longest", c->longest);
  thr_write_number(w, "longest_bound", c->longest_bound);
  thr_write_string(w, "longest_status",
                   c->longest_optimal   ? "optimal"
                   : word.longest_least ? "bound, optimal by the solver's word"
                                        : "bound");
  if (!c->fewest) return;
  thr_write_int(w, "fewest_cords", c->fewest);
  thr_write_string(w, "fewest_status", c->fewest_optimal ? "optimal" : "bound");
}

void plan_put_json(thr_writer *w, const thr_plan *p, const thr_rivals *r, thr_cords_word word)
{
  const thr_metrics *m = &p->metrics;
  thr_write_hash(w, "framework", thr_frame_hash(&p->frame));
  thr_write_int(w, "nodes", p->frame.n_nodes);
  thr_write_int(w, "edges", p->frame.n_edges);
  thr_write_int(w, "cords", p->n_cords);
  thr_write_string(w, "units", p->frame.units);
  thr_write_number(w, "length", m->length);
  thr_write_number(w, "base_length", m->base_length);
  thr_write_number(w, "overlap", m->overlap);
  thr_write_number(w, "lower_bound", p->proof.lower_bound);
  thr_write_number(w, "gap", p->proof.gap);
  thr_write_number(w, "turning", m->turning);
  thr_write_number(w, "max_turning", m->max_turning);
  thr_write_number(w, "mu", p->options.physics.mu);
  thr_write_string(w, "status", p->proof.optimal ? "optimal" : "bound");
  thr_write_number(w, "pull_factor", turning_pull(p, NULL));
  if (p->cords_claim.present) put_claim_json(w, p, word);
  if (r) turning_put_json(w, p, r);
  if (p->symmetry.present) symmetry_put_json(w, p);
}
