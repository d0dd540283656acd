/* Inside graph/io: what the readers of JSON frameworks share (values and names, with the place of what is wrong), and those
 * readers. read_json.c says which one reads what. All fail with THR_EINPUT, which names the file, the way to the value and what
 * to do. */
#ifndef THR_READ_JSON_H
#define THR_READ_JSON_H

#include "graph/io/faces.h"
#include "graph/io/parts.h"

/* The way to a value, for messages: data.node["21"].x. It lives on the stack along the descent. */
typedef struct thr_json_where {
  const struct thr_json_where *up; /* NULL at the document itself */
  const char *key;                 /* NULL: an array's element */
  int index;
} thr_json_where;

typedef struct {
  const char *file;
  const thr_json *document; /* borrowed */
  thr_draft *d;
  thr_read_report *report;
  thr_err *err;
  thr_names names;
  thr_faces faces;
  thr_text scratch; /* for one name at a time */
  bool has_z;       /* some point has a z of its own */
  bool by_place;    /* links name nodes by their places in the list */
  uint64_t *place;  /* [n_found] of the frameworks of the document, where each stands but for numbers (place_of); owned */
  int n_found, found_capacity;
  thr_parts parts; /* the frameworks */
  int n_seen;      /* in the second walk through the document */
  int n_chosen;    /* how many are read */
} thr_json_reader;

/* ---- values: read_json_values.c ---- */

/* Fails with the way to the value and what is wrong with it. */
thr_status thr_json_bad(thr_json_reader *r, const thr_json_where *at, const char *what);

bool thr_json_is_array(const thr_json *v);
bool thr_json_is_object(const thr_json *v);

/* First of the members named, and which it was. */
const thr_json *thr_json_member(const thr_json *object, const char *const *keys, const char **which);
#define THR_JSON_MEMBER(o, which, ...) thr_json_member(o, (const char *const[]){__VA_ARGS__, NULL}, which)

/* Coordinates as [x, y, z] or as members x, y, z in either case, where defaults may stand in; a missing z is 0. */
thr_status thr_json_point(thr_json_reader *r, const thr_json_where *at, const thr_json *v, const thr_json *defaults,
                          double xyz[3]) THR_MUST_CHECK;

/* A length of an edge; null is 0, the distance of its nodes. */
thr_status thr_json_length(thr_json_reader *r, const thr_json_where *at, const thr_json *v, double *length) THR_MUST_CHECK;

/* Adds an edge's own numbers of passes, where there are some. */
thr_status thr_json_passes(thr_json_reader *r, const thr_json_where *at, const thr_json *cover,
                           const thr_json *capacity) THR_MUST_CHECK;

/* Index into n things. */
thr_status thr_json_index(thr_json_reader *r, const thr_json_where *at, const thr_json *v, int n, int *index) THR_MUST_CHECK;

/* What is not there, or null, leaves the default. */
thr_status thr_json_units(thr_json_reader *r, const thr_json_where *up, const char *key, const thr_json *v) THR_MUST_CHECK;

/* ---- names: read_json_values.c ---- */

/* What a value calls a node: a string, a number, or a tuple of these, written (a, b) as Python does. The result is
 * valid until the next call. */
thr_status thr_json_name_of(thr_json_reader *r, const thr_json_where *at, const thr_json *v, const char **name) THR_MUST_CHECK;

/* A key of an object as a name; the result is valid until the next call. */
thr_status thr_json_key_name(thr_json_reader *r, const thr_json_where *at, const char *key, const char **name) THR_MUST_CHECK;

/* The node of this name, or that a value names. */
thr_status thr_json_find_node(thr_json_reader *r, const thr_json_where *at, const char *name, int *node) THR_MUST_CHECK;
thr_status thr_json_reference(thr_json_reader *r, const thr_json_where *at, const thr_json *v, int *node) THR_MUST_CHECK;

/* ---- our own frames and plans, any lists of points and index pairs: read_json_own.c ---- */

/* The member of object that says something of every edge, if there is one. */
thr_status thr_json_edge_list(thr_json_reader *r, const thr_json_where *up, const thr_json *object, const char *key, int n_edges,
                              const thr_json **list) THR_MUST_CHECK;

thr_status thr_json_read_own(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;
thr_status thr_json_read_plan(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;

/* ---- COMPAS, its lines, assembly_instances, conmech: read_json_compas.c ---- */

/* Whether a key is a number, and which. */
bool thr_json_parse_key(const char *key, int64_t *number);

/* Whether a node stands on the ground, by any of the names that there are for it. */
thr_status thr_json_support(thr_json_reader *r, const thr_json_where *at, const thr_json *node, const thr_json *defaults,
                            bool *foot) THR_MUST_CHECK;

/* Of a line of COMPAS or Rhino the object with its ends, called *end[2], of a Polyline the list of its points; NULL if it is
 * neither. */
const thr_json *thr_json_points_of_line(const thr_json *v, const char *const **end);

/* GeoJSON's lines and polygons; points are skipped and counted. */
bool thr_json_is_geometry(const thr_json *v);
thr_status thr_json_read_geometry(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;

thr_status thr_json_read_compas(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;
thr_status thr_json_read_lines(thr_json_reader *r, const thr_json_where *at, const thr_json *list) THR_MUST_CHECK;
thr_status thr_json_read_assembly(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;

/* ---- networkx: read_json_graphs.c ---- */

thr_status thr_json_read_node_link(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;

/* networkx adjacency data: for each node the list of its neighbours. An edge that both ends list counts once. */
thr_status thr_json_read_adjacency(thr_json_reader *r, const thr_json_where *at, const thr_json *object) THR_MUST_CHECK;

#endif
