/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces on paper: a card for every kind, and a tag for every piece. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
  CARDS = 4,
  MOST_CARDS = 80,
  MOST_NUMBERS = 6
};                                        /* in a row; in all; arms whose lengths are said */
static const double CARD = 46, AIR = 1.5; /* mm: height of a card; between two of them */
static const double
    ROOM = 12.5,
    NUMBER_OFF = 2; /* mm: from the hub to the ends of its arms; from there to their lengths */
static const double NAME = 4; /* mm: size of the letters on a card and a tag */
static const double TAG = 9;  /* mm: height of a tag */
enum { SOME_TAGS = 4 };       /* rows for which a page is begun */

/* ---- cards ---- */

/* Lengths of the arms, in units, beyond their ends. */
static void put_lengths(thr_sheets *sheets, const thr_scene *scene, int point, const double at[2])
{
  const thr_frame *paper = scene->paper;
  for (int i = paper->first[point];
       i < paper->first[point + 1] && thr_degree(paper, point) <= MOST_NUMBERS; i++) {
    int h = paper->half[i];
    double d[2], off = 0.5 * thr_scene_edge_length(scene, h >> 1) + NUMBER_OFF;
    char number[32];
    thr_scene_direction(scene, h, d);
    snprintf(number, sizeof number, "%.3g", sheets->f->length[h >> 1] / 2);
    off += fabs(d[0]) * 0.3 * THR_SHEET_SMALL * (double)strlen(number);
    thr_svg_text(thr_sheets_out(sheets), at[0] + off * d[0],
                 at[1] + off * d[1] + 0.36 * THR_SHEET_SMALL, THR_SHEET_SMALL,
                 " text-anchor=\"middle\" style=\"fill:#666\"", number);
  }
}

/* Where the pieces of a kind come to: as many as a line takes. */
static void put_members(thr_sheets *sheets, int kind, double x, double y, double width)
{
  thr_text words = {0};
  for (int i = 0; i < sheets->pieces.n; i++)
    if (sheets->pieces.kind[i] == kind)
      thr_text_printf(&words, "%s%s", words.length ? " " : "", sheets->guide.label[i]);
  if (words.failed || !words.data) {
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  } else {
    size_t n = thr_sheets_fit(words.data, width - 4, THR_SHEET_SMALL);
    char line[256];
    snprintf(line, sizeof line, "%.*s%s", (int)(n < 250 ? n : 250), words.data,
             words.data[n] ? " .." : "");
    thr_svg_text(thr_sheets_out(sheets), x + 0.5 * width, y, THR_SHEET_SMALL,
                 " text-anchor=\"middle\"", line);
  }
  thr_text_destroy(&words);
}

static void put_card(thr_sheets *sheets, int kind, double x, double y, double width)
{
  char name[24], count[24];
  const thr_scene *scene;
  int model = sheets->pieces.model[kind], point;
  double at[2] = {x + 0.5 * width, y + 24};
  thr_text *text = thr_sheets_out(sheets);
  thr_text_printf(text,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"1.50\" "
                  "fill=\"none\" stroke=\"#bbb\" "
                  "stroke-width=\"0.25\"/>\n",
                  x, y, width, CARD);
  thr_pieces_kind_name(&sheets->pieces, kind, name);
  snprintf(count, sizeof count, "x %d", sheets->pieces.members[kind]);
  thr_svg_text(text, x + 2, y + 5.5, NAME, " font-weight=\"bold\"", name);
  thr_svg_text(text, x + width - 2, y + 5.5, NAME, " font-weight=\"bold\" text-anchor=\"end\"",
               count);
  thr_status st =
      thr_crop_piece(&sheets->crops, model, at, ROOM, &scene, &point, text, &sheets->why);
  if (st) {
    thr_sheets_fail(sheets, st, NULL);
    return;
  }
  put_lengths(sheets, scene, point, at);
  put_members(sheets, kind, x, y + CARD - 2, width);
}

/* How many pieces hold cords that cross inside them. */
static void put_crossings(thr_sheets *sheets)
{
  thr_channels channels = {0};
  char line[200];
  thr_status st = thr_channels_make(&channels, sheets->plan, &sheets->why);
  if (st) {
    thr_sheets_fail(sheets, st, NULL);
    return;
  }
  if (channels.crossed)
    snprintf(line, sizeof line,
             "%d piece%s cords that cross inside: there one channel lies above the other "
             "(channels.csv says which).",
             channels.crossed, channels.crossed == 1 ? " holds" : "s hold");
  else
    snprintf(line, sizeof line, "No cords cross inside a piece.");
  thr_channels_destroy(&channels);
  thr_sheets_paragraph(sheets, 0, line);
}

/* Below what is on the page, if that takes fewer pages than to begin a new one; else there. */
static void begin_key(thr_sheets *sheets, const char *title)
{
  const double head = 12, row = CARD + AIR, here = thr_sheets_bottom(sheets) - sheets->y - head - 5;
  const double page = thr_sheets_bottom(sheets) - THR_SHEET_MARGIN - head;
  const int rows = (sheets->pieces.n_kinds + CARDS - 1) / CARDS,
            fit = (int)floor((page + AIR) / row);
  const int now = here > 0 ? (int)floor((here + AIR) / row) : 0, left = rows > now ? rows - now : 0;
  if (now > 0 && (left + fit - 1) / fit < (rows + fit - 1) / fit) {
    snprintf(sheets->running, sizeof sheets->running, "%s", title);
    thr_sheets_title(sheets, title);
  } else
    thr_sheets_page(sheets, title, title);
}

void thr_sheets_key(thr_sheets *sheets)
{
  char title[96];
  const thr_pieces *pieces = &sheets->pieces;
  double width = (thr_sheets_width(sheets) - (CARDS - 1) * AIR) / CARDS;
  if (!pieces->solid || sheets->st) return;
  put_crossings(sheets);
  if (!sheets->guide.sides || pieces->n_kinds > MOST_CARDS)
    return; /* a flat picture would not tell them apart */
  snprintf(title, sizeof title, "The %d %s: %d kind%s", pieces->n,
           thr_pieces_word(sheets->plan, pieces->n), pieces->n_kinds,
           pieces->n_kinds == 1 ? "" : "s");
  begin_key(sheets, title);
  if (sheets->st) return;
  snprintf(title, sizeof title,
           "Outer side up, as in the picture. Numbers: arms from the hub to the face, in %.15s.",
           sheets->f->units);
  thr_sheets_paragraph(sheets, 0, title);
  for (int k = 1; k <= pieces->n_kinds && !sheets->st; k++) {
    int column = (k - 1) % CARDS;
    if (column == 0 && k > 1) sheets->y += CARD + AIR;
    if (column == 0) thr_sheets_room(sheets, CARD);
    if (!sheets->st)
      put_card(sheets, k, THR_SHEET_MARGIN + column * (width + AIR), sheets->y, width);
  }
  sheets->y += CARD + 2 * AIR;
}

/* ---- tags ---- */

void thr_sheets_name_tags(thr_sheets *sheets)
{
  static const char words[] = "Cut these out and put each on its piece when it goes on the cord: "
                              "letters up, as in the picture.";
  double longest = 0;
  int n = sheets->pieces.n;
  if (!sheets->pieces.solid || sheets->st) return;
  for (int i = 0; i < n; i++)
    longest = fmax(longest, thr_text_columns(sheets->guide.label[i], SIZE_MAX));
  int columns = (int)fmax(1, floor(thr_sheets_width(sheets) / (0.75 * NAME * longest + 3)));
  columns = columns > 14 ? 14 : columns;
  double width = thr_sheets_width(sheets) / columns;
  if (sheets->y + SOME_TAGS * TAG < thr_sheets_bottom(sheets)) {
    snprintf(sheets->running, sizeof sheets->running, "Names to stick on (continued)");
    thr_sheets_title(sheets, "Names to stick on");
  } else
    thr_sheets_page(sheets, "Names to stick on", "Names to stick on (continued)");
  if (!sheets->st) thr_sheets_paragraph(sheets, 0, words);
  for (int i = 0; i < n && !sheets->st; i++) {
    int column = i % columns;
    double x = THR_SHEET_MARGIN + column * width;
    if (column == 0 && i) sheets->y += TAG;
    if (column == 0) thr_sheets_room(sheets, TAG);
    if (sheets->st) return;
    thr_text_printf(thr_sheets_out(sheets),
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" "
                    "stroke=\"#999\" stroke-width=\"0.15\"/>\n",
                    x, sheets->y, width, TAG);
    thr_svg_text(thr_sheets_out(sheets), x + 0.5 * width, sheets->y + 0.5 * TAG + 0.36 * NAME, NAME,
                 " font-weight=\"bold\" text-anchor=\"middle\"", sheets->guide.label[i]);
  }
}
