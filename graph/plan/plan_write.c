/* plan.json, written: docs/plan-format.md is the schema. */
#include "graph/plan/plan.h"

#include <inttypes.h>

static void put_key_double(thr_text *t, const char *key, double value, const char *after)
{
  thr_text_printf(t, "\"%s\": ", key);
  thr_text_double(t, value);
  thr_text_append(t, after);
}

/* A number that means nothing below 0. */
static void put_or_null(thr_text *t, double value)
{
  if (value < 0)
    thr_text_append(t, "null");
  else
    thr_text_double(t, value);
}

/* Appends "[a, b, ..]" from n ints read by the caller's stride. */
static void put_ints(thr_text *t, const int *value, int n)
{
  thr_text_append(t, "[");
  for (int i = 0; i < n; i++)
    thr_text_printf(t, i ? ",%d" : "%d", value[i]);
  thr_text_append(t, "]");
}

static void put_marked(thr_text *t, const bool *mark, int n)
{
  bool some = false;
  thr_text_append(t, "[");
  for (int v = 0; v < n; v++)
    if (mark[v]) {
      thr_text_printf(t, some ? ",%d" : "%d", v);
      some = true;
    }
  thr_text_append(t, "]");
}

/* Covers or capacities; a capacity of 0 is none. */
static void put_passes(thr_text *t, const char *key, const int *passes, int n)
{
  thr_text_printf(t, "  \"%s\": [", key);
  for (int e = 0; e < n; e++)
    if (passes[e] > 0)
      thr_text_printf(t, e ? ",%d" : "%d", passes[e]);
    else
      thr_text_append(t, e ? ",null" : "null");
  thr_text_append(t, "],\n");
}

static void put_frame(thr_text *t, const thr_frame *f)
{
  thr_text_append(t, "\"framework\": {\n  \"units\": ");
  thr_text_json_string(t, f->units);
  thr_text_printf(t, ",\n  \"hash\": \"%016" PRIx64 "\",\n  \"nodes\": [", thr_frame_hash(f));
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++) {
      thr_text_append(t, i ? "," : v ? ",\n    [" : "\n    [");
      thr_text_double(t, f->xyz[v][i]);
      if (i == 2) thr_text_append(t, "]");
    }
  thr_text_append(t, "\n  ],\n  \"edges\": [");
  for (int e = 0; e < f->n_edges; e++)
    thr_text_printf(t, "%s[%d,%d]", e == 0 ? "" : e % 12 ? "," : ",\n    ", f->edge[e][0], f->edge[e][1]);
  thr_text_append(t, "],\n");
  if (f->own_lengths) {
    thr_text_append(t, "  \"lengths\": [");
    for (int e = 0; e < f->n_edges; e++) {
      if (e) thr_text_append(t, ",");
      thr_text_double(t, f->length[e]);
    }
    thr_text_append(t, "],\n");
  }
  if (f->cover) put_passes(t, "covers", f->cover, f->n_edges);
  if (f->capacity) put_passes(t, "capacities", f->capacity, f->n_edges);
  if (!thr_frame_names_are_indices(f)) {
    thr_text_append(t, "  \"names\": [");
    for (int v = 0; v < f->n_nodes; v++) {
      if (v) thr_text_append(t, ",");
      thr_text_json_string(t, f->name[v]);
    }
    thr_text_append(t, "],\n");
  }
  thr_text_append(t, "  \"feet\": ");
  put_marked(t, f->foot, f->n_nodes);
  thr_text_append(t, "\n},\n");
}

static void put_turning_options(thr_text *t, const thr_plan_options *asked)
{
  const thr_turning_options *o = &asked->turning;
  thr_text_printf(t, "\"turning\": {\"cost\": \"%s\", \"length_slack\": ", thr_turn_cost_name(o->cost));
  put_or_null(t, o->length_slack);
  thr_text_printf(t, ", \"minimize\": \"%s\", \"tour\": \"%s\", \"pairings\": \"%s\"},\n  ",
                  thr_aim_name(thr_wants_largest(asked) ? THR_AIM_MAX_TURNING : THR_AIM_TURNING), thr_tour_name(o->tour),
                  o->ignore_pairings ? "ignore" : "keep");
}

static void put_symmetry_options(thr_text *t, const thr_plan_options *asked)
{
  const thr_symmetry_options *o = &asked->symmetry;
  thr_aim order[THR_N_AIMS];
  thr_aims_order(asked, order);
  thr_text_append(t, "\"symmetry\": {\"group\": ");
  if (o->group[0])
    thr_text_json_string(t, o->group);
  else
    thr_text_append(t, "null");
  thr_text_append(t, ", \"geometric\": ");
  put_or_null(t, o->geometric);
  thr_text_append(t, ", \"prefer\": [");
  for (int i = 0; i < THR_N_AIMS; i++)
    thr_text_printf(t, i ? ", \"%s\"" : "\"%s\"", thr_aim_name(order[i]));
  thr_text_append(t, "]},\n  ");
}

/* Where cord ends may be, or how many there are. */
static void put_ends(thr_text *t, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  thr_text_printf(t, "\"ends\": \"%s\", ", thr_ends_name(o->ends));
  if (o->ends == THR_ENDS_NODES) {
    thr_text_append(t, "\"end_nodes\": ");
    put_marked(t, o->end_node, p->frame.n_nodes);
    thr_text_append(t, ", ");
  }
  if (o->ends != THR_ENDS_COUNTS) return;
  const char *before = "";
  thr_text_append(t, "\"end_counts\": [");
  for (int v = 0; v < p->frame.n_nodes; v++) {
    if (o->end_count[v] == 0) continue;
    thr_text_printf(t, "%s[%d,%d]", before, v, o->end_count[v]);
    before = ",";
  }
  thr_text_append(t, "], ");
}

static void put_options(thr_text *t, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  thr_text_printf(t, "\"options\": {\"objective\": \"%s\", \"joint\": \"%s\", \"cover\": %d, ",
                  thr_objective_name(thr_aims_objective(o)), thr_joint_name(o->joint), o->cover);
  if (o->capacity > 0) thr_text_printf(t, "\"capacity\": %d, ", o->capacity);
  if (o->cords_least == o->cords)
    thr_text_printf(t, "\"cords\": %d, ", o->cords);
  else
    thr_text_printf(t, "\"cords\": {\"least\": %d, \"most\": %d}, ", o->cords_least, o->cords);
  if (o->max_length > 0) put_key_double(t, "max_length", o->max_length, ", ");
  if (thr_wants_balance(o)) thr_text_append(t, "\"balance\": true, ");
  put_ends(t, p);
  if (thr_wants_turning(o)) put_turning_options(t, o);
  if (thr_wants_symmetry(o)) put_symmetry_options(t, o);
  if (o->engine != THR_ENGINE_AUTO) thr_text_printf(t, "\"engine\": \"%s\", ", thr_engine_name(o->engine));
  if (thr_wants_length(o) && o->confirm != THR_CONFIRM_AUTO)
    thr_text_printf(t, "\"confirm\": \"%s\", ", thr_confirm_name(o->confirm));
  put_key_double(t, "time_limit", o->time_limit, ",");
  thr_text_append(t, "\n  \"physics\": ");
  thr_physics_write(&o->physics, t);
  thr_text_append(t, "},\n");
}

static void put_cords(thr_text *t, const thr_plan *p)
{
  thr_text_append(t, "\"cords\": [");
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    thr_text_append(t, i ? ",\n  {\"id\": " : "\n  {\"id\": ");
    thr_text_json_string(t, c->id);
    thr_text_printf(t, ", \"component\": %d, \"closed\": %s,\n   \"nodes\": [%d", c->component, c->closed ? "true" : "false",
                    thr_cord_start(&p->frame, c));
    for (int k = 0; k < c->n_passes; k++)
      thr_text_printf(t, ",%d", thr_head(&p->frame, c->half[k]));
    thr_text_append(t, "],\n   \"edges\": [");
    for (int k = 0; k < c->n_passes; k++)
      thr_text_printf(t, k ? ",%d" : "%d", c->half[k] >> 1);
    thr_text_append(t, "]}");
  }
  thr_text_append(t, "\n],\n");
}

static void put_images(thr_text *t, const char *key, const int *image, int n, int n_nodes)
{
  thr_text_printf(t, "\"%s\": [", key);
  for (int i = 0; i < n; i++) {
    thr_text_append(t, i ? ",\n    " : "\n    ");
    put_ints(t, image + (size_t)i * (size_t)n_nodes, n_nodes);
  }
  thr_text_append(t, "],\n  ");
}

static void put_symmetry(thr_text *t, const thr_plan *p)
{
  const thr_symmetry_record *r = &p->symmetry;
  thr_text_printf(t, "\"symmetry\": {\"order\": %d, \"name\": ", r->order);
  thr_text_json_string(t, r->name);
  thr_text_append(t, ",\n  ");
  put_images(t, "generators", r->generator, r->n_generators, p->frame.n_nodes);
  put_images(t, "images", r->image, r->n_images, p->frame.n_nodes);
  thr_text_append(t, "\"cords\": [");
  for (int i = 0; i < p->n_cords; i++)
    thr_text_printf(t, "%s{\"of\": %d, \"image\": %d}", i == 0 ? "" : i % 4 ? ", " : ",\n    ", r->unique[i], r->element[i]);
  thr_text_append(t, "],\n  ");
  put_key_double(t, "steps", r->steps, ", ");
  thr_text_printf(t, "\"unique_paths\": %d},\n", r->unique_paths);
}

static void put_metrics(thr_text *t, const thr_metrics *m)
{
  thr_text_append(t, "\"metrics\": {");
  put_key_double(t, "length", m->length, ", ");
  put_key_double(t, "base_length", m->base_length, ", ");
  put_key_double(t, "overlap", m->overlap, ", ");
  thr_text_printf(t, "\"passes\": %d, \"most_passes\": %d,\n  ", m->passes, m->most_passes);
  put_key_double(t, "turning", m->turning, ", ");
  put_key_double(t, "max_turning", m->max_turning, ", ");
  put_key_double(t, "worst_turn", m->worst_turn, ", ");
  thr_text_printf(t, "\"u_turns\": %d},\n", m->u_turns);
}

static void put_certificate(thr_text *t, const thr_certificate *c)
{
  thr_text_printf(t, "{\"component\": %d, ", c->component);
  put_key_double(t, "scale", c->scale, ", ");
  thr_text_printf(t, "\"denominator\": %" PRId64 ", \"end_price\": %" PRId64 ", \"join\": %" PRId64 ", \"sum\": %" PRId64,
                  c->denominator, c->end_price, c->join, c->sum);
  for (int i = 0; i < c->n_prices; i++)
    thr_text_printf(t, "%s%" PRId64 "%s", i ? ", " : ", \"place_prices\": [", c->place_price[i], i + 1 < c->n_prices ? "" : "]");
  thr_text_append(t, ",\n    \"cuts\": [");
  for (int k = 0; k < c->n_cuts; k++) {
    thr_text_printf(t, "%s      {\"value\": %" PRId64 ", \"nodes\": ", k ? ",\n" : "\n", c->cut[k].value);
    put_ints(t, c->cut[k].node, c->cut[k].n_nodes);
    if (c->cut[k].parent >= 0) thr_text_printf(t, ", \"parent\": %d", c->cut[k].parent);
    thr_text_append(t, "}");
  }
  thr_text_append(t, "]}");
}

static const char *status_name(bool optimal)
{
  return optimal ? "optimal" : "bound";
}

static void put_length_proof(thr_text *t, const thr_plan *p)
{
  const thr_length_proof *proof = &p->proof;
  thr_text_printf(t, "\"length\": {\"status\": \"%s\", ", status_name(proof->optimal));
  put_key_double(t, "lower_bound", proof->lower_bound, ", ");
  if (proof->slack_open) thr_text_append(t, "\"slack\": \"open\", ");
  put_key_double(t, "gap", proof->gap, ",\n  \"method\": ");
  if (p->options.joint == THR_JOINT_TUBE) {
    thr_text_append(t, "\"multipliers of odd sets and junctions over a tree of branchings\",\n  \"proof\": ");
    thr_turning_proof_write(&proof->tied, &p->frame, t);
    thr_text_append(t, "}");
    return;
  }
  thr_text_append(t, "\"odd-cut packing (Edmonds & Johnson 1973)\",\n  \"certificate\": [");
  for (int i = 0; i < proof->n_certificates; i++) {
    thr_text_append(t, i ? ",\n    " : "\n    ");
    put_certificate(t, &proof->certificate[i]);
  }
  thr_text_append(t, "\n  ]}");
}

static void put_turning_proof(thr_text *t, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  thr_text_printf(t, "\"turning\": {\"status\": \"%s\", ", status_name(c->optimal));
  put_key_double(t, "price", c->price, ", ");
  put_key_double(t, "lower_bound", c->lower_bound, ", ");
  put_key_double(t, "gap", c->gap, ", ");
  put_key_double(t, "pairing_bound", c->pairing_bound, ",\n  ");
  thr_text_printf(t, "\"largest\": {\"status\": \"%s\", ", status_name(c->largest_optimal));
  put_key_double(t, "price", c->largest, ", ");
  put_key_double(t, "lower_bound", c->largest_bound, "},\n  ");
  thr_text_printf(t, "\"most_passes\": %d, \"length_limit\": ", c->most_passes);
  put_or_null(t, c->length_limit);
  thr_text_append(
      t, ",\n  \"method\": \"multipliers of odd sets, groups and partitions over a tree of branchings\",\n  \"proof\": ");
  thr_turning_proof_write(&c->tree, &p->frame, t);
  thr_text_append(t, "}");
}

static void put_cords_claim(thr_text *t, const thr_cords_claim *c)
{
  thr_text_append(t, "\"cords\": {\"longest\": {");
  thr_text_printf(t, "\"status\": \"%s\", ", status_name(c->longest_optimal));
  put_key_double(t, "length", c->longest, ", ");
  put_key_double(t, "lower_bound", c->longest_bound, "}");
  if (c->fewest > 0)
    thr_text_printf(t, ", \"fewest\": {\"status\": \"%s\", \"lower_bound\": %d}", status_name(c->fewest_optimal), c->fewest);
  thr_text_append(t, "}");
}

static void put_proofs(thr_text *t, const thr_plan *p)
{
  thr_text_append(t, "\"proof\": {");
  if (p->proof.present) put_length_proof(t, p);
  if (p->proof.present && p->cords_claim.present) thr_text_append(t, ",\n  ");
  if (p->cords_claim.present) put_cords_claim(t, &p->cords_claim);
  if ((p->proof.present || p->cords_claim.present) && p->turning.present) thr_text_append(t, ",\n  ");
  if (p->turning.present) put_turning_proof(t, p);
  thr_text_append(t, "}\n}\n");
}

void thr_plan_write(const thr_plan *p, thr_text *t)
{
  thr_text_append(t, "{\n\"format\": \"thread-plan\",\n\"version\": 1,\n\"generator\": ");
  thr_text_json_string(t, p->generator ? p->generator : "");
  thr_text_append(t, ",\n");
  put_frame(t, &p->frame);
  put_options(t, p);
  put_cords(t, p);
  if (p->symmetry.present) put_symmetry(t, p);
  put_metrics(t, &p->metrics);
  if (p->evaluation.present) thr_evaluation_write(&p->evaluation, t);
  put_proofs(t, p);
}
