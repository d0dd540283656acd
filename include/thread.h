/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libthread: plans how cord is threaded through bead structures, proves it, checks it, draws it.
 *
 * Objects are opaque. What can fail returns a thread_status and, if err is not NULL, one line of
 * text; its outputs are then NULL, 0 or empty. Nothing prints, exits or changes the locale. Text is
 * UTF-8, lengths are in units of the frame, angles in rad, forces in N. Calls on different objects
 * may run in different threads; planning waits for planning (nauty and GLPK are not reentrant).
 * A call with a progress function or a time, and some libraries, run in forked children, which the
 * library waits for: do not set SIGCHLD to SIG_IGN. Structs begin with their size: thread_*_init
 * fills in the usual values, and a program built with an older header goes on working.
 */
#ifndef THREAD_H
#define THREAD_H
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif
#define THREAD_VERSION 100 /* 0.1.0 */
#define THREAD_API __attribute__((visibility("default")))

typedef enum {
  THREAD_OK = 0,
  THREAD_NO_MEMORY,
  THREAD_IO,         /* a file could not be opened, read or written */
  THREAD_BAD_INPUT,  /* the text says where, what, and what to do */
  THREAD_INFEASIBLE, /* no threading with these options; the text says what forbids it */
  THREAD_NOT_PROVED, /* valid, but not proved: ended by time or progress, or as far as it goes */
  THREAD_SOLVER,     /* a library failed */
  THREAD_VIOLATED    /* a claim of the plan is not true */
} thread_status;

typedef struct {
  char text[512];
} thread_error;
typedef struct thread_frame thread_frame; /* nodes in space, edges between them */
typedef struct thread_plan thread_plan;   /* cords through a frame, and proofs */

THREAD_API int thread_version(void);           /* THREAD_VERSION of the library */
THREAD_API const char *thread_libraries(void); /* "thread 0.1.0, GLPK 5.0, .."; never freed */
THREAD_API void thread_free(void *bytes);      /* what a char ** received; NULL ok */

/* ---- frames ---- */

typedef struct {
  size_t size;
  const char *edges; /* second file of a CSV pair; NULL = none */
  const char *units; /* NULL = as the file says, else mm */
  double weld;       /* nodes closer than this are one; < 0 = 1e-6 of the bounding box */
  double scale;      /* times every coordinate */
  double flat;       /* rad: no edge between triangles that meet at less */
  char up;           /* 'y', 'z', or 'a' = as the maker of the file is known to write */
  char split;        /* 1: an edge is cut where a node lies on it */
  int pick;          /* which framework of a file that holds several, from 1; 0 = all */
  const char *part; /* the same by the name of it, an object, group or layer; NULL = as pick says */
  char all_layers;  /* 1: what a drawing has on layers that are off or frozen is read, too */
  char parallel;    /* 1: parallel edges that differ in length are kept, parted by a node each */
  const char *columns; /* of a table of edges: both ends' columns, "a,b"; NULL = as it says */
} thread_read_options;
THREAD_API void thread_read_options_init(thread_read_options *options, size_t size);

/* options: NULL = the usual ones. name: of the text, for messages and for its ending. */
THREAD_API thread_status thread_frame_read(const char *path, const thread_read_options *options,
                                           thread_frame **out, thread_error *err);
THREAD_API thread_status thread_frame_parse(const char *text, size_t n, const char *name,
                                            const thread_read_options *options, thread_frame **out,
                                            thread_error *err);
/* xyz[3 * n_nodes], ends[2 * n_edges] nodes from 0, copied. Nothing is merged: two nodes in one
 * place, an edge given twice or of no length, and a node without an edge are THREAD_BAD_INPUT.
 * units NULL = mm. */
THREAD_API thread_status thread_frame_make(int n_nodes, const double *xyz, int n_edges,
                                           const int *ends, const char *units, thread_frame **out,
                                           thread_error *err);
/* As thread make: "dome", "sphere", "tube", "arch", ..; size 0 = the usual one. */
THREAD_API thread_status thread_frame_shape(const char *shape, int size, thread_frame **out,
                                            thread_error *err);
THREAD_API void thread_frame_free(thread_frame *frame); /* NULL ok */

/* Counts; xyz and ends (NULL ok) receive 3 coordinates a node, 2 nodes an edge, borrowed. */
THREAD_API int thread_frame_nodes(const thread_frame *frame, const double **xyz);
THREAD_API int thread_frame_edges(const thread_frame *frame, const int **ends);
/* Names are borrowed. NULL, -1: there is no such node. */
THREAD_API const char *thread_frame_name(const thread_frame *frame, int node);
THREAD_API int thread_frame_find(const thread_frame *frame, const char *name);
/* What reading merged, dropped or found odd, a line each; borrowed. */
THREAD_API const char *thread_frame_notes(const thread_frame *frame);
/* Where cord ends may come out with THREAD_FEET; n < 0: the lowest nodes. */
THREAD_API thread_status thread_frame_set_feet(thread_frame *frame, int n, const int *node,
                                               thread_error *err);
/* The same: "lowest", "rim" (all along the borders of a shell, arches in the air too),
 * "below=200mm"; else THREAD_BAD_INPUT. */
THREAD_API thread_status thread_frame_set_feet_where(thread_frame *frame, const char *where,
                                                     thread_error *err);
/* Passes that an edge needs (1 .. 100) and that fit through it (0 = any number). */
THREAD_API thread_status thread_frame_set_passes(thread_frame *frame, int edge, int cover,
                                                 int capacity, thread_error *err);
/* format: "json", "obj", "csv", "ply", "dxf", "graphml". Free *bytes, which end with a NUL that *n
 * does not count, with thread_free. */
THREAD_API thread_status thread_frame_write(const thread_frame *frame, const char *format,
                                            char **bytes, size_t *n, thread_error *err);

/* ---- plans ---- */

typedef enum {
  THREAD_UNSAID = -1, /* the best ones of a recommended plan (cords), else closed */
  THREAD_CLOSED,      /* both ends of a cord at one node */
  THREAD_ANY,
  THREAD_FEET,
  THREAD_NODES, /* at nodes of end_node */
  THREAD_COUNTS /* exactly end_count[v] at node v */
} thread_ends;
typedef struct {
  size_t size;
  const char *aims;    /* "length", "turning", "length+5%,turning", "overlap,steps", ..: first,
                          second, ..; NULL = "length" */
  const char *request; /* all that is asked for, as "options" of a plan's JSON; then what is above
                          and below down to physics does not count; NULL = none */
  int cords_least, cords; /* in every component, from .. to; cords_least < 0 = exactly so many.
                             cords < 0, and no aims, distinct, limits, gap, request: as few as a
                             hand can pull, from the best ends, the shortest, as thread plan FRAME;
                             with a limit as few as it takes; else as distinct, or 1 */
  int cover, capacity; /* passes of every edge, from .. to; cover < 0 = as distinct, or 1; 0 = any
                          capacity, or that of the bore in physics */
  int distinct;        /* different cords that pass every edge; 0 = any */
  double max_length;   /* of a cord; 0 = any */
  double max_pull;     /* of a cord at its ends, times the seating tension; 0 = any */
  int tube;            /* 1: only edges are pieces, and the cord ties them at every node */
  thread_ends ends;    /* where cords end */
  int n_end_nodes;
  const int *end_node; /* of THREAD_NODES */
  const char *physics; /* of cord and beads, as the file of --physics: "{\"mu\": 0.3, \"seating\":
                          5}"; what it does not say is usual: mu 0.2, seating 1 N, .. */
  double seconds;      /* for the call, which takes at most a tenth and 0.2 s more; 0 = until it is
                          proved; < 0 = as thread plan: 20, but 0 for the shortest cords */
  int threads;         /* 1 to 1000; change no result but of a search that time ends */
  /* Hears, in the caller's thread and at least every 0.1 s, what is being done, the best value so
   * far (units, or rad of turning; INFINITY = none yet) and what it cannot be less than. Not 0 =
   * stop: it is not called again, and the call returns within 0.5 s. NULL = nobody */
  int (*progress)(void *user, const char *what, double best, double bound);
  void *user;
  double gap; /* %, 0 to 100: the search ends when the plan is so near to its bound, which is
                 THREAD_OK; < 0 = as thread plan */
  const int *end_count; /* of THREAD_COUNTS: [nodes] */
  double hand;          /* N of an end of a recommended plan, or of advice; < 0 = 10 */
} thread_plan_options;
THREAD_API void thread_plan_options_init(thread_plan_options *options, size_t size);

/* THREAD_OK: nothing is better, proved. THREAD_NOT_PROVED: *out is the best so far, or NULL if
 * there is none. The usual question, the shortest cords, is polynomial; the least turning and
 * symmetric threadings are NP-hard. */
THREAD_API thread_status thread_plan_make(const thread_frame *frame,
                                          const thread_plan_options *options, thread_plan **out,
                                          thread_error *err);
THREAD_API thread_status thread_plan_parse(const char *json, size_t n, const char *name,
                                           thread_plan **out, thread_error *err);
THREAD_API thread_status thread_plan_write(const thread_plan *plan, char **json, size_t *n,
                                           thread_error *err);             /* as bytes above */
THREAD_API void thread_plan_free(thread_plan *plan);                       /* NULL ok */
THREAD_API const thread_frame *thread_plan_frame(const thread_plan *plan); /* borrowed */
THREAD_API int thread_plan_cords(const thread_plan *plan);
/* Edges that cord i, from 0, passes, one after another: count; node (NULL ok) receives one more,
 * borrowed. 0: no such cord. */
THREAD_API int thread_plan_cord(const thread_plan *plan, int i, const int **node);

/* One cord. Forces are those of the plan's evaluation (thread_eval; "structure": 0 N = it stands
 * unpulled); without one, of the closed form while both ends are pulled. */
typedef struct {
  size_t size;
  const char *name;            /* "A"; borrowed */
  int passes, from, to;        /* edges that it passes, and the nodes where it comes out */
  double length, turning;      /* without tails and knots; of all its turns on the way */
  double pull_start, pull_end; /* N; 0 = not pulled there, INFINITY = beyond all numbers */
  const double *tension;       /* N, [passes]; NULL = not known; borrowed until thread_eval */
  const int *node;             /* [passes + 1] from, .., to; borrowed */
  int grips; /* on the way, the fewest by which a hand of 10 N seats every pass; -1 = not known */
} thread_cord;
/* Fills in what is known of cord i, from 0. THREAD_BAD_INPUT: no such cord. */
THREAD_API thread_status thread_plan_cord_summary(const thread_plan *plan, int i, thread_cord *out,
                                                  size_t size, thread_error *err);

typedef struct {
  size_t size;
  double length, bound, overlap;   /* bound: no such plan is shorter */
  double turning, largest_turning; /* of all cords, and of the one that turns most */
  double pull;                     /* at an end, of the cord that needs most: as in thread_cord */
  int passes, u_turns, shortest, straightest; /* 1: no such plan is shorter, turns less, proved */
  int stopped; /* 1: time or progress ended its search, and the pull may be beyond a hand */
} thread_summary;
THREAD_API thread_status thread_plan_summary(const thread_plan *plan, thread_summary *out,
                                             size_t size, thread_error *err);

/* Verifies every claim of the plan without a solver: THREAD_OK, or THREAD_VIOLATED and which. */
THREAD_API thread_status thread_check(const thread_plan *plan, thread_error *err);
/* Puts the pull and all tensions into the plan, as thread eval: method "capstan", "joint" or
 * "structure". */
THREAD_API thread_status thread_eval(thread_plan *plan, const char *method, double seconds,
                                     thread_error *err);
/* A document as by thread draw --type: "svg", "pdf", "html", "steps", "obj", "kit", ..; free it. */
THREAD_API thread_status thread_draw(const thread_plan *plan, const char *type, char **bytes,
                                     size_t *n, thread_error *err);
/* The same two with what options say of time, threads and progress (NULL = the usual ones). */
THREAD_API thread_status thread_eval_with(thread_plan *plan, const char *method,
                                          const thread_plan_options *options, thread_error *err);
THREAD_API thread_status thread_draw_with(const thread_plan *plan, const char *type,
                                          const thread_plan_options *options, char **bytes,
                                          size_t *n, thread_error *err);
/* What is known of a frame, as JSON (docs/outputs.md): "advice": plans for all numbers of cords and
 * ends that may be worth it; "row": the plan of its row of these cords and ends; "symmetries": its
 * groups, a threading each. THREAD_NOT_PROVED: *bytes has what there is so far, or is NULL. */
THREAD_API thread_status thread_report(const thread_frame *frame, const char *what,
                                       const thread_plan_options *options, char **bytes, size_t *n,
                                       thread_error *err);
/* The same of plans: "rise": whether the pieces of one come up in simulation; of some of one frame
 * "compare": values and rankings by simulated joints; "compare capstan", .. structure, all, rise */
THREAD_API thread_status thread_report_plans(const thread_plan *const *plan, int n_plans,
                                             const char *what, const thread_plan_options *options,
                                             char **bytes, size_t *n, thread_error *err);
#ifdef __cplusplus
}
#endif
#endif
