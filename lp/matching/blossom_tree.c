/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Alternating trees: who is in them and what they see. */
#include "lp/matching/blossom_parts.h"

/* ---- in and out ---- */

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
  blossom *x = &matching_state->b[b];
  int64_t change = x->label == OUTER ? matching_state->time : -matching_state->time;
  x->dual += change;
  x->offset += change;
  x->label = FREE;
}

void thr_blossom_leave(thr_matching_state *matching_state, int b)
{
  const blossom *x = &matching_state->b[b];
  thr_blossom_settle(matching_state, b);
  if (x->after >= 0) matching_state->b[x->after].before = x->before;
  if (x->before >= 0)
    matching_state->b[x->before].after = x->after;
  else
    matching_state->tree[x->tree] = x->after;
}

void thr_blossom_make_outer(thr_matching_state *matching_state, int b, int tree)
{
  blossom *x = &matching_state->b[b];
  int64_t change = x->offset - matching_state->time;
  for (int v = x->first; change;
       v = matching_state->node[v]
               .next) { /* no offset: so it can become part of a larger one as it is */
    matching_state->node[v].moat += change;
    if (v == x->last) break;
  }
  x->label = OUTER;
  x->offset = 0;
  x->dual -= matching_state->time;
  x->mark = -1;
  enlist(matching_state, b, tree);
}

void thr_blossom_make_inner(thr_matching_state *matching_state, int b, int tree, int dart)
{
  blossom *x = &matching_state->b[b];
  x->label = INNER;
  x->offset += matching_state->time;
  x->dual += matching_state->time;
  x->entry = dart;
  enlist(matching_state, b, tree);
  if (x->child >= 0) thr_blossom_push(matching_state, x->dual, ~b);
}

/* ---- looking round ---- */

static void foresee_end(thr_matching_state *matching_state, int64_t time, int dart)
{
  if (time >= matching_state->end_time) return;
  matching_state->end_time = time;
  matching_state->end_dart = dart;
}

void thr_blossom_look_out(thr_matching_state *matching_state, int b, int top)
{
  for (int u = matching_state->b[b].first;; u = matching_state->node[u].next) {
    int64_t moat = matching_state->node[u].moat + matching_state->time;
    for (int k = matching_state->first_arc[u]; k < matching_state->first_arc[u + 1]; k++) {
      const blossom_arc *arc = &matching_state->arc[k];
      int other = top_of_node(matching_state, arc->head);
      const blossom *x = &matching_state->b[other];
      if (other == top || x->label == INNER) continue;
      int64_t gap = arc->weight - moat - matching_state->node[arc->head].moat - x->offset;
      int64_t time =
          matching_state->time + (x->label == OUTER ? (gap - matching_state->time) / 2 : gap);
      if (matching_state->half_integral && (x->label == OUTER || x->match < 0))
        foresee_end(matching_state, time, arc->dart);
      else
        thr_blossom_push(matching_state, time, arc->dart);
    }
    if (u == matching_state->b[b].last) break;
  }
}

void thr_blossom_look_back(thr_matching_state *matching_state, int b)
{
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

/* ---- growing and matching ---- */

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
  for (;;) {
    int old = matching_state->b[b].match;
    matching_state->b[b].match = dart;
    if (old < 0) return;
    int inner = top_of_node(matching_state, matching_state->tail[old ^ 1]);
    dart = matching_state->b[inner].entry;
    matching_state->b[inner].match = dart ^ 1;
    b = top_of_node(matching_state, matching_state->tail[dart]);
  }
}
