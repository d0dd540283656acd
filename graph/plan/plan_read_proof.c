/* plan.json, read: proofs. */
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_fields.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <stdio.h>
#include <string.h>

static const char *status_name(int i)
{
  return i ? "optimal" : "bound";
}

static thr_status read_cut(const thr_field_reader *r, const thr_json *v, int i, int n_cuts, const thr_frame *f, thr_cut *cut)
{
  static const char *const known[] = {"value", "nodes", "parent", NULL};
  const thr_json *nodes;
  thr_status st = thr_field_only(r, v, "proof.length.certificate.cuts", known);
  if (!st)
    st = thr_field_int64(r, v, "value", INT64_MIN, INT64_MAX, &cut->value); /* the checker says what a negative one means */
  cut->parent = -1;
  if (!st && thr_json_get(v, "parent")) st = thr_field_int(r, v, "parent", i + 1, n_cuts - 1, &cut->parent);
  if (!st) st = thr_field_need(r, v, "nodes", THR_JSON_ARRAY, &nodes);
  if (st) return st;
  int n = thr_json_size(nodes);
  if (!(cut->node = thr_calloc((size_t)n, sizeof *cut->node))) return thr_nomem(r->err);
  cut->n_nodes = n;
  for (int j = 0; j < n; j++)
    if ((st = thr_field_index(r, nodes, j, f->n_nodes, "proof.length.certificate: cuts: nodes", &cut->node[j]))) return st;
  return THR_OK;
}

static thr_status read_prices(const thr_field_reader *r, const thr_json *v, thr_certificate *c)
{
  const thr_json *list;
  thr_status st = thr_field_need(r, v, "place_prices", THR_JSON_ARRAY, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(c->place_price = thr_calloc((size_t)n, sizeof *c->place_price))) return thr_nomem(r->err);
  c->n_prices = n;
  for (int i = 0; i < n; i++)
    if (!thr_json_int(thr_json_at(list, i), &c->place_price[i])) /* the checker says what a negative one means */
      return thr_field_bad(r, "proof.length.certificate: place_prices", "not all are integers");
  return THR_OK;
}

static thr_status read_certificate(const thr_field_reader *r, const thr_json *v, const thr_frame *f, thr_certificate *c)
{
  static const char *const known[] = {"component", "scale", "denominator",  "end_price", "join",
                                      "sum",       "cuts",  "place_prices", NULL};
  const thr_json *cuts;
  thr_status st = thr_field_only(r, v, "proof.length.certificate", known);
  if (!st) st = thr_field_int(r, v, "component", 0, f->n_nodes - 1, &c->component);
  if (!st) st = thr_field_double(r, v, "scale", &c->scale);
  if (!st) st = thr_field_int64(r, v, "denominator", 1, INT64_C(1) << 40, &c->denominator);
  if (!st) st = thr_field_int64(r, v, "end_price", 0, INT64_MAX, &c->end_price);
  if (!st) st = thr_field_int64(r, v, "join", 0, INT64_C(1) << 60, &c->join);
  if (!st) st = thr_field_int64(r, v, "sum", 0, INT64_MAX, &c->sum);
  if (!st && thr_json_get(v, "place_prices")) st = read_prices(r, v, c);
  if (!st) st = thr_field_need(r, v, "cuts", THR_JSON_ARRAY, &cuts);
  if (st) return st;
  int n = thr_json_size(cuts);
  if (!(c->cut = thr_calloc((size_t)n, sizeof *c->cut))) return thr_nomem(r->err);
  c->n_cuts = n;
  for (int i = 0; i < n; i++)
    if ((st = read_cut(r, thr_json_at(cuts, i), i, n, f, &c->cut[i]))) return st;
  return THR_OK;
}

static thr_status get_status(const thr_field_reader *r, const thr_json *v, const char *place, bool *optimal)
{
  int status;
  thr_status st = thr_field_name(r, v, place, "status", 2, status_name, &status);
  *optimal = status == 1;
  return st;
}

/* "open", or nothing: then the limit on the length that the options set is one that is proved. */
static thr_status read_slack(const thr_field_reader *r, const thr_json *v, bool *open)
{
  const thr_json *slack = thr_json_get(v, "slack");
  const char *word = thr_json_string(slack);
  if (slack && (!word || strcmp(word, "open") != 0)) return thr_field_bad(r, "proof.length.slack", "not \"open\"");
  *open = slack != NULL;
  return THR_OK;
}

static thr_status read_length_proof(const thr_field_reader *r, const thr_json *v, const thr_frame *f, thr_length_proof *proof)
{
  static const char *const solid[] = {"status", "lower_bound", "slack", "gap", "method", "certificate", NULL};
  static const char *const tube[] = {"status", "lower_bound", "slack", "gap", "method", "proof", NULL};
  const thr_json *list, *tied = thr_json_get(v, "proof");
  thr_status st = thr_field_only(r, v, "proof.length", tied ? tube : solid);
  if (!st) st = get_status(r, v, "proof.length", &proof->optimal);
  if (!st) st = thr_field_amount(r, v, "lower_bound", &proof->lower_bound);
  if (!st) st = read_slack(r, v, &proof->slack_open);
  if (!st) st = thr_field_amount(r, v, "gap", &proof->gap);
  if (!st) proof->present = true;
  if (!st && tied) {
    char place[256];
    snprintf(place, sizeof place, "%s: proof.length.proof", r->name);
    return thr_turning_proof_from_json(&proof->tied, f, tied, place, r->err);
  }
  if (!st) st = thr_field_need(r, v, "certificate", THR_JSON_ARRAY, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(proof->certificate = thr_calloc((size_t)n, sizeof *proof->certificate))) return thr_nomem(r->err);
  proof->n_certificates = n;
  for (int i = 0; i < n; i++)
    if ((st = read_certificate(r, thr_json_at(list, i), f, &proof->certificate[i]))) return st;
  return THR_OK;
}

static thr_status read_largest(const thr_field_reader *r, const thr_json *o, thr_turning_claim *c)
{
  static const char *const known[] = {"status", "price", "lower_bound", NULL};
  const thr_json *v;
  thr_status st = thr_field_need(r, o, "largest", THR_JSON_OBJECT, &v);
  if (!st) st = thr_field_only(r, v, "proof.turning.largest", known);
  if (!st) st = get_status(r, v, "proof.turning.largest", &c->largest_optimal);
  if (!st) st = thr_field_amount(r, v, "price", &c->largest);
  if (!st) st = thr_field_amount(r, v, "lower_bound", &c->largest_bound);
  return st;
}

static thr_status read_turning_claim(const thr_field_reader *r, const thr_json *v, const thr_frame *f, thr_turning_claim *c)
{
  static const char *const known[] = {"status",       "price",  "lower_bound", "gap", "pairing_bound", "largest", "most_passes",
                                      "length_limit", "method", "proof",       NULL};
  char place[256];
  thr_status st = thr_field_only(r, v, "proof.turning", known);
  if (!st) st = get_status(r, v, "proof.turning", &c->optimal);
  if (!st) st = thr_field_amount(r, v, "price", &c->price);
  if (!st) st = thr_field_amount(r, v, "lower_bound", &c->lower_bound);
  if (!st) st = thr_field_amount(r, v, "gap", &c->gap);
  if (!st) st = thr_field_amount(r, v, "pairing_bound", &c->pairing_bound);
  if (!st) st = read_largest(r, v, c);
  if (!st) st = thr_field_int(r, v, "most_passes", 1, INT32_MAX, &c->most_passes);
  if (!st) st = thr_field_or_null(r, v, "length_limit", &c->length_limit);
  if (st) return st;
  snprintf(place, sizeof place, "%.200s: proof.turning.proof", r->name);
  c->present = true;
  return thr_turning_proof_from_json(&c->tree, f, thr_json_get(v, "proof"), place, r->err);
}

static thr_status read_cords_claim(const thr_field_reader *r, const thr_json *o, thr_cords_claim *c)
{
  static const char *const known[] = {"longest", "fewest", NULL}, *const of_longest[] = {"status", "length", "lower_bound", NULL},
                           *const of_fewest[] = {"status", "lower_bound", NULL};
  const thr_json *longest, *fewest = thr_json_get(o, "fewest");
  thr_status st = thr_field_only(r, o, "proof.cords", known);
  if (!st) st = thr_field_need(r, o, "longest", THR_JSON_OBJECT, &longest);
  if (!st) st = thr_field_only(r, longest, "proof.cords.longest", of_longest);
  if (!st) st = get_status(r, longest, "proof.cords.longest", &c->longest_optimal);
  if (!st) st = thr_field_amount(r, longest, "length", &c->longest);
  if (!st) st = thr_field_amount(r, longest, "lower_bound", &c->longest_bound);
  if (!st) c->present = true;
  if (st || !fewest) return st;
  st = thr_field_only(r, fewest, "proof.cords.fewest", of_fewest);
  if (!st) st = get_status(r, fewest, "proof.cords.fewest", &c->fewest_optimal);
  return st ? st : thr_field_int(r, fewest, "lower_bound", 1, INT32_MAX, &c->fewest);
}

/* A proof says that nothing with the plan's options is better: one of turning goes with the objective that asks for it. */
thr_status thr_plan_read_proofs(const thr_field_reader *r, const thr_json *doc, thr_plan *p)
{
  static const char *const of_length[] = {"length", "cords", NULL}, *const of_turning[] = {"length", "cords", "turning", NULL};
  const thr_json *all;
  thr_status st = thr_field_need(r, doc, "proof", THR_JSON_OBJECT, &all);
  if (!st) st = thr_field_only(r, all, "proof", thr_wants_turning(&p->options) ? of_turning : of_length);
  const thr_json *length = thr_json_get(all, "length"), *turning = thr_json_get(all, "turning"),
                 *cords = thr_json_get(all, "cords");
  if (!st && length) st = read_length_proof(r, length, &p->frame, &p->proof);
  if (!st && cords) st = read_cords_claim(r, cords, &p->cords_claim);
  if (!st && turning) st = read_turning_claim(r, turning, &p->frame, &p->turning);
  return st;
}
