/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a page from SVG, read in one pass without building a tree.
 *
 * This is a reader of the SVG that diagram/ writes for pages, no general one: svg (in mm), title,
 * desc, style, g with translation and clipping, clipPath around a rect, rect, turned or not,
 * circle, path of the commands M L H V C Z and their small letters, text. Of these elements it
 * takes the attributes that it draws by, and those that say nothing of the picture. Whatever else
 * stands in the document is an error, so that a PDF never lacks what the SVG shows.
 *
 * Example: <path d="M1 2h3" stroke="#222" stroke-width="0.5" fill="none"/> becomes one call each of
 * thr_paper_move, thr_paper_line and thr_paper_paint. */
#include "diagram/export/export_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  DEPTH = 24,      /* elements that are open, at most */
  ATTRIBUTES = 16, /* of a tag, at most */
  CLIPS = 16       /* clipping paths of a page, at most */
};

/* An element whose end has not come yet. */
typedef struct {
  thr_svg_element element;
  thr_svg_style style;
} open_element;

/* name="value" */
typedef struct {
  thr_slice name, value;
} svg_attribute;

/* A clipping path, which is a rectangle here, mm. */
typedef struct {
  thr_slice id;
  double at[2], size[2];
} clip_rectangle;

/* A tag, borrowed from the document. */
typedef struct {
  thr_slice name;
  svg_attribute attribute[ATTRIBUTES];
  int n_attributes;
  bool closes, empty; /* </name>; <name/> */
} svg_tag;

/* What is known of a document on the way through it. */
typedef struct {
  thr_paper *paper;
  thr_slice left;           /* what has not been read yet */
  thr_svg_sheet sheet;      /* rules of all style elements so far */
  open_element open[DEPTH]; /* outermost first */
  int depth;                /* number of open elements */
  clip_rectangle clip[CLIPS];
  int n_clips;
  thr_text words; /* of the text that is drawn, entities replaced */
  thr_err *err;
} svg_reader;

/* Fails with what cannot be drawn and the first 60 bytes of the place. */
static thr_status broken(svg_reader *reader, const char *what, thr_slice words)
{
  return thr_fail(reader->err, THR_ESOLVER, "a page cannot be drawn: %s '%.*s'", what,
                  (int)(words.n < 60 ? words.n : 60), words.s);
}

/* ---- tags ---- */

/* Takes n bytes off the front of a text. */
static void skip(thr_slice *text, size_t n)
{
  *text = (thr_slice){text->s + n, text->n - n};
}

/* Takes off the front of a text what stands before a character, and the character. Returns false,
 * with the text unchanged, if the character is not there. */
static bool take_until(thr_slice *text, char stop, thr_slice *taken)
{
  const char *end = text->n ? memchr(text->s, stop, text->n) : NULL;
  if (!end) return false;
  *taken = (thr_slice){text->s, (size_t)(end - text->s)};
  skip(text, taken->n + 1);
  return true;
}

/* Returns how many bytes the name at the front of a text has. */
static size_t name_length(thr_slice text)
{
  size_t n = 0;
  while (n < text.n && !strchr(" \n\t\r=/>\"", text.s[n]))
    n++;
  return n;
}

/* Reads all attributes of a tag: name="value", with double quotes. */
static thr_status read_attributes(svg_reader *reader, thr_slice text, svg_tag *tag)
{
  for (text = thr_slice_trim(text); text.n; text = thr_slice_trim(text)) {
    /* A name, =, and a quoted value without blanks between them. */
    svg_attribute next = {.name = {text.s, name_length(text)}};
    thr_slice rest = {text.s + next.name.n, text.n - next.name.n};
    if (!next.name.n || rest.n < 2 || rest.s[0] != '=' || rest.s[1] != '"' ||
        tag->n_attributes == ATTRIBUTES)
      return broken(reader, "the attributes", text);

    skip(&rest, 2);

    /* The value reaches to the next quote and may hold blanks. */
    if (!take_until(&rest, '"', &next.value)) return broken(reader, "the attribute", text);
    tag->attribute[tag->n_attributes++] = next;
    text = rest;
  }
  return THR_OK;
}

/* Reads the next tag. *between receives the text before it. The name is empty at the end of the
 * document, and for <?xml ..?>. */
static thr_status next_tag(svg_reader *reader, thr_slice *between, svg_tag *tag)
{
  thr_slice inside;
  tag->n_attributes = 0;
  tag->name = (thr_slice){"", 0};
  tag->closes = tag->empty = false;

  /* No further tag: what is left is text. */
  if (!take_until(&reader->left, '<', between)) {
    *between = reader->left;
    reader->left.n = 0;
    return THR_OK;
  }

  /* A tag reaches to the next ">", which attributes must not hold. */
  if (!take_until(&reader->left, '>', &inside)) return broken(reader, "the tag", reader->left);
  if (inside.n && *inside.s == '?') return THR_OK;

  /* The sign that it closes comes first, the sign that it is empty last. */
  tag->closes = inside.n && *inside.s == '/';
  skip(&inside, tag->closes);
  tag->empty = inside.n && inside.s[inside.n - 1] == '/';
  inside.n -= tag->empty;

  /* The name, and behind it the attributes. */
  tag->name = (thr_slice){inside.s, name_length(inside)};
  skip(&inside, tag->name.n);
  return tag->name.n ? read_attributes(reader, inside, tag) : broken(reader, "the tag", inside);
}

/* Returns the value of an attribute, or NULL if the tag has none of that name. */
static const thr_slice *find(const svg_tag *tag, const char *name)
{
  for (int i = 0; i < tag->n_attributes; i++)
    if (thr_slice_is(tag->attribute[i].name, name)) return &tag->attribute[i].value;
  return NULL;
}

/* Reads n attributes as numbers, 0 for one that the tag lacks. */
static thr_status read_numbers(svg_reader *reader, const svg_tag *tag, int n,
                               const char *const *name, double *value)
{
  for (int i = 0; i < n; i++) {
    const thr_slice *found = find(tag, name[i]), text = found ? *found : (thr_slice){"0", 1};
    thr_slice rest = text;

    /* Nothing may follow the number, such as a unit. */
    if (!thr_slice_number(&rest, &value[i]) || rest.n) return broken(reader, name[i], text);
  }
  return THR_OK;
}

/* ---- styles ---- */

/* Returns whether the element is drawn by the attribute, or the attribute says nothing of the
 * picture. */
static bool is_known(const svg_tag *tag, thr_slice name)
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

  /* Every element may have properties of style, a class, and what says nothing of the picture. */
  if (thr_svg_is_property(name)) return true;
  for (size_t i = 0; i < sizeof any / sizeof *any; i++)
    if (thr_slice_is(name, any[i])) return true;

  /* Each row begins with the element and goes on with its own attributes. */
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    for (int k = 1; thr_slice_is(tag->name, known[i][0]) && k < 8 && known[i][k]; k++)
      if (thr_slice_is(name, known[i][k])) return true;
  return false;
}

/* Opens an element. Its style is its parent's, then changed by its attributes, then by the style
 * sheet, then by style="..": each beats the one before, as in CSS. */
static thr_status push(svg_reader *reader, const svg_tag *tag)
{
  const thr_slice *classes = find(tag, "class"), *list = find(tag, "style");
  thr_status st = THR_OK;

  if (reader->depth == DEPTH) return broken(reader, "too deep is", tag->name);
  open_element *new = &reader->open[reader->depth];

  /* The parent's style, since all properties are inherited. */
  new->style = reader->depth ? reader->open[reader->depth - 1].style : thr_svg_style_first();
  new->element =
      (thr_svg_element){.name = tag->name, .dashed = find(tag, "stroke-dasharray") != NULL};
  if (classes) new->element.classes = *classes;

  /* Attributes first; one that is not known ends the page. */
  for (int i = 0; i < tag->n_attributes && !st; i++) {
    const svg_attribute *one = &tag->attribute[i];
    if (!is_known(tag, one->name)) return broken(reader, "not known is the attribute", one->name);
    if (thr_svg_is_property(one->name))
      st = thr_svg_style_set(&new->style, one->name, one->value, reader->err);
  }

  if (st) return st;

  /* Selectors look at all elements around this one. */
  const thr_svg_element *inside[DEPTH];
  for (int i = 0; i <= reader->depth; i++)
    inside[i] = &reader->open[i].element;
  thr_svg_sheet_apply(&reader->sheet, inside, ++reader->depth, &new->style);

  return list ? thr_svg_style_list(&new->style, *list, reader->err) : THR_OK;
}

/* Fills the ink of a paint property. Returns whether there is any ("none" is not). */
static bool ink_of(const thr_svg_style *style, thr_svg_property colour, thr_svg_property opacity,
                   thr_ink *ink)
{
  memcpy(ink->colour, style->value[colour].x, sizeof ink->colour);
  ink->opacity = style->value[opacity].x[0];
  return style->value[colour].n > 0;
}

/* Fills the line that a style draws along a path. Returns whether it draws any. */
static bool line_of(const thr_svg_style *style, thr_line *line)
{
  const thr_svg_value *dash = &style->value[THR_SVG_DASHARRAY];

  /* Filled even if nothing is drawn, as the result says. */
  *line = (thr_line){.width = style->value[THR_SVG_STROKE_WIDTH].x[0],
                     .dash_offset = style->value[THR_SVG_DASHOFFSET].x[0],
                     .n_dash = dash->n,
                     .round_ends = style->value[THR_SVG_LINECAP].x[0] > 0,
                     .round_corners = style->value[THR_SVG_LINEJOIN].x[0] > 0};

  memcpy(line->dash, dash->x, sizeof line->dash);
  return ink_of(style, THR_SVG_STROKE, THR_SVG_STROKE_OPACITY, &line->ink) && line->width > 0;
}

/* ---- shapes ---- */

/* Makes the numbers of a path command absolute: small letters count from where the pen is. */
static void make_absolute(char command, int n, const double now[2], double *number)
{
  /* Points come as pairs, so every other number is a y. */
  if (command == 'h' || command == 'v')
    number[0] += now[command == 'v'];
  else if (command >= 'a')
    for (int i = 0; i < n; i++)
      number[i] += now[i % 2];
}

/* Draws one path command with absolute numbers, and moves the pen. first receives where a part of
 * the path begins, to which Z returns. */
static void trace(thr_paper *paper, char command, double now[2], double first[2],
                  const double *number)
{
  /* Where the pen comes to. */
  switch (command) {
  case 'H':
  case 'h': now[0] = number[0]; break;
  case 'V':
  case 'v': now[1] = number[0]; break;
  case 'C':
  case 'c': memcpy(now, number + 4, 2 * sizeof *now); break;
  default: memcpy(now, number, 2 * sizeof *now);
  }

  /* What is drawn on the way. */
  if (command == 'M' || command == 'm') {
    memcpy(first, now, 2 * sizeof *now);
    thr_paper_move(paper, now);
  } else if (command == 'C' || command == 'c')
    thr_paper_curve(paper, number, number + 2, now);
  else
    thr_paper_line(paper, now);
}

/* Returns how many numbers a command takes; 0: it is not known. */
static int count_numbers(char command)
{
  if (!command) return 0;
  return strchr("MLml", command) ? 2 : strchr("HVhv", command) ? 1 : strchr("Cc", command) ? 6 : 0;
}

/* Adds the path of an attribute d to the page's path. A command may be left out if it is the one
 * before; after M or m this means L or l. */
static thr_status trace_path(svg_reader *reader, thr_slice data)
{
  double now[2] = {0, 0}, first[2] = {0, 0}, number[6];
  char command = '\0';

  for (data = thr_slice_trim(data); data.n; data = thr_slice_trim(data)) {
    /* Z takes no number, and no command may be left out behind it. */
    if (*data.s == 'z' || *data.s == 'Z') {
      skip(&data, 1);
      thr_paper_end(reader->paper);
      memcpy(now, first, sizeof now);
      command = '\0';
      continue;
    }

    /* A letter, or none: then the command before goes on. */
    if (count_numbers(*data.s)) {
      command = *data.s;
      skip(&data, 1);
    } else if (command == 'M' || command == 'm')
      command = command == 'M' ? 'L' : 'l';

    /* All numbers of the command, with blanks or commas between them. */
    int n = count_numbers(command);
    if (!n) return broken(reader, "the path", data);
    for (int i = 0; i < n; i++)
      if (!thr_slice_number(&data, &number[i])) return broken(reader, "the path", data);

    make_absolute(command, n, now, number);
    trace(reader->paper, command, now, first, number);
  }
  return THR_OK;
}

/* Adds the outline of a path, circle or rect to the page's path. */
static thr_status trace_shape(svg_reader *reader, const svg_tag *tag)
{
  static const char *const rect[] = {"x", "y", "width", "height", "rx"}, *const circle[] = {
                                                                             "cx", "cy", "r"};

  double number[5] = {0};
  thr_status st;

  /* A path must have its data. */
  if (thr_slice_is(tag->name, "path")) {
    const thr_slice *data = find(tag, "d");
    return data ? trace_path(reader, *data) : broken(reader, "without d is", tag->name);
  }

  /* A circle: middle and radius. */
  if (thr_slice_is(tag->name, "circle")) {
    st = read_numbers(reader, tag, 3, circle, number);
    if (!st) thr_paper_circle(reader->paper, number, number[2]);
    return st;
  }

  /* A rectangle, perhaps with round corners. */
  st = read_numbers(reader, tag, 5, rect, number);
  /* Larger radii would make an ellipse; the tolerance is for rounding in what is written. */
  double most = 0.5 * fmin(number[2], number[3]);
  if (!st && number[4] > most + 0.02)
    return broken(reader, "not known are such corners of a", tag->name);

  if (!st) thr_paper_rect(reader->paper, number, number + 2, fmin(number[4], most));
  return st;
}

/* Takes a word off the front of a text. Returns false if the text begins otherwise. */
static bool take_word(thr_slice *text, const char *word)
{
  const size_t n = strlen(word);
  if (text->n < n || memcmp(text->s, word, n) != 0) return false;
  skip(text, n);
  return true;
}

/* Moves the origin as transform="translate(x y)" says, perhaps with " rotate(degrees)" behind
 * it. */
static thr_status shift(svg_reader *reader, thr_slice text)
{
  thr_slice rest = text;
  double by[2], degrees;

  /* First the translation, which must be there. */
  if (!take_word(&rest, "translate(") || !thr_slice_number(&rest, &by[0]) ||
      !thr_slice_number(&rest, &by[1]) || !take_word(&rest, ")"))
    return broken(reader, "not known is", text);

  thr_paper_shift(reader->paper, by);
  if (!rest.n) return THR_OK;

  /* Then a rotation, or nothing. */
  if (!take_word(&rest, " rotate(") || !thr_slice_number(&rest, &degrees) ||
      !thr_slice_is(rest, ")"))
    return broken(reader, "not known is", text);

  thr_paper_turn(reader->paper, degrees);
  return THR_OK;
}

/* Returns whether an element is a path none of whose parts is closed. */
static bool is_open(const svg_tag *tag)
{
  const thr_slice *data = thr_slice_is(tag->name, "path") ? find(tag, "d") : NULL;
  return data && data->n && !memchr(data->s, 'z', data->n) && !memchr(data->s, 'Z', data->n);
}

/* Draws a path, circle or rect, with ink inside and along the line as its style says. */
static thr_status draw_shape(svg_reader *reader, const svg_tag *tag)
{
  thr_ink fill;
  thr_line line;
  const thr_slice *transform = find(tag, "transform");

  thr_status st = push(reader, tag);
  if (!st && transform) {
    thr_paper_push(reader->paper);
    st = shift(reader, *transform);
  }

  if (st) return st;

  /* The element ends at once: its style is looked at and forgotten. */
  const thr_svg_style *style = &reader->open[--reader->depth].style;

  /* Only of a plain open line may parts outside the clip be left out: dashes count from the
   * beginning, and an area needs its whole outline. */
  bool filled = ink_of(style, THR_SVG_FILL, THR_SVG_FILL_OPACITY, &fill),
       drawn = line_of(style, &line);
  if (drawn && !filled && !line.n_dash && is_open(tag)) thr_paper_trim(reader->paper, &line);

  st = trace_shape(reader, tag);
  thr_paper_trim(reader->paper, NULL);
  if (st) return st;

  /* paint-order: stroke. The line is painted first, and the path built once more to be filled. */
  if (drawn && filled && style->value[THR_SVG_PAINT_ORDER].x[0] > 0) {
    thr_paper_paint(reader->paper, NULL, &line);
    st = trace_shape(reader, tag);
    drawn = false;
  }

  thr_paper_paint(reader->paper, filled ? &fill : NULL, drawn ? &line : NULL);
  if (transform) thr_paper_pop(reader->paper);
  return st;
}

/* ---- text ---- */

/* Reads what stands between a tag and its end: text without elements. */
static thr_status read_words(svg_reader *reader, const svg_tag *tag, thr_slice *words)
{
  svg_tag end;

  thr_status st = next_tag(reader, words, &end);
  if (!st && (!end.closes || end.name.n != tag->name.n ||
              memcmp(end.name.s, tag->name.s, end.name.n) != 0))
    return broken(reader, "not known inside it is", end.name);
  return st;
}

/* Fills reader->words with a text whose entities are replaced by what they stand for. */
static thr_status put_words(svg_reader *reader, thr_slice text)
{
  static const char *const entity[][2] = {
      {"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}};

  reader->words.length = 0;
  while (text.n) {
    /* Everything up to the next entity is copied as it is. */
    const char *ampersand = memchr(text.s, '&', text.n);
    size_t n = ampersand ? (size_t)(ampersand - text.s) : text.n, i = 0;
    thr_text_append_bytes(&reader->words, text.s, n);
    skip(&text, n);

    if (!text.n) break;

    /* Five entities are written; any other one is an error. */
    while (i < sizeof entity / sizeof *entity && !take_word(&text, entity[i][0]))
      i++;
    if (i == sizeof entity / sizeof *entity) return broken(reader, "not known is", text);
    thr_text_append(&reader->words, entity[i][1]);
  }
  return reader->words.failed ? thr_nomem(reader->err) : THR_OK;
}

/* Draws a text element: one line at x, y, anchored as its style says, without elements inside. */
static thr_status draw_text(svg_reader *reader, const svg_tag *tag)
{
  static const char *const name[] = {"x", "y"};
  double at[2];
  thr_slice words = {0};
  thr_line line;

  thr_status st = push(reader, tag);
  if (!st) st = read_numbers(reader, tag, 2, name, at);
  if (!st) st = read_words(reader, tag, &words);
  if (!st) st = put_words(reader, words);
  if (st) return st;

  /* Size, weight and family choose the face; the anchor is a share of the width. */
  const thr_svg_style *style = &reader->open[--reader->depth].style;
  thr_letters letters = {.size = style->value[THR_SVG_FONT_SIZE].x[0],
                         .anchor = 0.5 * style->value[THR_SVG_ANCHOR].x[0],
                         .bold = style->value[THR_SVG_FONT_WEIGHT].x[0] > 0,
                         .mono = style->value[THR_SVG_FONT_FAMILY].x[0] > 0};

  /* Letters are filled, never outlined. */
  if (line_of(style, &line)) return broken(reader, "a border is not known of the text", words);
  if (ink_of(style, THR_SVG_FILL, THR_SVG_FILL_OPACITY, &letters.ink) && reader->words.length)
    thr_paper_text(reader->paper, at, &letters, reader->words.data);
  return THR_OK;
}

/* ---- containers ---- */

/* Clips what is drawn from now on to the path that clip-path="url(#id)" names. The last one of a
 * name counts. */
static thr_status clip_to(svg_reader *reader, thr_slice text)
{
  for (int i = reader->n_clips - 1; i >= 0; i--) {
    /* text is "url(#", the id and ")". */
    const clip_rectangle *path = &reader->clip[i];
    if (text.n != path->id.n + 6 || memcmp(text.s, "url(#", 5) != 0 ||
        memcmp(text.s + 5, path->id.s, path->id.n) != 0)
      continue;

    /* What was clipped before stays clipped: the new box is inside the old one. */
    thr_paper_rect(reader->paper, path->at, path->size, 0);
    thr_paper_clip(reader->paper);
    return THR_OK;
  }
  return broken(reader, "not known is the clipping path", text);
}

/* Opens a group: the page's state is saved, then translated and clipped. */
static thr_status open_group(svg_reader *reader, const svg_tag *tag)
{
  const thr_slice *transform = find(tag, "transform"), *clipping = find(tag, "clip-path");
  thr_status st = push(reader, tag);
  if (st) return st;

  /* close_element restores what is saved here. */
  thr_paper_push(reader->paper);
  if (transform) st = shift(reader, *transform);
  if (!st && clipping) st = clip_to(reader, *clipping);
  return st;
}

/* Reads <clipPath id=".."><rect ../></clipPath> and remembers the rectangle. */
static thr_status read_clip(svg_reader *reader, const svg_tag *tag)
{
  static const char *const name[] = {"x", "y", "width", "height"};
  const thr_slice *id = find(tag, "id");
  double number[4] = {0};
  thr_slice between;
  svg_tag inner;

  if (!id || reader->n_clips == CLIPS)
    return broken(reader, "one too many, or without a name, is", tag->name);

  /* Just a rect with its four sides, then the end. */
  thr_status st = next_tag(reader, &between, &inner);
  if (!st && (!thr_slice_is(inner.name, "rect") || inner.n_attributes != 4))
    return broken(reader, "no plain rectangle clips:", inner.name);

  if (!st) st = read_numbers(reader, &inner, 4, name, number);
  if (!st) st = read_words(reader, tag, &between);

  /* The slice stays valid as long as the document. */
  reader->clip[reader->n_clips++] =
      (clip_rectangle){.id = *id, .at = {number[0], number[1]}, .size = {number[2], number[3]}};
  return st;
}

/* Closes the innermost open element, which must have the tag's name. */
static thr_status close_element(svg_reader *reader, const svg_tag *tag)
{
  const thr_slice *name = reader->depth ? &reader->open[reader->depth - 1].element.name : NULL;
  if (!name || name->n != tag->name.n || memcmp(name->s, tag->name.s, name->n) != 0)
    return broken(reader, "not open is", tag->name);

  /* Only groups have saved a state of the page. */
  if (thr_slice_is(tag->name, "g")) thr_paper_pop(reader->paper);
  reader->depth--;
  return THR_OK;
}

/* Reads one element, or its beginning or end. */
static thr_status read_element(svg_reader *reader, const svg_tag *tag)
{
  thr_slice words = {0};
  if (tag->closes) return close_element(reader, tag);

  /* Shapes have no content. */
  if (thr_slice_is(tag->name, "path") || thr_slice_is(tag->name, "rect") ||
      thr_slice_is(tag->name, "circle"))
    return tag->empty ? draw_shape(reader, tag) : broken(reader, "open is", tag->name);

  /* Containers and text have some. */
  if (tag->empty) return broken(reader, "empty is", tag->name);
  if (thr_slice_is(tag->name, "g")) return open_group(reader, tag);
  if (thr_slice_is(tag->name, "text")) return draw_text(reader, tag);
  if (thr_slice_is(tag->name, "svg")) return push(reader, tag);
  if (thr_slice_is(tag->name, "clipPath")) return read_clip(reader, tag);

  if (thr_slice_is(tag->name, "title") || thr_slice_is(tag->name, "desc"))
    return read_words(reader, tag, &words);

  /* A style sheet holds for what comes after it. */
  if (!thr_slice_is(tag->name, "style")) return broken(reader, "not known is", tag->name);
  thr_status st = read_words(reader, tag, &words);
  return st ? st : thr_svg_sheet_add(&reader->sheet, words, reader->err);
}

thr_status thr_svg_page(thr_paper *paper, const thr_text *svg, thr_err *err)
{
  if (svg->failed) return thr_nomem(err);
  thr_err why = {0};

  /* Some kilobytes, mostly styles of open elements: kept off the stack. */
  svg_reader *reader = thr_calloc(1, sizeof *reader);
  if (!reader) return thr_nomem(err);
  *reader = (svg_reader){.paper = paper, .left = {svg->data, svg->length}, .err = err ? err : &why};

  thr_status st = THR_OK;

  bool drawn = false;
  while (reader->left.n && !st) {
    thr_slice between;
    svg_tag tag;

    /* Tag by tag; outside of text elements there are only blanks between tags. */
    st = next_tag(reader, &between, &tag);
    if (!st && thr_slice_trim(between).n) st = broken(reader, "not known are the words", between);
    if (!st && tag.name.n) st = read_element(reader, &tag);

    drawn = drawn || reader->depth > 0;
  }

  /* Everything that was opened must be closed at the end. */
  if (!st && (!drawn || reader->depth))
    st = broken(reader, "not a whole SVG document ends with", reader->left);

  thr_svg_sheet_destroy(&reader->sheet);
  thr_text_destroy(&reader->words);
  free(reader);
  return st;
}
