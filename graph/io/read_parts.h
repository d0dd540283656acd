/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what the readers share and nobody else sees: scanners of text and tables, parts, faces,
 * curves, links between records, the table of formats. The room's head is graph/io/read.h. */
#ifndef THR_READ_PARTS_H
#define THR_READ_PARTS_H

#include "graph/io/read.h"

/* ---- scan.c: Internal to the readers: lines, words and numbers of text formats, node names. */

/* Part of a text that somebody else owns; not NUL-terminated and without NUL bytes. */
typedef struct {
  const char *s;
  size_t n;
} thr_span;

typedef struct {
  const char *name;     /* of the text, for messages */
  const char *at, *end; /* what is left */
  int line, next;       /* number of the line given last, from 1, and of the one after it */
} thr_scan;

/* Starts at the text's first line, after a byte-order mark. THR_EINPUT if the text has NUL bytes.
 */
thr_status thr_scan_start(thr_scan *scan, const char *text, size_t n, const char *name,
                          thr_err *err) THR_MUST_CHECK;
/* Next line without its end (LF, CRLF or CR); false at the end of the text. */
bool thr_scan_line(thr_scan *scan, thr_span *line);
/* Makes line longer by the line after it; scan->line stays. False at the end of the text. */
bool thr_scan_extend(thr_scan *scan, thr_span *line);
/* THR_EINPUT with "name:line: " before the text. */
thr_status thr_scan_fail(const thr_scan *scan, thr_err *err, const char *format, ...)
    THR_PRINTF(3, 4);

thr_span thr_span_of(const char *s);
thr_span thr_span_trim(thr_span t); /* without blanks at both ends */
thr_span thr_span_word(
    thr_span *rest); /* takes the first word off, as far as a blank; n is 0 if there is none */
bool thr_span_is(thr_span t, const char *word);      /* equal but for ASCII case */
bool thr_span_same(thr_span a, thr_span b);          /* the same of two spans */
bool thr_span_starts(thr_span t, const char *start); /* case counts */
int thr_span_width(thr_span t);                      /* for "%.*s" in messages: at most 40 bytes */

/* A decimal number that is finite; -0 becomes 0 (writers do not tell them apart). decimal_comma:
 * "1,5" is 1.5. */
bool thr_span_number(thr_span t, bool decimal_comma, double *x);
/* Whether a text says yes, in the words for it of a few languages or as a number; nothing at all is
 * no. False if it says neither.
 */
bool thr_span_truth(thr_span t, bool *yes);
/* The same with a point, also as Fortran writes it: 1.5D+00. */
bool thr_span_real(thr_span t, double *x);
/* A decimal integer; beyond int it saturates. */
bool thr_span_int(thr_span t, int *x);

/* Node numbers by name. {0} is valid and empty. Valid as long as the draft's nodes stay. */
typedef struct {
  int n;
  struct thr_named {
    const char *name;
    int node;
  } * entry; /* by name; owned */
} thr_names;

/* Every node of the draft needs a name; THR_EINPUT if two have the same. O(n log n). */
thr_status thr_names_build(thr_names *names, const thr_draft *draft, const char *file,
                           thr_err *err) THR_MUST_CHECK;
int thr_names_find(const thr_names *names, thr_span name); /* -1 if there is none. O(log n) */
void thr_names_destroy(thr_names *names);

/* Counts a record that is known or harmless but not used. */
void thr_report_skip(thr_read_report *report, thr_span keyword);

/* Takes the unit of length that a comment names, if it names one (thr_units_in_comment); the
 * comment is without the sign that begins it. THR_EINPUT if it says "units:" before something else
 * than a unit. */
thr_status thr_scan_units(const thr_scan *scan, thr_span comment, thr_draft *draft,
                          thr_err *err) THR_MUST_CHECK;

/* The words of a text whose lines say little. A comment, from # to the end of its line, is left
 * out, what it says of units taken. Begin with draft and err, then thr_scan_start on scan. */
typedef struct {
  thr_scan scan;
  thr_span line; /* what is left of the current line */
  thr_draft *draft;
  thr_err *err;
  thr_status status; /* of the comments */
} thr_words;

/* Moves to the next line; false at the end of the text and where a comment is wrong, which is in
 * status then. */
bool thr_words_line(thr_words *words);
/* The next word; n is 0 where thr_words_line is false. */
thr_span thr_words_next(thr_words *words);
/* status, or THR_EINPUT with the line and what is wrong. */
thr_status thr_words_fail(const thr_words *words, const char *what);
/* The next word as a number of things or of a thing, from 0. */
thr_status thr_words_count(thr_words *words, int *n) THR_MUST_CHECK;

/* CSV with word of what the table lacks, so that the other half of a pair can be looked for. */
typedef enum { THR_CSV_WHOLE, THR_CSV_NODES_ONLY, THR_CSV_EDGES_ONLY } thr_csv_content;
thr_status thr_csv_scan(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_csv_content *content, thr_err *err) THR_MUST_CHECK;

/* The writers of write.c and dxf.c. */
void thr_json_frame_write(const thr_frame *frame, thr_text *out);
void thr_obj_write(const thr_frame *frame, thr_text *out);
void thr_csv_write(const thr_frame *frame, thr_text *out);
void thr_dxf_write(const thr_frame *frame, thr_text *out);

/* ---- formats.c: Formats of framework files: what a file of graph/io/ says of the format that it
 * reads. */

/* A new format is one file, with its reader, perhaps its writer, and one of these, and its line in
 * the table of formats.c. */
struct thr_format {
  const char *name;
  const char *ending[3]; /* of files' names, without the dot, NULL after the last; the first is the
                            one that is written */
  /* Does a text of this format begin with such a line? Blank lines and # comments before it are
   * left out. NULL: it is not told by that; what begins like nothing else is CSV. */
  bool (*begins)(thr_span line);
  /* As thr_draft_parse, which clears the draft and the report after a failure. */
  thr_status (*parse)(thr_draft *d, thr_read_report *r, const char *text, size_t n,
                      const char *name, thr_err *err);
  void (*write)(const thr_frame *f, thr_text *out); /* NULL: it is only read */
  bool pairs; /* a second file may hold the edges (thr_csv_parse_pair) */
  bool (*is)(const char *text,
             size_t n); /* is the whole text one of this format? NULL: it is not told by that */
};

/* What helps where a graph is in a format that is not read. */
#define THR_GRAPH_ADVICE                                                                           \
  "which is not read; write GraphML or node-link JSON with networkx or igraph, each node with x, " \
  "y and z"

/* By the file's name: NULL if that says nothing; THR_EINPUT if it says a format that is not read.
 */
thr_status thr_format_by_name(const char *name, const thr_format **format,
                              thr_err *err) THR_MUST_CHECK;

/* By the whole text or its first line that says anything: CSV if it is like nothing else. named:
 * what the file's name says, which counts unless the text is plainly of another format; NULL =
 * nothing. THR_EINPUT if the text is of a format that is not read. */
thr_status thr_format_by_text(const char *text, size_t n, const char *name, const thr_format *named,
                              const thr_format **format, thr_err *err) THR_MUST_CHECK;

/* ---- headers.c: Internal to the reader of tables: what the columns of a table mean, by the words
 * in their headers. */

enum { THR_HEADER_LENGTH = 48 };

/* A header without case, accents, blanks and punctuation ("Node_I" is nodei), and the unit that it
 * names ("X [mm]"), "" if none.
 */
typedef struct {
  char word[THR_HEADER_LENGTH];
  const char *unit;
} thr_header;

thr_header thr_header_of(thr_span field);

/* Returns 0, 1, 2 for x, y, z, in whatever words stand beside the letter; -1 for anything else. */
int thr_header_axis(const thr_header *header);

/* Whether the header means a name or number of nodes; the same for bars. */
bool thr_header_names_nodes(const thr_header *header);
bool thr_header_names_bars(const thr_header *header);

/* Whether the header means nodes where cord ends may come out. */
bool thr_header_feet(const thr_header *header);

/* Whether the header means a text of lines, as geographic systems write them. */
bool thr_header_lines(const thr_header *header);

/* Pairs of words for the two ends of an edge, from 0 on; false after the last one. */
bool thr_header_pair(int pair, const char *word[2]);

/* Whether two headers are alike but for the two words of a pair, and otherwise only say that they
 * are about nodes. */
bool thr_header_ends(const thr_header *a, const thr_header *b, const char *const word[2]);

/* The axis of a coordinate of the end that a word means: 0, 1, 2 for x1, y1, z1 with the word "1";
 * -1 for anything else. */
int thr_header_end_axis(const thr_header *header, const char *word);

/* ---- links.c: Internal to the readers of graphs: edges by the names of their nodes, which may
 * come after them. */

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

/* Appends an edge; both names are copied and cleaned as the draft cleans those of nodes. passes:
 * its capacity, 0 = not said. */
thr_status thr_links_add(thr_links *links, const char *from, const char *to, int line,
                         thr_err *err) THR_MUST_CHECK;

/* Adds all edges to the draft. THR_EINPUT as "name:line: .." if there is no node of a name or two
 * nodes have one. */
thr_status thr_links_finish(const thr_links *links, thr_draft *draft, const char *name,
                            thr_err *err) THR_MUST_CHECK;

void thr_links_destroy(thr_links *links);

/* What a graph says of a node or an edge, attribute by attribute, in whatever words: a node's x, y,
 * z, whether it is a foot and what it is called; an edge's length, cover and capacity. */
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
thr_status thr_said_node(const thr_said *said, thr_draft *draft, const char *node, bool *has_z,
                         const thr_scan *scan, thr_err *err) THR_MUST_CHECK;

/* What is said of the edge added last. */
void thr_said_link(const thr_said *said, thr_links *links);

/* ---- parts.c: Internal to the readers: the parts of a file that have names of their own, of which
 * one may be asked for
 * (--pick). */

/* Begin with {.asked = draft->pick}. Where nothing is asked for nothing is kept, and every part is
 * chosen. */
typedef struct {
  const char *asked; /* the name of a part, or its number from 1 in the order of the file; NULL =
                        all of them; borrowed */
  thr_text names;    /* each with its NUL; owned */
  int n, n_chosen;
  bool *chosen; /* [n] owned */
} thr_parts;

/* Adds a part; its number, from 0, in *part. */
thr_status thr_parts_add(thr_parts *parts, thr_span name, int *part, thr_err *err) THR_MUST_CHECK;

/* The same of a part that may be known already, like the layer of a line. O(parts). */
thr_status thr_parts_find(thr_parts *parts, thr_span name, int *part, thr_err *err) THR_MUST_CHECK;

/* The parts of the name that is asked for; if none has it, the one of that number. THR_EINPUT if
 * there is none: "file: there is no layer 'dome'; did you mean Dome? there are: Dome, Feet". what:
 * one of them, many: some of them. */
thr_status thr_parts_choose(thr_parts *parts, const char *file, const char *what, const char *many,
                            thr_err *err) THR_MUST_CHECK;

static inline bool thr_parts_has(const thr_parts *parts, int part)
{
  return !parts->asked || (part >= 0 && part < parts->n && parts->chosen[part]);
}

/* How many there are and were read, for the notes; then releases everything. */
void thr_parts_finish(thr_parts *parts, thr_read_report *report);

/* ---- faces.c: Internal to the readers of meshes: faces, which may be named before their nodes are
 * there, and their sides as edges. */

/* Runs of node numbers from 0, each a polygon of three and more or an edge of two. {0} is valid and
 * empty. */
typedef struct {
  int n, n_corners, capacity, corners_capacity;
  int *end;    /* [n] where the run ends in corner; owned */
  int *corner; /* [n_corners]; owned */
} thr_faces;

/* Appends a node to the run that is being written. */
thr_status thr_faces_corner(thr_faces *faces, int node, thr_err *err) THR_MUST_CHECK;
/* Ends that run; one of fewer than two nodes is left out. */
thr_status thr_faces_close(thr_faces *faces, thr_err *err) THR_MUST_CHECK;
/* Both, for a whole run. */
thr_status thr_faces_add(thr_faces *faces, const int *corner, int n, thr_err *err) THR_MUST_CHECK;

/* Appends the sides of all runs to the draft, each different side once (most belong to two faces,
 * which is no oddity to report), in order of first appearance; of two triangles that meet at less
 * than draft->flat not the side between them. THR_EINPUT with the text's name if a run names a node
 * that the draft has not. O(n log n). */
thr_status thr_faces_finish(const thr_faces *faces, thr_draft *draft, const char *name,
                            thr_err *err) THR_MUST_CHECK;

void thr_faces_destroy(thr_faces *faces);

/* ---- read_json.c: Inside graph/io: what the readers of JSON frameworks share (values and names,
 * with the place of what is wrong), and those readers. */

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
  uint64_t *place; /* [n_found] of the frameworks of the document, where each stands but for numbers
                      (place_of); owned */
  int n_found, found_capacity;
  thr_parts parts; /* the frameworks */
  int n_seen;      /* in the second walk through the document */
  int n_chosen;    /* how many are read */
} thr_json_reader;

/* ---- values: read_json_values.c ---- */

/* Fails with the way to the value and what is wrong with it. */
thr_status thr_json_bad(thr_json_reader *reader, const thr_json_where *at, const char *what);

bool thr_json_is_array(const thr_json *value);
bool thr_json_is_object(const thr_json *value);

/* First of the members named, and which it was. */
const thr_json *thr_json_member(const thr_json *object, const char *const *keys,
                                const char **which);
#define THR_JSON_MEMBER(o, which, ...)                                                             \
  thr_json_member(o, (const char *const[]){__VA_ARGS__, NULL}, which)

/* Coordinates as [x, y, z] or as members x, y, z in either case, where defaults may stand in; a
 * missing z is 0. */
thr_status thr_json_point(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                          const thr_json *defaults, double xyz[3]) THR_MUST_CHECK;

/* A length of an edge; null is 0, the distance of its nodes. */
thr_status thr_json_length(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                           double *length) THR_MUST_CHECK;

/* Adds an edge's own numbers of passes, where there are some. */
thr_status thr_json_passes(thr_json_reader *reader, const thr_json_where *at, const thr_json *cover,
                           const thr_json *capacity) THR_MUST_CHECK;

/* Index into n things. */
thr_status thr_json_index(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                          int n, int *index) THR_MUST_CHECK;

/* What is not there, or null, leaves the default. */
thr_status thr_json_units(thr_json_reader *reader, const thr_json_where *up, const char *key,
                          const thr_json *value) THR_MUST_CHECK;

/* ---- names: read_json_values.c ---- */

/* What a value calls a node: a string, a number, or a tuple of these, written (a, b) as Python
 * does. The result is valid until the next call. */
thr_status thr_json_name_of(thr_json_reader *reader, const thr_json_where *at,
                            const thr_json *value, const char **name) THR_MUST_CHECK;

/* A key of an object as a name; the result is valid until the next call. */
thr_status thr_json_key_name(thr_json_reader *reader, const thr_json_where *at, const char *key,
                             const char **name) THR_MUST_CHECK;

/* The node of this name, or that a value names. */
thr_status thr_json_find_node(thr_json_reader *reader, const thr_json_where *at, const char *name,
                              int *node) THR_MUST_CHECK;
thr_status thr_json_reference(thr_json_reader *reader, const thr_json_where *at,
                              const thr_json *value, int *node) THR_MUST_CHECK;

/* ---- our own frames and plans, any lists of points and index pairs: read_json_own.c ---- */

thr_status thr_json_read_own(thr_json_reader *reader, const thr_json_where *at,
                             const thr_json *object) THR_MUST_CHECK;
thr_status thr_json_read_plan(thr_json_reader *reader, const thr_json_where *at,
                              const thr_json *object) THR_MUST_CHECK;

/* ---- COMPAS, its lines, assembly_instances, conmech: read_json_compas.c ---- */

/* Whether a key is a number, and which. */
bool thr_json_parse_key(const char *key, int64_t *number);

/* Whether a node stands on the ground, by any of the names that there are for it. */
thr_status thr_json_support(thr_json_reader *reader, const thr_json_where *at, const thr_json *node,
                            const thr_json *defaults, bool *foot) THR_MUST_CHECK;

/* Of a line of COMPAS or Rhino the object with its ends, called *end[2], of a Polyline the list of
 * its points; NULL if it is neither. */
const thr_json *thr_json_points_of_line(const thr_json *value, const char *const **end);

/* GeoJSON's lines and polygons; points are skipped and counted. */
bool thr_json_is_geometry(const thr_json *value);
thr_status thr_json_read_geometry(thr_json_reader *reader, const thr_json_where *at,
                                  const thr_json *object) THR_MUST_CHECK;

thr_status thr_json_read_compas(thr_json_reader *reader, const thr_json_where *at,
                                const thr_json *object) THR_MUST_CHECK;
thr_status thr_json_read_lines(thr_json_reader *reader, const thr_json_where *at,
                               const thr_json *list) THR_MUST_CHECK;
thr_status thr_json_read_assembly(thr_json_reader *reader, const thr_json_where *at,
                                  const thr_json *object) THR_MUST_CHECK;

/* ---- networkx: read_json_graphs.c ---- */

thr_status thr_json_read_node_link(thr_json_reader *reader, const thr_json_where *at,
                                   const thr_json *object) THR_MUST_CHECK;

/* networkx adjacency data: for each node the list of its neighbours. An edge that both ends list
 * counts once. */
thr_status thr_json_read_adjacency(thr_json_reader *reader, const thr_json_where *at,
                                   const thr_json *object) THR_MUST_CHECK;

/* ---- xml.c: Internal to the readers of XML formats: the tags of a document one after the other,
 * with the text before each. */

typedef enum { THR_XML_END, THR_XML_OPEN, THR_XML_CLOSE, THR_XML_EMPTY } thr_xml_kind;

typedef struct {
  thr_scan scan; /* line: of the tag */
  thr_xml_kind kind;
  thr_span name;       /* of the tag, without what stands before a colon */
  thr_span attributes; /* as they are written */
  thr_span text;       /* before the tag and after the last one, as it is written */
} thr_xml;

thr_status thr_xml_start(thr_xml *xml, const char *text, size_t n, const char *name,
                         thr_err *err) THR_MUST_CHECK;
thr_status thr_xml_next(thr_xml *xml, thr_err *err) THR_MUST_CHECK;

/* The value of an attribute of the tag into out, instead of what it held; false if there is none.
 */
bool thr_xml_attribute(const thr_xml *xml, const char *name, thr_text *out);

/* Appends text with its entities and CDATA resolved and without its comments. */
void thr_xml_plain(thr_span text, thr_text *out);

/* ---- sites.c: Internal to the readers of formats whose lines and faces repeat coordinates: points
 * at exactly one place are one node. */

/* {0} is valid and empty. */
typedef struct {
  int n, capacity;
  double (*xyz)[3]; /* owned; never -0, so that equal places are equal bytes */
} thr_sites;

thr_status thr_sites_add(thr_sites *sites, const double xyz[3], thr_err *err) THR_MUST_CHECK;

/* Appends each different place to the draft as a node, in order of first appearance; node[i]
 * receives that of site i. THR_EINPUT if a coordinate is out of range. O(n log n). */
thr_status thr_sites_finish(const thr_sites *sites, int *node, thr_draft *draft,
                            thr_err *err) THR_MUST_CHECK;

void thr_sites_destroy(thr_sites *sites);

/* ---- curve.c: Internal to the readers: how long the curves of drawings are. */

/* A point of a curve at the parameter t. */
typedef void (*thr_curve_point)(const void *curve, double t, double xyz[3]);

/* Length from parameter a to b of a curve that is smooth in between: chords of 64 and of 128 equal
 * steps, extrapolated (Richardson), relative error about 1e-9 for a quarter of a circle. */
double thr_curve_length(thr_curve_point point, const void *curve, double a, double b);

/* A B-spline (rational if weight is not NULL) with n control points and n + degree + 1 knots; all
 * borrowed. */
typedef struct {
  int degree, n;
  const double (*control)[3];
  const double *weight, *knot;
} thr_spline;

enum { THR_SPLINE_MOST_DEGREE = 15 };

/* Is it one that the two functions below may be given: 1 <= degree <= 15, degree < n, knots that do
 * not fall, weights above 0 and a parameter range that is not empty? */
bool thr_spline_is_sound(const thr_spline *spline);
/* C. de Boor, "On calculating with B-splines", 1972. O(degree squared + log n). */
void thr_spline_point(const void *spline, double t, double xyz[3]);
/* Length of the whole curve, knot by knot. */
double thr_spline_length(const thr_spline *spline);

#endif
