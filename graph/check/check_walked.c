/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks the cords themselves against the framework and the request, and counts their passes.
 *
 * A cord is a walk: every pass starts where the last one ended. Cords end where they may, pass
 * every edge as often as needed, and keep to the limits on length, pull and joints. */
#include "graph/check/check_parts.h"

#include <stdlib.h>

/* Checks that the passes of a cord follow each other, and that it is closed if it says so. */
static thr_status check_walk(const thr_frame *frame, const thr_cord *cord, thr_err *err)
{
  for (int i = 0; i + 1 < cord->n_passes; i++)
    if (thr_head(frame, cord->half[i]) != thr_tail(frame, cord->half[i + 1]))
      return thr_fail(err, THR_EVIOLATED,
                      "cord %s, pass %d: ends at node %d, but pass %d starts at node %d", cord->id,
                      i + 1, thr_head(frame, cord->half[i]), i + 2,
                      thr_tail(frame, cord->half[i + 1]));

  /* A cord is closed exactly if it ends where it starts. */
  bool meets = thr_cord_start(frame, cord) == thr_cord_end(frame, cord);

  if (cord->closed != meets)
    return thr_fail(err, THR_EVIOLATED, "cord %s: said to be %s, but runs from node %d to node %d",
                    cord->id, cord->closed ? "closed" : "open", thr_cord_start(frame, cord),
                    thr_cord_end(frame, cord));
  return THR_OK;
}

/* Checks that a cord ends where the request allows. */
static thr_status check_ends(const thr_frame *frame, const thr_request *options,
                             const thr_cord *cord, thr_err *err)
{
  if (options->ends == THR_ENDS_CLOSED && !cord->closed)
    return thr_fail(err, THR_EVIOLATED, "cord %s: open, but the plan's options say closed",
                    cord->id);

  /* Both ends, which may be at one node. */
  int end[2] = {thr_cord_start(frame, cord), thr_cord_end(frame, cord)};

  for (int i = 0; i < 2; i++)
    if (!thr_plan_end_allowed(frame, options, end[i]))
      return thr_fail(err, THR_EVIOLATED, "cord %s: %s at node %d, where no cord end is allowed",
                      cord->id, i ? "ends" : "starts", end[i]);
  return THR_OK;
}

/* Checks that every edge has the passes that it needs, and no more than fit. */
thr_status thr_check_cover(const thr_frame *frame, const thr_request *options, const int *passes,
                           thr_err *err)
{
  for (int e = 0; e < frame->n_edges; e++) {
    int least = thr_plan_cover(frame, options, e), most = thr_plan_capacity(frame, options, e);
    if (passes[e] < least)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d of %d passes", e,
                      frame->edge[e][0], frame->edge[e][1], passes[e], least);

    if (passes[e] > most)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d passes, but only %d fit",
                      e, frame->edge[e][0], frame->edge[e][1], passes[e], most);
  }
  return THR_OK;
}

/* Checks that every node has as many cord ends as the request says, if it says so
 * (THR_ENDS_COUNTS). */
static thr_status check_end_counts(const thr_frame *frame, const thr_request *options,
                                   const thr_cord *cord, int n_cords, thr_err *err)
{
  if (options->ends != THR_ENDS_COUNTS) return THR_OK;

  int *count = thr_calloc((size_t)frame->n_nodes, sizeof *count);
  thr_status st = count ? THR_OK : thr_nomem(err);

  /* Both ends of every cord count. */
  for (int i = 0; i < n_cords && !st; i++) {
    count[thr_cord_start(frame, &cord[i])]++;
    count[thr_cord_end(frame, &cord[i])]++;
  }

  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (count[v] != options->end_count[v])
      st = thr_fail(err, THR_EVIOLATED, "node %d: has %d cord %s; the plan's options say %d", v,
                    count[v], count[v] == 1 ? "end" : "ends", options->end_count[v]);

  free(count);
  return st;
}

/* Checks that no cord is longer than the request allows, but for rounding. */
static thr_status check_lengths(const thr_frame *frame, const thr_request *options,
                                const thr_cord *cord, int n_cords, thr_err *err)
{
  for (int i = 0; i < n_cords && options->max_length > 0; i++) {
    double length = thr_cord_length(frame, &cord[i]);
    if (length > options->max_length && !thr_check_close(length, options->max_length, length))
      return thr_fail(err, THR_EVIOLATED, "cord %s: %.12g long; the plan's options allow %.12g",
                      cord[i].id, length, options->max_length);
  }
  return THR_OK;
}

/* Checks tube joints (THR_JOINT_TUBE): no cord turns back into its edge, and the turns tie the
 * edges of every node together. */
static thr_status check_joints(const thr_frame *frame, const thr_request *options,
                               const thr_cord *cord, int n_cords, thr_err *err)
{
  if (options->joint != THR_JOINT_TUBE) return THR_OK;

  /* U-turns connect an edge with itself only. */
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < thr_cord_turns(options, &cord[i]); k++)
      if (cord[i].half[(k + 1) % cord[i].n_passes] >> 1 == cord[i].half[k] >> 1)
        return thr_fail(err, THR_EVIOLATED,
                        "cord %s, pass %d: turns back at node %d, which ties no tube joint",
                        cord[i].id, k + 1, thr_head(frame, cord[i].half[k]));

  /* Edges of a node are tied if turns connect them all (junction.c). */
  bool *tied = thr_calloc((size_t)frame->n_nodes, sizeof *tied);
  thr_status st =
      tied ? thr_junction_tied(frame, cord, n_cords, options->ends == THR_ENDS_CLOSED, tied, err)
           : thr_nomem(err);

  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (!tied[v])
      st = thr_fail(
          err, THR_EVIOLATED,
          "node %d: the cords do not tie its edges together, as the plan's tube joints need", v);

  free(tied);
  return st;
}

/* Checks all cords, and counts their passes. */
static thr_status check_cords(const thr_frame *frame, const thr_request *options,
                              const int *component, const thr_cord *cord, int n_cords, int *passes,
                              thr_err *err)
{
  thr_status st;

  /* Cord by cord. */
  for (int i = 0; i < n_cords; i++) {
    const thr_cord *c = &cord[i];
    if ((st = check_walk(frame, c, err))) return st;
    if ((st = check_ends(frame, options, c, err))) return st;

    /* A cord stays in the component where it starts. */
    if (component[thr_cord_start(frame, c)] != c->component)
      return thr_fail(err, THR_EVIOLATED,
                      "cord %s: said to be in component %d, but runs in component %d", c->id,
                      c->component, component[thr_cord_start(frame, c)]);

    for (int k = 0; k < c->n_passes; k++)
      passes[c->half[k] >> 1]++;
  }

  /* All cords together, and the limits of the request. */
  if ((st = thr_check_cover(frame, options, passes, err))) return st;
  if ((st = check_end_counts(frame, options, cord, n_cords, err))) return st;
  if ((st = check_lengths(frame, options, cord, n_cords, err))) return st;
  if ((st = thr_check_pulls(frame, options, cord, n_cords, err))) return st;
  return check_joints(frame, options, cord, n_cords, err);
}

void thr_check_walked_destroy(thr_check_walked *check_walked)
{
  free(check_walked->component);
  free(check_walked->passes);
  free(check_walked->cords);
  *check_walked = (thr_check_walked){0};
}

thr_status thr_check_walked_init(thr_check_walked *check_walked, const thr_frame *frame,
                                 const thr_request *options, thr_err *err)
{
  *check_walked = (thr_check_walked){
      .component = thr_calloc((size_t)frame->n_nodes, sizeof *check_walked->component),
      .passes = thr_calloc((size_t)frame->n_edges, sizeof *check_walked->passes)};

  thr_status st = check_walked->component && check_walked->passes ? THR_OK : thr_nomem(err);
  if (!st)
    st = thr_frame_components(frame, check_walked->component, &check_walked->n_components, err);
  if (!st && !(check_walked->cords =
                   thr_calloc((size_t)check_walked->n_components, sizeof *check_walked->cords)))
    st = thr_nomem(err);

  /* The most that a component may have, as long as the cords are not known. */
  for (int k = 0; k < check_walked->n_components && !st; k++)
    check_walked->cords[k] = options->cords;

  if (st) thr_check_walked_destroy(check_walked);
  return st;
}

static void count_cords(thr_check_walked *check_walked, const thr_cord *cord, int n_cords)
{
  for (int k = 0; k < check_walked->n_components; k++)
    check_walked->cords[k] = 0;

  for (int i = 0; i < n_cords; i++)
    check_walked->cords[cord[i].component]++;
}

thr_status thr_check_walked_from(thr_check_walked *check_walked, const thr_frame *frame,
                                 const thr_request *options, const thr_cord *cord, int n_cords,
                                 thr_err *err)
{
  thr_status st = thr_check_walked_init(check_walked, frame, options, err);
  if (st) return st;

  st = check_cords(frame, options, check_walked->component, cord, n_cords, check_walked->passes,
                   err);
  if (st) {
    thr_check_walked_destroy(check_walked);
    return st;
  }

  /* The numbers of cords replace the most that were allowed. */
  count_cords(check_walked, cord, n_cords);
  return THR_OK;
}

thr_status thr_check_cord_count(const thr_check_walked *check_walked, const thr_request *options,
                                thr_err *err)
{
  const int *count = check_walked->cords;
  thr_status st = THR_OK;
  bool counted = thr_plan_counted(options);
  int first = 0, end = check_walked->n_components,
      least = counted ? options->cords_least : options->cords;

  /* Numbers that were not asked for are compared in the component that has most. */
  for (int k = 0; k < check_walked->n_components && !st && !counted; k++) {
    if (count[k] > count[first]) first = k;
    end = first + 1;
  }

  for (int k = first; k < end && !st; k++) {
    const char *cords = count[k] == 1 ? "cord" : "cords";
    if (count[k] >= least && count[k] <= options->cords) continue;

    /* Say what the options ask for. */
    if (least == options->cords)
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d", k,
                    count[k], cords, least);
    else
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d to %d",
                    k, count[k], cords, least, options->cords);
  }
  return st;
}

double thr_check_length_of(const thr_frame *frame, const int *passes)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++)
    sum += passes[e] * frame->length[e];
  return sum;
}

thr_status thr_check_count_different(const thr_frame *frame, int distinct, const thr_cord *cord,
                                     int n_cords, int *found, thr_err *err)
{
  int *cords = thr_calloc((size_t)frame->n_edges, sizeof *cords);
  bool *here = thr_calloc((size_t)frame->n_edges, sizeof *here);
  thr_status st = cords && here ? THR_OK : thr_nomem(err);
  *found = 0;

  /* Count every cord once at each of its edges. */
  for (int i = 0; i < n_cords && !st; i++) {
    for (int k = 0; k < cord[i].n_passes; k++) {
      cords[cord[i].half[k] >> 1] += !here[cord[i].half[k] >> 1];
      here[cord[i].half[k] >> 1] = true;
    }

    for (int k = 0; k < cord[i].n_passes; k++)
      here[cord[i].half[k] >> 1] = false;
  }

  /* An edge counts if enough different cords pass it. */
  for (int e = 0; e < frame->n_edges && !st; e++)
    *found += cords[e] >= distinct;

  free(cords);
  free(here);
  return st;
}

thr_status thr_check_different(const thr_frame *frame, const thr_request *options,
                               const thr_cord *cord, int n_cords, int *each, thr_err *err)
{
  int found = 0;
  *each = 1;
  if (options->distinct < 2) return THR_OK;

  /* All edges, or none counts. */
  thr_status st = thr_check_count_different(frame, options->distinct, cord, n_cords, &found, err);
  if (found == frame->n_edges) *each = options->distinct;
  return st;
}
