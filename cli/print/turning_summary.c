/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints a plan of least turning beside its lower bound and the plans that it is compared with: the
 * least turning among the shortest plans or of any length (the corner of the trade-off), the
 * shortest plan, and the frontier between the two.
 *
 * Tension grows by exp(mu x turning) along a cord (Euler-Eytelwein, docs/method.md, "Pull force"),
 * so that turning, in rad, decides how hard a cord is to pull (thesis, "Tortuosity"). Bounds are
 * lower bounds on the price of all turns; where turns are not priced by their angle, a bound says
 * nothing about angles.
 *
 * Every column holds the same figures, each of them in the unit of the plan: lengths in units of
 * the framework, angles in rad (printed in degrees), pulls as a factor on the seating tension
 * (printed in N).
 *
 * Example: one closed cord through the 7 x 7 dome turns by 2990.4 deg, which is proved to be the
 * least, and is pulled with 154 N; the shortest one that --objective length finds turns by 3163.9
 * deg and is pulled with 197 N. */
#include "cli/print/print.h"
#include "graph/number.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"

#include <math.h>
#include <stdio.h>

/* ---- figures ---- */

/* Rows of the table. */
enum {
  LENGTH,
  ABOVE,
  TURNING,
  PRICE,
  LARGEST,
  CAPSTAN,
  SHARPEST,
  OVER_60,
  OVER_90,
  U_TURNS,
  PULL,
  N_FIGURES
};

/* The figures of one plan, or of the bound, in rad, units and parts; NAN = not known or without
 * meaning. */
typedef struct {
  double value[N_FIGURES];
} turning_figures;

/* How a figure is printed. */
typedef enum {
  FORMAT_LENGTH,
  FORMAT_PERCENT,
  FORMAT_ANGLE,
  FORMAT_PRICE,
  FORMAT_FACTOR,
  FORMAT_FORCE,
  FORMAT_COUNT
} format;

/* The figures by row: their label, their JSON member, their format, and whether any plan's JSON has
 * that member already, so that it is not written again. */
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
    [PULL] = {"largest pull, N", "pull_factor", FORMAT_FORCE, true}, /* times the seating tension */
};

void turning_put_ends_json(thr_writer *writer, const thr_plan *plan, const thr_eval *seated)
{
  thr_write_number(writer, "other_pull", thr_evaluation_hardest(&seated->record)->other_force);
  seated_put_holding_json(writer, plan, &seated->record);
}

double turning_pull(const thr_plan *plan, double *cord)
{
  thr_eval eval;
  bool known = !thr_eval_closed_form(plan, 1, &eval, NULL);
  double largest = known ? eval.record.largest : NAN;

  /* With a seating tension of 1 N pulls are factors. If the evaluation failed because a factor is
   * more than exp(690), about 1e300, the cords that are to blame are INFINITY. */
  for (int i = 0; i < plan->n_cords; i++) {
    double pull = known ? eval.record.cord[i].force : NAN;

    /* Pulled at both ends, each end has half of the turning to overcome. */
    if (!known &&
        plan->options.physics.mu * thr_cord_turning(&plan->frame, &plan->cord[i], false) / 2 > 690)
      pull = INFINITY;

    if (cord) cord[i] = pull;
    if (isinf(pull)) largest = pull;
  }

  thr_eval_destroy(&eval);

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

/* Returns the price of all turns of a plan, as the options of another plan price them. */
static double price_of(const thr_plan *plan, const thr_plan *other)
{
  double price = 0;
  for (int i = 0; i < other->n_cords; i++)
    price += thr_cord_price(&other->frame, &plan->options, &other->cord[i]);
  return price;
}

/* Computes the figures of plan `other`, as the options of `plan` price turns, and as the length
 * proof of `plan` knows the shortest length. */
static turning_figures measure_figures(const thr_plan *plan, const thr_plan *other)
{
  const thr_metrics *metrics = &other->metrics;

  /* Lengths in units, turning in rad, parts and factors without a unit. */
  return (turning_figures){{[LENGTH] = metrics->length,
                            [ABOVE] = fmax(0, metrics->length / plan->proof.lower_bound - 1),
                            [TURNING] = metrics->turning,
                            [PRICE] = price_of(plan, other),
                            [LARGEST] = metrics->max_turning,
                            [CAPSTAN] = thr_capstan(plan->options.physics.mu, metrics->max_turning),
                            [SHARPEST] = metrics->worst_turn,
                            [OVER_60] = thr_plan_turns_over(other, turning_right_angle * 2 / 3),
                            [OVER_90] = thr_plan_turns_over(other, turning_right_angle),
                            [U_TURNS] = metrics->u_turns,
                            [PULL] = turning_pull(other, NULL)}};
}

/* Returns the claim that bounds the turning: the plan's own, or for a classical tour, which claims
 * nothing, that of the plan with the least turning. NULL = none. */
static const thr_turning_claim *claim_of(const thr_plan *plan, const thr_rivals *rivals)
{
  if (plan->turning.present) return &plan->turning;
  return rivals->corner.made && rivals->corner.plan.turning.present ? &rivals->corner.plan.turning
                                                                    : NULL;
}

/* Returns whether the price of a turn is its angle. */
static bool in_angles(const thr_plan *plan)
{
  return plan->options.turning.cost == THR_TURN_ANGLE;
}

/* Fills in what is proved of any plan. A bound on prices bounds angles only where these are the
 * price, and then either the largest turning of a cord, or, if pulls are minimized, the larger part
 * of it before an end. */
static turning_figures bound_figures(const thr_plan *plan, const thr_rivals *rivals)
{
  const thr_turning_claim *claim = claim_of(plan, rivals);
  turning_figures bound;

  for (int i = 0; i < N_FIGURES; i++)
    bound.value[i] = NAN;

  /* A length is bounded by the proof of length, whatever turns cost. */
  bound.value[LENGTH] = plan->proof.lower_bound;
  if (!claim) return bound;
  bound.value[PRICE] = claim->lower_bound;
  if (!in_angles(plan)) return bound;

  /* Where the price is the angle there is more to say. */
  bound.value[TURNING] = claim->lower_bound;
  if (thr_wants_pull(&plan->options)) {
    bound.value[PULL] = thr_capstan(plan->options.physics.mu, claim->largest_bound);
    return bound;
  }

  bound.value[LARGEST] = claim->largest_bound;
  bound.value[CAPSTAN] = thr_capstan(plan->options.physics.mu, claim->largest_bound);

  return bound;
}

/* ---- text ---- */

/* Appends "1200.0 deg", or a price of another kind with its name. */
static void put_price(thr_text *text, const thr_plan *plan, double price)
{
  if (in_angles(plan))
    thr_text_printf(text, "%.1f deg", thr_degrees(price));
  else
    thr_text_printf(text, "%.6g (%s)", price, thr_turn_cost_name(plan->options.turning.cost));
}

/* Appends, with --verbose, what the proof is made of: branchings of the tree, sets of multipliers
 * at its leaves, and the bound for all cords together. */
static void put_machinery(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;
  const thr_turning_proof *tree = &claim->tree;
  int n = tree->n_nodes / 2;

  if (!cli_verbose) return;

  /* The leaves of the tree prove their bounds by sets of multipliers, which the checker adds up. */
  thr_text_printf(text, "         proof: %d %s, %d %s, verified; all cords together need at least ",
                  n, cli_plural(n, "branching", "branchings"), tree->n_duals,
                  cli_plural(tree->n_duals, "multiplier set", "multiplier sets"));
  put_price(text, plan, claim->lower_bound);
  thr_text_append(text, "\n");
}

/* Appends what a limit on the length is measured from, if that is more than the proved least
 * length: the shortest passes may not make so many cords. */
static void put_shortest(thr_text *text, const thr_plan *plan)
{
  double shortest = plan->turning.length_limit / (1 + plan->options.turning.length_slack),
         least = plan->proof.lower_bound;

  /* The limit is (1 + slack) x the shortest length that was found. */
  if (plan->turning.length_limit < 0 || shortest <= least * (1 + 1e-9)) return;
  thr_text_printf(
      text,
      "         shortest found for %s: %.7g %s, %.2f %% above the least length that is proved\n",
      plan->options.cords > 1 ? "so many cords" : "one cord", shortest, plan->frame.units,
      100 * (shortest / least - 1));
}

/* Appends among which threadings the turning is the least: the proof holds for at most so many
 * passes over an edge, up to a length, and for U-turns at nodes of degree 1 only. */
static void put_restriction(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;

  thr_text_printf(text, "         among threadings with at most %d %s over an edge",
                  claim->most_passes, cli_plural(claim->most_passes, "pass", "passes"));

  /* With a length slack also among those that are short enough. */
  if (claim->length_limit >= 0)
    thr_text_printf(text, ", cord up to %.7g %s", claim->length_limit, plan->frame.units);
  thr_text_printf(text, " and U-turns only at beads with one interface%s\n",
                  thr_wants_pull(&plan->options) ? " (of the pull: anywhere)" : "");
  put_shortest(text, plan);
}

/* Appends what is proved of the cord that turns most, or that is hardest to pull. */
static void put_largest(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;

  thr_text_append(text, "largest  ");
  put_price(text, plan, claim->largest);

  /* What is minimized of single cords: their turning or, for the pull, the larger part of it, on
   * one side of the slackest pass. */
  const bool pull = thr_wants_pull(&plan->options);
  thr_text_append(text, pull ? ", what an end of the cord that is hardest to pull has to overcome; "
                             : ", the cord that turns most; ");
  plain_put_largest_proof(text, plan);
  thr_text_append(text, "\n");
}

/* Appends the names of the nodes where cords turn back into the edge that they come from, each
 * once. A node of degree 1 forces that. */
static void put_u_turns(thr_text *text, const thr_plan *plan)
{
  enum { MOST = 8 };
  const thr_frame *frame = &plan->frame;
  int at[MOST], n = 0;
  bool forced = true, more = false;

  if (plan->metrics.u_turns == 0) return;

  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];

    /* A turn back is followed by the same edge's other half-edge. */
    for (int k = 0; k < thr_cord_turns(&plan->options, cord); k++) {
      int out = cord->half[(k + 1) % cord->n_passes], v = thr_tail(frame, out), j = 0;
      if (out != (cord->half[k] ^ 1)) continue;

      /* The first 8 nodes are named; more: there are others. */
      forced &= thr_degree(frame, v) == 1;
      while (j < n && at[j] != v)
        j++;
      more |= j == MOST;
      if (j == n && n < MOST) at[n++] = v;
    }
  }

  thr_text_printf(text, "U-turns  %d, %s", plan->metrics.u_turns,
                  forced ? "forced at the beads with one interface: " : "at ");
  for (int j = 0; j < n; j++)
    thr_text_printf(text, "%s%s", j ? ", " : "", frame->name[at[j]]);
  thr_text_append(text, more ? ", ..\n" : "\n");
}

/* Appends that nothing is proved of the plan itself, and what is known of the least turning. */
static void put_open_status(thr_text *text, const thr_plan *plan, const thr_rivals *rivals)
{
  const thr_turning_claim *claim = claim_of(plan, rivals);
  const bool tour = plan->options.turning.tour != THR_TOUR_LEAST;

  /* A classical tour is made to compare with. */
  thr_text_append(text, tour ? "; a classical tour, of which nothing is proved\n"
                             : "; nothing is proved of it\n");

  if (!claim) return;
  thr_text_append(text, "         the least turning is at least ");
  put_price(text, plan, claim->lower_bound);
  thr_text_append(text, "\n");
}

void turning_put_status(thr_text *text, const thr_plan *plan, const thr_rivals *rivals)
{
  const thr_turning_claim *claim = &plan->turning;

  thr_text_printf(text, "turning  %.1f deg", thr_degrees(plan->metrics.turning));
  if (plan->n_cords > 1) thr_text_append(text, ", all cords together");

  if (!in_angles(plan)) {
    thr_text_append(text, ", price ");
    put_price(text, plan, price_of(plan, plan));
  }

  /* What is proved, of all turning and of the largest cord, and of which threadings. */
  if (!claim->present) {
    put_open_status(text, plan, rivals);
  } else {
    thr_text_append(text, "; ");
    plain_put_turning_proof(text, plan);
    thr_text_append(text, "\n");

    /* The largest cord has a bound of its own if there are several, or if it is what is
     * minimized. */
    if (plan->n_cords > 1 || thr_wants_largest(&plan->options)) put_largest(text, plan);
    put_restriction(text, plan);
    put_machinery(text, plan);
  }

  put_u_turns(text, plan);
}

/* Appends a figure in a column. seating: N, by which factors become pulls. */
static void put_cell(thr_text *text, format kind, double value, double seating)
{
  char cell[40], factor[24];

  /* Factors, forces and prices span many powers of ten. */
  if (isnan(value))
    snprintf(cell, sizeof cell, "-");
  else if (kind == FORMAT_FACTOR)
    snprintf(cell, sizeof cell, "%s", turning_factor(value, factor));
  else if (kind == FORMAT_FORCE)
    thr_plain_newtons(value * seating, cell);
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

  thr_text_printf(text, "\v0 %18s", cell);
}

enum { MOST_COLUMNS = 4 };

/* A column of the table: its title, whether the plan is proved to turn least, and its figures. */
typedef struct {
  const char *title, *proved;
  turning_figures figures;
} column;

/* Returns whether a plan is proved to turn least: "yes", "no", or "-" if it claims nothing. */
static const char *yes_or_no(const thr_plan *plan)
{
  return !plan->turning.present ? "-" : plan->turning.optimal ? "yes" : "no";
}

/* Fills in the columns: this plan, the bound, and the plans that were made to compare with. Returns
 * their number. */
static int make_columns(const thr_plan *plan, const thr_rivals *rivals, column out[MOST_COLUMNS])
{
  int n = 0;

  /* The plan, and what bounds any plan. */
  out[n++] = (column){"this plan", yes_or_no(plan), measure_figures(plan, plan)};
  out[n++] = (column){"at least", "-", bound_figures(plan, rivals)};

  /* Each is there only if it could be made in time. */
  if (rivals->corner.made)
    out[n++] = (column){rivals->corner.title, yes_or_no(&rivals->corner.plan),
                        measure_figures(plan, &rivals->corner.plan)};
  if (rivals->length.made)
    out[n++] = (column){rivals->length.title, "-", measure_figures(plan, &rivals->length.plan)};

  return n;
}

/* Appends why a plan to compare with is missing. */
static void put_left_out(thr_text *text, const thr_rival *rival)
{
  if (!rival->made && rival->why.code)
    thr_text_printf(text, "without %s: %s\n", rival->title, rival->why.text);
}

void turning_put_table(thr_text *text, const thr_plan *plan, const thr_rivals *rivals)
{
  column columns[MOST_COLUMNS];
  int n = make_columns(plan, rivals, columns);

  thr_text_printf(text, "\n%-27s", "each against");

  /* Heads of the columns. */
  for (int k = 0; k < n; k++)
    thr_text_printf(text, "\v0 %18s", columns[k].title);

  /* Rows. The price is left out where it is the turning itself, the capstan factor without
   * --verbose. */
  for (int i = 0; i < N_FIGURES; i++) {
    if ((i == PRICE && in_angles(plan)) || (i == CAPSTAN && !cli_verbose))
      continue; /* the turning itself; for those who ask */

    if (i == LENGTH)
      thr_text_printf(text, "\nlength, %-19s", plan->frame.units);
    else
      thr_text_printf(text, "\n%-27s", figure[i].label);

    /* A value for each column. */
    for (int k = 0; k < n; k++)
      put_cell(text, figure[i].format, columns[k].figures.value[i], plan->options.physics.seating);
  }

  /* What is proved, and what is missing. */
  thr_text_printf(text, "\n%-27s", "proved to turn least");
  for (int k = 0; k < n; k++)
    thr_text_printf(text, "\v0 %18s", columns[k].proved);
  thr_text_append(text, "\n");
  put_left_out(text, &rivals->corner);
  put_left_out(text, &rivals->length);
}

/* Returns the pull at the hardest end of the cords of a point of the frontier, N, at friction mu;
 * INFINITY beyond 1e300. */
static double point_pull(const thr_plan *plan, const thr_frontier_point *point, double mu)
{
  return plan->options.physics.seating * thr_capstan(mu, point->pulled);
}

void turning_put_frontier(thr_text *text, const thr_plan *plan, const thr_rivals *rivals)
{
  const thr_frontier *frontier = &rivals->frontier;
  bool angles = in_angles(plan), proved = true;

  if (frontier->n == 0) return;

  /* Columns: with prices of their own, turning and price are different. */
  thr_text_printf(text, "\nfrontier: the least turning for each length\n%14s\v3 %16s\v0 %13s",
                  "length", "above shortest", "turning");
  if (!angles) thr_text_printf(text, "\v0 %13s", "price");
  thr_text_printf(text, "\v1 %13s\v2 %13s\v0 %12s\n", "at least", "largest cord", "pull, N");

  /* A line per point, from the shortest to the one that turns least. */
  for (int i = 0; i < frontier->n; i++) {
    const thr_frontier_point *frontier_point = &frontier->point[i];
    char force[24];
    thr_text_printf(text, "%14.3f\v3 %14.2f %%\v0 %9.1f deg", frontier_point->length,
                    100 * fmax(0, frontier_point->length / plan->proof.lower_bound - 1),
                    thr_degrees(frontier_point->turning));

    /* The bound: nothing that is no longer turns less. */
    if (angles)
      thr_text_printf(text, "\v1 %9.1f deg", thr_degrees(frontier_point->lower_bound));
    else
      thr_text_printf(text, "\v0 %13.6g\v1 %13.6g", frontier_point->price,
                      frontier_point->lower_bound);

    /* The cord that turns most, and the largest pull. */
    thr_text_printf(
        text, "\v2 %9.1f deg\v0 %12s%s\n", thr_degrees(frontier_point->max_turning),
        thr_plain_newtons(point_pull(plan, frontier_point, plan->options.physics.mu), force),
        frontier_point->open ? "  *" : "");
    proved &= !frontier_point->open;
  }

  /* What a star means. */
  if (!proved)
    thr_text_append(text, "* not proved: of that length, or less, something may turn less, but not "
                          "less than \"at least\"\n");
}

/* ---- JSON ---- */

/* Writes a lower bound on the price, and on the turning if that is the price. */
static void put_bound_json(thr_writer *writer, const thr_plan *plan, double bound)
{
  thr_write_number(writer, "turning_lower_bound", in_angles(plan) ? bound : NAN);
  thr_write_number(writer, "price_lower_bound", bound);
}

/* Returns the JSON word for what is proved: "none", "bound" or "optimal". */
static const char *proof_status(bool claimed, bool optimal)
{
  return !claimed ? "none" : optimal ? "optimal" : "bound";
}

/* Writes the claims of a plan. bound: the claim that bounds the turning, NULL = none. A classical
 * tour has that of the plan with the least turning, but claims nothing itself. price: of all turns
 * of the plan. */
static void put_claim_json(thr_writer *writer, const thr_plan *plan, const thr_turning_claim *bound,
                           double price)
{
  const thr_turning_claim *own = &plan->turning;

  put_bound_json(writer, plan, bound ? bound->lower_bound : NAN);

  /* A tour's gap is to the other plan's bound. */
  thr_write_number(writer, "turning_gap",
                   own->present ? own->gap
                   : bound      ? 1 - bound->lower_bound / price
                                : NAN);
  thr_write_string(writer, "turning_status", proof_status(own->present, own->optimal));

  /* The largest cord: its bound is one on angles only where pulls are not what is minimized. */
  const bool of_turning = bound && in_angles(plan) && !thr_wants_pull(&plan->options);
  thr_write_number(writer, "max_turning_bound", of_turning ? bound->largest_bound : NAN);
  thr_write_number(writer, "max_price_bound", bound ? bound->largest_bound : NAN);
  thr_write_string(writer, "max_turning_status", proof_status(own->present, own->largest_optimal));
}

/* Writes the figures; all: also those that any plan's JSON has already. */
static void put_figures_json(thr_writer *writer, const turning_figures *figures, bool all)
{
  for (int i = 0; i < N_FIGURES; i++)
    if (all || !figure[i].known) thr_write_number(writer, figure[i].key, figures->value[i]);
}

/* Writes a plan that this one is compared with, or null. claims: with what is proved of it. */
static void put_rival_json(thr_writer *writer, const thr_plan *plan, const thr_rival *rival,
                           bool claims)
{
  if (!rival->made) {
    thr_write_null(writer, rival->key);
    return;
  }

  /* All figures, as a plan of its own would have them. */
  turning_figures figures = measure_figures(plan, &rival->plan);
  thr_write_object(writer, rival->key);
  thr_write_string(writer, "plan", rival->title);
  put_figures_json(writer, &figures, true);
  if (claims) put_claim_json(writer, &rival->plan, &rival->plan.turning, figures.value[PRICE]);
  thr_write_close(writer);
}

/* Writes the points of the frontier. */
static void put_frontier_json(thr_writer *writer, const thr_plan *plan,
                              const thr_frontier *frontier)
{
  thr_write_array(writer, "frontier");
  for (int i = 0; i < frontier->n; i++) {
    const thr_frontier_point *frontier_point = &frontier->point[i];

    /* Length and turning of the point, and what bounds them. */
    thr_write_line(writer, 1);
    thr_write_object(writer, NULL);
    thr_write_number(writer, "length", frontier_point->length);
    thr_write_number(writer, "overlap", frontier_point->overlap);
    thr_write_number(writer, "turning", frontier_point->turning);
    thr_write_number(writer, "price", frontier_point->price);
    put_bound_json(writer, plan, frontier_point->lower_bound);

    /* What the turning means for the hand. */
    thr_write_number(writer, "max_turning", frontier_point->max_turning);
    thr_write_number(writer, "max_capstan",
                     thr_capstan(plan->options.physics.mu, frontier_point->max_turning));
    thr_write_number(writer, "pull", point_pull(plan, frontier_point, plan->options.physics.mu));

    /* A point that is open has a bound, but no proof that its price is the least. */
    thr_write_string(writer, "turning_status", frontier_point->open ? "bound" : "optimal");
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

void turning_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals)
{
  turning_figures figures = measure_figures(plan, plan);

  thr_write_string(writer, "turn_cost", thr_turn_cost_name(plan->options.turning.cost));

  /* Figures and claims of the plan itself. */
  put_figures_json(writer, &figures, false);
  put_claim_json(writer, plan, claim_of(plan, rivals), figures.value[PRICE]);

  /* The factor of each cord, from one end to the other. */
  thr_write_array(writer, "capstan");
  for (int i = 0; i < plan->n_cords; i++) {
    double turning =
        thr_cord_turning(&plan->frame, &plan->cord[i], plan->options.ends == THR_ENDS_CLOSED);
    thr_write_number(writer, NULL, thr_capstan(plan->options.physics.mu, turning));
  }
  thr_write_close(writer);

  /* What the plan is compared with. */
  put_rival_json(writer, plan, &rivals->corner, true);
  put_rival_json(writer, plan, &rivals->length, false);
  if (rivals->frontier.n) put_frontier_json(writer, plan, &rivals->frontier);
}
