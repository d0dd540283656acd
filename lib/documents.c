/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lib/documents.h"

#include "diagram/export/paper.h"
#include "diagram/mat/emboss.h"
#include "diagram/mat/mat.h"
#include "diagram/sheets/sheets.h"
#include "diagram/tables/tables.h"
#include "lib/handles.h"

#include <string.h>

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
  MAT,
  DXF,
  COMPAS,
  PAGES,
  POSTER,
  LABELS,
  N_DOCUMENTS
} document;

static const struct {
  const char *type, *file, *meaning;
} documents[N_DOCUMENTS] = {
    [OVERVIEW] = {"svg", "overview.svg", "overview.svg, the picture of all cords"},
    [SHEETS] = {"pdf", "sheets.pdf",
                "sheets.pdf: what to prepare, each step with its picture, what to do last"},
    [STEPS] = {"steps", "steps.txt", "steps.txt: each path to learn once, then its copies"},
    [VIEWER] = {"html", "viewer.html", "viewer.html: step by step in space, in any browser"},
    [STEPS_TABLE] = {"steps.csv", "steps.csv",
                     "a row per piece that the needle comes to: arms, turn, cord used"},
    [CORDS_TABLE] = {"cords.csv", "cords.csv",
                     "the cut list: a row per cord, with tails and allowances"},
    [BEADS_TABLE] = {"beads.csv", "beads.csv",
                     "the bead schedule: a row per piece, kinds, arms, bores"},
    [CHANNELS_TABLE] =
        {"channels.csv", "channels.csv",
         "which pass goes from which arm to which, piece by piece, and what crosses"},
    [OBJ] = {"obj", "cords.obj", "cords.obj: cords as lines for CAD and Blender"},
    [GLTF] = {"gltf", "cords.gltf", "cords.gltf: the same"},
    [MAT] = {"mat", "mat.pdf",
             "mat.pdf: the outlines of all pieces, true to size, to lay them out on"},
    [DXF] = {"dxf", "cords.dxf",
             "cords.dxf: a layer, a colour and a polyline in space for each cord"},
    [COMPAS] = {"compas", "cords.json", "cords.json: COMPAS polylines"},
    [PAGES] = {"sheets.html", "sheets.html",
               "the pages of sheets.pdf for any browser, which prints them"},
    [POSTER] =
        {"poster", "poster.pdf",
         "poster.pdf: the overview over several sheets, to glue together; --pitch says how large"},
    [LABELS] =
        {"labels", "labels.svg",
         "labels.svg: the pieces' names as outlines, true to size, to raise on printed pieces"},
};

int thr_documents_count(void)
{
  return N_DOCUMENTS;
}

const char *thr_document_type(int i)
{
  return documents[i].type;
}

const char *thr_document_file(int i)
{
  return documents[i].file;
}

const char *thr_document_meaning(int i)
{
  return documents[i].meaning;
}

int thr_document_find(const char *type)
{
  int i = N_DOCUMENTS - 1;
  while (i >= 0 && strcmp(documents[i].type, type) != 0)
    i--;
  return i;
}

int thr_document_sheets(void)
{
  return SHEETS;
}

bool thr_document_usual(int i)
{
  return i == PAGES ? !thr_pages_exist() : i < MAT && (i != SHEETS || thr_pages_exist());
}

bool thr_document_threads(int i)
{
  return i == SHEETS || i == STEPS;
}

static int needles_of(const thr_plan *plan, const thr_document_options *a)
{
  return a->needles ? a->needles : plan->options.needles;
}

static thr_status overview(const thr_plan *plan, const thr_document_options *a,
                           const char *const *motion, thr_text *out, thr_err *err)
{
  thr_overview_options options = thr_overview_options_default();
  options.pitch_mm = a->pitch_mm;
  options.colour = a->colour;
  options.motion = motion;
  options.layout = a->layout;
  return thr_overview_svg(plan, &options, out, err);
}

static thr_status poster(const thr_plan *plan, const thr_document_options *a,
                         const char *const *motion, const thr_limits *limits, thr_text *out,
                         thr_err *err)
{
  int n = 0;
  thr_text picture = {0};
  thr_status st = overview(plan, a, motion, &picture, err);
  if (!st) st = thr_poster_pdf(&picture, (thr_page_size)a->page, limits, &n, out, err);
  if (!st && a->pages) a->pages(documents[POSTER].file, n);
  thr_text_destroy(&picture);
  return st;
}

static thr_sheets_options sheets_options(const thr_plan *plan, const thr_document_options *a,
                                         const char *const *motion)
{
  thr_sheets_options options = thr_sheets_options_default();
  options.page = (thr_page_size)a->page;
  options.needles = needles_of(plan, a);
  options.working_mm = a->working_mm;
  options.kind_tolerance = a->kind_tolerance;
  options.motion = motion;
  options.layout = a->layout;
  return options;
}

static thr_status sheets_html(const thr_plan *plan, const thr_document_options *a,
                              const char *const *motion, const thr_limits *limits, thr_text *out,
                              thr_err *err)
{
  thr_sheets *pages = NULL;
  const thr_sheets_options options = sheets_options(plan, a, motion);
  thr_status st = thr_sheets_make(&pages, plan, &options, limits, err);
  if (!st && a->pages) a->pages(documents[PAGES].file, thr_sheets_pages(pages));
  if (!st) st = thr_sheets_html(pages, out, err);
  thr_sheets_destroy(pages);
  return st;
}

static thr_status sheets(const thr_plan *plan, const thr_document_options *a,
                         const char *const *motion, const thr_limits *limits, thr_text *out,
                         thr_err *err)
{
  int n = 0;
  const thr_sheets_options options = sheets_options(plan, a, motion);
  thr_status st = thr_sheets_write(plan, &options, limits, &n, out, err);
  if (!st && a->pages) a->pages(documents[SHEETS].file, n);
  return st;
}

static thr_status mat(const thr_plan *plan, const thr_document_options *a, const thr_limits *limits,
                      thr_text *out, thr_err *err)
{
  thr_mat *pages = NULL;
  thr_status st = thr_mat_make(&pages, plan, (thr_page_size)a->page, a->kind_tolerance, err);
  if (!st && a->pages) a->pages(documents[MAT].file, thr_mat_pages(pages));
  if (!st) st = thr_mat_pdf(pages, limits, out, err);
  thr_mat_destroy(pages);
  return st;
}

/* A document that says what moves a path to its copies. */
static thr_status describe(const thr_plan *plan, document which, const thr_document_options *a,
                           const thr_limits *limits, thr_text *out, thr_err *err)
{
  thr_motions copies;
  thr_status st = thr_motions_describe(plan, &copies, err);
  if (st) return st;
  switch (which) {
  case OVERVIEW: st = overview(plan, a, copies.motion, out, err); break;
  case SHEETS: st = sheets(plan, a, copies.motion, limits, out, err); break;
  case POSTER: st = poster(plan, a, copies.motion, limits, out, err); break;
  case PAGES: st = sheets_html(plan, a, copies.motion, limits, out, err); break;
  case STEPS:
    st = thr_steps_text(plan, copies.motion, a->kind_tolerance, needles_of(plan, a), a->layout, out,
                        err);
    break;
  case VIEWER:
    st = thr_viewer_html(plan, copies.motion, a->kind_tolerance, needles_of(plan, a), a->layout,
                         out, err);
    break;
  default: st = thr_table_cords(plan, copies.motion, a->layout, out, err);
  }
  thr_motions_destroy(&copies);
  return st;
}

thr_status thr_document_make(const thr_plan *plan, int i, const thr_document_options *options,
                             const thr_limits *limits, thr_text *out, thr_err *err)
{
  switch ((document)i) {
  case STEPS_TABLE:
    return thr_table_steps(plan, options->kind_tolerance, needles_of(plan, options),
                           options->layout, out, err);
  case BEADS_TABLE:
    return thr_table_beads(plan, options->kind_tolerance, options->layout, out, err);
  case CHANNELS_TABLE:
    return thr_table_channels(plan, options->kind_tolerance, options->layout, out, err);
  case LABELS: return thr_emboss_svg(plan, out, err);
  case MAT: return mat(plan, options, limits, out, err);
  case OBJ: return thr_polylines_obj(plan, &options->lines, out, err);
  case GLTF: return thr_polylines_gltf(plan, &options->lines, out, err);
  case DXF: return thr_polylines_dxf(plan, &options->lines, out, err);
  case COMPAS: return thr_polylines_compas(plan, &options->lines, out, err);
  default: return describe(plan, (document)i, options, limits, out, err);
  }
}
