/* SPDX-License-Identifier: GPL-3.0-or-later */
/* networkx node-link and adjacency: lists of nodes and of links. */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <string.h>

/* The node that a link names. */
static thr_status find_end(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                           int *node)
{
  return r->by_place ? thr_json_index(r, at, v, r->d->n_nodes, node)
                     : thr_json_reference(r, at, v, node);
}

/* Decides whether links name nodes by their ids or, as networkx before 2.0, by their places in the
 * list: by id if they can, unless the ids are text and the links numbers. networkx before 1.10
 * writes the graph's attributes as a list. */
static thr_status choose_reading(thr_json_reader *r, const thr_json_where *at,
                                 const thr_json *object, const thr_json *links)
{
  const thr_json *nodes = thr_json_get(object, "nodes");
  bool places = true, names = true, alike = true, text = true;
  for (int i = 0; i < thr_json_size(nodes); i++)
    text &= thr_json_string(thr_json_get(thr_json_at(nodes, i), "id")) != NULL;
  for (int i = 0; i < 2 * thr_json_size(links) && places; i++) {
    const thr_json *link = thr_json_at(links, i / 2),
                   *end = thr_json_get(link, i % 2 ? "target" : "source");
    char number[24];
    int64_t place;
    places = thr_json_int(end, &place) && place >= 0 && place < r->d->n_nodes;
    if (!places) break;
    snprintf(number, sizeof number, "%d", (int)place);
    const int named = thr_names_find(&r->names, thr_span_of(number));
    names &= named >= 0;
    alike &= named == place;
  }
  r->by_place = places && (!names || thr_json_is_array(thr_json_get(object, "graph")));
  if (places && names && !alike && !r->by_place && text)
    return thr_json_bad(
        r, at, "numbers that may be ids or places of nodes; write them as text, as the ids are");
  return THR_OK;
}

static thr_status read_link(thr_json_reader *r, const thr_json_where *at, const thr_json *link)
{
  thr_json_where source = {at, "source", 0}, target = {at, "target", 0},
                 length_here = {at, "length", 0};
  int a = 0, b = 0;
  double length;
  thr_status st = find_end(r, &source, thr_json_get(link, "source"), &a);
  if (!st) st = find_end(r, &target, thr_json_get(link, "target"), &b);
  if (!st) st = thr_json_length(r, &length_here, thr_json_get(link, "length"), &length);
  if (!st) st = thr_draft_add_edge(r->d, a, b, length, r->err);
  return st ? st
            : thr_json_passes(r, at, thr_json_get(link, "cover"), thr_json_get(link, "capacity"));
}

/* A node's place: pos, else x and y, else position. */
static thr_status read_graph_node(thr_json_reader *r, const thr_json_where *at,
                                  const thr_json *node, int i)
{
  const char *key, *x_key, *id_key;
  const thr_json *pos = THR_JSON_MEMBER(node, &key, "pos"),
                 *x = THR_JSON_MEMBER(node, &x_key, "x", "X"),
                 *id = THR_JSON_MEMBER(node, &id_key, "id");
  if (!pos && !x) pos = THR_JSON_MEMBER(node, &key, "position");
  if (!pos) pos = node;
  thr_json_where pos_here = {at, key, 0}, id_here = {at, id_key, 0};
  double xyz[3];
  char number[16];
  snprintf(number, sizeof number, "%d", i);
  const char *name = number;
  bool foot;
  thr_status st = thr_json_point(r, x || strcmp(key, "pos") == 0 ? at : &pos_here, pos, NULL, xyz);
  if (!st) st = thr_json_support(r, at, node, node, &foot);
  if (!st && id) st = thr_json_name_of(r, &id_here, id, &name);
  return st ? st : thr_draft_add_node(r->d, xyz, name, foot, r->err);
}

static thr_status read_graph_nodes(thr_json_reader *r, const thr_json_where *list,
                                   const thr_json *nodes)
{
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(nodes) && !st; i++) {
    thr_json_where here = {list, NULL, i};
    st = read_graph_node(r, &here, thr_json_at(nodes, i), i);
  }
  return st ? st : thr_names_build(&r->names, r->d, r->file, r->err);
}

thr_status thr_json_read_node_link(thr_json_reader *r, const thr_json_where *at,
                                   const thr_json *object)
{
  const char *link_key;
  const thr_json *nodes = thr_json_get(object, "nodes"),
                 *links = THR_JSON_MEMBER(object, &link_key, "links", "edges");
  thr_json_where node_list = {at, "nodes", 0}, link_list = {at, link_key, 0};
  thr_status st = read_graph_nodes(r, &node_list, nodes);
  if (!st) st = choose_reading(r, &link_list, object, links);
  for (int i = 0; i < thr_json_size(links) && !st; i++) {
    thr_json_where here = {&link_list, NULL, i};
    st = read_link(r, &here, thr_json_at(links, i));
  }
  r->by_place = false;
  return st;
}

/* Does the list of neighbours name node v? */
static thr_status lists_node(thr_json_reader *r, const thr_json_where *at,
                             const thr_json *neighbours, int v, bool *lists)
{
  *lists = false;
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(neighbours) && !st && !*lists; i++) {
    thr_json_where here = {at, NULL, i};
    int to = -1;
    st = thr_json_reference(r, &here, thr_json_get(thr_json_at(neighbours, i), "id"), &to);
    *lists = to == v;
  }
  return st;
}

thr_status thr_json_read_adjacency(thr_json_reader *r, const thr_json_where *at,
                                   const thr_json *object)
{
  const thr_json *nodes = thr_json_get(object, "nodes"),
                 *adjacency = thr_json_get(object, "adjacency");
  thr_json_where node_list = {at, "nodes", 0}, list = {at, "adjacency", 0};
  if (thr_json_size(adjacency) != thr_json_size(nodes))
    return thr_json_bad(r, &list, "not one list of neighbours for each node");
  thr_status st = read_graph_nodes(r, &node_list, nodes);
  for (int v = 0; v < thr_json_size(adjacency) && !st; v++) {
    const thr_json *neighbours = thr_json_at(adjacency, v);
    thr_json_where here = {&list, NULL, v};
    for (int i = 0; i < thr_json_size(neighbours) && !st; i++) {
      const thr_json *item = thr_json_at(neighbours, i);
      thr_json_where there = {&here, NULL, i}, back = {&list, NULL, 0},
                     length_here = {&there, "length", 0};
      int to = 0;
      bool twice = false;
      double length;
      st = thr_json_reference(r, &there, thr_json_get(item, "id"), &to);
      back.index = to;
      if (!st && to < v) st = lists_node(r, &back, thr_json_at(adjacency, to), v, &twice);
      if (!st) st = thr_json_length(r, &length_here, thr_json_get(item, "length"), &length);
      if (st || twice) continue;
      st = thr_draft_add_edge(r->d, v, to, length, r->err);
      if (!st)
        st =
            thr_json_passes(r, &there, thr_json_get(item, "cover"), thr_json_get(item, "capacity"));
    }
  }
  return st;
}
