/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps in words: read back row by row into half-edges and compared with the plan; sides
 * against what is outside in space. */
#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "symmetry/group/group.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/sample_plans.h"

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINE = 4000 };

/* ---- plans ---- */

/* Words for every copy, but every so many without a motion. */
static const char **words_for(const thr_plan *p, int every)
{
  const char **motion = calloc((size_t)p->n_cords, sizeof *motion);
  ck_assert_ptr_nonnull(motion);
  for (int c = 0; c < p->n_cords; c++)
    if ((c + 1) % every) motion[c] = "moved";
  return motion;
}

static thr_text steps_of(const thr_plan *p, const char *const *motion)
{
  thr_text t = {0};
  thr_err err = {0};
  assert_ok(thr_steps_text(p, motion, 0, 1, NULL, &t, &err), &err);
  return t;
}

/* ---- reading back ---- */

typedef struct {
  const thr_plan *p;
  char (*label)[48]; /* [n_nodes] what the overview calls the nodes */
  const char *next;  /* text that is left */
  char line[MOST_LINE];
  int *cord,
      *row;   /* [pieces] where it was picked up: -1 = nowhere yet; row 0 = where the cord starts */
  int **half; /* [n_cords] as read back, or NULL */
} reader;

static int pieces_in(const thr_plan *p)
{
  return p->options.joint == THR_JOINT_SOLID ? p->frame.n_nodes : p->frame.n_edges;
}

static reader reader_make(const thr_plan *p, const char *text)
{
  thr_layout l;
  thr_places places = {0};
  reader r = {.p = p, .next = text, .label = calloc((size_t)p->frame.n_nodes, sizeof *r.label)};
  r.cord = calloc((size_t)pieces_in(p), sizeof *r.cord);
  r.row = calloc((size_t)pieces_in(p), sizeof *r.row);
  r.half = calloc((size_t)p->n_cords, sizeof *r.half);
  ck_assert(r.label && r.cord && r.row && r.half);
  for (int i = 0; i < pieces_in(p); i++)
    r.cord[i] = -1;
  ck_assert_int_eq(thr_layout_choose(&l, &p->frame, NULL, 0, NULL), THR_OK);
  if (thr_layout_to_scale(l.kind))
    ck_assert_int_eq(thr_places_find(&places, &p->frame, (const double(*)[2])l.xy, l.median, NULL),
                     THR_OK);
  for (int v = 0; v < p->frame.n_nodes; v++)
    thr_places_name(&places, &p->frame, v, r.label[v]);
  thr_places_destroy(&places);
  thr_layout_destroy(&l);
  return r;
}

static void reader_destroy(reader *r)
{
  for (int c = 0; c < r->p->n_cords; c++)
    free(r->half[c]);
  free(r->half);
  free(r->cord);
  free(r->row);
  free(r->label);
}

/* The next line with its continuations joined; false at the end. Each is at most 100 columns and
 * ends without a blank. */
static bool next_line(reader *r)
{
  size_t n = 0;
  if (!*r->next) return false;
  do {
    size_t length = strcspn(r->next, "\n"), blanks = n ? strspn(r->next, " ") : 0;
    ck_assert_int_eq(r->next[length], '\n');
    ck_assert_uint_le(length, 100);
    ck_assert(length == 0 || r->next[length - 1] != ' ');
    ck_assert_uint_lt(n + length + 2, MOST_LINE);
    if (n) r->line[n++] = ' ';
    memcpy(r->line + n, r->next + blanks, length - blanks);
    n += length - blanks;
    r->next += length + 1;
  } while (n && strncmp(r->next, "    ", 4) == 0 && strncmp(r->next, "    start", 9) != 0 &&
           strncmp(r->next, "    the n", 9) != 0);
  r->line[n] = '\0';
  return true;
}

/* The node whose label begins the text; *text moves behind it. */
static int read_node(const reader *r, const char **text)
{
  size_t length = strcspn(*text, " ,");
  for (int v = 0; v < r->p->frame.n_nodes; v++)
    if (strlen(r->label[v]) == length && strncmp(r->label[v], *text, length) == 0) {
      *text += length;
      return v;
    }
  ck_abort_msg("no node is called as in: %s", *text);
  return -1;
}

/* "foot A1 (node 17)": foot exactly where one is. */
static int read_place(const reader *r, const char *text)
{
  bool foot = strncmp(text, "foot ", 5) == 0;
  text += foot ? 5 : 0;
  int v = read_node(r, &text);
  ck_assert_int_eq(r->p->frame.foot[v], foot);
  if (strncmp(text, " (node ", 7) == 0)
    ck_assert_int_eq(strncmp(text + 7, r->p->frame.name[v], strlen(r->p->frame.name[v])), 0);
  return v;
}

static int cord_of(const reader *r, const char *text)
{
  size_t length = strcspn(text, ",: ");
  for (int c = 0; c < r->p->n_cords; c++)
    if (strlen(r->p->cord[c].id) == length && strncmp(r->p->cord[c].id, text, length) == 0)
      return c;
  ck_abort_msg("no such cord: %s", text);
  return -1;
}

static int half_between(const thr_frame *f, int a, int b)
{
  int e = thr_frame_edge_between(f, a, b);
  ck_assert_int_ge(e, 0);
  return 2 * e + (f->edge[e][1] == a);
}

/* ---- what a novice holds, who has the text alone ---- */

/* The node whose label begins the text and is followed by one of these; the longest if there are
 * several. *text moves behind it.
 */
static int read_name(const reader *r, const char **text, const char *followers)
{
  int found = -1;
  size_t longest = 0;
  for (int v = 0; v < r->p->frame.n_nodes; v++) {
    size_t length = strlen(r->label[v]);
    if (length <= longest || strncmp(r->label[v], *text, length) != 0 ||
        !strchr(followers, (*text)[length]))
      continue;
    found = v;
    longest = length;
  }
  ck_assert_msg(found >= 0, "no node is called as in: %s", *text);
  *text += longest;
  return found;
}

/* A piece's name: of a node, or of an edge by its two places. */
static int read_piece(const reader *r, const char **text)
{
  if (r->p->options.joint == THR_JOINT_SOLID) return read_name(r, text, " ),");
  int a = read_name(r, text, "-");
  *text += 1;
  int b = read_name(r, text, " ),:");
  int e = thr_frame_edge_between(&r->p->frame, a, b);
  ck_assert_int_ge(e, 0);
  return e;
}

static bool skip(const char **text, const char *word)
{
  size_t n = strlen(word);
  if (strncmp(*text, word, n) != 0) return false;
  *text += n;
  return true;
}

/* "X-10 (B5)", "tube 3 (A1-A2)", "24 (an X)", "24 (with 5 arms)": the piece, taken from the box. */
static int pick_up(reader *r, const char **text, int c, int row)
{
  const char *open = strchr(*text, '('), *inside = open + 1;
  ck_assert_ptr_nonnull(open);
  bool alone = strncmp(open, "(an ", 4) == 0 || strncmp(open, "(a ", 3) == 0 ||
               strncmp(open, "(with ", 6) == 0;
  if (!strstr(*text, " (") || strstr(*text, " (") > strstr(*text, ": "))
    alone = true; /* a tube of its own kind */
  int piece = read_piece(r, alone ? text : &inside);
  *text = strstr(alone ? *text : inside, ": ");
  ck_assert_ptr_nonnull(*text);
  ck_assert_int_eq(r->cord[piece], -1);
  r->cord[piece] = c;
  r->row[piece] = row;
  return piece;
}

/* "F5, on cord A since its row 3", "F5, on the cord since its start": a piece that was picked up
 * there. */
static int find_held(reader *r, const char **text, int c)
{
  int piece = read_piece(r, text), cord = c;
  if (!skip(text, ", on the cord since ")) {
    ck_assert_msg(skip(text, ", on cord "), "%s", *text);
    cord = cord_of(r, *text);
    *text = strstr(*text, " since its ") + 11;
    ck_assert_int_ne(cord, c);
  } else
    skip(text, "its ");
  ck_assert_int_eq(r->cord[piece], cord);
  ck_assert_int_eq(r->row[piece], skip(text, "row ") ? atoi(*text) : 0);
  *text = strstr(*text, ": ");
  ck_assert_ptr_nonnull(*text);
  return piece;
}

/* One row of a cord, the n-th pass being the latest so far; from and due: the piece before and that
 * whose arm the cord left by. Fills half[n] if the row has a pass. */
static void read_row(reader *r, int c, int *half, int *n, int *from, int *due)
{
  const thr_frame *f = &r->p->frame;
  bool rigid = r->p->options.joint == THR_JOINT_SOLID;
  const char *s = r->line + 4;
  s += strspn(s, " ");
  int row = *s == 'S' ? 0 : atoi(s);
  ck_assert_int_eq(row, rigid && *from < 0 ? 0 : *n + 1);
  s += strcspn(s, " ");
  s += strspn(s, " ");
  bool starts = skip(&s, "start, ") || strncmp(s, "start in ", 9) == 0, back = false;
  if (!skip(&s, "start in ")) back = skip(&s, "back ");
  skip(&s, "through ");
  ck_assert_int_eq(starts, row == 0);
  int piece = skip(&s, "pick up ") ? pick_up(r, &s, c, row) : find_held(r, &s, c), in, out = -1;
  ck_assert(skip(&s, ": "));
  if (!rigid) {
    ck_assert(skip(&s, "in at "));
    in = read_name(r, &s, ",");
    ck_assert(skip(&s, ", out at "));
    out = read_name(r, &s, "");
    half[*n] = half_between(f, in, out);
    ck_assert_int_eq(half[*n] >> 1, piece);
    if (*n) ck_assert_int_eq(in, thr_head(f, half[*n - 1]));
    ck_assert(!back || r->cord[piece] >= 0);
    ++*n;
    return;
  }
  if (!starts) {
    ck_assert(skip(&s, "in from "));
    in = read_name(r, &s, ",");
    ck_assert(skip(&s, ", "));
    ck_assert(in == *from && piece == *due);
    half[(*n)++] = half_between(f, in, piece);
  }
  if (skip(&s, "out to "))
    out = read_name(r, &s, "");
  else
    ck_assert_str_eq(s, "here the end comes out");
  *from = piece;
  *due = out;
}

/* The lines of a path that is listed, up to where the needle comes out. */
static void read_path(reader *r, int c)
{
  const thr_cord *cord = &r->p->cord[c];
  int n = 0;
  r->half[c] = calloc((size_t)cord->n_passes, sizeof **r->half);
  ck_assert_ptr_nonnull(r->half[c]);
  ck_assert(next_line(r));
  ck_assert_int_eq(strncmp(r->line, "    start at ", 13), 0);
  int start = read_place(r, r->line + 13), from = -1, due = -1;
  while (next_line(r) && strncmp(r->line, "[ ] ", 4) == 0) {
    read_row(r, c, r->half[c], &n, &from, &due);
    ck_assert_int_le(n, cord->n_passes);
  }
  ck_assert_int_eq(n, cord->n_passes);
  ck_assert_int_eq(due, -1);
  ck_assert_int_eq(start, thr_tail(&r->p->frame, r->half[c][0]));
  ck_assert_int_eq(strncmp(r->line, "    the needle comes out at ", 28), 0);
  int end = read_place(r, r->line + 28);
  ck_assert_int_eq(end, thr_head(&r->p->frame, r->half[c][n - 1]));
  ck_assert_int_eq(strstr(r->line, ", where it began") != NULL, start == end);
}

/* A copy picks up what is not held: its rows are numbered as they would be if they were listed. */
static void thread_copy(reader *r, int c)
{
  bool rigid = r->p->options.joint == THR_JOINT_SOLID;
  for (int row = rigid ? 0 : 1; row <= r->p->cord[c].n_passes; row++) {
    int h = r->half[c][row ? row - 1 : 0];
    int piece = !rigid ? h >> 1 : row ? thr_head(&r->p->frame, h) : thr_tail(&r->p->frame, h);
    if (r->cord[piece] >= 0) continue;
    r->cord[piece] = c;
    r->row[piece] = row;
  }
}

/* "Cord B: the same, moved, threaded backwards, beginning with its pass 3: start at A1, first to
 * A2, end at A6": the image of what was read of its path, as the words say. */
static void read_copy(reader *r)
{
  const thr_frame *f = &r->p->frame;
  int c = cord_of(r, r->line + 9), u = r->p->symmetry.unique[c], n = r->p->cord[c].n_passes;
  const int *image = r->p->symmetry.image + r->p->symmetry.element[c] * f->n_nodes;
  const char *how = strstr(r->line, "beginning with its pass "),
             *start = strstr(r->line, ": start at "), *first, *end;
  bool backward = strstr(r->line, ", threaded backwards") != NULL;
  int from = how ? atoi(how + 24) - 1 : backward ? n - 1 : 0;
  ck_assert(start && r->half[u]);
  ck_assert(strstr(r->line, ": the same, moved") != NULL);
  r->half[c] = calloc((size_t)n, sizeof **r->half);
  ck_assert_ptr_nonnull(r->half[c]);
  for (int k = 0; k < n; k++) {
    int h = r->half[u][((backward ? from - k : from + k) % n + n) % n] ^ (backward ? 1 : 0);
    r->half[c][k] = half_between(f, image[thr_tail(f, h)], image[thr_head(f, h)]);
  }
  thread_copy(r, c);
  first = strstr(start, ", first to ") + 11;
  end = strstr(first, ", end at ") + 9;
  ck_assert_int_eq(read_place(r, start + 11), thr_tail(f, r->half[c][0]));
  ck_assert_int_eq(read_node(r, &first), thr_head(f, r->half[c][0]));
  ck_assert_int_eq(read_place(r, end), thr_head(f, r->half[c][n - 1]));
}

/* Reads all; every cord of the plan must be there as it is. Returns how many copies were not
 * listed. */
static int assert_read_back(reader *r)
{
  int copies = 0;
  while (next_line(r)) {
    char *path = strstr(r->line, ": cord ");
    if (strncmp(r->line, "Path ", 5) == 0) {
      read_path(r, cord_of(r, path + 7));
    } else if (strncmp(r->line, "Cord ", 5) == 0) {
      read_path(r, cord_of(r, r->line + 5));
    } else if (strncmp(r->line, "[ ] Cord ", 9) == 0) {
      read_copy(r);
      copies++;
    }
  }
  for (int i = 0; i < pieces_in(r->p); i++)
    ck_assert_int_ge(r->cord[i], 0);
  for (int c = 0; c < r->p->n_cords; c++) {
    ck_assert_msg(r->half[c] != NULL, "cord %s is missing", r->p->cord[c].id);
    ck_assert_mem_eq(r->half[c], r->p->cord[c].half, (size_t)r->p->cord[c].n_passes * sizeof(int));
  }
  return copies;
}

/* ---- tests ---- */

START_TEST(what_is_said_is_the_plan)
{
  thr_plan p = plan_number(_i / 4);
  if (_i % 4 > 1) p.options.joint = THR_JOINT_TUBE;
  const char **motion = words_for(&p, _i % 2 ? 3 : 1000);
  thr_text t = steps_of(&p, motion), again = steps_of(&p, motion);
  assert_same_text(&t, &again);
  reader r = reader_make(&p, t.data);
  int listed = 0, copies = assert_read_back(&r);
  for (int c = 0; c < p.n_cords; c++)
    listed += !p.symmetry.present || p.symmetry.unique[c] == c || !motion[c];
  ck_assert_int_eq(copies, p.n_cords - listed);
  if (p.symmetry.present && _i % 2 == 0)
    ck_assert_int_eq(copies, p.n_cords - p.symmetry.unique_paths);
  reader_destroy(&r);
  free(motion);
  thr_text_destroy(&t);
  thr_text_destroy(&again);
  thr_plan_destroy(&p);
}
END_TEST

/* A closed copy may be written from any of its places and either way round: the words tell. */
START_TEST(copies_written_otherwise)
{
  thr_plan p = plan_number(_i ? 12 : 7);
  ck_assert_int_gt(p.n_cords, p.symmetry.unique_paths);
  for (int c = 0; c < p.n_cords; c++) {
    thr_cord *cord = &p.cord[c];
    int n = cord->n_passes, shift = _i ? (c * 3 + 1) % n : 0, old[512];
    ck_assert_int_lt(n, 512);
    if (p.symmetry.unique[c] == c) continue;
    memcpy(old, cord->half, (size_t)n * sizeof *old);
    for (int k = 0; k < n; k++)
      cord->half[k] = c % 2 ? old[(n - 1 - k + shift) % n] ^ 1 : old[(k + shift) % n];
  }
  const char **motion = words_for(&p, 1000);
  thr_text t = steps_of(&p, motion);
  reader r = reader_make(&p, t.data);
  ck_assert_int_eq(assert_read_back(&r), p.n_cords - p.symmetry.unique_paths);
  ck_assert(strstr(t.data, "threaded backwards") != NULL);
  ck_assert_int_eq(strstr(t.data, "beginning with its pass") != NULL, _i);
  reader_destroy(&r);
  free(motion);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* A record that lies makes no copies: the cords are listed as they are. */
START_TEST(false_copies_are_listed)
{
  thr_plan p = plan_number(7);
  const char **motion = words_for(&p, 1000);
  for (int c = 0; c < p.n_cords; c++)
    if (p.symmetry.unique[c] != c)
      p.symmetry.element[c] = (p.symmetry.element[c] + 1) % p.symmetry.n_images;
  thr_text t = steps_of(&p, motion);
  reader r = reader_make(&p, t.data);
  ck_assert_int_eq(assert_read_back(&r), 0);
  reader_destroy(&r);
  free(motion);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* Which side is outside: away from the middle of a sphere, up on a dome. */
static void outward_at(const thr_frame *f, bool sphere, int v, double out[3])
{
  double middle[3] = {0};
  for (int w = 0; w < f->n_nodes && sphere; w++)
    for (int i = 0; i < 3; i++)
      middle[i] += f->xyz[w][i] / f->n_nodes;
  for (int i = 0; i < 3; i++)
    out[i] = sphere ? f->xyz[v][i] - middle[i] : i == 2;
}

/* Left is left seen from outside, in space. */
START_TEST(left_is_left_from_outside)
{
  static const struct {
    thr_shape shape;
    int size, rings;
    bool sphere;
  } shape[] = {{THR_MAKE_DOME, 8, 0, false},
               {THR_MAKE_SPHERE, 2, 0, true},
               {THR_MAKE_SPHERE, 3, 0, true},
               {THR_MAKE_HONEYCOMB, 3, 0, false}};
  thr_plan p =
      plan_of(shape_make(shape[_i].shape, shape[_i].size, shape[_i].rings), THR_ENDS_CLOSED, 1);
  const thr_frame *f = &p.frame;
  thr_guide guide;
  ck_assert_int_eq(thr_guide_make(&guide, f, NULL, NULL), THR_OK);
  int left = 0, right = 0;
  for (int k = 1; k < p.cord[0].n_passes; k++) {
    double a[3], b[3], cross[3], out[3];
    int in = p.cord[0].half[k - 1], go = p.cord[0].half[k];
    thr_way way = thr_guide_way(&guide, in, go);
    if (way != THR_WAY_LEFT && way != THR_WAY_RIGHT) continue;
    for (int i = 0; i < 3; i++) {
      a[i] = f->xyz[thr_head(f, in)][i] - f->xyz[thr_tail(f, in)][i];
      b[i] = f->xyz[thr_head(f, go)][i] - f->xyz[thr_tail(f, go)][i];
    }
    thr_cross(a, b, cross);
    outward_at(f, shape[_i].sphere, thr_tail(f, go), out);
    ck_assert_msg((thr_dot(cross, out) > 0) == (way == THR_WAY_LEFT),
                  "pass %d goes to the other side", k + 1);
    left += way == THR_WAY_LEFT;
    right += way == THR_WAY_RIGHT;
  }
  ck_assert_int_gt(left + right, 10);
  if (shape[_i].sphere) ck_assert(left > 3 && right > 3);
  thr_guide_destroy(&guide);
  thr_plan_destroy(&p);
}
END_TEST

/* In a tangle no side is said. */
START_TEST(a_tangle_has_no_sides)
{
  rng r = rng_make(11);
  thr_frame f = random_frame(&r, 14, 40, LENGTHS_EUCLID);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_text t = steps_of(&p, NULL);
  thr_guide guide;
  reader back = reader_make(&p, t.data);
  assert_read_back(&back);
  ck_assert_int_eq(thr_guide_make(&guide, &f, NULL, NULL), THR_OK);
  ck_assert(!guide.sides);
  for (int k = 1; k < p.cord[0].n_passes; k++) {
    thr_way way = thr_guide_way(&guide, p.cord[0].half[k - 1], p.cord[0].half[k]);
    ck_assert(way != THR_WAY_LEFT && way != THR_WAY_RIGHT);
  }
  thr_guide_destroy(&guide);
  reader_destroy(&back);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Copies by a mirror have left for right, those by a rotation have not. */
START_TEST(mirrors_exchange_left_and_right)
{
  thr_plan p = plan_number(6);
  const char **motion = words_for(&p, 1000);
  thr_text t = steps_of(&p, motion);
  int exchanged = 0;
  for (int c = 0; c < p.n_cords; c++) {
    char key[32];
    thr_isometry iso;
    if (p.symmetry.unique[c] == c) continue;
    thr_isometry_of(&p.frame, p.symmetry.image + p.symmetry.element[c] * p.frame.n_nodes, 1e-6,
                    &iso);
    snprintf(key, sizeof key, "[ ] Cord %s: ", p.cord[c].id);
    const char *line = strstr(t.data, key),
               *words = line ? strstr(line, "left and right turns exchanged") : NULL;
    ck_assert_ptr_nonnull(line);
    bool backward = strstr(line, "threaded backwards") &&
                    strstr(line, "threaded backwards") < strstr(line, "start at");
    bool said = words && words < strstr(line, "start at");
    ck_assert_int_eq(said, iso.kind == THR_ISO_MIRROR && !backward);
    exchanged += said;
  }
  ck_assert_int_gt(exchanged, 0);
  free(motion);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* Names with blanks are one word, equal names are told apart, and a long one is not broken. */
START_TEST(names_stay_single_words)
{
  static const char *const name[] = {"(0, 1)", "x", "x",
                                     "a name of more than forty bytes is cut so that it fits",
                                     "\xC3\xA4 \xC3\xB6"};
  thr_frame f = ring_make(5);
  name_nodes(&f, name, 5);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_text t = steps_of(&p, NULL);
  static const char *const label[] = {
      "(0,_1)", " x#1", " x#2", "(a_name_of_more_than_forty_bytes_is_cut_s", " \xC3\xA4_\xC3\xB6"};
  for (int v = 0; v < 5; v++)
    ck_assert_msg(strstr(t.data, label[v]) != NULL, "%s is not in:\n%s", label[v], t.data);
  ck_assert_ptr_null(strstr(t.data, "cut_so"));
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(broken_plans_are_refused)
{
  thr_plan p = plan_of(ring_make(6), THR_ENDS_CLOSED, 1);
  thr_text t = {0};
  thr_err err = {0};
  int half = p.cord[0].half[2];
  p.cord[0].half[2] = half ^ 1;
  assert_status(thr_steps_text(&p, NULL, 0, 1, NULL, &t, &err), THR_EINPUT, &err, "pass 3");
  p.cord[0].half[2] = 1000;
  assert_status(thr_steps_text(&p, NULL, 0, 1, NULL, &t, &err), THR_EINPUT, &err, "edge 500");
  p.cord[0].half[2] = half;
  int n = p.n_cords;
  p.n_cords = 0;
  assert_status(thr_steps_text(&p, NULL, 0, 1, NULL, &t, &err), THR_EINPUT, &err, "no cord");
  ck_assert_uint_eq(t.length, 0);
  p.n_cords = n;
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(every_allocation_may_fail)
{
  thr_plan p = plan_number(_i ? 7 : 1);
  thr_text whole = steps_of(&p, NULL);
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    thr_text t = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_steps_text(&p, NULL, 0, 1, NULL, &t, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_int_eq(st, THR_ENOMEM);
      ck_assert_uint_eq(t.length, 0);
      assert_one_line(&err, "memory");
    } else {
      assert_same_text(&t, &whole);
    }
    thr_text_destroy(&t);
    ck_assert_int_lt(k, 100000);
  }
  thr_text_destroy(&whole);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("steps");
  ADD_LOOP(s, 30, what_is_said_is_the_plan, 0, 4 * N_PLANS);
  ADD_LOOP(s, 30, copies_written_otherwise, 0, 2);
  ADD_TEST(s, 20, false_copies_are_listed);
  ADD_LOOP(s, 20, left_is_left_from_outside, 0, 4);
  ADD_TEST(s, 20, a_tangle_has_no_sides);
  ADD_TEST(s, 20, mirrors_exchange_left_and_right);
  ADD_TEST(s, 20, names_stay_single_words);
  ADD_TEST(s, 20, broken_plans_are_refused);
  ADD_LOOP(s, 60, every_allocation_may_fail, 0, 2);
  return run_suite(s);
}
