/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds what the columns of a table mean, by the words in their headers.
 *
 * A header is a few words in a row, of which one or two carry the meaning: "Knoten A", "node_a" and
 * "NodeA" are all the word "a" beside a word for nodes. So the tables below list words, and a
 * header matches if nothing else is in it. Words are English, German, French, Spanish and Italian.
 *
 * Example: "Anfang X [mm]" becomes "anfangx" with the unit mm: the first end of the pair anfang,
 * ende, and the axis x. */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <string.h>

/* Words that mean nodes, bars, or feet; words that may stand beside an axis or an end; and names of
 * columns with lines as text. */
static const char *const nodes[] = {"node",        "nodes", "joint", "point",  "punkt",  "knoten",
                                    "knotenpunkt", "noeud", "nodo",  "nudo",   "punto",  "vertex",
                                    "id",          "nr",    "no",    "num",    "number", "nummer",
                                    "numero",      "name",  "nom",   "nombre", "nome",   "label",
                                    "n",           "p",     "pt",    "k",      "v",      NULL};
static const char *const bars[] = {
    "bar",  "member", "element", "frame",  "rod",      "strut", "beam",  "edge",  "line",
    "stab", "kante",  "barre",   "barra",  "elemento", "asta",  "arete", "id",    "nr",
    "no",   "num",    "number",  "nummer", "numero",   "name",  "label", "index", NULL};
static const char *const beside_axis[] = {
    "coordinate", "coord",    "coords", "koordinate", "koord",  "coordonnee", "coordenada",
    "coordinata", "position", "pos",    "value",      "wert",   "global",     "axis",
    "node",       "joint",    "point",  "punkt",      "knoten", "noeud",      "nodo",
    "nudo",       "punto",    "vertex", "p",          NULL};
static const char *const beside_end[] = {
    "node",  "nodes", "joint",  "point",  "punkt",  "knoten", "knotenpunkt",
    "noeud", "nodo",  "nudo",   "punto",  "vertex", "id",     "nr",
    "no",    "num",   "number", "nummer", "numero", "name",   "label",
    "n",     "p",     "pt",     "k",      "v",      "end",    NULL};
static const char *const feet[] = {"issupport", "isgrounded", "isanchor", "isfixed",  "foot",
                                   "feet",      "support",    "fixed",    "anchor",   "grounded",
                                   "auflager",  "appui",      "apoyo",    "appoggio", NULL};
static const char *const lines[] = {"wkt", "geometry", "geom", "thegeom", "wktgeom", NULL};

/* Words for the two ends of an edge; the first pair that fits counts. */
static const char *const pairs[][2] = {{"a", "b"},
                                       {"u", "v"},
                                       {"i", "j"},
                                       {"1", "2"},
                                       {"source", "target"},
                                       {"from", "to"},
                                       {"start", "end"},
                                       {"begin", "end"},
                                       {"first", "second"},
                                       {"tail", "head"},
                                       {"anfang", "ende"},
                                       {"anfangs", "end"},
                                       {"von", "nach"},
                                       {"von", "bis"},
                                       {"debut", "fin"},
                                       {"de", "vers"},
                                       {"de", "a"},
                                       {"initial", "final"},
                                       {"origine", "extremite"},
                                       {"inicio", "fin"},
                                       {"inicial", "final"},
                                       {"desde", "hasta"},
                                       {"origen", "destino"},
                                       {"inizio", "fine"},
                                       {"iniziale", "finale"},
                                       {"da", "a"}};

bool thr_header_pair(int pair, const char *word[2])
{
  if (pair >= (int)(sizeof pairs / sizeof *pairs)) return false;
  memcpy(word, pairs[pair], sizeof pairs[pair]);
  return true;
}

/* Returns the letter without its accent of a character of two bytes in UTF-8; "" if it is none of
 * those that the words above need. */
static const char *plain_letter(const char *c)
{
  static const char *const accented[] = {"äÄàÀáÁâÂ", "éÉèÈêÊëË", "íÍìÌîÎ", "öÖóÓòÒôÔ",
                                         "üÜúÚùÙûÛ", "ñÑ",       "çÇ"};
  static const char *const letter[] = {"a", "e", "i", "o", "u", "n", "c"};

  /* Upper and lower case alternate in the lists, two bytes each. */
  for (size_t i = 0; i < sizeof letter / sizeof *letter; i++)
    for (const char *known = accented[i]; *known; known += 2)
      if (memcmp(c, known, 2) == 0) return letter[i];

  return memcmp(c, "œ", 2) == 0 ? "oe" : memcmp(c, "ß", 2) == 0 ? "ss" : "";
}

/* Returns the unit that a text names; NULL if it names none. A "foot" may be a support, too: the
 * caller knows. */
static const char *unit_in(thr_span text)
{
  char word[24];

  /* No unit has a longer name. */
  text = thr_span_trim(text);
  if (text.n == 0 || text.n >= sizeof word) return NULL;
  snprintf(word, sizeof word, "%.*s", (int)text.n, text.s);
  return thr_units_name(word);
}

/* Splits a header into its unit and a word of small letters and digits. */
thr_header thr_header_of(thr_span field)
{
  /* The unit first, then the word. */
  thr_header header = {"", ""};
  size_t n = 0;
  field = thr_span_trim(field);

  /* What is in brackets is a unit or a remark, and a last word of its own may be a unit. */
  size_t open = 0;
  while (open < field.n && field.s[open] != '[' && field.s[open] != '(')
    open++;

  if (open < field.n && open > 0) {
    size_t close = open + 1;

    while (close < field.n && field.s[close] != ']' && field.s[close] != ')')
      close++;

    const char *unit = unit_in((thr_span){field.s + open + 1, close - open - 1});
    if (unit) header.unit = unit;
    field.n = open;
  } else {
    size_t last = field.n;

    while (last > 0 && field.s[last - 1] != ' ' && field.s[last - 1] != '_')
      last--;

    const char *unit = last > 1 ? unit_in((thr_span){field.s + last, field.n - last}) : NULL;
    if (unit && strcmp(unit, "unit") != 0 &&
        !thr_span_is((thr_span){field.s + last, field.n - last}, "foot") &&
        !thr_span_is((thr_span){field.s + last, field.n - last}, "feet")) {
      header.unit = unit;
      field.n = last;
    }
  }

  /* Keep letters and digits, in lower case and without accents. */
  for (size_t i = 0; i < field.n && n + 3 < sizeof header.word; i++) {
    const char c = field.s[i];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'),
               digit = c >= '0' && c <= '9';
    if (letter || digit)
      header.word[n++] = (char)(letter ? c | 0x20 : c);
    else if ((unsigned char)c >= 0xc0 && i + 1 < field.n)
      n += (size_t)snprintf(header.word + n, sizeof header.word - n, "%s",
                            plain_letter(field.s + i++));
  }

  header.word[n] = '\0';
  return header;
}

/* Returns whether a text of n bytes is a sequence of some of these words, or empty. Computes which
 * prefixes are: reached[i] says that the first i bytes are such a sequence. */
static bool made_of(const char *text, size_t n, const char *const *words)
{
  bool reached[THR_HEADER_LENGTH + 1] = {true};

  for (size_t i = 0; i < n; i++)

    /* From each prefix, each word leads to a longer one. */
    for (int k = 0; reached[i] && words[k]; k++) {
      const size_t length = strlen(words[k]);
      if (i + length <= n && memcmp(text + i, words[k], length) == 0) reached[i + length] = true;
    }

  return reached[n];
}

/* Returns whether a header is one of these words, and nothing else. */
static bool is_one_of(const thr_header *header, const char *const *words)
{
  for (; *words; words++)
    if (strcmp(header->word, *words) == 0) return true;
  return false;
}

int thr_header_axis(const thr_header *header)
{
  const char *word = header->word;

  /* The letter may be anywhere, with words for nodes or coordinates around it. */
  for (size_t i = 0; word[i]; i++)
    if (word[i] >= 'x' && word[i] <= 'z' && made_of(word, i, beside_axis) &&
        made_of(word + i + 1, strlen(word + i + 1), beside_axis))
      return word[i] - 'x';

  return -1;
}

bool thr_header_names_nodes(const thr_header *header)
{
  return header->word[0] && made_of(header->word, strlen(header->word), nodes);
}

bool thr_header_names_bars(const thr_header *header)
{
  return header->word[0] && made_of(header->word, strlen(header->word), bars);
}

bool thr_header_feet(const thr_header *header)
{
  return is_one_of(header, feet);
}

bool thr_header_lines(const thr_header *header)
{
  return is_one_of(header, lines);
}

/* Tries each occurrence of the first word. */
bool thr_header_ends(const thr_header *a, const thr_header *b, const char *const word[2])
{
  const size_t n = strlen(word[0]), m = strlen(word[1]), length = strlen(a->word);

  /* Wherever the word of the first end is, the second header must have its own word there, and the
   * same words around it. */
  for (const char *at = strstr(a->word, word[0]); at; at = strstr(at + 1, word[0])) {
    const size_t before = (size_t)(at - a->word), after = length - before - n;
    if (strlen(b->word) == before + m + after && memcmp(b->word, a->word, before) == 0 &&
        memcmp(b->word + before, word[1], m) == 0 && strcmp(b->word + before + m, at + n) == 0 &&
        made_of(a->word, before, beside_end) && made_of(at + n, after, beside_end))
      return true;
  }

  return false;
}

int thr_header_end_axis(const thr_header *header, const char *word)
{
  /* Take the word of the end out; what is left must be a header of a coordinate. */
  for (const char *at = strstr(header->word, word); at; at = strstr(at + 1, word)) {
    thr_header rest = {"", ""};
    snprintf(rest.word, sizeof rest.word, "%.*s%s", (int)(at - header->word), header->word,
             at + strlen(word));
    const int axis = thr_header_axis(&rest);
    if (axis >= 0) return axis;
  }

  return -1;
}
