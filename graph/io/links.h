/* Internal to the readers of graphs: edges by the names of their nodes, which may come after them. */
#ifndef THR_LINKS_H
#define THR_LINKS_H

#include "graph/io/scan.h"

/* {0} is valid and empty. */
typedef struct {
  int n, capacity;
  struct thr_link {
    size_t from, to; /* where the names begin in names */
    double length;   /* 0 = the distance of the nodes */
    int cover, passes;
    int line;
  } * link; /* owned */
  thr_text names;
} thr_links;

/* Appends an edge; both names are copied and cleaned as the draft cleans those of nodes. passes: its capacity, 0 = not said. */
thr_status thr_links_add(thr_links *links, const char *from, const char *to, int line, thr_err *err) THR_MUST_CHECK;

/* Adds all edges to the draft. THR_EINPUT as "name:line: .." if there is no node of a name or two nodes have one. */
thr_status thr_links_finish(const thr_links *links, thr_draft *draft, const char *name, thr_err *err) THR_MUST_CHECK;

void thr_links_destroy(thr_links *links);

/* What a graph says of a node or an edge, attribute by attribute, in whatever words: a node's x, y, z, whether it is a foot and
 * what it is called; an edge's length, cover and capacity. */
typedef struct {
  double xyz[3];
  bool has[3];
  bool foot;
  double length;
  int cover, capacity;
} thr_said;

/* Takes an attribute in; *what is set to what is wrong with its value. Others are left alone. */
void thr_said_take(thr_said *said, thr_span key, thr_span value, const char **what);

/* A node without x or y is THR_EINPUT; one without z lies at 0. */
thr_status thr_said_node(const thr_said *said, thr_draft *draft, const char *node, bool *has_z, const thr_scan *scan,
                         thr_err *err) THR_MUST_CHECK;

/* What is said of the edge added last. */
void thr_said_link(const thr_said *said, thr_links *links);

#endif
