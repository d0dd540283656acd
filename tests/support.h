/* What the unit and property tests share: seeded random numbers, builders of frameworks and plans, and oracles that share no
 * code with the program. Builders assert that they succeed. */
#ifndef THR_SUPPORT_H
#define THR_SUPPORT_H

#include "graph/check/check.h"
#include "graph/plan/plan.h"
#include "lp/length/postman.h"
#include "planner/planners.h"

#include <check.h>
#include <stdint.h>

/* ---- running ---- */

/* Check writes every assertion that it meets into a file, which takes most of the time of tests with millions of them. Here one
 * that holds leaves no mark. */
#define _mark_point(file, line) ((void)0)

/* Runs the suite, each test in its own process; what main returns. */
int run_suite(Suite *s);

/* Adds a test to a suite with a limit of so many seconds. */
#define ADD_TEST(suite, seconds, test) add_case(suite, #test, seconds, test, 0, 1)
#define ADD_LOOP(suite, seconds, test, first, end) add_case(suite, #test, seconds, test, first, end)
void add_case(Suite *s, const char *name, double seconds, const TTest *test, int first, int end);

/* A part of n examples of an exhaustive test, one at least: all, or with THREAD_TEST_SHARE=10 in the environment a tenth. */
int share_of(int n);

/* Adds the test for a part of the numbers 0 .. end - 1, spread over them. */
#define ADD_EXAMPLES(suite, seconds, test, end) add_examples(suite, #test, seconds, test, end)
void add_examples(Suite *s, const char *name, double seconds, const TTest *test, int end);

/* Adds a test that takes long, only where all examples are run. */
#define ADD_LARGE(suite, seconds, test, first, end) add_large(suite, #test, seconds, test, first, end)
void add_large(Suite *s, const char *name, double seconds, const TTest *test, int first, int end);

/* Fails unless err holds a status with a text of one line that contains word (NULL: any). */
void assert_one_line(const thr_err *err, const char *word);

/* ---- random numbers ---- */

typedef struct {
  uint64_t state;
} rng;

rng rng_make(uint64_t seed);
int rng_below(rng *r, int n);               /* 0 .. n - 1 */
int rng_between(rng *r, int low, int high); /* both included */
double rng_unit(rng *r);                    /* [0, 1) */
void rng_shuffle(rng *r, int *a, int n);

/* ---- requests ---- */

/* Asks for these aims, a list as thr_aims_parse reads; prices of turns and the slack of the length stay as they are. */
void want(thr_request *o, const char *aims);

/* A plan of the least length, as the planner makes it. word: NULL = not wanted. */
thr_status length_plan(const thr_frame *f, const thr_request *o, const thr_limits *limits, thr_plan *p, thr_cords_word *word,
                       thr_err *err);

/* ---- frameworks ---- */

/* length NULL: Euclidean; feet is a list that ends with -1, or NULL. */
thr_frame frame_make(int n, const double (*xyz)[3], int m, const int (*edge)[2], const double *length, const int *feet);
thr_frame frame_load(const char *path, const char *edges_path);

typedef enum { TETRAHEDRON, CUBE, OCTAHEDRON, DODECAHEDRON, ICOSAHEDRON } solid;
thr_frame solid_make(solid s); /* edges of length 1 */

thr_frame path_make(int n);                        /* straight along x, unit edges, foot at node 0 */
thr_frame chain_make(int n, const double *length); /* straight along x, at most 8 edges of these lengths */
thr_frame ring_make(int n);                        /* regular n-gon of unit edges, foot at node 0 */
thr_frame star_make(int n);                        /* n unit spokes in a plane; node 0 is the hub, node 1 the foot */
thr_frame wheel_make(int n);                       /* star and rim */
thr_frame grid_make(int w, int h);                 /* unit squares in a plane, feet at the corners */
thr_frame triangles_make(int n);                   /* n separate unit triangles, each with one foot */

typedef enum { LENGTHS_EUCLID, LENGTHS_EQUAL, LENGTHS_SMALL_INTEGERS, LENGTHS_RANDOM, LENGTHS_SURDS } length_kind;
enum { LENGTH_KINDS = 5 };

/* Both, far apart, as pieces of one framework: the nodes of a come first. Lengths are Euclidean. */
thr_frame side_by_side(const thr_frame *a, const thr_frame *b);

/* Connected: a random tree of n nodes and up to extra further edges; feet at random, at least one. */
thr_frame random_frame(rng *r, int n, int extra, length_kind kind);

/* The same, with further edges between odd nodes until no more than most_odd are left. */
thr_frame random_frame_few_odd(rng *r, int n, int extra, length_kind kind, int most_odd);

/* The framework with nodes renamed at random, edges shuffled and turned round; node v becomes to[v]. */
thr_frame shuffled_frame(rng *r, const thr_frame *f, int *to);

/* ---- plans ---- */

thr_request options_for(thr_ends ends, int cover);
thr_plan plan_make(const thr_frame *f, const thr_request *o);
thr_plan plan_simple(const thr_frame *f, thr_ends ends, int cover);

/* Plan of o->cords cords through the shortest passes of a connected framework with ends; the proof is the postman's. Its cords
 * are a walk's pieces, cut where an end may be: fails if there are too few such places. */
thr_plan plan_of_cords(const thr_frame *f, const thr_request *o);

/* Appends so many closed cords there and back over an edge, and counts them in *n. */
void add_loops(thr_cord *cord, int *n, int edge, int count);

thr_text plan_text(const thr_plan *p);
thr_plan plan_from(const char *text);

void assert_same_text(const thr_text *a, const thr_text *b);

/* Asserts that the checker agrees, that JSON survives a round trip byte for byte. */
void assert_plan_sound(const thr_plan *p);

/* Status of thr_plan_parse and, if it parses, thr_check_plan. */
thr_status judge_text(const char *text, size_t n, thr_err *err);

/* Status after a round trip of an altered plan. */
thr_status judge_plan(const thr_plan *p, thr_err *err);

/* ---- oracles ---- */

/* Least length of extra passes with which o's cords cover the component of node 0 and end as o allows, by trying every
 * subset of edges (at most 20). INFINITY if no end is allowed. */
double least_extra_by_subsets(const thr_frame *f, const thr_request *o);

/* The same by all-pairs shortest paths and a perfect matching over subsets of at most 18 odd nodes. */
double least_extra_by_matching(const thr_frame *f, const thr_request *o);

/* U-turns that no pairing avoids, given the cords' passes and ends: at each node, what one edge has beyond the rest. */
int forced_u_turns(const thr_plan *p);

/* The verdict on the certificates in plain sums over edges: 0 = does not hold, 1 = a bound, 2 = proves the shortest cord. */
int verdict_by_sums(const thr_plan *p);

/* ---- memory ---- */

/* Calls make with each of its allocations failing once, fewer than most. It fails for want of memory then and leaves no text; in
 * the end it succeeds. */
void assert_allocations_may_fail(thr_status (*make)(const void *user, thr_text *t, thr_err *err), const void *user, long most);

#endif
