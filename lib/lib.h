/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands behind include/thread.h: handles and their errors, notes about a framework, and the
 * documents that are made from a plan. */
#ifndef THR_LIB_H
#define THR_LIB_H

#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "include/thread.h"
#include "kit/picture.h"
#include "graph/io/json.h"
#include "graph/plan/plan_measures.h"
#include "symmetry/symmetry.h"

/* ---- libthread, the library that other programs link (include/thread.h), and what its users and
 * the commands both need: the table of documents, the notes on reading, the names of motions.
 *
 * Read include/thread.h first, then library.c (versions, lock, statuses), library_frame.c,
 * library_request.c (options), library_plan.c and library_report.c (a call is checked, translated,
 * and handed to graph/, planner/, eval/ or diagram/, by heard.c). documents.c, notes.c and
 * motions.c stand by themselves; cli/ uses the first two, too.
 *
 * This header says what the files of libthread share. */

/* ---- What is behind the opaque types of include/thread.h, and how statuses and texts get there.
 */

/* A framework of a program. */
struct thread_frame {
  thr_frame frame;
  thr_text notes; /* what reading did and found odd */
};

/* A plan of a program. */
struct thread_plan {
  thr_plan plan;
  thread_frame lent;          /* the plan's framework, for thread_plan_frame: a shallow copy */
  int **node;                 /* [n_cords] where each cord runs; owned */
  int *grips;                 /* [n_cords] as in thread_cord; owned */
  bool stopped;               /* its search was ended before it was done */
  thr_evaluation closed_form; /* both ends pulled: what is known without an evaluation, and grips */
};

/* Lets calls that use what is not reentrant come one after another. */
void thr_library_lock(void);
void thr_library_unlock(void);

/* Returns a status of the program as that of the library, with its text in *err (NULL ok). */
thread_status thr_library_status(thr_status st, const thr_err *from, thread_error *err);

/* Makes words for the command line those for programs: options are members. THR_ENOMEM. */
thr_status thr_library_words(thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Fails with THR_EINPUT: there is no shape, method, .. (kind) of the name given, only the names of
 * 0 .. n - 1. */
thr_status thr_library_none(const char *kind, const char *given, const char *(*name)(int), int n,
                            thr_err *err) THR_MUST_CHECK;

/* Copies a program's options over the usual ones in *own. The first member of both is their size,
 * and a program knows only so many bytes; theirs may be NULL. THR_EINPUT if the size is absurd.
 * what: the name of the struct. */
thr_status thr_library_options(void *own, size_t own_size, const void *theirs, const char *what,
                               thr_err *err) THR_MUST_CHECK;

/* The same for the options of plans, which become the usual ones first. THR_EINPUT, too: a member
 * is out of its range, or does not go with another one; its name, the value, what it may be. */
thr_status thr_library_plan_options(const thread_plan_options *theirs, thread_plan_options *own,
                                    thr_err *err) THR_MUST_CHECK;

/* ---- heard.c: Long calls, of which the caller hears how far they are, and which it may end. */

/* Takes the answer of a job. */
typedef struct thr_reply thr_reply;

/* What a call does: run sends its answer, or the best so far again and again, in words that another
 * process can read. It sees an interrupt and progress functions in limits, but neither time nor
 * threads. */
typedef struct {
  const char *what; /* for the caller until there is news */
  thr_status (*run)(void *user, const thr_limits *limits, thr_reply *reply, thr_err *err);
  void *user;
  bool child; /* whoever listens, it is done in a child: what it uses may crash */
} thr_job;

/* Sends an answer in place of the one before. THR_ENOMEM; THR_ESOLVER: nobody takes it. */
thr_status thr_reply_send(thr_reply *reply, const thr_text *answer, thr_err *err) THR_MUST_CHECK;

/* Does a job, in a child if options have a progress function. *answer, empty before, is what was
 * sent last, whatever the status, and the caller's to destroy. THR_ELIMIT: ended by progress, or as
 * run says. */
thr_status thr_library_do(const thr_job *job, const thread_plan_options *options, thr_text *answer,
                          thr_err *err) THR_MUST_CHECK;

/* Does a job that makes a document, under the lock, with the caller's options over the usual ones
 * in *own, and gives what it has sent. st, why: what is known to be wrong before, then how it
 * ended. */
thread_status thr_library_document(thr_status st, const thr_job *job,
                                   const thread_plan_options *options, thread_plan_options *own,
                                   thr_err *why, char **bytes, size_t *n, thread_error *err);

/* Makes a text the caller's, and leaves it empty. THR_ENOMEM if an append failed. */
thr_status thr_library_give(thr_text *text, char **bytes, size_t *n, thr_err *err) THR_MUST_CHECK;

/* ---- incumbent.c: The best cords of a search so far, as a plan that claims nothing. */

/* What cords must be, what was kept last, and who is told. Begin with thr_incumbent_begin. */
typedef struct {
  const thr_frame *frame; /* borrowed, as options; NULL = nothing is kept */
  const thr_request *options;
  int n;            /* kept so far */
  thr_metrics last; /* of the last one .. */
  double value;     /* .. and what is minimized of it */
  double pause;     /* s between two, 0 = every better one is kept */
  double next;      /* thr_clock() before which nothing is looked at */
  double hand; /* N, 0 = none: as few cords are wanted as it can pull (thr_plan_recommended), with
                  ends of any kind */
  thr_cord *waiting; /* [n_waiting] the best found since then; owned */
  int n_waiting;
  double waiting_value;
  void (*keep)(void *user, const thr_plan *plan, const thr_text *text); /* the plan, and as JSON */
  void *user;
} thr_incumbent;

/* Returns an incumbent that has nothing yet, for whom keep and user are still to be set. */
thr_incumbent thr_incumbent_begin(const thr_frame *frame, const thr_request *options, double hand);

/* For thr_limits.found: keeps the cords if they pass the checker and are better than the last ones,
 * a few times a second at most; in between the best ones wait. O(size of a plan). */
void thr_incumbent_found(thr_incumbent *best, const thr_cord *cord, int n_cords,
                         const thr_symmetry_record *symmetry);

/* Keeps the cords that wait as soon as it is time; to be called now and then. */
void thr_incumbent_look(thr_incumbent *best);

/* Keeps the plan that the search has ended with, unless it was the last one that was kept (empty:
 * none), and frees what waits. Nothing is kept afterwards. */
void thr_incumbent_end(thr_incumbent *best, const thr_plan *plan);

/* ---- library_request.c: What the options of a program ask for. */

/* Makes the request of options; the caller frees out->end_node and out->end_count, also after a
 * failure. THR_EINPUT, THR_EINFEASIBLE: a member is wrong, which is named. */
thr_status thr_library_request(const thread_plan_options *options, const thr_frame *frame,
                               thr_request *out, thr_err *err) THR_MUST_CHECK;

/* Do options leave to the program which plan it is (thr_plan_recommended)? */
bool thr_library_recommends(const thread_plan_options *options);

/* Returns limits with the time or the counted work of the options; they tell whom `given` tells.
 * work: is borrowed by them. */
thr_limits thr_library_limits(const thread_plan_options *options, const thr_request *request,
                              const thr_limits *given, double *work);

/* Returns the limits of a call that is no search: so many seconds, if above 0. */
thr_limits thr_library_time(const thread_plan_options *options, double seconds,
                            const thr_limits *given);

/* Counts the cords in every component that end at counts[n_nodes] of the nodes: the least number
 * and the most. THR_EINFEASIBLE: an odd number of ends, or none. O(nodes + edges). */
thr_status thr_end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most,
                                thr_err *err) THR_MUST_CHECK;

/* ---- report_json.c: What is known of a framework as JSON, as members of an open object. */

/* Writes the members of a row of advice: lengths in units, turning in rad, pulls in N. */
void thr_advice_put_row(thr_writer *writer, const thr_advice_row *row);

/* Appends the command that makes the plan of a row. */
typedef void thr_advice_command(const void *user, const thr_advice_row *row, thr_text *text);

/* Writes the rows of advice, each with its command, and which one is recommended, again with its
 * command (NULL: no such members). user: for command. */
void thr_advice_put_json(thr_writer *writer, const thr_frame *frame, const thr_advice *advice,
                         thr_advice_command *command, const void *user);

/* Writes the groups, and the best threading under each; before them what the frame is and what was
 * asked for, or the table alone. */
void thr_symmetries_put_json(thr_writer *writer, const thr_frame *frame, const thr_request *options,
                             const thr_symmetries *symmetries);
void thr_symmetries_put_table(thr_writer *writer, const thr_request *options,
                              const thr_symmetries *symmetries);

/* Returns the factor on the tension over so much turning, rad: exp(mu x turning); INFINITY beyond
 * 1e300. */
double thr_capstan(double mu, double turning);

/* Appends the order of a group, mantissa x 10^exponent: "8", "1.2e+40". */
void thr_order_put(thr_text *text, double mantissa, int exponent);

/* Returns the pull at the hardest end of the cords of a row, N. */
double thr_symmetry_row_pull(const thr_request *options, const thr_symmetry_row *row);

/* ---- motions.c: What takes a unique path of a symmetric plan to its copies, in words for who
 * threads. */

/* The motions of a plan in words. */
typedef struct {
  const char **motion; /* [n_cords] "turned by 90 degrees .."; NULL for no copy, and for one that no
                          motion makes; owned */
  char (*words)[104];  /* [n_images] owned */
} thr_motions;

/* Describes for each image the motion in space that is nearest to it, if it is within
 * thr_symmetry_near. Plans that are not symmetric have no words. Release with thr_motions_destroy.
 * O(images * n). */
thr_status thr_motions_describe(const thr_plan *plan, thr_motions *out,
                                thr_err *err) THR_MUST_CHECK;
void thr_motions_destroy(thr_motions *motions);

/* ---- Notes on how a framework was read, in words for its user: what was merged, dropped or found
 * odd, and what was assumed. handles.h says in which order to read the folder. */

/* Appends a line for each note, or nothing. THR_ENOMEM. Takes as long as thr_frame_near. */
thr_status thr_read_notes(const thr_frame *frame, const thr_read_report *report, thr_text *out,
                          thr_err *err) THR_MUST_CHECK;

/* What was taken of something that a file may leave open, and why: "unit", "mm", THR_FROM_NOBODY,
 * "the file names none; --units".
 */
typedef struct {
  const char *what; /* static, as the other two */
  char value[48];
  double number; /* the same as a number, NAN where it is a word */
  thr_whence from;
  char why[120]; /* in words for the user, "" = from says it all */
} thr_assumption;

enum { THR_ASSUMPTIONS = 8 };

/* Fills row with what applies to this file and returns how many: its format, unit, which way is up,
 * scale and weld tolerance always; hidden layers, parts and parallel edges where it has such. The
 * scale's `from` is never THR_FROM_FILE. */
int thr_read_assumptions(const thr_read_options *options, const thr_frame *frame,
                         const thr_read_report *report, thr_assumption row[THR_ASSUMPTIONS]);

/* Returns "assumed", "maker", "file" or "option". */
const char *thr_whence_name(thr_whence from);

/* ---- The documents that are made from a plan: overview, step sheets, tables, lines for CAD, mat
 * and so on. One table says what they are called and who makes them (documents.c), for the
 * commands, the pages and the library. handles.h says in which order to read the folder. */

int thr_documents_count(void);
const char *thr_document_type(int i);    /* as `thread draw --type` names it: "svg", "steps.csv" */
const char *thr_document_file(int i);    /* usual file name: "overview.svg" */
const char *thr_document_meaning(int i); /* what it is, for help */
int thr_document_find(const char *type); /* -1: there is none of that name */
int thr_document_sheets(void);           /* the one that takes longest: sheets.pdf */
bool thr_document_usual(int i);   /* is it one of those that "all" means? Not the mat, which needs a
                                     unit, nor others that few need */
bool thr_document_threads(int i); /* does it say, step by step, how the plan is threaded? */

/* How they are drawn; {0} is the usual way. */
typedef struct {
  double pitch_mm;            /* of the overview; 0 = automatic */
  thr_overview_colour colour; /* of the overview */
  double
      kind_tolerance; /* pieces that differ by no more are of a kind, in units; 0 = the usual one */
  double
      working_mm; /* cord that is worked with at a time, in booklet and cut list; 0 = the usual */
  int page;       /* of step sheets and mat: thr_page_size */
  int needles; /* that cords are threaded with in the step sheets: 1, 2 = from their middle; 0 = as
                  the plan says */
  thr_line_options lines;   /* of cords for CAD */
  thr_kit_view view;        /* of the picture */
  const char *piece;        /* the only one in the picture, by its name; NULL = all */
  const char *name;         /* of the thing, for the cover of the step sheets; NULL = not said */
  const thr_still *rise;    /* of the step sheets: how the pieces come up (thr_sheets_options) */
  const thr_text *kit;      /* of the viewer: the pieces' meshes (kit/files.h); NULL = none */
  const thr_layout *layout; /* of the plan's framework, by thr_layout_choose: what several documents
                               share; NULL: each lays out anew */
  void (*pages)(const char *file, int n); /* hears how many a file of pages has; NULL = nobody */
} thr_document_options;

/* Appends document i of the plan to out. THR_EINPUT: the plan has not what it shows, or an option
 * does not fit. out is for the caller to destroy in any case. */
thr_status thr_document_make(const thr_plan *plan, int i, const thr_document_options *options,
                             const thr_limits *limits, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
