/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the alternating trees: which blossoms are in a tree, as outer or inner ones, and which
 * events lie ahead of their nodes.
 *
 * Nothing is updated as time passes. The dual of an outer blossom is stored less the time at which
 * it became outer, the dual of an inner one plus this time, so that adding or subtracting the
 * present time gives the dual of now. Likewise for the moats of their nodes, to which the offset of
 * the blossom is added.
 *
 * Example: a node with dual 4 that becomes outer at time 3 is stored with dual 1, and at time 5 has
 * dual 6. */
#include "lp/matching/blossom_parts.h"

/* ---- joining and leaving a tree ---- */

/* Puts a blossom in front of the list of a tree. */
static void enlist(thr_matching_state *matching_state, int b, int tree)
{
  int head = matching_state->tree[tree];
  matching_state->b[b].tree = tree;
  matching_state->b[b].before = -1;
  matching_state->b[b].after = head;

  if (head >= 0) matching_state->b[head].before = b;
  matching_state->tree[tree] = b;
}

void thr_blossom_settle(thr_matching_state *matching_state, int b)
{
  blossom *leaving = &matching_state->b[b];
  int64_t change = leaving->label == OUTER ? matching_state->time : -matching_state->time;

  leaving->dual += change;
  leaving->offset += change;
  leaving->label = FREE;
}

void thr_blossom_leave(thr_matching_state *matching_state, int b)
{
  const blossom *leaving = &matching_state->b[b];

  /* Take the blossom out of the list of the tree. */
  thr_blossom_settle(matching_state, b);
  if (leaving->after >= 0) matching_state->b[leaving->after].before = leaving->before;
  if (leaving->before >= 0)
    matching_state->b[leaving->before].after = leaving->after;
  else
    matching_state->tree[leaving->tree] = leaving->after;
}

void thr_blossom_make_outer(thr_matching_state *matching_state, int b, int tree)
{
  /* An outer blossom has offset 0, so that it can become part of a larger one as it is: the
   * offset goes into the moats of its nodes. */
  blossom *made = &matching_state->b[b];
  int64_t change = made->offset - matching_state->time;
  for (int v = made->first; change; v = matching_state->node[v].next) {
    matching_state->node[v].moat += change;
    if (v == made->last) break;
  }

  made->label = OUTER;
  made->offset = 0;
  made->dual -= matching_state->time;
  made->mark = -1;

  enlist(matching_state, b, tree);
}

void thr_blossom_make_inner(thr_matching_state *matching_state, int b, int tree, int dart)
{
  blossom *made = &matching_state->b[b];

  made->label = INNER;
  made->offset += matching_state->time;
  made->dual += matching_state->time;
  made->entry = dart;

  enlist(matching_state, b, tree);

  /* A blossom that is no node is expanded when its dual falls to 0. */
  if (made->child >= 0) thr_blossom_push(matching_state, made->dual, ~b);
}

/* ---- queueing what lies ahead ---- */

/* Notes when the search for a half-integral matching ends, if no earlier end is known. */
static void foresee_end(thr_matching_state *matching_state, int64_t time, int dart)
{
  if (time >= matching_state->end_time) return;
  matching_state->end_time = time;
  matching_state->end_dart = dart;
}

void thr_blossom_look_out(thr_matching_state *matching_state, int b, int top)
{
  for (int u = matching_state->b[b].first;; u = matching_state->node[u].next) {
    /* Moats of outer nodes are stored less the time. */
    int64_t moat = matching_state->node[u].moat + matching_state->time;
    for (int k = matching_state->first_arc[u]; k < matching_state->first_arc[u + 1]; k++) {
      const blossom_arc *arc = &matching_state->arc[k];
      int other = top_of_node(matching_state, arc->head);
      const blossom *met = &matching_state->b[other];

      /* Edges inside the blossom, and edges to inner blossoms, do not become tighter. */
      if (other == top || met->label == INNER) continue;

      /* Both moats widen if the other one is outer, too, so that the gap closes at twice the
       * speed. */
      int64_t gap = arc->weight - moat - matching_state->node[arc->head].moat - met->offset;
      int64_t time =
          matching_state->time + (met->label == OUTER ? (gap - matching_state->time) / 2 : gap);

      /* While one tree grows, an exposed blossom or the tree itself ends the search. */
      if (matching_state->half_integral && (met->label == OUTER || met->match < 0))
        foresee_end(matching_state, time, arc->dart);
      else
        thr_blossom_push(matching_state, time, arc->dart);
    }
    if (u == matching_state->b[b].last) break;
  }
}

void thr_blossom_look_back(thr_matching_state *matching_state, int b)
{
  /* The blossom is free, so that only the moats at the other ends widen. */
  for (int v = matching_state->b[b].first;; v = matching_state->node[v].next) {
    int64_t moat =
        matching_state->node[v].moat + matching_state->b[b].offset + matching_state->time;
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++) {
      const blossom_arc *arc = &matching_state->arc[k];
      if (matching_state->b[top_of_node(matching_state, arc->head)].label != OUTER) continue;

      thr_blossom_push(matching_state,
                       matching_state->time + arc->weight - moat -
                           matching_state->node[arc->head].moat,
                       arc->dart ^ 1);
    }
    if (v == matching_state->b[b].last) break;
  }
}

/* ---- growing, and changing pairs ---- */

void thr_blossom_attach(thr_matching_state *matching_state, int dart)
{
  int tree = matching_state->b[top_of_node(matching_state, matching_state->tail[dart])].tree,
      inner = top_of_node(matching_state, matching_state->tail[dart ^ 1]);
  int mate = top_of_node(matching_state, matching_state->tail[matching_state->b[inner].match ^ 1]);

  thr_blossom_make_inner(matching_state, inner, tree, dart);
  thr_blossom_make_outer(matching_state, mate, tree);
  thr_blossom_look_out(matching_state, mate, mate);
}

void thr_blossom_change_pairs(thr_matching_state *matching_state, int b, int dart)
{
  /* From b up to the root: the blossom gets its new dart, and gives its old mate free. */
  for (;;) {
    int old = matching_state->b[b].match;
    matching_state->b[b].match = dart;
    if (old < 0) return;

    /* The mate, an inner blossom, is matched with the outer blossom above. */
    int inner = top_of_node(matching_state, matching_state->tail[old ^ 1]);
    dart = matching_state->b[inner].entry;
    matching_state->b[inner].match = dart ^ 1;
    b = top_of_node(matching_state, matching_state->tail[dart]);
  }
}
