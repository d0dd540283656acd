/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The overview looked at as a maker does: parsed from its SVG and held against the plan and the
 * framework. */
#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/scene/scene.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/sample_plans.h"
#include "tests/svg_tree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double POINT = 25.4 / 72; /* mm */

/* A plan and its picture. */
typedef struct {
  thr_plan p;
  thr_layout l;
  char *svg;
  svg_tree t;
} view;

static view view_of(thr_plan p, double pitch)
{
  view v = {.p = p};
  thr_text svg = {0};
  thr_err err = {0};
  thr_overview_options o = thr_overview_options_default();
  assert_ok(thr_layout_choose(&v.l, &v.p.frame, NULL, 0, &err), &err);
  o.pitch_mm = pitch;
  assert_ok(thr_overview_svg(&v.p, &o, &svg, &err), &err);
  v.svg = svg.data;
  v.t = svg_parse(v.svg);
  return v;
}

static const thr_frame *paper_of(const view *v)
{
  return thr_layout_paper(&v->l, &v->p.frame);
}

static void view_destroy(view *v)
{
  svg_tree_destroy(&v->t);
  free(v->svg);
  thr_layout_destroy(&v->l);
  thr_plan_destroy(&v->p);
}

/* ---- plans ---- */

/* Takes the framework. The closed cord through it cut into pieces of so many passes. */
static thr_plan pieces_of(thr_frame f, int passes)
{
  thr_plan whole = plan_of(f, THR_ENDS_CLOSED, 1), p = whole;
  int n = whole.cord[0].n_passes, count = (n + passes - 1) / passes;
  p.cord = thr_calloc((size_t)count, sizeof *p.cord);
  ck_assert_ptr_nonnull(p.cord);
  p.options.ends = THR_ENDS_ANY;
  p.n_cords = count;
  for (int c = 0; c < count; c++) {
    int from = c * passes, k = n - from < passes ? n - from : passes;
    p.cord[c] = (thr_cord){.n_passes = k, .half = thr_calloc((size_t)k, sizeof(int))};
    ck_assert_ptr_nonnull(p.cord[c].half);
    memcpy(p.cord[c].half, whole.cord[0].half + from, (size_t)k * sizeof(int));
    thr_cord_id(c, p.cord[c].id);
  }
  thr_cords_destroy(whole.cord, whole.n_cords);
  return p;
}

/* Planar: a grid whose nodes are moved at random, with one diagonal in some of its squares. */
static thr_frame random_planar(uint64_t seed, int w, int h)
{
  rng r = rng_make(seed);
  thr_draft d = {0};
  thr_frame f = {0};
  thr_read_report report = {0};
  for (int i = 0; i < w * h; i++) {
    double xyz[3] = {20 * (i % w + 0.5 * rng_unit(&r)), 20 * (i / w + 0.5 * rng_unit(&r)),
                     rng_unit(&r)};
    ck_assert_int_eq(thr_draft_add_node(&d, xyz, NULL, false, NULL), THR_OK);
  }
  for (int i = 0; i < w * h; i++) {
    bool right = i % w + 1 < w, up = i + w < w * h;
    if (right) ck_assert_int_eq(thr_draft_add_edge(&d, i, i + 1, 0, NULL), THR_OK);
    if (up) ck_assert_int_eq(thr_draft_add_edge(&d, i, i + w, 0, NULL), THR_OK);
    if (right && up && rng_below(&r, 3) == 0)
      ck_assert_int_eq(thr_draft_add_edge(&d, i, i + w + 1, 0, NULL), THR_OK);
  }
  ck_assert_int_eq(thr_draft_build(&d, 0, &f, &report, NULL), THR_OK);
  thr_draft_destroy(&d);
  return f;
}

static thr_plan drawn_plan(int i)
{
  switch (i) {
  case 0: return plan_of(shape_make(THR_MAKE_DOME, 7, 0), THR_ENDS_CLOSED, 1);
  case 1: return plan_of(shape_make(THR_MAKE_DOME, 12, 0), THR_ENDS_FEET, 1);
  case 2: return plan_of(shape_make(THR_MAKE_TUBE, 12, 7), THR_ENDS_CLOSED, 1);
  case 3: return plan_of(shape_make(THR_MAKE_SPHERE, 3, 0), THR_ENDS_CLOSED, 1);
  case 4: return plan_of(shape_make(THR_MAKE_HONEYCOMB, 4, 0), THR_ENDS_CLOSED, 2);
  case 5: return pieces_of(shape_make(THR_MAKE_DOME, 7, 0), 33);
  case 6: return symmetric_plan(shape_make(THR_MAKE_DOME, 6, 0), THR_ENDS_FEET, 1, "C4");
  case 7: return plan_of(shape_make(THR_MAKE_GEODESIC, 4, 0), THR_ENDS_CLOSED, 1);
  case 8: return plan_of(random_planar(1, 7, 6), THR_ENDS_CLOSED, 1);
  case 9: return plan_of(random_planar(2, 9, 4), THR_ENDS_ANY, 1);
  case 10: return pieces_of(shape_make(THR_MAKE_SPHERE, 2, 0), 9);
  case 11: return plan_of(frame_load("data/jax_fdm/creased_shell.json", NULL), THR_ENDS_CLOSED, 1);
  case 12: return plan_of(frame_load("data/jax_fdm/liew_dome.json", NULL), THR_ENDS_CLOSED, 1);
  default: return plan_of(shape_make(THR_MAKE_SPHERE, 5, 0), THR_ENDS_CLOSED, 1);
  }
}
enum { N_DRAWN = 14 };

/* ---- passes ---- */

static int child_by_class(const svg_tree *t, int group, const char *word)
{
  for (int i = group + 1; i < t->n && svg_inside(t, i, group); i++)
    if (svg_has_class(t, i, word)) return i;
  return -1;
}

/* A pass as it is drawn: where it starts, enters its lane, leaves it and ends. */
typedef struct {
  double start[2], from[2], to[2], end[2];
} stroke;

static stroke stroke_of(const view *v, int group)
{
  char letter[9];
  double at[9][2];
  stroke s;
  int path = child_by_class(&v->t, group, "cord");
  ck_assert_int_gt(path, 0);
  int n = svg_path(&v->t, path, letter, at, 9);
  ck_assert_msg((n == 6 || n == 9) && strncmp(letter, "MCCCLLCCC", (size_t)n) == 0, "%d %.9s", n,
                letter);
  memcpy(s.start, at[0], sizeof s.start);
  memcpy(s.from, at[3], sizeof s.from);
  memcpy(s.to, at[5], sizeof s.to);
  memcpy(s.end, at[n - 1], sizeof s.end);
  return s;
}

static bool is_solid(const view *v)
{
  return v->p.options.joint == THR_JOINT_SOLID;
}

static int element_of_piece(const view *v, int piece)
{
  char id[32];
  snprintf(id, sizeof id, "piece-%d", piece);
  int i = svg_by_id(&v->t, id);
  ck_assert_msg(i >= 0, "%s is not drawn", id);
  return i;
}

/* Is a point inside the outline of a solid piece, or within so much of it? By the winding of its
 * polygons. */
static bool in_outline(const view *v, int piece, const double at[2], double air)
{
  enum { MOST = 400 };
  const svg_element *e = &v->t.element[element_of_piece(v, piece)];
  const char *d = strstr(e->attributes, " d=\"") + 4;
  double p[MOST][2], angle = 0;
  bool near = false;
  while (*d == 'M') {
    int n = 0, length;
    do {
      ck_assert_int_eq(sscanf(d + 1, "%lf %lf%n", &p[n][0], &p[n][1], &length), 2);
      p[n][0] += e->shift[0];
      p[n++][1] += e->shift[1];
      ck_assert_int_lt(n, MOST);
      d += 1 + length;
    } while (*d == 'L');
    ck_assert_int_eq(*d++, 'z');
    angle = 0;
    for (int i = 0; i < n; i++) {
      const double *a = p[i], *b = p[(i + 1) % n];
      double u[2] = {a[0] - at[0], a[1] - at[1]}, w[2] = {b[0] - at[0], b[1] - at[1]};
      angle += atan2(u[0] * w[1] - u[1] * w[0], u[0] * w[0] + u[1] * w[1]);
      double side[2] = {b[0] - a[0], b[1] - a[1]}, length2 = side[0] * side[0] + side[1] * side[1];
      double part =
          length2 > 0 ? fmin(fmax(-(u[0] * side[0] + u[1] * side[1]) / length2, 0), 1) : 0;
      near |= hypot(u[0] + part * side[0], u[1] + part * side[1]) <= air;
    }
    if (fabs(angle) > 3) return true;
  }
  return near;
}

/* A point in the coordinates of a tube: along it from its middle, and across; and half its size. */
static void in_tube(const view *v, int e, const double at[2], double *along, double *across,
                    double half[2])
{
  int i = element_of_piece(v, e);
  const svg_element *b = &v->t.element[i];
  double x = at[0] - b->shift[0], y = at[1] - b->shift[1], c = cos(b->angle * acos(-1) / 180),
         s = sin(b->angle * acos(-1) / 180);
  *along = c * x + s * y;
  *across = c * y - s * x;
  half[0] = 0.5 * svg_number(&v->t, i, "width");
  half[1] = 0.5 * svg_number(&v->t, i, "height");
}

/* The lane of a pass runs inside its tube from the end at its tail to the end at its head, or from
 * one solid piece to the next.
 */
static void assert_lane(const view *v, int h, const stroke *s)
{
  double along[2], across[2], half[2], sign = h & 1 ? -1 : 1;
  if (is_solid(v)) {
    double wide = 0.1 * hypot(s->to[0] - s->from[0], s->to[1] - s->from[1]);
    const double *const at[2] = {s->from, s->to};
    for (int k = 0; k < 2; k++) {
      int node = k ? thr_head(&v->p.frame, h) : thr_tail(&v->p.frame, h);
      ck_assert_msg(thr_degree(&v->p.frame, node) > 8 ||
                        in_outline(v, node, at[k], fmax(wide, 0.3)),
                    "half-edge %d runs beside piece %d at %g %g", h, node, at[k][0], at[k][1]);
    }
    return;
  }
  in_tube(v, h >> 1, s->from, &along[0], &across[0], half);
  in_tube(v, h >> 1, s->to, &along[1], &across[1], half);
  ck_assert_double_le(fabs(across[0]), half[1]);
  ck_assert_double_le(fabs(across[1]), half[1]);
  ck_assert_double_eq_tol(across[0], across[1], 0.1);
  ck_assert_double_lt(sign * along[0], sign * along[1]);
  ck_assert_double_le(fabs(along[0]), half[0] + 0.05);
  ck_assert_double_le(fabs(along[1]), half[0] + 0.05);
}

/* Every tube lies in the direction of its edge: the layout's, with y down. */
static void assert_tubes(const view *v)
{
  for (int e = 0; e < v->p.frame.n_edges; e++) {
    int i = element_of_piece(v, e);
    const double *a = v->l.xy[paper_of(v)->edge[e][0]], *b = v->l.xy[paper_of(v)->edge[e][1]];
    double turn = atan2(a[1] - b[1], b[0] - a[0]) * 180 / acos(-1) - v->t.element[i].angle;
    ck_assert_double_lt(fabs(remainder(turn, 360)), 0.1);
  }
}

/* One element for every piece, each with a name of its own, and no others. */
static void assert_pieces(const view *v)
{
  int pieces = is_solid(v) ? v->p.frame.n_nodes : v->p.frame.n_edges, drawn = 0;
  char name[2][256];
  for (int i = 0; i < v->t.n; i++)
    drawn += svg_attribute(&v->t, i, "data-piece", name[0]);
  ck_assert_int_eq(drawn, pieces);
  for (int i = 0; i < pieces && pieces < 400; i++) {
    ck_assert(svg_attribute(&v->t, element_of_piece(v, i), "data-piece", name[0]));
    for (int k = 0; k < i; k++) {
      svg_attribute(&v->t, element_of_piece(v, k), "data-piece", name[1]);
      ck_assert_str_ne(name[0], name[1]);
    }
  }
  if (!is_solid(v)) assert_tubes(v);
}

static void assert_at(const double a[2], const double b[2], double air)
{
  ck_assert_msg(hypot(a[0] - b[0], a[1] - b[1]) <= air, "(%g, %g) is not at (%g, %g)", a[0], a[1],
                b[0], b[1]);
}

static void middle_of(const view *v, int i, double at[2])
{
  double box[4];
  svg_box(&v->t, i, box);
  at[0] = 0.5 * (box[0] + box[2]);
  at[1] = 0.5 * (box[1] + box[3]);
}

/* The mark with this text, in the group of ends. */
static void mark_at(const view *v, const char *text, double at[2])
{
  int ends = svg_by_id(&v->t, "ends");
  for (int i = ends + 1; i < v->t.n && svg_inside(&v->t, i, ends); i++)
    if (strcmp(v->t.element[i].name, "text") == 0 && strcmp(v->t.element[i].text, text) == 0) {
      middle_of(v, i - 1, at); /* the disc or square before it */
      return;
    }
  ck_abort_msg("no mark %s", text);
}

static bool over_seam(const view *v, int c, int k)
{
  const int *half = v->p.cord[c].half;
  return thr_head(paper_of(v), half[k - 1]) != thr_tail(paper_of(v), half[k]);
}

/* What is written where the cord goes over to the other panel before pass k (from 0); *seen counts
 * labelled ones. */
static void assert_seam(const view *v, int c, int k, const stroke *before, const stroke *now,
                        int *seen)
{
  const char *id = v->p.cord[c].id, *letter = v->p.n_cords > 1 ? id : "",
             *colon = *letter ? ":" : "";
  char out[40], in[40], want[40];
  double at[2];
  snprintf(out, sizeof out, "out-%s-%d", id, k);
  snprintf(in, sizeof in, "in-%s-%d", id, k + 1);
  int i = svg_by_id(&v->t, out), j = svg_by_id(&v->t, in);
  ck_assert_int_eq(i < 0, j < 0);
  if (i < 0) return;
  ++*seen;
  snprintf(want, sizeof want, "to %s%s%d", letter, colon, k + 1);
  ck_assert_str_eq(v->t.element[i + 2].text, want);
  snprintf(want, sizeof want, "from %s%s%d", letter, colon, k);
  ck_assert_str_eq(v->t.element[j + 2].text, want);
  middle_of(v, i + 1, at);
  assert_at(before->end, at, 0.02);
  middle_of(v, j + 1, at);
  assert_at(now->start, at, 0.02);
}

/* A pass in a pale colour has a rim where it runs, in a darker one, and nothing else has. */
static void assert_rim(const view *v, int group)
{
  char colour[256], dark[8], along[256], path[256];
  int rim = child_by_class(&v->t, group, "rim");
  ck_assert(svg_attribute(&v->t, group, "stroke", colour));
  ck_assert_int_eq(rim > 0, !svg_has_class(&v->t, v->t.element[group].parent, "copy") &&
                                thr_palette_rim(colour, dark));
  if (rim < 0) return;
  svg_attribute(&v->t, rim, "d", along);
  svg_attribute(&v->t, child_by_class(&v->t, group, "cord"), "d", path);
  ck_assert_str_eq(along, path);
  svg_attribute(&v->t, rim, "stroke", colour);
  ck_assert_str_eq(colour, dark);
}

/* Every pass of a cord is drawn once, in order, in its lane, and goes on where the one before ends.
 */
static void assert_cord(const view *v, int c, int *seams, int *labelled)
{
  const thr_cord *cord = &v->p.cord[c];
  const char *letter = v->p.n_cords > 1 ? cord->id : "";
  char id[40];
  double at[2];
  stroke before = {0}, now = {0};
  snprintf(id, sizeof id, "cord-%s", cord->id);
  int group = svg_by_id(&v->t, id), k = 0;
  ck_assert_msg(group >= 0, "%s is not drawn", id);
  for (int i = group + 1; i < v->t.n && svg_inside(&v->t, i, group); i++) {
    if (v->t.element[i].parent != group) continue;
    snprintf(id, sizeof id, "%s-%d", cord->id, k + 1);
    ck_assert_int_lt(k, cord->n_passes);
    ck_assert_str_eq(v->t.element[i].id, id);
    now = stroke_of(v, i);
    assert_rim(v, i);
    assert_lane(v, cord->half[k], &now);
    if (k == 0) {
      snprintf(id, sizeof id, "S%s", letter);
      mark_at(v, id, at);
      assert_at(now.start, at, 0.02);
    } else if (over_seam(v, c, k)) {
      ++*seams;
      assert_seam(v, c, k, &before, &now, labelled);
    } else {
      assert_at(now.start, before.end, 0.001);
    }
    before = now;
    k++;
  }
  ck_assert_int_eq(k, cord->n_passes);
  snprintf(id, sizeof id, "E%s", letter);
  mark_at(v, id, at);
  assert_at(now.end, at, 0.02);
}

static void assert_passes(const view *v)
{
  int seams = 0, labelled = 0;
  assert_pieces(v);
  for (int c = 0; c < v->p.n_cords; c++)
    assert_cord(v, c, &seams, &labelled);
  if (!v->l.node) ck_assert_int_eq(seams, 0);
  if (v->l.node) ck_assert_int_gt(seams, 0);
  if (labelled < seams)
    ck_assert(strstr(v->svg, " without a label for want of room") ||
              strstr(v->svg, "the cord may go on in the other half"));
}

/* ---- what is written ---- */

enum { PILL, TAG, MARK, PLACE, KINDS };

typedef struct {
  double box[4];
  int kind, element;
} writing;

/* Numbers, labels of seams, marks and names in the drawing; the caller frees. */
static writing *writings(const view *v, int *n)
{
  int drawing = svg_by_id(&v->t, "drawing"), places = svg_by_id(&v->t, "places");
  writing *w = thr_calloc((size_t)v->t.n, sizeof *w);
  ck_assert_ptr_nonnull(w);
  *n = 0;
  for (int i = drawing + 1; i < v->t.n && svg_inside(&v->t, i, drawing); i++) {
    int kind = svg_has_class(&v->t, i, "pill")   ? PILL
               : svg_has_class(&v->t, i, "tag")  ? TAG
               : svg_has_class(&v->t, i, "mark") ? MARK
                                                 : KINDS;
    if (svg_inside(&v->t, i, places) && i > places) kind = PLACE;
    if (kind == KINDS) continue;
    svg_box(&v->t, i, w[*n].box);
    w[*n].kind = kind;
    w[(*n)++].element = i;
  }
  return w;
}

static void assert_apart(const view *v)
{
  int n, pills = 0;
  writing *w = writings(v, &n);
  for (int i = 0; i < n; i++) {
    pills += w[i].kind == PILL;
    for (int j = 0; j < i; j++)
      ck_assert_msg(!svg_overlap(w[i].box, w[j].box, -0.02), "<%s%s> covers <%s%s>",
                    v->t.element[w[i].element].name, v->t.element[w[i].element].attributes,
                    v->t.element[w[j].element].name, v->t.element[w[j].element].attributes);
  }
  ck_assert_int_gt(pills, 0);
  free(w);
}

static void assert_legible(const view *v)
{
  for (int i = 0; i < v->t.n; i++)
    if (strcmp(v->t.element[i].name, "text") == 0) {
      double box[4];
      ck_assert_double_ge(svg_number(&v->t, i, "font-size"), 7 * POINT);
      svg_box(&v->t, i, box);
      ck_assert_msg(box[0] >= 0 && box[1] >= 0 && box[2] <= v->t.width && box[3] <= v->t.height,
                    "off the sheet: %s", v->t.element[i].text);
    }
  char box[256], want[256], width[256], height[256];
  svg_attribute(&v->t, 0, "viewBox", box);
  svg_attribute(&v->t, 0, "width", width);
  svg_attribute(&v->t, 0, "height", height);
  snprintf(want, sizeof want, "0 0 %.*s %.*s", (int)strcspn(width, "m"), width,
           (int)strcspn(height, "m"), height);
  ck_assert_str_eq(box, want); /* so sizes are mm */
}

static int times_written(const view *v, const char *text, const char *class)
{
  int places = svg_by_id(&v->t, "places"), n = 0;
  for (int i = places + 1; i < v->t.n && svg_inside(&v->t, i, places); i++)
    n += strcmp(v->t.element[i].text, text) == 0 && svg_has_class(&v->t, i, class);
  return n;
}

/* Names that are missing, of nodes that are not in a grid: as many as the heading says. */
static void assert_named(const view *v)
{
  const thr_frame *f = &v->p.frame;
  int missing = 0, said = 0;
  thr_places grid;
  ck_assert_int_eq(thr_places_find(&grid, f, (const double(*)[2])v->l.xy, v->l.median, NULL),
                   THR_OK);
  bool in_grid = thr_layout_to_scale(v->l.kind) && grid.n_columns;
  for (int n = 0; n < f->n_nodes; n++) {
    char name[48];
    thr_places_name(&grid, f, n, name);
    if (in_grid) {
      ck_assert_int_ge(times_written(v, grid.letter[grid.column[n]], "middle"), 1);
      ck_assert_int_ge(times_written(v, grid.number[grid.row[n]], "middle"), 1);
    } else {
      missing += times_written(v, name, "middle") == 0;
    }
  }
  thr_places_destroy(&grid);
  const char *words = strstr(v->svg, " no name for want of room");
  while (words && words[-1] != '>')
    words--;
  if (words) ck_assert_int_eq(sscanf(words, "%d place", &said), 1);
  ck_assert_int_eq(missing, said);
  ck_assert_int_le(missing * 25, f->n_nodes);
}

/* Which side of the middle between the panels' captions the middle of an element is on. */
static bool right_of(const view *v, double middle, int i)
{
  double at[2];
  middle_of(v, i, at);
  return at[0] > middle;
}

/* Names on the seam are written once in each panel, and so are the two labels of a cord that
 * crosses it. */
static void assert_panels(const view *v)
{
  int places = svg_by_id(&v->t, "places"), captions = 0;
  double middle = 0, at[2];
  if (!v->l.node) return;
  for (int i = places + 1; captions < 2; i++, captions++) {
    ck_assert_ptr_nonnull(strstr(v->t.element[i].text, "from "));
    middle_of(v, i, at);
    middle += 0.5 * at[0];
  }
  for (int p = v->l.n_nodes; p < v->l.n_points; p++) {
    char name[48];
    int sides[2] = {0, 0};
    thr_places_name(&(thr_places){0}, &v->p.frame, v->l.node[p], name);
    for (int i = places + 1; i < v->t.n && svg_inside(&v->t, i, places); i++)
      if (strcmp(v->t.element[i].text, name) == 0 && svg_has_class(&v->t, i, "seam"))
        sides[right_of(v, middle, i)]++;
    ck_assert_int_eq(sides[0], sides[1]);
    ck_assert_int_le(sides[0], 1);
  }
  for (int c = 0; c < v->p.n_cords; c++)
    for (int k = 1; k < v->p.cord[c].n_passes; k++) {
      char id[40];
      snprintf(id, sizeof id, "out-%s-%d", v->p.cord[c].id, k);
      int i = svg_by_id(&v->t, id);
      snprintf(id, sizeof id, "in-%s-%d", v->p.cord[c].id, k + 1);
      int j = svg_by_id(&v->t, id);
      if (i >= 0) ck_assert_int_ne(right_of(v, middle, i + 1), right_of(v, middle, j + 1));
      if (i >= 0) ck_assert(over_seam(v, c, k));
    }
}

START_TEST(every_pass_is_drawn_once_and_in_order)
{
  view v = view_of(drawn_plan(_i), 0);
  assert_passes(&v);
  view_destroy(&v);
}
END_TEST

START_TEST(tubes_lie_along_edges)
{
  thr_plan p = drawn_plan(_i);
  p.options.joint = THR_JOINT_TUBE;
  view v = view_of(p, 0);
  assert_passes(&v);
  assert_legible(&v);
  assert_apart(&v);
  view_destroy(&v);
}
END_TEST

/* The acceptance of the whole: what a maker counts is what is drawn. */
START_TEST(the_dome_has_49_pieces_or_84_tubes)
{
  for (int tube = 0; tube < 2; tube++) {
    thr_plan p = drawn_plan(0);
    p.options.joint = tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
    view v = view_of(p, 0);
    assert_pieces(&v);
    ck_assert_ptr_nonnull(
        strstr(v.svg, tube ? ">Cord A: 84 tubes, 96 passes<" : ">Cord A: 49 pieces, 96 passes<"));
    view_destroy(&v);
  }
}
END_TEST

START_TEST(what_is_written_is_legible)
{
  view v = view_of(drawn_plan(_i), 0);
  assert_legible(&v);
  assert_apart(&v);
  assert_named(&v);
  assert_panels(&v);
  view_destroy(&v);
}
END_TEST

START_TEST(small_pictures_stay_legible)
{
  static const double pitch[] = {3, 7, 12, 20};
  for (int k = 0; k < 4; k++) {
    view v = view_of(drawn_plan(_i), pitch[k]);
    assert_legible(&v);
    assert_panels(&v);
    assert_passes(&v);
    view_destroy(&v);
  }
}
END_TEST

/* Of several cords each number begins with its cord's letter: grey and colour-blind readers need no
 * colour. */
START_TEST(letters_tell_cords_apart)
{
  view v = view_of(pieces_of(shape_make(THR_MAKE_DOME, 7, 0), 8), 0);
  ck_assert_int_gt(v.p.n_cords, 6);
  for (int c = 0; c < v.p.n_cords; c++) {
    char id[40], want[40], line[40];
    snprintf(id, sizeof id, "n-%s-1", v.p.cord[c].id);
    snprintf(want, sizeof want, "%s:1", v.p.cord[c].id);
    snprintf(line, sizeof line, ">Cord %s: ", v.p.cord[c].id);
    int i = svg_by_id(&v.t, id);
    ck_assert_int_gt(i, 0);
    ck_assert_str_eq(v.t.element[i + 2].text, want);
    ck_assert_ptr_nonnull(strstr(v.svg, line));
  }
  view_destroy(&v);
}
END_TEST

/* More passes than can be followed one by one: lines, in a file of bounded size that says what it
 * leaves out. */
START_TEST(a_very_large_plan_is_lines)
{
  thr_err err = {0};
  thr_text svg = {0};
  thr_plan p = plan_of(shape_make(THR_MAKE_DOME, 105, 0), THR_ENDS_FEET, 1);
  thr_overview_options o = thr_overview_options_default();
  ck_assert_int_eq(thr_overview_svg(&p, &o, &svg, &err), THR_OK);
  ck_assert_uint_lt(svg.length, 3000000);
  ck_assert(strstr(svg.data, "are left out") && strstr(svg.data, "<g id=\"cord-A\"") &&
            strstr(svg.data, "id=\"ends\""));
  ck_assert(!strstr(svg.data, "id=\"A-1\"") && !strstr(svg.data, "data-piece"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("overview");
  ADD_EXAMPLES(s, 60, every_pass_is_drawn_once_and_in_order, N_DRAWN);
  ADD_EXAMPLES(s, 60, tubes_lie_along_edges, 6);
  ADD_TEST(s, 20, the_dome_has_49_pieces_or_84_tubes);
  ADD_EXAMPLES(s, 60, what_is_written_is_legible, N_DRAWN);
  ADD_EXAMPLES(s, 60, small_pictures_stay_legible, 11);
  ADD_TEST(s, 20, letters_tell_cords_apart);
  ADD_TEST(s, 60, a_very_large_plan_is_lines);
  return run_suite(s);
}
