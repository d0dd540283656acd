/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads graphs as networkx writes them: node-link data (lists of nodes and of links) and adjacency
 * data (for each node the list of its neighbours). Nodes have a place as pos, as x and y, or as
 * position.
 *
 * Example of node-link data:
 *     {"nodes": [{"id": "a", "x": 0, "y": 0}, {"id": "b", "x": 20, "y": 0}],
 *      "links": [{"source": "a", "target": "b"}]} */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <string.h>

/* Finds the node that a link names, by place or by id. */
static thr_status find_end(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                           int *node)
{
  return reader->by_place ? thr_json_index(reader, at, value, reader->d->n_nodes, node)
                          : thr_json_reference(reader, at, value, node);
}

/* Decides whether links name nodes by their ids or, as networkx before 2.0, by their places in the
 * list. Ids are taken if all ends are ids. THR_EINPUT if both readings are possible and differ, and
 * the ids are text while the links have numbers. networkx before 1.10 writes the graph's attributes
 * as a list, so that files of it are known to use places. */
static thr_status choose_reading(thr_json_reader *reader, const thr_json_where *at,
                                 const thr_json *object, const thr_json *links)
{
  const thr_json *nodes = thr_json_get(object, "nodes");
  bool places = true, names = true, alike = true, text = true;

  /* Are all ids text? */
  for (int i = 0; i < thr_json_size(nodes); i++)
    text &= thr_json_string(thr_json_get(thr_json_at(nodes, i), "id")) != NULL;

  /* Are all ends places, are all of them ids, and do both mean the same nodes? */
  for (int i = 0; i < 2 * thr_json_size(links) && places; i++) {
    const thr_json *link = thr_json_at(links, i / 2),
                   *end = thr_json_get(link, i % 2 ? "target" : "source");
    char number[24];
    int64_t place;
    places = thr_json_int(end, &place) && place >= 0 && place < reader->d->n_nodes;
    if (!places) break;
    snprintf(number, sizeof number, "%d", (int)place);
    const int named = thr_names_find(&reader->names, thr_span_of(number));
    names &= named >= 0;
    alike &= named == place;
  }

  reader->by_place = places && (!names || thr_json_is_array(thr_json_get(object, "graph")));
  if (places && names && !alike && !reader->by_place && text)
    return thr_json_bad(
        reader, at,
        "numbers that may be ids or places of nodes; write them as text, as the ids are");

  return THR_OK;
}

/* Reads a link as an edge with its length and passes. */
static thr_status read_link(thr_json_reader *reader, const thr_json_where *at, const thr_json *link)
{
  thr_json_where source = {at, "source", 0}, target = {at, "target", 0},
                 length_here = {at, "length", 0};
  int a = 0, b = 0;
  double length;

  /* Both ends. */
  thr_status st = find_end(reader, &source, thr_json_get(link, "source"), &a);
  if (!st) st = find_end(reader, &target, thr_json_get(link, "target"), &b);
  if (!st) st = thr_json_length(reader, &length_here, thr_json_get(link, "length"), &length);
  if (!st) st = thr_draft_add_edge(reader->d, a, b, length, reader->err);

  return st ? st
            : thr_json_passes(reader, at, thr_json_get(link, "cover"),
                              thr_json_get(link, "capacity"));
}

/* Reads a node: its place is pos, else x and y, else position; its name is its id, else its
 * number. */
static thr_status read_graph_node(thr_json_reader *reader, const thr_json_where *at,
                                  const thr_json *node, int i)
{
  const char *key, *x_key, *id_key;
  const thr_json *pos = THR_JSON_MEMBER(node, &key, "pos"),
                 *x = THR_JSON_MEMBER(node, &x_key, "x", "X"),
                 *id = THR_JSON_MEMBER(node, &id_key, "id");

  /* position is often a place in a diagram, so it comes last. */
  if (!pos && !x) pos = THR_JSON_MEMBER(node, &key, "position");
  if (!pos) pos = node;
  thr_json_where pos_here = {at, key, 0}, id_here = {at, id_key, 0};
  double xyz[3];

  /* A node without an id is called by its number. */
  char number[16];
  snprintf(number, sizeof number, "%d", i);
  const char *name = number;
  bool foot;

  /* The path in messages leads to the coordinates. */
  thr_status st =
      thr_json_point(reader, x || strcmp(key, "pos") == 0 ? at : &pos_here, pos, NULL, xyz);
  if (!st) st = thr_json_support(reader, at, node, node, &foot);
  if (!st && id) st = thr_json_name_of(reader, &id_here, id, &name);

  return st ? st : thr_draft_add_node(reader->d, xyz, name, foot, reader->err);
}

/* Reads all nodes, and sorts their names. */
static thr_status read_graph_nodes(thr_json_reader *reader, const thr_json_where *list,
                                   const thr_json *nodes)
{
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(nodes) && !st; i++) {
    thr_json_where here = {list, NULL, i};
    st = read_graph_node(reader, &here, thr_json_at(nodes, i), i);
  }
  return st ? st : thr_names_build(&reader->names, reader->d, reader->file, reader->err);
}

/* Reads nodes, decides how links name them, and reads the links. */
thr_status thr_json_read_node_link(thr_json_reader *reader, const thr_json_where *at,
                                   const thr_json *object)
{
  const char *link_key;
  const thr_json *nodes = thr_json_get(object, "nodes"),
                 *links = THR_JSON_MEMBER(object, &link_key, "links", "edges");
  thr_json_where node_list = {at, "nodes", 0}, link_list = {at, link_key, 0};

  /* Nodes first, because links may come before them in the file but name them. */
  thr_status st = read_graph_nodes(reader, &node_list, nodes);
  if (!st) st = choose_reading(reader, &link_list, object, links);

  /* Links in the order of the file. */
  for (int i = 0; i < thr_json_size(links) && !st; i++) {
    thr_json_where here = {&link_list, NULL, i};
    st = read_link(reader, &here, thr_json_at(links, i));
  }

  reader->by_place = false;
  return st;
}

/* Finds whether the list of neighbours names node v. */
static thr_status lists_node(thr_json_reader *reader, const thr_json_where *at,
                             const thr_json *neighbours, int v, bool *lists)
{
  *lists = false;
  thr_status st = THR_OK;

  /* The first match is enough. */
  for (int i = 0; i < thr_json_size(neighbours) && !st && !*lists; i++) {
    thr_json_where here = {at, NULL, i};
    int to = -1;
    st = thr_json_reference(reader, &here, thr_json_get(thr_json_at(neighbours, i), "id"), &to);
    *lists = to == v;
  }

  return st;
}

/* Reads nodes, and the lists of their neighbours as edges. */
thr_status thr_json_read_adjacency(thr_json_reader *reader, const thr_json_where *at,
                                   const thr_json *object)
{
  const thr_json *nodes = thr_json_get(object, "nodes"),
                 *adjacency = thr_json_get(object, "adjacency");
  thr_json_where node_list = {at, "nodes", 0}, list = {at, "adjacency", 0};

  /* Lists and nodes correspond by their places. */
  if (thr_json_size(adjacency) != thr_json_size(nodes))
    return thr_json_bad(reader, &list, "not one list of neighbours for each node");

  thr_status st = read_graph_nodes(reader, &node_list, nodes);

  /* Each list belongs to the node at the same place. */
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

      /* A neighbour that came before and lists this node, too, has added the edge already. */
      st = thr_json_reference(reader, &there, thr_json_get(item, "id"), &to);
      back.index = to;
      if (!st && to < v) st = lists_node(reader, &back, thr_json_at(adjacency, to), v, &twice);
      if (!st) st = thr_json_length(reader, &length_here, thr_json_get(item, "length"), &length);

      /* A new edge, with what this list says of it. */
      if (st || twice) continue;
      st = thr_draft_add_edge(reader->d, v, to, length, reader->err);
      if (!st)
        st = thr_json_passes(reader, &there, thr_json_get(item, "cover"),
                             thr_json_get(item, "capacity"));
    }
  }

  return st;
}
