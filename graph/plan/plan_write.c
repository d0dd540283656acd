/* plan.json, written: docs/plan-format.md is the schema. */
#include "graph/framework/frame.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/io/writer.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/text.h"

/* A number that means nothing below 0. */
static void put_or_null(thr_writer *w, const char *key, double value)
{
  if (value < 0)
    thr_write_null(w, key);
  else
    thr_write_number(w, key, value);
}

/* A line of its own for the next member of the plan. */
static void put_line(thr_writer *w)
{
  thr_write_line(w, 0);
}

/* ---- the framework ---- */

static void put_marked(thr_writer *w, const char *key, const bool *mark, int n)
{
  thr_write_row(w, key);
  for (int v = 0; v < n; v++)
    if (mark[v]) thr_write_int(w, NULL, v);
  thr_write_close(w);
}

/* Covers or capacities; a capacity of 0 is none. */
static void put_passes(thr_writer *w, const char *key, const int *passes, int n)
{
  thr_write_line(w, 2);
  thr_write_row(w, key);
  for (int e = 0; e < n; e++)
    if (passes[e] > 0)
      thr_write_int(w, NULL, passes[e]);
    else
      thr_write_null(w, NULL);
  thr_write_close(w);
}

static void put_nodes(thr_writer *w, const thr_frame *f)
{
  thr_write_line(w, 2);
  thr_write_array(w, "nodes");
  for (int v = 0; v < f->n_nodes; v++) {
    thr_write_line(w, 4);
    thr_write_row(w, NULL);
    for (int i = 0; i < 3; i++)
      thr_write_number(w, NULL, f->xyz[v][i]);
    thr_write_close(w);
  }
  thr_write_line(w, 2);
  thr_write_close(w);
}

static void put_edges(thr_writer *w, const thr_frame *f)
{
  thr_write_line(w, 2);
  thr_write_row(w, "edges");
  for (int e = 0; e < f->n_edges; e++) {
    if (e && e % 12 == 0) thr_write_line(w, 4);
    thr_write_ints(w, NULL, f->edge[e], 2);
  }
  thr_write_close(w);
}

static void put_lengths(thr_writer *w, const thr_frame *f)
{
  thr_write_line(w, 2);
  thr_write_row(w, "lengths");
  for (int e = 0; e < f->n_edges; e++)
    thr_write_number(w, NULL, f->length[e]);
  thr_write_close(w);
}

static void put_names(thr_writer *w, const thr_frame *f)
{
  thr_write_line(w, 2);
  thr_write_row(w, "names");
  for (int v = 0; v < f->n_nodes; v++)
    thr_write_string(w, NULL, f->name[v]);
  thr_write_close(w);
}

static void put_frame(thr_writer *w, const thr_frame *f)
{
  put_line(w);
  thr_write_object(w, "framework");
  thr_write_line(w, 2);
  thr_write_string(w, "units", f->units);
  thr_write_line(w, 2);
  thr_write_hash(w, "hash", thr_frame_hash(f));
  put_nodes(w, f);
  put_edges(w, f);
  if (f->own_lengths) put_lengths(w, f);
  if (f->cover) put_passes(w, "covers", f->cover, f->n_edges);
  if (f->capacity) put_passes(w, "capacities", f->capacity, f->n_edges);
  if (!thr_frame_names_are_indices(f)) put_names(w, f);
  thr_write_line(w, 2);
  put_marked(w, "feet", f->foot, f->n_nodes);
  put_line(w);
  thr_write_close(w);
}

/* ---- options ---- */

static void put_turning_options(thr_writer *w, const thr_plan_options *asked)
{
  const thr_turning_options *o = &asked->turning;
  thr_write_object(w, "turning");
  thr_write_string(w, "cost", thr_turn_cost_name(o->cost));
  put_or_null(w, "length_slack", o->length_slack);
  thr_write_string(w, "minimize", thr_minimize_name(thr_wants_largest(asked)));
  thr_write_string(w, "tour", thr_tour_name(o->tour));
  thr_write_string(w, "pairings", thr_pairings_name(o->ignore_pairings));
  thr_write_close(w);
  thr_write_line(w, 2);
}

static void put_symmetry_options(thr_writer *w, const thr_plan_options *asked)
{
  const thr_symmetry_options *o = &asked->symmetry;
  thr_aim order[THR_N_AIMS];
  thr_aims_order(asked, order);
  thr_write_object(w, "symmetry");
  if (o->group[0])
    thr_write_string(w, "group", o->group);
  else
    thr_write_null(w, "group");
  put_or_null(w, "geometric", o->geometric);
  thr_write_array(w, "prefer");
  for (int i = 0; i < THR_N_AIMS; i++)
    thr_write_string(w, NULL, thr_aim_name(order[i]));
  thr_write_close(w);
  thr_write_close(w);
  thr_write_line(w, 2);
}

/* Where cord ends may be, or how many there are. */
static void put_ends(thr_writer *w, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  thr_write_string(w, "ends", thr_ends_name(o->ends));
  if (o->ends == THR_ENDS_NODES) put_marked(w, "end_nodes", o->end_node, p->frame.n_nodes);
  if (o->ends != THR_ENDS_COUNTS) return;
  thr_write_row(w, "end_counts");
  for (int v = 0; v < p->frame.n_nodes; v++)
    if (o->end_count[v]) thr_write_ints(w, NULL, (const int[]){v, o->end_count[v]}, 2);
  thr_write_close(w);
}

static void put_number_of_cords(thr_writer *w, const thr_plan_options *o)
{
  if (o->cords_least == o->cords) {
    thr_write_int(w, "cords", o->cords);
    return;
  }
  thr_write_object(w, "cords");
  thr_write_int(w, "least", o->cords_least);
  thr_write_int(w, "most", o->cords);
  thr_write_close(w);
}

static void put_options(thr_writer *w, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  put_line(w);
  thr_write_object(w, "options");
  thr_write_string(w, "objective", thr_objective_name(thr_aims_objective(o)));
  thr_write_string(w, "joint", thr_joint_name(o->joint));
  thr_write_int(w, "cover", o->cover);
  if (o->capacity > 0) thr_write_int(w, "capacity", o->capacity);
  put_number_of_cords(w, o);
  if (o->max_length > 0) thr_write_number(w, "max_length", o->max_length);
  if (thr_wants_balance(o)) thr_write_bool(w, "balance", true);
  put_ends(w, p);
  if (thr_wants_turning(o)) put_turning_options(w, o);
  if (thr_wants_symmetry(o)) put_symmetry_options(w, o);
  if (o->engine != THR_ENGINE_AUTO) thr_write_string(w, "engine", thr_engine_name(o->engine));
  if (thr_wants_length(o) && o->confirm != THR_CONFIRM_AUTO) thr_write_string(w, "confirm", thr_confirm_name(o->confirm));
  thr_write_number(w, "time_limit", o->time_limit);
  thr_write_line(w, 2);
  thr_physics_write(&o->physics, w, "physics");
  thr_write_close(w);
}

/* ---- cords ---- */

static void put_cord(thr_writer *w, const thr_frame *f, const thr_cord *c)
{
  thr_write_line(w, 2);
  thr_write_object(w, NULL);
  thr_write_string(w, "id", c->id);
  thr_write_int(w, "component", c->component);
  thr_write_bool(w, "closed", c->closed);
  thr_write_line(w, 3);
  thr_write_row(w, "nodes");
  thr_write_int(w, NULL, thr_cord_start(f, c));
  for (int k = 0; k < c->n_passes; k++)
    thr_write_int(w, NULL, thr_head(f, c->half[k]));
  thr_write_close(w);
  thr_write_line(w, 3);
  thr_write_row(w, "edges");
  for (int k = 0; k < c->n_passes; k++)
    thr_write_int(w, NULL, c->half[k] >> 1);
  thr_write_close(w);
  thr_write_close(w);
}

static void put_cords(thr_writer *w, const thr_plan *p)
{
  put_line(w);
  thr_write_array(w, "cords");
  for (int i = 0; i < p->n_cords; i++)
    put_cord(w, &p->frame, &p->cord[i]);
  put_line(w);
  thr_write_close(w);
}

static void put_images(thr_writer *w, const char *key, const int *image, int n, int n_nodes)
{
  thr_write_line(w, 2);
  thr_write_array(w, key);
  for (int i = 0; i < n; i++) {
    thr_write_line(w, 4);
    thr_write_ints(w, NULL, image + (size_t)i * (size_t)n_nodes, n_nodes);
  }
  thr_write_close(w);
}

static void put_symmetry(thr_writer *w, const thr_plan *p)
{
  const thr_symmetry_record *r = &p->symmetry;
  put_line(w);
  thr_write_object(w, "symmetry");
  thr_write_int(w, "order", r->order);
  thr_write_string(w, "name", r->name);
  put_images(w, "generators", r->generator, r->n_generators, p->frame.n_nodes);
  put_images(w, "images", r->image, r->n_images, p->frame.n_nodes);
  thr_write_line(w, 2);
  thr_write_array(w, "cords");
  for (int i = 0; i < p->n_cords; i++) {
    if (i && i % 4 == 0) thr_write_line(w, 4);
    thr_write_object(w, NULL);
    thr_write_int(w, "of", r->unique[i]);
    thr_write_int(w, "image", r->element[i]);
    thr_write_close(w);
  }
  thr_write_close(w);
  thr_write_line(w, 2);
  thr_write_number(w, "steps", r->steps);
  thr_write_int(w, "unique_paths", r->unique_paths);
  thr_write_close(w);
}

static void put_metrics(thr_writer *w, const thr_metrics *m)
{
  put_line(w);
  thr_write_object(w, "metrics");
  thr_write_number(w, "length", m->length);
  thr_write_number(w, "base_length", m->base_length);
  thr_write_number(w, "overlap", m->overlap);
  thr_write_int(w, "passes", m->passes);
  thr_write_int(w, "most_passes", m->most_passes);
  thr_write_line(w, 2);
  thr_write_number(w, "turning", m->turning);
  thr_write_number(w, "max_turning", m->max_turning);
  thr_write_number(w, "worst_turn", m->worst_turn);
  thr_write_int(w, "u_turns", m->u_turns);
  thr_write_close(w);
}

/* ---- proofs ---- */

static void put_certificate(thr_writer *w, const thr_certificate *c)
{
  thr_write_object(w, NULL);
  thr_write_int(w, "component", c->component);
  thr_write_number(w, "scale", c->scale);
  thr_write_int(w, "denominator", c->denominator);
  thr_write_int(w, "end_price", c->end_price);
  thr_write_int(w, "join", c->join);
  thr_write_int(w, "sum", c->sum);
  if (c->n_prices) {
    thr_write_array(w, "place_prices");
    for (int i = 0; i < c->n_prices; i++)
      thr_write_int(w, NULL, c->place_price[i]);
    thr_write_close(w);
  }
  thr_write_line(w, 4);
  thr_write_array(w, "cuts");
  for (int k = 0; k < c->n_cuts; k++) {
    thr_write_line(w, 6);
    thr_write_object(w, NULL);
    thr_write_int(w, "value", c->cut[k].value);
    thr_write_ints(w, "nodes", c->cut[k].node, c->cut[k].n_nodes);
    if (c->cut[k].parent >= 0) thr_write_int(w, "parent", c->cut[k].parent);
    thr_write_close(w);
  }
  thr_write_close(w);
  thr_write_close(w);
}

static const char *status_name(bool optimal)
{
  return optimal ? "optimal" : "bound";
}

static void put_length_proof(thr_writer *w, const thr_plan *p)
{
  const thr_length_proof *proof = &p->proof;
  const bool tube = p->options.joint == THR_JOINT_TUBE;
  thr_write_object(w, "length");
  thr_write_string(w, "status", status_name(proof->optimal));
  thr_write_number(w, "lower_bound", proof->lower_bound);
  if (proof->slack_open) thr_write_string(w, "slack", "open");
  thr_write_number(w, "gap", proof->gap);
  thr_write_line(w, 2);
  thr_write_string(w, "method",
                   tube ? "multipliers of odd sets and junctions over a tree of branchings"
                        : "odd-cut packing (Edmonds & Johnson 1973)");
  thr_write_line(w, 2);
  if (tube) {
    thr_turning_proof_write(&proof->tied, &p->frame, w, "proof");
  } else {
    thr_write_array(w, "certificate");
    for (int i = 0; i < proof->n_certificates; i++) {
      thr_write_line(w, 4);
      put_certificate(w, &proof->certificate[i]);
    }
    thr_write_line(w, 2);
    thr_write_close(w);
  }
  thr_write_close(w);
}

static void put_turning_proof(thr_writer *w, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  thr_write_object(w, "turning");
  thr_write_string(w, "status", status_name(c->optimal));
  thr_write_number(w, "price", c->price);
  thr_write_number(w, "lower_bound", c->lower_bound);
  thr_write_number(w, "gap", c->gap);
  thr_write_number(w, "pairing_bound", c->pairing_bound);
  thr_write_line(w, 2);
  thr_write_object(w, "largest");
  thr_write_string(w, "status", status_name(c->largest_optimal));
  thr_write_number(w, "price", c->largest);
  thr_write_number(w, "lower_bound", c->largest_bound);
  thr_write_close(w);
  thr_write_line(w, 2);
  thr_write_int(w, "most_passes", c->most_passes);
  put_or_null(w, "length_limit", c->length_limit);
  thr_write_line(w, 2);
  thr_write_string(w, "method", "multipliers of odd sets, groups and partitions over a tree of branchings");
  thr_write_line(w, 2);
  thr_turning_proof_write(&c->tree, &p->frame, w, "proof");
  thr_write_close(w);
}

static void put_cords_claim(thr_writer *w, const thr_cords_claim *c)
{
  thr_write_object(w, "cords");
  thr_write_object(w, "longest");
  thr_write_string(w, "status", status_name(c->longest_optimal));
  thr_write_number(w, "length", c->longest);
  thr_write_number(w, "lower_bound", c->longest_bound);
  thr_write_close(w);
  if (c->fewest > 0) {
    thr_write_object(w, "fewest");
    thr_write_string(w, "status", status_name(c->fewest_optimal));
    thr_write_int(w, "lower_bound", c->fewest);
    thr_write_close(w);
  }
  thr_write_close(w);
}

static void put_proofs(thr_writer *w, const thr_plan *p)
{
  put_line(w);
  thr_write_object(w, "proof");
  if (p->proof.present) put_length_proof(w, p);
  if (p->proof.present && p->cords_claim.present) thr_write_line(w, 2);
  if (p->cords_claim.present) put_cords_claim(w, &p->cords_claim);
  if ((p->proof.present || p->cords_claim.present) && p->turning.present) thr_write_line(w, 2);
  if (p->turning.present) put_turning_proof(w, p);
  thr_write_close(w);
}

void thr_plan_write(const thr_plan *p, thr_text *t)
{
  thr_writer w = {.out = t};
  thr_write_object(&w, NULL);
  put_line(&w);
  thr_write_string(&w, "format", "thread-plan");
  put_line(&w);
  thr_write_int(&w, "version", 1);
  put_line(&w);
  thr_write_string(&w, "generator", p->generator ? p->generator : "");
  put_frame(&w, &p->frame);
  put_options(&w, p);
  put_cords(&w, p);
  if (p->symmetry.present) put_symmetry(&w, p);
  put_metrics(&w, &p->metrics);
  put_line(&w);
  if (p->evaluation.present) thr_evaluation_write(&p->evaluation, &w, "evaluation");
  put_proofs(&w, p);
  put_line(&w);
  thr_write_close(&w);
  thr_text_append(t, "\n");
}
