/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what `thread plan` says of a plan: its cords, their length, turning and pull, what is
 * proved of each, and what comes loose if a cord is cut.
 *
 * Every claim is one that `thread check` verifies (graph/check/check.h), unless the line says "not
 * verified". Cords are pulled at both ends; the pull at the harder end, N, is seating tension x
 * exp(mu x reach), where the reach is the turning from that end to the slackest pass, rad.
 *
 * Order of the lines: what was asked for; a line per cord; length with its proof; longest cord and
 * number of cords with theirs; what hangs on one cord alone; pull; the pieces to make; for plans of
 * least turning the comparison with other plans (turning_summary.c). */
#include "cli/print/print.h"
#include "diagram/tables/tables.h"
#include "graph/number.h"

#include <stdio.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns whether the plan is one of least turning. */
static bool minimizes_turning(const thr_plan *plan)
{
  return thr_wants_turning(&plan->options);
}

/* ---- cords ---- */

/* Sums over the turns of a cord that the plan counts. A plan of least turning counts the closing
 * turn of a closed cord, too; others only turns inside the cord. */
typedef struct {
  double turning, sharpest; /* rad */
  int u_turns;
} turn_sums;

/* Computes the turning of a cord, its sharpest turn (both rad) and its number of U-turns. */
static turn_sums measure_turns(const thr_plan *plan, const thr_cord *cord)
{
  turn_sums sums = {0};
  int n = minimizes_turning(plan) ? thr_cord_turns(&plan->options, cord) : cord->n_passes - 1;

  /* A U-turn goes on with the other half-edge of the same edge. */
  for (int k = 0; k < n; k++) {
    int out = cord->half[(k + 1) % cord->n_passes];
    double angle = thr_turn_angle(&plan->frame, cord->half[k], out);
    sums.turning += angle;
    sums.sharpest = fmax(sums.sharpest, angle);
    sums.u_turns += out == (cord->half[k] ^ 1);
  }

  return sums;
}

/* Appends the line of a cord. pull: at the harder end, as a factor on the seating tension. seated:
 * the cord's evaluation in N, NULL if there is none; it knows the pull at either end. */
static void put_cord(thr_text *text, const thr_plan *plan, const thr_cord *cord, double pull,
                     const thr_eval_cord *seated)
{
  const turn_sums turns = measure_turns(plan, cord);
  const char *from = plan->frame.name[thr_cord_start(&plan->frame, cord)],
             *to = plan->frame.name[thr_cord_end(&plan->frame, cord)];
  char factor[24], force[64];
  const double newton = pull * plan->options.physics.seating;

  /* Where both ends are pulled each has the tension of its own first pass. */
  const bool both = seated && seated->tension && seated->pull == THR_PULL_BOTH;
  plain_both(both ? seated->tension[0] : newton,
             both ? seated->tension[cord->n_passes - 1] : newton, force);

  /* The sharpest turn matters for least turning, the capstan factor for those who ask. */
  thr_text_printf(text, "%-5s\v4 %7d\v2 %14.3f\v0 %6.0f deg", cord->id, cord->n_passes,
                  thr_cord_length(&plan->frame, cord), thr_degrees(turns.turning));
  if (minimizes_turning(plan)) thr_text_printf(text, "\v5 %6.0f deg", thr_degrees(turns.sharpest));
  thr_text_printf(text, "\v6 %8d", turns.u_turns);
  if (cli_verbose)
    thr_text_printf(text, "\v7 %12s",
                    turning_factor(thr_capstan(plan->options.physics.mu, turns.turning), factor));

  /* A closed cord begins and ends at the same node. */
  thr_text_printf(text, "\v0 %18s", force);
  thr_text_printf(text, cord->closed ? "\v1  both at %s\n" : "\v1  %s and %s\n", from, to);
}

/* Appends the table of at most 30 cords. pull: of each, as a factor on the seating tension. */
static void put_cords(thr_text *text, const thr_plan *plan, const double *pull,
                      const thr_eval *seated)
{
  enum { MOST = 30 };

  thr_text_printf(text, "%-5s\v4 %7s\v2 %14s\v0 %10s", "cord", "passes", "length", "turning");
  if (minimizes_turning(plan)) thr_text_printf(text, "\v5 %10s", "sharpest");
  thr_text_printf(text, "\v6 %8s", "U-turns");
  if (cli_verbose) thr_text_printf(text, "\v7 %12s", "capstan");
  thr_text_printf(text, "\v0 %18s\v1  %s\n", "pull", "ends");

  /* A line per cord, the first MOST. */
  for (int i = 0; i < plan->n_cords && i < MOST; i++)
    put_cord(text, plan, &plan->cord[i], pull[i], seated ? &seated->record.cord[i] : NULL);
  if (plan->n_cords > MOST) thr_text_printf(text, "..    and %d more\n", plan->n_cords - MOST);
}

/* ---- text ---- */

/* Appends how many cords were asked for, and what each of them has to keep to: even lengths, a
 * largest length, a largest pull in N that somebody asked for. */
static void put_number(thr_text *text, const thr_plan *plan, int components, bool recommended)
{
  enum { NO_LIMIT = 1000 };
  const thr_request *options = &plan->options;
  const char *each = components > 1 ? " in each component" : "";

  /* A single cord goes without saying; 1000 stands for any number. */
  if (!thr_plan_counted(options) || options->ends == THR_ENDS_COUNTS)
    thr_text_printf(text, "; %d %s", plan->n_cords, cli_plural(plan->n_cords, "cord", "cords"));
  else if (options->max_pull > 0 && plan->pull_claim.present)
    ; /* as many as the pull takes */
  else if (options->cords_least < options->cords && options->cords < NO_LIMIT)
    thr_text_printf(text, "; %d to %d cords%s", options->cords_least, options->cords, each);
  else if (options->cords_least < options->cords && options->cords_least > 1)
    thr_text_printf(text, "; %d cords and more%s", options->cords_least, each);
  else if (options->cords_least == options->cords && options->cords > 1)
    thr_text_printf(text, "; %d cords%s", options->cords, each);

  /* What limits single cords. */
  if (thr_wants_balance(options)) thr_text_append(text, "; of even length");
  char most[THR_PLAIN_NUMBER];
  if (options->max_length > 0)
    thr_text_printf(text, "; none longer than %s %s",
                    thr_plain_number(options->max_length, 6, most), plan->frame.units);
  if (options->max_pull > 0 && !recommended)
    thr_text_printf(text, "; none pulled by more than %s N",
                    thr_plain_newtons(options->max_pull * options->physics.seating, most));
}

/* Appends what was asked for: "49 pieces, 84 interfaces, 1 component; 1 pass per interface; ends:
 * closed". With tube joints the pieces are the edges. */
static void put_head(thr_text *text, const thr_plan *plan, bool recommended)
{
  const thr_request *options = &plan->options;
  int components = thr_plan_components(plan);
  bool tubes = options->joint == THR_JOINT_TUBE;

  /* What is threaded. */
  if (tubes)
    thr_text_printf(text, "%d %s, %d joints", plan->frame.n_edges,
                    cli_plural(plan->frame.n_edges, "tube", "tubes"), plan->frame.n_nodes);
  else
    thr_text_printf(text, "%d pieces, %d %s", plan->frame.n_nodes, plan->frame.n_edges,
                    cli_plural(plan->frame.n_edges, "interface", "interfaces"));

  /* How often. */
  thr_text_printf(text, ", %d %s; %d %s per %s", components,
                  cli_plural(components, "component", "components"), options->cover,
                  cli_plural(options->cover, "pass", "passes"), tubes ? "tube" : "interface");
  if (plan->frame.cover) thr_text_append(text, " or as the framework says");
  if (options->capacity) thr_text_printf(text, ", at most %d", options->capacity);

  /* By which cords. */
  thr_text_printf(text, "; ends: %s", thr_ends_name(options->ends));
  if (tubes) thr_text_append(text, "; joints: tube");
  put_number(text, plan, components, recommended);
  thr_text_append(text, "\n\n");
}

/* Appends the number of cords and what is proved of it: whether fewer would do. */
static void put_fewest(thr_text *text, const thr_plan *plan, int fewest, bool optimal,
                       const char *within)
{
  thr_text_printf(text, "cords    %d", plan->n_cords);

  /* What is proved, what was asked for, or what is open. */
  if (plain_put_fewest(text, plan, fewest, "", within))
    ;
  else if (optimal && thr_plan_cords_least(&plan->options) > 1)
    thr_text_append(text, "; as few as were asked for");
  else if (!optimal && plan->n_cords > 1)
    thr_text_append(text, "; whether fewer would do is not known");
  thr_text_append(text, "\n");
}

/* Appends how long the longest cord is, and what is proved of that and of the number of cords.
 * word: what the search found out but the checker cannot verify. */
static void put_claim(thr_text *text, const thr_plan *plan, thr_cords_word word)
{
  const thr_cords_claim *claim = &plan->cords_claim;
  const char *units = plan->frame.units;

  if (!claim->present) return;
  thr_text_printf(text, "longest  %.7g %s", claim->longest, units);

  /* Where evenness was not asked for, only a proof of it is worth a clause. */
  if (claim->longest_optimal || thr_wants_balance(&plan->options)) {
    thr_text_append(text, "; ");
    plain_put_proof(text, claim->longest_optimal, claim->longest, claim->longest_bound,
                    "the longest cord can be no shorter", "shortest possible");
  }

  thr_text_append(text, "\n");

  /* The search may know more than a proof shows. */
  if (!claim->longest_optimal && thr_wants_balance(&plan->options) && word.longest_least)
    thr_text_append(text, "         the search ruled out every shorter one (not verified)\n");
  if (claim->fewest > 0) put_fewest(text, plan, claim->fewest, claim->fewest_optimal, "");
}

/* Appends the largest pull where a limit on it was asked for, in N, and whether fewer cords would
 * do within that limit, or within that of a recommended plan. */
static void put_pull_limit(thr_text *text, const thr_plan *plan, double largest, bool recommended)
{
  const thr_request *options = &plan->options;
  const thr_pull_claim *claim = &plan->pull_claim;
  double seating = options->physics.seating;
  char force[64], allowed[THR_PLAIN_NUMBER], within[64];

  if (options->max_pull <= 0) return;

  /* A limit and a claim are factors on the seating tension. */
  thr_plain_newtons(options->max_pull * seating, allowed);
  if (!recommended)
    thr_text_printf(text, "hand     %s at most at the end of a cord; %s N are allowed\n",
                    plain_force(largest * seating, force), allowed);
  snprintf(within, sizeof within, " within %s N", allowed);
  if (claim->present) put_fewest(text, plan, claim->fewest, claim->optimal, within);
}

/* Appends, for those who ask, how many odd cuts prove the length, and whether GLPK's exact
 * simplex finds the same minimum on the same cuts. */
static void put_certificate(thr_text *text, const thr_plan *plan)
{
  const thr_length_proof *proof = &plan->proof;
  int cuts = thr_length_proof_cuts(proof);
  bool agreed = proof->confirmed > 0 && proof->unconfirmed == 0;
  bool missed = proof->unconfirmed > 0 && plan->options.confirm == THR_CONFIRM_ALWAYS;

  if (!cli_verbose && plan->options.confirm != THR_CONFIRM_ALWAYS) return;

  /* GLPK's word counts only if it confirmed, and never denied, the minimum. */
  thr_text_printf(text, "         certificate: %d %s, verified; at least %.6f %s%s\n", cuts,
                  cli_cuts_word(plan, cuts), proof->lower_bound, plan->frame.units,
                  agreed   ? "; GLPK agrees"
                  : missed ? "; not confirmed by GLPK"
                           : "");
}

/* Appends what is proved of the length. */
static void put_length_status(thr_text *text, const thr_plan *plan, thr_cords_word word)
{
  const thr_length_proof *proof = &plan->proof;

  thr_text_append(text, "         ");
  plain_put_length_proof(text, plan);
  thr_text_append(text, "\n");

  /* The search may have ruled out more than the proof shows. */
  if (!proof->optimal && word.passes_least && plan->options.max_length == 0 &&
      !thr_wants_balance(&plan->options))
    thr_text_append(
        text,
        "         the search ruled out everything shorter with so many cords (not verified)\n");
  put_certificate(text, plan);
}

/* Returns how many edges only this cord passes: interfaces between rigid pieces or, with tube
 * joints, pieces. only[n_edges]: the one cord over each edge (thr_cords_only). */
static int edges_alone(const thr_plan *plan, const int *only, int cord)
{
  int n = 0;
  for (int e = 0; e < plan->frame.n_edges; e++)
    n += only[e] == cord;
  return n;
}

/* Returns the number of pieces: edges with tube joints, else nodes. */
static int count_pieces(const thr_plan *plan)
{
  return plan->options.joint == THR_JOINT_TUBE ? plan->frame.n_edges : plan->frame.n_nodes;
}

/* Returns whether no other cord passes any interface of a piece, or the piece itself with tube
 * joints. */
static bool is_alone(const thr_plan *plan, const int *only, int cord, int piece)
{
  const thr_frame *frame = &plan->frame;

  if (plan->options.joint == THR_JOINT_TUBE) return only[piece] == cord;

  /* A node without edges is held by no cord. */
  bool alone = thr_degree(frame, piece) > 0;
  for (int i = frame->first[piece]; i < frame->first[piece + 1]; i++)
    alone = alone && only[frame->half[i] >> 1] == cord;

  return alone;
}

/* Returns how many pieces come wholly loose without a cord. */
static int pieces_alone(const thr_plan *plan, const int *only, int cord)
{
  int n = 0;
  for (int i = 0; i < count_pieces(plan); i++)
    n += is_alone(plan, only, cord, i);
  return n;
}

/* Appends the name of a piece: a node, or the two ends of an edge. */
static void put_piece(thr_text *text, const thr_plan *plan, int piece)
{
  const thr_frame *frame = &plan->frame;
  const bool tube = plan->options.joint == THR_JOINT_TUBE;
  thr_text_append_clean(text, frame->name[tube ? frame->edge[piece][0] : piece]);
  if (!tube) return;
  thr_text_append(text, "-");
  thr_text_append_clean(text, frame->name[frame->edge[piece][1]]);
}

/* Appends the names of the pieces that come wholly loose without a cord. */
static void put_loose(thr_text *text, const thr_plan *plan, const int *only, int cord)
{
  const char *between = ": ";

  for (int i = 0; i < count_pieces(plan); i++) {
    /* Pieces that another cord passes, too, stay where they are. */
    if (!is_alone(plan, only, cord, i)) continue;
    thr_text_append(text, between);
    put_piece(text, plan, i);
    between = ", ";
  }

  thr_text_append(text, "\n");
}

/* Appends what comes loose if one of several cords is cut: the worst case, and with --verbose each
 * cord. */
static void put_cut(thr_text *text, const thr_plan *plan)
{
  int worst = 0, most = 0,
      *only = plan->n_cords > 1 ? thr_calloc((size_t)plan->frame.n_edges, sizeof *only) : NULL;
  const char *what = plan->options.joint == THR_JOINT_TUBE ? "piece" : "interface";

  if (plan->n_cords <= 1) return;
  if (!only) {
    text->failed = true;
    return;
  }

  /* The cord that holds most edges alone. */
  thr_cords_only(&plan->frame, plan->cord, plan->n_cords, only);

  for (int i = 0; i < plan->n_cords; i++) {
    int n = edges_alone(plan, only, i);
    if (n > most) worst = i;
    if (n > most) most = n;
  }

  if (most == 0)
    thr_text_printf(text, "cut      whichever cord is cut, every %s keeps another\n", what);
  else
    thr_text_printf(
        text, "cut      if one cord is cut, at worst %d of %d %ss are left without any (cord %s)\n",
        most, plan->frame.n_edges, what, plan->cord[worst].id);

  /* Cord by cord. */
  for (int i = 0; i < plan->n_cords && cli_verbose && most > 0; i++) {
    thr_text_printf(text, "         cord %s: %d without any, %d %s wholly loose", plan->cord[i].id,
                    edges_alone(plan, only, i), pieces_alone(plan, only, i),
                    cli_plural(pieces_alone(plan, only, i), "piece", "pieces"));
    put_loose(text, plan, only, i);
  }
  free(only);
}

/* Appends how many edges are passed by as many different cords as was asked for. */
static void put_distinct(thr_text *text, const thr_plan *plan)
{
  int asked = plan->options.distinct, met = plan->metrics.distinct, n = plan->frame.n_edges;
  if (asked > 0)
    thr_text_printf(text, "distinct %d of %d edges are passed by %d different cords\n", met, n,
                    asked);
}

/* ---- the kit ---- */

/* Rounds a volume to the two digits that are sure (kit/estimate.c). */
static double round_volume(double volume)
{
  double power = floor(log10(volume)) - 1, unit = pow(10, fabs(power));
  return power < 0 ? round(volume * unit) / unit : round(volume / unit) * unit;
}

void kit_put(thr_text *text, const thr_kit_estimate *kit)
{
  const char *piece = kit->solid ? "piece" : "tube";
  char volume[64], mass[64], width[THR_PLAIN_NUMBER];

  thr_text_printf(text, "%d %s%s, %d %s", kit->pieces, piece, kit->pieces == 1 ? "" : "s",
                  kit->shapes, cli_plural(kit->shapes, "kind", "kinds"));
  if (kit->kinds > kit->shapes)
    thr_text_printf(text, " (%d with their %s)", kit->kinds, kit->solid ? "channels" : "ends");
  if (kit->volume > 0)
    thr_text_printf(text, ", about %s%s %s mm wide",
                    plain_volume(round_volume(kit->volume), volume),
                    kit->solid ? " with arms" : ",", thr_plain_number(kit->width, 3, width));

  /* Pieces beyond a printer's bed are heavy, too, which is why they are hard to hold. */
  if (kit->refused.code && kit->volume > 0) {
    thr_text_printf(text, ", %s (", plain_mass(round_volume(kit->mass), mass));
    plain_put_material(text, &kit->physics);
    thr_text_printf(text, ");\n         too large to print: %s", kit->refused.text);
  } else if (kit->refused.code)
    thr_text_printf(text, "; none can be printed with the usual sizes: %s", kit->refused.text);
  thr_text_append(text, "\n");
}

void kit_put_json(thr_writer *writer, const thr_kit_estimate *kit)
{
  thr_write_object(writer, "kit");
  thr_write_int(writer, "pieces", kit->pieces);
  thr_write_int(writer, "kinds", kit->shapes);
  if (kit->kinds > 0) thr_write_int(writer, "kinds_with_channels", kit->kinds);
  if (kit->volume > 0) {
    thr_write_number(writer, "volume_cm3", round_volume(kit->volume / 1000));
    thr_write_number(writer, "width_mm", kit->width);
  }
  if (kit->refused.code) thr_write_string(writer, "refused", kit->refused.text);
  thr_write_close(writer);
}

/* Appends how long the cords are between their ends, and how much is cut for each, in units. */
static void put_lengths(thr_text *text, const thr_supplies *supplies)
{
  const thr_plan *plan = supplies->plan;
  double range[2][2] = {{INFINITY, 0}, {INFINITY, 0}};
  char words[2][2 * THR_PLAIN_NUMBER + 4];

  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cut_length cut = thr_supplies_cut(supplies, c);
    for (int i = 0; i < 2; i++) {
      range[i][0] = fmin(range[i][0], i ? cut.cut : cut.length);
      range[i][1] = fmax(range[i][1], i ? cut.cut : cut.length);
    }
  }

  for (int i = 0; i < 2; i++) {
    char least[THR_PLAIN_NUMBER], most[THR_PLAIN_NUMBER];
    thr_plain_number(range[i][0], 3, least);
    thr_plain_number(range[i][1], 3, most);
    snprintf(words[i], sizeof *words, "%s%s%s", strcmp(least, most) ? least : "",
             strcmp(least, most) ? " to " : "", most);
  }
  thr_text_printf(text, "to cut   %s %s of cord%s: %s threaded, the rest tails and knots%s\n",
                  words[1], plan->frame.units, plan->n_cords > 1 ? " each" : "", words[0],
                  range[1][1] * supplies->mm > THR_SUPPLIES_WORKING
                      ? "; more where lengths are joined: cords.csv"
                      : "");
}

/* Appends how much cord to cut, what cord and needle to take and which options say others; nothing
 * where sizes in mm are not known. */
static void put_supplies(thr_text *text, const thr_plan *plan)
{
  thr_supplies supplies;
  thr_err err = {0};
  thr_status st = thr_supplies_make(&supplies, plan, &err);
  if (!st) st = thr_supplies_find_sizes(&supplies, &err);

  if (!st && supplies.mm > 0) {
    const double least = thr_supplies_extreme_bore(&supplies, true),
                 most = thr_supplies_extreme_bore(&supplies, false);
    const bool asked = plan->options.physics.cord_diameter > 0;

    put_lengths(text, &supplies);
    thr_text_printf(
        text, "cord     %.3g mm thick%s, bores of %.4g", supplies.cord,
        !asked && supplies.cord < THR_CORD_THINNEST ? ", as thick as the pieces take" : "", least);
    if (most > least) thr_text_printf(text, " to %.4g", most);
    thr_text_printf(text, " mm, needle through %.4g mm%s\n", least,
                    asked ? "" : ": --cord-diameter, --bore");
  }
  text->failed |= st == THR_ENOMEM;
  thr_supplies_destroy(&supplies);
}

/* Estimates the kit of a plan. Returns whether something is known; memory that runs out is kept in
 * the text. */
static bool estimate_kit(thr_text *text, const thr_plan *plan, thr_kit_estimate *kit)
{
  thr_err err = {0};
  thr_status st = thr_kit_estimate_make(kit, plan, &err);
  text->failed |= st == THR_ENOMEM;
  return st == THR_OK;
}

/* Appends the whole summary. pull[n_cords] and largest: factors on the seating tension. seated:
 * what pulls in N do, NULL if they are more than a number holds. Others as in plan_put_summary. */
static double put_text(thr_text *text, const thr_plan *plan, const double *pull, double largest,
                       const thr_eval *seated, const thr_rivals *rivals, thr_cords_word word,
                       bool recommended)
{
  double holds = NAN;
  const thr_metrics *metrics = &plan->metrics;
  const thr_physics *physics = &plan->options.physics;

  /* What was asked for and what each cord is. */
  put_head(text, plan, recommended);
  put_cords(text, plan, pull, seated);
  if (plan->symmetry.present) symmetry_put_paths(text, plan);

  /* Length: the passes that every edge needs, and overlap beyond that. */
  thr_text_printf(text, "\nlength   %.7g %s = %.7g for ", metrics->length, plan->frame.units,
                  metrics->base_length);

  /* A framework may say how often each edge is to be passed. */
  if (plan->frame.cover)
    thr_text_append(text, "the passes that every edge needs");
  else
    thr_text_printf(text, "%d %s over every edge", plan->options.cover,
                    cli_plural(plan->options.cover, "pass", "passes"));
  thr_text_printf(text, " + %.7g overlap (%.1f %%)\n", metrics->overlap,
                  100 * metrics->overlap / metrics->base_length);

  /* What is proved of length and number of cords, and what they mean for hand and knife. */
  put_length_status(text, plan, word);
  put_claim(text, plan, word);
  put_distinct(text, plan);
  put_cut(text, plan);
  put_pull_limit(text, plan, largest, recommended);

  /* Turning and pull. */
  if (rivals) turning_put_status(text, plan, rivals);
  if (cli_verbose)
    thr_text_append(text,
                    "capstan  exp(mu x turning): the factor from one end of a cord to the other\n");
  thr_text_printf(text,
                  "pull     at both ends of every cord, so that %g N is left where it is slackest "
                  "(friction mu = %g)\n",
                  physics->seating, physics->mu);

  /* Holding, and comparisons. */
  if (seated) holds = seated_put_holding(text, "hold     ", plan, &seated->record);
  put_supplies(text, plan);
  thr_kit_estimate kit;
  if (estimate_kit(text, plan, &kit)) {
    thr_text_append(text, "kit      ");
    kit_put(text, &kit);
  }
  if (rivals) turning_put_table(text, plan, rivals);
  if (rivals) turning_put_frontier(text, plan, rivals);
  return holds;
}

/* Returns the pull of each cord as a factor on the seating tension; the caller frees it. NULL when
 * memory runs out, which whoever writes the text reports. */
static double *compute_pulls(thr_text *text, const thr_plan *plan, double *largest)
{
  double *pull = thr_calloc((size_t)plan->n_cords, sizeof *pull);
  if (!pull) text->failed = true; /* which whoever writes the text reports */
  if (pull) *largest = turning_pull(plan, pull);
  return pull;
}

double plan_put_summary(thr_text *text, const thr_plan *plan, const thr_rivals *rivals,
                        thr_cords_word word, bool recommended)
{
  double largest, *pull = compute_pulls(text, plan, &largest), holds = NAN;
  thr_eval seated;
  const bool known = !thr_eval_closed_form(plan, plan->options.physics.seating, &seated, NULL);
  if (pull)
    holds = put_text(text, plan, pull, largest, known ? &seated : NULL, rivals, word, recommended);
  thr_eval_destroy(&seated);
  free(pull);
  return holds;
}

/* ---- JSON ---- */

/* Writes what is known of the longest cord and of the number of cords. */
static void put_claim_json(thr_writer *writer, const thr_plan *plan, thr_cords_word word)
{
  const thr_cords_claim *claim = &plan->cords_claim;

  thr_write_number(writer, "longest", claim->longest);
  thr_write_number(writer, "longest_bound", claim->longest_bound);

  /* What the search ruled out no checker verifies. */
  thr_write_string(writer, "longest_status", claim->longest_optimal ? "optimal" : "bound");
  thr_write_bool(writer, "longest_ruled_out", claim->longest_optimal || word.longest_least);

  if (!claim->fewest) return;
  thr_write_int(writer, "fewest_cords", claim->fewest);
  thr_write_string(writer, "fewest_status", claim->fewest_optimal ? "optimal" : "bound");
}

/* Writes the names of the pieces that come wholly loose without a cord. */
static void put_loose_json(thr_writer *writer, const thr_plan *plan, const int *only, int cord)
{
  thr_write_row(writer, "loose");
  for (int i = 0; i < count_pieces(plan); i++) {
    thr_text name = {0};
    if (!is_alone(plan, only, cord, i)) continue;

    /* A name may have any bytes, so that it is written as a JSON string. */
    put_piece(&name, plan, i);
    thr_write_string(writer, NULL, name.data ? name.data : "");
    writer->out->failed |= name.failed;
    thr_text_destroy(&name);
  }
  thr_write_close(writer);
}

/* Writes, for each of several cords, the edges that it alone passes, and the pieces that come
 * wholly loose without it. */
static void put_cut_json(thr_writer *writer, const thr_plan *plan)
{
  int *only = thr_calloc((size_t)plan->frame.n_edges, sizeof *only);

  if (!only) {
    writer->out->failed = true;
    return;
  }

  thr_cords_only(&plan->frame, plan->cord, plan->n_cords, only);
  thr_write_array(writer, "cut");

  for (int i = 0; i < plan->n_cords; i++) {
    thr_write_object(writer, NULL);
    thr_write_string(writer, "cord", plan->cord[i].id);
    thr_write_int(writer, "pieces", pieces_alone(plan, only, i));
    put_loose_json(writer, plan, only, i);

    /* Edges by their numbers in the plan's framework. */
    thr_write_row(writer, "edges");
    for (int e = 0; e < plan->frame.n_edges; e++)
      if (only[e] == i) thr_write_int(writer, NULL, e);
    thr_write_close(writer);
    thr_write_close(writer);
  }
  thr_write_close(writer);
  free(only);
}

/* Writes each cord: length in units, turning in rad, pulls in N at the harder and the easier end,
 * the two ends and all nodes by their names. pull[n_cords]: factors on the seating tension, NULL:
 * not known; seated: as put_cord has it. */
static void put_each_cord_json(thr_writer *writer, const thr_plan *plan, const double *pull,
                               const thr_eval *seated)
{
  const thr_frame *frame = &plan->frame;

  thr_write_array(writer, "each_cord");
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    const double newton = pull ? pull[i] * plan->options.physics.seating : NAN;
    const thr_eval_cord *known = seated ? &seated->record.cord[i] : NULL;

    thr_write_object(writer, NULL);
    thr_write_string(writer, "id", cord->id);
    thr_write_bool(writer, "closed", cord->closed);
    thr_write_int(writer, "passes", cord->n_passes);
    thr_write_number(writer, "length", thr_cord_length(frame, cord));
    thr_write_number(writer, "turning", thr_cord_turning(frame, cord, cord->closed));
    thr_write_number(writer, "pull", newton);
    thr_write_number(writer, "other_pull", known ? fmin(known->force, known->other_force) : newton);

    /* Names, as steps and drawings have them. */
    thr_write_row(writer, "ends");
    thr_write_string(writer, NULL, frame->name[thr_cord_start(frame, cord)]);
    thr_write_string(writer, NULL, frame->name[thr_cord_end(frame, cord)]);
    thr_write_close(writer);
    thr_write_row(writer, "nodes");
    thr_write_string(writer, NULL, frame->name[thr_cord_start(frame, cord)]);
    for (int k = 0; k < cord->n_passes; k++)
      thr_write_string(writer, NULL, frame->name[thr_head(frame, cord->half[k])]);
    thr_write_close(writer);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

void plan_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals,
                   thr_cords_word word)
{
  const thr_metrics *metrics = &plan->metrics;

  /* The framework, and how many cords are in it. */
  thr_write_hash(writer, "framework", thr_frame_hash(&plan->frame));
  thr_write_int(writer, "nodes", plan->frame.n_nodes);
  thr_write_int(writer, "edges", plan->frame.n_edges);
  thr_write_int(writer, "cords", plan->n_cords);
  thr_write_string(writer, "units", plan->frame.units);

  /* Lengths in units, angles in rad. */
  thr_write_number(writer, "length", metrics->length);
  thr_write_number(writer, "base_length", metrics->base_length);
  thr_write_number(writer, "overlap", metrics->overlap);
  thr_write_number(writer, "lower_bound", plan->proof.lower_bound);
  thr_write_number(writer, "gap", plan->proof.gap);
  thr_write_number(writer, "turning", metrics->turning);
  thr_write_number(writer, "max_turning", metrics->max_turning);
  thr_write_number(writer, "mu", plan->options.physics.mu);
  thr_write_string(writer, "status", plan->proof.optimal ? "optimal" : "bound");
  thr_text proof = {0};
  plain_put_length_proof(&proof, plan);
  if (proof.data && !proof.failed) thr_write_string(writer, "proof", proof.data);
  thr_text_destroy(&proof);

  /* Pulls: as factors on the seating tension, and in N. */
  double factor = NAN, *pull = compute_pulls(writer->out, plan, &factor);
  thr_write_number(writer, "pull_factor", factor);
  thr_write_number(writer, "pull", factor * plan->options.physics.seating);

  thr_eval seated;
  const bool known = !thr_eval_closed_form(plan, plan->options.physics.seating, &seated, NULL);
  if (known) turning_put_ends_json(writer, plan, &seated);
  put_each_cord_json(writer, plan, pull, known ? &seated : NULL);
  thr_eval_destroy(&seated);
  free(pull);

  /* What is proved of the number of cords. */
  if (plan->options.max_pull > 0) thr_write_number(writer, "max_pull", plan->options.max_pull);
  if (plan->pull_claim.present) {
    thr_write_int(writer, "fewest_cords_for_pull", plan->pull_claim.fewest);
    thr_write_string(writer, "fewest_cords_for_pull_status",
                     plan->pull_claim.optimal ? "optimal" : "bound");
  }

  if (plan->cords_claim.present) put_claim_json(writer, plan, word);

  /* What only some plans have. */
  if (plan->options.distinct > 0) thr_write_int(writer, "distinct", metrics->distinct);
  if (plan->n_cords > 1) put_cut_json(writer, plan);
  if (rivals) turning_put_json(writer, plan, rivals);
  if (plan->symmetry.present) symmetry_put_json(writer, plan);

  thr_kit_estimate kit;
  if (estimate_kit(writer->out, plan, &kit)) kit_put_json(writer, &kit);
}
