/* networkx node-link and adjacency, Cytoscape, sigma: lists of nodes and of links. */
#include "graph/io/read_json.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/io/scan.h"
#include "graph/status.h"

#include <stdio.h>
#include <string.h>

/* What is said of a node or a link: in its member data (Cytoscape) or attributes (graphology, sigma), or beside its name. */
static const thr_json *said_of(const thr_json *item)
{
  const char *key;
  const thr_json *said = THR_JSON_MEMBER(item, &key, "data", "attributes");
  return thr_json_is_object(said) ? said : item;
}

const thr_json *thr_json_said(const thr_json *item, const char *const *keys, const char **which)
{
  const thr_json *v = thr_json_member(said_of(item), keys, which);
  return v ? v : thr_json_member(item, keys, which);
}

#define SAID(item, which, ...) thr_json_said(item, (const char *const[]){__VA_ARGS__, NULL}, which)

/* The node that a link names. */
static thr_status find_end(thr_json_reader *r, const thr_json_where *at, const thr_json *v, int *node)
{
  return r->by_place ? thr_json_index(r, at, v, r->d->n_nodes, node) : thr_json_reference(r, at, v, node);
}

/* Decides whether links name nodes by their ids or, as networkx before 2.0, by their places in the list: by id if they can,
 * unless the ids are text and the links numbers. networkx before 1.10 writes the graph's attributes as a list. */
static thr_status choose_reading(thr_json_reader *r, const thr_json_where *at, const thr_json *object, const thr_json *links)
{
  const thr_json *nodes = thr_json_get(object, "nodes");
  const char *key;
  bool places = true, names = true, alike = true, text = true;
  for (int i = 0; i < thr_json_size(nodes); i++)
    text &= thr_json_string(SAID(thr_json_at(nodes, i), &key, "id", "key")) != NULL;
  for (int i = 0; i < 2 * thr_json_size(links) && places; i++) {
    const thr_json *link = thr_json_at(links, i / 2), *end = i % 2 ? SAID(link, &key, "target") : SAID(link, &key, "source");
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
    return thr_json_bad(r, at, "numbers that may be ids or places of nodes; write them as text, as the ids are");
  return THR_OK;
}

static thr_status read_link(thr_json_reader *r, const thr_json_where *at, const thr_json *link)
{
  const char *key;
  thr_json_where source = {at, "source", 0}, target = {at, "target", 0}, length_here = {at, "length", 0};
  int a = 0, b = 0;
  double length;
  thr_status st = find_end(r, &source, SAID(link, &key, "source"), &a);
  if (!st) st = find_end(r, &target, SAID(link, &key, "target"), &b);
  if (!st) st = thr_json_length(r, &length_here, SAID(link, &key, "length"), &length);
  if (!st) st = thr_draft_add_edge(r->d, a, b, length, r->err);
  return st ? st : thr_json_passes(r, at, SAID(link, &key, "cover"), SAID(link, &key, "capacity"));
}

/* A node's place: pos, else x and y, else position (where Cytoscape has drawn it). */
static thr_status read_graph_node(thr_json_reader *r, const thr_json_where *at, const thr_json *node, int i)
{
  const char *key, *x_key, *id_key;
  const thr_json *pos = SAID(node, &key, "pos"), *x = SAID(node, &x_key, "x", "X"), *id = SAID(node, &id_key, "id", "key");
  if (!pos && !x) pos = SAID(node, &key, "position");
  if (!pos) pos = thr_json_get(said_of(node), x_key) ? said_of(node) : node;
  thr_json_where pos_here = {at, key, 0}, id_here = {at, id_key, 0};
  double xyz[3];
  char number[16];
  snprintf(number, sizeof number, "%d", i);
  const char *name = number;
  bool foot;
  thr_status st = thr_json_point(r, x || strcmp(key, "pos") == 0 ? at : &pos_here, pos, NULL, xyz);
  if (!st) st = thr_json_support(r, at, said_of(node), node, &foot);
  if (!st && id) st = thr_json_name_of(r, &id_here, id, &name);
  return st ? st : thr_draft_add_node(r->d, xyz, name, foot, r->err);
}

static thr_status read_graph_nodes(thr_json_reader *r, const thr_json_where *list, const thr_json *nodes)
{
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(nodes) && !st; i++) {
    thr_json_where here = {list, NULL, i};
    st = read_graph_node(r, &here, thr_json_at(nodes, i), i);
  }
  return st ? st : thr_names_build(&r->names, r->d, r->file, r->err);
}

thr_status thr_json_read_node_link(thr_json_reader *r, const thr_json_where *at, const thr_json *object)
{
  const char *link_key;
  const thr_json *nodes = thr_json_get(object, "nodes"), *links = THR_JSON_MEMBER(object, &link_key, "links", "edges");
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

thr_status thr_json_read_cytoscape(thr_json_reader *r, const thr_json_where *at, const thr_json *object)
{
  const thr_json *elements = thr_json_get(object, "elements");
  const char *key;
  thr_json_where here = {at, "elements", 0};
  thr_status st = THR_OK;
  if (thr_json_is_object(elements)) return thr_json_read_node_link(r, &here, elements);
  for (int i = 0; i < thr_json_size(elements) && !st; i++) {
    thr_json_where item = {&here, NULL, i};
    if (!SAID(thr_json_at(elements, i), &key, "source")) st = read_graph_node(r, &item, thr_json_at(elements, i), r->d->n_nodes);
  }
  if (!st) st = thr_names_build(&r->names, r->d, r->file, r->err);
  for (int i = 0; i < thr_json_size(elements) && !st; i++) {
    thr_json_where item = {&here, NULL, i};
    if (SAID(thr_json_at(elements, i), &key, "source")) st = read_link(r, &item, thr_json_at(elements, i));
  }
  return st;
}

/* Does the list of neighbours name node v? */
static thr_status lists_node(thr_json_reader *r, const thr_json_where *at, const thr_json *neighbours, int v, bool *lists)
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

thr_status thr_json_read_adjacency(thr_json_reader *r, const thr_json_where *at, const thr_json *object)
{
  const thr_json *nodes = thr_json_get(object, "nodes"), *adjacency = thr_json_get(object, "adjacency");
  thr_json_where node_list = {at, "nodes", 0}, list = {at, "adjacency", 0};
  if (thr_json_size(adjacency) != thr_json_size(nodes)) return thr_json_bad(r, &list, "not one list of neighbours for each node");
  thr_status st = read_graph_nodes(r, &node_list, nodes);
  for (int v = 0; v < thr_json_size(adjacency) && !st; v++) {
    const thr_json *neighbours = thr_json_at(adjacency, v);
    thr_json_where here = {&list, NULL, v};
    for (int i = 0; i < thr_json_size(neighbours) && !st; i++) {
      const thr_json *item = thr_json_at(neighbours, i);
      thr_json_where there = {&here, NULL, i}, back = {&list, NULL, 0}, length_here = {&there, "length", 0};
      int to = 0;
      bool twice = false;
      double length;
      st = thr_json_reference(r, &there, thr_json_get(item, "id"), &to);
      back.index = to;
      if (!st && to < v) st = lists_node(r, &back, thr_json_at(adjacency, to), v, &twice);
      if (!st) st = thr_json_length(r, &length_here, thr_json_get(item, "length"), &length);
      if (st || twice) continue;
      st = thr_draft_add_edge(r->d, v, to, length, r->err);
      if (!st) st = thr_json_passes(r, &there, thr_json_get(item, "cover"), thr_json_get(item, "capacity"));
    }
  }
  return st;
}
