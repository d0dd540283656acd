/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/drawings.h"

#include "diagram/export/paper.h"
#include "diagram/layout/layout.h"
#include "graph/os.h"
#include "graph/plan/plan_measures.h"
#include "lib/documents.h"

#include <stdio.h>
#include <string.h>

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
     .help = "cord to work with at a time, before more is joined on (default: 2000)"},
    {"kind-tolerance", .value = "X", .kind = CLI_AMOUNT, AT(kind_tolerance), .low = 1e-9,
     .high = 1e9,
     .help = "pieces whose points differ by no more are of one kind, in units of the framework "
             "(default: a hundredth of the median edge)"},
    {0}};

thr_status drawings_chains(const thr_plan *plan, const drawings_args *a, thr_text *text,
                           thr_err *err)
{
  thr_chains chains, planned;
  thr_status st =
      thr_plan_chains(plan, a->needles ? a->needles : plan->options.needles, &chains, err);
  if (!st) st = thr_plan_chains(plan, plan->options.needles, &planned, err);
  if (st) return st;
  thr_text_printf(text, "longest loose chain: %d %s", chains.longest,
                  thr_pieces_word(plan, chains.longest));
  if (planned.longest < chains.longest &&
      plan->options.order !=
          THR_ORDER_PLANNED) /* the order of work is not the one for so many needles */
    thr_text_printf(text, ", %d as planned; thread plan --from %s puts the work in order for that",
                    planned.longest, a->needles == 1 ? "end" : "middle");
  return THR_OK;
}

static void note_pages(const char *file, int n)
{
  cli_note("%s: %d %s", file, n, cli_plural(n, "page", "pages"));
}

/* layout: NULL = of its own. */
static int write_one(const thr_plan *plan, int i, const thr_layout *layout, const char *path,
                     const drawings_args *a)
{
  thr_err err = {0};
  thr_text text = {0};
  const thr_document_options options = {.pitch_mm = a->pitch_mm,
                                        .lines = a->lines,
                                        .layout = layout,
                                        .colour = a->colour,
                                        .kind_tolerance = a->kind_tolerance,
                                        .page = a->page,
                                        .needles = a->needles,
                                        .working_mm = a->working_mm,
                                        .pages = note_pages};
  thr_limits limits = cli_limits(0);
  if (thr_limits_stop(&limits))
    limits.interrupted = NULL; /* an interrupt that has ended the planning does not end this */
  thr_status st = thr_document_make(plan, i, &options, &limits, &text, &err);
  cli_progress_end();
  return cli_write_drawn(st, &text, path, &err);
}

int drawings_write(const thr_plan *plan, int i, const char *path, const drawings_args *a)
{
  return write_one(plan, i, NULL, path, a);
}

bool drawings_no_sheets(const thr_plan *plan, const drawings_args *a)
{
  return a->quick && thr_pieces_count(plan) > DRAWINGS_SHEETS_PIECES;
}

void drawings_names(const thr_plan *plan, const drawings_args *a, char names[DRAWINGS_NAMES])
{
  int n = 0;
  names[0] = '\0';
  for (int i = 0; i < thr_documents_count() && n < DRAWINGS_NAMES; i++)
    if (thr_document_usual(i) && (i != thr_document_sheets() || !drawings_no_sheets(plan, a)))
      n += snprintf(names + n, (size_t)(DRAWINGS_NAMES - n), "%s%s", n ? " " : "",
                    thr_document_file(i));
}

/* Is document i one of those that are asked for? */
static bool is_asked(int asked, int i)
{
  return asked < 0 ? thr_document_usual(i) : i == asked;
}

static void name_in(const char *folder, const char *file, char path[1200])
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
    name_in(folder, thr_document_file(k), path);
    code = files_claim(command, NULL, path);
  }
  return code;
}

bool drawings_would_lose(const char *folder)
{
  bool lost = false;
  char path[1200];
  for (int k = 0; k < thr_documents_count(); k++) {
    if (!thr_document_usual(k)) continue;
    name_in(folder, thr_document_file(k), path);
    lost = lost || files_is_taken(path, NULL);
  }
  name_in(folder, "plan.json", path);
  return lost || files_is_taken(path, NULL);
}

/* In this order: the step sheets last, which take longest, so that who stops them has all others.
 */
static int nth_document(int k)
{
  const int sheets = thr_document_sheets();
  return k == thr_documents_count() - 1 ? sheets : k < sheets ? k : k + 1;
}

/* Is there no time for document k and those after it? Says so. */
static bool too_late(int k)
{
  if (guard_deadline() == 0 || thr_clock() < guard_deadline()) return false;
  cli_error("not drawn for lack of time: %s%s", thr_document_file(nth_document(k)),
            k + 1 < thr_documents_count() ? " and what follows it" : "");
  return true;
}

static int write_all(const thr_plan *plan, const thr_layout *layout, const char *folder,
                     const drawings_args *a)
{
  int code = EXIT_OK;
  for (int k = 0; k < thr_documents_count() && !code; k++) {
    int i = nth_document(k);
    char path[1200];
    if (i == thr_document_sheets() && drawings_no_sheets(plan, a)) break;
    if (!thr_document_usual(i)) continue;
    if (too_late(k)) return EXIT_LIMIT;
    code = cli_in_folder(folder, thr_document_file(i), path, sizeof path);
    if (!code) code = write_one(plan, i, layout, path, a);
  }
  return code;
}

int drawings_write_all(const thr_plan *plan, const char *folder, const drawings_args *a)
{
  thr_layout layout = {0};
  thr_err err = {0};
  if (thr_layout_choose(&layout, &plan->frame, NULL, 0, &err)) return cli_fail(&err);
  int code = write_all(plan, &layout, folder, a);
  thr_layout_destroy(&layout);
  return code;
}
