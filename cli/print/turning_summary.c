/* The table "each against", what is proved of the turning, and the frontier. */
#include "cli/print/turning_summary.h"
#include "eval/eval.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "planner/turning.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>

/* ---- figures ---- */

enum { LENGTH, ABOVE, TURNING, PRICE, LARGEST, CAPSTAN, SHARPEST, OVER_60, OVER_90, U_TURNS, PULL, N_FIGURES };

/* Of one plan, or of the bound. rad, units, parts; NAN = not known or without meaning. */
typedef struct {
  double value[N_FIGURES];
} figures;

typedef enum { FORMAT_LENGTH, FORMAT_PERCENT, FORMAT_ANGLE, FORMAT_PRICE, FORMAT_FACTOR, FORMAT_COUNT } format;

/* Those that any plan's JSON has are not written again. */
static const struct {
  const char *label, *key;
  format format;
  bool known;
} figure[N_FIGURES] = {
    [LENGTH] = {"length", "length", FORMAT_LENGTH, true},
    [ABOVE] = {"above the shortest, %", "above_shortest", FORMAT_PERCENT, false},
    [TURNING] = {"turning of all cords, deg", "turning", FORMAT_ANGLE, true},
    [PRICE] = {"price of all turns", "price", FORMAT_PRICE, false},
    [LARGEST] = {"largest cord, deg", "max_turning", FORMAT_ANGLE, true},
    [CAPSTAN] = {"its capstan factor", "max_capstan", FORMAT_FACTOR, false},
    [SHARPEST] = {"sharpest turn, deg", "worst_turn", FORMAT_ANGLE, false},
    [OVER_60] = {"turns over 60 deg", "turns_over_60", FORMAT_COUNT, false},
    [OVER_90] = {"turns over 90 deg", "turns_over_90", FORMAT_COUNT, false},
    [U_TURNS] = {"U-turns", "u_turns", FORMAT_COUNT, false},
    [PULL] = {"largest pull", "pull_factor", FORMAT_FACTOR, true},
};

double turning_capstan(double mu, double turning)
{
  double factor = exp(mu * turning);
  return factor > 1e300 ? INFINITY : factor;
}

double turning_pull(const thr_plan *p, double *cord)
{
  thr_eval e;
  const thr_limits none = {0};
  thr_eval_options o = thr_eval_options_default();
  o.physics = p->options.physics;
  o.physics.seating = 1;
  bool known = thr_eval_plan(&p->frame, p->cord, p->n_cords, THR_CAPSTAN, &o, &none, &e, NULL) == THR_OK;
  double largest = known ? e.record.largest : NAN;
  for (int i = 0; i < p->n_cords; i++) {
    /* pulled at both ends, each has half of the turning to overcome */
    double half = p->options.physics.mu * thr_cord_turning(&p->frame, &p->cord[i], false) / 2;
    double pull = known ? e.record.cord[i].force : half > 690 ? INFINITY : NAN;
    if (cord) cord[i] = pull;
    if (isinf(pull)) largest = pull;
  }
  thr_eval_destroy(&e);
  return largest;
}

const char *turning_factor(double value, char out[24])
{
  if (isnan(value))
    snprintf(out, 24, "-");
  else if (value > 1e300)
    snprintf(out, 24, "> 1e300 x");
  else
    snprintf(out, 24, value < 1e6 ? "%.1f x" : "%.1e x", value);
  return out;
}

/* Of all turns of q, priced as p's options say. */
static double price_of(const thr_plan *p, const thr_plan *q)
{
  double price = 0;
  for (int i = 0; i < q->n_cords; i++)
    price += thr_cord_price(&q->frame, &p->options, &q->cord[i]);
  return price;
}

/* Of q, as p's options price turns and its proof knows the shortest length. */
static figures figures_of(const thr_plan *p, const thr_plan *q)
{
  const thr_metrics *m = &q->metrics;
  return (figures){{[LENGTH] = m->length,
                    [ABOVE] = fmax(0, m->length / p->proof.lower_bound - 1),
                    [TURNING] = m->turning,
                    [PRICE] = price_of(p, q),
                    [LARGEST] = m->max_turning,
                    [CAPSTAN] = turning_capstan(p->options.physics.mu, m->max_turning),
                    [SHARPEST] = m->worst_turn,
                    [OVER_60] = thr_plan_turns_over(q, turning_right_angle * 2 / 3),
                    [OVER_90] = thr_plan_turns_over(q, turning_right_angle),
                    [U_TURNS] = m->u_turns,
                    [PULL] = turning_pull(q, NULL)}};
}

/* The claim that bounds the turning: of a classical tour, that of the plan with the least. NULL = none. */
static const thr_turning_claim *claim_of(const thr_plan *p, const thr_rivals *r)
{
  if (p->turning.present) return &p->turning;
  return r->corner.made && r->corner.plan.turning.present ? &r->corner.plan.turning : NULL;
}

static bool in_angles(const thr_plan *p)
{
  return p->options.turning.cost == THR_TURN_ANGLE;
}

/* A bound on prices bounds angles only where they are the price. */
static figures figures_of_bound(const thr_plan *p, const thr_rivals *r)
{
  const thr_turning_claim *claim = claim_of(p, r);
  figures b;
  for (int i = 0; i < N_FIGURES; i++)
    b.value[i] = NAN;
  b.value[LENGTH] = p->proof.lower_bound;
  if (!claim) return b;
  b.value[PRICE] = claim->lower_bound;
  if (!in_angles(p)) return b;
  b.value[TURNING] = claim->lower_bound;
  b.value[LARGEST] = claim->largest_bound;
  b.value[CAPSTAN] = turning_capstan(p->options.physics.mu, claim->largest_bound);
  return b;
}

/* ---- text ---- */

/* "1200.000 deg", or a price of another kind. */
static void put_price(thr_text *t, const thr_plan *p, double price)
{
  if (in_angles(p))
    thr_text_printf(t, "%.3f deg", thr_degrees(price));
  else
    thr_text_printf(t, "%.6g (%s)", price, thr_turn_cost_name(p->options.turning.cost));
}

/* Branchings, and sets of multipliers at the leaves. */
static void put_proof(thr_text *t, const thr_turning_proof *tree)
{
  int n = tree->n_nodes / 2;
  thr_text_printf(t, "(proof: %d %s, %d %s, verified)\n", n, cli_plural(n, "branching", "branchings"), tree->n_duals,
                  cli_plural(tree->n_duals, "multiplier set", "multiplier sets"));
}

/* What a limit on the length is measured from, where that is more than the length proof needs: the shortest passes may not hold
 * so many cords. */
static void put_shortest(thr_text *t, const thr_plan *p)
{
  double shortest = p->turning.length_limit / (1 + p->options.turning.length_slack), least = p->proof.lower_bound;
  if (p->turning.length_limit < 0 || shortest <= least * (1 + 1e-9)) return;
  thr_text_printf(t, "         shortest found for %s: %.6f %s, %.2f %% above the least length that is proved\n",
                  p->options.cords > 1 ? "so many cords" : "one cord", shortest, p->frame.units, 100 * (shortest / least - 1));
}

static void put_restriction(thr_text *t, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  thr_text_printf(t, "         among threadings with at most %d %s over an edge", c->most_passes,
                  cli_plural(c->most_passes, "pass", "passes"));
  if (c->length_limit >= 0) thr_text_printf(t, ", cord up to %.6f %s", c->length_limit, p->frame.units);
  thr_text_append(t, " and U-turns only at beads with one interface\n");
  put_shortest(t, p);
  thr_text_append(t, "         these passes, paired at every node on its own: ");
  put_price(t, p, c->pairing_bound);
  thr_text_append(t, "; that may be several loops\n");
}

static void put_largest(thr_text *t, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  thr_text_append(t, "largest  ");
  put_price(t, p, c->largest);
  if (c->largest_optimal) {
    thr_text_printf(t, "\n         optimal: the cord that turns most cannot %s less, the bound is attained\n",
                    in_angles(p) ? "turn" : "cost");
    return;
  }
  thr_text_append(t, "\n         not proved optimal: at least ");
  put_price(t, p, c->largest_bound);
  thr_text_printf(t, " is needed by the cord that turns most, gap %.3g %%\n", 100 * (1 - c->largest_bound / c->largest));
}

/* Names of the nodes where cords turn back, each once. */
static void put_u_turns(thr_text *t, const thr_plan *p)
{
  enum { MOST = 8 };
  const thr_frame *f = &p->frame;
  int at[MOST], n = 0;
  bool forced = true, more = false;
  if (p->metrics.u_turns == 0) return;
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    for (int k = 0; k < thr_cord_turns(&p->options, c); k++) {
      int out = c->half[(k + 1) % c->n_passes], v = thr_tail(f, out), j = 0;
      if (out != (c->half[k] ^ 1)) continue;
      forced &= thr_degree(f, v) == 1;
      while (j < n && at[j] != v)
        j++;
      more |= j == MOST;
      if (j == n && n < MOST) at[n++] = v;
    }
  }
  thr_text_printf(t, "U-turns  %d, %s", p->metrics.u_turns, forced ? "forced at the beads with one interface: " : "at ");
  for (int j = 0; j < n; j++)
    thr_text_printf(t, "%s%s", j ? ", " : "", f->name[at[j]]);
  thr_text_append(t, more ? ", ..\n" : "\n");
}

static void put_tour_status(thr_text *t, const thr_plan *p, const thr_rivals *r)
{
  const thr_turning_claim *claim = claim_of(p, r);
  thr_text_append(t, "         a classical tour, nothing proved");
  if (claim) {
    thr_text_append(t, "; least turning needs at least ");
    put_price(t, p, claim->lower_bound);
  }
  thr_text_append(t, "\n");
}

void turning_put_status(thr_text *t, const thr_plan *p, const thr_rivals *r)
{
  const thr_turning_claim *c = &p->turning;
  thr_text_printf(t, "turning  %.3f deg", thr_degrees(p->metrics.turning));
  if (!in_angles(p)) {
    thr_text_append(t, ", price ");
    put_price(t, p, price_of(p, p));
  }
  thr_text_append(t, "\n");
  if (!c->present) {
    put_tour_status(t, p, r);
  } else if (c->optimal) {
    thr_text_printf(t, "         optimal: no threading with these options %s ",
                    in_angles(p) ? "turns less" : "has a lower price");
    put_proof(t, &c->tree);
  } else {
    thr_text_append(t, thr_wants_largest(&p->options) ? "         all cords together need at least "
                                                      : "         not proved optimal: at least ");
    put_price(t, p, c->lower_bound);
    thr_text_printf(t, "%s, gap %.3g %% ", thr_wants_largest(&p->options) ? "" : " is needed", 100 * c->gap);
    put_proof(t, &c->tree);
  }
  if (c->present) put_restriction(t, p);
  if (c->present && (p->n_cords > 1 || thr_wants_largest(&p->options))) put_largest(t, p);
  put_u_turns(t, p);
}

static void put_cell(thr_text *t, format kind, double value)
{
  char cell[40], factor[24];
  if (isnan(value))
    snprintf(cell, sizeof cell, "-");
  else if (kind == FORMAT_FACTOR)
    snprintf(cell, sizeof cell, "%s", turning_factor(value, factor));
  else if (kind == FORMAT_PRICE)
    snprintf(cell, sizeof cell, "%.6g", value);
  else
    snprintf(cell, sizeof cell, "%.*f",
             kind == FORMAT_LENGTH    ? 3
             : kind == FORMAT_PERCENT ? 2
             : kind == FORMAT_ANGLE   ? 1
                                      : 0,
             kind == FORMAT_PERCENT ? 100 * value
             : kind == FORMAT_ANGLE ? thr_degrees(value)
                                    : value);
  thr_text_printf(t, " %18s", cell);
}

enum { MOST_COLUMNS = 4 };

typedef struct {
  const char *title, *proved;
  figures figures;
} column;

static const char *yes_or_no(const thr_plan *p)
{
  return !p->turning.present ? "-" : p->turning.optimal ? "yes" : "no";
}

static int make_columns(const thr_plan *p, const thr_rivals *r, column out[MOST_COLUMNS])
{
  int n = 0;
  out[n++] = (column){"this plan", yes_or_no(p), figures_of(p, p)};
  out[n++] = (column){"lower bound", "-", figures_of_bound(p, r)};
  if (r->corner.made) out[n++] = (column){r->corner.title, yes_or_no(&r->corner.plan), figures_of(p, &r->corner.plan)};
  if (r->length.made) out[n++] = (column){r->length.title, "-", figures_of(p, &r->length.plan)};
  return n;
}

static void put_left_out(thr_text *t, const thr_rival *r)
{
  if (!r->made && r->why.code) thr_text_printf(t, "without %s: %s\n", r->title, r->why.text);
}

void turning_put_table(thr_text *t, const thr_plan *p, const thr_rivals *r)
{
  column c[MOST_COLUMNS];
  int n = make_columns(p, r, c);
  thr_text_printf(t, "\n%-27s", "each against");
  for (int k = 0; k < n; k++)
    thr_text_printf(t, " %18s", c[k].title);
  for (int i = 0; i < N_FIGURES; i++) {
    if (i == PRICE && in_angles(p)) continue; /* the turning itself */
    if (i == LENGTH)
      thr_text_printf(t, "\nlength, %-19s", p->frame.units);
    else
      thr_text_printf(t, "\n%-27s", figure[i].label);
    for (int k = 0; k < n; k++)
      put_cell(t, figure[i].format, c[k].figures.value[i]);
  }
  thr_text_printf(t, "\n%-27s", "proved to turn least");
  for (int k = 0; k < n; k++)
    thr_text_printf(t, " %18s", c[k].proved);
  thr_text_append(t, "\n");
  put_left_out(t, &r->corner);
  put_left_out(t, &r->length);
}

void turning_put_frontier(thr_text *t, const thr_plan *p, const thr_rivals *r)
{
  const thr_frontier *f = &r->frontier;
  bool angles = in_angles(p), proved = true;
  if (f->n == 0) return;
  thr_text_printf(t, "\nfrontier: the least turning for each length\n%14s %16s %13s", "length", "above shortest", "turning");
  if (!angles) thr_text_printf(t, " %13s", "price");
  thr_text_printf(t, " %13s %9s %13s %12s\n", "lower bound", "gap", "largest cord", "capstan");
  for (int i = 0; i < f->n; i++) {
    const thr_frontier_point *q = &f->point[i];
    char factor[24];
    thr_text_printf(t, "%14.3f %14.2f %% %9.1f deg", q->length, 100 * fmax(0, q->length / p->proof.lower_bound - 1),
                    thr_degrees(q->turning));
    if (angles)
      thr_text_printf(t, " %9.1f deg", thr_degrees(q->lower_bound));
    else
      thr_text_printf(t, " %13.6g %13.6g", q->price, q->lower_bound);
    thr_text_printf(t, " %7.3g %% %9.1f deg %12s%s\n",
                    !q->open || q->price <= 0 ? 0 : 100 * fmax(0, 1 - q->lower_bound / q->price), thr_degrees(q->max_turning),
                    turning_factor(turning_capstan(p->options.physics.mu, q->max_turning), factor), q->open ? "  *" : "");
    proved &= !q->open;
  }
  if (!proved) thr_text_append(t, "* not proved optimal: of that length, or less, none turns less than the lower bound\n");
}

/* ---- JSON ---- */

static void put_bound_json(thr_writer *w, const thr_plan *p, double bound)
{
  thr_write_number(w, "turning_lower_bound", in_angles(p) ? bound : NAN);
  thr_write_number(w, "price_lower_bound", bound);
}

static const char *proof_status(bool claimed, bool optimal)
{
  return !claimed ? "none" : optimal ? "optimal" : "bound";
}

/* bound: the claim that bounds the turning, NULL = none. A classical tour has that of the plan with the least turning, but claims
 * nothing itself. */
static void put_claim_json(thr_writer *w, const thr_plan *p, const thr_turning_claim *bound, double price)
{
  const thr_turning_claim *own = &p->turning;
  put_bound_json(w, p, bound ? bound->lower_bound : NAN);
  thr_write_number(w, "turning_gap", own->present ? own->gap : bound ? 1 - bound->lower_bound / price : NAN);
  thr_write_string(w, "turning_status", proof_status(own->present, own->optimal));
  thr_write_number(w, "pairing_bound", own->present ? own->pairing_bound : NAN);
  thr_write_number(w, "max_turning_bound", bound && in_angles(p) ? bound->largest_bound : NAN);
  thr_write_number(w, "max_price_bound", bound ? bound->largest_bound : NAN);
  thr_write_string(w, "max_turning_status", proof_status(own->present, own->largest_optimal));
}

static void put_figures_json(thr_writer *w, const figures *x, bool all)
{
  for (int i = 0; i < N_FIGURES; i++)
    if (all || !figure[i].known) thr_write_number(w, figure[i].key, x->value[i]);
}

static void put_rival_json(thr_writer *w, const thr_plan *p, const thr_rival *r, bool claims)
{
  if (!r->made) {
    thr_write_null(w, r->key);
    return;
  }
  figures x = figures_of(p, &r->plan);
  thr_write_object(w, r->key);
  thr_write_string(w, "plan", r->title);
  put_figures_json(w, &x, true);
  if (claims) put_claim_json(w, &r->plan, &r->plan.turning, x.value[PRICE]);
  thr_write_close(w);
}

static void put_frontier_json(thr_writer *w, const thr_plan *p, const thr_frontier *f)
{
  thr_write_array(w, "frontier");
  for (int i = 0; i < f->n; i++) {
    const thr_frontier_point *q = &f->point[i];
    thr_write_line(w, 1);
    thr_write_object(w, NULL);
    thr_write_number(w, "length", q->length);
    thr_write_number(w, "overlap", q->overlap);
    thr_write_number(w, "turning", q->turning);
    thr_write_number(w, "price", q->price);
    put_bound_json(w, p, q->lower_bound);
    thr_write_number(w, "max_turning", q->max_turning);
    thr_write_number(w, "max_capstan", turning_capstan(p->options.physics.mu, q->max_turning));
    thr_write_string(w, "turning_status", q->open ? "bound" : "optimal");
    thr_write_close(w);
  }
  thr_write_close(w);
}

void turning_put_json(thr_writer *w, const thr_plan *p, const thr_rivals *r)
{
  figures x = figures_of(p, p);
  thr_write_string(w, "turn_cost", thr_turn_cost_name(p->options.turning.cost));
  put_figures_json(w, &x, false);
  put_claim_json(w, p, claim_of(p, r), x.value[PRICE]);
  thr_write_array(w, "capstan");
  for (int i = 0; i < p->n_cords; i++) {
    double turning = thr_cord_turning(&p->frame, &p->cord[i], p->options.ends == THR_ENDS_CLOSED);
    thr_write_number(w, NULL, turning_capstan(p->options.physics.mu, turning));
  }
  thr_write_close(w);
  put_rival_json(w, p, &r->corner, true);
  put_rival_json(w, p, &r->length, false);
  if (r->frontier.n) put_frontier_json(w, p, &r->frontier);
}
