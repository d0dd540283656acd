/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out pieces on paper: a card for every kind of solid piece, with its outline and the lengths
 * of its arms, and a tag with the name of every piece, to cut out and stick on.
 *
 * A card shows the first piece of the kind as the layout draws that piece, that side up, or as it
 * is told best where steps are drawn in space, at the largest scale at which its arms stay within
 * ROOM mm. At most MOST_CARDS kinds have one, and none those that rows call by their places.
 *
 * Example: 25 kinds in rows of four make seven rows of 46 mm: two pages. */
#include "diagram/sheets/sheets_parts.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
  CARDS = 4,       /* in a row */
  MOST_CARDS = 80, /* in all: more kinds have no cards */
  MOST_NUMBERS = 6 /* a piece of more arms has no lengths written at them */
};
static const double CARD = 46;      /* mm: height of a card */
static const double AIR = 1.5;      /* mm between two cards */
static const double ROOM = 12.5;    /* mm from the hub to the end of the longest arm, at most */
static const double NUMBER_OFF = 2; /* mm from the end of an arm to its length in figures */
static const double NAME = 4;       /* mm: size of the letters on a card and a tag */
static const double TAG = 9;        /* mm: height of a tag */
enum { SOME_TAGS = 4 };             /* rows of tags that must fit below what is on a page */

/* ---- cards ---- */

/* Writes the length of each arm of a piece, in units, beyond the end of the arm. point: the piece
 * in the scene; at: its hub on the page, mm. */
static void put_lengths(thr_flow *flow, const thr_known *known, const thr_scene *scene, int point,
                        const double at[2])
{
  const thr_frame *paper = scene->paper;
  for (int i = paper->first[point];
       i < paper->first[point + 1] && thr_degree(paper, point) <= MOST_NUMBERS; i++) {
    /* An arm is half an edge. */
    int h = paper->half[i];
    double outwards[2], off = 0.5 * thr_scene_edge_length(scene, h >> 1) + NUMBER_OFF;
    char number[32];

    thr_scene_direction(scene, h, outwards);
    snprintf(number, sizeof number, "%.3g", known->f->length[h >> 1] / 2);

    /* A figure is wider than high: beside a flat arm it needs more distance. */
    off += fabs(outwards[0]) * 0.3 * THR_SHEET_SMALL * (double)strlen(number);
    thr_svg_text(thr_sheets_out(flow), at[0] + off * outwards[0],
                 at[1] + off * outwards[1] + 0.36 * THR_SHEET_SMALL, THR_SHEET_SMALL,
                 " text-anchor=\"middle\" style=\"fill:#666\"", number);
  }
}

/* Writes the places of all pieces of a kind in a line, centred in a card, with ".." where some do
 * not fit. */
static void put_members(thr_flow *flow, const thr_known *known, int kind, double x, double y,
                        double width)
{
  thr_text words = {0};

  /* All names of the kind, in the order of pieces. */
  for (int i = 0; i < known->pieces.n; i++)
    if (known->pieces.kind[i] == kind)
      thr_text_printf(&words, "%s%s", words.length ? " " : "", known->guide.label[i]);

  /* As many whole names as the width takes. */
  if (words.failed) thr_nomem(&flow->why);
  if (words.data && !words.failed) {
    size_t n = thr_sheets_fit(words.data, width - 4, THR_SHEET_SMALL);
    char line[256];
    snprintf(line, sizeof line, "%.*s%s", (int)(n < 250 ? n : 250), words.data,
             words.data[n] ? " .." : "");
    thr_svg_text(thr_sheets_out(flow), x + 0.5 * width, y, THR_SHEET_SMALL,
                 " text-anchor=\"middle\"", line);
  }
  thr_text_destroy(&words);
}

/* Draws the card of a kind with its upper left corner at (x, y): name and number of pieces above,
 * outline and lengths in the middle, places below. */
static void put_card(thr_sheets *sheets, int kind, double x, double y, double width)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  char name[24], count[24];
  const thr_scene *scene = NULL;
  int model = known->pieces.model[kind], point = 0;
  double at[2] = {x + 0.5 * width, y + 24};
  thr_text *text = thr_sheets_out(flow);

  /* The frame, then name and number. */
  thr_sheets_frame(text, x, y, width, CARD,
                   "rx=\"1.50\" fill=\"none\" stroke=\"#bbb\" stroke-width=\"0.25\"");
  thr_pieces_kind_name(&known->pieces, kind, name);
  snprintf(count, sizeof count, "x %d", known->pieces.members[kind]);
  thr_svg_text(text, x + 2, y + 5.5, NAME, " font-weight=\"bold\"", name);
  thr_svg_text(text, x + width - 2, y + 5.5, NAME, " font-weight=\"bold\" text-anchor=\"end\"",
               count);

  /* The piece at a scale of its own: cards show shapes, not relative sizes. */
  thr_status st =
      known->in_space
          ? thr_space_piece(&sheets->space, model, at, ROOM, text, &flow->why)
          : thr_crop_piece(&sheets->crops, model, at, ROOM, &scene, &point, text, &flow->why);
  thr_sheets_fail(flow, st);

  /* Around the picture, and below it. */
  if (!st && !known->in_space) put_lengths(flow, known, scene, point, at);
  put_members(flow, known, kind, x, y + CARD - 2, width);
}

/* Writes in how many pieces cords cross: such pieces need channels one above the other. */
static void put_crossings(thr_flow *flow, const thr_known *known)
{
  thr_channels channels = {0};

  /* The channels are only counted here. Where some cross, a maker needs the table. */
  thr_status st = thr_channels_make(&channels, known->plan, &flow->why);
  const int n = channels.crossed;
  thr_sheets_fail(flow, st);
  thr_channels_destroy(&channels);
  if (!st && n)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "%d piece%s cords that cross inside: there one channel lies above the other "
                   "(the table of channels says which).",
                   n, n == 1 ? " holds" : "s hold");
  else if (!st)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH, "No cords cross inside a piece.");
}

/* Begins a part below what is on the page if that is wanted, else on a page of its own. */
static void begin(thr_flow *flow, bool here, const char *title, const char *running)
{
  if (!here) {
    thr_sheets_page(flow, title, running);
    return;
  }
  snprintf(flow->running, sizeof flow->running, "%s", running);
  thr_sheets_put(flow, THR_BLOCK_TITLE, "%s", title);
}

/* Begins cell i, from 0, of a grid that goes on row by row over as many pages as needed, with air
 * mm between two cells. Returns its x; its y is that of the page. */
static double begin_cell(thr_flow *flow, int i, int columns, double width, double height,
                         double air)
{
  const int column = i % columns;

  if (column == 0 && i) flow->y += height + air;
  if (column == 0) thr_sheets_room(flow, height);
  return THR_SHEET_MARGIN + column * (width + air);
}

/* Returns whether n_kinds cards take fewer further pages below what is on the page than on a page
 * of their own. */
static bool is_shorter_here(const thr_flow *flow, int n_kinds)
{
  const double head = 12, row = CARD + AIR, here = thr_sheets_bottom(flow) - flow->y - head - 5,
               page = thr_sheets_bottom(flow) - THR_SHEET_MARGIN - head;

  /* Rows of cards in all, and as many as a whole page takes. */
  const int rows = (n_kinds + CARDS - 1) / CARDS, fit = (int)floor((page + AIR) / row);

  /* Rows below what is there; (left + fit - 1) / fit pages take the others. */
  const int rows_here = here > 0 ? (int)floor((here + AIR) / row) : 0,
            left = rows > rows_here ? rows - rows_here : 0;

  return rows_here > 0 && (left + fit - 1) / fit < (rows + fit - 1) / fit;
}

void thr_sheets_key(thr_sheets *sheets)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  char title[96], rest[96] = "";
  const thr_pieces *pieces = &known->pieces;
  int cards = 0;
  double width = (thr_sheets_width(flow) - (CARDS - 1) * AIR) / CARDS;

  if (!pieces->solid || flow->why.code) return;
  put_crossings(flow, known);

  /* Kinds that rows call by their places have no cards, nor have those beyond a number. */
  for (int k = 1; k <= pieces->n_kinds; k++)
    cards += !thr_pieces_alone(pieces, k);
  if (!cards) return;
  if (cards > MOST_CARDS)
    snprintf(rest, sizeof rest, " %d kinds are drawn, the other %d are in the table of beads.",
             MOST_CARDS, pieces->n_kinds - MOST_CARDS);
  else if (cards < pieces->n_kinds)
    snprintf(rest, sizeof rest,
             " Kinds of one piece, which rows call by its place: the table of beads.");
  if (cards > MOST_CARDS) cards = MOST_CARDS;
  snprintf(title, sizeof title, "The %d %s: %d kind%s", pieces->n,
           thr_pieces_word(known->plan, pieces->n), pieces->n_kinds,
           pieces->n_kinds == 1 ? "" : "s");

  begin(flow, is_shorter_here(flow, cards), title, title);
  if (flow->why.code) return;

  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                 "%s Numbers: arms from the hub to the face, in %.15s.%s",
                 known->in_space ? "Each turned so that its arms are told best."
                                 : "Outer side up, as in the picture.",
                 known->f->units, rest);

  /* Kinds count from 1. */
  for (int k = 1, card = 0; k <= pieces->n_kinds && card < cards && !flow->why.code; k++) {
    if (thr_pieces_alone(pieces, k)) continue;
    double x = begin_cell(flow, card++, CARDS, width, CARD, AIR);
    if (!flow->why.code) put_card(sheets, k, x, flow->y, width);
  }

  flow->y += CARD + 2 * AIR;
}

/* ---- tags ---- */

int thr_sheets_name_tags(thr_flow *flow, const thr_known *known)
{
  double longest = 0;
  int n = known->pieces.n;

  /* A tube has no side to stick a name on. */
  if (!known->pieces.solid || flow->why.code) return -1;

  /* The longest name decides how many tags stand in a row, 14 at most. */
  for (int i = 0; i < n; i++)
    longest = fmax(longest, thr_text_columns(known->guide.label[i], SIZE_MAX));
  int columns = (int)fmax(1, floor(thr_sheets_width(flow) / (0.75 * NAME * longest + 3)));
  columns = columns > 14 ? 14 : columns;

  double width = thr_sheets_width(flow) / columns;

  /* A few rows below what is on the page, or a page of their own. */
  begin(flow, flow->y + SOME_TAGS * TAG < thr_sheets_bottom(flow), "Names to stick on",
        "Names to stick on (continued)");
  const int before = flow->n_pages - 1;
  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                 "Cut these out and put each on its piece when it goes on the cord: letters up, as "
                 "in the picture.");
  for (int i = 0; i < n && !flow->why.code; i++) {
    double x = begin_cell(flow, i, columns, width, TAG, 0);
    if (flow->why.code) return before;

    thr_sheets_frame(thr_sheets_out(flow), x, flow->y, width, TAG,
                     "fill=\"none\" stroke=\"#999\" stroke-width=\"0.15\"");
    thr_svg_text(thr_sheets_out(flow), x + 0.5 * width, flow->y + 0.5 * TAG + 0.36 * NAME, NAME,
                 " font-weight=\"bold\" text-anchor=\"middle\"", known->guide.label[i]);
  }
  return before;
}
