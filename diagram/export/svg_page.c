/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page drawn from SVG, read in one pass. It knows the SVG that diagram/ writes for pages: svg (in
 * mm), title, desc, style, g with translations and clipping, clipPath around a rect, rect, turned
 * or not, circle, path of M L H V C Z and their small letters, text; and of these no attribute but
 * those that are drawn or say nothing of the picture. Private to diagram/. */
#include "diagram/export/export_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH = 24, ATTRIBUTES = 16, CLIPS = 16 };

typedef struct {
  thr_svg_element element;
  thr_svg_style style;
} open_element;

typedef struct {
  thr_slice name, value;
} attribute;

typedef struct {
  thr_slice id;
  double at[2], size[2];
} clip;

/* The tag just read. */
typedef struct {
  thr_slice name;
  attribute attribute[ATTRIBUTES];
  int n_attributes;
  bool closes, empty; /* </name>; <name/> */
} tag;

typedef struct {
  thr_paper *paper;
  thr_slice left; /* of the document */
  thr_svg_sheet sheet;
  open_element open[DEPTH]; /* outermost first */
  int depth;
  clip clip[CLIPS];
  int n_clips;
  thr_text words; /* of the text being drawn */
  thr_err *err;
} reader;

static thr_status broken(reader *r, const char *what, thr_slice words)
{
  return thr_fail(r->err, THR_ESOLVER, "a page cannot be drawn: %s '%.*s'", what,
                  (int)(words.n < 60 ? words.n : 60), words.s);
}

/* ---- tags ---- */

static void skip(thr_slice *text, size_t n)
{
  *text = (thr_slice){text->s + n, text->n - n};
}

/* Takes off the front what stands before a character, and the character. */
static bool take_until(thr_slice *text, char stop, thr_slice *taken)
{
  const char *end = text->n ? memchr(text->s, stop, text->n) : NULL;
  if (!end) return false;
  *taken = (thr_slice){text->s, (size_t)(end - text->s)};
  skip(text, taken->n + 1);
  return true;
}

static size_t name_length(thr_slice text)
{
  size_t n = 0;
  while (n < text.n && !strchr(" \n\t\r=/>\"", text.s[n]))
    n++;
  return n;
}

static thr_status read_attributes(reader *r, thr_slice text, tag *t)
{
  for (text = thr_slice_trim(text); text.n; text = thr_slice_trim(text)) {
    attribute a = {.name = {text.s, name_length(text)}};
    thr_slice rest = {text.s + a.name.n, text.n - a.name.n};
    if (!a.name.n || rest.n < 2 || rest.s[0] != '=' || rest.s[1] != '"' ||
        t->n_attributes == ATTRIBUTES)
      return broken(r, "the attributes", text);
    skip(&rest, 2);
    if (!take_until(&rest, '"', &a.value)) return broken(r, "the attribute", text);
    t->attribute[t->n_attributes++] = a;
    text = rest;
  }
  return THR_OK;
}

/* Goes to the next tag; what stands before it is given back in between. Name empty at the end of
 * the document, and of <?xml ..?>.
 */
static thr_status next_tag(reader *r, thr_slice *between, tag *t)
{
  thr_slice inside;
  t->n_attributes = 0;
  t->name = (thr_slice){"", 0};
  t->closes = t->empty = false;
  if (!take_until(&r->left, '<', between)) {
    *between = r->left;
    r->left.n = 0;
    return THR_OK;
  }
  if (!take_until(&r->left, '>', &inside)) return broken(r, "the tag", r->left);
  if (inside.n && *inside.s == '?') return THR_OK;
  t->closes = inside.n && *inside.s == '/';
  skip(&inside, t->closes);
  t->empty = inside.n && inside.s[inside.n - 1] == '/';
  inside.n -= t->empty;
  t->name = (thr_slice){inside.s, name_length(inside)};
  skip(&inside, t->name.n);
  return t->name.n ? read_attributes(r, inside, t) : broken(r, "the tag", inside);
}

static const thr_slice *find(const tag *t, const char *name)
{
  for (int i = 0; i < t->n_attributes; i++)
    if (thr_slice_is(t->attribute[i].name, name)) return &t->attribute[i].value;
  return NULL;
}

/* A number that is 0 if it is not said. */
static thr_status read_number(reader *r, const tag *t, const char *name, double *value)
{
  const thr_slice *text = find(t, name);
  *value = 0;
  if (!text) return THR_OK;
  thr_slice rest = *text;
  return thr_slice_number(&rest, value) && !rest.n ? THR_OK : broken(r, name, *text);
}

static thr_status read_numbers(reader *r, const tag *t, int n, const char *const *name,
                               double *value)
{
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = read_number(r, t, name[i], &value[i]);
  return st;
}

/* ---- styles ---- */

/* Is the attribute one that the element draws by, or one that says nothing of the picture? */
static bool is_known(const tag *t, thr_slice name)
{
  static const char *const any[] = {"class",      "style",    "id",
                                    "data-piece", "data-for", "shape-rendering"};
  static const char *const known[][8] = {
      {"svg", "xmlns", "width", "height", "viewBox", "role", "aria-labelledby"},
      {"g", "transform", "clip-path"},
      {"rect", "x", "y", "width", "height", "rx", "transform"},
      {"circle", "cx", "cy", "r"},
      {"path", "d"},
      {"text", "x", "y"}};
  if (thr_svg_is_property(name)) return true;
  for (size_t i = 0; i < sizeof any / sizeof *any; i++)
    if (thr_slice_is(name, any[i])) return true;
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    for (int k = 1; thr_slice_is(t->name, known[i][0]) && k < 8 && known[i][k]; k++)
      if (thr_slice_is(name, known[i][k])) return true;
  return false;
}

/* Opens an element, whose style is its parent's, then of its attributes, then of the style sheet,
 * then of style="..". */
static thr_status push(reader *r, const tag *t)
{
  const thr_slice *classes = find(t, "class"), *list = find(t, "style");
  thr_status st = THR_OK;
  if (r->depth == DEPTH) return broken(r, "too deep is", t->name);
  open_element *new = &r->open[r->depth];
  new->style = r->depth ? r->open[r->depth - 1].style : thr_svg_style_first();
  new->element = (thr_svg_element){.name = t->name, .dashed = find(t, "stroke-dasharray") != NULL};
  if (classes) new->element.classes = *classes;
  for (int i = 0; i < t->n_attributes && !st; i++) {
    const attribute *a = &t->attribute[i];
    if (!is_known(t, a->name)) return broken(r, "not known is the attribute", a->name);
    if (thr_svg_is_property(a->name))
      st = thr_svg_style_set(&new->style, a->name, a->value, r->err);
  }
  if (st) return st;
  const thr_svg_element *inside[DEPTH];
  for (int i = 0; i <= r->depth; i++)
    inside[i] = &r->open[i].element;
  thr_svg_sheet_apply(&r->sheet, inside, ++r->depth, &new->style);
  return list ? thr_svg_style_list(&new->style, *list, r->err) : THR_OK;
}

static bool ink_of(const thr_svg_style *style, thr_svg_property colour, thr_svg_property opacity,
                   thr_ink *ink)
{
  memcpy(ink->colour, style->value[colour].x, sizeof ink->colour);
  ink->opacity = style->value[opacity].x[0];
  return style->value[colour].n > 0;
}

static bool line_of(const thr_svg_style *style, thr_line *line)
{
  const thr_svg_value *dash = &style->value[THR_SVG_DASHARRAY];
  *line = (thr_line){.width = style->value[THR_SVG_STROKE_WIDTH].x[0],
                     .dash_offset = style->value[THR_SVG_DASHOFFSET].x[0],
                     .n_dash = dash->n,
                     .round_ends = style->value[THR_SVG_LINECAP].x[0] > 0,
                     .round_corners = style->value[THR_SVG_LINEJOIN].x[0] > 0};
  memcpy(line->dash, dash->x, sizeof line->dash);
  return ink_of(style, THR_SVG_STROKE, THR_SVG_STROKE_OPACITY, &line->ink) && line->width > 0;
}

/* ---- shapes ---- */

/* Small letters: from where the pen is. */
static void make_absolute(char command, int n, const double now[2], double *x)
{
  if (command == 'h' || command == 'v')
    x[0] += now[command == 'v'];
  else if (command >= 'a')
    for (int i = 0; i < n; i++)
      x[i] += now[i % 2];
}

static void trace(thr_paper *paper, char command, double now[2], double first[2], const double *x)
{
  switch (command) {
  case 'H':
  case 'h': now[0] = x[0]; break;
  case 'V':
  case 'v': now[1] = x[0]; break;
  case 'C':
  case 'c': memcpy(now, x + 4, 2 * sizeof *now); break;
  default: memcpy(now, x, 2 * sizeof *now);
  }
  if (command == 'M' || command == 'm') {
    memcpy(first, now, 2 * sizeof *now);
    thr_paper_move(paper, now);
  } else if (command == 'C' || command == 'c')
    thr_paper_curve(paper, x, x + 2, now);
  else
    thr_paper_line(paper, now);
}

/* Numbers that a command takes; 0: not known. */
static int count_numbers(char command)
{
  if (!command) return 0;
  return strchr("MLml", command) ? 2 : strchr("HVhv", command) ? 1 : strchr("Cc", command) ? 6 : 0;
}

static thr_status trace_path(reader *r, thr_slice d)
{
  double now[2] = {0, 0}, first[2] = {0, 0}, x[6];
  char command = '\0';
  for (d = thr_slice_trim(d); d.n; d = thr_slice_trim(d)) {
    if (*d.s == 'z' || *d.s == 'Z') {
      skip(&d, 1);
      thr_paper_end(r->paper);
      memcpy(now, first, sizeof now);
      command = '\0';
      continue;
    }
    if (count_numbers(*d.s)) {
      command = *d.s;
      skip(&d, 1);
    } else if (command == 'M' || command == 'm')
      command = command == 'M' ? 'L' : 'l';
    int n = count_numbers(command);
    if (!n) return broken(r, "the path", d);
    for (int i = 0; i < n; i++)
      if (!thr_slice_number(&d, &x[i])) return broken(r, "the path", d);
    make_absolute(command, n, now, x);
    trace(r->paper, command, now, first, x);
  }
  return THR_OK;
}

static thr_status trace_shape(reader *r, const tag *t)
{
  static const char *const rect[] = {"x", "y", "width", "height", "rx"}, *const circle[] = {
                                                                             "cx", "cy", "r"};
  double x[5] = {0};
  thr_status st;
  if (thr_slice_is(t->name, "path")) {
    const thr_slice *d = find(t, "d");
    return d ? trace_path(r, *d) : broken(r, "without d is", t->name);
  }
  if (thr_slice_is(t->name, "circle")) {
    st = read_numbers(r, t, 3, circle, x);
    if (!st) thr_paper_circle(r->paper, x, x[2]);
    return st;
  }
  st = read_numbers(r, t, 5, rect, x);
  double most =
      0.5 *
      fmin(x[2],
           x[3]); /* corners of an ellipse beyond it, but for the rounding of what is written */
  if (!st && x[4] > most + 0.02) return broken(r, "not known are such corners of a", t->name);
  if (!st) thr_paper_rect(r->paper, x, x + 2, fmin(x[4], most));
  return st;
}

/* Takes word off the beginning; false if the text begins otherwise. */
static bool take_word(thr_slice *text, const char *word)
{
  const size_t n = strlen(word);
  if (text->n < n || memcmp(text->s, word, n) != 0) return false;
  skip(text, n);
  return true;
}

/* "translate(x y)", and perhaps "rotate(degrees)" after it */
static thr_status shift(reader *r, thr_slice text)
{
  thr_slice rest = text;
  double by[2], degrees;
  if (!take_word(&rest, "translate(") || !thr_slice_number(&rest, &by[0]) ||
      !thr_slice_number(&rest, &by[1]) || !take_word(&rest, ")"))
    return broken(r, "not known is", text);
  thr_paper_shift(r->paper, by);
  if (!rest.n) return THR_OK;
  if (!take_word(&rest, " rotate(") || !thr_slice_number(&rest, &degrees) ||
      !thr_slice_is(rest, ")"))
    return broken(r, "not known is", text);
  thr_paper_turn(r->paper, degrees);
  return THR_OK;
}

/* Is it a path, of parts that are not closed? */
static bool is_open(const tag *t)
{
  const thr_slice *d = thr_slice_is(t->name, "path") ? find(t, "d") : NULL;
  return d && d->n && !memchr(d->s, 'z', d->n) && !memchr(d->s, 'Z', d->n);
}

static thr_status draw_shape(reader *r, const tag *t)
{
  thr_ink fill;
  thr_line line;
  const thr_slice *transform = find(t, "transform");
  thr_status st = push(r, t);
  if (!st && transform) {
    thr_paper_push(r->paper);
    st = shift(r, *transform);
  }
  if (st) return st;
  const thr_svg_style *style = &r->open[--r->depth].style;
  bool filled = ink_of(style, THR_SVG_FILL, THR_SVG_FILL_OPACITY, &fill),
       drawn = line_of(style, &line);
  if (drawn && !filled && !line.n_dash && is_open(t)) thr_paper_trim(r->paper, &line);
  st = trace_shape(r, t);
  thr_paper_trim(r->paper, NULL);
  if (st) return st;
  if (drawn && filled && style->value[THR_SVG_PAINT_ORDER].x[0] > 0) {
    thr_paper_paint(r->paper, NULL, &line);
    st = trace_shape(r, t);
    drawn = false;
  }
  thr_paper_paint(r->paper, filled ? &fill : NULL, drawn ? &line : NULL);
  if (transform) thr_paper_pop(r->paper);
  return st;
}

/* ---- text ---- */

static thr_status put_words(reader *r, thr_slice text)
{
  static const char *const entity[][2] = {
      {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}};
  r->words.length = 0;
  while (text.n) {
    const char *and = memchr(text.s, '&', text.n);
    size_t n = and? (size_t)(and-text.s) : text.n, i;
    thr_text_append_bytes(&r->words, text.s, n);
    skip(&text, n);
    if (!text.n) break;
    for (i = 0; i < sizeof entity / sizeof *entity; i++)
      if (text.n >= strlen(entity[i][0]) && memcmp(text.s, entity[i][0], strlen(entity[i][0])) == 0)
        break;
    if (i == sizeof entity / sizeof *entity) return broken(r, "not known is", text);
    thr_text_append(&r->words, entity[i][1]);
    skip(&text, strlen(entity[i][0]));
  }
  return r->words.failed ? thr_nomem(r->err) : THR_OK;
}

static thr_status draw_text(reader *r, const tag *t)
{
  static const char *const name[] = {"x", "y"};
  double at[2];
  thr_slice words;
  thr_line line;
  tag end;
  thr_status st = push(r, t);
  if (!st) st = read_numbers(r, t, 2, name, at);
  if (!st) st = next_tag(r, &words, &end);
  if (!st && (!end.closes || !thr_slice_is(end.name, "text")))
    return broken(r, "not known inside text is", end.name);
  if (!st) st = put_words(r, words);
  if (st) return st;
  const thr_svg_style *style = &r->open[--r->depth].style;
  thr_letters letters = {.size = style->value[THR_SVG_FONT_SIZE].x[0],
                         .anchor = 0.5 * style->value[THR_SVG_ANCHOR].x[0],
                         .bold = style->value[THR_SVG_FONT_WEIGHT].x[0] > 0,
                         .mono = style->value[THR_SVG_FONT_FAMILY].x[0] > 0};
  if (line_of(style, &line)) return broken(r, "a border is not known of the text", words);
  if (ink_of(style, THR_SVG_FILL, THR_SVG_FILL_OPACITY, &letters.ink) && r->words.length)
    thr_paper_text(r->paper, at, &letters, r->words.data);
  return THR_OK;
}

/* ---- containers ---- */

/* transform="translate(1.00 2.00)" */
/* clip-path="url(#id)" */
static thr_status clip_to(reader *r, thr_slice text)
{
  for (int i = r->n_clips - 1; i >= 0; i--) {
    const clip *c = &r->clip[i];
    if (text.n != c->id.n + 6 || memcmp(text.s, "url(#", 5) != 0 ||
        memcmp(text.s + 5, c->id.s, c->id.n) != 0)
      continue;
    thr_paper_rect(r->paper, c->at, c->size, 0);
    thr_paper_clip(r->paper);
    return THR_OK;
  }
  return broken(r, "not known is the clipping path", text);
}

static thr_status open_group(reader *r, const tag *t)
{
  const thr_slice *transform = find(t, "transform"), *clipping = find(t, "clip-path");
  thr_status st = push(r, t);
  if (st) return st;
  thr_paper_push(r->paper);
  if (transform) st = shift(r, *transform);
  if (!st && clipping) st = clip_to(r, *clipping);
  return st;
}

/* <clipPath id=".."><rect ../></clipPath> */
static thr_status read_clip(reader *r, const tag *t)
{
  static const char *const name[] = {"x", "y", "width", "height"};
  const thr_slice *id = find(t, "id");
  double x[4] = {0};
  thr_slice between;
  tag inner, end;
  if (!id || r->n_clips == CLIPS) return broken(r, "one too many, or without a name, is", t->name);
  thr_status st = next_tag(r, &between, &inner);
  if (!st && (!thr_slice_is(inner.name, "rect") || inner.n_attributes != 4))
    return broken(r, "no plain rectangle clips:", inner.name);
  if (!st) st = read_numbers(r, &inner, 4, name, x);
  if (!st) st = next_tag(r, &between, &end);
  if (!st && (!end.closes || !thr_slice_is(end.name, "clipPath")))
    return broken(r, "not known in clipPath is", end.name);
  r->clip[r->n_clips++] = (clip){.id = *id, .at = {x[0], x[1]}, .size = {x[2], x[3]}};
  return st;
}

/* An element whose text is for itself: title, desc, style. */
static thr_status read_words(reader *r, const tag *t, thr_slice *words)
{
  tag end;
  thr_status st = next_tag(r, words, &end);
  if (!st &&
      (!end.closes || end.name.n != t->name.n || memcmp(end.name.s, t->name.s, end.name.n) != 0))
    return broken(r, "not known inside it is", end.name);
  return st;
}

static thr_status close_element(reader *r, const tag *t)
{
  const thr_slice *name = r->depth ? &r->open[r->depth - 1].element.name : NULL;
  if (!name || name->n != t->name.n || memcmp(name->s, t->name.s, name->n) != 0)
    return broken(r, "not open is", t->name);
  if (thr_slice_is(t->name, "g")) thr_paper_pop(r->paper);
  r->depth--;
  return THR_OK;
}

static thr_status read_element(reader *r, const tag *t)
{
  thr_slice words;
  if (t->closes) return close_element(r, t);
  if (thr_slice_is(t->name, "path") || thr_slice_is(t->name, "rect") ||
      thr_slice_is(t->name, "circle"))
    return t->empty ? draw_shape(r, t) : broken(r, "open is", t->name);
  if (t->empty) return broken(r, "empty is", t->name);
  if (thr_slice_is(t->name, "g")) return open_group(r, t);
  if (thr_slice_is(t->name, "text")) return draw_text(r, t);
  if (thr_slice_is(t->name, "svg")) return push(r, t);
  if (thr_slice_is(t->name, "clipPath")) return read_clip(r, t);
  if (thr_slice_is(t->name, "title") || thr_slice_is(t->name, "desc"))
    return read_words(r, t, &words);
  if (!thr_slice_is(t->name, "style")) return broken(r, "not known is", t->name);
  thr_status st = read_words(r, t, &words);
  return st ? st : thr_svg_sheet_add(&r->sheet, words, r->err);
}

thr_status thr_svg_page(thr_paper *paper, const thr_text *svg, thr_err *err)
{
  if (svg->failed) return thr_nomem(err);
  thr_err why = {0};
  reader *r = thr_calloc(1, sizeof *r);
  if (!r) return thr_nomem(err);
  *r = (reader){.paper = paper, .left = {svg->data, svg->length}, .err = err ? err : &why};
  thr_status st = THR_OK;
  bool drawn = false;
  while (r->left.n && !st) {
    thr_slice between;
    tag t;
    st = next_tag(r, &between, &t);
    if (!st && thr_slice_trim(between).n) st = broken(r, "not known are the words", between);
    if (!st && t.name.n) st = read_element(r, &t);
    drawn = drawn || r->depth > 0;
  }
  if (!st && (!drawn || r->depth)) st = broken(r, "not a whole SVG document ends with", r->left);
  thr_svg_sheet_destroy(&r->sheet);
  thr_text_destroy(&r->words);
  free(r);
  return st;
}
