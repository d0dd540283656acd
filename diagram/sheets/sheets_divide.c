/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Divides the visits of a path into steps, by a dynamic programme over the ends of steps.
 *
 * A step must fit on a page, with every pass legible in its picture. Among all divisions into such
 * steps the cheapest one is taken: few steps, which end where the cord turns and at a piece that is
 * on a cord already, since a maker who puts the work down finds such a place again. Let cost(e) be
 * the least cost of dividing the visits before e; then
 *
 *   cost(e) = min over i of cost(i) + STEP + price_of_end(e - 1) + SHORT * max(FEW - (e - i), 0)
 *
 * over all i from which a step may reach e. reach(i), the largest such e, never falls as i grows,
 * so that two pointers find all of them with O(n) pictures. */
#include "diagram/sheets/sheets_parts.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

enum { SMALLEST = 13 };          /* number of the least scale of a flat picture */
static const double TURNED = 40; /* degrees: a turn by more ends a straight run of the cord */
/* Costs that the division of a path minimises the sum of. */
static const double STEP = 4;      /* of every step: few steps are better */
static const double STRAIGHT = 20; /* of an end within a straight run of the cord */
static const double NEW = 6;       /* of an end at a piece that is picked up by its last visit */
static const double SHORT = 4;     /* of each visit that a step has less than FEW */
enum { FEW = 6 };

bool thr_step_begins(const thr_known *known, int i)
{
  return i == 0 || known->move[i].part != known->move[i - 1].part;
}

bool thr_step_ends(const thr_known *known, int i)
{
  return i + 1 == known->n_visits || thr_step_begins(known, i + 1);
}

int thr_step_now(const thr_known *known, int first, int end, int *now)
{
  int n = 0;
  for (int i = first; i < end; i++) {
    const thr_visit *visit = &known->visit[i];
    if (visit->number) now[n++] = known->first_pass[visit->cord] + visit->number - 1;
  }

  return n;
}

/* A path that is divided into steps. Its visits are numbered from 0 here. */
typedef struct {
  thr_sheets *sheets;
  int first;  /* number of the path's first visit in known->visit */
  int n;      /* visits of the path */
  int *lines; /* [n + 1] lines of text in the rows of all visits before */
  int *reach; /* [n] the last possible end of a step that begins with a visit */
  int view;   /* the view in space in which the last picture was legible, tried first next time */
} divided_path;

/* Returns how many visits a step that begins at visit i needs, 1 or 2: the start of a cord alone
 * has no pass to draw. */
static int fewest(const divided_path *path, int i)
{
  return path->sheets->known.visit[path->first + i].number || i + 1 == path->n ? 1 : 2;
}

/* Computes the width and height, mm, that a page leaves for the picture of the visits i .. end - 1.
 * Returns whether they do. */
static bool find_room(const divided_path *path, int i, int end, double room[2])
{
  const thr_flow *flow = &path->sheets->flow;

  /* Everything but the picture has a known height; the text before and after the rows takes a line
   * each. */
  double below =
      THR_STEP_LEGEND + thr_step_strip_height(end - i) +
      thr_step_words_height(thr_step_rows_height(path->lines[end] - path->lines[i], end - i), 1, 1);
  room[0] = thr_sheets_width(flow);
  room[1] = thr_sheets_bottom(flow) - THR_SHEET_MARGIN - THR_STEP_HEAD - below;
  return room[1] >= THR_STEP_PICTURE[1];
}

/* Finds out whether the visits i .. end - 1 may be a step: *good says whether a page takes them
 * with every pass legible in the picture. */
static thr_status is_good(divided_path *path, int i, int end, bool *good, thr_err *err)
{
  thr_sheets *sheets = path->sheets;
  const thr_known *known = &sheets->known;
  int now[THR_STEP_VISITS];

  thr_crop crop = {.now = now,
                   .n_now = thr_step_now(known, path->first + i, path->first + end, now)};
  crop.backward = known->move[path->first + i].needle == THR_NEEDLE_LEFT;

  double room[2];
  thr_crop_view view;
  *good = find_room(path, i, end, room);
  if (!*good) return THR_OK;

  /* In space some view must show every pass long enough. */
  if (known->in_space) {
    *good = thr_space_legible(&sheets->space, &crop, room, &path->view);
    return THR_OK;
  }

  /* A flat picture must fit at a scale that is large enough. */
  thr_status st = thr_crop_fit(&sheets->crops, &crop, room, THR_STEP_PICTURE, &view, err);
  *good = view.scale <= SMALLEST;

  return st;
}

/* Computes path->reach. A step that is good stays good without its first visit, so each search
 * begins at the end that was found for the visit before. */
static thr_status find_reach(divided_path *path, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0, end = 0; i < path->n && !st; i++) {
    bool good = true;

    /* The least that any step has is accepted unseen: there is no smaller one. */
    if (end < i + fewest(path, i)) end = i + fewest(path, i);

    /* One visit more, as long as the page takes it and the needle's part goes on. */
    while (good && !st && end < path->n && end < i + THR_STEP_VISITS &&
           !thr_step_ends(&path->sheets->known, path->first + end - 1)) {
      st = is_good(path, i, end + 1, &good, err);
      end += good;
    }

    path->reach[i] = end;
  }
  return st;
}

/* Returns the cost of ending a step behind a visit: 0 where the needle's part ends anyway. */
static double price_of_end(const divided_path *path, int last)
{
  const thr_known *known = &path->sheets->known;
  const thr_visit *visit = &known->visit[path->first + last];
  if (thr_step_ends(known, path->first + last)) return 0;

  /* At the start of a cord there is no turn: a step had better not end there. */
  int out = known->visit[path->first + last + 1].in;
  bool turns = visit->number && thr_degrees(thr_turn_angle(known->f, visit->in, out)) > TURNED;

  return (turns ? 0 : STRAIGHT) + (visit->nth == 1 ? NEW : 0);
}

/* Computes the least cost of dividing the visits up to each end, and before[e]: where the last step
 * begins that ends at e. */
static void choose(const divided_path *path, double *least, int *begin_of)
{
  least[0] = 0;
  for (int e = 1; e <= path->n; e++)
    least[e] = HUGE_VAL;

  /* Costs are final when i is reached, as steps only lead forwards. */
  for (int i = 0; i < path->n; i++)
    for (int e = i + fewest(path, i); e <= path->reach[i]; e++) {
      double price =
          least[i] + STEP + price_of_end(path, e - 1) + (e - i < FEW ? (FEW - e + i) * SHORT : 0);

      /* Of equal costs the first one stays, the longer last step. */
      if (price >= least[e]) continue;
      least[e] = price;
      begin_of[e] = i;
    }
}

/* Joins steps of one pass to the steps before them, if the page takes both: in space any view can
 * be drawn, and a picture of one pass says less than a crowded one. */
static void join_single(const divided_path *path, int *end, int *n_steps)
{
  const thr_known *known = &path->sheets->known;
  int n = 0;

  for (int k = 0; k < *n_steps; k++) {
    const int from = n ? end[n - 1] : path->first, before = n > 1 ? end[n - 2] : path->first;
    double room[2];
    if (n && end[k] - from == 1 && !thr_step_begins(known, from) &&
        end[k] - before <= THR_STEP_VISITS &&
        find_room(path, before - path->first, end[k] - path->first, room))
      n--;
    end[n++] = end[k];
  }
  *n_steps = n;
}

thr_status thr_step_divide(thr_sheets *sheets, int c, int **ends, int *n_steps, thr_err *err)
{
  const thr_known *known = &sheets->known;
  divided_path path = {.sheets = sheets,
                       .first = known->first_visit[c],
                       .n = thr_sheets_end(known, c) - known->first_visit[c]};

  size_t n = (size_t)path.n + 1;
  double *least = thr_calloc(n, sizeof *least);
  int *begin_of = thr_calloc(n, sizeof *begin_of), *end = *ends = thr_calloc(n, sizeof *end);
  path.lines = thr_calloc(n, sizeof *path.lines);
  path.reach = thr_calloc(n, sizeof *path.reach);

  /* All arrays at once; each has a place for every end 0 .. n. */
  thr_status st = least && begin_of && end && path.lines && path.reach ? THR_OK : thr_nomem(err);

  /* Sums of lines let is_good ask for the height of any range. */
  for (int i = 0; i < path.n && !st; i++)
    path.lines[i + 1] = path.lines[i] + thr_step_row_lines(sheets, path.first + i);
  if (!st) st = sheets->flow.why.code;

  if (!st) st = find_reach(&path, err);
  *n_steps = 0;

  /* Follow the chosen beginnings back from the end: once to count the steps, once to list their
   * ends. */
  if (!st) {
    choose(&path, least, begin_of);
    for (int e = path.n; e > 0; e = begin_of[e])
      ++*n_steps;
    for (int e = path.n, k = *n_steps; e > 0; e = begin_of[e])
      end[--k] = path.first + e;
    if (known->in_space) join_single(&path, end, n_steps);
  }

  free(least);
  free(begin_of);
  free(path.lines);
  free(path.reach);
  return st;
}
