/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays pieces out on the mat, divides the mat into pages, and draws each page.
 *
 * The mat is the overview's layout at true size: a mm of the framework is a mm on paper. Edges that
 * the layout foreshortens would put pieces on each other, so that all middles are spread by the
 * most that an edge is foreshortened by; the pieces themselves keep their size. Pages overlap by
 * OVERLAP mm, with register marks, and seams avoid the middles of pieces, where the names are.
 *
 * Steps: find_spread, place_points (from the layout to mm), place_tiles (where pages lie),
 * number_pages (which of them show anything); then thr_mat_svg for a page. */
#include "diagram/mat/mat.h"

#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/tables/tables.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* mm: around a page; above and below what it shows */
static const double MARGIN = 12, HEAD = 19, FOOT = 20;
static const double OVERLAP = 12, AROUND = 2; /* mm: of two pages; around all pieces */
static const double CLEAR = 12; /* mm: between a seam and the middle of a piece, if there is room */
static const double FACES = 0.9;                       /* mm between the faces of two pieces */
static const double TEXT = 2.6, NAME = 3.4, LARGE = 8; /* mm: sizes of letters */
static const double MARK = 3;                          /* mm: half a register mark */
static const double BAR = 100;                         /* mm */
enum { OFFSETS = 60, MARKS = 3 };                      /* tried for the seams; marks along a seam */

/* A mat that is laid out. */
struct thr_mat {
  const thr_plan *plan;
  const thr_frame *frame;
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

/* Returns the largest ratio of an edge's true length to its length in the layout; at least 1,
 * HUGE_VAL if the layout shows an edge as a point. */
static double find_spread(const thr_mat *mat)
{
  double most = 1;
  for (int e = 0; e < mat->frame->n_edges; e++) {
    const double *tail = mat->guide.layout.xy[mat->paper->edge[e][0]],
                 *head = mat->guide.layout.xy[mat->paper->edge[e][1]];
    double drawn = hypot(head[0] - tail[0], head[1] - tail[1]);
    most = fmax(most, drawn > 0 ? mat->frame->length[e] / drawn : HUGE_VAL);
  }
  return most;
}

/* Places the points on the mat, mm from the corner that the outermost pieces touch; extent: size of
 * the mat. */
static void place_points(thr_mat *mat, double extent[2])
{
  const thr_layout *layout = &mat->guide.layout;
  const double around = 0.5 * mat->width + AROUND;

  for (int k = 0; k < 2; k++) {
    double low = HUGE_VAL, high = -HUGE_VAL;

    /* Paper has y downwards. */
    for (int point = 0; point < layout->n_points; point++) {
      mat->at[point][k] = (k ? -1 : 1) * layout->xy[point][k] * mat->spread * mat->mm;
      low = fmin(low, mat->at[point][k]);
      high = fmax(high, mat->at[point][k]);
    }

    /* Move the corner to the origin. */
    extent[k] = high - low + 2 * around;
    for (int point = 0; point < layout->n_points; point++)
      mat->at[point][k] += around - low;
  }
}

/* Returns the distance, mm, between the middle of a seam across axis k and the nearest middle of a
 * piece, with the first tile at an offset. */
static double clearance(const thr_mat *mat, int k, double origin)
{
  double step = mat->window[k] - OVERLAP, least = HUGE_VAL;

  /* Seam t lies in the middle of the overlap of tiles t - 1 and t. */
  for (int t = 1; t < mat->tiles[k]; t++)
    for (int point = 0; point < mat->guide.layout.n_points; point++)
      least = fmin(least, fabs(mat->at[point][k] - (origin + t * step + 0.5 * OVERLAP)));
  return least;
}

/* Chooses how many tiles there are each way, and where the first one begins: the mat is in the
 * middle of its pages, but moved as little as it takes for names to stay whole. */
static void place_tiles(thr_mat *mat, const double extent[2])
{
  for (int k = 0; k < 2; k++) {
    double step = mat->window[k] - OVERLAP, best = -1;

    /* As many tiles as cover the extent; what they have more lets the seams move. */
    mat->tiles[k] = (int)fmax(1, ceil((extent[k] - OVERLAP) / step - 1e-9));
    double room = mat->tiles[k] * step + OVERLAP - extent[k];
    mat->origin[k] = -0.5 * room;

    /* Try offsets from the middle to both sides in turn. */
    for (int i = 0; i <= OFFSETS && mat->tiles[k] > 1; i++) {
      double part = (i % 2 ? 0.5 : -0.5) * ((i + 1) / 2) / (OFFSETS / 2),
             origin = -room * (0.5 + part);

      /* More than CLEAR is no better. */
      double now = fmin(clearance(mat, k, origin), CLEAR);
      if (now <= best + 1e-9) continue;

      best = now;
      mat->origin[k] = origin;
    }
  }
}

/* Computes the corner of a tile on the mat, mm. */
static void tile_corner(const thr_mat *mat, int tile, double at[2])
{
  const int place[2] = {tile % mat->tiles[0], tile / mat->tiles[0]};
  for (int k = 0; k < 2; k++)
    at[k] = mat->origin[k] + place[k] * (mat->window[k] - OVERLAP);
}

/* Finds hub and arms of the piece that a point, or with tube joints an edge, shows, in mm. */
static void find_arms(const thr_mat *mat, int item, thr_arms *arms)
{
  *arms = (thr_arms){.width = mat->width, .fill = "#fdf6e3", .outline = "#222", .line = 0.4};

  /* A tube: two arms from its middle, without the room that the tubes beside it take at the
   * nodes. */
  if (!mat->pieces.solid) {
    const double *tail = mat->at[mat->paper->edge[item][0]],
                 *head = mat->at[mat->paper->edge[item][1]];
    double drawn = hypot(head[0] - tail[0], head[1] - tail[1]),
           half = 0.5 * fmax(mat->frame->length[item] * mat->mm - mat->width, 0);

    arms->n = 2;
    for (int k = 0; k < 2; k++) {
      arms->hub[k] = 0.5 * (tail[k] + head[k]);
      arms->end[0][k] = arms->hub[k] + (drawn > 0 ? half * (tail[k] - head[k]) / drawn : 0);
      arms->end[1][k] = arms->hub[k] + (drawn > 0 ? half * (head[k] - tail[k]) / drawn : 0);
    }
    return;
  }

  /* A solid piece: arms of half the true length of the edges, in the directions of the layout. */
  for (int k = 0; k < 2; k++)
    arms->hub[k] = mat->at[item][k];

  for (int i = mat->paper->first[item]; i < mat->paper->first[item + 1] && arms->n < THR_ARMS;
       i++) {
    int h = mat->paper->half[i];
    const double *head = mat->at[thr_head(mat->paper, h)];
    double drawn = hypot(head[0] - arms->hub[0], head[1] - arms->hub[1]);

    double length =
        0.5 * fmax(mat->frame->length[h >> 1] * mat->mm - fmin(FACES, 0.1 * mat->width), 0);
    for (int k = 0; k < 2; k++)
      arms->end[arms->n][k] =
          arms->hub[k] + (drawn > 0 ? length * (head[k] - arms->hub[k]) / drawn : 0);
    arms->n++;
  }
}

/* Returns how many pieces are drawn: a node with two points is drawn twice. */
static int count_items(const thr_mat *mat)
{
  return mat->pieces.solid ? mat->guide.layout.n_points : mat->frame->n_edges;
}

/* Returns whether a piece reaches into a box, low to high, as it is drawn (thr_arms_draw): whether
 * the round corner at its hub does, or one of its arms, a rectangle from the hub to its end. Two
 * rectangles are apart if they are so along a side of one of them. */
static bool reaches(const thr_mat *mat, const thr_arms *arms, const double low[2],
                    const double high[2])
{
  const double half = 0.5 * mat->width, beyond = arms->n == 1 ? half : 0,
               middle[2] = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])};

  /* The nearest point of the box to the hub. */
  if (hypot(arms->hub[0] - fmin(fmax(arms->hub[0], low[0]), high[0]),
            arms->hub[1] - fmin(fmax(arms->hub[1], low[1]), high[1])) < half)
    return true;

  for (int i = 0; i < arms->n; i++) {
    double along[2] = {arms->end[i][0] - arms->hub[0], arms->end[i][1] - arms->hub[1]},
           length = hypot(along[0], along[1]);
    if (!(length > 0)) continue;
    for (int k = 0; k < 2; k++)
      along[k] /= length;

    /* Half the arm, which goes on beyond the hub if it is the only one, seen along both sides of
     * the box, and half the box seen along both sides of the arm. */
    const double reach = 0.5 * (length + beyond),
                 way[2] = {arms->hub[0] + (reach - beyond) * along[0] - middle[0],
                           arms->hub[1] + (reach - beyond) * along[1] - middle[1]};
    bool apart = false;
    for (int k = 0; k < 2; k++)
      apart |= fabs(way[k]) >
               reach * fabs(along[k]) + half * fabs(along[1 - k]) + 0.5 * (high[k] - low[k]);
    for (int k = 0; k < 2; k++) {
      const double axis[2] = {k ? -along[1] : along[0], k ? along[0] : along[1]};
      apart |= fabs(way[0] * axis[0] + way[1] * axis[1]) >
               (k ? half : reach) +
                   0.5 * ((high[0] - low[0]) * fabs(axis[0]) + (high[1] - low[1]) * fabs(axis[1]));
    }
    if (!apart) return true;
  }
  return false;
}

/* Computes what of the mat is a tile's own: up to the middles of the strips that its neighbours
 * show, too; or what the tile alone shows, without these strips. */
static void tile_box(const thr_mat *mat, int tile, bool alone, double low[2], double high[2])
{
  const double strip = alone ? OVERLAP : 0.5 * OVERLAP;
  const int place[2] = {tile % mat->tiles[0], tile / mat->tiles[0]};
  tile_corner(mat, tile, low);
  for (int k = 0; k < 2; k++) {
    high[k] = low[k] + mat->window[k] - (place[k] + 1 < mat->tiles[k] ? strip : 0);
    low[k] += place[k] ? strip : 0;
  }
}

/* Numbers the tiles that a piece reaches into, row by row. THR_EINPUT: too many pages. */
static thr_status number_pages(thr_mat *mat, thr_err *err)
{
  if ((double)mat->tiles[0] * mat->tiles[1] > 25.0 * THR_MAT_PAGES)
    return thr_fail(err, THR_EINPUT, "a mat of true size would be %d pages wide and %d high",
                    mat->tiles[0], mat->tiles[1]);

  int n_tiles = mat->tiles[0] * mat->tiles[1];
  mat->tile = thr_calloc((size_t)n_tiles, sizeof *mat->tile);
  mat->number = thr_calloc((size_t)n_tiles, sizeof *mat->number);
  if (!mat->tile || !mat->number) return thr_nomem(err);

  /* A tile is a page if it alone shows a part of a piece, or has the middle of one. */
  for (int tile = 0; tile < n_tiles; tile++) {
    double low[2], high[2], own_low[2], own_high[2];
    bool used = false;
    tile_box(mat, tile, true, low, high);
    tile_box(mat, tile, false, own_low, own_high);

    for (int i = 0; i < count_items(mat) && !used; i++) {
      thr_arms arms;
      find_arms(mat, i, &arms);
      used = reaches(mat, &arms, low, high) ||
             (arms.hub[0] >= own_low[0] && arms.hub[0] <= own_high[0] &&
              arms.hub[1] >= own_low[1] && arms.hub[1] <= own_high[1]);
    }

    /* Pages are numbered from 1. */
    if (!used) continue;
    mat->tile[mat->n++] = tile;
    mat->number[tile] = mat->n;
  }

  if (mat->n <= THR_MAT_PAGES) return THR_OK;
  return thr_fail(err, THR_EINPUT, "a mat of true size would take %d pages; %d are the most",
                  mat->n, THR_MAT_PAGES);
}

/* Prepares everything: unit, sizes of pieces, layout, names, then points and pages. */
static thr_status prepare(thr_mat *mat, double tolerance, thr_err *err)
{
  thr_physics physics;
  double extent[2];

  /* True size needs a unit of known length. */
  if (thr_units_in_mm(mat->frame->units, &mat->mm, NULL))
    return thr_fail(
        err, THR_EINPUT,
        "a mat is of true size, and nobody knows the framework's unit: plan it with --units");

  /* What the plan says of its pieces, and how they are called. */
  thr_status st = thr_physics_resolve(&mat->plan->options.physics, mat->frame, &physics, err);
  if (!st) st = thr_supplies_make(&mat->supplies, mat->plan, err);
  if (!st) st = thr_supplies_find_sizes(&mat->supplies, err);
  if (!st) st = thr_guide_make(&mat->guide, mat->frame, NULL, err);
  if (!st) st = thr_pieces_make(&mat->pieces, mat->plan, tolerance, err);
  if (st) return st;

  /* Sizes and layout. */
  mat->paper = thr_layout_paper(&mat->guide.layout, mat->frame);
  mat->width = physics.bead_diameter;
  mat->spread = find_spread(mat);
  if (!isfinite(mat->spread))
    return thr_fail(err, THR_EINPUT, "no flat picture shows all edges: there is no mat of it");

  if (!(mat->at = thr_calloc((size_t)mat->guide.layout.n_points, sizeof *mat->at)))
    return thr_nomem(err);

  /* The window is what a page shows of the mat. */
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
  mat->frame = &plan->frame;
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

/* A page being drawn: corner of the mat's part on the page, and where this goes on paper. */
typedef struct {
  const thr_mat *mat;
  double corner[2], to[2];
  thr_text *svg;
} mat_page;

/* Computes the place on paper of a place on the mat. */
static void on_paper(const mat_page *page, const double at[2], double xy[2])
{
  for (int k = 0; k < 2; k++)
    xy[k] = at[k] - page->corner[k] + page->to[k];
}

/* Appends words whose middle line is at a place. */
static void put_word(const mat_page *page, const double at[2], double size, const char *attributes,
                     const char *words)
{
  thr_svg_text(page->svg, at[0], at[1] + 0.36 * size, size, attributes, words);
}

/* Draws at the end of an arm a ring for every cord that goes in there, side by side, and further in
 * the name of the piece that the arm faces. */
static void put_arm(const mat_page *page, const double hub[2], const double end[2], int cords,
                    const char *faces)
{
  double direction[2] = {end[0] - hub[0], end[1] - hub[1]},
         length = hypot(direction[0], direction[1]);
  if (!(length > 0)) return;

  /* As many rings as the arm's width takes, at least one. */
  double most = fmax(1, floor(0.8 * page->mat->width / 1.3)),
         ring = fmin(0.5, 0.07 * page->mat->width);
  for (int k = 0; k < 2; k++)
    direction[k] /= length;

  /* Rings side by side, across the arm. */
  for (int i = 0; i < cords && i < most; i++) {
    double off = (i - 0.5 * (fmin(cords, most) - 1)) * 2.6 * ring, back = length - 1 - ring;
    thr_text_printf(page->svg,
                    "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"none\" stroke=\"#222\" "
                    "stroke-width=\"0.25\"/>\n",
                    thr_svg_round(hub[0] + back * direction[0] - off * direction[1]),
                    thr_svg_round(hub[1] + back * direction[1] + off * direction[0]), ring);
  }

  /* The name lies level: its extent along the arm depends on the arm's direction. */
  double wide = fabs(direction[0]) * 0.33 * TEXT * thr_text_columns(faces, SIZE_MAX) +
                fabs(direction[1]) * 0.5 * TEXT;
  double at = length - 1.6 - 2 * ring - wide;
  if (at - wide < NAME + 0.6) return;

  put_word(page, (const double[]){hub[0] + at * direction[0], hub[1] + at * direction[1]}, TEXT,
           " text-anchor=\"middle\" style=\"fill:#666\"", faces);
}

/* Writes name and kind of a piece on its hub, in lines; a name with a hyphen that is too wide for
 * an upright tube takes two. */
static void put_name(const mat_page *page, const thr_arms *arms, const char *name, const char *kind)
{
  const thr_mat *mat = page->mat;

  /* The name of a tube, "A1-A2", may be parted behind its hyphen. */
  const char *hyphen = strchr(name, '-');
  bool upright = !mat->pieces.solid &&
                 fabs(arms->end[0][1] - arms->hub[1]) > fabs(arms->end[0][0] - arms->hub[0]);

  double most = fmax(NAME, fmin(LARGE, 0.3 * mat->width));
  bool parted = upright && hyphen && 0.7 * TEXT * thr_text_columns(name, SIZE_MAX) > mat->width;
  size_t first = parted ? (size_t)(hyphen - name) + 1 : strlen(name);

  /* As large as the width allows, between TEXT and LARGE. */
  double size = fmax(TEXT, fmin(most, 1.5 * mat->width / (1 + thr_text_columns(name, first)))),
         line = 1.15 * size;

  int lines = 1 + parted;
  bool room = parted || mat->width > size + TEXT;

  /* All lines together are centred on the hub. */
  double y = arms->hub[1] - 0.5 * ((lines - 1) * line + (room ? 0.5 * size + 0.7 * TEXT : 0));

  for (int i = 0; i < lines; i++, y += line) {
    char words[2 * THR_LABEL + 8];
    snprintf(words, sizeof words, "%.*s", (int)(i ? strlen(name + first) : first),
             i ? name + first : name);
    put_word(page, (const double[]){arms->hub[0], y}, size,
             " text-anchor=\"middle\" font-weight=\"bold\"", words);
  }

  /* The kind comes below, if the piece is wide enough. */
  y += 0.5 * size + 0.7 * TEXT - line;
  if (room)
    put_word(page, (const double[]){arms->hub[0], y}, TEXT,
             " text-anchor=\"middle\" style=\"fill:#666\"", kind);
}

/* Draws a piece that reaches into the page: outline, arms, name. */
static void put_item(const mat_page *page, int item)
{
  const thr_mat *mat = page->mat;
  const thr_frame *paper = mat->paper;
  thr_arms arms;
  thr_text name = {0};
  char kind[24];

  find_arms(mat, item, &arms);
  const double end[2] = {page->corner[0] + mat->window[0], page->corner[1] + mat->window[1]};
  if (!reaches(mat, &arms, page->corner, end)) return;

  /* From the mat to paper. */
  on_paper(page, arms.hub, arms.hub);
  for (int i = 0; i < arms.n; i++)
    on_paper(page, arms.end[i], arms.end[i]);

  /* A point shows a node, which is the piece. */
  int piece = mat->pieces.solid ? thr_layout_node(&mat->guide.layout, item) : item;
  thr_arms_draw(&arms, page->svg);

  /* Arms with rings and names, which tubes have not. */
  for (int i = 0; i < arms.n && mat->pieces.solid; i++) {
    int h = paper->half[paper->first[item] + i];
    put_arm(page, arms.hub, arms.end[i], mat->supplies.passes[h >> 1],
            mat->guide.label[thr_layout_node(&mat->guide.layout, thr_head(paper, h))]);
  }

  /* Name and kind. */
  thr_pieces_name(&mat->pieces, (const char(*)[THR_LABEL])mat->guide.label, piece, &name);
  thr_pieces_kind_name(&mat->pieces, mat->pieces.kind[piece], kind);
  if (name.data && !name.failed) put_name(page, &arms, name.data, kind);
  if (name.failed) page->svg->failed = true;

  thr_text_destroy(&name);
}

/* Returns the distance between a point and the nearest outline, mm; negative inside. */
static double distance_to_pieces(const thr_mat *mat, const double at[2])
{
  double least = HUGE_VAL;
  for (int item = 0; item < count_items(mat); item++) {
    thr_arms arms;
    find_arms(mat, item, &arms);

    /* The distance to the middle line of each arm, less half its width. */
    for (int i = 0; i < arms.n; i++) {
      double direction[2] = {arms.end[i][0] - arms.hub[0], arms.end[i][1] - arms.hub[1]},
             square = direction[0] * direction[0] + direction[1] * direction[1];
      double part =
          square > 0
              ? ((at[0] - arms.hub[0]) * direction[0] + (at[1] - arms.hub[1]) * direction[1]) /
                    square
              : 0;

      /* The nearest point of the middle line. */
      part = fmin(fmax(part, 0), 1);
      least = fmin(least, hypot(at[0] - arms.hub[0] - part * direction[0],
                                at[1] - arms.hub[1] - part * direction[1]) -
                              0.5 * mat->width);
    }
  }
  return least;
}

/* Draws a register mark: a ring with a cross. */
static void put_mark(const mat_page *page, const double at[2])
{
  double xy[2];
  on_paper(page, at, xy);
  thr_text_printf(
      page->svg,
      "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"#fff\" stroke=\"#222\" "
      "stroke-width=\"0.3\"/>\n"
      "<path stroke=\"#222\" stroke-width=\"0.3\" d=\"M%.2f %.2fh%.2fM%.2f %.2fv%.2f\"/>\n",
      xy[0], xy[1], 0.6 * MARK, xy[0] - MARK, xy[1], 2 * MARK, xy[0], xy[1] - MARK, 2 * MARK);
}

/* Draws marks along the seam that begins at a corner of two tiles and is parallel to axis k. Each
 * is moved until no outline is below it, or to the place where outlines are furthest. Both pages
 * draw the same marks. */
static void put_marks(const mat_page *page, const double corner[2], int k)
{
  const thr_mat *mat = page->mat;
  for (int i = 0; i < MARKS; i++) {
    double at[2], best[2] = {corner[0], corner[1]}, most = -HUGE_VAL;

    /* From the usual place to both sides in turn. */
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

    put_mark(page, best);
  }
}

/* Draws the strips that overlap the neighbours: their marks, or grey areas where this page lies on
 * top, to the right and below. */
static void put_seams(const mat_page *page, int tile, bool marks)
{
  const thr_mat *mat = page->mat;
  int column = tile % mat->tiles[0], row = tile / mat->tiles[0];

  /* Left and right, above and below; a page without pieces is no neighbour. */
  for (int k = 0; k < 2; k++)
    for (int side = 0; side < 2; side++) {
      int place = k ? row : column, other = tile + (side ? 1 : -1) * (k ? mat->tiles[0] : 1);
      if (side ? place + 1 >= mat->tiles[k] : place == 0) continue;
      if (!mat->number[other]) continue;

      /* The corner of the strip on the mat, then on paper. */
      double corner[2] = {page->corner[0], page->corner[1]}, xy[2];
      if (side) corner[k] += mat->window[k] - OVERLAP;
      on_paper(page, corner, xy);

      if (marks)
        put_marks(page, corner, 1 - k);
      else if (side)
        thr_text_printf(
            page->svg,
            "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#eee\"/>\n", xy[0],
            xy[1], k ? mat->window[0] : OVERLAP, k ? OVERLAP : mat->window[1]);
    }
}

/* Draws a small map of all pages with this one black. */
static void put_map(const mat_page *page, int tile)
{
  const thr_mat *mat = page->mat;

  /* Cells as large as the head and 60 mm of width allow. */
  double cell = fmin(7, fmin(60.0 / mat->tiles[0], (HEAD - 4) / mat->tiles[1])),
         right = mat->size[0] - MARGIN;

  for (int other = 0; other < mat->tiles[0] * mat->tiles[1]; other++) {
    double x = right - (mat->tiles[0] - other % mat->tiles[0]) * cell,
           y = MARGIN + other / mat->tiles[0] * cell;
    char number[16];
    thr_text_printf(page->svg,
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\" "
                    "stroke=\"#222\" stroke-width=\"0.3\"/>\n",
                    x, y, cell, cell, other == tile ? "#222" : "#fff");

    /* Numbers where the cells are large enough. */
    snprintf(number, sizeof number, "%d", mat->number[other]);
    if (mat->number[other] && cell >= 5)
      put_word(page, (const double[]){x + 0.5 * cell, y + 0.5 * cell}, TEXT,
               other == tile ? " text-anchor=\"middle\" style=\"fill:#fff\""
                             : " text-anchor=\"middle\"",
               number);
  }
}

/* Writes the head of page i: number, what to do, what is in doubt. */
static void put_head(const mat_page *page, int i)
{
  const thr_mat *mat = page->mat;
  char line[200], doubt[160];

  snprintf(line, sizeof line, "Mat, page %d of %d", i + 1, mat->n);
  thr_svg_text(page->svg, MARGIN, MARGIN + 5, 5, " font-weight=\"bold\"", line);

  /* What to do with the page. */
  thr_svg_text(page->svg, MARGIN, MARGIN + 10, TEXT, "",
               mat->pieces.solid
                   ? "Print at 100 %: the bar at the foot is 100 mm long. Each piece on its "
                     "outline, name upright."
                   : "Print at 100 %: the bar at the foot is 100 mm long. Each tube in its place.");

  /* Several pages must be joined. */
  if (mat->n > 1)
    thr_svg_text(page->svg, MARGIN, MARGIN + 14, TEXT, "",
                 "Lay the next page below the grey strip of this one, marks on marks.");

  if (thr_supplies_doubt(&mat->supplies, doubt))
    thr_svg_text(page->svg, MARGIN, MARGIN + 17.5, TEXT, " font-weight=\"bold\"", doubt);
  if (mat->n > 1) put_map(page, mat->tile[i]);
}

/* Draws the foot of a page: a bar of 100 mm, and what signs mean. */
static void put_foot(const mat_page *page)
{
  const thr_mat *mat = page->mat;
  double y = mat->size[1] - MARGIN - FOOT + 7;
  char line[200];

  /* The bar with a tick for each cm. */
  thr_text_printf(page->svg, "<path stroke=\"#222\" stroke-width=\"0.4\" d=\"M%.2f %.2fh%.2f",
                  MARGIN, y, BAR);
  for (int k = 0; k <= 10; k++)
    thr_text_printf(page->svg, "M%.2f %.2fv%.2f", MARGIN + k * BAR / 10, y - (k % 10 ? 1 : 2),
                    k % 10 ? 2.0 : 4.0);
  thr_text_append(page->svg, "\"/>\n");

  put_word(page, (const double[]){MARGIN + BAR + 3, y}, TEXT, " font-weight=\"bold\"", "100 mm");
  if (mat->pieces.solid)
    thr_svg_text(
        page->svg, MARGIN, y + 6.5, TEXT, " style=\"fill:#666\"",
        "Ring: a cord goes in here, one for each. Grey name on an arm: the piece that it meets.");

  /* How much further apart than in the framework the middles are. */
  if (mat->spread > 1.005) {
    snprintf(line, sizeof line,
             "Pieces are as large as they are; their middles lie %.0f %% further apart, so that "
             "flat none lies on another.",
             100 * (mat->spread - 1));
    thr_svg_text(page->svg, MARGIN, y + 10.5, TEXT, " style=\"fill:#666\"", line);
    thr_svg_text(page->svg, MARGIN, y + 14.5, TEXT, " style=\"fill:#666\"",
                 "Where a cord gets short, slide together what is on it.");
  }
}

thr_status thr_mat_svg(const thr_mat *mat, int i, thr_text *svg, thr_err *err)
{
  mat_page page = {.mat = mat, .to = {MARGIN, MARGIN + HEAD}, .svg = svg};

  tile_corner(mat, mat->tile[i], page.corner);
  thr_svg_open(svg, mat->size[0], mat->size[1], "Mat", "The framework flat, true to size.");
  thr_text_append(
      svg, "<style>.thread text{fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}</style>\n");

  /* The window clips what belongs to the neighbours. */
  thr_text_printf(svg,
                  "<clipPath id=\"window\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  page.to[0], page.to[1], mat->window[0], mat->window[1]);
  thr_text_append(svg, "<g clip-path=\"url(#window)\">\n");

  /* Grey strips below the pieces, marks above. */
  put_seams(&page, mat->tile[i], false);
  for (int item = 0; item < count_items(mat); item++)
    put_item(&page, item);
  put_seams(&page, mat->tile[i], true);
  thr_text_append(svg, "</g>\n");

  /* A frame, head and foot. */
  thr_text_printf(svg,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" "
                  "stroke=\"#888\" stroke-width=\"0.25\"/>\n",
                  page.to[0], page.to[1], mat->window[0], mat->window[1]);
  put_head(&page, i);
  put_foot(&page);

  thr_text_append(svg, "</svg>\n");
  return svg->failed ? thr_nomem(err) : THR_OK;
}

thr_status thr_mat_pdf(const thr_mat *mat, const thr_limits *limits, thr_text *pdf, thr_err *err)
{
  thr_pages *pages = NULL;
  thr_status st = thr_pages_open(&pages, "mat", mat->page, "Mat", limits, err);

  /* A page at a time: only one is in memory before it goes to the PDF. */
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

/* Draws page i of a mat. */
static thr_status draw_page(const void *mat, int i, thr_text *svg, thr_err *err)
{
  return thr_mat_svg(mat, i, svg, err);
}

thr_status thr_mat_html(const thr_mat *mat, thr_text *html, thr_err *err)
{
  const thr_drawn_pages pages = {"Mat", mat->size, mat->n, draw_page, mat};
  return thr_pages_html(&pages, html, err);
}
