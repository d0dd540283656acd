/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what `thread check` has verified of a plan: a line with every claim and its proof, among
 * which plans the claims hold (terms.c), and with --verbose what the proofs are made of.
 *
 * Example: "a.json: holds: 1 cord, 96 passes, every edge covered, 1995.249 mm: proved: nothing
 * shorter exists". */
#include "cli/print/print.h"
#include "graph/number.h"
#include "graph/plan/turning_proof.h"

#include <inttypes.h>

/* Appends what is verified of the turning of a plan that was made for it. Whether its length is the
 * shortest or not is another claim. */
static void put_turning(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;
  const char *cost = thr_turn_cost_name(plan->options.turning.cost);
  bool angles = plan->options.turning.cost == THR_TURN_ANGLE;

  if (!thr_wants_turning(&plan->options)) return;
  thr_text_printf(text, "; turning %.1f deg: ", thr_degrees(plan->metrics.turning));

  if (!claim->present) {
    thr_text_append(text, "nothing is claimed");
    return;
  }

  /* All cords together. */
  if (!angles) thr_text_printf(text, "price %.9g (%s), ", claim->price, cost);

  /* Optimal, or by how much the price may be above the least. */
  plain_put_turning_proof(text, plan);
  if (plan->n_cords == 1 && !thr_wants_largest(&plan->options)) return;

  /* The largest cord, as the request measures it: by pull, turning or price. */
  const bool pull = thr_wants_pull(&plan->options);
  thr_text_printf(text,
                  pull     ? "; the cord that is hardest to pull, %.1f deg before an end: "
                  : angles ? "; the cord that turns most, %.1f deg: "
                           : "; the dearest cord, %.6g: ",
                  angles ? thr_degrees(claim->largest) : claim->largest);
  plain_put_largest_proof(text, plan);
}

/* Appends the group of a symmetric plan and what is to be learned. */
static void put_symmetry(thr_text *text, const thr_plan *plan)
{
  const thr_symmetry_record *record = &plan->symmetry;
  if (!record->present) return;
  thr_text_printf(text, "; group %s%sof order %d, %d unique %s, %g learned steps", record->name,
                  record->name[0] ? " " : "", record->order, record->unique_paths,
                  cli_plural(record->unique_paths, "path", "paths"), record->steps);
}

/* Appends what is verified of several cords where the plan was asked for it: the longest one, the
 * fewest possible, tied joints. */
static void put_cords(thr_text *text, const thr_plan *plan)
{
  const thr_cords_claim *claim = &plan->cords_claim;

  if (claim->present && thr_wants_balance(&plan->options)) {
    thr_text_printf(text, "; longest cord %.7g %s: ", claim->longest, plan->frame.units);
    plain_put_proof(text, claim->longest_optimal, claim->longest, claim->longest_bound,
                    "it can be no shorter", "shortest possible");
  }

  /* Fewer cords: whatever their pull, and within a limit on it. */
  if (claim->present) plain_put_fewest(text, plan, claim->fewest, " cords", "");
  if (plan->pull_claim.present)
    plain_put_fewest(text, plan, plan->pull_claim.fewest, " cords", " within that pull");
  if (plan->options.joint == THR_JOINT_TUBE) thr_text_append(text, "; every joint tied");
}

/* Appends, with --verbose, what the checker has added up: cuts of the length proof, branchings and
 * multipliers of the proof of turning. */
static void put_machinery(thr_text *text, const thr_plan *plan)
{
  const thr_turning_proof *tree = &plan->turning.tree;
  int cuts = thr_length_proof_cuts(&plan->proof), branchings = tree->n_nodes / 2;

  if (!cli_verbose || !plan->proof.present) return;

  thr_text_printf(text, "  certificate: %d %s, at least %.6f %s", cuts, cli_cuts_word(plan, cuts),
                  plan->proof.lower_bound, plan->frame.units);

  /* A branching has two children: b branchings make a tree of 2 b + 1 nodes. */
  if (plan->turning.present)
    thr_text_printf(text, "; of the turning: %d %s, %d %s", branchings,
                    cli_plural(branchings, "branching", "branchings"), tree->n_duals,
                    cli_plural(tree->n_duals, "multiplier set", "multiplier sets"));
  thr_text_append(text, "\n");
}

/* Appends, with --verbose and solid joints, how many pieces hold channels that cross inside
 * them. */
static void put_crossings(thr_text *text, const thr_plan *plan)
{
  thr_channels channels = {0};

  if (!cli_verbose || plan->options.joint != THR_JOINT_SOLID) return;

  /* A failure is reported by whoever writes the text. */
  if (thr_channels_make(&channels, plan, NULL))
    text->failed = true;
  else
    thr_text_printf(text,
                    "  pieces: %d, %d of them with cords that cross inside (%" PRId64 " %s)\n",
                    plan->frame.n_nodes, channels.crossed, channels.crossings,
                    cli_plural((int)channels.crossings, "crossing", "crossings"));
  thr_channels_destroy(&channels);
}

void verdict_put(thr_text *text, const char *path, const thr_plan *plan)
{
  const thr_metrics *metrics = &plan->metrics;
  const char *units = plan->frame.units;

  thr_text_append_clean(text, path);
  thr_text_printf(text, ": holds: %d %s, %d passes, every edge covered, %.7g %s: ", plan->n_cords,
                  cli_plural(plan->n_cords, "cord", "cords"), metrics->passes, metrics->length,
                  units);

  /* Every claim with its proof. */
  if (plan->proof.present)
    plain_put_length_proof(text, plan);
  else
    thr_text_append(text, "nothing is claimed");
  put_cords(text, plan);
  put_turning(text, plan);
  put_symmetry(text, plan);
  thr_text_append(text, "\n");

  /* Among which plans the claims hold. */
  terms_put(text, plan);
  put_machinery(text, plan);
  put_crossings(text, plan);
}

/* Writes the claim on the turning, rad, and on the price of all turns. */
static void put_turning_json(thr_writer *writer, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;

  thr_write_number(writer, "turning", plan->metrics.turning);

  /* Bounds are on the price, which may be another measure than the angle. */
  if (!claim->present) return;
  thr_write_string(writer, "turning_status", claim->optimal ? "optimal" : "bound");
  thr_write_number(writer, "price", claim->price);
  thr_write_number(writer, "price_lower_bound", claim->lower_bound);
  thr_write_number(writer, "turning_gap", claim->gap);
  if (claim->length_limit >= 0) thr_write_number(writer, "length_limit", claim->length_limit);
}

/* Writes the claims on the longest cord and on the number of cords. */
static void put_cords_json(thr_writer *writer, const thr_cords_claim *claim)
{
  thr_write_number(writer, "longest", claim->longest);
  thr_write_number(writer, "longest_lower_bound", claim->longest_bound);
  if (claim->fewest > 0) thr_write_int(writer, "fewest_cords", claim->fewest);
}

/* Writes the group of a symmetric plan and what is to be learned. */
static void put_symmetry_json(thr_writer *writer, const thr_symmetry_record *record)
{
  thr_write_int(writer, "group_order", record->order);
  thr_write_int(writer, "unique_paths", record->unique_paths);
  thr_write_number(writer, "learned_steps", record->steps);
}

/* Writes all claims of a plan that holds. */
static void put_claims_json(thr_writer *writer, const thr_plan *plan)
{
  thr_write_number(writer, "length", plan->metrics.length);
  if (plan->proof.present) {
    thr_write_string(writer, "status", plan->proof.optimal ? "optimal" : "bound");
    thr_write_number(writer, "lower_bound", plan->proof.lower_bound);
    thr_write_number(writer, "gap", plan->proof.gap);
  }

  /* What only some plans claim. */
  if (plan->cords_claim.present) put_cords_json(writer, &plan->cords_claim);
  if (plan->pull_claim.present)
    thr_write_int(writer, "fewest_cords_for_pull", plan->pull_claim.fewest);

  /* Turning, symmetry, and the terms of all claims. */
  if (thr_wants_turning(&plan->options)) put_turning_json(writer, plan);
  if (plan->symmetry.present) put_symmetry_json(writer, &plan->symmetry);
  terms_put_json(writer, plan);
}

void verdict_put_json(thr_text *text, const char *path, const thr_plan *plan, const thr_err *err,
                      int code)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "plan", path);
  thr_write_bool(&writer, "ok", !err->code);

  /* A violation is about the plan, an error about this run. */
  if (err->code)
    thr_write_string(&writer, err->code == THR_EVIOLATED ? "violation" : "error", err->text);
  if (err->code)
    thr_write_int(&writer, "code", code);
  else
    put_claims_json(&writer, plan);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}
