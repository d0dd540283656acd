/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blossoms made of odd cycles, and opened again. */
#include "lp/matching/blossom_parts.h"

/* ---- making ---- */

/* The outer blossom above an outer one in the tree, or -1. */
static int above(thr_matching_state *matching_state, int b)
{
  if (matching_state->b[b].match < 0) return -1;
  int inner = top_of_node(matching_state, matching_state->tail[matching_state->b[b].match ^ 1]);
  return top_of_node(matching_state, matching_state->tail[matching_state->b[inner].entry]);
}

/* The lowest outer blossom on both paths to the root. In turns, so that it takes no longer than the
 * cycle it closes. */
static int lowest_common(thr_matching_state *matching_state, int a, int b)
{
  matching_state->stamp++;
  for (;;) {
    if (a >= 0) {
      if (matching_state->b[a].mark == matching_state->stamp) return a;
      matching_state->b[a].mark = matching_state->stamp;
      a = above(matching_state, a);
    }
    int other = a;
    a = b;
    b = other;
  }
}

/* Takes a blossom out of its tree and puts it before next in a cycle; its nodes are as those of
 * outer ones from now on. */
static void link_child(thr_matching_state *matching_state, int c, int next, int link)
{
  blossom *x = &matching_state->b[c];
  blossom_label was = x->label;
  thr_blossom_leave(matching_state, c);
  for (int v = x->first; was == INNER; v = matching_state->node[v].next) {
    matching_state->node[v].moat += x->offset - matching_state->time;
    if (v == x->last) break;
  }
  x->label = was;
  x->next = next;
  x->link = link;
}

/* Links the cycle: from common down to the tail of dart, over it, and up from its head. */
static void link_cycle(thr_matching_state *matching_state, int dart, int common)
{
  int next = top_of_node(matching_state, matching_state->tail[dart ^ 1]), link = dart;
  for (int b = top_of_node(matching_state, matching_state->tail[dart]);;) {
    link_child(matching_state, b, next, link);
    if (b == common) break;
    int inner = top_of_node(matching_state, matching_state->tail[matching_state->b[b].match ^ 1]);
    link_child(matching_state, inner, b, matching_state->b[b].match ^ 1);
    next = inner;
    link = matching_state->b[inner].entry;
    b = top_of_node(matching_state, matching_state->tail[link]);
  }
  for (int b = top_of_node(matching_state, matching_state->tail[dart ^ 1]); b != common;) {
    int inner = top_of_node(matching_state, matching_state->tail[matching_state->b[b].match ^ 1]),
        up = matching_state->b[inner].entry ^ 1;
    link_child(matching_state, b, inner, matching_state->b[b].match);
    b = top_of_node(matching_state, matching_state->tail[up ^ 1]);
    link_child(matching_state, inner, b, up);
  }
}

int thr_blossom_shrink(thr_matching_state *matching_state, int dart)
{
  int common =
      lowest_common(matching_state, top_of_node(matching_state, matching_state->tail[dart]),
                    top_of_node(matching_state, matching_state->tail[dart ^ 1]));
  int b = matching_state->spare[--matching_state->n_spare], c = common, largest = common;
  link_cycle(matching_state, dart, common);
  matching_state->b[b] = (blossom){.match = matching_state->b[common].match,
                                   .parent = -1,
                                   .child = common,
                                   .first = matching_state->b[common].first};
  do {
    blossom *x = &matching_state->b[c];
    x->parent = b;
    matching_state->b[b].last = x->last;
    matching_state->b[b].size += x->size;
    if (x->size > matching_state->b[largest].size) largest = c;
    c = x->next;
    matching_state->node[x->last].next = matching_state->b[c].first;
  } while (c != common);
  do {
    matching_state->node[matching_state->b[c].root].up = matching_state->b[largest].root;
    c = matching_state->b[c].next;
  } while (c != common);
  matching_state->b[b].root = matching_state->b[largest].root;
  matching_state->node[matching_state->b[b].root].up = ~b;
  matching_state->b[b].offset =
      matching_state->time; /* its nodes are as those of outer blossoms already */
  thr_blossom_make_outer(matching_state, b, matching_state->b[common].tree);
  return b;
}

/* ---- opening ---- */

void thr_blossom_match_children(thr_matching_state *matching_state, int base)
{
  for (int c = matching_state->b[base].next; c != base;) {
    int link = matching_state->b[c].link, mate = matching_state->b[c].next;
    matching_state->b[c].match = link;
    matching_state->b[mate].match = link ^ 1;
    c = matching_state->b[mate].next;
  }
}

void thr_blossom_open(thr_matching_state *matching_state, int b)
{
  int c = matching_state->b[b].child, match = matching_state->b[b].match;
  do {
    blossom *x = &matching_state->b[c];
    for (int v = x->first; x->root != matching_state->b[b].root;
         v = matching_state->node[v].next) { /* all but the largest child */
      matching_state->node[v].up = x->root;
      if (v == x->last) break;
    }
    matching_state->node[x->root].up = ~c;
    x->parent = -1;
    x->label = FREE;
    x->offset = matching_state->b[b].offset;
    c = x->next;
  } while (c != matching_state->b[b].child);
  int base = match < 0 ? c : top_of_node(matching_state, matching_state->tail[match]);
  matching_state->b[base].match = match;
  thr_blossom_match_children(matching_state, base);
  matching_state->b[b] = (blossom){.child = -1};
  matching_state->spare[matching_state->n_spare++] = b;
}

/* Turns the cycle round. */
static void reverse_cycle(thr_matching_state *matching_state, int start)
{
  int b = start, next = matching_state->b[b].next, link = matching_state->b[b].link;
  do {
    blossom *x = &matching_state->b[next];
    int after = x->next, over = x->link;
    x->next = b;
    x->link = link ^ 1;
    b = next;
    next = after;
    link = over;
  } while (b != start);
}

void thr_blossom_expand(thr_matching_state *matching_state, int b)
{
  int entry = matching_state->b[b].entry, match = matching_state->b[b].match,
      tree = matching_state->b[b].tree;
  thr_blossom_leave(matching_state, b);
  thr_blossom_open(matching_state, b);
  int base = top_of_node(matching_state, matching_state->tail[match]),
      in = top_of_node(matching_state, matching_state->tail[entry ^ 1]);
  /* the tree goes round the side where its alternation fits, the children on the other side are
   * free */
  if (in != base && matching_state->b[in].match != matching_state->b[in].link)
    reverse_cycle(matching_state, in);
  for (int c = matching_state->b[base].next; c != in; c = matching_state->b[c].next)
    thr_blossom_look_back(matching_state, c);
  for (int c = in, dart = entry;;) { /* the list of the tree takes the place of the cycle's */
    int outer = matching_state->b[c].next;
    thr_blossom_make_inner(matching_state, c, tree, dart);
    if (c == base) break;
    c = matching_state->b[outer].next;
    dart = matching_state->b[outer].link;
    thr_blossom_make_outer(matching_state, outer, tree);
    thr_blossom_look_out(matching_state, outer, outer);
  }
}
