/* Alternating trees: who is in them and what they see. */
#include "lp/matching/blossom_parts.h"

/* ---- in and out ---- */

static void enlist(thr_matching_state *s, int b, int tree)
{
  int head = s->tree[tree];
  s->b[b].tree = tree;
  s->b[b].before = -1;
  s->b[b].after = head;
  if (head >= 0) s->b[head].before = b;
  s->tree[tree] = b;
}

void thr_blossom_settle(thr_matching_state *s, int b)
{
  blossom *x = &s->b[b];
  int64_t change = x->label == OUTER ? s->time : -s->time;
  x->dual += change;
  x->offset += change;
  x->label = FREE;
}

void thr_blossom_leave(thr_matching_state *s, int b)
{
  const blossom *x = &s->b[b];
  thr_blossom_settle(s, b);
  if (x->after >= 0) s->b[x->after].before = x->before;
  if (x->before >= 0)
    s->b[x->before].after = x->after;
  else
    s->tree[x->tree] = x->after;
}

void thr_blossom_make_outer(thr_matching_state *s, int b, int tree)
{
  blossom *x = &s->b[b];
  int64_t change = x->offset - s->time;
  for (int v = x->first; change; v = s->node[v].next) { /* no offset: so it can become part of a larger one as it is */
    s->node[v].moat += change;
    if (v == x->last) break;
  }
  x->label = OUTER;
  x->offset = 0;
  x->dual -= s->time;
  x->mark = -1;
  enlist(s, b, tree);
}

void thr_blossom_make_inner(thr_matching_state *s, int b, int tree, int dart)
{
  blossom *x = &s->b[b];
  x->label = INNER;
  x->offset += s->time;
  x->dual += s->time;
  x->entry = dart;
  enlist(s, b, tree);
  if (x->child >= 0) thr_blossom_push(s, x->dual, ~b);
}

/* ---- looking round ---- */

static void foresee_end(thr_matching_state *s, int64_t time, int dart)
{
  if (time >= s->end_time) return;
  s->end_time = time;
  s->end_dart = dart;
}

void thr_blossom_look_out(thr_matching_state *s, int b, int top)
{
  for (int u = s->b[b].first;; u = s->node[u].next) {
    int64_t moat = s->node[u].moat + s->time;
    for (int k = s->first_arc[u]; k < s->first_arc[u + 1]; k++) {
      const blossom_arc *arc = &s->arc[k];
      int other = top_of_node(s, arc->head);
      const blossom *x = &s->b[other];
      if (other == top || x->label == INNER) continue;
      int64_t gap = arc->weight - moat - s->node[arc->head].moat - x->offset;
      int64_t time = s->time + (x->label == OUTER ? (gap - s->time) / 2 : gap);
      if (s->half_integral && (x->label == OUTER || x->match < 0))
        foresee_end(s, time, arc->dart);
      else
        thr_blossom_push(s, time, arc->dart);
    }
    if (u == s->b[b].last) break;
  }
}

void thr_blossom_look_back(thr_matching_state *s, int b)
{
  for (int v = s->b[b].first;; v = s->node[v].next) {
    int64_t moat = s->node[v].moat + s->b[b].offset + s->time;
    for (int k = s->first_arc[v]; k < s->first_arc[v + 1]; k++) {
      const blossom_arc *arc = &s->arc[k];
      if (s->b[top_of_node(s, arc->head)].label != OUTER) continue;
      thr_blossom_push(s, s->time + arc->weight - moat - s->node[arc->head].moat, arc->dart ^ 1);
    }
    if (v == s->b[b].last) break;
  }
}

/* ---- growing and matching ---- */

void thr_blossom_attach(thr_matching_state *s, int dart)
{
  int tree = s->b[top_of_node(s, s->tail[dart])].tree, inner = top_of_node(s, s->tail[dart ^ 1]);
  int mate = top_of_node(s, s->tail[s->b[inner].match ^ 1]);
  thr_blossom_make_inner(s, inner, tree, dart);
  thr_blossom_make_outer(s, mate, tree);
  thr_blossom_look_out(s, mate, mate);
}

void thr_blossom_change_pairs(thr_matching_state *s, int b, int dart)
{
  for (;;) {
    int old = s->b[b].match;
    s->b[b].match = dart;
    if (old < 0) return;
    int inner = top_of_node(s, s->tail[old ^ 1]);
    dart = s->b[inner].entry;
    s->b[inner].match = dart ^ 1;
    b = top_of_node(s, s->tail[dart]);
  }
}
