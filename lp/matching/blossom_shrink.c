/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shrinks odd cycles of tight edges to blossoms, and opens blossoms again.
 *
 * The children of a blossom form a cycle by `next`, and `link` is the dart to the next one. The
 * nodes of a blossom are one list, put together of the children's lists, and one disjoint set
 * (union by size), so that opening a blossom moves only the nodes of its smaller children.
 *
 * Example: a tree has the root r, inner nodes c and d entered from r, and their mates a and b,
 * which are outer. When the edge ab becomes tight, the cycle r, c, a, b, d is shrunk to one outer
 * blossom. */
#include "lp/matching/blossom_parts.h"

/* ---- making ---- */

/* Returns the outer blossom above an outer one in its tree, or -1 for the root. */
static int above(thr_matching_state *matching_state, int b)
{
  if (matching_state->b[b].match < 0) return -1;
  int inner = top_of_node(matching_state, matching_state->tail[matching_state->b[b].match ^ 1]);
  return top_of_node(matching_state, matching_state->tail[matching_state->b[inner].entry]);
}

/* Returns the lowest outer blossom on both paths to the root. The two paths are followed in
 * turns, so that the search takes no longer than the cycle that is closed. */
static int lowest_common(thr_matching_state *matching_state, int a, int b)
{
  /* A new stamp makes all old marks void. */
  matching_state->stamp++;
  for (;;) {
    if (a >= 0) {
      if (matching_state->b[a].mark == matching_state->stamp) return a;
      matching_state->b[a].mark = matching_state->stamp;
      a = above(matching_state, a);
    }

    /* Swap the paths. */
    int other = a;
    a = b;
    b = other;
  }
}

/* Takes a blossom out of its tree and puts it before `next` in a cycle. Its nodes are stored as
 * those of outer blossoms from now on, as the new blossom is outer. */
static void link_child(thr_matching_state *matching_state, int b, int next, int link)
{
  /* Leaving the tree makes dual and offset those of now. */
  blossom *child = &matching_state->b[b];
  blossom_label was = child->label;
  thr_blossom_leave(matching_state, b);

  /* Moats of inner nodes are rewritten relative to the time; those of outer nodes are so
   * already. */
  for (int v = child->first; was == INNER; v = matching_state->node[v].next) {
    matching_state->node[v].moat += child->offset - matching_state->time;
    if (v == child->last) break;
  }

  /* The label is kept for those who look out from formerly inner children. */
  child->label = was;
  child->next = next;
  child->link = link;
}

/* Links the cycle that a dart closes: from the common blossom down to the tail of the dart, over
 * the dart, and from its head up to the common blossom. */
static void link_cycle(thr_matching_state *matching_state, int dart, int common)
{
  /* Up from the tail, an outer and an inner blossom at a time; the cycle runs the other way. */
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

  /* Up from the head, in the direction of the cycle. */
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
  int b = matching_state->spare[--matching_state->n_spare], at = common, largest = common;

  link_cycle(matching_state, dart, common);

  /* The new blossom is matched as the common one, which is the base of the cycle. */
  matching_state->b[b] = (blossom){.match = matching_state->b[common].match,
                                   .parent = -1,
                                   .child = common,
                                   .first = matching_state->b[common].first};

  /* Adopt the children, and put their lists of nodes together. */
  do {
    blossom *child = &matching_state->b[at];
    child->parent = b;
    matching_state->b[b].last = child->last;
    matching_state->b[b].size += child->size;
    if (child->size > matching_state->b[largest].size) largest = at;
    at = child->next;
    matching_state->node[child->last].next = matching_state->b[at].first;
  } while (at != common);

  /* Unite the disjoint sets, the root of the largest child on top. */
  do {
    matching_state->node[matching_state->b[at].root].up = matching_state->b[largest].root;
    at = matching_state->b[at].next;
  } while (at != common);
  matching_state->b[b].root = matching_state->b[largest].root;
  matching_state->node[matching_state->b[b].root].up = ~b;

  /* The nodes are stored as those of an outer blossom already: with this offset none is changed. */
  matching_state->b[b].offset = matching_state->time;
  thr_blossom_make_outer(matching_state, b, matching_state->b[common].tree);
  return b;
}

/* ---- opening ---- */

void thr_blossom_match_children(thr_matching_state *matching_state, int base)
{
  /* An odd number of children: after the base each child is matched with the next one. */
  for (int child = matching_state->b[base].next; child != base;) {
    int link = matching_state->b[child].link, mate = matching_state->b[child].next;
    matching_state->b[child].match = link;
    matching_state->b[mate].match = link ^ 1;
    child = matching_state->b[mate].next;
  }
}

void thr_blossom_open(thr_matching_state *matching_state, int b)
{
  int at = matching_state->b[b].child, match = matching_state->b[b].match;

  /* Make every child a top blossom and a disjoint set of its own. */
  do {
    blossom *child = &matching_state->b[at];

    /* The nodes of the child with b's root, the largest, point there already. */
    for (int v = child->first; child->root != matching_state->b[b].root;
         v = matching_state->node[v].next) {
      matching_state->node[v].up = child->root;
      if (v == child->last) break;
    }

    matching_state->node[child->root].up = ~at;
    child->parent = -1;
    child->label = FREE;
    child->offset = matching_state->b[b].offset;
    at = child->next;
  } while (at != matching_state->b[b].child);

  /* The child that the matched dart leaves keeps the dart; the others are matched in pairs. If b
   * is exposed, so is its first child. */
  int base = match < 0 ? at : top_of_node(matching_state, matching_state->tail[match]);
  matching_state->b[base].match = match;
  thr_blossom_match_children(matching_state, base);

  /* Give the blossom back. */
  matching_state->b[b] = (blossom){.child = -1};
  matching_state->spare[matching_state->n_spare++] = b;
}

/* Turns the direction of a cycle round. */
static void reverse_cycle(thr_matching_state *matching_state, int start)
{
  int b = start, next = matching_state->b[b].next, link = matching_state->b[b].link;
  do {
    blossom *passed = &matching_state->b[next];
    int after = passed->next, over = passed->link;
    passed->next = b;
    passed->link = link ^ 1;
    b = next;
    next = after;
    link = over;
  } while (b != start);
}

void thr_blossom_expand(thr_matching_state *matching_state, int b)
{
  int entry = matching_state->b[b].entry, match = matching_state->b[b].match,
      tree = matching_state->b[b].tree;

  /* b is inner, with dual 0. The tree enters at the child `in`, and the child `base` is matched. */
  thr_blossom_leave(matching_state, b);
  thr_blossom_open(matching_state, b);
  int base = top_of_node(matching_state, matching_state->tail[match]),
      in = top_of_node(matching_state, matching_state->tail[entry ^ 1]);

  /* The tree runs from `in` to base along the side of the cycle where `in` is matched with the next
   * child. The children on the other side are free. */
  if (in != base && matching_state->b[in].match != matching_state->b[in].link)
    reverse_cycle(matching_state, in);

  /* Free children may be met by other outer blossoms. */
  for (int child = matching_state->b[base].next; child != in; child = matching_state->b[child].next)
    thr_blossom_look_back(matching_state, child);

  /* Children from `in` to base are inner and outer in turns. The list of the tree overwrites the
   * links of the cycle, so that these are read first. */
  for (int child = in, dart = entry;;) {
    int outer = matching_state->b[child].next;
    thr_blossom_make_inner(matching_state, child, tree, dart);
    if (child == base) break;
    child = matching_state->b[outer].next;
    dart = matching_state->b[outer].link;
    thr_blossom_make_outer(matching_state, outer, tree);
    thr_blossom_look_out(matching_state, outer, outer);
  }
}
