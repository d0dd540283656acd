/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the terms of a plan's claims: among which plans it is the best, which statements are
 * verified, and which nobody can verify.
 *
 * A proof without its terms can be taken for more than it is: "nothing shorter exists" holds for so
 * many cords, with ends at these nodes, so many passes over an edge, and joints of one kind. The
 * bounds of the limit analysis hold for the beads, cords, frictions, ground and loads that are
 * stated with them.
 *
 * Example:
 *
 *    terms: closed cords; 1 pass of every edge or more; 1 cord; solid joints
 *    cord at most 5 % above the least length: verified */
#include "cli/print/print.h"
#include "graph/number.h"

#include <ctype.h>

/* Returns the number of nodes where cords may end. */
static int count_end_nodes(const thr_plan *plan)
{
  int n = 0;
  for (int v = 0; v < plan->frame.n_nodes; v++)
    n += thr_plan_end_allowed(&plan->frame, &plan->options, v);
  return n;
}

/* Appends where cords may end. */
static void put_ends(thr_text *text, const thr_plan *plan)
{
  int n = count_end_nodes(plan);

  /* Closed cords, ends anywhere, at the feet, or at given nodes. */
  switch (plan->options.ends) {
  case THR_ENDS_CLOSED: thr_text_append(text, "closed cords"); break;
  case THR_ENDS_ANY: thr_text_append(text, "cord ends at any node"); break;
  case THR_ENDS_FEET:
    thr_text_printf(text, "cord ends at the %d %s", n, cli_plural(n, "foot", "feet"));
    break;
  case THR_ENDS_NODES:
    thr_text_printf(text, "cord ends at %d given %s", n, cli_plural(n, "node", "nodes"));
    break;

  /* THR_ENDS_COUNTS: so many ends at each of these nodes. */
  default:
    thr_text_printf(text, "given numbers of cord ends at %d %s", n, cli_plural(n, "node", "nodes"));
  }
}

/* Appends how often edges are passed: at least, by different cords, at most. */
static void put_passes(thr_text *text, const thr_plan *plan)
{
  const thr_request *options = &plan->options;

  thr_text_printf(text, "; %d %s of every edge or more", options->cover,
                  cli_plural(options->cover, "pass", "passes"));
  if (plan->frame.cover) thr_text_append(text, ", as the framework says");
  if (options->distinct) thr_text_printf(text, ", by %d different cords", options->distinct);

  /* Upper limits, of the request or of the framework. */
  if (options->capacity) thr_text_printf(text, ", at most %d", options->capacity);
  if (plan->frame.capacity)
    thr_text_append(text, options->capacity ? " or what the framework allows"
                                            : ", at most what the framework allows");
}

/* Appends how many cords there may be in each component, and what limits single cords. */
static void put_number(thr_text *text, const thr_plan *plan)
{
  const thr_request *options = &plan->options;
  int components = thr_plan_components(plan), least = thr_plan_cords_least(options);

  if (options->ends == THR_ENDS_COUNTS)
    thr_text_printf(text, "; %d %s", plan->n_cords, cli_plural(plan->n_cords, "cord", "cords"));
  else if (least < options->cords)
    thr_text_printf(text, "; %d to %d cords", least, options->cords);
  else
    thr_text_printf(text, "; %d %s", options->cords, cli_plural(options->cords, "cord", "cords"));

  /* Given numbers of ends say how many cords each component has. */
  if (components > 1 && options->ends != THR_ENDS_COUNTS)
    thr_text_printf(text, " in each of %d components", components);

  /* Limits on single cords. A pull is a factor on the seating tension. */
  if (options->max_length > 0)
    thr_text_printf(text, ", none longer than %.12g %s", options->max_length, plan->frame.units);
  if (options->max_pull > 0)
    thr_text_printf(text, ", none that needs more than %.6g times the seating tension at mu = %g",
                    options->max_pull, options->physics.mu);
}

/* Returns the least number of passes over an edge that any tree of a claim, or of one of its parts,
 * is about; 0: there is no tree. */
static int most_passes(const thr_pull_claim *claim)
{
  int most = claim->tree.n_nodes > 0 ? claim->most_passes : 0;

  /* A claim of several components has a part for each; the strictest one counts. */
  for (int k = 0; k < claim->n_parts; k++) {
    const int of_part = most_passes(&claim->part[k]);
    if (of_part > 0 && (most == 0 || of_part < most)) most = of_part;
  }

  return most;
}

/* Appends to which threadings the proofs of turning and of the fewest cords are restricted. */
static void put_kind(thr_text *text, const thr_plan *plan)
{
  const int most = most_passes(&plan->pull_claim);

  if (most > 0) thr_text_printf(text, "; for the fewest cords: at most %d passes of an edge", most);
  if (!plan->turning.present) return;

  /* Turning is proved without U-turns at nodes with more than one edge. */
  thr_text_printf(
      text, "; for the turning: at most %d passes of an edge, back only at nodes with one edge%s",
      plan->turning.most_passes, thr_wants_pull(&plan->options) ? " (for the pull anywhere)" : "");
  if (plan->turning.length_limit >= 0)
    thr_text_printf(text, ", at most %.6f %s", plan->turning.length_limit, plan->frame.units);
}

/* Appends all terms: among which plans the claims of this one hold. */
static void put_plans(thr_text *text, const thr_plan *plan)
{
  put_ends(text, plan);
  put_passes(text, plan);
  put_number(text, plan);
  thr_text_append(text, plan->options.joint == THR_JOINT_TUBE ? "; tube joints" : "; solid joints");

  if (plan->frame.own_lengths)
    thr_text_append(text, "; lengths of edges as given, not from their nodes");
  put_kind(text, plan);
}

/* Returns whether length was limited to a part above the shortest plan, for a plan of least
 * turning. */
static bool is_slack_asked(const thr_plan *plan)
{
  return thr_wants_turning(&plan->options) && plan->options.turning.length_slack >= 0;
}

/* Returns whether that limit is verified: the proof of length states a least length that is enough
 * for it. */
static bool is_slack_proved(const thr_plan *plan)
{
  return plan->proof.present && !plan->proof.slack_open;
}

/* Returns whether the tensions of the plan's evaluation were measured, or follow from turns that
 * nobody verifies. */
static bool is_measured(const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  return evaluation->present && evaluation->method != THR_CAPSTAN &&
         (!evaluation->standing.present || evaluation->standing.taut);
}

/* Returns whether a row of a table of symmetries was asked for by its number, which says nothing
 * without the table. */
static bool is_row_asked(const thr_plan *plan)
{
  return thr_wants_symmetry(&plan->options) &&
         isdigit((unsigned char)plan->options.symmetry.group[0]);
}

/* Appends how the cords are drawn in: "2 cords pulled at both ends, 1 slack". */
static void put_drawn(thr_text *text, const thr_standing *standing)
{
  static const struct {
    thr_pull pull;
    const char *words;
  } way[] = {{THR_PULL_BOTH, "pulled at both ends"},
             {THR_PULL_START, "pulled at the start"},
             {THR_PULL_END, "pulled at the end"},
             {THR_PULL_NONE, "slack"}};
  const char *between = "; ";

  for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
    /* Cords that are drawn in the same way are counted together. */
    int n = 0;
    for (int k = 0; k < standing->n_cords; k++)
      n += standing->drawn[k].pull == (int)way[i].pull;

    if (n == 0) continue;
    thr_text_printf(text, "%s%d %s %s", between, n, cli_plural(n, "cord", "cords"), way[i].words);
    between = ", ";
  }
}

/* Appends a load: "(0, 0, -1) N at D4". Adding 0.0 makes -0 print as 0. */
static void put_force(thr_text *text, const thr_load *load, const thr_plan *plan)
{
  thr_text_printf(text, "(%.6g, %.6g, %.6g) N at ", load->force[0] + 0.0, load->force[1] + 0.0,
                  load->force[2] + 0.0);
  thr_text_append_clean(text, plan->frame.name[load->node]);
}

/* Appends a step of a schedule in the words of --schedule. */
static void put_step(thr_text *text, const thr_plan *plan, const thr_schedule_step *step)
{
  thr_text_printf(text, "%s %s", plan->cord[step->cord].id, thr_deed_name(step->deed));

  /* Forces in N, a knot's slip in mm; passes are counted from 1. */
  if (step->deed == THR_DEED_GRIP)
    thr_text_printf(text, " %d %.6g from", step->pass + 1, step->force + 0.0);
  if (step->deed != THR_DEED_NONE) thr_text_printf(text, " %s", thr_pull_name(step->end));
  if (step->deed == THR_DEED_PULL || step->deed == THR_DEED_RELEASE)
    thr_text_printf(text, " %.6g", step->force + 0.0);
  if (step->deed == THR_DEED_KNOT && step->slip > 0) thr_text_printf(text, " %.6g", step->slip);
}

/* Appends all that the answers of the limit analysis depend on: beads, cords, frictions, feet,
 * gravity, how cords are drawn in, and what is done to them. */
static void put_structure(thr_text *text, const thr_plan *plan)
{
  enum { MOST_LOADS = 8, MOST_STEPS = 24 };
  const thr_schedule *schedule = &plan->evaluation.schedule;
  const thr_standing *standing = &plan->evaluation.standing;
  const thr_physics *physics = &plan->evaluation.physics;

  /* The mass of a bead is given, or follows from the density. */
  if (physics->bead_mass > 0)
    thr_text_printf(text, "beads of %.6g g", physics->bead_mass);
  else
    thr_text_printf(text, "beads of %.6g g/cm3", physics->density);

  /* In model 1 a cord is in the middle of its bore, from model 2 on anywhere in it. */
  thr_text_printf(text, ", %.6g mm wide, ", physics->bead_diameter);
  if (standing->model > 1)
    thr_text_printf(text, "cords of %.6g mm anywhere in bores of %.6g mm", physics->cord_diameter,
                    physics->bore);
  else
    thr_text_printf(text, "cords in the middle of bores of %.6g mm", physics->bore);

  /* Frictions and turns. */
  thr_text_printf(text, "; friction %.6g of beads, %.6g of the ground, %.6g of cords",
                  physics->mu_bead, physics->mu_ground, physics->mu);
  if (physics->wobble > 0) thr_text_printf(text, " and %.6g rad/m of wobble", physics->wobble);
  thr_text_append(text, standing->taut ? "; turns of the tight cords"
                                       : "; turns in the middles of the beads");

  /* Feet and ground. */
  thr_text_append(text, standing->clamped     ? "; feet are held"
                        : standing->model > 1 ? "; feet stand on discs"
                                              : "; feet stand on squares");
  if (standing->tilt > 0)
    thr_text_printf(text, " on ground that leans by %.6g degrees towards %.6g",
                    thr_degrees(standing->tilt), thr_degrees(standing->azimuth) + 0.0);
  thr_text_printf(text, "; gravity %.6g m/s2", physics->gravity + 0.0);

  /* How cords are drawn in, and the schedule. */
  put_drawn(text, standing);

  for (int i = 0; i < schedule->n && i < MOST_STEPS; i++) {
    thr_text_append(text, i ? ", " : "; schedule ");
    put_step(text, plan, &schedule->step[i]);
  }

  if (schedule->n > MOST_STEPS) thr_text_printf(text, " and %d more", schedule->n - MOST_STEPS);

  /* What knotted cords bear, and loads. */
  if (standing->strength > 0)
    thr_text_printf(text, "; knotted cords bear %.6g N", standing->strength);
  for (int i = 0; i < standing->n_loads && i < MOST_LOADS; i++) {
    thr_text_append(text, i ? ", " : "; load ");
    put_force(text, &standing->load[i], plan);
  }

  if (standing->n_loads > MOST_LOADS)
    thr_text_printf(text, " and %d more", standing->n_loads - MOST_LOADS);
}

/* Appends the terms of the limit analysis and a line for each of its answers that a mechanism
 * proves: "below 4.14 N at the harder ends, .. nothing holds it: verified". */
static void put_standing(thr_text *text, const thr_plan *plan)
{
  static const char *const below[] = {
      [THR_ASKED_HOLDING] = "N at the harder ends, while the cords are drawn in, nothing holds it",
      [THR_ASKED_EQUAL] = "N at all ends, while the cords are drawn in, nothing holds it",
      [THR_ASKED_ANY_STATE] =
          "N at all ends, whatever was done to the cords before, nothing holds it",
      [THR_ASKED_AFTER] = "of the tensions that the schedule leaves nothing holds it",
      [THR_ASKED_STRETCH] = "N m, by which the tension of knotted cord grows x its length, nothing "
                            "holds it after the schedule",
      [THR_ASKED_TIGHTEST] = "N in every pass of knotted cord nothing holds it after the schedule",
      [THR_ASKED_LOADED] =
          "N at all ends, while the cords are drawn in, it does not carry the load"};
  const thr_standing *standing = &plan->evaluation.standing;

  if (!standing->present) return;

  thr_text_append(text, "  terms of the structure: ");
  put_structure(text, plan);
  thr_text_append(text, "\n");

  for (int i = 0; i < standing->n_answers; i++) {
    const thr_answer *answer = &standing->answer[i];

    /* Without a mechanism nothing is proved. */
    if (answer->n_beads == 0) continue;

    /* Of a pull, a factor or a stretch the proof is a lower bound, of a load an upper one. */
    if (!thr_asked_of_load(answer->asked))
      thr_text_printf(text, "  below %.6g %s: verified\n", answer->proved, below[answer->asked]);
    else if (answer->asked == THR_ASKED_CARRIED)
      thr_text_printf(text,
                      "  %.6g N at all ends carry no more than %.4g times the load: verified\n",
                      answer->pull, answer->proved);
    else
      thr_text_printf(
          text, "  after the schedule it carries no more than %.4g times the load: verified\n",
          answer->proved);
  }

  /* What was found by the solver has no proof in the plan. */
  thr_text_append(text,
                  "  not verified: that the equilibria which the limit analysis found exist\n");
}

/* Returns whether a plan of version 1 says anything of pulls at both ends. Such a plan parts a cord
 * at a pass, which both ends have to reach, and asks for more than is needed. */
static bool is_of_older_pull(const thr_plan *plan)
{
  bool says = plan->options.max_pull > 0 || plan->evaluation.standing.present;
  for (int i = 0; i < plan->evaluation.n_cords; i++)
    says |= plan->evaluation.cord[i].pull == THR_PULL_BOTH && plan->evaluation.schedule.n == 0;
  return says && plan->options.old_pull;
}

void terms_put(thr_text *text, const thr_plan *plan)
{
  /* Among which plans. */
  thr_text_append(text, "  terms: ");
  put_plans(text, plan);
  thr_text_append(text, "\n");

  /* What was asked for with a limit or a number. */
  if (is_slack_asked(plan))
    thr_text_printf(text, "  cord at most %g %% above the least length: %s\n",
                    100 * plan->options.turning.length_slack + 0.0,
                    is_slack_proved(plan) ? "verified" : "not verified");
  if (is_row_asked(plan))
    thr_text_printf(text, "  not verified: that the group is row %s of a table of symmetries\n",
                    plan->options.symmetry.group);

  /* A member of older plans, which no checker reads. */
  if (plan->turning.pairing_bound > 0) {
    thr_text_append(text, "  not verified: pairing_bound, which plans no longer state\n");
  }

  /* Turns and tensions. */
  if (is_measured(plan) && plan->evaluation.standing.taut)
    thr_text_append(text,
                    "  not verified: the turns of the tight cords; what follows from them is\n");
  else if (is_measured(plan))
    thr_text_printf(
        text, "  not verified: the tensions, which method %s measured; what follows from them is\n",
        thr_method_name(plan->evaluation.method));

  /* Plans of older versions. */
  if (plan->left_out) {
    thr_text_append(
        text, "  not verified: what a plan of version 1 proves within its limit on the pull\n");
  }

  if (is_of_older_pull(plan))
    thr_text_append(text, "  pulls at both ends are those of plans of version 1, which ask both "
                          "for the pass in the middle: more than is needed\n");

  put_standing(text, plan);
}

void terms_put_json(thr_writer *writer, const thr_plan *plan)
{
  thr_text words = {0};

  put_plans(&words, plan);
  thr_write_words(writer, "terms", &words);
  if (plan->evaluation.standing.present) {
    thr_text structure = {0};
    put_structure(&structure, plan);
    thr_write_words(writer, "structure_terms", &structure);
  }

  /* What is verified and what is not. */
  if (is_slack_asked(plan)) {
    thr_write_printf(writer, "length_slack", "%.12g", plan->options.turning.length_slack);
    thr_write_bool(writer, "slack_verified", is_slack_proved(plan));
  }

  if (plan->evaluation.present) thr_write_bool(writer, "tensions_verified", !is_measured(plan));
  if (is_of_older_pull(plan)) thr_write_int(writer, "pulls_of_version", 1);
}
