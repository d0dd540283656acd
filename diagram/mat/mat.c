/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Middles of pieces on the mat, its pages, and what is on each. */
#include "diagram/mat/mat.h"

#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/tables/supplies.h"
#include "graph/framework/frame.h"
#include "graph/framework/units.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double MARGIN = 12, HEAD = 19,
                    FOOT = 20;                /* mm: around a page; above and below what it shows */
static const double OVERLAP = 12, AROUND = 2; /* mm: of two pages; around all pieces */
static const double CLEAR = 12; /* mm: between a seam and the middle of a piece, if there is room */
static const double FACES = 0.9;                       /* mm between the faces of two pieces */
static const double TEXT = 2.6, NAME = 3.4, LARGE = 8; /* mm: sizes of letters */
static const double MARK = 3;                          /* mm: half a register mark */
static const double BAR = 100;                         /* mm */
enum { OFFSETS = 60, MARKS = 3 };                      /* tried for the seams; marks along a seam */

struct thr_mat {
  const thr_plan *plan;
  const thr_frame *f;
  const thr_frame *paper; /* what edges join on paper */
  thr_page_size page;
  double size[2], window[2]; /* mm: of a page, of what it shows of the mat */
  thr_guide guide;
  thr_pieces pieces;
  thr_supplies supplies;
  double mm, spread, width; /* mm per unit; drawn over true; of an arm */
  double (*at)[2];          /* [points] mm, from the mat's corner, y down; owned */
  int tiles[2];
  double origin[2]; /* of the first tile */
  int n;            /* pages */
  int *tile;        /* [n] row by row; owned */
  int *number;      /* [tiles] from 1; 0 = none; owned */
};

void thr_mat_destroy(thr_mat *mat)
{
  if (!mat) return;
  thr_guide_destroy(&mat->guide);
  thr_pieces_destroy(&mat->pieces);
  thr_supplies_destroy(&mat->supplies);
  free(mat->at);
  free(mat->tile);
  free(mat->number);
  free(mat);
}

/* ---- where things are ---- */

/* The most that an edge is drawn too short by; at least 1. */
static double find_spread(const thr_mat *mat)
{
  double most = 1;
  for (int e = 0; e < mat->f->n_edges; e++) {
    const double *a = mat->guide.layout.xy[mat->paper->edge[e][0]],
                 *b = mat->guide.layout.xy[mat->paper->edge[e][1]];
    double drawn = hypot(b[0] - a[0], b[1] - a[1]);
    most = fmax(most, drawn > 0 ? mat->f->length[e] / drawn : HUGE_VAL);
  }
  return most;
}

/* Points from the corner that the outermost pieces touch. */
static void place_points(thr_mat *mat, double extent[2])
{
  const thr_layout *layout = &mat->guide.layout;
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL},
         around = 0.5 * mat->width + AROUND;
  for (int p = 0; p < layout->n_points; p++)
    for (int k = 0; k < 2; k++) {
      mat->at[p][k] = (k ? -1 : 1) * layout->xy[p][k] * mat->spread * mat->mm;
      low[k] = fmin(low[k], mat->at[p][k]);
      high[k] = fmax(high[k], mat->at[p][k]);
    }
  for (int k = 0; k < 2; k++) {
    extent[k] = high[k] - low[k] + 2 * around;
    for (int p = 0; p < layout->n_points; p++)
      mat->at[p][k] += around - low[k];
  }
}

/* Between the middle of a seam and the nearest middle of a piece, with the first tile at an offset.
 */
static double clearance(const thr_mat *mat, int k, double origin)
{
  double step = mat->window[k] - OVERLAP, least = HUGE_VAL;
  for (int t = 1; t < mat->tiles[k]; t++)
    for (int p = 0; p < mat->guide.layout.n_points; p++)
      least = fmin(least, fabs(mat->at[p][k] - (origin + t * step + 0.5 * OVERLAP)));
  return least;
}

/* The mat is in the middle of its pages, but moved as little as it takes for names to stay whole.
 */
static void place_tiles(thr_mat *mat, const double extent[2])
{
  for (int k = 0; k < 2; k++) {
    double step = mat->window[k] - OVERLAP, best = -1;
    mat->tiles[k] = (int)fmax(1, ceil((extent[k] - OVERLAP) / step - 1e-9));
    double room = mat->tiles[k] * step + OVERLAP - extent[k];
    mat->origin[k] = -0.5 * room;
    for (int i = 0; i <= OFFSETS && mat->tiles[k] > 1;
         i++) { /* from the middle to both sides in turn */
      double part = (i % 2 ? 0.5 : -0.5) * ((i + 1) / 2) / (OFFSETS / 2),
             origin = -room * (0.5 + part);
      double now = fmin(clearance(mat, k, origin), CLEAR);
      if (now <= best + 1e-9) continue;
      best = now;
      mat->origin[k] = origin;
    }
  }
}

static void tile_corner(const thr_mat *mat, int tile, double at[2])
{
  const int place[2] = {tile % mat->tiles[0], tile / mat->tiles[0]};
  for (int k = 0; k < 2; k++)
    at[k] = mat->origin[k] + place[k] * (mat->window[k] - OVERLAP);
}

/* Hub and ends of the piece that a point, or with tube joints an edge, shows. */
static void find_arms(const thr_mat *mat, int item, thr_arms *arms)
{
  *arms = (thr_arms){.width = mat->width, .fill = "#fdf6e3", .outline = "#222", .line = 0.4};
  if (!mat->pieces.solid) {
    const double *a = mat->at[mat->paper->edge[item][0]], *b = mat->at[mat->paper->edge[item][1]];
    double drawn = hypot(b[0] - a[0], b[1] - a[1]),
           half = 0.5 * fmax(mat->f->length[item] * mat->mm - mat->width, 0);
    arms->n = 2;
    for (int k = 0; k < 2; k++) {
      arms->hub[k] = 0.5 * (a[k] + b[k]);
      arms->end[0][k] = arms->hub[k] + (drawn > 0 ? half * (a[k] - b[k]) / drawn : 0);
      arms->end[1][k] = arms->hub[k] + (drawn > 0 ? half * (b[k] - a[k]) / drawn : 0);
    }
    return;
  }
  for (int k = 0; k < 2; k++)
    arms->hub[k] = mat->at[item][k];
  for (int i = mat->paper->first[item]; i < mat->paper->first[item + 1] && arms->n < THR_ARMS;
       i++) {
    int h = mat->paper->half[i];
    const double *b = mat->at[thr_head(mat->paper, h)];
    double drawn = hypot(b[0] - arms->hub[0], b[1] - arms->hub[1]);
    double length = 0.5 * fmax(mat->f->length[h >> 1] * mat->mm - fmin(FACES, 0.1 * mat->width), 0);
    for (int k = 0; k < 2; k++)
      arms->end[arms->n][k] =
          arms->hub[k] + (drawn > 0 ? length * (b[k] - arms->hub[k]) / drawn : 0);
    arms->n++;
  }
}

static int count_items(const thr_mat *mat)
{
  return mat->pieces.solid ? mat->guide.layout.n_points : mat->f->n_edges;
}

/* Does a piece reach into a box from a corner? */
static bool reaches(const thr_mat *mat, const thr_arms *arms, const double corner[2])
{
  double low[2] = {arms->hub[0], arms->hub[1]}, high[2] = {arms->hub[0], arms->hub[1]},
         w = 0.5 * mat->width;
  for (int i = 0; i < arms->n; i++)
    for (int k = 0; k < 2; k++) {
      low[k] = fmin(low[k], arms->end[i][k]);
      high[k] = fmax(high[k], arms->end[i][k]);
    }
  bool in = true;
  for (int k = 0; k < 2; k++)
    in &= high[k] + w > corner[k] && low[k] - w < corner[k] + mat->window[k];
  return in;
}

/* Numbers the tiles that a piece reaches into. */
static thr_status number_pages(thr_mat *mat, thr_err *err)
{
  if ((double)mat->tiles[0] * mat->tiles[1] > 25.0 * THR_MAT_PAGES)
    return thr_fail(err, THR_EINPUT, "a mat of true size would be %d pages wide and %d high",
                    mat->tiles[0], mat->tiles[1]);
  int n = mat->tiles[0] * mat->tiles[1];
  mat->tile = thr_calloc((size_t)n, sizeof *mat->tile);
  mat->number = thr_calloc((size_t)n, sizeof *mat->number);
  if (!mat->tile || !mat->number) return thr_nomem(err);
  for (int t = 0; t < n; t++) {
    double corner[2];
    bool used = false;
    tile_corner(mat, t, corner);
    for (int i = 0; i < count_items(mat) && !used; i++) {
      thr_arms arms;
      find_arms(mat, i, &arms);
      used = reaches(mat, &arms, corner);
    }
    if (!used) continue;
    mat->tile[mat->n++] = t;
    mat->number[t] = mat->n;
  }
  if (mat->n <= THR_MAT_PAGES) return THR_OK;
  return thr_fail(err, THR_EINPUT, "a mat of true size would take %d pages; %d are the most",
                  mat->n, THR_MAT_PAGES);
}

static thr_status prepare(thr_mat *mat, double tolerance, thr_err *err)
{
  thr_physics physics;
  double extent[2];
  if (thr_units_in_mm(mat->f->units, &mat->mm, NULL))
    return thr_fail(
        err, THR_EINPUT,
        "a mat is of true size, and nobody knows the framework's unit: plan it with --units");
  thr_status st = thr_physics_resolve(&mat->plan->options.physics, mat->f, &physics, err);
  if (!st) st = thr_supplies_make(&mat->supplies, mat->plan, err);
  if (!st) st = thr_supplies_find_sizes(&mat->supplies, err);
  if (!st) st = thr_guide_make(&mat->guide, mat->f, NULL, err);
  if (!st) st = thr_pieces_make(&mat->pieces, mat->plan, tolerance, err);
  if (st) return st;
  mat->paper = thr_layout_paper(&mat->guide.layout, mat->f);
  mat->width = physics.bead_diameter;
  mat->spread = find_spread(mat);
  if (!isfinite(mat->spread))
    return thr_fail(err, THR_EINPUT, "no flat picture shows all edges: there is no mat of it");
  if (!(mat->at = thr_calloc((size_t)mat->guide.layout.n_points, sizeof *mat->at)))
    return thr_nomem(err);
  thr_page_mm(mat->page, mat->size);
  mat->window[0] = mat->size[0] - 2 * MARGIN;
  mat->window[1] = mat->size[1] - 2 * MARGIN - HEAD - FOOT;
  place_points(mat, extent);
  for (int k = 0; k < 2; k++)
    if (extent[k] > 25.0 * THR_MAT_PAGES * mat->window[k])
      return thr_fail(err, THR_EINPUT, "a mat of true size would be %.3g m wide and %.3g m high",
                      extent[0] / 1000, extent[1] / 1000);
  place_tiles(mat, extent);
  return number_pages(mat, err);
}

thr_status thr_mat_make(thr_mat **out, const thr_plan *plan, thr_page_size page, double tolerance,
                        thr_err *err)
{
  thr_mat *mat = *out = thr_calloc(1, sizeof *mat);
  if (!mat) return thr_nomem(err);
  mat->plan = plan;
  mat->f = &plan->frame;
  mat->page = page;
  thr_status st = prepare(mat, tolerance, err);
  if (!st) return THR_OK;
  thr_mat_destroy(mat);
  *out = NULL;
  return st;
}

int thr_mat_pages(const thr_mat *mat)
{
  return mat->n;
}

void thr_mat_at(const thr_mat *mat, int piece, double at[2])
{
  thr_arms arms;
  find_arms(mat, piece, &arms);
  at[0] = arms.hub[0];
  at[1] = arms.hub[1];
}

void thr_mat_corner(const thr_mat *mat, int i, double at[2])
{
  tile_corner(mat, mat->tile[i], at);
}

/* ---- what is on a page ---- */

/* A page being written: corner of the mat's part on it, and where that goes on paper. */
typedef struct {
  const thr_mat *mat;
  double corner[2], to[2];
  thr_text *svg;
} sheet;

static void on_paper(const sheet *s, const double at[2], double xy[2])
{
  for (int k = 0; k < 2; k++)
    xy[k] = at[k] - s->corner[k] + s->to[k];
}

static void put_word(const sheet *s, const double at[2], double size, const char *attributes,
                     const char *words)
{
  thr_svg_text(s->svg, at[0], at[1] + 0.36 * size, size, attributes, words);
}

/* At the end of an arm a ring for every cord that goes in there, side by side, and further in the
 * name of what it faces. */
static void put_arm(const sheet *s, const double hub[2], const double end[2], int cords,
                    const char *faces)
{
  double d[2] = {end[0] - hub[0], end[1] - hub[1]}, length = hypot(d[0], d[1]);
  if (!(length > 0)) return;
  double most = fmax(1, floor(0.8 * s->mat->width / 1.3)), ring = fmin(0.5, 0.07 * s->mat->width);
  for (int k = 0; k < 2; k++)
    d[k] /= length;
  for (int i = 0; i < cords && i < most; i++) {
    double off = (i - 0.5 * (fmin(cords, most) - 1)) * 2.6 * ring, back = length - 1 - ring;
    thr_text_printf(s->svg,
                    "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"none\" stroke=\"#222\" "
                    "stroke-width=\"0.25\"/>\n",
                    thr_svg_round(hub[0] + back * d[0] - off * d[1]),
                    thr_svg_round(hub[1] + back * d[1] + off * d[0]), ring);
  }
  double wide =
      fabs(d[0]) * 0.33 * TEXT * thr_text_columns(faces, SIZE_MAX) + fabs(d[1]) * 0.5 * TEXT;
  double at = length - 1.6 - 2 * ring - wide;
  if (at - wide < NAME + 0.6) return;
  put_word(s, (const double[]){hub[0] + at * d[0], hub[1] + at * d[1]}, TEXT,
           " text-anchor=\"middle\" style=\"fill:#666\"", faces);
}

/* Name and kind of a piece on its hub, in lines; a name with a hyphen that is too wide for an
 * upright tube takes two. */
static void put_name(const sheet *s, const thr_arms *arms, const char *name, const char *kind)
{
  const thr_mat *mat = s->mat;
  const char *hyphen = strchr(name, '-');
  bool upright = !mat->pieces.solid &&
                 fabs(arms->end[0][1] - arms->hub[1]) > fabs(arms->end[0][0] - arms->hub[0]);
  double most = fmax(NAME, fmin(LARGE, 0.3 * mat->width));
  bool parted = upright && hyphen && 0.7 * TEXT * thr_text_columns(name, SIZE_MAX) > mat->width;
  size_t first = parted ? (size_t)(hyphen - name) + 1 : strlen(name);
  double size = fmax(TEXT, fmin(most, 1.5 * mat->width / (1 + thr_text_columns(name, first)))),
         line = 1.15 * size;
  int lines = 1 + parted;
  bool room = parted || mat->width > size + TEXT;
  double y = arms->hub[1] - 0.5 * ((lines - 1) * line + (room ? 0.5 * size + 0.7 * TEXT : 0));
  for (int i = 0; i < lines; i++, y += line) {
    char words[2 * THR_LABEL + 8];
    snprintf(words, sizeof words, "%.*s", (int)(i ? strlen(name + first) : first),
             i ? name + first : name);
    put_word(s, (const double[]){arms->hub[0], y}, size,
             " text-anchor=\"middle\" font-weight=\"bold\"", words);
  }
  y += 0.5 * size + 0.7 * TEXT - line;
  if (room)
    put_word(s, (const double[]){arms->hub[0], y}, TEXT,
             " text-anchor=\"middle\" style=\"fill:#666\"", kind);
}

static void put_item(const sheet *s, int item)
{
  const thr_mat *mat = s->mat;
  const thr_frame *paper = mat->paper;
  thr_arms arms;
  thr_text name = {0};
  char kind[24];
  find_arms(mat, item, &arms);
  if (!reaches(mat, &arms, s->corner)) return;
  on_paper(s, arms.hub, arms.hub);
  for (int i = 0; i < arms.n; i++)
    on_paper(s, arms.end[i], arms.end[i]);
  int piece = mat->pieces.solid ? thr_layout_node(&mat->guide.layout, item) : item;
  thr_arms_draw(&arms, s->svg);
  for (int i = 0; i < arms.n && mat->pieces.solid; i++) {
    int h = paper->half[paper->first[item] + i];
    put_arm(s, arms.hub, arms.end[i], mat->supplies.passes[h >> 1],
            mat->guide.label[thr_layout_node(&mat->guide.layout, thr_head(paper, h))]);
  }
  thr_pieces_name(&mat->pieces, (const char(*)[THR_LABEL])mat->guide.label, piece, &name);
  thr_pieces_kind_name(&mat->pieces, mat->pieces.kind[piece], kind);
  if (name.data && !name.failed) put_name(s, &arms, name.data, kind);
  if (name.failed) s->svg->failed = true;
  thr_text_destroy(&name);
}

/* Between a point and the nearest outline, mm. */
static double distance_to_pieces(const thr_mat *mat, const double at[2])
{
  double least = HUGE_VAL;
  for (int item = 0; item < count_items(mat); item++) {
    thr_arms arms;
    find_arms(mat, item, &arms);
    for (int i = 0; i < arms.n; i++) {
      double d[2] = {arms.end[i][0] - arms.hub[0], arms.end[i][1] - arms.hub[1]},
             square = d[0] * d[0] + d[1] * d[1];
      double part =
          square > 0 ? ((at[0] - arms.hub[0]) * d[0] + (at[1] - arms.hub[1]) * d[1]) / square : 0;
      part = fmin(fmax(part, 0), 1);
      least =
          fmin(least, hypot(at[0] - arms.hub[0] - part * d[0], at[1] - arms.hub[1] - part * d[1]) -
                          0.5 * mat->width);
    }
  }
  return least;
}

static void put_mark(const sheet *s, const double at[2])
{
  double xy[2];
  on_paper(s, at, xy);
  thr_text_printf(
      s->svg,
      "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"#fff\" stroke=\"#222\" "
      "stroke-width=\"0.3\"/>\n"
      "<path stroke=\"#222\" stroke-width=\"0.3\" d=\"M%.2f %.2fh%.2fM%.2f %.2fv%.2f\"/>\n",
      xy[0], xy[1], 0.6 * MARK, xy[0] - MARK, xy[1], 2 * MARK, xy[0], xy[1] - MARK, 2 * MARK);
}

/* Marks along the seam that begins at a corner of two tiles and is parallel to axis k: each is
 * moved until no outline is below it. */
static void put_marks(const sheet *s, const double corner[2], int k)
{
  const thr_mat *mat = s->mat;
  for (int i = 0; i < MARKS; i++) {
    double at[2], best[2] = {corner[0], corner[1]}, most = -HUGE_VAL;
    for (int try = 0; try < 40 && most < MARK + 0.5; try++) {
      double along =
          (i + 0.5) / MARKS * mat->window[k] + (try % 2 ? -1 : 1) * ((try + 1) / 2) * 1.5;
      at[k] = corner[k] + along;
      at[1 - k] = corner[1 - k] + 0.5 * OVERLAP;
      double now = fmin(distance_to_pieces(mat, at), MARK + 1);
      if (now <= most) continue;
      most = now;
      best[0] = at[0];
      best[1] = at[1];
    }
    put_mark(s, best);
  }
}

/* The strips that overlap the neighbours, grey where this page lies on top: to the right and below.
 */
static void put_seams(const sheet *s, int tile, bool marks)
{
  const thr_mat *mat = s->mat;
  int column = tile % mat->tiles[0], row = tile / mat->tiles[0];
  for (int k = 0; k < 2; k++)
    for (int side = 0; side < 2; side++) {
      int place = k ? row : column, other = tile + (side ? 1 : -1) * (k ? mat->tiles[0] : 1);
      if (side ? place + 1 >= mat->tiles[k] : place == 0) continue;
      if (!mat->number[other]) continue;
      double corner[2] = {s->corner[0], s->corner[1]}, xy[2];
      if (side) corner[k] += mat->window[k] - OVERLAP;
      on_paper(s, corner, xy);
      if (marks)
        put_marks(s, corner, 1 - k);
      else if (side)
        thr_text_printf(
            s->svg, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#eee\"/>\n",
            xy[0], xy[1], k ? mat->window[0] : OVERLAP, k ? OVERLAP : mat->window[1]);
    }
}

/* Which page this is among all, in small. */
static void put_map(const sheet *s, int tile)
{
  const thr_mat *mat = s->mat;
  double cell = fmin(7, fmin(60.0 / mat->tiles[0], (HEAD - 4) / mat->tiles[1])),
         right = mat->size[0] - MARGIN;
  for (int t = 0; t < mat->tiles[0] * mat->tiles[1]; t++) {
    double x = right - (mat->tiles[0] - t % mat->tiles[0]) * cell,
           y = MARGIN + t / mat->tiles[0] * cell;
    char number[16];
    thr_text_printf(s->svg,
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\" "
                    "stroke=\"#222\" stroke-width=\"0.3\"/>\n",
                    x, y, cell, cell, t == tile ? "#222" : "#fff");
    snprintf(number, sizeof number, "%d", mat->number[t]);
    if (mat->number[t] && cell >= 5)
      put_word(s, (const double[]){x + 0.5 * cell, y + 0.5 * cell}, TEXT,
               t == tile ? " text-anchor=\"middle\" style=\"fill:#fff\""
                         : " text-anchor=\"middle\"",
               number);
  }
}

static void put_head(const sheet *s, int i)
{
  const thr_mat *mat = s->mat;
  char line[200], doubt[160];
  snprintf(line, sizeof line, "Mat, page %d of %d", i + 1, mat->n);
  thr_svg_text(s->svg, MARGIN, MARGIN + 5, 5, " font-weight=\"bold\"", line);
  thr_svg_text(s->svg, MARGIN, MARGIN + 10, TEXT, "",
               mat->pieces.solid
                   ? "Print at 100 %: the bar at the foot is 100 mm long. Each piece on its "
                     "outline, name upright."
                   : "Print at 100 %: the bar at the foot is 100 mm long. Each tube in its place.");
  if (mat->n > 1)
    thr_svg_text(s->svg, MARGIN, MARGIN + 14, TEXT, "",
                 "Lay the next page below the grey strip of this one, marks on marks.");
  if (thr_supplies_doubt(&mat->supplies, doubt))
    thr_svg_text(s->svg, MARGIN, MARGIN + 17.5, TEXT, " font-weight=\"bold\"", doubt);
  if (mat->n > 1) put_map(s, mat->tile[i]);
}

static void put_foot(const sheet *s)
{
  const thr_mat *mat = s->mat;
  double y = mat->size[1] - MARGIN - FOOT + 7;
  char line[200];
  thr_text_printf(s->svg, "<path stroke=\"#222\" stroke-width=\"0.4\" d=\"M%.2f %.2fh%.2f", MARGIN,
                  y, BAR);
  for (int k = 0; k <= 10; k++)
    thr_text_printf(s->svg, "M%.2f %.2fv%.2f", MARGIN + k * BAR / 10, y - (k % 10 ? 1 : 2),
                    k % 10 ? 2.0 : 4.0);
  thr_text_append(s->svg, "\"/>\n");
  put_word(s, (const double[]){MARGIN + BAR + 3, y}, TEXT, " font-weight=\"bold\"", "100 mm");
  if (mat->pieces.solid)
    thr_svg_text(
        s->svg, MARGIN, y + 6.5, TEXT, " style=\"fill:#666\"",
        "Ring: a cord goes in here, one for each. Grey name on an arm: the piece that it meets.");
  if (mat->spread > 1.005) {
    snprintf(line, sizeof line,
             "Pieces are as large as they are; their middles lie %.0f %% further apart, so that "
             "flat none lies on another.",
             100 * (mat->spread - 1));
    thr_svg_text(s->svg, MARGIN, y + 10.5, TEXT, " style=\"fill:#666\"", line);
  }
}

thr_status thr_mat_svg(const thr_mat *mat, int i, thr_text *svg, thr_err *err)
{
  sheet s = {.mat = mat, .to = {MARGIN, MARGIN + HEAD}, .svg = svg};
  tile_corner(mat, mat->tile[i], s.corner);
  thr_svg_open(svg, mat->size[0], mat->size[1], "Mat", "The framework flat, true to size.");
  thr_text_append(
      svg, "<style>.thread text{fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}</style>\n");
  thr_text_printf(svg,
                  "<clipPath id=\"window\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  s.to[0], s.to[1], mat->window[0], mat->window[1]);
  thr_text_append(svg, "<g clip-path=\"url(#window)\">\n");
  put_seams(&s, mat->tile[i], false);
  for (int item = 0; item < count_items(mat); item++)
    put_item(&s, item);
  put_seams(&s, mat->tile[i], true);
  thr_text_append(svg, "</g>\n");
  thr_text_printf(svg,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" "
                  "stroke=\"#888\" stroke-width=\"0.25\"/>\n",
                  s.to[0], s.to[1], mat->window[0], mat->window[1]);
  put_head(&s, i);
  put_foot(&s);
  thr_text_append(svg, "</svg>\n");
  return svg->failed ? thr_nomem(err) : THR_OK;
}

thr_status thr_mat_pdf(const thr_mat *mat, const thr_limits *limits, thr_text *pdf, thr_err *err)
{
  thr_pages *pages = NULL;
  thr_status st = thr_pages_open(&pages, "mat", mat->page, "Mat", limits, err);
  for (int i = 0; i < mat->n && !st; i++) {
    thr_text svg = {0};
    if (limits->advance) limits->advance(limits->user, "mat", (double)i / mat->n);
    st = thr_mat_svg(mat, i, &svg, err);
    if (st)
      thr_text_destroy(&svg);
    else
      st = thr_pages_add(pages, -1, &svg, err);
  }
  if (!st) st = thr_pages_close(pages, false, pdf, err);
  thr_pages_destroy(pages);
  return st;
}
