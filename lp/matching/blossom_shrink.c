/* Blossoms made of odd cycles, and opened again. */
#include "lp/matching/blossom_parts.h"

/* ---- making ---- */

/* The outer blossom above an outer one in the tree, or -1. */
static int above(thr_matching_state *s, int b)
{
  if (s->b[b].match < 0) return -1;
  int inner = top_of_node(s, s->tail[s->b[b].match ^ 1]);
  return top_of_node(s, s->tail[s->b[inner].entry]);
}

/* The lowest outer blossom on both paths to the root. In turns, so that it takes no longer than the cycle it closes. */
static int lowest_common(thr_matching_state *s, int a, int b)
{
  s->stamp++;
  for (;;) {
    if (a >= 0) {
      if (s->b[a].mark == s->stamp) return a;
      s->b[a].mark = s->stamp;
      a = above(s, a);
    }
    int other = a;
    a = b;
    b = other;
  }
}

/* Takes a blossom out of its tree and puts it before next in a cycle; its nodes are as those of outer ones from now on. */
static void link_child(thr_matching_state *s, int c, int next, int link)
{
  blossom *x = &s->b[c];
  blossom_label was = x->label;
  thr_blossom_leave(s, c);
  for (int v = x->first; was == INNER; v = s->node[v].next) {
    s->node[v].moat += x->offset - s->time;
    if (v == x->last) break;
  }
  x->label = was;
  x->next = next;
  x->link = link;
}

/* Links the cycle: from common down to the tail of dart, over it, and up from its head. */
static void link_cycle(thr_matching_state *s, int dart, int common)
{
  int next = top_of_node(s, s->tail[dart ^ 1]), link = dart;
  for (int b = top_of_node(s, s->tail[dart]);;) {
    link_child(s, b, next, link);
    if (b == common) break;
    int inner = top_of_node(s, s->tail[s->b[b].match ^ 1]);
    link_child(s, inner, b, s->b[b].match ^ 1);
    next = inner;
    link = s->b[inner].entry;
    b = top_of_node(s, s->tail[link]);
  }
  for (int b = top_of_node(s, s->tail[dart ^ 1]); b != common;) {
    int inner = top_of_node(s, s->tail[s->b[b].match ^ 1]), up = s->b[inner].entry ^ 1;
    link_child(s, b, inner, s->b[b].match);
    b = top_of_node(s, s->tail[up ^ 1]);
    link_child(s, inner, b, up);
  }
}

int thr_blossom_shrink(thr_matching_state *s, int dart)
{
  int common = lowest_common(s, top_of_node(s, s->tail[dart]), top_of_node(s, s->tail[dart ^ 1]));
  int b = s->spare[--s->n_spare], c = common, largest = common;
  link_cycle(s, dart, common);
  s->b[b] = (blossom){.match = s->b[common].match, .parent = -1, .child = common, .first = s->b[common].first};
  do {
    blossom *x = &s->b[c];
    x->parent = b;
    s->b[b].last = x->last;
    s->b[b].size += x->size;
    if (x->size > s->b[largest].size) largest = c;
    c = x->next;
    s->node[x->last].next = s->b[c].first;
  } while (c != common);
  do {
    s->node[s->b[c].root].up = s->b[largest].root;
    c = s->b[c].next;
  } while (c != common);
  s->b[b].root = s->b[largest].root;
  s->node[s->b[b].root].up = ~b;
  s->b[b].offset = s->time; /* its nodes are as those of outer blossoms already */
  thr_blossom_make_outer(s, b, s->b[common].tree);
  return b;
}

/* ---- opening ---- */

void thr_blossom_match_children(thr_matching_state *s, int base)
{
  for (int c = s->b[base].next; c != base;) {
    int link = s->b[c].link, mate = s->b[c].next;
    s->b[c].match = link;
    s->b[mate].match = link ^ 1;
    c = s->b[mate].next;
  }
}

void thr_blossom_open(thr_matching_state *s, int b)
{
  int c = s->b[b].child, match = s->b[b].match;
  do {
    blossom *x = &s->b[c];
    for (int v = x->first; x->root != s->b[b].root; v = s->node[v].next) { /* all but the largest child */
      s->node[v].up = x->root;
      if (v == x->last) break;
    }
    s->node[x->root].up = ~c;
    x->parent = -1;
    x->label = FREE;
    x->offset = s->b[b].offset;
    c = x->next;
  } while (c != s->b[b].child);
  int base = match < 0 ? c : top_of_node(s, s->tail[match]);
  s->b[base].match = match;
  thr_blossom_match_children(s, base);
  s->b[b] = (blossom){.child = -1};
  s->spare[s->n_spare++] = b;
}

/* Turns the cycle round. */
static void reverse_cycle(thr_matching_state *s, int start)
{
  int b = start, next = s->b[b].next, link = s->b[b].link;
  do {
    blossom *x = &s->b[next];
    int after = x->next, over = x->link;
    x->next = b;
    x->link = link ^ 1;
    b = next;
    next = after;
    link = over;
  } while (b != start);
}

void thr_blossom_expand(thr_matching_state *s, int b)
{
  int entry = s->b[b].entry, match = s->b[b].match, tree = s->b[b].tree;
  thr_blossom_leave(s, b);
  thr_blossom_open(s, b);
  int base = top_of_node(s, s->tail[match]), in = top_of_node(s, s->tail[entry ^ 1]);
  /* the tree goes round the side where its alternation fits, the children on the other side are free */
  if (in != base && s->b[in].match != s->b[in].link) reverse_cycle(s, in);
  for (int c = s->b[base].next; c != in; c = s->b[c].next)
    thr_blossom_look_back(s, c);
  for (int c = in, dart = entry;;) { /* the list of the tree takes the place of the cycle's */
    int outer = s->b[c].next;
    thr_blossom_make_inner(s, c, tree, dart);
    if (c == base) break;
    c = s->b[outer].next;
    dart = s->b[outer].link;
    thr_blossom_make_outer(s, outer, tree);
    thr_blossom_look_out(s, outer, outer);
  }
}
