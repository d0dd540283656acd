/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the style of an SVG element, for the SVG that diagram/ writes.
 *
 * Styles come from presentation attributes, from style="..", and from style sheets. Selectors are
 * lists of elements and classes with blanks between them, as ".view-1 .place text.own", and
 * :not([stroke-dasharray]). All properties are inherited. Rules are kept in the order of their
 * specificity, 16 for each class and :not, 1 for an element, and of equal ones the later wins (CSS
 * 2.1, 6.4.3). Whatever is not known is an error.
 *
 * Example: ".place text{fill:#222}" (17) beats "text{fill:#666}" (1) wherever it stands. */
#include "diagram/export/export_parts.h"

#include "graph/number.h"

#include <stdlib.h>
#include <string.h>

/* ---- text ---- */

bool thr_slice_is(thr_slice slice, const char *word)
{
  if (slice.n && *slice.s != *word) return false;
  return strlen(word) == slice.n && memcmp(slice.s, word, slice.n) == 0;
}

/* Returns whether a character is white space. */
static bool is_blank(char c)
{
  return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

thr_slice thr_slice_trim(thr_slice slice)
{
  while (slice.n && is_blank(*slice.s))
    slice = (thr_slice){slice.s + 1, slice.n - 1};
  while (slice.n && is_blank(slice.s[slice.n - 1]))
    slice.n--;
  return slice;
}

/* Reads a number such as "-12.34" of so few digits that both the digits, as a whole number, and the
 * power of ten are exact doubles. Then their quotient is rounded once and is the nearest double.
 * Returns false for anything else. */
static bool read_few_digits(const char *text, size_t n, double *value)
{
  enum { MOST = 15 };
  static const double power[MOST + 1] = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                         1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool minus = n && *text == '-';
  int64_t digits = 0;
  int behind = -1; /* digits behind the point; -1: there is none yet */
  if (n <= minus || n > MOST || (text[minus] == '.' && n == 1u + minus)) return false;

  /* All digits make one whole number; count those behind the point. */
  for (size_t i = minus; i < n; i++) {
    if (text[i] == '.' && behind >= 0) return false;
    if (text[i] != '.') digits = 10 * digits + (text[i] - '0');
    behind += behind >= 0 || text[i] == '.';
  }

  *value = (double)(minus ? -digits : digits) / power[behind > 0 ? behind : 0];
  return true;
}

bool thr_slice_number(thr_slice *text, double *value)
{
  size_t n = 0, end;

  /* Blanks and commas before the number. */
  while (n < text->n && (is_blank(text->s[n]) || text->s[n] == ','))
    n++;

  /* A sign, digits and points. No exponents: nothing here writes any. */
  for (end = n + (n < text->n && text->s[n] == '-'); end < text->n; end++)
    if ((text->s[end] < '0' || text->s[end] > '9') && text->s[end] != '.') break;

  /* The fast way, or the exact one for long numbers. */
  if (!read_few_digits(text->s + n, end - n, value) &&
      !thr_number_parse(text->s + n, end - n, value))
    return false;

  *text = (thr_slice){text->s + end, text->n - end};
  return true;
}

/* Takes off the front of a text what stands before a character, and the character; everything if
 * the character is not there. Returns what was before it, trimmed. */
static thr_slice take_until(thr_slice *text, char stop)
{
  const char *end = text->n ? memchr(text->s, stop, text->n) : NULL;
  thr_slice taken = {text->s, end ? (size_t)(end - text->s) : text->n};
  size_t used = taken.n + (end != NULL);

  *text = (thr_slice){text->s + used, text->n - used};
  return thr_slice_trim(taken);
}

/* Fails with the first 60 bytes of what is not known. */
static thr_status unknown(const char *what, thr_slice words, thr_err *err)
{
  return thr_fail(err, THR_ESOLVER, "a page cannot be drawn: its %s '%.*s' is not known", what,
                  (int)(words.n < 60 ? words.n : 60), words.s);
}

/* ---- properties ---- */

/* How the values of a property are written. */
typedef enum { COLOUR, NUMBERS, WORD } value_kind;

/* Words that a property may have, at most. */
enum { WORDS = 3 };

/* All properties, in the order of thr_svg_property. */
static const struct {
  const char *name;
  value_kind kind;
  int most;                /* numbers of a value, at most */
  const char *word[WORDS]; /* of WORD: the value is the index of the word */
} property[THR_SVG_PROPERTIES] = {
    [THR_SVG_FILL] = {"fill", COLOUR, 3, {NULL}},
    [THR_SVG_STROKE] = {"stroke", COLOUR, 3, {NULL}},
    [THR_SVG_FILL_OPACITY] = {"fill-opacity", NUMBERS, 1, {NULL}},
    [THR_SVG_STROKE_OPACITY] = {"stroke-opacity", NUMBERS, 1, {NULL}},
    [THR_SVG_STROKE_WIDTH] = {"stroke-width", NUMBERS, 1, {NULL}},
    [THR_SVG_LINECAP] = {"stroke-linecap", WORD, 1, {"butt", "round"}},
    [THR_SVG_LINEJOIN] = {"stroke-linejoin", WORD, 1, {"miter", "round"}},
    [THR_SVG_DASHARRAY] = {"stroke-dasharray", NUMBERS, 4, {NULL}},
    [THR_SVG_DASHOFFSET] = {"stroke-dashoffset", NUMBERS, 1, {NULL}},
    [THR_SVG_ANCHOR] = {"text-anchor", WORD, 1, {"start", "middle", "end"}},
    [THR_SVG_FONT_SIZE] = {"font-size", NUMBERS, 1, {NULL}},
    [THR_SVG_FONT_WEIGHT] = {"font-weight", WORD, 1, {"normal", "bold"}},
    [THR_SVG_FONT_FAMILY] = {"font-family", WORD, 1, {"'DejaVu Sans'", "'DejaVu Sans Mono'"}},
    [THR_SVG_PAINT_ORDER] = {"paint-order", WORD, 1, {"normal", "stroke"}},
};

thr_svg_style thr_svg_style_first(void)
{
  thr_svg_style style = {{{0}}};

  /* No stroke and no dashes; what would be drawn is opaque, lines are 1 wide. */
  for (int i = 0; i < THR_SVG_PROPERTIES; i++)
    style.value[i].n = i == THR_SVG_STROKE || i == THR_SVG_DASHARRAY ? 0 : property[i].most;
  style.value[THR_SVG_FILL_OPACITY].x[0] = style.value[THR_SVG_STROKE_OPACITY].x[0] =
      style.value[THR_SVG_STROKE_WIDTH].x[0] = 1;

  style.value[THR_SVG_FONT_SIZE].x[0] = 16;
  return style;
}

/* Returns the number of a property, or -1 if the name is not known. */
static int find_property(thr_slice name)
{
  for (int i = 0; i < THR_SVG_PROPERTIES; i++)
    if (thr_slice_is(name, property[i].name)) return i;
  return -1;
}

bool thr_svg_is_property(thr_slice name)
{
  return find_property(name) >= 0;
}

/* Returns the value of a hexadecimal digit, or -1. */
static int hex_digit(char c)
{
  const char *digits = "0123456789abcdef",
             *at = c ? strchr(digits, c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c) : NULL;
  return at ? (int)(at - digits) : -1;
}

/* Reads "#rgb" or "#rrggbb" into three numbers from 0 to 1. */
static bool read_colour(thr_slice text, thr_svg_value *value)
{
  if ((text.n != 4 && text.n != 7) || *text.s != '#') return false;

  /* A single digit counts twice: #fc8 is #ffcc88. */
  size_t each = text.n / 3;
  for (size_t i = 0; i < 3; i++) {
    int high = hex_digit(text.s[1 + i * each]), low = hex_digit(text.s[i * each + each]);
    if (high < 0 || low < 0) return false;
    value->x[i] = (16 * high + low) / 255.0;
  }

  value->n = 3;
  return true;
}

/* Reads 1 to most numbers. */
static bool read_numbers(thr_slice text, int most, thr_svg_value *value)
{
  for (value->n = 0; text.n; value->n++)
    if (value->n == most || !thr_slice_number(&text, &value->x[value->n])) return false;
  return value->n > 0;
}

/* Reads one of the words of a property into the word's index; of a list of fonts the first one
 * counts. */
static bool read_word(thr_slice text, const char *const *word, thr_svg_value *value)
{
  thr_slice first = take_until(&text, ',');

  /* Words are compared as they are written here, quotes and all. */
  for (int i = 0; i < WORDS && word[i]; i++)
    if (thr_slice_is(first, word[i])) {
      *value = (thr_svg_value){1, {i}};
      return true;
    }
  return false;
}

/* Reads a property's value. *which receives the property. */
static thr_status read_property(thr_slice name, thr_slice text, int *which, thr_svg_value *value,
                                thr_err *err)
{
  *which = find_property(name);
  *value = (thr_svg_value){0};

  /* An unknown property might change the picture. */
  if (*which < 0) return unknown("property", name, err);
  value_kind how = property[*which].kind;

  /* Three properties may be "none", which is no number at all. */
  bool may_lack = how == COLOUR || *which == THR_SVG_DASHARRAY,
       ok = may_lack && thr_slice_is(text, "none");

  if (!ok && how == COLOUR) ok = read_colour(text, value);
  if (!ok && how == NUMBERS) ok = read_numbers(text, property[*which].most, value);
  if (!ok && how == WORD) ok = read_word(text, property[*which].word, value);

  return ok ? THR_OK : unknown(property[*which].name, text, err);
}

thr_status thr_svg_style_set(thr_svg_style *style, thr_slice name, thr_slice text, thr_err *err)
{
  int which;
  thr_svg_value value;
  thr_status st = read_property(name, thr_slice_trim(text), &which, &value, err);
  if (!st) style->value[which] = value;
  return st;
}

thr_status thr_svg_style_list(thr_svg_style *style, thr_slice list, thr_err *err)
{
  thr_status st = THR_OK;
  while (list.n && !st) {
    thr_slice text = take_until(&list, ';'), name = take_until(&text, ':');
    if (name.n) st = thr_svg_style_set(style, name, text, err);
  }
  return st;
}

/* ---- style sheets ---- */

enum { COMPOUNDS = 4, CLASSES = 2 }; /* of a selector; of a compound selector */

/* A compound selector such as "text.own:not([stroke-dasharray])". */
typedef struct {
  thr_slice name; /* of the element; empty = any */
  thr_slice class[CLASSES];
  int n_classes;
  bool not_dashed; /* does it ask for an element without stroke-dasharray? */
} compound_selector;

/* A rule: compound selectors with blanks between them, and declarations first .. end - 1. */
struct thr_svg_rule {
  compound_selector compound[COMPOUNDS]; /* the outermost element's first */
  int n, strength;                       /* compounds; what CSS calls specificity */
  int first, end;
};

/* What a rule sets a property to. */
struct thr_svg_declaration {
  int property;
  thr_svg_value value;
};

/* Returns how many bytes of a selector belong to the name at its front. */
static size_t word_length(thr_slice text)
{
  size_t n = 0;
  while (n < text.n && !strchr(".:#[>+~,*", text.s[n]))
    n++;
  return n;
}

/* Reads a compound selector: an element's name or none, then classes, then perhaps :not. */
static thr_status read_compound(thr_slice text, compound_selector *selector, thr_err *err)
{
  static const char not_dashed[] = ":not([stroke-dasharray])";
  thr_slice whole = text;
  *selector = (compound_selector){0};

  /* The element's name, up to a dot or a colon. */
  selector->name = (thr_slice){text.s, word_length(text)};
  text = (thr_slice){text.s + selector->name.n, text.n - selector->name.n};

  /* Classes, each with a dot before it. */
  while (text.n && *text.s == '.' && selector->n_classes < CLASSES) {
    thr_slice rest = {text.s + 1, text.n - 1}, name = {rest.s, word_length(rest)};
    selector->class[selector->n_classes++] = name;
    text = (thr_slice){rest.s + name.n, rest.n - name.n};
  }

  /* Only one more condition is known, and it must be the last. */
  selector->not_dashed = thr_slice_is(text, not_dashed);
  return !text.n || selector->not_dashed ? THR_OK : unknown("selector", whole, err);
}

/* Reads a rule's selector and adds up its specificity. */
static thr_status read_selector(thr_slice text, thr_svg_rule *rule, thr_err *err)
{
  thr_slice whole = text;
  thr_status st = THR_OK;
  while (text.n && !st) {
    thr_slice part = take_until(&text, ' ');

    /* Several blanks count as one. */
    if (!part.n) continue;
    if (rule->n == COMPOUNDS) return unknown("selector", whole, err);

    /* The blank is the only combinator: any element further in. */
    compound_selector *part_selector = &rule->compound[rule->n++];
    st = read_compound(part, part_selector, err);
    rule->strength +=
        16 * (part_selector->n_classes + part_selector->not_dashed) + (part_selector->name.n > 0);
  }

  return rule->n || st ? st : unknown("selector", whole, err);
}

/* Appends the declarations "property:value;.." of a rule to the sheet. */
static thr_status read_declarations(thr_svg_sheet *sheet, thr_slice list, thr_err *err)
{
  thr_status st = THR_OK;
  while (list.n && !st) {
    thr_slice text = take_until(&list, ';'), name = take_until(&text, ':');

    /* An empty declaration, as behind the last semicolon. */
    if (!name.n) continue;
    st = thr_grow(&sheet->declaration, sheet->n_declarations, &sheet->declarations_capacity,
                  sizeof *sheet->declaration, err);
    if (st) break;

    /* Values are read once here, not for every element that the rule meets. */
    thr_svg_declaration *next = &sheet->declaration[sheet->n_declarations++];
    st = read_property(name, text, &next->property, &next->value, err);
  }
  return st;
}

thr_status thr_svg_sheet_add(thr_svg_sheet *sheet, thr_slice css, thr_err *err)
{
  thr_status st = THR_OK;
  for (css = thr_slice_trim(css); css.n && !st; css = thr_slice_trim(css)) {
    thr_svg_rule rule = {.first = sheet->n_declarations};

    /* "selector{declarations}" */
    thr_slice selector = take_until(&css, '{'), list = take_until(&css, '}');
    st = read_selector(selector, &rule, err);
    if (!st) st = read_declarations(sheet, list, err);
    if (!st)
      st = thr_grow(&sheet->rule, sheet->n_rules, &sheet->rules_capacity, sizeof *sheet->rule, err);

    if (st) break;
    rule.end = sheet->n_declarations;

    /* Insert the rule behind all that are no stronger: the later of equal ones is applied last. */
    int at = sheet->n_rules++;
    for (; at > 0 && sheet->rule[at - 1].strength > rule.strength; at--)
      sheet->rule[at] = sheet->rule[at - 1];
    sheet->rule[at] = rule;
  }
  return st;
}

/* Returns whether a list of classes holds the wanted one. */
static bool has_class(thr_slice classes, thr_slice wanted)
{
  while (classes.n) {
    thr_slice one = take_until(&classes, ' ');
    if (one.n == wanted.n && memcmp(one.s, wanted.s, one.n) == 0) return true;
  }
  return false;
}

/* Returns whether an element meets a compound selector. */
static bool meets(const compound_selector *selector, const thr_svg_element *element)
{
  /* The name, if the selector has one; then all its classes. */
  if (selector->name.n && (selector->name.n != element->name.n ||
                           memcmp(selector->name.s, element->name.s, selector->name.n) != 0))
    return false;

  for (int i = 0; i < selector->n_classes; i++)
    if (!has_class(element->classes, selector->class[i])) return false;

  return !selector->not_dashed || !element->dashed;
}

/* Returns whether the last of n elements, each inside the one before, meets a rule. The last
 * compound is the element's own; those before it are matched greedily from the inside out, which
 * finds a match if there is one. */
static bool rule_meets(const thr_svg_rule *rule, const thr_svg_element *const *element, int n)
{
  int left = rule->n - 1;

  /* The innermost selector must meet the element itself. */
  if (!meets(&rule->compound[left], element[n - 1])) return false;
  for (int i = n - 2; i >= 0 && left > 0; i--)
    left -= meets(&rule->compound[left - 1], element[i]);

  return left == 0;
}

void thr_svg_sheet_apply(const thr_svg_sheet *sheet, const thr_svg_element *const *element, int n,
                         thr_svg_style *style)
{
  /* From the weakest rule to the strongest, so that the strongest is applied last. */
  for (int i = 0; i < sheet->n_rules; i++) {
    const thr_svg_rule *rule = &sheet->rule[i];

    if (!rule_meets(rule, element, n)) continue;
    for (int d = rule->first; d < rule->end; d++)
      style->value[sheet->declaration[d].property] = sheet->declaration[d].value;
  }
}

void thr_svg_sheet_destroy(thr_svg_sheet *sheet)
{
  free(sheet->rule);
  free(sheet->declaration);
  *sheet = (thr_svg_sheet){0};
}
