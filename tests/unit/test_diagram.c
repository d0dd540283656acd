/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Diagrams: layouts measured and chosen, and the overview picture read back from its SVG text. */
#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FOUND = 20000 };

/* ---- frameworks and pictures ---- */

static thr_plan shape_plan(thr_shape shape, int size, int rings, thr_ends ends, int cover)
{
  thr_frame f = shape_make(shape, size, rings);
  thr_plan p = plan_simple(&f, ends, cover);
  thr_frame_destroy(&f);
  return p;
}

static thr_text coloured_picture(const thr_plan *p, thr_overview_colour colour)
{
  thr_text svg = {0};
  thr_err err = {0};
  thr_overview_options o = thr_overview_options_default();
  o.colour = colour;
  assert_ok(thr_overview_svg(p, &o, &svg, &err), &err);
  return svg;
}

static thr_text picture(const thr_plan *p)
{
  return coloured_picture(p, THR_COLOUR_CORD);
}

/* Cuts every cord into pieces of at most n passes, so that there are many cords, named A, B, .. */
static void cut_cords(thr_plan *p, int n)
{
  thr_cord *cut = NULL;
  int count = 0, capacity = 0;
  for (int c = 0; c < p->n_cords; c++) {
    for (int from = 0; from < p->cord[c].n_passes; from += n) {
      ck_assert_int_eq(thr_grow(&cut, count, &capacity, sizeof *cut, NULL), THR_OK);
      int passes = p->cord[c].n_passes - from < n ? p->cord[c].n_passes - from : n;
      cut[count] = (thr_cord){.n_passes = passes, .half = thr_calloc((size_t)passes, sizeof(int))};
      ck_assert_ptr_nonnull(cut[count].half);
      memcpy(cut[count].half, p->cord[c].half + from, (size_t)passes * sizeof(int));
      thr_cord_id(count, cut[count].id);
      count++;
    }
    free(p->cord[c].half);
  }
  free(p->cord);
  p->cord = cut;
  p->n_cords = count;
}

/* Is there an edge whose ends are one point? It turns nowhere. */
static bool has_point_edges(const thr_frame *f)
{
  for (int e = 0; e < f->n_edges; e++) {
    const double *a = f->xyz[f->edge[e][0]], *b = f->xyz[f->edge[e][1]];
    if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) return true;
  }
  return false;
}

/* ---- reading the SVG ---- */

/* Is the text well-formed: tags balanced, attributes quoted, only the five entities, printable
 * characters? */
static bool well_formed(const char *s)
{
  char stack[64][32];
  int depth = 0;
  while (*s) {
    if (*s == '&') {
      const char *entities[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"};
      int i = 0;
      while (i < 5 && strncmp(s, entities[i], strlen(entities[i])) != 0)
        i++;
      if (i == 5) return false;
    }
    if (*s == '>' || ((unsigned char)*s < 32 && *s != '\n')) return false;
    if (*s++ != '<') continue;
    char name[32];
    bool closing = *s == '/';
    size_t n = strcspn(s += closing, " />");
    if (n == 0 || n >= sizeof name) return false;
    memcpy(name, s, n);
    name[n] = '\0';
    char quote = 0, last = 0;
    for (; *s && (quote || *s != '>'); last = *s++)
      if (*s == '"')
        quote = quote ? 0 : '"';
      else if (*s == '<')
        return false;
    if (!*s++) return false;
    if (closing && (!depth || strcmp(stack[--depth], name) != 0)) return false;
    if (!closing && last != '/' && last != '?') {
      if (depth == 64) return false;
      memcpy(stack[depth++], name, sizeof name);
    }
  }
  return depth == 0;
}

static int by_text(const void *a, const void *b)
{
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Values of all attributes called name, sorted; free each and the list. */
static char **attributes(const char *svg, const char *name, int *count)
{
  char key[40], **list = thr_calloc(MAX_FOUND, sizeof *list);
  snprintf(key, sizeof key, " %s=\"", name);
  ck_assert_ptr_nonnull(list);
  *count = 0;
  for (const char *s = strstr(svg, key); s; s = strstr(s, key)) {
    s += strlen(key);
    size_t n = strcspn(s, "\"");
    ck_assert_int_lt(*count, MAX_FOUND);
    list[*count] = thr_calloc(n + 1, 1);
    ck_assert_ptr_nonnull(list[*count]);
    memcpy(list[(*count)++], s, n);
  }
  qsort(list, (size_t)*count, sizeof *list, by_text);
  return list;
}

static void free_list(char **list, int n)
{
  for (int i = 0; i < n; i++)
    free(list[i]);
  free(list);
}

static double attribute(const char *element, const char *name)
{
  char key[40];
  snprintf(key, sizeof key, " %s=\"", name);
  const char *s = strstr(element, key);
  ck_assert_ptr_nonnull(s);
  return strtod(s + strlen(key), NULL);
}

/* Start and end of the group with this id: it ends where the next line is "</g>". */
static void find_group(const char *svg, const char *id, const char **from, const char **to)
{
  char key[64];
  snprintf(key, sizeof key, "<g id=\"%s\"", id);
  *from = strstr(svg, key);
  ck_assert_ptr_nonnull(*from);
  *to = strstr(*from, "\n</g>");
  ck_assert_ptr_nonnull(*to);
}

static void assert_ids(const thr_plan *p, const char *svg)
{
  int n;
  char **id = attributes(svg, "id", &n), want[32];
  for (int i = 1; i < n; i++)
    ck_assert_str_ne(id[i - 1], id[i]);
  for (int c = 0; c < p->n_cords; c++)
    for (int i = 0; i < p->cord[c].n_passes; i++) {
      const char *key = want;
      snprintf(want, sizeof want, "%s-%d", p->cord[c].id, i + 1);
      ck_assert_msg(bsearch(&key, id, (size_t)n, sizeof *id, by_text) != NULL,
                    "pass %s is not drawn", want);
    }
  for (int i = 0; i < (p->options.joint == THR_JOINT_SOLID ? p->frame.n_nodes : p->frame.n_edges);
       i++) {
    const char *key = want;
    snprintf(want, sizeof want, "piece-%d", i);
    ck_assert_msg(bsearch(&key, id, (size_t)n, sizeof *id, by_text) != NULL, "%s is not drawn",
                  want);
  }
  free_list(id, n);
}

static void assert_text_legible(const char *svg)
{
  int n;
  char **size = attributes(svg, "font-size", &n);
  ck_assert_int_gt(n, 3);
  for (int i = 0; i < n; i++)
    ck_assert_double_ge(strtod(size[i], NULL), 7 * 25.4 / 72);
  free_list(size, n);
  /* sizes are mm only if the sheet is as large as its coordinates say */
  const char *box = strstr(svg, "viewBox=\"0 0 ");
  ck_assert_ptr_nonnull(box);
  char *end;
  ck_assert_double_eq(strtod(box + 13, &end), attribute(svg, "width"));
  ck_assert_double_eq(strtod(end, NULL), attribute(svg, "height"));
}

/* Numbers do not cover each other; returns how many there are. */
static int assert_pills_apart(const char *svg)
{
  const char *from, *to;
  static double pill[MAX_FOUND][4];
  int n = 0;
  find_group(svg, "numbers", &from, &to);
  to = strstr(from, "<g id=\"legend\""); /* the key shows a pill too */
  ck_assert_ptr_nonnull(to);
  for (const char *s = strstr(from, "class=\"pill\""); s && s < to && n < MAX_FOUND;
       s = strstr(s + 1, "class=\"pill\"")) {
    double x = attribute(s, "x"), y = attribute(s, "y");
    pill[n][0] = x, pill[n][1] = y, pill[n][2] = x + attribute(s, "width"),
    pill[n++][3] = y + attribute(s, "height");
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      ck_assert_msg(pill[i][2] <= pill[j][0] || pill[j][2] <= pill[i][0] ||
                        pill[i][3] <= pill[j][1] || pill[j][3] <= pill[i][1],
                    "numbers %d and %d overlap", i, j);
  return n;
}

/* Every colour of a legend swatch is one that its cord is drawn in, and every pass's colour is in
 * the legend. */
static void assert_legend_true(const thr_plan *p, const char *svg)
{
  for (int c = 0; c < p->n_cords; c++) {
    char key[80], colour[8] = "";
    const char *from, *to;
    int swatches = 0;
    snprintf(key, sizeof key, "cord-%s", p->cord[c].id);
    find_group(svg, key, &from, &to);
    snprintf(key, sizeof key, "data-for=\"%s\" stroke=\"", p->cord[c].id);
    for (const char *s = strstr(svg, key); s; s = strstr(s + 1, key), swatches++) {
      snprintf(colour, sizeof colour, "%.7s", s + strlen(key));
      const char *used = strstr(from, colour);
      ck_assert_msg(used && used < to, "cord %s is never %s", p->cord[c].id, colour);
    }
    ck_assert_int_gt(swatches, 0);
    for (const char *s = strstr(from, "\" stroke=\"#"); s && s < to;
         s = strstr(s + 1, "\" stroke=\"#")) {
      char want[100];
      bool rim = s - from >= 3 &&
                 !strncmp(s - 3, "rim", 3); /* a dark line round a pale one: in its swatch too */
      snprintf(want, sizeof want, "%s%.7s", rim ? "class=\"rim\" stroke=\"" : key, s + 10);
      ck_assert_msg(strstr(rim ? strstr(svg, key) : svg, want) != NULL,
                    "%s is missing in the legend", want);
    }
  }
}

/* Signs of sharp turns cover neither each other nor a number. */
static void assert_signs_apart(const char *svg)
{
  enum { MOST = 2000 };
  static double sign[MOST][3];
  const char *from, *to;
  int n = 0;
  find_group(svg, "sharp-turns", &from, &to);
  for (const char *s = strstr(from, "class=\"sharp\""); s && s < to;
       s = strstr(s + 1, "class=\"sharp\"")) {
    double x, top, half;
    ck_assert_int_lt(n, MOST);
    ck_assert_int_eq(sscanf(s, "class=\"sharp\" d=\"M%lf %lfl%lf", &x, &top, &half), 3);
    sign[n][0] = x, sign[n][1] = top + half, sign[n++][2] = half;
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < i; j++)
      ck_assert_double_ge(fmax(fabs(sign[i][0] - sign[j][0]), fabs(sign[i][1] - sign[j][1])),
                          2 * sign[i][2] - 0.03);
    find_group(svg, "numbers", &from, &to);
    to = strstr(from, "<g id=\"legend\"");
    for (const char *s = strstr(from, "class=\"pill\""); s && s < to;
         s = strstr(s + 1, "class=\"pill\"")) {
      double wide = 0.5 * attribute(s, "width"), high = 0.5 * attribute(s, "height"),
             reach = sign[i][2] - 0.03;
      ck_assert(fabs(attribute(s, "x") + wide - sign[i][0]) >= wide + reach ||
                fabs(attribute(s, "y") + high - sign[i][1]) >= high + reach);
    }
  }
}

/* With turning shown: every inner pass has two coloured pieces, an end without a turn one. */
static void assert_turning_sound(const thr_plan *p)
{
  thr_text svg = coloured_picture(p, THR_COLOUR_TURNING),
           again = coloured_picture(p, THR_COLOUR_TURNING);
  assert_same_text(&svg, &again);
  ck_assert(well_formed(svg.data));
  ck_assert_ptr_null(strstr(svg.data, "nan"));
  ck_assert_ptr_null(strstr(svg.data, "inf"));
  ck_assert_ptr_null(strstr(svg.data, "-0.00"));
  assert_ids(p, svg.data);
  assert_text_legible(svg.data);
  assert_signs_apart(svg.data);
  int pieces = 0, turns = 0;
  const char *legend = strstr(svg.data, "<g id=\"legend\"");
  for (const char *s = strstr(svg.data, "class=\"turn\""); s && s < legend;
       s = strstr(s + 1, "class=\"turn\""))
    pieces++;
  for (int c = 0; c < p->n_cords; c++)
    turns += p->options.ends == THR_ENDS_CLOSED ? p->cord[c].n_passes : p->cord[c].n_passes - 1;
  ck_assert_int_eq(pieces, 2 * turns);
  thr_text_destroy(&svg);
  thr_text_destroy(&again);
}

static void assert_picture_sound(const thr_plan *p)
{
  thr_text svg = picture(p), again = picture(p);
  assert_same_text(&svg, &again);
  ck_assert(well_formed(svg.data));
  ck_assert_ptr_null(strstr(svg.data, "nan"));
  ck_assert_ptr_null(strstr(svg.data, "inf"));
  ck_assert_ptr_null(strstr(svg.data, "-0.00"));
  assert_ids(p, svg.data);
  assert_text_legible(svg.data);
  assert_legend_true(p, svg.data);
  thr_text_destroy(&svg);
  thr_text_destroy(&again);
  if (!has_point_edges(&p->frame)) assert_turning_sound(p);
}

/* ---- overview ---- */

static thr_plan symmetric_dome(const char *group)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  thr_plan p = {0};
  thr_limits none = {0};
  thr_request o = options_for(THR_ENDS_FEET, 1);
  want(&o, "overlap,steps");
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "%s", group);
  ck_assert_int_eq(thr_symmetry_plan(&f, &o, &none, NULL, &p, NULL), THR_OK);
  thr_frame_destroy(&f);
  return p;
}

static bool has_id(const char *svg, const char *prefix, const char *cord, int pass)
{
  char key[64];
  snprintf(key, sizeof key, " id=\"%s%s-%d\"", prefix, cord, pass);
  return strstr(svg, key) != NULL;
}

/* Unique paths have hues in their order, a number on every pass and cover their copies, which are
 * pale, without numbers and with few arrows. */
START_TEST(copies_are_pale)
{
  thr_plan p = symmetric_dome(_i ? "C4" : "");
  const int *unique = p.symmetry.unique;
  thr_text svg = picture(&p);
  const char *end_of_copies = strstr(svg.data, "class=\"copy\""), *first_path = NULL;
  assert_picture_sound(&p);
  int paths = 0, hue[64] = {0};
  ck_assert_int_lt(p.symmetry.unique_paths, p.n_cords);
  ck_assert_int_le(p.n_cords, 64);
  for (int c = 0; c < p.n_cords; c++) {
    char id[40];
    const char *from, *to, *pale = thr_palette(unique[c] == c ? paths : hue[unique[c]]).pale;
    int arrows = 0, n = p.cord[c].n_passes;
    if (unique[c] == c) hue[c] = paths++;
    const char *strong = thr_palette(hue[unique[c]]).hex;
    snprintf(id, sizeof id, "cord-%s", p.cord[c].id);
    find_group(svg.data, id, &from, &to);
    bool copy = unique[c] != c;
    ck_assert_int_eq(strstr(from, "class=\"copy\"") == from + strlen("<g id=\"\" ") + strlen(id),
                     copy);
    const char *stroke = strstr(from, " stroke=\"") + 9;
    ck_assert_int_eq(strncmp(stroke, copy ? pale : strong, 7), 0);
    for (const char *s = strstr(from, "class=\"arrow\""); s && s < to;
         s = strstr(s + 1, "class=\"arrow\""))
      arrows++;
    ck_assert_int_eq(arrows, copy ? (n + 3) / 4 : n);
    for (int k = 1; k <= n; k++)
      ck_assert_int_eq(has_id(svg.data, "n-", p.cord[c].id, k), !copy);
    if (copy && from > end_of_copies) end_of_copies = from;
    if (!copy && (!first_path || from < first_path)) first_path = from;
  }
  ck_assert(first_path > end_of_copies);
  assert_pills_apart(svg.data);
  thr_text_destroy(&svg);
  svg = coloured_picture(&p, THR_COLOUR_TURNING);
  ck_assert_ptr_null(strstr(svg.data, "class=\"copy\""));
  ck_assert(has_id(svg.data, "n-", p.cord[p.n_cords - 1].id, 1));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

/* The legend has a line per copy, with the words that are given for it; of very many copies a part.
 */
START_TEST(the_legend_says_how_paths_repeat)
{
  thr_plan p = symmetric_dome("C4");
  const char *motion[8] = {NULL, "turned by a quarter", "<turned> & back", NULL};
  thr_text svg = {0};
  thr_overview_options o = thr_overview_options_default();
  ck_assert_int_eq(p.n_cords, 4);
  ck_assert_int_eq(thr_overview_svg(&p, &o, &svg, NULL), THR_OK);
  ck_assert_ptr_nonnull(strstr(svg.data, ">4 cords, 1 path to learn: 36 pieces, 68 passes<"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">Cord B: repeat A from foot "));
  ck_assert_ptr_null(strstr(svg.data, "no motion"));
  thr_text_destroy(&svg);
  o.motion = motion;
  ck_assert_int_eq(thr_overview_svg(&p, &o, &svg, NULL), THR_OK);
  ck_assert(well_formed(svg.data));
  ck_assert_ptr_nonnull(strstr(svg.data, ", turned by a quarter<"));
  ck_assert_ptr_nonnull(strstr(svg.data, ", &lt;turned&gt; &amp; back<"));
  ck_assert_ptr_nonnull(strstr(svg.data, ", renumbered by the framework"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(not_every_copy_has_a_line)
{
  thr_frame f = triangles_make(80);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_symmetry_record *r = &p.symmetry;
  size_t n = (size_t)f.n_nodes, cords = (size_t)p.n_cords;
  *r = (thr_symmetry_record){.present = true, .order = 80, .n_images = 80, .unique_paths = 1};
  r->image = calloc(80 * n, sizeof(int));
  r->unique = calloc(cords, sizeof(int));
  r->element = calloc(cords, sizeof(int));
  ck_assert(r->image && r->unique && r->element);
  for (int c = 0; c < 80; c++) { /* image c moves every triangle on by c */
    r->element[c] = c;
    for (int v = 0; v < f.n_nodes; v++)
      r->image[c * f.n_nodes + v] = (v + 3 * c) % f.n_nodes;
  }
  thr_text svg = picture(&p);
  ck_assert_ptr_nonnull(strstr(svg.data, ">and 31 more copies of A<"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">Cord B: repeat A from"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(a_dome_has_every_pass_numbered_once)
{
  thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_plan p = shape_plan(THR_MAKE_DOME, 7, 0, ends[_i], 1);
  assert_picture_sound(&p);
  thr_text svg = picture(&p);
  ck_assert_int_eq(assert_pills_apart(svg.data), p.cord[0].n_passes);
  ck_assert_ptr_nonnull(strstr(svg.data, "Plan, seen from above"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">S</text>"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">E</text>"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(many_shapes_are_drawn_soundly)
{
  static const struct {
    thr_shape shape;
    int size, rings, cover;
  } table[] = {{THR_MAKE_DOME, 12, 0, 1},    {THR_MAKE_DOME, 2, 0, 1},
               {THR_MAKE_DOME, 5, 0, 4},     {THR_MAKE_TUBE, 10, 5, 1},
               {THR_MAKE_SPHERE, 2, 0, 1},   {THR_MAKE_GEODESIC, 3, 0, 1},
               {THR_MAKE_HONEYCOMB, 3, 0, 2}};
  thr_plan p = shape_plan(table[_i].shape, table[_i].size, table[_i].rings, THR_ENDS_CLOSED,
                          table[_i].cover);
  assert_picture_sound(&p);
  thr_text svg = picture(&p);
  assert_pills_apart(svg.data);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(many_cords_are_told_apart)
{
  thr_plan p = shape_plan(THR_MAKE_DOME, 7, 0, THR_ENDS_CLOSED, 1);
  cut_cords(&p, 5);
  p.options.ends = THR_ENDS_ANY;
  ck_assert_int_gt(p.n_cords, 12);
  assert_picture_sound(&p);
  thr_text svg = picture(&p);
  assert_pills_apart(svg.data);
  ck_assert_ptr_nonnull(strstr(svg.data, ">SA</text>"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">EB</text>"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">A:5</text>"));
  ck_assert_ptr_nonnull(strstr(svg.data, "stroke-dasharray"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(odd_frameworks_do_not_crash)
{
  rng r = rng_make(71);
  thr_frame f[] = {path_make(2),           path_make(40),
                   ring_make(3),           star_make(90),
                   wheel_make(12),         triangles_make(9),
                   solid_make(CUBE),       random_frame(&r, 30, 60, LENGTHS_EUCLID),
                   solid_make(ICOSAHEDRON)};
  for (int i = 0; i < 9; i++) {
    for (int turned = 0; turned < 2; turned++) {
      thr_plan p = plan_simple(&f[i], THR_ENDS_CLOSED, 1 + turned);
      /* second time as a flat card on edge, then as a point cloud on the z axis */
      for (int v = 0; v < f[i].n_nodes && turned; v++)
        p.frame.xyz[v][i % 2] = 0, p.frame.xyz[v][1] *= i % 3;
      assert_picture_sound(&p);
      thr_plan_destroy(&p);
    }
    thr_frame_destroy(&f[i]);
  }
}
END_TEST

START_TEST(hostile_names_stay_text)
{
  thr_plan p = shape_plan(THR_MAKE_HONEYCOMB, 1, 0, THR_ENDS_CLOSED, 1);
  const char *bad[] = {"</text><script>", "\"'&amp;", "\xff\xfe\xc3", "\x01\x1b[31m",
                       "\xed\xa0\x80",    "",         "\xef\xbf\xbf", "B\xc3\xa4r"};
  name_nodes(&p.frame, bad, 8);
  snprintf(p.frame.units, sizeof p.frame.units, "<&>");
  snprintf(p.cord[0].id, sizeof p.cord[0].id, "bead\"<");
  thr_text svg = {0};
  thr_overview_options o = thr_overview_options_default();
  o.title = "a <b> & \"c\" \xc0\xaf";
  ck_assert_int_eq(thr_overview_svg(&p, &o, &svg, NULL), THR_OK);
  ck_assert(well_formed(svg.data));
  ck_assert_ptr_null(strstr(svg.data, "<script"));
  ck_assert_ptr_nonnull(strstr(svg.data, "a &lt;b&gt; &amp; &quot;c&quot;"));
  ck_assert_ptr_nonnull(strstr(svg.data, "<g id=\"cord-A\""));
  for (const unsigned char *s = (const unsigned char *)svg.data; *s; s++)
    ck_assert(*s != 0xff && *s != 0xc0 && *s != 0xed);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(numbers_thin_out_with_the_pitch)
{
  thr_plan p = shape_plan(THR_MAKE_DOME, 7, 0, THR_ENDS_CLOSED, 1);
  static const struct {
    double pitch;
    const char *words;
  } table[] = {{20, "Every pass is numbered"},
               {12, "Every 5th pass"},
               {8, "Every 10th pass"},
               {3, "Every 50th pass"}};
  for (int i = 0; i < 4; i++) {
    thr_overview_options o = thr_overview_options_default();
    thr_text svg = {0};
    o.pitch_mm = table[i].pitch;
    ck_assert_int_eq(thr_overview_svg(&p, &o, &svg, NULL), THR_OK);
    ck_assert_ptr_nonnull(strstr(svg.data, table[i].words));
    assert_text_legible(svg.data);
    assert_pills_apart(svg.data);
    thr_text_destroy(&svg);
  }
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(a_large_dome_stays_within_a0)
{
  thr_frame f = grid_make(70, 70);
  thr_plan p = {.frame = f, .n_cords = 1, .cord = thr_calloc(1, sizeof(thr_cord))};
  ck_assert_ptr_nonnull(p.cord);
  /* there and back along the first row is enough */
  p.cord[0] = (thr_cord){.id = "A", .n_passes = 2, .half = thr_calloc(2, sizeof(int))};
  ck_assert_ptr_nonnull(p.cord[0].half);
  p.cord[0].half[1] = 1;
  thr_text svg = picture(&p);
  ck_assert_double_le(attribute(svg.data, "width"), 1189);
  ck_assert_double_le(attribute(svg.data, "height"), 1189);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(broken_plans_are_refused)
{
  thr_plan p = shape_plan(THR_MAKE_DOME, 3, 0, THR_ENDS_CLOSED, 1);
  thr_overview_options o = thr_overview_options_default();
  thr_text svg = {0};
  int keep = p.cord[0].half[3];
  const int wrong[] = {-1, 2 * p.frame.n_edges, keep ^ 1};
  for (int i = 0; i < 3; i++) {
    thr_err err = {0};
    p.cord[0].half[3] = wrong[i];
    assert_status(thr_overview_svg(&p, &o, &svg, &err), THR_EINPUT, &err, "cord A: pass");
  }
  p.cord[0].half[3] = keep;
  const double pitch[] = {1, 500, NAN, -3};
  for (int i = 0; i < 4; i++) {
    thr_err err = {0};
    o.pitch_mm = pitch[i];
    assert_status(thr_overview_svg(&p, &o, &svg, &err), THR_EINPUT, &err, "pitch");
  }
  ck_assert_int_eq((int)svg.length, 0);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(every_allocation_may_fail)
{
  thr_plan p = _i == 2   ? symmetric_dome("C4")
               : _i == 3 ? shape_plan(THR_MAKE_SPHERE, 2, 0, THR_ENDS_CLOSED, 1)
                         : shape_plan(THR_MAKE_TUBE, 3, 2, THR_ENDS_CLOSED, 1);
  thr_overview_options o = thr_overview_options_default();
  thr_status st = THR_ENOMEM;
  o.colour = _i == 1 ? THR_COLOUR_TURNING : THR_COLOUR_CORD;
  for (long k = 1; st != THR_OK; k++) {
    thr_text svg = {0};
    ck_assert_int_lt((int)k, 5000);
    thr_alloc_fail_at(k);
    st = thr_overview_svg(&p, &o, &svg, NULL);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_int_eq(st, THR_ENOMEM);
      ck_assert_int_eq((int)svg.length, 0);
    }
    thr_text_destroy(&svg);
  }
  thr_plan_destroy(&p);
}
END_TEST

/* ---- layouts ---- */

static double turn(const double *a, const double *b, const double *c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Proper crossings by testing all pairs; *close tells of a pair that is so near to touching that
 * opinions may differ. */
static long crossings_by_pairs(const thr_frame *f, const thr_layout *l, bool *close)
{
  long count = 0;
  *close = false;
  for (int e = 0; e < f->n_edges; e++)
    for (int d = 0; d < e; d++) {
      const int *p = f->edge[e], *q = f->edge[d];
      const double *a = l->xy[p[0]], *b = l->xy[p[1]], *c = l->xy[q[0]], *h = l->xy[q[1]];
      if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) continue;
      double t[4] = {turn(a, b, c), turn(a, b, h), turn(c, h, a), turn(c, h, b)};
      if (t[0] * t[1] < 0 && t[2] * t[3] < 0) {
        count++;
        continue;
      }
      double near = 0.021 * l->median;
      const double *end[4] = {c, h, a, b}, *from[4] = {a, a, c, c}, *to[4] = {b, b, h, h};
      for (int i = 0; i < 4; i++) {
        double dx = to[i][0] - from[i][0], dy = to[i][1] - from[i][1];
        double s =
            ((end[i][0] - from[i][0]) * dx + (end[i][1] - from[i][1]) * dy) / (dx * dx + dy * dy);
        s = s < 0 ? 0 : s > 1 ? 1 : s;
        *close |= hypot(from[i][0] + s * dx - end[i][0], from[i][1] + s * dy - end[i][1]) < near;
      }
    }
  return count;
}

/* Pairs of edges at one node that leave it within about a degree. */
static bool has_fold(const thr_frame *f, const thr_layout *l)
{
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      for (int j = f->first[v]; j < i; j++) {
        const double *o = l->xy[v], *a = l->xy[thr_head(f, f->half[i])],
                     *b = l->xy[thr_head(f, f->half[j])];
        double dot = (a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1]);
        if (dot > 0 && fabs(turn(o, a, b)) < 0.02 * dot) return true;
        if (hypot(a[0] - o[0], a[1] - o[1]) < 0.021 * l->median) return true;
      }
  return false;
}

START_TEST(crossings_agree_with_all_pairs)
{
  int compared = 0;
  for (uint64_t seed = 1; seed <= 400; seed++) {
    rng r = rng_make(seed * 977 + 5);
    thr_frame f = random_frame(&r, rng_between(&r, 4, 24), rng_between(&r, 0, 12), LENGTHS_EQUAL);
    double(*xy)[2] = thr_calloc((size_t)f.n_nodes, sizeof *xy);
    thr_layout l = {0};
    bool close;
    ck_assert_ptr_nonnull(xy);
    for (int v = 0; v < f.n_nodes; v++) {
      xy[v][0] = rng_unit(&r) * (seed % 3 ? 1 : 30);
      xy[v][1] = rng_unit(&r);
    }
    ck_assert_int_eq(thr_layout_adopt(&l, &f, (const double(*)[2])xy, NULL), THR_OK);
    long pairs = crossings_by_pairs(&f, &l, &close);
    if (!close && !has_fold(&f, &l)) {
      ck_assert_int_eq((int)l.crossings, (int)pairs);
      compared++;
    }
    thr_layout_destroy(&l);
    thr_frame_destroy(&f);
    free(xy);
  }
  ck_assert_int_gt(compared, 60);
}
END_TEST

START_TEST(shapes_find_a_layout_without_crossings)
{
  static const struct {
    thr_shape shape;
    int size, rings;
    thr_layout_kind kind;
  } table[] = {{THR_MAKE_DOME, 7, 0, THR_LAYOUT_PLAN},
               {THR_MAKE_HONEYCOMB, 4, 0, THR_LAYOUT_PLAN},
               {THR_MAKE_TUBE, 12, 7, THR_LAYOUT_UNROLLED_Z},
               {THR_MAKE_GEODESIC, 4, 0, THR_LAYOUT_UNROLLED_Z},
               {THR_MAKE_SPHERE, 2, 0, THR_LAYOUT_PANELS},
               {THR_MAKE_SPHERE, 5, 0, THR_LAYOUT_PANELS}};
  thr_frame f = shape_make(table[_i].shape, table[_i].size, table[_i].rings);
  thr_layout l = {0};
  ck_assert_int_eq(thr_layout_choose(&l, &f, NULL, 0, NULL), THR_OK);
  ck_assert_int_eq((int)l.crossings, 0);
  ck_assert_int_eq(l.squeezed, 0);
  ck_assert_int_eq(l.kind, table[_i].kind);
  thr_layout_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(layouts_show_the_outside)
{
  /* a triangle at the crown, counter-clockwise from above, stays so in every layout seen from above
   */
  static const thr_layout_kind kinds[] = {THR_LAYOUT_PLAN, THR_LAYOUT_UNROLLED_Z, THR_LAYOUT_SPREAD,
                                          THR_LAYOUT_PLANE};
  thr_frame f = shape_make(THR_MAKE_GEODESIC, 3, 0);
  int top = 0;
  for (int v = 0; v < f.n_nodes; v++)
    if (f.xyz[v][2] > f.xyz[top][2]) top = v;
  for (int k = 0; k < 4; k++) {
    thr_layout l = {0};
    ck_assert_int_eq(thr_layout_make(&l, &f, kinds[k], NULL), THR_OK);
    for (int i = f.first[top]; i + 1 < f.first[top + 1]; i++) {
      int a = thr_head(&f, f.half[i]), b = thr_head(&f, f.half[i + 1]);
      double above = turn(f.xyz[top], f.xyz[a], f.xyz[b]);
      if (fabs(above) > 1e-6)
        ck_assert_msg(above * turn(l.xy[top], l.xy[a], l.xy[b]) > 0, "mirrored: layout %d",
                      (int)kinds[k]);
    }
    thr_layout_destroy(&l);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(an_extra_layout_is_used_only_if_better)
{
  thr_frame f = solid_make(CUBE);
  thr_layout best = {0}, tangle = {0}, again = {0};
  double xy[8][2];
  for (int v = 0; v < 8; v++)
    xy[v][0] = v * 3 % 8, xy[v][1] = v * 5 % 7;
  ck_assert_int_eq(thr_layout_choose(&best, &f, NULL, 0, NULL), THR_OK);
  ck_assert_int_eq(thr_layout_adopt(&tangle, &f, (const double(*)[2])xy, NULL), THR_OK);
  ck_assert_int_eq(thr_layout_choose(&again, &f, &tangle, 1, NULL), THR_OK);
  ck_assert_int_eq(again.kind, best.kind);
  thr_layout_destroy(&again);
  tangle.crossings = 0, tangle.squeezed = 0, tangle.ratio = 2;
  ck_assert_int_eq(thr_layout_choose(&again, &f, &tangle, 1, NULL), THR_OK);
  ck_assert_int_eq(again.kind, THR_LAYOUT_DRAWN);
  xy[3][1] = INFINITY;
  thr_layout_destroy(&tangle);
  ck_assert_int_eq(thr_layout_adopt(&tangle, &f, (const double(*)[2])xy, NULL), THR_EINPUT);
  thr_layout_destroy(&best);
  thr_layout_destroy(&again);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(seven_thousand_edges_are_measured_at_once)
{
  thr_frame f = grid_make(60, 60);
  thr_layout l = {0};
  ck_assert_int_eq(thr_layout_make(&l, &f, THR_LAYOUT_PLAN, NULL), THR_OK);
  ck_assert_int_eq((int)l.crossings, 0);
  ck_assert_double_eq_tol(l.ratio, 1, 1e-9);
  thr_layout_destroy(&l);
  /* all in one line: everything touches, and still it ends */
  ck_assert_int_eq(thr_layout_make(&l, &f, THR_LAYOUT_FRONT, NULL), THR_OK);
  ck_assert(l.crossings > 1000 || l.estimated);
  thr_layout_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("diagram");
  ADD_LOOP(s, 20, a_dome_has_every_pass_numbered_once, 0, 3);
  ADD_EXAMPLES(s, 30, many_shapes_are_drawn_soundly, 7);
  ADD_TEST(s, 20, many_cords_are_told_apart);
  ADD_LOOP(s, 20, copies_are_pale, 0, 2);
  ADD_TEST(s, 20, the_legend_says_how_paths_repeat);
  ADD_TEST(s, 20, not_every_copy_has_a_line);
  ADD_TEST(s, 60, odd_frameworks_do_not_crash);
  ADD_TEST(s, 20, hostile_names_stay_text);
  ADD_TEST(s, 20, numbers_thin_out_with_the_pitch);
  ADD_TEST(s, 30, a_large_dome_stays_within_a0);
  ADD_TEST(s, 20, broken_plans_are_refused);
  ADD_EXAMPLES(s, 60, every_allocation_may_fail, 4);
  ADD_TEST(s, 30, crossings_agree_with_all_pairs);
  ADD_LOOP(s, 20, shapes_find_a_layout_without_crossings, 0, 6);
  ADD_TEST(s, 20, layouts_show_the_outside);
  ADD_TEST(s, 20, an_extra_layout_is_used_only_if_better);
  ADD_TEST(s, 30, seven_thousand_edges_are_measured_at_once);
  return run_suite(s);
}
