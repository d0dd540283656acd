/* Paper, beads and passes: the parts of the scene that everything else is placed against. */
#include "diagram/scene/scene.h"
#include "graph/angle.h"
#include "graph/scratch.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double AUTO_PITCH = 24, MAX_WIDTH = 1130, MAX_HEIGHT = 1070; /* mm; A0 is 1189 long, less margins and text */
static const double SHORT = 0.36; /* at most this share of an edge is left free at each end */

double thr_scene_text_width(const char *text, double font_size)
{
  /* DejaVu Sans, a wide face: digits 0.636 em, capitals 0.70 in the mean, many of those in names 0.77 */
  int capitals = 0;
  for (const char *s = text; *s; s++)
    capitals += *s >= 'A' && *s <= 'Z';
  return font_size * (0.64 * thr_text_columns(text, SIZE_MAX) + 0.11 * capitals);
}

double thr_scene_pill_height(const thr_scene *s)
{
  return 1.4 * s->size.text;
}

double thr_scene_pill_width(const thr_scene *s, const char *text)
{
  return fmax(thr_scene_text_width(text, s->size.text) + 0.6 * s->size.text, thr_scene_pill_height(s));
}

void thr_scene_number(const thr_scene *s, int pass, char text[32])
{
  const thr_scene_pass *p = &s->pass[pass];
  snprintf(text, 32, "%s%d", s->plan->n_cords > 1 ? s->id[p->cord] : "", p->number);
}

double thr_scene_sweep(double a, double b)
{
  double d = fmod(b - a, 2 * THR_PI);
  return d < 0 ? d + 2 * THR_PI : d;
}

bool thr_scene_is_copy(const thr_scene *s, int c)
{
  return s->copy && s->copy[c].of != c;
}

int thr_scene_hue(const thr_scene *s, int c)
{
  return s->copy ? s->copy[c].path : c;
}

const char *thr_scene_cord_colour(const thr_scene *s, int c)
{
  thr_colour colour = thr_palette(thr_scene_hue(s, c));
  return thr_scene_is_copy(s, c) ? colour.pale : colour.hex;
}

void thr_scene_colour(const thr_scene *s, int i, char hex[8])
{
  const thr_scene_pass *p = &s->pass[i];
  const thr_eval_cord *known = s->tension && s->tension->cord[p->cord].known ? &s->tension->cord[p->cord] : NULL;
  if (known)
    thr_tension_colour(s->tension_range, known->tension[p->number - 1], hex);
  else if (s->tension)
    snprintf(hex, 8, "#999999");
  else if (s->turning && s->plan->n_cords == 1)
    snprintf(hex, 8, "#666666");
  else
    snprintf(hex, 8, "%s",
             s->plan->n_cords > 1 ? thr_scene_cord_colour(s, p->cord) : thr_palette((p->number - 1) / THR_COLOUR_PASSES).hex);
}

bool thr_scene_rim(const thr_scene *s, int c, const char *colour, char rim[8])
{
  return !s->turning && !thr_scene_is_copy(s, c) && thr_palette_rim(colour, rim);
}

const double *thr_scene_dash(const thr_scene *s, int c)
{
  int hues = s->copy ? thr_copies_paths(s->copy, s->plan->n_cords) : s->plan->n_cords;
  return hues > THR_COLOURS ? thr_palette_dash(thr_scene_hue(s, c) / THR_COLOURS) : NULL;
}

bool thr_scene_continues(const thr_scene *s, int i)
{
  return i + 1 < s->first_pass[s->pass[i].cord + 1];
}

const thr_mark *thr_scene_mark_before(const thr_scene *s, int i)
{
  const thr_scene_pass *p = &s->pass[i];
  if (p->number == 1) return &s->mark[p->cord][0];
  return p->seam >= 0 ? &s->seam[p->seam][1] : NULL;
}

const thr_mark *thr_scene_mark_after(const thr_scene *s, int i)
{
  const thr_scene_pass *p = &s->pass[i];
  if (!thr_scene_continues(s, i)) return &s->mark[p->cord][1];
  return p[1].seam >= 0 ? &s->seam[p[1].seam][0] : NULL;
}

const double *thr_scene_turn_start(const thr_scene *s, int i)
{
  const thr_mark *m = thr_scene_mark_before(s, i);
  return m ? m->at : s->pass[i - 1].to;
}

void thr_scene_place_name(const thr_scene *s, int point, char name[48])
{
  thr_places_name(&s->places, s->frame, thr_layout_node(s->layout, point), name);
}

double thr_scene_edge_length(const thr_scene *s, int e)
{
  const double *a = s->at[s->paper->edge[e][0]], *b = s->at[s->paper->edge[e][1]];
  return hypot(b[0] - a[0], b[1] - a[1]);
}

void thr_scene_direction(const thr_scene *s, int h, double d[2])
{
  const double *a = s->at[thr_tail(s->paper, h)], *b = s->at[thr_head(s->paper, h)];
  double length = hypot(b[0] - a[0], b[1] - a[1]);
  d[0] = length > 0 ? (b[0] - a[0]) / length : h & 1 ? -1 : 1;
  d[1] = length > 0 ? (b[1] - a[1]) / length : 0;
}

void thr_scene_destroy(thr_scene *s)
{
  thr_places_destroy(&s->places);
  thr_boxes_destroy(&s->boxes);
  free(s->copy);
  thr_scratch_free(&s->own);
  free(s->seam);
  free(s->seam_labelled);
  *s = (thr_scene){0};
}

static thr_status allocate(thr_scene *s, thr_err *err)
{
  size_t n = (size_t)s->layout->n_points, m = (size_t)s->frame->n_edges, c = (size_t)s->plan->n_cords, p = (size_t)s->n_passes;
  s->at = thr_scratch_array(&s->own, n, sizeof *s->at);
  s->twin = thr_scratch_array(&s->own, n, sizeof *s->twin);
  s->angle = thr_scratch_array(&s->own, 2 * m, sizeof *s->angle);
  s->around = thr_scratch_array(&s->own, 2 * m, sizeof *s->around);
  s->rank = thr_scratch_array(&s->own, 2 * m, sizeof *s->rank);
  s->gap = thr_scratch_array(&s->own, 2 * m, sizeof *s->gap);
  s->lane = thr_scratch_array(&s->own, m, sizeof *s->lane);
  s->bead = thr_scratch_array(&s->own, m, sizeof *s->bead);
  s->pass = thr_scratch_array(&s->own, p, sizeof *s->pass);
  s->first_pass = thr_scratch_array(&s->own, c + 1, sizeof *s->first_pass);
  s->first_on = thr_scratch_array(&s->own, m + 2, sizeof *s->first_on);
  s->on = thr_scratch_array(&s->own, p, sizeof *s->on);
  s->mark = thr_scratch_array(&s->own, c, sizeof *s->mark);
  s->id = thr_scratch_array(&s->own, c, sizeof *s->id);
  s->named = thr_scratch_array(&s->own, n, sizeof *s->named);
  s->name_at = thr_scratch_array(&s->own, n, sizeof *s->name_at);
  return thr_scratch_check(&s->own, err);
}

thr_status thr_scene_check_cords(const thr_plan *p, int *n_passes, thr_err *err)
{
  const thr_frame *f = &p->frame;
  long total = 0;
  for (int c = 0; c < p->n_cords; c++) {
    const thr_cord *cord = &p->cord[c];
    if (cord->n_passes < 1) return thr_fail(err, THR_EINPUT, "cord %.11s has no pass", cord->id);
    for (int i = 0; i < cord->n_passes; i++) {
      int h = cord->half[i];
      if (h < 0 || h >= 2 * f->n_edges)
        return thr_fail(err, THR_EINPUT, "cord %.11s: pass %d names edge %d, but there are %d", cord->id, i + 1, h / 2,
                        f->n_edges);
      if (i && thr_head(f, cord->half[i - 1]) != thr_tail(f, h))
        return thr_fail(err, THR_EINPUT, "cord %.11s: pass %d does not start where pass %d ends", cord->id, i + 1, i);
    }
    total += cord->n_passes;
  }
  if (total > 100000000) return thr_fail(err, THR_EINPUT, "%ld passes are too many to draw", total);
  *n_passes = (int)total;
  return THR_OK;
}

/* Which cords are copies, if any is. */
static thr_status find_copies(thr_scene *s, thr_err *err)
{
  int n = s->plan->n_cords;
  thr_copy *copy = thr_calloc((size_t)n, sizeof *copy);
  if (!copy) return thr_nomem(err);
  thr_status st = thr_copies_find(s->plan, copy, err);
  if (!st && thr_copies_paths(copy, n) < n)
    s->copy = copy;
  else
    free(copy);
  return st;
}

/* Flattens the cords into passes and sorts these by edge; within an edge by pass. */
void thr_scene_cord_id(const thr_plan *p, int c, char id[12])
{
  size_t letters = strspn(p->cord[c].id, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
  if (letters && !p->cord[c].id[letters])
    snprintf(id, 12, "%.11s", p->cord[c].id);
  else
    thr_cord_id(c, id);
}

static void collect_passes(thr_scene *s)
{
  int n = 0;
  for (int c = 0; c < s->plan->n_cords; c++) {
    const thr_cord *cord = &s->plan->cord[c];
    s->first_pass[c] = n;
    for (int i = 0; i < cord->n_passes; i++) {
      s->pass[n++] = (thr_scene_pass){.cord = c, .number = i + 1, .half = cord->half[i], .seam = -1};
      s->first_on[(cord->half[i] >> 1) + 2]++;
    }
    thr_scene_cord_id(s->plan, c, s->id[c]);
  }
  s->first_pass[s->plan->n_cords] = n;
  for (int e = 0; e < s->frame->n_edges; e++)
    s->first_on[e + 2] += s->first_on[e + 1];
  for (int i = 0; i < n; i++) {
    int *at = &s->first_on[(s->pass[i].half >> 1) + 1];
    s->on[(*at)++] = i;
  }
}

static void choose_sizes(thr_scene *s)
{
  double u = s->size.pitch;
  s->size.lane = 0.115 * u;
  s->size.cord = fmin(0.045 * u, 1.6);
  s->size.casing = fmin(0.025 * u, 0.8);
  s->size.bead = 0.28 * u;
  s->size.gap = 0.15 * u;
  s->size.foot = fmax(0.16 * u, 0.5);
  s->size.arrow = fmin(0.14 * u, 5);
  s->size.text = u > 28 ? 3 : 2.5;
}

/* Chooses the scale and puts the nodes on paper. */
static thr_status place_nodes(thr_scene *s, double pitch_mm, thr_err *err)
{
  const thr_layout *l = s->layout;
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int v = 0; v < l->n_points; v++)
    for (int i = 0; i < 2; i++) {
      low[i] = fmin(low[i], l->xy[v][i]);
      high[i] = fmax(high[i], l->xy[v][i]);
    }
  double extent = fmax(high[0] - low[0], high[1] - low[1]);
  double unit = l->median > 1e-9 * extent ? l->median : extent / sqrt(s->frame->n_edges);
  if (!(unit > 0)) unit = 1;
  /* a layout with many short edges gets a larger sheet, so that these have room too */
  double wanted = AUTO_PITCH * fmax(1, fmin(1.4, 0.6 / fmax(l->ratio, 0.01)));
  wanted *= fmax(1, fmin(1.5, 0.8 + 0.17 * s->n_passes / s->frame->n_edges)); /* and so does one with many lanes */
  double relative = fmax((high[0] - low[0]) / MAX_WIDTH, (high[1] - low[1]) / MAX_HEIGHT) / unit;
  s->size.pitch = pitch_mm > 0 ? pitch_mm : fmin(wanted, relative > 0 ? 1 / relative : wanted);
  s->scale = s->size.pitch / unit;
  s->width = (high[0] - low[0]) * s->scale;
  s->height = (high[1] - low[1]) * s->scale;
  if (!(s->width < 1e5 && s->height < 1e5))
    return thr_fail(err, THR_EINPUT, "a pitch of %g mm needs a sheet %.0f mm wide; choose a smaller one", s->size.pitch,
                    fmax(s->width, s->height));
  s->origin[0] = low[0];
  s->origin[1] = high[1];
  for (int v = 0; v < l->n_points; v++) {
    s->at[v][0] = (l->xy[v][0] - low[0]) * s->scale;
    s->at[v][1] = (high[1] - l->xy[v][1]) * s->scale;
  }
  choose_sizes(s);
  return THR_OK;
}

/* Sorts the half-edges around every node. */
static thr_status sort_around(thr_scene *s, thr_err *err)
{
  const thr_frame *f = s->paper;
  for (int h = 0; h < 2 * f->n_edges; h++) {
    double d[2];
    thr_scene_direction(s, h, d);
    s->angle[h] = atan2(d[1], d[0]);
  }
  thr_status st = thr_layout_around(f, s->angle, s->around, err);
  for (int v = 0; v < f->n_nodes && !st; v++)
    for (int i = 0; i < thr_degree(f, v); i++)
      s->rank[s->around[f->first[v] + i]] = i;
  return st;
}

/* Widths: lanes get closer where there are many or the edge is short. */
static void size_beads(thr_scene *s)
{
  for (int e = 0; e < s->frame->n_edges; e++) {
    int n = s->first_on[e + 1] - s->first_on[e];
    double room = fmin(0.62 * s->size.pitch, fmax(0.6 * thr_scene_edge_length(s, e), 0.2 * s->size.pitch));
    s->lane[e] = n > 1 ? fmin(s->size.lane, room / (n - 1)) : s->size.lane;
    double wide = (n > 1 ? (n - 1) * s->lane[e] : 0) + 0.2 * s->size.pitch;
    s->bead[e] = fmax(wide, fmin(s->size.bead, fmax(0.55 * thr_scene_edge_length(s, e), 0.17 * s->size.pitch)));
  }
}

/* How far from the node half-edge h may start so that its bead clears the bead of its neighbour other. */
static double clearance(const thr_scene *s, int h, int other)
{
  double a = thr_scene_sweep(s->angle[h], s->angle[other]);
  if (a > THR_PI) a = 2 * THR_PI - a;
  if (a > 2.6) return 0;
  if (a < 0.05) a = 0.05;
  return 0.5 * (s->bead[other >> 1] + s->bead[h >> 1] * cos(a)) / sin(a);
}

static void size_gaps(thr_scene *s)
{
  const thr_frame *f = s->paper;
  for (int v = 0; v < f->n_nodes; v++) {
    int first = f->first[v], degree = thr_degree(f, v);
    for (int i = 0; i < degree; i++) {
      int h = s->around[first + i];
      double gap = s->size.gap;
      if (degree > 1) {
        gap = fmax(gap, 0.95 * clearance(s, h, s->around[first + (i + 1) % degree]));
        gap = fmax(gap, 0.95 * clearance(s, h, s->around[first + (i + degree - 1) % degree]));
      }
      s->gap[h] = fmin(fmin(gap, s->size.pitch), SHORT * thr_scene_edge_length(s, h >> 1));
    }
  }
}

/* Tells the boxes where the beads are: small squares along each. */
static thr_status box_beads(thr_scene *s, thr_err *err)
{
  double u = s->size.pitch;
  thr_status st = thr_boxes_init(&s->boxes, (thr_box){-u, -u, s->width + u, s->height + u}, fmax(0.5 * u, 4), err);
  for (int e = 0; e < s->frame->n_edges && !st; e++) {
    double d[2], half = 0.5 * s->bead[e], length = thr_scene_edge_length(s, e) - s->gap[2 * e] - s->gap[2 * e + 1];
    const double *a = s->at[s->paper->edge[e][0]];
    thr_scene_direction(s, 2 * e, d);
    int n = (int)fmin(ceil(length / s->bead[e]) + 1, 64);
    for (int i = 0; i < n && !st; i++) {
      double t = s->gap[2 * e] + (n > 1 ? fmin(half, 0.5 * length) + i * fmax(length - 2 * half, 0) / (n - 1) : 0.5 * length);
      st = thr_boxes_add(&s->boxes, thr_box_around(a[0] + t * d[0], a[1] + t * d[1], 0.9 * half, 0.9 * half), THR_BOX_BEAD, err);
    }
  }
  return st;
}

thr_status thr_scene_build(thr_scene *s, const thr_plan *p, const thr_layout *l, double pitch_mm, bool pale_copies, thr_err *err)
{
  *s = (thr_scene){.plan = p, .frame = &p->frame, .layout = l, .paper = thr_layout_paper(l, &p->frame)};
  thr_status st = thr_scene_check_cords(p, &s->n_passes, err);
  if (!st) st = allocate(s, err);
  if (!st && pale_copies) st = find_copies(s, err);
  if (st) goto done;
  collect_passes(s);
  if ((st = place_nodes(s, pitch_mm, err))) goto done;
  if (thr_layout_to_scale(l->kind)) st = thr_places_find(&s->places, s->frame, (const double(*)[2])l->xy, l->median, err);
  if (st) goto done;
  if ((st = sort_around(s, err))) goto done;
  size_beads(s);
  size_gaps(s);
  if ((st = box_beads(s, err))) goto done;
  if ((st = thr_scene_place_marks(s, err))) goto done;
  if ((st = thr_scene_place_seams(s, err))) goto done;
  if ((st = thr_scene_order_lanes(s, err))) goto done;
  thr_scene_lay_strands(s);
  if ((st = thr_scene_name_seams(s, err))) goto done;
  st = thr_scene_place_labels(s, err);
done:
  if (st) thr_scene_destroy(s);
  return st;
}
