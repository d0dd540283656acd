#include "cli/drawings.h"

#include "cli/print/copies_table.h"
#include "cli/guard.h"
#include "diagram/export/paper.h"
#include "diagram/scene/pieces.h"
#include "diagram/scene/polylines.h"
#include "diagram/sheets/sheets.h"
#include "diagram/overview/steps.h"
#include "diagram/tables/tables.h"
#include "diagram/export/viewer.h"
#include "graph/plan/chains.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>

typedef enum {
  OVERVIEW,
  SHEETS,
  STEPS,
  VIEWER,
  STEPS_TABLE,
  CORDS_TABLE,
  BEADS_TABLE,
  CHANNELS_TABLE,
  OBJ,
  GLTF,
  N_DOCUMENTS
} document;

static const struct {
  const char *type, *file;
} documents[N_DOCUMENTS] = {
    [OVERVIEW] = {"svg", "overview.svg"},
    [SHEETS] = {"pdf", "sheets.pdf"},
    [STEPS] = {"steps", "steps.txt"},
    [VIEWER] = {"html", "viewer.html"},
    [STEPS_TABLE] = {"steps.csv", "steps.csv"},
    [CORDS_TABLE] = {"cords.csv", "cords.csv"},
    [BEADS_TABLE] = {"beads.csv", "beads.csv"},
    [CHANNELS_TABLE] = {"channels.csv", "channels.csv"},
    [OBJ] = {"obj", "cords.obj"},
    [GLTF] = {"gltf", "cords.gltf"},
};

int drawings_count(void)
{
  return N_DOCUMENTS;
}

const char *drawings_type(int i)
{
  return documents[i].type;
}

const char *drawings_file(int i)
{
  return documents[i].file;
}

/* A document that says what moves a path to its copies. */
static thr_status describe(const thr_plan *plan, document which, const drawings_args *a, thr_text *text, thr_err *err)
{
  cli_copies copies;
  thr_status st = cli_copies_describe(plan, &copies, err);
  if (!st && which == STEPS) st = thr_steps_text(plan, copies.motion, a->kind_tolerance, text, err);
  if (!st && which == VIEWER) st = thr_viewer_html(plan, copies.motion, a->kind_tolerance, text, err);
  if (!st && which == CORDS_TABLE) st = thr_table_cords(plan, copies.motion, text, err);
  cli_copies_destroy(&copies);
  return st;
}

static int write_overview(const thr_plan *plan, const char *path, const drawings_args *a)
{
  thr_err err = {0};
  thr_text svg = {0};
  cli_copies copies;
  thr_overview_options options = thr_overview_options_default();
  options.pitch_mm = a->pitch_mm;
  options.colour = a->colour;
  thr_status st = cli_copies_describe(plan, &copies, &err);
  options.motion = copies.motion;
  if (!st) st = thr_overview_svg(plan, &options, &svg, &err);
  cli_copies_destroy(&copies);
  return cli_write_drawn(st, &svg, path, &err);
}

/* Says how many pages there will be before it draws them. An interrupt that has ended the planning does not end this. */
static int write_sheets(const thr_plan *plan, const char *path, const drawings_args *a)
{
  thr_err err = {0};
  thr_text pdf = {0};
  thr_sheets *sheets = NULL;
  cli_copies copies;
  thr_sheets_options options = thr_sheets_options_default();
  thr_limits limits = cli_limits(0);
  if (thr_limits_stop(&limits)) limits.interrupted = NULL;
  options.page = (thr_page_size)a->page;
  options.middle = (a->needles ? a->needles : plan->options.needles) == 2;
  options.kind_tolerance = a->kind_tolerance;
  thr_status st = cli_copies_describe(plan, &copies, &err);
  options.motion = copies.motion;
  if (!st) st = thr_sheets_make(&sheets, plan, &options, &limits, &err);
  if (!st) {
    int n = thr_sheets_pages(sheets);
    cli_note("%s: %d %s", documents[SHEETS].file, n, cli_plural(n, "page", "pages"));
    st = thr_sheets_pdf(sheets, &limits, &pdf, &err);
    cli_progress_end();
  }
  thr_sheets_destroy(sheets);
  cli_copies_destroy(&copies);
  return cli_write_drawn(st, &pdf, path, &err);
}

static const char *from_name(int i)
{
  static const char *const name[] = {"end", "middle"};
  return name[i];
}

bool drawings_option(drawings_args *a, const char *command, int option, const char *value, bool *ok)
{
  int from = 0;
  if (option == OPTION_KIND_TOLERANCE) {
    *ok = cli_double(command, "--kind-tolerance", value, 1e-9, 1e9, &a->kind_tolerance);
    return true;
  }
  if (option != OPTION_PAGE && option != OPTION_FROM) return false;
  *ok = option == OPTION_PAGE ? cli_choose(command, "--page", value, thr_page_name, THR_N_PAGES, &a->page)
                              : cli_choose(command, "--from", value, from_name, 2, &from);
  if (option == OPTION_FROM) a->needles = 1 + from;
  return true;
}

thr_status drawings_chains(const thr_plan *plan, thr_text *text, thr_err *err)
{
  thr_chains chains;
  thr_status st = thr_plan_chains(plan, &chains, err);
  if (!st) thr_text_printf(text, "longest loose chain: %d %s", chains.longest, thr_pieces_word(plan, chains.longest));
  return st;
}

int drawings_write(const thr_plan *plan, int i, const char *path, const drawings_args *a)
{
  thr_err err = {0};
  thr_text text = {0};
  thr_status st;
  switch ((document)i) {
  case OVERVIEW: return write_overview(plan, path, a);
  case SHEETS: return write_sheets(plan, path, a);
  case STEPS:
  case VIEWER:
  case CORDS_TABLE: st = describe(plan, (document)i, a, &text, &err); break;
  case STEPS_TABLE: st = thr_table_steps(plan, a->kind_tolerance, &text, &err); break;
  case BEADS_TABLE: st = thr_table_beads(plan, a->kind_tolerance, &text, &err); break;
  case CHANNELS_TABLE: st = thr_table_channels(plan, a->kind_tolerance, &text, &err); break;
  case OBJ: st = thr_polylines_obj(plan, &text, &err); break;
  default: st = thr_polylines_gltf(plan, &text, &err);
  }
  return cli_write_drawn(st, &text, path, &err);
}

bool drawings_no_sheets(const thr_plan *plan, const drawings_args *a)
{
  return a->quick && thr_pieces_count(plan) > DRAWINGS_SHEETS_PIECES;
}

void drawings_names(const thr_plan *plan, const drawings_args *a, char names[DRAWINGS_NAMES])
{
  int n = 0;
  names[0] = '\0';
  for (int i = 0; i < N_DOCUMENTS && n < DRAWINGS_NAMES; i++)
    if (i != SHEETS || !drawings_no_sheets(plan, a))
      n += snprintf(names + n, (size_t)(DRAWINGS_NAMES - n), "%s%s", n ? " " : "", documents[i].file);
}

/* In this order: the step sheets last, which take longest, so that who stops them has all others. */
static int nth_document(int k)
{
  return k == N_DOCUMENTS - 1 ? SHEETS : k < SHEETS ? k : k + 1;
}

/* Is there no time for document k and those after it? Says so. */
static bool too_late(int k)
{
  if (guard_deadline() == 0 || thr_clock() < guard_deadline()) return false;
  cli_error("not drawn for lack of time: %s%s", documents[nth_document(k)].file,
            k + 1 < N_DOCUMENTS ? " and what follows it" : "");
  return true;
}

int drawings_write_all(const thr_plan *plan, const char *folder, const drawings_args *a)
{
  int code = EXIT_OK;
  for (int k = 0; k < N_DOCUMENTS && !code; k++) {
    int i = nth_document(k);
    char path[1200];
    if (i == SHEETS && drawings_no_sheets(plan, a)) break;
    if (too_late(k)) return EXIT_LIMIT;
    code = cli_in_folder(folder, documents[i].file, path, sizeof path);
    if (!code) code = drawings_write(plan, i, path, a);
  }
  return code;
}
