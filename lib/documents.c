/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the documents of a plan: one table says what each is called, and one function who makes it,
 * so that `thread draw`, the pages and the library offer the same ones.
 *
 * Example: thr_document_find("steps.csv") is the document that is written to steps.csv, a table of
 * the steps by which the plan is threaded. */
#include "lib/lib.h"

#include "diagram/export/paper.h"
#include "diagram/mat/mat.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/sheets/sheets.h"
#include "diagram/space/space.h"
#include "diagram/tables/tables.h"
#include "eval/eval.h"
#include "kit/files.h"
#include "kit/kit.h"

#include <math.h>
#include <string.h>

/* Numbers the documents. Those before MAT are made by "all", but for one of SHEETS and PAGES. */
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
  DXF,
  GLTF,
  MAT,
  COMPAS,
  PAGES,
  MAT_PAGES,
  POSTER,
  KIT,
  PICTURE,
  N_DOCUMENTS
} document;

/* Says how each is called by --type, and what its usual file is. */
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
    [DXF] = {"dxf", "cords.dxf",
             "cords.dxf: a layer, a colour and a polyline in space for each cord"},
    [GLTF] = {"gltf", "cords.gltf", "cords.gltf: the cords as coloured lines"},
    [MAT] = {"mat", "mat.pdf",
             "mat.pdf: the outlines of all pieces, true to size, to lay them out on"},
    [COMPAS] = {"compas", "cords.json", "cords.json: COMPAS polylines"},
    [PAGES] = {"sheets.html", "sheets.html",
               "the pages of sheets.pdf for any browser, which prints them"},
    [MAT_PAGES] = {"mat.html", "mat.html", "the pages of mat.pdf for any browser"},
    [POSTER] =
        {"poster", "poster.pdf",
         "poster.pdf: the overview over several sheets, to glue together; --pitch says how large"},
    [KIT] = {"kit", "kit.3mf", "kit.3mf: the pieces to print, with names; thread kit has options"},
    [PICTURE] = {"picture", "picture.png",
                 "picture.png: the pieces to print in their places, translucent, with the cords in "
                 "them"},
};

/* Returns the number of documents. */
int thr_documents_count(void)
{
  return N_DOCUMENTS;
}

/* Returns the name of a document, as --type takes it. */
const char *thr_document_type(int i)
{
  return documents[i].type;
}

/* Returns the usual file of a document. */
const char *thr_document_file(int i)
{
  return documents[i].file;
}

/* Returns what a document is, for help. */
const char *thr_document_meaning(int i)
{
  return documents[i].meaning;
}

/* Returns the document of a name, or -1. */
int thr_document_find(const char *type)
{
  int i = N_DOCUMENTS - 1;
  while (i >= 0 && strcmp(documents[i].type, type) != 0)
    i--;
  return i;
}

/* Returns the document that takes longest. */
int thr_document_sheets(void)
{
  return SHEETS;
}

/* Returns whether "all" means a document. Where pages cannot be printed as PDF, they are HTML. */
bool thr_document_usual(int i)
{
  return i == PAGES ? !thr_pages_exist() : i < MAT && (i != SHEETS || thr_pages_exist());
}

/* Returns whether a document says how the plan is threaded, step by step. */
bool thr_document_threads(int i)
{
  return i == SHEETS || i == STEPS;
}

/* Returns with how many needles the step sheets thread: as asked for, or as the plan says. */
static int needles_of(const thr_plan *plan, const thr_document_options *asked)
{
  return asked->needles ? asked->needles : plan->options.needles;
}

/* Draws the overview. */
static thr_status overview(const thr_plan *plan, const thr_document_options *asked,
                           const char *const *motion, thr_text *out, thr_err *err)
{
  thr_overview_options options = thr_overview_options_default();

  /* What the overview takes of the options that all documents share. */
  options.pitch_mm = asked->pitch_mm;
  options.colour = asked->colour;
  options.motion = motion;
  options.layout = asked->layout;

  /* In space what no flat picture shows as it is, but for colours of single passes, which belong to
   * lanes, and for more passes than can be followed. */
  thr_guide guide;
  int n;
  thr_status st = thr_scene_check_cords(plan, &n, err);
  if (st || !plan->n_cords || options.colour != THR_COLOUR_CORD || n > THR_SCENE_LINES)
    return st ? st : thr_overview_svg(plan, &options, out, err);
  st = thr_guide_make(&guide, &plan->frame, asked->layout, err);
  options.layout = &guide.layout;
  if (!st && guide.flat) st = thr_overview_svg(plan, &options, out, err);
  if (!st && !guide.flat) st = thr_space_overview(plan, &guide, &options, out, err);
  thr_guide_destroy(&guide);
  return st;
}

/* Draws the overview over several pages, to be joined. */
static thr_status poster(const thr_plan *plan, const thr_document_options *asked,
                         const char *const *motion, const thr_limits *limits, thr_text *out,
                         thr_err *err)
{
  /* The poster is the overview, cut into pages. */
  int n = 0;
  thr_text picture = {0};
  thr_status st = overview(plan, asked, motion, &picture, err);

  /* The caller hears how many pages the paper takes. */
  if (!st) st = thr_poster_pdf(&picture, (thr_page_size)asked->page, limits, &n, out, err);
  if (!st && asked->pages) asked->pages(documents[POSTER].file, n);

  thr_text_destroy(&picture);
  return st;
}

/* Returns the options of the step sheets, on paper or as HTML. */
static thr_sheets_options sheets_options(const thr_plan *plan, const thr_document_options *asked,
                                         const char *const *motion)
{
  thr_sheets_options options = thr_sheets_options_default();

  /* What the step sheets take of the options that all documents share. */
  options.page = (thr_page_size)asked->page;
  options.needles = needles_of(plan, asked);
  options.working_mm = asked->working_mm;
  options.kind_tolerance = asked->kind_tolerance;
  options.motion = motion;
  options.layout = asked->layout;
  options.rise = asked->rise;
  options.name = asked->name;

  return options;
}

/* Finds what the step sheets say of forces: as the plan was evaluated, else by the closed form,
 * into *eval, and from which pull on its pieces hold. Pulls that are more than numbers hold are not
 * said.
 */
static thr_status find_pulls(const thr_plan *plan, thr_eval *eval, thr_sheets_options *options,
                             thr_err *err)
{
  thr_err absurd = {0};
  const thr_evaluation *pulls = &plan->evaluation;
  options->holding = NAN;

  if (!pulls->present) {
    thr_status st = thr_eval_closed_form(plan, plan->options.physics.seating, eval, &absurd);
    if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
    pulls = options->pulls = &eval->record;
  }

  return thr_eval_holding_factor(plan, pulls, &options->holding, err);
}

/* Finds whether a mat and printed pieces are too large to be asked for. */
static thr_status find_sizes(const thr_plan *plan, thr_sheets_options *options, thr_err *err)
{
  thr_mat *mat;
  thr_kit_estimate kit;
  thr_err refused;

  /* Of what is larger nobody prints a mat; its sizes would take longer than its sheets. */
  enum { MOST_EDGES = 4000 };
  options->no_mat = plan->frame.n_edges > MOST_EDGES;
  if (options->no_mat) return THR_OK;

  const thr_status st = thr_mat_make(&mat, plan, options->page, options->kind_tolerance, &refused);
  thr_mat_destroy(mat);
  if (st == THR_ENOMEM) return thr_nomem(err);

  /* A volume is known of pieces that can be made, but may not fit the bed. */
  const thr_status estimated = thr_kit_estimate_make(&kit, plan, err);
  options->no_mat = st != THR_OK;
  options->too_large = !estimated && kit.volume > 0 && kit.refused.code;
  options->weight =
      thr_kit_weight(&kit, &(options->pulls ? options->pulls : &plan->evaluation)->physics);
  return estimated;
}

/* Makes the step sheets, as HTML or as PDF. */
static thr_status sheets(const thr_plan *plan, const thr_document_options *asked,
                         const char *const *motion, bool html, const thr_limits *limits,
                         thr_text *out, thr_err *err)
{
  thr_sheets *pages = NULL;
  thr_sheets_options options = sheets_options(plan, asked, motion);
  thr_eval eval = {0};
  thr_status st = find_pulls(plan, &eval, &options, err);
  if (!st) st = find_sizes(plan, &options, err);
  int n = 0;

  /* A PDF is written page by page as it is laid out. */
  if (!st && !html) st = thr_sheets_write(plan, &options, limits, &n, out, err);
  if (!st && html) st = thr_sheets_make(&pages, plan, &options, limits, err);
  if (!st && html) n = thr_sheets_pages(pages);

  /* The caller hears how many pages there are. */
  if (!st && asked->pages) asked->pages(documents[html ? PAGES : SHEETS].file, n);
  if (!st && html) st = thr_sheets_html(pages, out, err);

  thr_sheets_destroy(pages);
  thr_eval_destroy(&eval);
  return st;
}

/* Makes the mat as PDF or HTML: the framework flat and true to size, over as many pages as it
 * takes. */
static thr_status mat(const thr_plan *plan, const thr_document_options *asked, document which,
                      const thr_limits *limits, thr_text *out, thr_err *err)
{
  thr_mat *pages = NULL;

  /* Laid out first, since the number of pages is told before they are drawn. */
  thr_status st =
      thr_mat_make(&pages, plan, (thr_page_size)asked->page, asked->kind_tolerance, err);
  if (!st && asked->pages) asked->pages(documents[which].file, thr_mat_pages(pages));
  if (!st && which == MAT) st = thr_mat_pdf(pages, limits, out, err);
  if (!st && which == MAT_PAGES) st = thr_mat_html(pages, out, err);

  thr_mat_destroy(pages);
  return st;
}

/* Makes a document that says which motion takes a path to its copies. */
static thr_status describe(const thr_plan *plan, document which, const thr_document_options *asked,
                           const thr_limits *limits, thr_text *out, thr_err *err)
{
  /* The motions in words, for all documents that name copies. */
  thr_motions copies;
  thr_status st = thr_motions_describe(plan, &copies, err);
  if (st) return st;

  /* Drawings and sheets. */
  switch (which) {
  case OVERVIEW: st = overview(plan, asked, copies.motion, out, err); break;
  case SHEETS:
  case PAGES: st = sheets(plan, asked, copies.motion, which == PAGES, limits, out, err); break;
  case POSTER: st = poster(plan, asked, copies.motion, limits, out, err); break;

  /* Text of the steps, and the viewer. */
  case STEPS:
    st = thr_steps_text(plan, copies.motion, asked->kind_tolerance, needles_of(plan, asked),
                        asked->layout, out, err);
    break;
  case VIEWER:
    st = thr_viewer_html(plan, copies.motion, asked->kind_tolerance, needles_of(plan, asked),
                         asked->layout, asked->kit, out, err);
    break;

  /* The table of cords names the motion of each copy. */
  default:
    st = thr_table_cords(plan, copies.motion, needles_of(plan, asked), asked->working_mm,
                         asked->layout, out, err);
  }

  thr_motions_destroy(&copies);
  return st;
}

/* Writes the pieces of a kit on the plates of a printer. */
static thr_status plates_3mf(const thr_kit *kit, thr_text *out, thr_err *err)
{
  thr_kit_plates plates = {0};
  thr_status st = thr_kit_plates_make(&plates, kit, err);
  if (!st) st = thr_kit_3mf(&plates, -1, out, err);
  thr_kit_plates_destroy(&plates);
  return st;
}

/* Draws a kit, or the piece of it that is named. */
static thr_status picture(const thr_kit *kit, const thr_document_options *asked,
                          const thr_limits *limits, thr_text *out, thr_err *err)
{
  thr_kit_view view = asked->view;
  view.alone = kit->only;
  view.limits = limits;
  return thr_kit_picture(kit, &view, out, err);
}

/* Up to so many pieces a picture shows triangles as fine as those to print; of more they are larger
 * by the root of the number, and at most so many times. */
static const double FEW_PIECES = 25, COARSEST = 2.5;

/* Makes the usual kit, and of it a file to print or a picture, on which names would be specks. */
static thr_status of_kit(const thr_plan *plan, document which, const thr_document_options *asked,
                         const thr_limits *limits, thr_text *out, thr_err *err)
{
  thr_kit_options options = {.kind_tolerance = asked->kind_tolerance, .to_print = which == KIT};
  if (which == PICTURE) {
    options.names = THR_KIT_NO_NAMES;
    options.only = asked->piece;

    /* Of many pieces each is small in the picture, and as many triangles would take minutes. */
    if (!asked->piece)
      options.coarse = fmin(fmax(1, sqrt(thr_pieces_count(plan) / FEW_PIECES)), COARSEST);
  }
  thr_kit kit;

  thr_status st = thr_kit_make(&kit, plan, &options, asked->layout, true, limits, err);
  if (!st)
    st = which == PICTURE ? picture(&kit, asked, limits, out, err) : plates_3mf(&kit, out, err);
  thr_kit_destroy(&kit);

  return st;
}

/* Writes the cords as OBJ or DXF, with the names of the places that the booklet speaks of. */
static thr_status placed_lines(const thr_plan *plan, document which,
                               const thr_document_options *asked, thr_text *out, thr_err *err)
{
  thr_line_options lines = asked->lines;
  thr_guide guide;
  thr_status st = thr_guide_make(&guide, &plan->frame, asked->layout, err);
  lines.label = (const char(*)[THR_LABEL])guide.label;
  if (!st) st = (which == OBJ ? thr_polylines_obj : thr_polylines_dxf)(plan, &lines, out, err);
  thr_guide_destroy(&guide);
  return st;
}

/* Makes a document; see documents.h. Documents that do not speak of copies need no motions. */
thr_status thr_document_make(const thr_plan *plan, int i, const thr_document_options *options,
                             const thr_limits *limits, thr_text *out, thr_err *err)
{
  switch ((document)i) {
  /* Tables. */
  case STEPS_TABLE:
    return thr_table_steps(plan, options->kind_tolerance, needles_of(plan, options),
                           options->layout, out, err);
  case BEADS_TABLE:
    return thr_table_beads(plan, options->kind_tolerance, options->layout, out, err);
  case CHANNELS_TABLE:
    return thr_table_channels(plan, options->kind_tolerance, options->layout, out, err);

  /* What pieces are called and where they lie. */
  case MAT:
  case MAT_PAGES: return mat(plan, options, (document)i, limits, out, err);

  /* Pieces to print. */
  case KIT:
  case PICTURE: return of_kit(plan, (document)i, options, limits, out, err);

  /* Lines for CAD. */
  case OBJ:
  case DXF: return placed_lines(plan, (document)i, options, out, err);
  case GLTF: return thr_polylines_gltf(plan, &options->lines, out, err);
  case COMPAS: return thr_polylines_compas(plan, &options->lines, out, err);

  /* The rest says what moves a path to its copies. */
  default: return describe(plan, (document)i, options, limits, out, err);
  }
}
