/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes what `thread plan` leaves: finds where plan and drawings go, checks the plan's text as
 * `thread check` does, and writes plan, summary and drawings. */
#include "cli/commands/plan_parts.h"
#include "eval/cord/profile.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Returns whether the folder holds a plan whose text is not this one. */
static bool holds_another(const char *folder, const thr_text *text)
{
  char path[1200];
  thr_text there = {0};

  snprintf(path, sizeof path, "%s/plan.json", folder);
  if (access(path, F_OK) != 0) return false;

  /* The same request makes the same text, which may be written over. */
  bool same = !thr_text_read(&there, path, NULL) && there.length == text->length &&
              (text->length == 0 || memcmp(there.data, text->data, text->length) == 0);
  thr_text_destroy(&there);

  return !same;
}

/* Finds the folder for a plan of which nobody said where it goes: dome, or the first of dome-2,
 * dome-3, .. that holds no other plan, and no file that this command reads. */
static void find_folder(const plan_arguments *args, const thr_text *text, char folder[280])
{
  enum { MOST = 1000 };
  char stem[256];

  cli_stem(args->path, stem, sizeof stem);
  snprintf(folder, 280, "%s", stem);

  /* With --force another plan is replaced, but never a file that was read. */
  const bool reads = drawings_would_lose(stem);

  /* The first name that is free. */
  for (int i = 2;
       i <= MOST && ((!args->force && holds_another(folder, text)) || drawings_would_lose(folder));
       i++)
    snprintf(folder, 280, "%s-%d", stem, i);

  /* Say so where it is not the usual folder. */
  if (strcmp(folder, stem) != 0)
    cli_note(reads ? "note: in %s a drawing would take the place of a file that is read: this plan "
                     "is in %s"
                   : "note: %s holds another plan: this one is in %s (--force replaces the other)",
             stem, folder);
}

int plan_try_places(const plan_arguments *args)
{
  char stem[256];

  cli_stem(args->path, stem, sizeof stem);

  /* A folder of the name of a framework that is not there would be read in its place. */
  if (strcmp(stem, args->path) == 0 && access(args->path, F_OK) != 0) return EXIT_OK;
  if (!args->draw && !args->output) return files_try_folder(stem);
  int code = args->draw ? drawings_claim("plan", args->draw, -1) : EXIT_OK;
  if (code || !args->draw || args->output) return code;

  /* The plan goes among the drawings. */
  char plan[1200];
  code = cli_in_folder(args->draw, "plan.json", plan, sizeof plan);

  return code ? code : files_claim("plan", "draw", plan);
}

int plan_find_places(const plan_arguments *args, const thr_text *text, output_places *places)
{
  if (!args->draw && !args->output) find_folder(args, text, places->own);

  places->folder = args->draw ? args->draw : args->output ? NULL : places->own;
  places->plan = args->output ? args->output : places->in_folder;
  return places->folder ? cli_in_folder(places->folder, "plan.json", places->in_folder,
                                        sizeof places->in_folder)
                        : EXIT_OK;
}

/* Reads back and checks the whole text that is to be written, as `thread check` does, so that no
 * claim is left that would be refused. *plan becomes what was read. *code becomes EXIT_LIMIT if a
 * claim was dropped. Returns an exit code; the text is not to be written unless it is EXIT_OK. */
static int check_text(thr_text *text, const char *path, thr_plan *plan, int *code)
{
  thr_err err = {0};
  int dropped;

  if (text->failed) return EXIT_OK; /* writing says so */
  thr_status st =
      thr_plan_confirm(plan, text, strcmp(path, "-") == 0 ? "stdout" : path, &dropped, &err);
  if (st == THR_ENOMEM) return cli_fail(&err);

  /* The plan itself does not hold. */
  if (st) {
    cli_error(
        "a fault of this program: the plan does not pass its own check, and is not written: %s",
        err.text);
    return EXIT_INTERNAL;
  }

  /* The plan holds without these claims, which are bits of a sum. */
  for (int claim = 1; claim <= THR_CLAIMS_ALL; claim *= 2)
    if (dropped & claim)
      cli_error("a fault of this program: what it proved of %s does not pass its own check, and is "
                "left out: %s",
                thr_claim_name(claim), err.text);
  if (dropped) *code = EXIT_LIMIT;

  return EXIT_OK;
}

/* Writes the plan. Only from here on is the plan what this run leaves, with the exit code *code,
 * which is another one if the plan lost a claim. places->plan receives where the plan is, which is
 * another place if it cannot be written there, or NULL if it is nowhere. Returns an exit code. */
static int write_plan(const plan_arguments *args, thr_plan *plan, output_places *places, int *code)
{
  thr_text text = {0};

  thr_frame_keep_hash(&plan->frame);
  thr_plan_write(plan, &text);

  int refused = plan_find_places(args, &text, places);
  cli_step("checking the plan", "");
  if (!refused) refused = check_text(&text, places->plan, plan, code);

  if (refused) {
    thr_text_destroy(&text);
    places->plan = NULL;
    return refused;
  }

  /* Until the last byte is written nothing but a second signal ends this process. */
  guard_writing();
  int written = cli_write_kept(&text, &places->plan);
  guard_written(written ? written : *code);

  return written;
}

/* Appends the line about the order of work: the longest chain of pieces that is loose at a time. */
static void put_order(const plan_arguments *args, const thr_plan *plan, thr_text *text)
{
  thr_err err = {0};
  thr_text_append(text, "order    ");
  if (drawings_chains(plan, &args->drawings, text, &err)) thr_text_append(text, err.text);
  thr_text_append(text, "\n");
}

/* Prints where the plan is and, unless folder is NULL, the drawings; and what to do if a hand
 * cannot pull the cords. Returns an exit code. */
static int print_places(const plan_arguments *args, const planned_result *result,
                        const char *plan_path, const char *folder)
{
  const thr_plan *plan = &result->plan;
  const bool unsaid = plan_is_recommended(args, &plan->options);
  char names[DRAWINGS_NAMES];
  thr_text text = {0};

  /* Where the files are. */
  thr_text_append(&text, args->compare || thr_wants_turning(&plan->options) ? "\n" : "");
  thr_text_append(&text, "plan     ");
  thr_text_append_clean(&text, plan_path);
  drawings_names(plan, &args->drawings, names);
  if (folder) {
    thr_text_append(&text, "\ndrawn    in ");
    thr_text_append_clean(&text, folder);
    thr_text_printf(&text, ": %s", names);
  }

  thr_text_append(&text, "\n");

  /* Order of work, and whether a hand can pull the cords. */
  if (plan->options.order == THR_ORDER_HAND || cli_verbose) put_order(args, plan, &text);
  const double strength = args->request.strength;
  const double bears = strength > 0 ? strength * thr_strength_left(0) : INFINITY;
  if (!unsaid || !advice_put_recommended(plan, fmin(thr_hand_always, bears), result->holds, &text))
    advice_put_hint(plan, unsaid, &text);

  return print_text(&text);
}

/* Draws everything into the folder. Drawings are always whole: a limit on the time is the search's.
 * Returns an exit code. */
static int write_drawings(const plan_arguments *args, const thr_plan *plan,
                          const output_places *places)
{
  if (!places->folder) return EXIT_OK;

  /* A search that was ended by the clock leaves time for its drawings. */
  guard_allow(0);
  const int code = drawings_write_all(plan, places->folder, &args->drawings);
  if (!code && drawings_no_sheets(plan, &args->drawings))
    cli_note(
        "no sheets.pdf, which has hundreds of pages for more than %d pieces: thread draw %s -T pdf",
        DRAWINGS_SHEETS_PIECES, strcmp(places->plan, "-") == 0 ? "plan.json" : places->plan);

  return code;
}

int plan_write_outputs(const plan_arguments *args, planned_result *result, int *planned_code)
{
  thr_plan *plan = &result->plan;
  output_places places = {0};
  const int written = write_plan(args, plan, &places, planned_code);

  if (!places.plan) return written; /* there is none */

  /* The summary for programs comes before the drawings, and names them. */
  answer_file(places.plan, "the plan");
  if (places.folder && !written) drawings_foretell(plan, places.folder, &args->drawings);

  /* A plan on stdout leaves no place for a summary. */
  const bool is_silent =
      strcmp(places.plan, "-") == 0 || (cli_quiet && !cli_json && !args->request.plot);
  cli_step("measuring the cords", "");
  int code = is_silent ? EXIT_OK : plan_print_summary(args, result);

  /* Drawings are made only of a plan that is where it was to be. */
  const int drawn = written ? EXIT_OK : write_drawings(args, plan, &places);
  if (!code) code = drawn;
  if (!code && !is_silent && !cli_json && !cli_quiet)
    code = print_places(args, result, places.plan, written ? NULL : places.folder);

  return written ? written : code;
}
