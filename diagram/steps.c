#include "diagram/steps.h"

#include "diagram/copies.h"
#include "diagram/places.h"
#include "diagram/scene.h"
#include "diagram/svg.h"
#include "graph/vector.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 100, INDENT = 4, LABEL = 64 };
static const double AHEAD = 0.13962634015954636; /* rad, 8 degrees: to that side it is still ahead */
static const double PI = 3.14159265358979323846;

typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  const char *const *motion;
  thr_layout layout;
  thr_places places;
  double (*outward)[3]; /* [n_nodes] unit normal towards the viewer; 0 where none is known */
  char (*label)[LABEL]; /* [n_nodes] all different, without blanks */
  thr_copy *copy;       /* [n_cords] */
  int *held;            /* [n_edges] cords in the bead so far */
  int n_passes;
  thr_text *out;
} steps;

/* ---- names ---- */

typedef struct {
  const char *label;
  int node;
} named;

static int by_label(const void *a, const void *b)
{
  const named *p = a, *q = b;
  int order = strcmp(p->label, q->label);
  return order ? order : p->node - q->node;
}

/* Adds the node's number to each of those that share a label. */
static void tell_apart(steps *s, named *k)
{
  int n = s->f->n_nodes;
  for (int v = 0; v < n; v++)
    k[v] = (named){s->label[v], v};
  qsort(k, (size_t)n, sizeof *k, by_label);
  for (int i = 0, next; i < n; i = next) {
    for (next = i + 1; next < n && strcmp(k[next].label, k[i].label) == 0;)
      next++;
    for (int j = i; j < next && next - i > 1; j++) {
      char *label = s->label[k[j].node];
      size_t length = strlen(label);
      snprintf(label + length, LABEL - length, "#%d", k[j].node);
    }
  }
}

static thr_status name_nodes(steps *s, thr_err *err)
{
  named *k = thr_calloc((size_t)s->f->n_nodes, sizeof *k);
  if (!k) return thr_nomem(err);
  for (int v = 0; v < s->f->n_nodes; v++) {
    thr_places_name(&s->places, s->f, v, s->label[v]);
    for (char *c = s->label[v]; *c; c++)
      if (isspace((unsigned char)*c)) *c = '_';
  }
  tell_apart(s, k);
  free(k);
  return THR_OK;
}

/* "foot A1 (node 17)": the node's own name where it is called by its place. */
static void put_place(const steps *s, int v, thr_text *t)
{
  const char *own = s->f->name && s->f->name[v] ? s->f->name[v] : NULL;
  thr_text_printf(t, "%s%s", s->f->foot && s->f->foot[v] ? "foot " : "", s->label[v]);
  if (s->places.n_columns && own && strcmp(own, s->label[v]) != 0) thr_text_printf(t, " (node %.40s)", own);
}

/* ---- lines ---- */

/* Writes the prefix and then the words, broken at blanks; further lines begin below the first word. Destroys words. */
static void put_wrapped(steps *s, const char *prefix, thr_text *words)
{
  int indent = thr_scene_characters(prefix), column = indent;
  thr_text *t = s->out;
  thr_text_append(t, prefix);
  for (const char *w = words->data ? words->data : ""; *w;) {
    size_t length = strcspn(w, " ");
    int wide = 0;
    for (size_t i = 0; i < length; i++)
      wide += ((unsigned char)w[i] & 0xC0) != 0x80;
    if (column > indent && column + 1 + wide > COLUMNS) {
      thr_text_printf(t, "\n%*s", indent, "");
      column = indent;
    } else if (column > indent) {
      thr_text_append(t, " ");
      column++;
    }
    thr_text_append_bytes(t, w, length);
    column += wide;
    w += length + (w[length] == ' ');
  }
  thr_text_append(t, "\n");
  if (words->failed) t->failed = true;
  thr_text_destroy(words);
}

static void put_line(steps *s, const char *line)
{
  thr_text words = {0};
  thr_text_append(&words, line);
  put_wrapped(s, "", &words);
}

/* ---- turns ---- */

static bool has_sides(const steps *s)
{
  return !s->layout.crossings && !s->layout.capped && s->layout.kind != THR_LAYOUT_DRAWN;
}

/* Unit vector along half-edge h in space; false if it has no length. */
static bool direction(const thr_frame *f, int h, double d[3])
{
  const double *a = f->xyz[thr_tail(f, h)], *b = f->xyz[thr_head(f, h)];
  for (int i = 0; i < 3; i++)
    d[i] = b[i] - a[i];
  double length = sqrt(thr_dot(d, d));
  for (int i = 0; i < 3 && length > 0; i++)
    d[i] /= length;
  return length > 0;
}

/* Adds up what two edges that are neighbours around a node, counter-clockwise on paper, say about the side that one sees there.
 */
static void add_corner(const thr_frame *f, int h, int g, double sweep, double normal[3])
{
  double a[3], b[3], cross[3];
  if (!(sweep > 0 && sweep < PI - 1e-6) || !direction(f, h, a) || !direction(f, g, b)) return;
  thr_cross(a, b, cross);
  for (int i = 0; i < 3; i++)
    normal[i] += cross[i];
}

/* From how edges follow each other around the nodes on paper: which way faces the viewer there. */
static thr_status find_outward(steps *s, thr_err *err)
{
  const thr_frame *f = s->f;
  double *angle = thr_calloc(2 * (size_t)f->n_edges, sizeof *angle);
  int *around = thr_calloc(2 * (size_t)f->n_edges, sizeof *around);
  thr_status st = angle && around ? THR_OK : thr_nomem(err);
  for (int h = 0; h < 2 * f->n_edges && !st; h++) {
    const double *a = s->layout.xy[thr_tail(f, h)], *b = s->layout.xy[thr_head(f, h)];
    angle[h] = atan2(b[1] - a[1], b[0] - a[0]);
  }
  if (!st) st = thr_layout_around(f, angle, around, err);
  for (int v = 0; v < f->n_nodes && !st; v++) {
    int degree = thr_degree(f, v), *at = around + f->first[v];
    double *normal = s->outward[v];
    for (int i = 0; i < degree; i++) {
      int next = at[(i + 1) % degree];
      add_corner(f, at[i], next, thr_scene_sweep(angle[at[i]], angle[next]), normal);
    }
    double length = sqrt(thr_dot(normal, normal));
    for (int i = 0; i < 3; i++)
      normal[i] = length > 1e-6 ? normal[i] / length : 0;
  }
  free(angle);
  free(around);
  return st;
}

typedef enum { NOWHERE, LEFT, RIGHT, AHEAD_OVER } side;

/* To which side of the surface, seen from outside, pass out goes on from pass in; NOWHERE: that cannot be said. */
static side side_of(const steps *s, int in, int out)
{
  double a[3], b[3], cross[3], *n = s->outward[thr_tail(s->f, out)];
  if (!has_sides(s) || thr_dot(n, n) == 0 || !direction(s->f, in, a) || !direction(s->f, out, b)) return NOWHERE;
  thr_cross(a, b, cross);
  double turn = atan2(thr_dot(n, cross), thr_dot(a, b) - thr_dot(a, n) * thr_dot(b, n));
  if (fabs(turn) < AHEAD) return AHEAD_OVER;
  return fabs(turn) > PI - AHEAD ? NOWHERE : turn > 0 ? LEFT : RIGHT;
}

static void put_turn(const steps *s, int in, int out, double angle, thr_text *t)
{
  static const char *const word[] = {"turn", "turn left", "turn right", "over the curve"};
  if (out == (in ^ 1))
    thr_text_append(t, "turn back");
  else
    thr_text_printf(t, "%s %.0f degrees", word[side_of(s, in, out)], angle * 180 / PI);
}

/* "second", "third", "4th", "21st" */
static void ordinal(int n, char word[16])
{
  static const char *const end[] = {"th", "st", "nd", "rd"};
  int last = n % 10 < 4 && n / 10 % 10 != 1 ? n % 10 : 0;
  if (n == 2 || n == 3)
    snprintf(word, 16, n == 2 ? "second" : "third");
  else
    snprintf(word, 16, "%d%s", n, end[last]);
}

/* ---- paths ---- */

/* Does pass k of a cord go straight on from the one before? Then its angle is not needed. */
static bool is_straight(const steps *s, const thr_cord *c, int k, double *angle)
{
  *angle = k > 0 ? thr_turn_angle(s->f, c->half[k - 1], c->half[k]) : 0;
  return k > 0 && c->half[k] != (c->half[k - 1] ^ 1) && *angle < THR_STEPS_STRAIGHT;
}

/* One row: the passes from first on that go straight on through beads that hold as many cords. Returns the pass after it. */
static int put_row(steps *s, const thr_cord *c, int first)
{
  thr_text words = {0};
  char range[32], prefix[64], nth[16];
  double angle;
  int k = first, times = s->held[c->half[k] >> 1] + 1, digits = snprintf(range, sizeof range, "%d", c->n_passes);
  if (is_straight(s, c, k, &angle))
    thr_text_append(&words, "straight on");
  else if (k == 0)
    thr_text_append(&words, "go");
  else
    put_turn(s, c->half[k - 1], c->half[k], angle, &words);
  bool straight = is_straight(s, c, k, &angle);
  thr_text_printf(&words, " to %s", s->label[thr_head(s->f, c->half[k])]);
  s->held[c->half[k++] >> 1]++;
  for (; k < c->n_passes && is_straight(s, c, k, &angle) && s->held[c->half[k] >> 1] + 1 == times; k++) {
    if (k == first + 1 && !straight) thr_text_append(&words, ", straight on to");
    thr_text_printf(&words, " %s", s->label[thr_head(s->f, c->half[k])]);
    s->held[c->half[k] >> 1]++;
  }
  ordinal(times, nth);
  if (times > 1) thr_text_printf(&words, " (%s pass)", nth);
  if (k == first + 1)
    snprintf(range, sizeof range, "%d", k);
  else
    snprintf(range, sizeof range, "%d-%d", first + 1, k);
  snprintf(prefix, sizeof prefix, "[ ] %*s  ", 2 * digits + 1, range);
  put_wrapped(s, prefix, &words);
  return k;
}

static void put_rows(steps *s, const thr_cord *c)
{
  thr_text words = {0};
  char indent[INDENT + 1];
  int start = thr_cord_start(s->f, c), end = thr_cord_end(s->f, c);
  snprintf(indent, sizeof indent, "%*s", INDENT, "");
  thr_text_append(&words, "start at ");
  put_place(s, start, &words);
  put_wrapped(s, indent, &words);
  for (int k = 0; k < c->n_passes;)
    k = put_row(s, c, k);
  thr_text_append(&words, "the needle comes out at ");
  put_place(s, end, &words);
  if (start == end) thr_text_append(&words, ", where it began");
  put_wrapped(s, indent, &words);
}

/* ", 17 passes through 15 beads, 510.0 mm". A bead is counted at its first pass. */
static void put_measure(const steps *s, const thr_cord *c, int *seen, int mark, thr_text *t)
{
  char length[64];
  int beads = 0;
  for (int k = 0; k < c->n_passes; k++) {
    beads += seen[c->half[k] >> 1] != mark;
    seen[c->half[k] >> 1] = mark;
  }
  thr_svg_length(thr_cord_length(s->f, c), s->f->units, length);
  thr_text_printf(t, ", %d pass%s through %d bead%s, %s", c->n_passes, c->n_passes == 1 ? "" : "es", beads, beads == 1 ? "" : "s",
                  length);
}

/* ---- copies ---- */

/* Is every left turn of the path a right one of its copy, and the other way round? Not for copies threaded backwards, whose turns
 * come in the opposite order too. */
static bool is_reflected(const steps *s, int c)
{
  const thr_copy *copy = &s->copy[c];
  const thr_cord *cord = &s->plan->cord[c], *path = &s->plan->cord[copy->of];
  bool some = false;
  for (int k = 1; k < cord->n_passes && !copy->backward; k++) {
    int now = (copy->start + k) % path->n_passes, before = (copy->start + k - 1) % path->n_passes;
    side own = side_of(s, cord->half[k - 1], cord->half[k]), model = side_of(s, path->half[before], path->half[now]);
    if (own != LEFT && own != RIGHT) continue;
    if (own == model) return false;
    some |= model == LEFT || model == RIGHT;
  }
  return some;
}

static void put_copy(steps *s, int c)
{
  thr_text words = {0};
  char how[192];
  const thr_cord *cord = &s->plan->cord[c];
  thr_copies_words(s->plan, s->copy, c, s->motion, how);
  if (!s->motion || !s->motion[c]) {
    thr_text_printf(&words, "Cord %s: copy of path %d%s, in full:", cord->id, s->copy[c].path + 1, how);
    put_wrapped(s, "", &words);
    put_rows(s, cord);
    return;
  }
  thr_text_printf(&words, "Cord %s: the same%s%s: start at ", cord->id, how,
                  is_reflected(s, c) ? ", left and right turns exchanged" : "");
  put_place(s, thr_cord_start(s->f, cord), &words);
  thr_text_printf(&words, ", first to %s, end at ", s->label[thr_head(s->f, cord->half[0])]);
  put_place(s, thr_cord_end(s->f, cord), &words);
  put_wrapped(s, "[ ] ", &words);
  for (int k = 0; k < cord->n_passes; k++)
    s->held[cord->half[k] >> 1]++;
}

static void put_path(steps *s, int c, int n_paths, int *seen)
{
  thr_text words = {0};
  int copies = thr_copies_count(s->copy, s->plan->n_cords, c);
  thr_text_append(s->out, "\n");
  if (n_paths < s->plan->n_cords)
    thr_text_printf(&words, "Path %d of %d: cord ", s->copy[c].path + 1, n_paths);
  else
    thr_text_append(&words, "Cord ");
  thr_text_append(&words, s->plan->cord[c].id);
  put_measure(s, &s->plan->cord[c], seen, c + 1, &words);
  put_wrapped(s, "", &words);
  put_rows(s, &s->plan->cord[c]);
  if (!copies) return;
  thr_text_printf(s->out, "\nRepeat path %d with %d other cord%s:\n", s->copy[c].path + 1, copies, copies == 1 ? "" : "s");
  for (int i = 0; i < s->plan->n_cords; i++)
    if (i != c && s->copy[i].of == c) put_copy(s, i);
}

/* ---- the whole ---- */

static void put_heading(steps *s, int n_paths)
{
  thr_text words = {0};
  char length[64];
  double total = 0;
  int n = s->plan->n_cords;
  for (int c = 0; c < n; c++)
    total += thr_cord_length(s->f, &s->plan->cord[c]);
  thr_svg_length(total, s->f->units, length);
  thr_text_printf(&words, "Steps: %d cord%s", n, n == 1 ? "" : "s");
  if (n_paths < n) thr_text_printf(&words, ", %d path%s to learn", n_paths, n_paths == 1 ? "" : "s");
  thr_text_printf(&words, ", %d beads, %d passes, %s of cord", s->f->n_edges, s->n_passes, length);
  put_wrapped(s, "", &words);
  thr_text_append(s->out, "\n");
  put_line(s, thr_layout_words(s->layout.kind));
  put_line(s, !has_sides(s) ? "Turns have no left and right here: in this view beads cross that do not in space."
                            : "Left and right are meant as seen there, going with the needle. Over the curve: ahead, where the "
                              "surface bends.");
  put_line(s, "Rows: box to tick, passes, the nodes that they come to. Straight on: a turn of less than 15 degrees. Second pass: "
              "the beads hold a cord already.");
}

static thr_status prepare(steps *s, thr_err *err)
{
  const thr_plan *p = s->plan;
  thr_status st = thr_scene_check_cords(p, &s->n_passes, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;
  s->outward = thr_calloc((size_t)s->f->n_nodes, sizeof *s->outward);
  s->label = thr_calloc((size_t)s->f->n_nodes, sizeof *s->label);
  s->copy = thr_calloc((size_t)p->n_cords, sizeof *s->copy);
  s->held = thr_calloc((size_t)s->f->n_edges, sizeof *s->held);
  if (!s->outward || !s->label || !s->copy || !s->held) return thr_nomem(err);
  st = thr_layout_choose(&s->layout, s->f, NULL, 0, err);
  if (!st && thr_layout_to_scale(s->layout.kind))
    st = thr_places_find(&s->places, s->f, (const double(*)[2])s->layout.xy, s->layout.median, err);
  if (!st && has_sides(s)) st = find_outward(s, err);
  if (!st) st = name_nodes(s, err);
  if (!st) st = thr_copies_find(p, s->copy, err);
  return st;
}

thr_status thr_steps_text(const thr_plan *p, const char *const *motion, thr_text *out, thr_err *err)
{
  thr_text text = {0};
  steps s = {.plan = p, .f = &p->frame, .motion = motion, .out = &text};
  int *seen = thr_calloc((size_t)p->frame.n_edges, sizeof *seen);
  thr_status st = seen ? prepare(&s, err) : thr_nomem(err);
  if (st) goto done;
  int n_paths = thr_copies_paths(s.copy, p->n_cords);
  put_heading(&s, n_paths);
  for (int c = 0; c < p->n_cords; c++)
    if (s.copy[c].of == c) put_path(&s, c, n_paths, seen);
  if (!text.failed) thr_text_append_bytes(out, text.data, text.length);
  if (text.failed || out->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&text);
  thr_layout_destroy(&s.layout);
  thr_places_destroy(&s.places);
  free(s.outward);
  free(s.label);
  free(s.copy);
  free(s.held);
  free(seen);
  return st;
}
