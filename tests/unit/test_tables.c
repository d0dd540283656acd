/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of a plan, read back and worked out again from its JSON and coordinates. */
#include "diagram/tables/tables.h"
#include "graph/number.h"
#include "graph/io/json.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/sample_plans.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- CSV ---- */

enum { MOST_FIELDS = 20 };

/* Rows of fields, the first one their names. */
typedef struct {
  int n_rows, n_columns;
  char *bytes;
  char *(*field)[MOST_FIELDS];
} csv;

/* Strict: every row of as many fields, quotes where needed only, line feeds, one at the end. */
static csv csv_read(const thr_text *t)
{
  csv c = {.bytes = malloc(t->length + 1), .field = calloc(t->length + 1, sizeof *c.field)};
  ck_assert(c.bytes && c.field && t->length > 0 && t->data[t->length - 1] == '\n');
  char *to = c.bytes;
  for (const char *s = t->data; *s; c.n_rows++) {
    int n = 0;
    do {
      ck_assert_int_lt(n, MOST_FIELDS);
      if (n) s++;
      c.field[c.n_rows][n++] = to;
      bool quoted = *s == '"', needed = false;
      if (quoted) s++;
      while (quoted ? *s != '"' || s[1] == '"' : *s != ',' && *s != '\n') {
        ck_assert(*s && (quoted || *s != '"'));
        needed |= strchr(",\"\r\n", *s) != NULL;
        if (quoted && *s == '"') s++;
        *to++ = *s++;
      }
      if (quoted) s++;
      ck_assert(quoted == needed);
      *to++ = '\0';
    } while (*s == ',');
    ck_assert_int_eq(*s++, '\n');
    if (c.n_rows == 0) c.n_columns = n;
    ck_assert_int_eq(n, c.n_columns);
  }
  return c;
}

static void csv_destroy(csv *c)
{
  free(c->bytes);
  free(c->field);
}

static const char *at(const csv *c, int row, const char *column)
{
  for (int k = 0; k < c->n_columns; k++)
    if (strcmp(c->field[0][k], column) == 0) return c->field[row][k];
  ck_abort_msg("no column %s", column);
}

static double number(const csv *c, int row, const char *column)
{
  char *end;
  const char *s = at(c, row, column);
  double value = strtod(s, &end);
  ck_assert_msg(*s && !*end, "%s: %s is no number", column, s);
  return value;
}

static int integer(const csv *c, int row, const char *column)
{
  return (int)number(c, row, column);
}

static void assert_says(const csv *c, int row, const char *column, const char *word)
{
  ck_assert_msg(strcmp(at(c, row, column), word) == 0, "row %d: %s is %s, not %s", row, column,
                at(c, row, column), word);
}

typedef enum { STEPS, CORDS, BEADS, CHANNELS, N_TABLES } kind;

static thr_status make(const thr_plan *p, kind k, const char *const *motion, thr_text *t,
                       thr_err *err)
{
  if (k == STEPS) return thr_table_steps(p, 0, 1, NULL, t, err);
  if (k == CHANNELS) return thr_table_channels(p, 0, NULL, t, err);
  return k == CORDS ? thr_table_cords(p, motion, 1, 0, NULL, t, err)
                    : thr_table_beads(p, 0, NULL, t, err);
}

static csv table_of(const thr_plan *p, kind k, const char *const *motion)
{
  thr_text t = {0}, again = {0};
  thr_err err = {0};
  assert_ok(make(p, k, motion, &t, &err), &err);
  ck_assert_int_eq(make(p, k, motion, &again, &err), THR_OK);
  assert_same_text(&t, &again);
  csv c = csv_read(&t);
  thr_text_destroy(&t);
  thr_text_destroy(&again);
  return c;
}

/* ---- the plan as its JSON has it ---- */

typedef struct {
  thr_text text;
  thr_json *doc;
} json_plan;

static json_plan json_of(const thr_plan *p)
{
  json_plan j = {.text = plan_text(p)};
  ck_assert_int_eq(thr_json_parse(&j.doc, j.text.data, j.text.length, "plan", NULL), THR_OK);
  return j;
}

static void json_destroy(json_plan *j)
{
  thr_json_destroy(j->doc);
  thr_text_destroy(&j->text);
}

static const thr_json *cord_of(const json_plan *j, const char *id)
{
  const thr_json *cords = thr_json_get(j->doc, "cords");
  for (int c = 0; c < thr_json_size(cords); c++)
    if (strcmp(thr_json_string(thr_json_get(thr_json_at(cords, c), "id")), id) == 0)
      return thr_json_at(cords, c);
  ck_abort_msg("no cord %s", id);
}

static int item(const thr_json *cord, const char *key, int k)
{
  int64_t i;
  ck_assert(thr_json_int(thr_json_at(thr_json_get(cord, key), k), &i));
  return (int)i;
}

static void vector(const json_plan *j, int a, int b, double d[3])
{
  const thr_json *nodes = thr_json_get(thr_json_get(j->doc, "framework"), "nodes");
  for (int i = 0; i < 3; i++) {
    double from, to;
    ck_assert(thr_json_number(thr_json_at(thr_json_at(nodes, a), i), &from));
    ck_assert(thr_json_number(thr_json_at(thr_json_at(nodes, b), i), &to));
    d[i] = to - from;
  }
}

static double distance(const json_plan *j, int a, int b)
{
  double d[3];
  vector(j, a, b, d);
  return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* Degrees between going from a to b and going from b to c. */
static double bend(const json_plan *j, int a, int b, int c)
{
  double u[3], v[3];
  vector(j, a, b, u);
  vector(j, b, c, v);
  double cosine = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / distance(j, a, b) / distance(j, b, c);
  return acos(fmin(1, fmax(-1, cosine))) * 180 / THR_PI;
}

static double length_of(const json_plan *j, const thr_json *cord)
{
  double sum = 0;
  for (int k = 1; k < thr_json_size(thr_json_get(cord, "nodes")); k++)
    sum += distance(j, item(cord, "nodes", k - 1), item(cord, "nodes", k));
  return sum;
}

/* Degrees; closed cords with the turn that closes them. */
static double turning_of(const json_plan *j, const thr_json *cord, bool closing)
{
  int n = thr_json_size(thr_json_get(cord, "nodes"));
  double sum = 0;
  for (int k = 2; k < n; k++)
    sum += bend(j, item(cord, "nodes", k - 2), item(cord, "nodes", k - 1), item(cord, "nodes", k));
  return closing ? sum + bend(j, item(cord, "nodes", n - 2), item(cord, "nodes", 0),
                              item(cord, "nodes", 1))
                 : sum;
}

/* ---- steps ---- */

/* The turn that a row tells, of a cord at its node k. */
static void assert_turn(const csv *c, int row, const json_plan *j, const thr_json *cord, int k,
                        bool flat)
{
  int n = thr_json_size(thr_json_get(cord, "edges"));
  if (k == 0 || k == n) {
    assert_says(c, row, "turn", k == 0 ? "start" : "end");
    assert_says(c, row, "degrees", "");
    return;
  }
  int before = item(cord, "nodes", k - 1), at_node = item(cord, "nodes", k),
      to = item(cord, "nodes", k + 1);
  double degrees = bend(j, before, at_node, to), in[3], out[3];
  ck_assert_double_eq_tol(number(c, row, "degrees"), degrees, 0.0051);
  ck_assert_int_eq(strcmp(at(c, row, "turn"), "back") == 0, before == to);
  if (fabs(degrees - 15) > 1e-6)
    ck_assert_int_eq(strcmp(at(c, row, "turn"), "straight on") == 0, degrees < 15);
  vector(j, before, at_node, in);
  vector(j, at_node, to, out);
  if (flat && degrees > 15 && degrees < 165)
    assert_says(c, row, "turn", in[0] * out[1] - in[1] * out[0] > 0 ? "left" : "right");
}

/* A row against the cord of the JSON: which piece, by which pass, how far, how it turns. Solid
 * pieces turn the cord, between tubes the node before does. */
static void assert_step(const csv *c, int row, const json_plan *j, bool rigid, bool flat)
{
  const thr_json *cord = cord_of(j, at(c, row, "cord"));
  int k = integer(c, row, "step"), to = item(cord, "nodes", k);
  double length = length_of(j, cord), used = number(c, row, "used");
  ck_assert_int_eq(integer(c, row, "to_node"), to);
  ck_assert_double_eq_tol(number(c, row, "left"), length - used, 1e-6 * length);
  assert_turn(c, row, j, cord, rigid ? k : k - 1, flat);
  if (k == 0) {
    ck_assert(rigid && used == 0);
    assert_says(c, row, "edge", "");
    assert_says(c, row, "from_node", "");
    return;
  }
  int from = item(cord, "nodes", k - 1);
  ck_assert_int_eq(integer(c, row, "edge"), item(cord, "edges", k - 1));
  ck_assert_int_eq(integer(c, row, "from_node"), from);
  ck_assert_double_eq_tol(number(c, row, "length"), distance(j, from, to), 1e-6);
  if (k > 1 || rigid) {
    assert_says(c, row - 1, "cord", at(c, row, "cord"));
    ck_assert_int_eq(integer(c, row - 1, "step"), k - 1);
    ck_assert_double_eq_tol(used - number(c, row - 1, "used"), distance(j, from, to),
                            1e-6 * length);
  }
}

/* The piece of a row: with solid joints its node, else its edge. */
static int piece_of(const csv *c, int row, bool rigid)
{
  return integer(c, row, rigid ? "to_node" : "edge");
}

/* Visits and their words, by going through the rows once more; a piece has one name in all rows,
 * and arms have that of the piece that they face. */
static void assert_visits(const csv *c, const thr_plan *p, bool rigid)
{
  int most = p->frame.n_nodes + p->frame.n_edges;
  int *visits = calloc((size_t)most, sizeof *visits), *from = calloc((size_t)most, sizeof *from);
  const char **label = calloc((size_t)most, sizeof *label);
  ck_assert(visits && from && label);
  for (int row = 1; row < c->n_rows; row++) {
    int i = piece_of(c, row, rigid), came = rigid ? 0 : integer(c, row, "from_node");
    ck_assert_int_eq(integer(c, row, "visit"), ++visits[i]);
    assert_says(c, row, "how",
                visits[i] == 1             ? "pick up"
                : rigid || from[i] == came ? "through"
                                           : "back through");
    from[i] = came;
    if (!label[i]) label[i] = at(c, row, "piece");
    assert_says(c, row, "piece", label[i]);
  }
  for (int i = 0; i < most; i++)
    for (int k = 0; k < i; k++)
      ck_assert(!label[i] || !label[k] || strcmp(label[i], label[k]) != 0);
  for (int row = 1; row < c->n_rows && rigid; row++) {
    bool last = row + 1 == c->n_rows || integer(c, row + 1, "step") == 0;
    assert_says(c, row, "in", integer(c, row, "step") ? label[integer(c, row, "from_node")] : "");
    assert_says(c, row, "out", last ? "" : label[integer(c, row + 1, "to_node")]);
  }
  for (int i = 0; i < (rigid ? p->frame.n_nodes : p->frame.n_edges); i++)
    ck_assert_int_gt(visits[i], 0);
  free(visits);
  free(from);
  free(label);
}

/* A copy's step is the image of its path's, by the record of the symmetry: the same edge, one way
 * round or the other. */
static void assert_copies(const csv *c, const thr_plan *p)
{
  for (int row = 1; row < c->n_rows; row++) {
    int own = 0, path = 0;
    while (strcmp(p->cord[own].id, at(c, row, "cord")) != 0)
      own++;
    while (strcmp(p->cord[path].id, at(c, row, "path")) != 0)
      path++;
    const thr_symmetry_record *r = &p->symmetry;
    ck_assert_int_eq(path, r->present ? r->unique[own] : own);
    if (path == own || !integer(c, row, "step"))
      ck_assert_int_eq(integer(c, row, "path_step"), integer(c, row, "step"));
    if (path == own || !integer(c, row, "step")) continue;
    const int *image = r->image + (size_t)r->element[own] * (size_t)p->frame.n_nodes;
    int h = p->cord[path].half[integer(c, row, "path_step") - 1];
    int a = image[thr_tail(&p->frame, h)], b = image[thr_head(&p->frame, h)];
    int from = integer(c, row, "from_node"), to = integer(c, row, "to_node");
    ck_assert((a == from && b == to) || (a == to && b == from));
  }
}

static void judge_steps(thr_plan *p, bool rigid, bool flat)
{
  p->options.joint = rigid ? THR_JOINT_SOLID : THR_JOINT_TUBE;
  json_plan j = json_of(p);
  csv c = table_of(p, STEPS, NULL);
  ck_assert_int_eq(c.n_rows - 1, p->metrics.passes + (rigid ? p->n_cords : 0));
  for (int row = 1; row < c.n_rows; row++)
    assert_step(&c, row, &j, rigid, flat);
  assert_visits(&c, p, rigid);
  assert_copies(&c, p);
  csv_destroy(&c);
  json_destroy(&j);
}

START_TEST(steps_are_the_plan)
{
  thr_plan p = plan_number(_i / 2);
  judge_steps(&p, _i % 2, false);
  thr_plan_destroy(&p);
}
END_TEST

/* The rows of a cord, from row on, against the plan: the right needle from the fold to the end,
 * then the left one back from there to the start. Returns the row after them. */
static int judge_needles(const csv *c, int row, const json_plan *j, bool rigid)
{
  const thr_json *cord = cord_of(j, at(c, row, "cord"));
  const int n = thr_json_size(thr_json_get(cord, "nodes")) - 1,
            first = rigid ? integer(c, row + 1, "step") : integer(c, row, "step");
  const bool folded = first > 1;
  double used[2] = {0, 0}, last_left[2] = {0, 0};
  if (rigid) ck_assert_int_eq(integer(c, row++, "step"), 0);
  for (int k = 0; k < n; k++, row++) {
    const bool left = k > n - first;
    const int step = left ? n - k : first + k;
    ck_assert_int_eq(integer(c, row, "step"), step);
    assert_says(c, row, "needle", !folded ? "" : left ? "left" : "right");
    ck_assert_int_eq(integer(c, row, "from_node"), item(cord, "nodes", left ? step : step - 1));
    ck_assert_int_eq(integer(c, row, "to_node"), item(cord, "nodes", left ? step - 1 : step));
    used[left] += number(c, row, "length");
    last_left[left] = number(c, row, "left");
    ck_assert_double_eq_tol(number(c, row, "used"), used[left], 1e-6 * used[left]);
  }
  ck_assert(last_left[0] == 0 && last_left[1] == 0);
  ck_assert_double_eq_tol(used[0] + used[1], length_of(j, cord), 1e-6 * (used[0] + used[1]));
  ck_assert_int_eq(folded, n >= 24); /* docs/outputs.md */
  if (folded) ck_assert(fabs(used[0] - used[1]) < 0.5 * (used[0] + used[1]));
  return row;
}

START_TEST(two_needles_go_from_the_fold)
{
  thr_plan p = plan_number(_i / 2);
  const bool rigid = _i % 2;
  thr_text t = {0};
  p.options.joint = rigid ? THR_JOINT_SOLID : THR_JOINT_TUBE;
  json_plan j = json_of(&p);
  ck_assert_int_eq(thr_table_steps(&p, 0, 2, NULL, &t, NULL), THR_OK);
  csv c = csv_read(&t);
  for (int row = 1; row < c.n_rows;)
    row = judge_needles(&c, row, &j, rigid);
  csv_destroy(&c);
  thr_text_destroy(&t);
  json_destroy(&j);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(left_is_left_on_flat_ground)
{
  thr_frame f = grid_make(5, 4);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 2);
  judge_steps(&p, _i, true);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- cords ---- */

START_TEST(cords_are_cut_long_enough)
{
  thr_plan p = plan_number(_i);
  p.options.physics.cord_diameter = 0.125;
  p.options.physics.bore = 0.5; /* four cords wide: no bead of these plans needs more */
  json_plan j = json_of(&p);
  csv c = table_of(&p, CORDS, NULL);
  ck_assert_int_eq(c.n_rows - 1, p.n_cords);
  for (int row = 1; row < c.n_rows; row++) {
    const thr_json *cord = cord_of(&j, at(&c, row, "cord"));
    bool closing = p.options.ends == THR_ENDS_CLOSED;
    double length = length_of(&j, cord), turning = turning_of(&j, cord, closing);
    double cut = number(&c, row, "length") + number(&c, row, "tails") + number(&c, row, "knots") +
                 number(&c, row, "turns") + number(&c, row, "joins");
    ck_assert_double_eq_tol(number(&c, row, "length"), length, 1e-6 * length);
    ck_assert_double_eq_tol(number(&c, row, "turning_degrees"), turning, 0.01);
    ck_assert_double_eq_tol(number(&c, row, "tails"), 2 * 150, 1e-9);
    ck_assert_double_eq_tol(number(&c, row, "knots"), 2 * 16.4 * 0.125, 1e-9);
    ck_assert_double_eq_tol(number(&c, row, "turns"), (0.5 - 0.125) / 2 * turning * THR_PI / 180,
                            1e-6 * turning + 1e-12);
    ck_assert_double_eq_tol(number(&c, row, "cut"), cut, 1e-6 * cut);
    ck_assert_int_eq(integer(&c, row, "passes"), thr_json_size(thr_json_get(cord, "edges")));
    assert_says(&c, row, "closed", thr_json_true(thr_json_get(cord, "closed")) ? "yes" : "no");
    assert_says(&c, row, "path",
                p.symmetry.present ? p.cord[p.symmetry.unique[row - 1]].id : p.cord[row - 1].id);
    if (thr_json_true(thr_json_get(cord, "closed")))
      assert_says(&c, row, "end", at(&c, row, "start"));
  }
  csv_destroy(&c);
  json_destroy(&j);
  thr_plan_destroy(&p);
}
END_TEST

/* Says what moves a path to its copies, commas and all; of a path nothing. */
START_TEST(repetitions_are_said)
{
  thr_plan p = plan_number(7);
  const char **motion = calloc((size_t)p.n_cords, sizeof *motion);
  ck_assert_ptr_nonnull(motion);
  for (int c = 0; c < p.n_cords; c++)
    motion[c] = "turned, \"so to speak\"";
  csv c = table_of(&p, CORDS, motion);
  int copies = 0;
  for (int row = 1; row < c.n_rows; row++) {
    bool copy = p.symmetry.unique[row - 1] != row - 1;
    const char *words = at(&c, row, "repeated");
    ck_assert_int_eq(strncmp(words, motion[row - 1], strlen(motion[row - 1])) == 0, copy);
    if (!copy) ck_assert_int_eq(*words, '\0');
    copies += copy;
  }
  ck_assert_int_gt(copies, 0);
  free(motion);
  csv_destroy(&c);
  thr_plan_destroy(&p);
}
END_TEST

/* A metre is a thousand millimetres, and of what is no unit nobody knows how long a tail is. */
START_TEST(sizes_follow_the_units)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  thr_plan mm = plan_simple(&f, THR_ENDS_FEET, 1), m = plan_simple(&f, THR_ENDS_FEET, 1),
           cubits = plan_simple(&f, THR_ENDS_FEET, 1);
  mm.options.physics.cord_diameter = m.options.physics.cord_diameter = 1.5;
  snprintf(m.frame.units, sizeof m.frame.units, "m");
  snprintf(cubits.frame.units, sizeof cubits.frame.units, "cu,bi\nts");
  csv a = table_of(&mm, CORDS, NULL), b = table_of(&m, CORDS, NULL),
      c = table_of(&cubits, CORDS, NULL), d = table_of(&cubits, BEADS, NULL);
  static const char *const known[] = {"tails", "knots", "turns"};
  for (int i = 0; i < 3; i++) {
    ck_assert_double_eq_tol(number(&a, 1, known[i]) / 1000, number(&b, 1, known[i]), 1e-8);
    assert_says(&c, 1, known[i], "");
  }
  assert_says(&c, 1, "cut", "");
  assert_says(&c, 1, "unit", "cu,bi ts");
  for (int row = 1; row < d.n_rows; row++) {
    assert_says(&d, row, "bore_mm", "");
    ck_assert_double_ge(number(&d, row, "bore_cords"), 1);
  }
  csv_destroy(&a);
  csv_destroy(&b);
  csv_destroy(&c);
  csv_destroy(&d);
  thr_plan_destroy(&mm);
  thr_plan_destroy(&m);
  thr_plan_destroy(&cubits);
  thr_frame_destroy(&f);
}
END_TEST

/* What a spreadsheet would take for a formula gets an apostrophe; numbers with a sign stay numbers.
 */
START_TEST(names_are_no_formulas)
{
  static const char *const name[][2] = {
      {"=1+1", "'=1+1"}, {"-12.5", "-12.5"},  {"@SUM(A1)", "'@SUM(A1)"}, {"+1e3", "+1e3"},
      {"-", "'-"},       {"-2+3", "'-2+3"},   {"\t=x", "_=x"},           {"+1e999", "'+1e999"},
      {"a=1", "a=1"},    {"-0x10", "'-0x10"}, {"=\"a\",b", "'=\"a\",b"}, {"-inf", "'-inf"}};
  enum { N = sizeof name / sizeof *name };
  thr_frame f = path_make(N);
  const char *first[N];
  for (int v = 0; v < N; v++)
    first[v] = name[v][0];
  name_nodes(&f, first, N);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  csv c = table_of(&p, STEPS, NULL), b = table_of(&p, BEADS, NULL);
  for (int row = 1; row < c.n_rows; row++)
    assert_says(&c, row, "piece", name[integer(&c, row, "to_node")][1]);
  for (int row = 1; row <= N; row++)
    assert_says(&b, row, "piece", name[row - 1][1]);
  csv_destroy(&c);
  csv_destroy(&b);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- beads ---- */

/* Passes over an edge, or of cords at a node, in the JSON. */
static int count_in(const json_plan *j, const char *key, int number)
{
  const thr_json *cords = thr_json_get(j->doc, "cords");
  int n = 0;
  for (int c = 0; c < thr_json_size(cords); c++) {
    const thr_json *cord = thr_json_at(cords, c), *list = thr_json_get(cord, key);
    bool skip = strcmp(key, "nodes") == 0 &&
                thr_json_true(thr_json_get(cord, "closed")); /* its end is its start */
    for (int k = skip; k < thr_json_size(list); k++)
      n += item(cord, key, k) == number;
  }
  return n;
}

/* The bore of the evaluation, or wider where cords side by side would have no play in it: best[n -
 * 1] diameters hold n of them.
 */
static void assert_bore(const csv *c, int row, int passes, const thr_physics *sizes)
{
  static const double best[] = {1, 2, 2.1548, 2.4143, 2.7014, 3, 3},
                      fill[] = {0.53, 0.31, 0.4, 0.4, 0.4, 0.4, 0.4};
  double cords = number(c, row, "bore_cords"), mm = number(c, row, "bore_mm");
  ck_assert_int_le(passes, 7);
  ck_assert_double_ge(mm, sizes->bore - 1e-9);
  ck_assert_double_ge(mm, 1.15 * best[passes - 1] * sizes->cord_diameter);
  ck_assert_double_le(passes / (cords * cords), fill[passes - 1] * (1 + 1e-6));
  ck_assert(mm >= cords * sizes->cord_diameter - 1e-5 && mm < cords * sizes->cord_diameter + 0.01);
}

/* Blank-separated words of a field; returns how many. */
static int words_of(const char *field, char word[][64], int most)
{
  int n = 0, length;
  for (; n < most && sscanf(field, " %63s%n", word[n], &length) == 1; field += length)
    n++;
  return n;
}

/* What the arms of a piece face, and how many cords each holds. Names of these frames have no
 * blanks. */
static void assert_arms(const csv *c, int row, const json_plan *j, const thr_plan *p, int node)
{
  const thr_frame *f = &p->frame;
  enum { MOST = 16 };
  char face[MOST][64], cords[MOST][64];
  int n = words_of(at(c, row, "faces"), face, MOST), most = 0;
  ck_assert_int_eq(n, thr_degree(f, node));
  ck_assert_int_eq(words_of(at(c, row, "cords"), cords, MOST), n);
  ck_assert_int_eq(integer(c, row, "arms"), n);
  for (int i = 0; i < n; i++) {
    int other = 1;
    while (strcmp(at(c, other, "piece"), face[i]) != 0)
      ck_assert_int_lt(++other, c->n_rows);
    int e = thr_frame_edge_between(f, node, integer(c, other, "number"));
    ck_assert_int_ge(e, 0);
    ck_assert_int_eq(atoi(cords[i]), count_in(j, "edges", e));
    most = atoi(cords[i]) > most ? atoi(cords[i]) : most;
    for (int k = 0; k < i; k++)
      ck_assert_str_ne(face[i], face[k]);
  }
  thr_physics sizes;
  ck_assert_int_eq(thr_physics_resolve(&p->options.physics, f, &sizes, NULL), THR_OK);
  assert_bore(c, row, most, &sizes);
}

START_TEST(solid_pieces_are_the_nodes)
{
  thr_plan p = plan_number(_i);
  json_plan j = json_of(&p);
  csv c = table_of(&p, BEADS, NULL);
  const thr_frame *f = &p.frame;
  ck_assert_int_eq(c.n_rows - 1, f->n_nodes);
  for (int row = 1; row < c.n_rows; row++) {
    double arms = 0;
    for (int e = 0; e < f->n_edges; e++)
      if (f->edge[e][0] == row - 1 || f->edge[e][1] == row - 1)
        arms += distance(&j, f->edge[e][0], f->edge[e][1]) / 2;
    ck_assert_int_eq(integer(&c, row, "number"), row - 1);
    ck_assert_int_eq(integer(&c, row, "visits"), count_in(&j, "nodes", row - 1));
    ck_assert_double_eq_tol(number(&c, row, "length"), arms, 1e-6);
    assert_says(&c, row, "foot", f->foot[row - 1] ? "yes" : "no");
    assert_arms(&c, row, &j, &p, row - 1);
  }
  csv_destroy(&c);
  json_destroy(&j);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(tubes_are_the_edges)
{
  thr_plan p = plan_number(_i);
  thr_physics sizes;
  p.options.joint = THR_JOINT_TUBE;
  ck_assert_int_eq(thr_physics_resolve(&p.options.physics, &p.frame, &sizes, NULL), THR_OK);
  json_plan j = json_of(&p);
  csv c = table_of(&p, BEADS, NULL);
  const thr_frame *f = &p.frame;
  ck_assert_int_eq(c.n_rows - 1, f->n_edges);
  for (int row = 1; row < c.n_rows; row++) {
    const int *end = f->edge[row - 1];
    ck_assert_int_eq(integer(&c, row, "number"), row - 1);
    ck_assert_int_eq(integer(&c, row, "visits"), count_in(&j, "edges", row - 1));
    ck_assert_double_eq_tol(number(&c, row, "length"), distance(&j, end[0], end[1]), 1e-6);
    assert_says(&c, row, "foot", f->foot[end[0]] || f->foot[end[1]] ? "yes" : "no");
    assert_bore(&c, row, count_in(&j, "edges", row - 1), &sizes);
  }
  csv_destroy(&c);
  json_destroy(&j);
  thr_plan_destroy(&p);
}
END_TEST

/* Seen from above on flat ground: clockwise, from the arm that points up. */
START_TEST(arms_go_clockwise_from_the_top)
{
  thr_frame f = grid_make(3, 3);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 2);
  csv c = table_of(&p, BEADS, NULL);
  for (int row = 1; row < c.n_rows; row++) {
    const char *place = at(&c, row, "piece"), *faces = at(&c, row, "faces");
    if (strcmp(place, "B2") == 0) ck_assert_str_eq(faces, "B3 C2 B1 A2");
    if (strcmp(place, "A2") == 0) ck_assert_str_eq(faces, "A3 B2 A1");
    if (strcmp(place, "B3") == 0)
      ck_assert(strcmp(faces, "C3 B2 A3") == 0 || strcmp(faces, "A3 C3 B2") == 0);
  }
  csv_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- channels ---- */

/* Angle on the ground of the way from one node to another. */
static double bearing(const thr_frame *f, int from, int to)
{
  return atan2(f->xyz[to][1] - f->xyz[from][1], f->xyz[to][0] - f->xyz[from][0]);
}

/* How far to the left of direction a direction b is, in (0, 2 pi). */
static double to_the_left(double a, double b)
{
  double d = fmod(b - a, 2 * THR_PI);
  return d < 0 ? d + 2 * THR_PI : d;
}

/* Node called so by the row of another table. */
static int node_called(const csv *pieces, const char *name)
{
  for (int row = 1; row < pieces->n_rows; row++)
    if (strcmp(at(pieces, row, "piece"), name) == 0) return integer(pieces, row, "number");
  return -1;
}

/* On a dome seen from above: do the channels of two rows cross? */
static bool rows_cross(const csv *c, const csv *pieces, const thr_frame *f, int a, int b)
{
  static const char *const arm[] = {"in", "out"};
  int v = node_called(pieces, at(c, a, "piece")), end[4];
  for (int i = 0; i < 4; i++) {
    end[i] = node_called(pieces, at(c, i < 2 ? a : b, arm[i % 2]));
    if (end[i] < 0) return false;
    for (int k = 0; k < i; k++)
      if (end[k] == end[i]) return false;
  }
  double base = bearing(f, v, end[0]), other = to_the_left(base, bearing(f, v, end[1]));
  return (to_the_left(base, bearing(f, v, end[2])) < other) !=
         (to_the_left(base, bearing(f, v, end[3])) < other);
}

START_TEST(channels_are_the_plan)
{
  static const int dome[] = {0, 6, 7, 11, 13};
  thr_plan p = plan_number(dome[_i]);
  json_plan j = json_of(&p);
  csv c = table_of(&p, CHANNELS, NULL), pieces = table_of(&p, BEADS, NULL);
  bool closed = p.options.ends == THR_ENDS_CLOSED;
  ck_assert_int_eq(c.n_rows - 1, p.metrics.passes + (closed ? 0 : p.n_cords));
  for (int row = 1; row < c.n_rows; row++) {
    const thr_json *cord = cord_of(&j, at(&c, row, "cord"));
    int k = integer(&c, row, "step"), n = thr_json_size(thr_json_get(cord, "edges")),
        v = item(cord, "nodes", k), crosses = 0;
    int next = k < n ? item(cord, "nodes", k + 1) : closed ? item(cord, "nodes", 1) : -1;
    ck_assert_int_eq(node_called(&pieces, at(&c, row, "piece")), v);
    ck_assert_int_eq(node_called(&pieces, at(&c, row, "in")), k ? item(cord, "nodes", k - 1) : -1);
    ck_assert_int_eq(node_called(&pieces, at(&c, row, "out")), next);
    ck_assert_int_eq(integer(&c, row, "cords_in"),
                     k ? count_in(&j, "edges", item(cord, "edges", k - 1)) : 0);
    for (int other = 1; other < c.n_rows; other++)
      if (other != row && strcmp(at(&c, row, "piece"), at(&c, other, "piece")) == 0)
        crosses += rows_cross(&c, &pieces, &p.frame, row, other);
    ck_assert_int_eq(integer(&c, row, "crosses"), crosses);
  }
  csv_destroy(&c);
  csv_destroy(&pieces);
  json_destroy(&j);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- what can go wrong ---- */

START_TEST(names_are_quoted)
{
  thr_frame f = ring_make(5);
  static const char *const name[] = {"a,b", "say \"x\"", "plain", "\"", "line\nbreak"};
  static const char *const label[] = {"a,b", "say_\"x\"", "plain", "\"", "line_break"};
  name_nodes(&f, name, 5);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  csv c = table_of(&p, STEPS, NULL);
  ck_assert_int_eq(c.n_rows, 7);
  for (int row = 1; row < c.n_rows; row++)
    assert_says(&c, row, "piece", label[integer(&c, row, "to_node")]);
  csv_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(broken_plans_are_refused)
{
  for (int k = 0; k < N_TABLES; k++) {
    thr_plan p = plan_number(0);
    thr_text t = {0};
    thr_err err = {0};
    int half = p.cord[0].half[2], n = p.n_cords;
    p.cord[0].half[2] = 1000;
    assert_status(make(&p, (kind)k, NULL, &t, &err), THR_EINPUT, &err, "edge 500");
    p.cord[0].half[2] = half;
    p.n_cords = 0;
    assert_status(make(&p, (kind)k, NULL, &t, &err), THR_EINPUT, &err, "no cord");
    p.n_cords = n;
    p.options.physics.cord_diameter = 3;
    p.options.physics.bore = 2;
    ck_assert_uint_eq(t.length, 0);
    bool sizes = k == CORDS || k == BEADS;
    ck_assert_int_eq(make(&p, (kind)k, NULL, &t, &err), sizes ? THR_EINPUT : THR_OK);
    if (sizes) assert_one_line(&err, "bore");
    ck_assert_int_eq(t.length > 0, !sizes);
    thr_text_destroy(&t);
    thr_plan_destroy(&p);
  }
}
END_TEST

typedef struct {
  thr_plan plan;
  kind table;
} wanted;

static thr_status make_wanted(const void *user, thr_text *t, thr_err *err)
{
  const wanted *w = user;
  return make(&w->plan, w->table, NULL, t, err);
}

START_TEST(every_allocation_may_fail)
{
  wanted w = {plan_number(0), (kind)_i};
  assert_allocations_may_fail(make_wanted, &w, 100000);
  thr_plan_destroy(&w.plan);
}
END_TEST

/* A grid whose nodes have no names of a grid: its places have the numbers of the nodes, as on
 * screen and in the plan. */
START_TEST(places_have_the_names_of_nodes)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 4, 0);
  thr_plan p = plan_simple(&f, THR_ENDS_FEET, 1);
  thr_frame_destroy(&f);
  free(p.frame.name);
  p.frame.name = NULL;
  csv c = table_of(&p, CORDS, NULL);
  for (int row = 1; row < c.n_rows; row++) {
    ck_assert_int_eq(integer(&c, row, "start"), thr_cord_start(&p.frame, &p.cord[row - 1]));
    ck_assert_int_eq(integer(&c, row, "end"), thr_cord_end(&p.frame, &p.cord[row - 1]));
  }
  csv_destroy(&c);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tables");
  ADD_EXAMPLES(s, 30, steps_are_the_plan, 2 * N_PLANS);
  ADD_TEST(s, 20, places_have_the_names_of_nodes);
  ADD_EXAMPLES(s, 30, two_needles_go_from_the_fold, 2 * N_PLANS);
  ADD_LOOP(s, 20, left_is_left_on_flat_ground, 0, 2);
  ADD_EXAMPLES(s, 30, cords_are_cut_long_enough, N_PLANS);
  ADD_TEST(s, 20, repetitions_are_said);
  ADD_TEST(s, 20, names_are_no_formulas);
  ADD_TEST(s, 20, sizes_follow_the_units);
  ADD_EXAMPLES(s, 30, solid_pieces_are_the_nodes, N_PLANS);
  ADD_EXAMPLES(s, 30, tubes_are_the_edges, N_PLANS);
  ADD_TEST(s, 20, arms_go_clockwise_from_the_top);
  ADD_LOOP(s, 20, channels_are_the_plan, 0, 5);
  ADD_TEST(s, 20, names_are_quoted);
  ADD_TEST(s, 20, broken_plans_are_refused);
  ADD_EXAMPLES(s, 60, every_allocation_may_fail, N_TABLES);
  return run_suite(s);
}
