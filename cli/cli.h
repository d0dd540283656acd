/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what all commands share: options, files, messages, progress.
 *
 * The folder cli holds the command line program, and is the only one that prints or exits. A
 * command parses its options, calls the planner, the checker or eval, and prints the result;
 * functions that fail print why and return the exit code.
 *
 * Read in this order:
 *   main.c, commands/          the commands
 *   args/                      their options (args/args.h, args/options.h)
 *   cli.c                      messages, reading and writing
 *   status_line.c              the status line of a terminal
 *   files.c                    which files a command reads and writes
 *   guard.c, guard_process.c   limits of time and memory, by a child process
 *   answer.c                   what programs hear: files, failures, exit codes
 *   best.c, progress.c         the best cords found so far; progress for other programs
 *   print/                     reports of results */
#ifndef THR_CLI_H
#define THR_CLI_H

#include "cli/args/options.h"
#include "diagram/overview/overview.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/io/read.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- cli.c: What the subcommands share. */

/* Documented in the man page; scripts rely on them. */
enum {
  EXIT_OK = 0,
  EXIT_VIOLATION = 1,
  EXIT_USAGE = 2,
  EXIT_INPUT = 3,
  EXIT_INFEASIBLE = 4,
  EXIT_LIMIT = 5,
  EXIT_INTERNAL = 70,
  EXIT_SECOND_SIGNAL = 130
};

int cmd_plan(int argc, char **argv);
int cmd_symmetries(int argc, char **argv);
int cmd_advise(int argc, char **argv);
int cmd_check(int argc, char **argv);
int cmd_eval(int argc, char **argv);
int cmd_compare(int argc, char **argv);
int cmd_draw(int argc, char **argv);
int cmd_kit(int argc, char **argv);
int cmd_rise(int argc, char **argv);
int cmd_info(int argc, char **argv);
int cmd_convert(int argc, char **argv);
int cmd_make(int argc, char **argv);
int cmd_complete(int argc, char **argv); /* for shells: what may follow */

/* The commands, in the order in which a user reads them. */
typedef struct {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} cli_command;
extern const cli_command cli_commands[];
extern const int cli_n_commands;

/* ---- answer.c: Answers programs: which files a command wrote, and why it failed. */

extern bool cli_json; /* --json: the answer is JSON on stdout */

/* What each exit code means: for `thread help exit-codes` and the documents. */
typedef struct {
  int code;
  const char *meaning;
} cli_exit_code;
extern const cli_exit_code cli_exit_codes[];
extern const int cli_n_exit_codes;

/* Prints them. Returns an exit code. */
int answer_exit_codes(void);

/* Takes down the message of an error: the last one is the answer of a command that fails. */
void answer_error_is(const char *message);

/* Returns this message, and "" if there is none or stdout has an answer. */
const char *answer_error(void);

/* Takes down that stdout has an answer. */
void answer_given(void);

/* Writes {"error": .., "code": ..} to stdout if that is wanted and nothing else was the answer. */
void answer_failure(int code);

/* Takes down that a file is written, and what it is; both are copied. Nothing for NULL and stdout.
 */
void answer_file(const char *path, const char *what);

/* Writes these files as member "files", if there are any. */
void answer_put_files(thr_writer *writer);

/* Closes the object, and writes its text to stdout. Returns an exit code. */
int answer_close(thr_writer *writer);

/* Writes the whole answer of a command that has written a framework to path. Returns an exit
 * code. */
int answer_frame(const thr_frame *frame, const char *path);

/* Releases what was taken down. */
void answer_tidy(void);

/* ---- messages ---- */

extern bool cli_quiet, cli_verbose; /* -q: no notes; -v: what the solver does */

/* "thread: .." on stderr, one line. */
void cli_note(const char *format, ...) THR_PRINTF(1, 2); /* not with --quiet */
void cli_error(const char *format, ...) THR_PRINTF(1, 2);

/* Prints err and returns the exit code that belongs to its status. */
int cli_fail(const thr_err *err);

/* Prints the message and a pointer to `thread COMMAND --help`; returns EXIT_USAGE. */
int cli_usage(const char *command, const char *format, ...) THR_PRINTF(2, 3);

/* ---- options (cli/args/options.h) ---- */

/* -j: how many things are done at a time, at first one per processor. It changes no result. */
extern const cli_option cli_processes_options[];
int cli_processes(void);

/* Numbers in options, checked against a range: false prints why (a usage error). */
bool cli_double(const char *command, const char *option, const char *text, double low, double high,
                double *out);

/* The same of a quantity, with its unit behind it or in `unit` (thr_quantity_read); the range
 * counts in `unit`. "": a number without one. */
bool cli_quantity(const char *command, const char *option, const char *text, const char *unit,
                  double low, double high, double *out);

/* Converts the lengths among the options that are in the framework's units and were given with
 * another, as they are read before the framework. Prints why not: nobody knows how long its unit
 * is. Once. */
bool cli_lengths_in_units(const char *units);

bool cli_int(const char *command, const char *option, const char *text, int low, int high,
             int *out);

/* Width and height of a picture in px, as 1200x900, each from `low` to `high`. */
bool cli_pixels(const char *command, const char *option, const char *text, int low, int high,
                int size[2]);

/* Newtons for --hand: "one" and "two" hands are what these pull again and again (docs/method.md,
 * "Few cords within a pull"). */
bool cli_hand(const char *command, const char *text, double *newtons);

/* One of n words, name(0) .. name(n - 1); false prints which there are. */
bool cli_choose(const char *command, const char *option, const char *value,
                const char *(*name)(int), int n, int *out);

/* ---- frameworks and plans ---- */

/* --edges, --weld, --up, .., --feet: how to read FRAME. */
typedef struct {
  thr_read_options read;
  const char *feet; /* NULL: as the file says; words of thr_frame_feet_where, a file's name, or node
                       names with commas */
} cli_frame_args;

extern const cli_option cli_frame_options[];
cli_frame_args cli_frame_args_default(void);
/* Reads, says on stderr what was merged, dropped or odd, and sets the feet. Returns EXIT_OK or
 * prints and returns the code. */
int cli_read_frame(const char *path, const cli_frame_args *a, thr_frame *frame);
int cli_read_frame_report(const char *path, const cli_frame_args *a, thr_frame *frame,
                          thr_read_report *report);

/* Is it a folder, or a name that ends like one? */
bool cli_is_folder(const char *path);

/* Has output another ending than the file's usual name? A folder, a device, "-" or a name without
 * an ending has none. */
bool cli_misnamed(const char *output, const char *like);

/* Is output no name for a plan? Prints the line about it. */
bool cli_no_plan_name(const char *command, const char *output);

/* The format to write a framework in, NULL = JSON: what the output's name says, else type (NULL:
 * nothing was said). false: they disagree, or it is not a format that is written (printed). */
bool cli_output_format(const char *command, const char *output, const char *type,
                       const thr_format **format);

/* Says that there is no node of this name, and which comes nearest; what: "node", or what else was
 * looked for. Returns EXIT_INPUT. */
int cli_no_node(const thr_frame *frame, const char *option, const char *what, const char *name);

/* Marks one node by its name, the nodes in a list of names, or those in a file of names; false
 * prints why. */
bool cli_mark_nodes(const thr_frame *frame, const char *list, const char *option, bool *mark);

/* --ends closed, any, feet, or nodes as above: sets options->ends and, for nodes,
 * options->end_node, which the caller frees. Returns EXIT_OK or prints and returns the code. */
int cli_resolve_ends(const char *ends, const thr_frame *frame, thr_request *options);

/* Reads a plan; one that does not hold is still read, with a warning. Returns EXIT_OK or prints and
 * returns the code. */
int cli_read_plan(const char *path, thr_plan *plan);

/* File name of a path without folder and extension ("frame" for "-"). */
void cli_stem(const char *path, char *out, size_t size);

/* Writes what the thing in a file of a framework or plan is called, and returns name; NULL where
 * the file's name says nothing: stdin, plan.json, no path. */
const char *cli_thing(const char *path, char name[64]);

/* Makes a folder and those that it is in, if they are not there. Returns EXIT_OK or prints and
 * returns the code. */
int cli_make_folder(const char *folder);

/* folder/file; makes the folder if needed. Returns EXIT_OK or prints and returns the code. */
int cli_in_folder(const char *folder, const char *file, char *out, size_t size);

/* Writes and destroys the text; prints and returns the code on failure, and if the file is one that
 * the command has read. */
int cli_write(thr_text *text, const char *path);

/* The same for what took long to compute: if it cannot be written to *path, it is left in the
 * current folder under another name, or on stdout if that fails as well, *path is where, and what
 * is printed says so. */
int cli_write_kept(thr_text *text, const char **path);

/* The same for what was drawn, unless that failed with st: then err is printed. */
int cli_write_drawn(thr_status st, thr_text *text, const char *path, const thr_err *err);

/* ---- long computations ---- */

/* From now on SIGINT, SIGTERM and SIGHUP only set what cli_limits' interrupt looks at; another one
 * after a while, but for SIGHUP, ends the process. */
void cli_heed_signals(void);

/* Limits with a deadline (0 = none), Ctrl-C and, on a terminal, a progress line on stderr with the
 * time left. */
thr_limits cli_limits(double seconds);

/* ---- status_line.c: The status line of a terminal: what a command is doing, and for how long. */

/* Shows a step from now on, "reading dome.json": its words, and what it is done to ("": nothing).
 * The line is first written when the step has taken a second. */
void cli_step(const char *what, const char *of);

/* Says that a search has found so many cords. */
void cli_status_found(int n_cords);

/* Sets the functions of limits through which a search tells how far it is, and their user. */
void status_listen(thr_limits *limits);

/* Wipes the line, which from now on is not kept up: from cli_step or cli_limits on it tells every
 * second that work goes on. */
void cli_progress_end(void);
void cli_progress_wipe(void); /* wipes it for what is printed now */
void cli_wipe_line(void);     /* the same for one that another process has left */

/* Is it a terminal that understands more than lines? Not with TERM=dumb. */
bool cli_is_terminal(int file);

/* Is it one that has colours, of which NO_COLOR wants none? */
bool cli_is_coloured(int file);

/* ---- tables ---- */

/* "n word" or "n words". */
const char *cli_plural(int n, const char *one, const char *many);

/* What the n multipliers of the plan's proof of length stand on: "odd cut", "odd cuts", "odd sets
 * and junctions". */
const char *cli_cuts_word(const thr_plan *plan, int n);

/* ---- files.c: The files that a command reads and writes: no file is asked for twice, and every
 * output is tried before anything is computed. */

/* Takes down an option with its value, or an operand (option NULL). writes: it is the name of an
 * output. The strings stay the caller's, and where they are. */
void files_heard(const char *option, const char *value, bool writes);

/* Compares all that was heard, makes the folders of outputs and tries to write there. Returns
 * EXIT_OK, or prints and returns the code: EXIT_USAGE for a file that is asked for twice,
 * EXIT_INPUT for an output that cannot be written. */
int files_settle(const char *command);

/* Makes a folder and tries to write there. Returns EXIT_OK, or prints and returns the code. */
int files_try_folder(const char *folder);

/* Takes down a file that is read unasked. Returns EXIT_OK, or prints and returns the code if it is
 * an output. */
int files_also_read(const char *path);

/* Is path a file that was heard of, but not with this option (NULL: with any)? */
bool files_is_taken(const char *path, const char *option);

/* Prints which file would be lost and returns EXIT_USAGE if path, to be written by this option, is
 * taken; else EXIT_OK. */
int files_claim(const char *command, const char *option, const char *path);

/* The same at the last moment, for inputs only: nothing that was read is ever written over. */
int files_may_write(const char *path);

/* Finds a name in the current folder that no file has, like that of path: "plan.json",
 * "plan-2.json", .. */
void files_name_beside(const char *path, char *name, size_t size);

/* Takes down that a folder was made; at the end those that are still empty are removed. */
void files_made(const char *folder);
void files_tidy(void);

/* ---- guard.c: Limits that hold whatever a command does: it runs in a child process whose memory
 * the system bounds, and which is ended when its time is over. */

/* --time-limit and --memory. */
typedef struct {
  double seconds; /* 0 = no limit, < 0 = not said */
  double memory;  /* bytes, 0 = no limit */
} guard_limits;

guard_limits guard_limits_default(void); /* no time said, 2 GB */

/* --time-limit and --memory; those without the first are for commands that say more of it. */
extern const cli_option guard_options[], guard_memory_options[];
#define GUARD_TIME_LIMIT                                                                           \
  "time-limit", .value = "S", .kind = CLI_AMOUNT, .offset = offsetof(guard_limits, seconds),       \
                .high = 1e9

typedef enum {
  GUARD_DONE,        /* the child ended by itself, with `code` */
  GUARD_TIME,        /* it did not end in its time, and was ended */
  GUARD_INTERRUPTED, /* nor when it was asked to by a signal */
  GUARD_MEMORY,      /* it had no more memory */
  GUARD_DIED         /* of a signal that nobody here sent, or a library ended it */
} guard_reason;

typedef struct {
  guard_reason reason;
  int code;      /* GUARD_DONE: the exit code */
  bool written;  /* its result was out, with exit code `code`: only what comes after is missing */
  thr_text kept; /* what it handed over last; owned by the caller */
  char why[120]; /* the reason in words: "not done after 2 s" */
} guard_end;

/* Forks. Returns false in the child. Returns true in the parent, after the child has ended, or if
 * there could be none (printed: GUARD_DONE with EXIT_INTERNAL). The first SIGINT, SIGTERM or SIGHUP
 * is passed on to the child, which has half a second more then; the second ends both at once, but
 * for another SIGHUP. */
bool guard_fork(const guard_limits *l, guard_end *end);

/* Where there is only one process (in a browser, targets/alone_guard.c), guard_fork returns false,
 * and the command asks this when it is done, with its exit code: true if it left nothing but has
 * kept something, for which *end is then filled as for a parent. False where there are two. */
bool guard_alone(int code, guard_end *end);

/* thr_clock() at which the child must be done; 0 = any time. Without a child 0. */
double guard_deadline(void);

/* From here on there are so many seconds, whatever there were; 0 = any time. */
void guard_allow(double seconds);

/* In the child; nothing without one. kept: replaces what was handed over before. Between writing
 * and written nothing ends the child but a second signal. No memory: what the parent is to say if
 * the child fails now; false if there is no parent. Answered: stdout has what programs read.
 * Ending: the child exits with this code by itself, not a library, and its last error was this;
 * false if there is no parent to tell it. */
void guard_keep(const thr_text *text);
void guard_writing(void);
void guard_written(int code);
bool guard_no_memory(void);
void guard_answered(void);
bool guard_ending(int code, const char *error);

/* What a command does that has nothing to hand over: prints why it ended and returns the exit code.
 */
int guard_conclude(guard_end *end, const char *missing);

/* ---- progress.c: --progress: how far a search is, for a program that reads it: one JSON object on
 * a line of stderr each time the plan or its bound is better. */

/* From here on lines are written. */
void progress_begin(void);

bool progress_wanted(void);

/* Sets the functions of limits that tell of progress; their user may be any. */
void progress_listen(thr_limits *limits);

/* Begins a line, whose members the caller writes; ends it with the seconds since the beginning,
 * writes it at once and releases the text. */
thr_writer progress_open(thr_text *text, const char *what);
void progress_close(thr_writer *writer);

/* A plan that is better than the last one. */
void progress_plan(const thr_plan *plan);

/* ---- best.c: The best cords found so far, handed to the parent (cli/guard.c) as a plan that
 * claims nothing. */

/* What cords must be: those of a plan for this framework with these options, both of which stay as
 * they are until the search is over; or, for a hand, N, as few as it can pull (0 = none). */
void best_begin(const thr_frame *frame, const thr_request *options, double hand);

/* For thr_limits.found: keeps the cords if they pass the checker and are better than the last ones,
 * a few times a second at most. O(size of a plan). */
void best_found(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry);

/* Hands over what waits for its turn, if it is time. */
void best_look(void);

/* Hands over the plan that the search has ended with, unless it was the last one (empty: none). */
void best_end(const thr_plan *plan);

#endif
