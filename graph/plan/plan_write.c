/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a plan as JSON. docs/plan-format.md is the schema, and plan_read.c reads all back.
 *
 * The text is the same on every machine: members in a fixed order, numbers in the shortest form
 * that reads back as the same double (graph/io/json.h). Line breaks are chosen so that a person can
 * read the file and a diff shows single cords.
 *
 * Example: {"id": "A", "component": 0, "closed": true,
 * "nodes": [0, 1, 2, 0],
 * "edges": [0, 1, 2]} is a cord round a triangle. */
#include "graph/plan/plan_fields.h"

/* Begins a new line for the next member of the plan. */
static void put_line(thr_writer *writer)
{
  thr_write_line(writer, 0);
}

/* ---- the framework ---- */

/* Writes the list of nodes that are marked. */
static void put_marked(thr_writer *writer, const char *key, const bool *mark, int n)
{
  thr_write_row(writer, key);
  for (int v = 0; v < n; v++)
    if (mark[v]) thr_write_int(writer, NULL, v);
  thr_write_close(writer);
}

/* Writes covers or capacities of all edges; 0, which means none, is written as null. */
static void put_passes(thr_writer *writer, const char *key, const int *passes, int n)
{
  thr_write_line(writer, 2);
  thr_write_row(writer, key);
  for (int e = 0; e < n; e++)
    if (passes[e] > 0)
      thr_write_int(writer, NULL, passes[e]);
    else
      thr_write_null(writer, NULL);
  thr_write_close(writer);
}

/* Writes the coordinates, a node in each line. */
static void put_nodes(thr_writer *writer, const thr_frame *frame)
{
  thr_write_line(writer, 2);
  thr_write_array(writer, "nodes");

  for (int v = 0; v < frame->n_nodes; v++) {
    thr_write_line(writer, 4);
    thr_write_numbers(writer, NULL, frame->xyz[v], 3);
  }

  thr_write_line(writer, 2);
  thr_write_close(writer);
}

/* Writes the nodes of all edges, twelve edges in each line. */
static void put_edges(thr_writer *writer, const thr_frame *frame)
{
  thr_write_line(writer, 2);
  thr_write_row(writer, "edges");

  for (int e = 0; e < frame->n_edges; e++) {
    if (e && e % 12 == 0) thr_write_line(writer, 4);
    thr_write_ints(writer, NULL, frame->edge[e], 2);
  }
  thr_write_close(writer);
}

/* Writes the names of the nodes. */
static void put_names(thr_writer *writer, const thr_frame *frame)
{
  thr_write_line(writer, 2);
  thr_write_row(writer, "names");

  for (int v = 0; v < frame->n_nodes; v++)
    thr_write_string(writer, NULL, frame->name[v]);
  thr_write_close(writer);
}

/* Writes the framework. Lists that say nothing are left out. */
static void put_frame(thr_writer *writer, const thr_frame *frame)
{
  put_line(writer);
  thr_write_object(writer, "framework");

  /* Units and hash; the reader compares the hash with the framework that it has read. */
  thr_write_line(writer, 2);
  thr_write_string(writer, "units", frame->units);
  thr_write_line(writer, 2);
  thr_write_hash(writer, "hash", thr_frame_hash(frame));

  /* The graph. */
  put_nodes(writer, frame);
  put_edges(writer, frame);

  /* What only some frameworks state. */
  if (frame->own_lengths) thr_write_line(writer, 2);
  if (frame->own_lengths) thr_write_numbers(writer, "lengths", frame->length, frame->n_edges);
  if (frame->cover) put_passes(writer, "covers", frame->cover, frame->n_edges);
  if (frame->capacity) put_passes(writer, "capacities", frame->capacity, frame->n_edges);
  if (!thr_frame_names_are_indices(frame)) put_names(writer, frame);

  thr_write_line(writer, 2);
  put_marked(writer, "feet", frame->foot, frame->n_nodes);
  put_line(writer);
  thr_write_close(writer);
}

/* ---- cords ---- */

/* Writes a cord: the nodes that it visits, and the edges between them. */
static void put_cord(thr_writer *writer, const thr_frame *frame, const thr_cord *cord)
{
  thr_write_line(writer, 2);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "id", cord->id);
  thr_write_int(writer, "component", cord->component);
  thr_write_bool(writer, "closed", cord->closed);

  /* n passes visit n + 1 nodes. */
  thr_write_line(writer, 3);
  thr_write_row(writer, "nodes");
  thr_write_int(writer, NULL, thr_cord_start(frame, cord));
  for (int k = 0; k < cord->n_passes; k++)
    thr_write_int(writer, NULL, thr_head(frame, cord->half[k]));
  thr_write_close(writer);

  /* Half-edge h passes edge h / 2. */
  thr_write_line(writer, 3);
  thr_write_row(writer, "edges");
  for (int k = 0; k < cord->n_passes; k++)
    thr_write_int(writer, NULL, cord->half[k] >> 1);
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes all cords. */
static void put_cords(thr_writer *writer, const thr_plan *plan)
{
  put_line(writer);
  thr_write_array(writer, "cords");
  for (int i = 0; i < plan->n_cords; i++)
    put_cord(writer, &plan->frame, &plan->cord[i]);
  put_line(writer);
  thr_write_close(writer);
}

/* Writes n images of all nodes, one in each line. */
static void put_images(thr_writer *writer, const char *key, const int *image, int n, int n_nodes)
{
  thr_write_line(writer, 2);
  thr_write_array(writer, key);

  for (int i = 0; i < n; i++) {
    thr_write_line(writer, 4);
    thr_write_ints(writer, NULL, image + (size_t)i * (size_t)n_nodes, n_nodes);
  }
  thr_write_close(writer);
}

/* Writes how the cords are copies of unique paths under a group. */
static void put_symmetry(thr_writer *writer, const thr_plan *plan)
{
  const thr_symmetry_record *record = &plan->symmetry;
  put_line(writer);
  thr_write_object(writer, "symmetry");

  /* The group. */
  thr_write_int(writer, "order", record->order);
  thr_write_string(writer, "name", record->name);
  put_images(writer, "generators", record->generator, record->n_generators, plan->frame.n_nodes);
  put_images(writer, "images", record->image, record->n_images, plan->frame.n_nodes);

  /* Of each cord the unique path, and the image that maps the path to the cord. */
  thr_write_line(writer, 2);
  thr_write_array(writer, "cords");
  for (int i = 0; i < plan->n_cords; i++) {
    if (i && i % 4 == 0) thr_write_line(writer, 4);
    thr_write_object(writer, NULL);
    thr_write_int(writer, "of", record->unique[i]);
    thr_write_int(writer, "image", record->element[i]);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  /* What is to be learned. A record without `retraced` is an older plan's. */
  thr_write_line(writer, 2);
  thr_write_number(writer, "steps", record->steps);
  if (record->retraced) thr_write_bool(writer, "retraced", true);
  thr_write_int(writer, "unique_paths", record->unique_paths);
  thr_write_close(writer);
}

/* ---- proofs ---- */

/* Writes the proof of length of one component: a packing of odd cuts. */
static void put_certificate(thr_writer *writer, const thr_certificate *certificate)
{
  thr_write_object(writer, NULL);

  thr_write_int(writer, "component", certificate->component);
  thr_fields_write(writer, thr_certificate_fields, certificate);

  /* Prices of places, which are there where as many cords as asked for may need more passes than a
   * join has. */
  if (certificate->n_prices) {
    thr_write_array(writer, "place_prices");
    for (int i = 0; i < certificate->n_prices; i++)
      thr_write_int(writer, NULL, certificate->place_price[i]);
    thr_write_close(writer);
  }

  /* The cuts, children before parents; only own nodes are listed. */
  thr_write_line(writer, 4);
  thr_write_array(writer, "cuts");
  for (int k = 0; k < certificate->n_cuts; k++) {
    thr_write_line(writer, 6);
    thr_write_object(writer, NULL);
    thr_write_int(writer, "value", certificate->cut[k].value);
    thr_write_ints(writer, "nodes", certificate->cut[k].node, certificate->cut[k].n_nodes);
    if (certificate->cut[k].parent >= 0)
      thr_write_int(writer, "parent", certificate->cut[k].parent);
    thr_write_close(writer);
  }
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes the proof of least length: by odd cuts with solid joints, by a tree of multipliers with
 * tube joints. */
static void put_length_proof(thr_writer *writer, const thr_plan *plan)
{
  const thr_length_proof *proof = &plan->proof;
  const bool tube = plan->options.joint == THR_JOINT_TUBE;
  thr_write_object(writer, "length");

  /* What is claimed. */
  thr_write_string(writer, "status", thr_status_name(proof->optimal));
  thr_write_number(writer, "lower_bound", proof->lower_bound);
  if (proof->slack_open) thr_write_string(writer, "slack", "open");
  thr_write_number(writer, "gap", proof->gap);

  /* How the claim is proved, in words. */
  thr_write_line(writer, 2);
  thr_write_string(writer, "method",
                   tube ? "multipliers of odd sets and junctions over a tree of branchings"
                        : "odd-cut packing (Edmonds & Johnson 1973)");
  thr_write_line(writer, 2);

  /* The proof. */
  if (tube) {
    thr_turning_proof_write(&proof->tied, &plan->frame, writer, "proof");
  } else {
    thr_write_array(writer, "certificate");
    for (int i = 0; i < proof->n_certificates; i++) {
      thr_write_line(writer, 4);
      put_certificate(writer, &proof->certificate[i]);
    }
    thr_write_line(writer, 2);
    thr_write_close(writer);
    thr_walk_proof_write(&proof->pulled, &plan->frame, NULL, writer);
  }
  thr_write_close(writer);
}

/* Writes the claim of least turning and its proof. */
static void put_turning_proof(thr_writer *writer, const thr_plan *plan)
{
  thr_write_object(writer, "turning");
  thr_fields_write(writer, thr_turning_claim_fields, plan);

  /* The proof. */
  thr_write_line(writer, 2);
  thr_write_string(writer, "method",
                   "multipliers of odd sets, groups and partitions over a tree of branchings");
  thr_write_line(writer, 2);
  thr_turning_proof_write(&plan->turning.tree, &plan->frame, writer, "proof");
  thr_write_close(writer);
}

/* Writes the claims about the longest cord and the number of cords, with the prices of walks that
 * prove them. */
static void put_cords_claim(thr_writer *writer, const thr_plan *plan)
{
  thr_write_object(writer, "cords");
  thr_fields_write(writer, thr_cords_claim_fields, plan);
  thr_walk_proof_write(&plan->proof.walks, &plan->frame, "length", writer);
  if (plan->proof.walks.sets) thr_write_bool(writer, "sets", true);
  thr_write_close(writer);
}

/* Writes the claim that fewer cords are not within the pull, of the whole framework or, with parts,
 * of each component. frame: of a component only the sizes are set. */
static void put_pull_claim(thr_writer *writer, const char *name, const thr_pull_claim *claim,
                           const thr_frame *frame)
{
  thr_write_line(writer, 2);
  thr_write_object(writer, name);
  thr_write_string(writer, "status", thr_status_name(claim->optimal));
  thr_write_int(writer, "lower_bound", claim->fewest);

  /* The proof: prices of walks, or a tree of multipliers. */
  if (thr_pull_excludes(claim)) thr_write_int(writer, "excluded", claim->excluded);
  thr_walk_proof_write(&claim->walks, frame, NULL, writer);
  if (claim->tree.n_nodes > 0) {
    thr_write_int(writer, "most_passes", claim->most_passes);
    if (claim->cut > 0) thr_write_int(writer, "cut", claim->cut);
    thr_write_line(writer, 2);
    thr_turning_proof_write(&claim->tree, frame, writer, "proof");
  }

  /* Claims of the components in their order. */
  if (claim->n_parts > 0) thr_write_array(writer, "parts");
  for (int i = 0; i < claim->n_parts; i++) {
    const thr_frame sizes = {.n_nodes = claim->part[i].n_nodes, .n_edges = claim->part[i].n_edges};
    put_pull_claim(writer, NULL, &claim->part[i], &sizes);
  }
  if (claim->n_parts > 0) thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes all proofs that the plan has; none of them is an empty object. */
static void put_proofs(thr_writer *writer, const thr_plan *plan)
{
  put_line(writer);
  thr_write_object(writer, "proof");
  if (plan->proof.present) put_length_proof(writer, plan);
  if (plan->proof.present && plan->cords_claim.present) thr_write_line(writer, 2);
  if (plan->cords_claim.present) put_cords_claim(writer, plan);
  if (plan->pull_claim.present) put_pull_claim(writer, "pull", &plan->pull_claim, &plan->frame);

  /* The proof of turning begins a line, if it is not the first. */
  bool before = plan->proof.present || plan->cords_claim.present || plan->pull_claim.present;
  if (before && plan->turning.present) thr_write_line(writer, 2);
  if (plan->turning.present) put_turning_proof(writer, plan);
  thr_write_close(writer);
}

void thr_plan_write(const thr_plan *plan, thr_text *text)
{
  thr_writer writer = {.out = text};

  /* What the document is, and who wrote it. */
  thr_write_object(&writer, NULL);
  put_line(&writer);
  thr_write_string(&writer, "format", "thread-plan");
  put_line(&writer);
  thr_write_int(&writer, "version", plan->options.old_pull ? 1 : 2);
  put_line(&writer);
  thr_write_string(&writer, "generator", plan->generator ? plan->generator : "");

  /* What was asked for. */
  put_frame(&writer, &plan->frame);
  put_line(&writer);
  thr_request_write(&writer, plan);

  /* What was found. */
  put_cords(&writer, plan);
  if (plan->symmetry.present) put_symmetry(&writer, plan);
  put_line(&writer);
  thr_write_object(&writer, "metrics");
  thr_fields_write(&writer, thr_metrics_fields, plan);
  thr_write_close(&writer);

  /* What is claimed of the cords. */
  put_line(&writer);
  if (plan->evaluation.present) thr_evaluation_write(&plan->evaluation, &writer, "evaluation");
  put_proofs(&writer, plan);
  put_line(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}
