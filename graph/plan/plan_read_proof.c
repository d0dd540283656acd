/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads the proofs of plan.json: the claims about length, longest cord, number of cords, pull and
 * turning, each with what proves it (docs/plan-format.md).
 *
 * Only shapes, sizes and indices are checked here, so that the checker can follow a proof without
 * looking back at the document. Whether the numbers prove the claim is the checker's business
 * (graph/check).
 *
 * Example: {"status": "optimal", "lower_bound": 12, ..} as proof.length of a plan with solid joints
 * needs a certificate, a list with one packing of odd cuts for each component. */
#include "graph/number.h"
#include "graph/framework/components.h"
#include "graph/plan/plan_fields.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Reads cut i of a certificate of n_cuts. A parent comes later in the list, so that the cuts are a
 * forest. */
static thr_status read_cut(const thr_field_reader *field_reader, const thr_json *value, int i,
                           int n_cuts, const thr_frame *frame, thr_cut *cut)
{
  static const char *const known[] = {"value", "nodes", "parent", NULL};
  const thr_json *nodes;
  thr_status st = thr_field_only(field_reader, value, "proof.length.certificate.cuts", known);
  if (!st)
    st = thr_field_int64(field_reader, value, "value", INT64_MIN, INT64_MAX,
                         &cut->value); /* the checker says what a negative one means */

  cut->parent = -1;
  if (!st && thr_json_get(value, "parent"))
    st = thr_field_int(field_reader, value, "parent", i + 1, n_cuts - 1, &cut->parent);

  /* The nodes of the cut that are in none of its children. */
  if (!st)
    cut->node =
        thr_field_list(field_reader, value, "nodes", sizeof *cut->node, &cut->n_nodes, &nodes, &st);

  return st ? st
            : thr_field_indices(field_reader, nodes, cut->n_nodes, frame->n_nodes,
                                "proof.length.certificate: cuts: nodes", cut->node);
}

/* Reads the prices of places into a new array, which the certificate owns. */
static thr_status read_prices(const thr_field_reader *field_reader, const thr_json *value,
                              thr_certificate *certificate)
{
  const thr_json *list;
  thr_status st;
  certificate->place_price =
      thr_field_list(field_reader, value, "place_prices", sizeof *certificate->place_price,
                     &certificate->n_prices, &list, &st);

  for (int i = 0; i < certificate->n_prices; i++)
    if (!thr_json_int(
            thr_json_at(list, i),
            &certificate->place_price[i])) /* the checker says what a negative one means */
      return thr_field_bad(field_reader, "proof.length.certificate: place_prices",
                           "not all are integers");

  return st;
}

/* Reads the proof of length of one component. */
static thr_status read_certificate(const thr_field_reader *field_reader, const thr_json *value,
                                   const thr_frame *frame, thr_certificate *certificate)
{
  const thr_json *cuts;
  thr_status st = thr_fields_read(field_reader, value, "proof.length.certificate",
                                  thr_certificate_fields, certificate);
  if (!st)
    st = thr_field_int(field_reader, value, "component", 0, frame->n_nodes - 1,
                       &certificate->component);
  if (!st && thr_json_get(value, "place_prices"))
    st = read_prices(field_reader, value, certificate);

  /* The packing of odd cuts. */
  if (!st)
    certificate->cut = thr_field_list(field_reader, value, "cuts", sizeof *certificate->cut,
                                      &certificate->n_cuts, &cuts, &st);
  for (int i = 0; i < certificate->n_cuts && !st; i++)
    st = read_cut(field_reader, thr_json_at(cuts, i), i, certificate->n_cuts, frame,
                  &certificate->cut[i]);

  return st;
}

/* Reads whether a bound is claimed to be attained. */
static thr_status get_status(const thr_field_reader *field_reader, const thr_json *value,
                             const char *place, bool *optimal)
{
  int status;
  thr_status st = thr_field_name(field_reader, value, place, "status", 2, thr_status_name, &status);
  *optimal = status == 1;
  return st;
}

/* Reads the member `slack`: "open" says that the cords may be longer than
 * options.turning.length_slack allows; left out, that limit is proved to be kept. */
static thr_status read_slack(const thr_field_reader *field_reader, const thr_json *value,
                             bool *open)
{
  const thr_json *slack = thr_json_get(value, "slack");
  const char *word = thr_json_string(slack);
  if (slack && (!word || strcmp(word, "open") != 0))
    return thr_field_bad(field_reader, "proof.length.slack", "not \"open\"");
  *open = slack != NULL;
  return THR_OK;
}

/* Reads the claim of least length, with certificates of odd cuts (solid joints) or a tree of
 * multipliers (tube joints). */
static thr_status read_length_proof(const thr_field_reader *field_reader, const thr_json *value,
                                    const thr_frame *frame, thr_length_proof *proof)
{
  static const char *const solid[] = {"status", "lower_bound", "slack", "gap",
                                      "method", "certificate", "walks", NULL};
  static const char *const tube[] = {"status", "lower_bound", "slack", "gap",
                                     "method", "proof",       NULL};
  const thr_json *list, *tied = thr_json_get(value, "proof");
  char place[256];

  /* What is claimed. */
  thr_status st = thr_field_only(field_reader, value, "proof.length", tied ? tube : solid);
  if (!st) st = get_status(field_reader, value, "proof.length", &proof->optimal);
  if (!st) st = thr_field_amount(field_reader, value, "lower_bound", &proof->lower_bound);
  if (!st) st = read_slack(field_reader, value, &proof->slack_open);
  if (!st) st = thr_field_amount(field_reader, value, "gap", &proof->gap);
  if (!st) proof->present = true;

  /* With tube joints a tree of multipliers proves the bound. */
  if (!st && tied) {
    snprintf(place, sizeof place, "%.200s: proof.length.proof", field_reader->name);
    return thr_turning_proof_from_json(&proof->tied, frame, tied, place, field_reader->err);
  }

  /* With solid joints there is a certificate for each component. */
  if (!st)
    proof->certificate =
        thr_field_list(field_reader, value, "certificate", sizeof *proof->certificate,
                       &proof->n_certificates, &list, &st);
  for (int i = 0; i < proof->n_certificates && !st; i++)
    st = read_certificate(field_reader, thr_json_at(list, i), frame, &proof->certificate[i]);
  if (st) return st;

  /* Where the pull is limited, prices of walks may prove the bound. */
  snprintf(place, sizeof place, "%.200s: proof.length.walks", field_reader->name);

  return thr_walk_proof_from_json(&proof->pulled, frame, NULL, thr_json_get(value, "walks"), place,
                                  field_reader->err);
}

/* Reads the turn above which no turn counts for more, in units of 2^-THR_TURNING_BITS rad; may be
 * left out. place: of the member, for messages. */
static thr_status read_free_turn(const thr_field_reader *field_reader, const thr_json *value,
                                 const char *place, int64_t *cut)
{
  const int64_t most = (int64_t)floor(ldexp(THR_PI, THR_TURNING_BITS));
  const thr_json *stated = thr_json_get(value, "cut");

  if (stated && (!thr_json_int(stated, cut) || *cut < 1 || *cut > most))
    return thr_field_bad(field_reader, place,
                         "not a turn of at most 180 degrees in units of 2^-44");
  return THR_OK;
}

/* Reads the claim of least turning, with the tree of multipliers that proves it. */
static thr_status read_turning_claim(const thr_field_reader *field_reader, const thr_json *value,
                                     thr_plan *plan)
{
  char place[256];
  thr_status st =
      thr_fields_read(field_reader, value, "proof.turning", thr_turning_claim_fields, plan);
  if (st) return st;

  snprintf(place, sizeof place, "%.200s: proof.turning.proof", field_reader->name);
  plan->turning.present = true;

  return thr_turning_proof_from_json(&plan->turning.tree, &plan->frame,
                                     thr_json_get(value, "proof"), place, field_reader->err);
}

/* Reads the claims about the longest cord and the number of cords, with the prices of walks that
 * prove them. */
static thr_status read_cords_claim(const thr_field_reader *field_reader, const thr_json *object,
                                   thr_plan *plan)
{
  thr_walk_proof *walks = &plan->proof.walks;
  thr_status st =
      thr_fields_read(field_reader, object, "proof.cords", thr_cords_claim_fields, plan);
  plan->cords_claim.present = !st;

  /* Prices of walks by length; `sets` says that all sets of edges were tried as well. */
  char place[256];
  snprintf(place, sizeof place, "%.200s: proof.cords.walks", field_reader->name);
  if (!st)
    st = thr_walk_proof_from_json(walks, &plan->frame, "length", thr_json_get(object, "walks"),
                                  place, field_reader->err);
  const thr_json *sets = thr_json_get(object, "sets");
  if (!st && sets && (thr_json_typeof(sets) != THR_JSON_BOOL || !thr_json_true(sets)))
    st = thr_field_bad(field_reader, "proof.cords.sets", "true, or left out");
  walks->sets = sets;

  return st;
}

/* Reads the members that every claim of the number of cords has, of the whole framework or of a
 * component. */
static thr_status read_fewest(const thr_field_reader *field_reader, const thr_json *value,
                              const char *name, const char *const *known, thr_pull_claim *claim)
{
  thr_status st = thr_field_only(field_reader, value, name, known);

  if (!st) st = get_status(field_reader, value, name, &claim->optimal);
  if (!st) st = thr_field_int(field_reader, value, "lower_bound", 1, INT32_MAX, &claim->fewest);
  claim->present = !st;
  return st;
}

/* Reads the claim that fewer cords exceed the pull. The proof is a tree of multipliers, prices of
 * walks, or the edges alone, which takes no numbers. */
static thr_status read_pull_claim(const thr_field_reader *field_reader, const thr_json *value,
                                  const char *name, const thr_frame *frame, thr_pull_claim *claim)
{
  static const char *const by_tree[] = {"status", "lower_bound", "excluded", "most_passes",
                                        "cut",    "proof",       NULL};
  static const char *const by_walks[] = {"status", "lower_bound", "excluded", "walks", NULL};
  static const char *const by_edges[] = {"status", "lower_bound", "excluded", NULL};
  const thr_json *proof = thr_json_get(value, "proof"), *walks = thr_json_get(value, "walks");
  char place[256], cut[64];

  /* Status and bound; which members there may be depends on the proof. */
  thr_status st = read_fewest(field_reader, value, name,
                              walks   ? by_walks
                              : proof ? by_tree
                                      : by_edges,
                              claim);
  if (st || (!proof && !walks && !thr_json_get(value, "excluded"))) return st;

  /* The number of cords that is excluded. */
  st = thr_field_int(field_reader, value, "excluded", 1, THR_MOST_CORDS, &claim->excluded);
  snprintf(place, sizeof place, "%.200s: %.32s.walks", field_reader->name, name);

  if (st || walks)
    return st ? st
              : thr_walk_proof_from_json(&claim->walks, frame, NULL, walks, place,
                                         field_reader->err);

  /* A tree: among which plans it was grown. */
  if (!proof) return THR_OK;
  st = thr_field_int(field_reader, value, "most_passes", 1, INT32_MAX, &claim->most_passes);
  snprintf(cut, sizeof cut, "%.32s.cut", name);
  if (!st) st = read_free_turn(field_reader, value, cut, &claim->cut);
  if (st) return st;

  snprintf(place, sizeof place, "%.200s: %.32s.proof", field_reader->name, name);

  return thr_turning_proof_from_json(&claim->tree, frame, proof, place, field_reader->err);
}

/* Reads such a claim for every component, in the order of the components. */
static thr_status read_pull_parts(const thr_field_reader *field_reader, const thr_json *list,
                                  const thr_plan *plan, thr_pull_claim *claim)
{
  thr_components components;
  thr_status st = thr_components_init(&components, &plan->frame, &plan->options, field_reader->err);

  const int n = st ? 0 : components.n;
  if (!st && (plan->options.old_pull || n > THR_MOST_PULL_PARTS || thr_json_size(list) != n))
    st = thr_field_bad(field_reader, "proof.pull.parts",
                       "one for each of at most 100 components, with version 2");

  if (!st && !(claim->part = thr_calloc((size_t)n, sizeof *claim->part)))
    st = thr_nomem(field_reader->err);

  /* The sizes of a proof are those of the component taken by itself. */
  for (int k = 0; k < n && !st; k++) {
    char name[64];
    const thr_json *part = thr_json_at(list, k);
    thr_plan alone;
    snprintf(name, sizeof name, "proof.pull.parts[%d]", k);
    if (thr_json_typeof(part) != THR_JSON_OBJECT)
      st = thr_field_bad(field_reader, name, "an object");

    if (!st) st = thr_component_take(&components, k, &alone, field_reader->err);
    if (st) break;

    /* The part counts before it is read, so that a failure releases it. */
    claim->n_parts = k + 1;
    claim->part[k].n_nodes = alone.frame.n_nodes;
    claim->part[k].n_edges = alone.frame.n_edges;
    st = read_pull_claim(field_reader, part, name, &alone.frame, &claim->part[k]);
    thr_plan_destroy(&alone);
  }
  thr_components_destroy(&components);

  return st;
}

/* Reads the claim about the number of cords within the pull: of the whole framework, or of each
 * component. */
static thr_status read_whole_pull_claim(const thr_field_reader *field_reader, const thr_json *value,
                                        thr_plan *plan)
{
  static const char *const by_parts[] = {"status", "lower_bound", "parts", NULL};
  thr_pull_claim *claim = &plan->pull_claim;
  const thr_json *parts;

  if (!thr_json_get(value, "parts"))
    return read_pull_claim(field_reader, value, "proof.pull", &plan->frame, claim);

  thr_status st = read_fewest(field_reader, value, "proof.pull", by_parts, claim);
  if (!st) st = thr_field_need(field_reader, value, "parts", THR_JSON_ARRAY, &parts);

  return st ? st : read_pull_parts(field_reader, parts, plan, claim);
}

/* Drops what a plan of version 1 proves within its limit on the pull: such proofs are about cords
 * that a pass parts, and are not verified any more. Dropped are the number of cords, and the length
 * if it rests on prices of walks within the pull, with a turning that is limited by such a length.
 */
static void leave_out_older_pull(thr_plan *plan)
{
  const bool by_walks = plan->proof.present && plan->proof.pulled.unit > 0;

  plan->left_out = plan->pull_claim.present || by_walks;
  plan->pull_claim.present = false;

  if (!by_walks) return;
  plan->proof.present = plan->cords_claim.present = false;
  if (plan->turning.length_limit >= 0) plan->turning.present = false;
}

/* A claim of turning is allowed only with the objective that asks for little turning, since a proof
 * says that no plan with the same options is better. */
thr_status thr_plan_read_proofs(const thr_field_reader *field_reader, const thr_json *doc,
                                thr_plan *plan)
{
  static const char *const of_length[] = {"length", "cords", "pull", NULL}, *const of_turning[] = {
                                                                                "length", "cords",
                                                                                "pull", "turning",
                                                                                NULL};
  const int without = field_reader->without;
  const thr_json *all;
  thr_status st = thr_field_need(field_reader, doc, "proof", THR_JSON_OBJECT, &all);
  if (!st)
    st = thr_field_only(field_reader, all, "proof",
                        thr_wants_turning(&plan->options) ? of_turning : of_length);

  /* Each claim may be left out, or passed over at the caller's wish. */
  const thr_json *length = thr_json_get(all, "length"), *turning = thr_json_get(all, "turning"),
                 *cords = thr_json_get(all, "cords"), *pull = thr_json_get(all, "pull");
  if (!st && length && !(without & THR_CLAIM_LENGTH))
    st = read_length_proof(field_reader, length, &plan->frame, &plan->proof);
  if (!st && cords && !(without & THR_CLAIM_CORDS))
    st = read_cords_claim(field_reader, cords, plan);
  if (!st && pull && !(without & THR_CLAIM_PULL))
    st = read_whole_pull_claim(field_reader, pull, plan);
  if (!st && turning && !(without & THR_CLAIM_TURNING))
    st = read_turning_claim(field_reader, turning, plan);

  if (!st && plan->options.old_pull) leave_out_older_pull(plan);

  return st;
}
