/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A framework: nodes with coordinates, edges, and what is said of them.
 *
 * The room graph/framework holds the framework, the graph whose edges cords are threaded through,
 * and all that follows from the framework alone, without a plan. Lengths are in the framework's
 * units, angles in rad.
 *
 * Read first this file and frame.c (from draft to framework: welding, indices, names, hash), which
 * everything else builds on. Then, in any order: near.c (what a drawing nearly says), components.c
 * (components as frameworks of their own), feet.c (on which nodes they stand), units.c (units of
 * length, numbers with units), make.c (example frameworks),
 * procrustes.c (isometries near to a permutation), igraph.c (cuts, flows, automorphisms, drawings),
 * bore.c (cords in a bore). */
#ifndef THR_FRAME_H
#define THR_FRAME_H

#include "graph/status.h"
#include "graph/text.h"

/* ---- frame.c: The framework: a simple graph whose nodes have coordinates. */

/* Half-edge h = 2*e + s is edge e seen from its end s: it leaves node edge[e][s] and arrives at
 * edge[e][1-s]. h ^ 1 is the same edge the other way. All arrays are owned; {0} is valid and empty.
 */
typedef struct {
  int n_nodes, n_edges;
  double (*xyz)[3]; /* [n_nodes] coordinates in units */
  int (*edge)[2];   /* [n_edges] the two nodes; never equal, no pair twice */
  double *length;   /* [n_edges] cord used by one pass, in units, > 0 */
  int *cover;       /* [n_edges] passes that the edge needs at least, >= 1; NULL = 1 each */
  int *capacity;    /* [n_edges] passes that fit through the edge, 0 = no limit; NULL = no limits */
  bool *foot;       /* [n_nodes] may a cord end come out here (--ends feet)? */
  char **name; /* [n_nodes] what the file calls the node: an OBJ vertex number, a COMPAS key, ..; in
                  names */
  char *names; /* all names, each with its NUL */
  char units[16]; /* short name of the unit (thr_units_name): "mm" unless the file or the user says
                     otherwise */
  bool own_lengths; /* lengths were given, not Euclidean */
  int *first;       /* [n_nodes + 1] half-edges leaving v: half[first[v] .. first[v + 1] - 1], by
                       ascending edge */
  int *half;        /* [2 * n_edges] */
  uint64_t hash;    /* kept by thr_frame_keep_hash; 0 = not */
} thr_frame;

static inline int thr_tail(const thr_frame *frame, int h)
{
  return frame->edge[h >> 1][h & 1];
}
static inline int thr_head(const thr_frame *frame, int h)
{
  return frame->edge[h >> 1][1 - (h & 1)];
}
static inline int thr_degree(const thr_frame *frame, int v)
{
  return frame->first[v + 1] - frame->first[v];
}

/* What a reader collects before welding: nodes in file order, edges as node indices. Fill it with
 * the two add functions below, then call thr_draft_build. {0} is valid and empty. */
typedef struct {
  int n_nodes, n_edges, nodes_capacity, edges_capacity;
  struct thr_draft_node {
    double xyz[3];
    int name; /* where it begins in names; -1 means the index in decimal */
    bool foot;
  } * node;
  struct thr_draft_edge {
    int a, b;
    double length; /* 0 = Euclidean */
    int cover;     /* 0 = not said */
    int capacity;  /* 0 = no limit */
  } * edge;
  thr_text names;   /* each with its NUL */
  char units[16];   /* "" = not said */
  char other[16];   /* another unit that the file's comments name as well; "" = none */
  bool y_up;        /* the file's maker is known to write y upwards */
  bool up_is_y;     /* the format says that y points up */
  const char *pick; /* asked of the readers of files that hold several frameworks: the name or the
                       number of one of them, from 1; NULL = all of a list; borrowed */
  bool all_layers;  /* asked of the readers of drawings: what is on hidden layers is read, too */
  const char *columns; /* asked of the reader of tables: the two columns of the ends of edges, "a,b"
                          by name or number; NULL = as the table says; borrowed */
  double flat; /* asked of the readers of meshes, rad: triangles that meet at less have no edge
                  between them; 0 = all have */
} thr_draft;

/* What node v is called until another node is added; NULL means the index in decimal. */
const char *thr_draft_name(const thr_draft *draft, int v);

/* Appends a node; name may be NULL and is copied and cleaned (thr_text_clean). Coordinates must be
 * finite and below 1e100 (THR_EINPUT otherwise). */
thr_status thr_draft_add_node(thr_draft *draft, const double xyz[3], const char *name, bool foot,
                              thr_err *err) THR_MUST_CHECK;
/* Appends an edge between node indices that exist already (THR_EINPUT otherwise). length 0 =
 * Euclidean. */
thr_status thr_draft_add_edge(thr_draft *draft, int a, int b, double length,
                              thr_err *err) THR_MUST_CHECK;
/* Of the edge added last: passes that it needs (1 .. 100, 0 = not said) and that fit through it
 * (cover .. 100, 0 = no limit). THR_EINPUT otherwise. */
thr_status thr_draft_edge_passes(thr_draft *draft, int cover, int capacity,
                                 thr_err *err) THR_MUST_CHECK;
/* Says what one unit of the coordinates is: a word that thr_units_find knows, kept as its short
 * name. THR_EINPUT otherwise. */
thr_status thr_draft_set_units(thr_draft *draft, const char *units, thr_err *err) THR_MUST_CHECK;
/* Appends the nodes and edges of another draft, with prefix before the names of its nodes, and its
 * units. */
thr_status thr_draft_append(thr_draft *draft, const thr_draft *other, const char *prefix,
                            thr_err *err) THR_MUST_CHECK;
void thr_draft_destroy(thr_draft *draft);

/* Whence something is known: the file leaves it open, its maker is known to write so, the file or
 * its format says it, or the user. */
typedef enum { THR_FROM_NOBODY, THR_FROM_MAKER, THR_FROM_FILE, THR_FROM_USER } thr_whence;

/* What was done to the file's data, and what is odd about it. */
typedef struct {
  const char *format;    /* the format's name; static */
  double weld_tolerance; /* in units */
  int nodes_read, edges_read;
  int welded_nodes;      /* merged into an earlier node */
  int duplicate_edges;   /* dropped */
  int parallel_edges;    /* of these, those that have another length than the one that is kept */
  char parallel[160];    /* the first of these, with the lengths */
  int zero_length_edges; /* dropped: both ends weld to one node */
  int isolated_nodes;    /* dropped: no edge */
  int skipped_records;   /* records of the file that the reader knows but does not use (set by the
                            reader) */
  char skipped_kind[32]; /* the first such record's keyword */
  int hidden_edges;      /* of layers that are off or frozen, left out, and of how many layers */
  int hidden_layers;
  int unseen_records;     /* records that are marked invisible, or on paper, left out */
  int missing_blocks;     /* insertions of blocks that the file does not hold, left out */
  char missing_block[32]; /* the first one's name */
  thr_whence units_from;  /* nobody: they are taken to be mm */
  char units_of_file[16]; /* what the file names, where the user says another unit; else "" */
  thr_whence up_from;     /* nobody: z is taken to point up */
  bool y_up;              /* y was taken to point up */
  bool lies; /* z was taken to point up, but it may be y: the structure seems to lie on its side */
  bool no_z; /* no node has a z: the framework is flat */
  int empty_z;       /* coordinates z left empty where others are not: taken as 0 */
  char thousands[8]; /* a number of the file, if the dot of all that have one may part thousands;
                        else "" */
  int frameworks;    /* that the file holds, and how many were read as one; 0 = the format holds one
                        only */
  int frameworks_read;
  int split_edges;  /* cut where a node lies on them */
  char unused[120]; /* columns of a table that mean nothing, with commas */
} thr_read_report;

/* Welds nodes closer than tolerance (< 0: 1e-6 of the bounding box's diagonal, at most a thousandth
 * of the median edge), drops zero-length and duplicate edges and isolated nodes, and fills frame
 * and report (nodes_read .. isolated_nodes). The lowest file index of a welded group gives
 * coordinates and name; any member's foot makes it a foot. Of edges that fall together the shortest
 * one counts, of those of one length the first. Nodes and edges keep file order.
 * THR_EINPUT if no edge is left, a length is out of range, or two nodes that are left have one
 * name. The draft is unchanged. O(n log n) as long as few nodes lie within the tolerance of each
 * other along one fixed skew direction; quadratic in those. */
thr_status thr_draft_build(const thr_draft *draft, double tolerance, thr_frame *frame,
                           thr_read_report *report, thr_err *err) THR_MUST_CHECK;

/* Parts the edges that thr_draft_build would drop although they have a length of their own, by a
 * node for each on the straight line between its ends: in the middle, where there is one. */
thr_status thr_draft_keep_parallel(thr_draft *draft, double tolerance, thr_err *err) THR_MUST_CHECK;

/* Would thr_draft_build make this framework again, which it made, of the draft with tolerance 0:
 * the same nodes and edges in the same order, with equal numbers and names? O(n). */
bool thr_draft_says(const thr_draft *draft, const thr_frame *frame);

void thr_frame_destroy(thr_frame *frame);
thr_status thr_frame_copy(thr_frame *to, const thr_frame *from, thr_err *err) THR_MUST_CHECK;

/* Takes over the names of all nodes, one after the other and each with its NUL, instead of those
 * that there are. O(bytes). */
thr_status thr_frame_take_names(thr_frame *frame, thr_text *names, thr_err *err) THR_MUST_CHECK;

/* Fills first and half, which are allocated and zero, from the edges. O(n + m). */
void thr_frame_index(thr_frame *frame);

/* Index of the node with this name, or -1. O(n). */
int thr_frame_find(const thr_frame *frame, const char *name);

/* Is every node called by its index, as readers call nodes without a name? Then writers leave the
 * names out. */
bool thr_frame_names_are_indices(const thr_frame *frame);

/* Edge between two nodes, or -1. O(degree). */
int thr_frame_edge_between(const thr_frame *frame, int a, int b);

/* Direction of a half-edge, from tail to head, with its largest component scaled to 1 or -1:
 * products neither overflow nor vanish. */
void thr_direction(const thr_frame *frame, int half, double d[3]);

double thr_frame_total_length(const thr_frame *frame);

/* Edges at a node at most. O(nodes). */
int thr_frame_largest_degree(const thr_frame *frame);
double thr_frame_diagonal(const thr_frame *frame); /* of the bounding box, in units */

/* 64-bit FNV-1a over counts, coordinates, edges, lengths, feet and, if there are any, covers and
 * capacities: names a framework in outputs. Not for security. O(n + m), unless it is kept. */
uint64_t thr_frame_hash(const thr_frame *frame);

/* Works the hash out and keeps it, for who writes a framework that nobody changes any more and
 * reads it back. */
void thr_frame_keep_hash(thr_frame *frame);

/* Component number of every node (0, 1, .. by lowest node) in component[n_nodes], unless that is
 * NULL; *count receives how many. */
thr_status thr_frame_components(const thr_frame *frame, int *component, int *count,
                                thr_err *err) THR_MUST_CHECK;

/* Marks bridges (edges whose removal disconnects their component) in is_bridge[n_edges]. Iterative
 * DFS, O(n + m). */
thr_status thr_frame_bridges(const thr_frame *frame, bool *is_bridge, thr_err *err) THR_MUST_CHECK;

/* ---- feet.c: Feet: the nodes on which a framework stands, by height or as the rim of a shell. */

/* Returns how many nodes are feet. */
int thr_frame_feet(const thr_frame *frame);

/* Marks in foot[n_nodes] on which nodes the framework stands: on its feet or, if it has none, on
 * the nodes within 1e-6 of the diagonal of the lowest z. Returns how many. */
int thr_frame_standing(const thr_frame *frame, bool *foot);

/* Makes the nodes within 1e-6 of the diagonal of the lowest z the feet, and no others. */
void thr_frame_feet_lowest(thr_frame *frame);

/* Do the words say which nodes thr_frame_feet_where is to take, and do not name them? */
bool thr_feet_is_word(const char *words);

/* Makes the feet, and no others: "lowest", as above; "rim", all nodes on an edge of a shell, level
 * or not; "below=HEIGHT", all up to that z, with its unit or in the framework's. THR_EINPUT, and
 * nothing changes: the framework is no shell, or has no rim; no node is so low; other words. O(n),
 * of a shell with small panels. */
thr_status thr_frame_feet_where(thr_frame *frame, const char *words, thr_err *err) THR_MUST_CHECK;

/* ---- bore.c: Round bores: how many cords are drawn with ease through one, and how wide one has to
 * be for so many. */

/* Bore where none is given, in cord diameters: wide enough for one cord. */
static const double THR_BORE_CORDS = 2;

/* Cord that hands thread and pull, mm: what is taken if none is given lies between the two, unless
 * the pieces have no room for it. */
static const double THR_CORD_THINNEST = 1, THR_CORD_THICKEST = 3;

/* Bore through which n >= 1 cords are drawn with ease, in cord diameters: sqrt(n / fill), where the
 * cords' sections fill no more of the bore's than is allowed in a conduit through which cables are
 * pulled: 0.53 for one, 0.31 for two, 0.40 for more (NFPA 70, National Electrical Code, chapter 9,
 * table 1). So 1.37, 2.54, 2.74, 3.16: always wider than the narrowest that holds them. */
double thr_bore_clear(int n);

enum { THR_BORE_MOST = 1000 }; /* cords that are counted */

/* Cords of diameter cord that are drawn with ease through a bore (the same unit); 0 if none is.
 * O(n). Example: through a bore of three cord diameters three cords, side by side it would hold
 * seven. */
int thr_bore_fits(double bore, double cord);

/* ---- near.c: What a drawing nearly says: nodes that are almost one, nodes that lie on an edge
 * which passes them, edges that cross without a node. */

typedef struct {
  int n_close; /* pairs of nodes without an edge between them, at most a tenth of the shortest edge
                  at either apart */
  int closest[2];
  double gap;  /* of the closest pair */
  double weld; /* a tolerance that joins all of these pairs, and what it would do: */
  int n_welded, n_merged, n_lost; /* nodes merged, edges merged, edges of no length dropped */
  int components, components_welded;
  int n_on_edge, on_edge[2]; /* nodes at most a thousandth of its length from an edge that does not
                                end there; one and its edge */
  int n_crossings,
      crossing[2]; /* pairs of edges as close to each other between their ends; one of them */
  bool tangled;    /* so many edges pass close to each other that not all pairs were looked at */
} thr_near;

/* Edges that are longer than their nodes are apart are taken for curves, of which only the ends
 * count. O(n + m) where edges of about one length fill space evenly; at most about 1e8 comparisons.
 */
thr_status thr_frame_near(const thr_frame *frame, thr_near *near, thr_err *err) THR_MUST_CHECK;

/* Cuts each edge at the nodes that lie on it: its parts share its length, and each needs and takes
 * as many passes. *n_cut receives how many edges were cut; parts that are edges already are dropped
 * and counted in the report. */
thr_status thr_frame_split(thr_frame *frame, int *n_cut, thr_read_report *report,
                           thr_err *err) THR_MUST_CHECK;

/* ---- Flows and cuts of undirected graphs, by igraph: the Gomory-Hu cut tree (Gomory & Hu 1961),
 * and a maximum flow (Goldberg & Tarjan 1988). */

/* Graph with n nodes and m undirected edges of capacity >= 0; it should be connected. tree[0 ..
 * n-2] receives the tree's edges and flow[0 .. n-2] the minimum cut that each stands for: removing
 * the tree edge leaves the cut's two sides. n - 1 maximum flows. THR_ESOLVER if igraph fails. */
thr_status thr_cut_tree(int n, int m, const int (*edge)[2], const double *capacity, int (*tree)[2],
                        double *flow, thr_err *err) THR_MUST_CHECK;

/* Graph as above; loops do not matter. flow[e] receives how much a maximum flow from source to sink
 * sends from edge[e][0] to edge[e][1], below 0 the other way. source_side[n] receives the source's
 * side of a minimum cut. THR_ESOLVER if igraph fails. */
thr_status thr_maximum_flow(int n, int m, const int (*edge)[2], const double *capacity, int source,
                            int sink, double *flow, bool *source_side, thr_err *err) THR_MUST_CHECK;

const char *thr_igraph_version(void);

/* ---- procrustes.c: The orthogonal matrix that moves the nodes of a framework nearest to where a
 * permutation sends them (Schoenemann 1966). */

typedef struct {
  double q[3][3];
  bool proper; /* determinant +1: a rotation */
  bool flat; /* the nodes span no more than a plane: a rotation would do as well as one that mirrors
              */
  double
      residual; /* root mean square distance of moved nodes from their images, in parts of size */
  double farthest; /* the largest such distance, in parts of size */
} thr_motion;

/* Residual up to which a permutation is called by the name of an isometry. */
#define THR_ISOMETRY_NEAR 0.05

/* What sums over coordinates lose to rounding, in parts of size. */
#define THR_ISOMETRY_ROUNDING 1e-9

/* Centroid, and as size the root mean square distance of the nodes from it. */
void thr_frame_extent(const thr_frame *frame, double centroid[3], double *size);

/* Best q about the centroid; image: [n_nodes], any node numbers. Where the nodes span no more than
 * a plane (thinner than a ten-thousandth of the size), a rotation is taken, on a line the least
 * one. O(n). */
void thr_procrustes(const thr_frame *frame, const int *image, thr_motion *out);

/* ---- Units of length: which words a file may use for them, and how long they are; and numbers
 * with units. */

/* The usual short name ("mm") of a unit called by that name, by its names in full ("Millimeters")
 * or by another short name, in either case; NULL if the word is none. "unit" is a length that
 * nobody knows. Static. */
const char *thr_units_name(const char *word);

/* THR_EINPUT if the word is no unit, with the word and those that are; *name as above. */
thr_status thr_units_find(const char *word, const char **name, thr_err *err) THR_MUST_CHECK;

/* Looks for the unit of length in a comment of a file (its n bytes without the sign that begins
 * it), as programs and people write it: "units: mm", "File units = inches", "Units [cm]", "1 unit =
 * 1 m", "This file uses centimeters as units for coordinates". *name is the unit's short name, NULL
 * if the comment names none. *wrong is NULL unless the comment begins with "units:" or "file units
 * =" before something else than a unit: then it points to that, inside the text. O(n). */
void thr_units_in_comment(const char *text, size_t n, const char **name, const char **wrong);

/* Millimetres in one unit, by its short name or any other; THR_EINPUT if it is none whose length is
 * known. */
thr_status thr_units_in_mm(const char *units, double *mm, thr_err *err) THR_MUST_CHECK;

/* Reads a number with or without a unit behind it, "200", "20cm", "1.5 kN", as one of `unit`: any
 * unit of length, or N, s, deg, g, g/cm3, MPa, mm/s, m/s2, rad/m, %; "": no unit may follow. A kg
 * of force is a weight on earth. THR_EINPUT without the text: not a finite number, or a unit of
 * another kind, or of no known length. */
thr_status thr_quantity_read(const char *text, const char *unit, double *value,
                             thr_err *err) THR_MUST_CHECK;

/* ---- Makes example frameworks, shapes by name; and draws graphs in the plane. */

/* ---- make.c: Generators of example frameworks. */

typedef enum {
  THR_MAKE_DOME,
  THR_MAKE_GEODESIC,
  THR_MAKE_TUBE,
  THR_MAKE_SPHERE,
  THR_MAKE_HONEYCOMB,
  THR_MAKE_ROW,
  THR_MAKE_ARCH,
  THR_MAKE_ALTERNATING,
  THR_N_SHAPES
} thr_shape;
const char *thr_shape_name(int shape); /* "dome", "geodesic", "tube", "sphere", .. */

typedef struct {
  thr_shape shape;
  int size;  /* dome: nodes per side (>= 2); geodesic, sphere: frequency (>= 1); tube: nodes around
                (>= 3);  honeycomb: rings of hexagons (>= 1); row, arch: nodes (>= 2, >= 3);
                alternating: nodes (>= 2) */
  int rings; /* tube: rings of nodes along the axis (>= 2) */
  double pitch; /* mm between neighbouring nodes (dome: in plan; others: nominal), > 0 */
  double rise; /* dome, honeycomb, arch: height of the crown over the feet as a fraction of the half
                  span, >= 0; alternating: tangent of half a bend, at most 1 */
  double twist; /* alternating: degrees from a bend to the next, 60 .. 180 */
} thr_make_options;

thr_make_options thr_make_options_default(thr_shape shape);

/* THR_EINPUT with the option's name for a size out of range; at most 2 million nodes. */
thr_status thr_make(thr_draft *draft, const thr_make_options *options, thr_err *err) THR_MUST_CHECK;

/* ---- Drawing of graphs by igraph. */

/* Kamada & Kawai 1989: nodes as springs, whose lengths are the shortest ways along the edges. Graph
 * with n nodes and m undirected edges of length > 0; xy[n] is where the search starts, unless it is
 * to start from a circle, and receives where it ends. No randomness. O(n m log n), then O(n) for
 * each of at most 50 n steps; n^2 numbers of memory. THR_ESOLVER if igraph fails. */
thr_status thr_kamada_kawai(int n, int m, const int (*edge)[2], const double *length, bool circle,
                            double (*xy)[2], thr_err *err) THR_MUST_CHECK;

#endif
