/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the documents that are made from a plan: one of them, or all into a folder
 * (lib/lib.h has the table of documents).
 *
 * All documents of a plan share one layout of its framework, because finding it takes long. The
 * step sheets come last, since they take longest: who stops them has all others. When the time of
 * the command is over between two documents, the rest is named and left out.
 *
 * Files that the command reads are safe: drawings_claim refuses a folder in which a document would
 * replace one, before any search. */

#include "cli/commands/commands.h"
#include "diagram/export/paper.h"
#include "diagram/layout/layout.h"
#include "graph/os.h"
#include "graph/plan/plan_measures.h"
#include "lib/lib.h"

#include <stdio.h>
#include <string.h>

/* Returns the value of --from for a choice: 0 = end, one needle; 1 = middle, two needles. */
static const char *from_name(int i)
{
  static const char *const name[] = {"end", "middle"};
  return name[i];
}

static bool take_from(void *into, const cli_option *option, const char *value)
{
  int from;
  if (!cli_choose(cli_command_name(), "--from", value, option->word, option->n_words, &from))
    return false;
  ((drawings_args *)into)->needles = 1 + from;
  return true;
}

#define AT(member) .offset = offsetof(drawings_args, member)

const cli_option drawings_options[] = {
    {"page", .kind = CLI_WORD, AT(page), .word = thr_page_name, .n_words = THR_N_PAGES,
     .help = "paper of the step sheets (default: a4)"},
    {"from", .kind = CLI_OTHER, .take = take_from, .word = from_name, .n_words = 2,
     .help = "thread each cord from its end with one needle, or those of 24 passes and more from "
             "their middle with two (default: as the plan was made for; else closed ones of 48 and "
             "more)"},
    {"working-length", .value = "MM", .kind = CLI_AMOUNT, AT(working_mm), .low = 10, .high = 1e6,
     .help =
         "cord to work with at a time, before more is joined on (default: 2000, or 24 edges where "
         "these are longer)"},
    {"kind-tolerance", .value = "X", .kind = CLI_AMOUNT, AT(kind_tolerance), .low = 1e-9,
     .high = 1e9,
     .help = "pieces whose points differ by no more are of one kind, in units of the framework "
             "(default: a hundredth of the median edge)"},
    {0}};

thr_status drawings_chains(const thr_plan *plan, const drawings_args *args, thr_text *text,
                           thr_err *err)
{
  thr_chains chains, planned;
  thr_status st =
      thr_plan_chains(plan, args->needles ? args->needles : plan->options.needles, &chains, err);

  if (!st) st = thr_plan_chains(plan, plan->options.needles, &planned, err);
  if (st) return st;

  /* With another number of needles than planned the chain may be longer: the order of work was not
   * made for that. */
  thr_text_printf(text, "longest loose chain: %d %s", chains.longest,
                  thr_pieces_word(plan, chains.longest));
  if (planned.longest < chains.longest && plan->options.order != THR_ORDER_PLANNED)
    thr_text_printf(text, ", %d as planned; thread plan --from %s puts the work in order for that",
                    planned.longest, args->needles == 1 ? "end" : "middle");

  return THR_OK;
}

/* Notes how many pages a file has. Signature of thr_document_options.pages. */
static void note_pages(const char *file, int n)
{
  cli_note("%s: %d %s", file, n, cli_plural(n, "page", "pages"));
}

/* Makes document i. layout: of the plan's framework, shared by all documents; NULL = of its own. */
static thr_status make_one(const thr_plan *plan, int i, const thr_layout *layout,
                           const drawings_args *args, thr_text *text, thr_err *err)
{
  char name[64];
  const thr_document_options options = {.pitch_mm = args->pitch_mm,
                                        .lines = args->lines,
                                        .layout = layout,
                                        .colour = args->colour,
                                        .kind_tolerance = args->kind_tolerance,
                                        .page = args->page,
                                        .view = args->view,
                                        .piece = args->piece,
                                        .needles = args->needles,
                                        .working_mm = args->working_mm,
                                        .name = cli_thing(args->path, name),
                                        .pages = note_pages};

  /* An interrupt that has ended the planning does not end the drawing, too. */
  thr_limits limits = cli_limits(0);

  if (thr_limits_stop(&limits)) limits.interrupted = NULL;
  cli_step("drawing", thr_document_file(i));

  /* What cannot be drawn in time or memory leaves no half of a file. */
  thr_status st = thr_document_make(plan, i, &options, &limits, text, err);
  cli_progress_end();

  return st;
}

/* Writes document i to path, or why there is none, and releases it. Returns an exit code. */
static int put_one(thr_status st, int i, thr_text *text, const char *path, const thr_err *err)
{
  const int code = cli_write_drawn(st, text, path, err);
  if (!code) answer_file(path, thr_document_meaning(i));

  return code;
}

/* Makes document i and writes it to path. Returns an exit code. */
static int write_one(const thr_plan *plan, int i, const thr_layout *layout, const char *path,
                     const drawings_args *args)
{
  thr_err err = {0};
  thr_text text = {0};
  const thr_status st = make_one(plan, i, layout, args, &text, &err);

  return put_one(st, i, &text, path, &err);
}

int drawings_write(const thr_plan *plan, int i, const char *path, const drawings_args *args)
{
  return write_one(plan, i, NULL, path, args);
}

bool drawings_no_sheets(const thr_plan *plan, const drawings_args *args)
{
  return args->quick && thr_pieces_count(plan) > DRAWINGS_SHEETS_PIECES;
}

/* Was the booklet written for browsers, since there are no fonts for a PDF? */
static bool is_without_fonts;

void drawings_names(const thr_plan *plan, const drawings_args *args, char names[DRAWINGS_NAMES])
{
  const int html = thr_document_find("sheets.html");
  int n = 0;

  names[0] = '\0';

  /* Without the sheets where there would be too many. */
  for (int i = 0; i < thr_documents_count() && n < DRAWINGS_NAMES; i++)
    if (thr_document_usual(i) && (i != thr_document_sheets() || !drawings_no_sheets(plan, args)))
      n += snprintf(names + n, (size_t)(DRAWINGS_NAMES - n), "%s%s", n ? " " : "",
                    thr_document_file(i == thr_document_sheets() && is_without_fonts ? html : i));
}

/* Returns whether document i may be written where `asked` is, or with -1 all usual ones: among them
 * the step sheets for browsers, which stand for the PDF where there are no fonts. */
static bool is_asked(int asked, int i)
{
  return asked < 0 ? thr_document_usual(i) || i == thr_document_find("sheets.html") : i == asked;
}

/* Formats folder/file. */
static void join_path(const char *folder, const char *file, char path[1200])
{
  const size_t n = strlen(folder);
  snprintf(path, 1200, "%s%s%s", folder, n && thr_os_is_separator(folder[n - 1]) ? "" : "/", file);
}

int drawings_claim(const char *command, const char *folder, int i)
{
  int code = EXIT_OK;
  char path[1200];

  for (int k = 0; k < thr_documents_count() && !code; k++) {
    if (!is_asked(i, k)) continue;

    /* The usual name of a document is what it is written to. */
    join_path(folder, thr_document_file(k), path);
    code = files_claim(command, NULL, path);
  }

  return code;
}

bool drawings_would_lose(const char *folder)
{
  bool lost = false;
  char path[1200];

  for (int k = 0; k < thr_documents_count(); k++) {
    if (!is_asked(-1, k)) continue;

    /* Every document that drawings_write_all may write. */
    join_path(folder, thr_document_file(k), path);
    lost = lost || files_is_taken(path, NULL);
  }

  /* The plan is among its drawings. */
  join_path(folder, "plan.json", path);

  return lost || files_is_taken(path, NULL);
}

void drawings_foretell(const thr_plan *plan, const char *folder, const drawings_args *args)
{
  char path[1200];

  for (int i = 0; i < thr_documents_count(); i++) {
    if (!thr_document_usual(i)) continue;
    if (i == thr_document_sheets() && drawings_no_sheets(plan, args)) continue;
    join_path(folder, thr_document_file(i), path);
    answer_file(path, thr_document_meaning(i));
  }
}

/* Returns the document that is made as number k: all in the order of the table, but the step sheets
 * last. */
static int nth_document(int k)
{
  const int sheets = thr_document_sheets();
  return k == thr_documents_count() - 1 ? sheets : k < sheets ? k : k + 1;
}

/* Returns whether there is no time for document k and those after it, and prints that. */
static bool too_late(int k)
{
  if (guard_deadline() == 0 || thr_clock() < guard_deadline()) return false;
  cli_error("not drawn for lack of time: %s%s", thr_document_file(nth_document(k)),
            k + 1 < thr_documents_count() ? " and what follows it" : "");
  return true;
}

/* Writes the step sheets into the folder. Where no fonts for a PDF are found, as in a container
 * that has nothing but this program, browsers print them. Returns an exit code. */
static int write_sheets(const thr_plan *plan, const thr_layout *layout, const char *folder,
                        const drawings_args *args)
{
  int i = thr_document_sheets();
  char path[1200];
  thr_err err = {0}, reason = {0};
  thr_text text = {0};

  thr_status st = make_one(plan, i, layout, args, &text, &err);
  if (st == THR_ESOLVER && thr_pages_find_fonts(&reason) == THR_ESOLVER) {
    is_without_fonts = true;
    i = thr_document_find("sheets.html");
    cli_note("%s; until then %s stands for %s", reason.text, thr_document_file(i),
             thr_document_file(thr_document_sheets()));
    thr_text_destroy(&text);
    err = (thr_err){0};
    st = make_one(plan, i, layout, args, &text, &err);
  }

  const int code = cli_in_folder(folder, thr_document_file(i), path, sizeof path);
  if (!code) return put_one(st, i, &text, path, &err);
  thr_text_destroy(&text);
  return code;
}

/* Writes all usual documents into the folder; stops at the first that fails. Returns an exit
 * code. */
static int write_all(const thr_plan *plan, const thr_layout *layout, const char *folder,
                     const drawings_args *args)
{
  int code = EXIT_OK;

  for (int k = 0; k < thr_documents_count() && !code; k++) {
    int i = nth_document(k);
    char path[1200];

    /* Sheets come last, so that nothing is left out with them. */
    if (i == thr_document_sheets() && drawings_no_sheets(plan, args)) break;

    /* The mat and others that few need are made only by name. */
    if (!thr_document_usual(i)) continue;

    /* Documents that are there already stay if the time is over. */
    if (too_late(k)) return EXIT_LIMIT;

    if (i == thr_document_sheets()) {
      code = write_sheets(plan, layout, folder, args);
      continue;
    }
    code = cli_in_folder(folder, thr_document_file(i), path, sizeof path);
    if (!code) code = write_one(plan, i, layout, path, args);
  }

  return code;
}

int drawings_write_all(const thr_plan *plan, const char *folder, const drawings_args *args)
{
  thr_layout layout = {0};
  thr_err err = {0};
  if (thr_layout_choose(&layout, &plan->frame, NULL, 0, &err)) return cli_fail(&err);
  int code = write_all(plan, &layout, folder, args);
  thr_layout_destroy(&layout);
  return code;
}
