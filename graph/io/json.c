/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses a JSON document (RFC 8259) into one array of slots of eight bytes. A number is its own
 * double or a whole number of 48 bits; text, lists and objects are the distance in slots from the
 * slot that names them to a block of slots further on or back. Nothing is allocated for a value by
 * itself: [0.5, 2] takes three slots, a node's coordinates four.
 *
 * Blocks:
 *   text    its bytes and a NUL
 *   key     where the key begins in the document, then as text
 *   list    its size unless the size is below MANY, then the values
 *   object  its size, then a key and a value for each member; then, if there are many members,
 * their numbers in the order of their keys
 *
 * Why not a library: jansson and cJSON allocate each value by itself, and are 4 times slower on
 * large frameworks. */
#include "graph/io/json.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Either the bits of a finite double, or a tag above 48 bits of payload. The tags are bit patterns
 * of NaNs, which no number of a document can be. */
struct thr_json {
  uint64_t bits;
};

/* The tags. WORD: null, false, true or NaN; INT: a whole number of 48 bits; LONG: a pointing slot,
 * whose block is an int64_t; TEXT, ARRAY, OBJECT: pointing slots. */
enum {
  TAG_WORD = 0xfff9,
  TAG_INT,
  TAG_LONG,
  TAG_TEXT,
  TAG_ARRAY,
  TAG_OBJECT
}; /* LONG: its block is an int64_t */
enum { WORD_NULL, WORD_FALSE, WORD_TRUE, WORD_NAN };
/* MANY: sizes of lists from here on are in the block; FEW_MEMBERS: up to so many are looked through
 * one by one; DEEPEST: lists and objects in each other, which the parser enters by recursion. */
enum { MANY = 15, FEW_MEMBERS = 8, DEEPEST = 2048 };

static const int64_t INT_LIMIT = (int64_t)1 << 47; /* of what fits into a slot */

/* Returns the tag; that of a double is below TAG_WORD or the sign and exponent of a negative
 * number. */
static unsigned tag_of(const thr_json *value)
{
  return (unsigned)(value->bits >> 48);
}

/* Returns whether a slot names a block. */
static bool is_pointing(uint64_t bits)
{
  return bits >> 48 >= TAG_LONG;
}

/* Returns the 48 bits of payload with their sign. */
static int64_t payload_of(const thr_json *value)
{
  return (int64_t)(value->bits << 16) / 65536;
}

/* Returns a slot of a tag and a payload. */
static uint64_t tagged(unsigned tag, int64_t payload)
{
  return (uint64_t)tag << 48 | ((uint64_t)payload & 0xffffffffffffu);
}

/* Returns the block that a pointing slot names. The payload is 16 times the distance in slots plus
 * the size of a short list. */
static const thr_json *block_of(const thr_json *value)
{
  return value + (payload_of(value) - (payload_of(value) & 15)) / 16;
}

/* Returns a slot that names a block. */
static uint64_t pointing(unsigned tag, int64_t distance, unsigned size)
{
  return tagged(tag, distance * 16 + size);
}

/* ---- what is in a document ---- */

thr_json_type thr_json_typeof(const thr_json *value)
{
  if (!value) return THR_JSON_NULL;

  /* Words are three types; any other tag is one. */
  switch (tag_of(value)) {
  case TAG_WORD:
    return payload_of(value) == WORD_NULL  ? THR_JSON_NULL
           : payload_of(value) == WORD_NAN ? THR_JSON_NAN
                                           : THR_JSON_BOOL;
  case TAG_TEXT: return THR_JSON_STRING;
  case TAG_ARRAY: return THR_JSON_ARRAY;
  case TAG_OBJECT: return THR_JSON_OBJECT;
  default: return THR_JSON_NUMBER;
  }
}

/* Returns whether a value is there and has the tag. */
static bool is(const thr_json *value, unsigned tag)
{
  return value && tag_of(value) == tag;
}

/* Returns the number of values of a list, or of members of an object. */
static size_t count_of(const thr_json *value)
{
  unsigned size = (unsigned)(value->bits & 15);
  return tag_of(value) == TAG_ARRAY && size < MANY ? size : (size_t)block_of(value)->bits;
}

/* Returns the text in a block. */
static const char *text_of(const thr_json *block)
{
  return (const char *)block;
}

/* Returns the key of member i; its value is the next slot. */
static const thr_json *key_at(const thr_json *object, size_t i)
{
  return block_of(object) + 1 + 2 * i;
}

/* Returns the text of a key, after the slot that says where the key is in the document. */
static const char *key_text(const thr_json *key)
{
  return text_of(block_of(key) + 1);
}

/* Returns the value of the member with the key, by binary search in the members' order after the
 * last one; NULL if there is none. */
static const thr_json *find(const thr_json *object, size_t n, const char *key)
{
  const thr_json *order = key_at(object, n);
  size_t low = 0, high = n;

  /* The members' numbers are sorted by key. */
  while (low < high) {
    size_t middle = (low + high) / 2;
    const thr_json *found = key_at(object, (size_t)order[middle].bits);
    int way = strcmp(key, key_text(found));
    if (way == 0) return found + 1;
    if (way < 0)
      high = middle;
    else
      low = middle + 1;
  }

  return NULL;
}

const thr_json *thr_json_get(const thr_json *object, const char *key)
{
  if (!is(object, TAG_OBJECT)) return NULL;
  size_t n = count_of(object);

  /* Few members are looked through faster than searched. */
  if (n > FEW_MEMBERS) return find(object, n, key);
  for (size_t i = 0; i < n; i++)
    if (strcmp(key_text(key_at(object, i)), key) == 0) return key_at(object, i) + 1;

  return NULL;
}

int thr_json_size(const thr_json *value)
{
  return is(value, TAG_ARRAY) || is(value, TAG_OBJECT) ? (int)count_of(value) : 0;
}

const thr_json *thr_json_at(const thr_json *array, int i)
{
  if (!is(array, TAG_ARRAY) || i < 0 || (size_t)i >= count_of(array)) return NULL;
  return block_of(array) + ((array->bits & 15) == MANY) + i;
}

const char *thr_json_string(const thr_json *value)
{
  return is(value, TAG_TEXT) ? text_of(block_of(value)) : NULL;
}

/* Reads a whole number of either size; returns false for any other value. */
static bool whole_of(const thr_json *value, int64_t *out)
{
  if (is(value, TAG_INT)) *out = payload_of(value);
  if (is(value, TAG_LONG)) memcpy(out, block_of(value), sizeof *out);
  return is(value, TAG_INT) || is(value, TAG_LONG);
}

bool thr_json_number(const thr_json *value, double *out)
{
  int64_t whole;
  if (thr_json_typeof(value) != THR_JSON_NUMBER) return false;
  if (whole_of(value, &whole))
    *out = (double)whole;
  else
    memcpy(out, value, sizeof *out);
  return true;
}

bool thr_json_int(const thr_json *value, int64_t *out)
{
  double real;

  if (whole_of(value, out)) return true;
  if (!thr_json_number(value, &real) || real != floor(real) || fabs(real) > 9007199254740992.0)

    /* Beyond 2^53 not every integer is a double, so that the number may have been rounded. */
    return false;
  *out = (int64_t)real;

  return true;
}

bool thr_json_numbers(const thr_json *array, int n, double *out)
{
  const thr_json *value = n > 0 && thr_json_size(array) >= n ? thr_json_at(array, 0) : NULL;
  for (int i = 0; i < n; i++)
    if (!value || !thr_json_number(value + i, &out[i])) return false;
  return true;
}

bool thr_json_indices(const thr_json *array, int n, int limit, int *out)
{
  const thr_json *value = n > 0 && thr_json_size(array) >= n ? thr_json_at(array, 0) : NULL;
  int64_t whole;

  /* The values of a list follow one another. */
  for (int i = 0; i < n; i++) {
    if (!value || !thr_json_int(value + i, &whole) || whole < 0 || whole >= limit) return false;
    out[i] = (int)whole;
  }

  return true;
}

bool thr_json_true(const thr_json *value)
{
  double real;
  return value && (value->bits == tagged(TAG_WORD, WORD_TRUE) ||
                   (thr_json_number(value, &real) && real != 0));
}

bool thr_json_next(const thr_json *object, void **iter, const char **key, const thr_json **value)
{
  if (!is(object, TAG_OBJECT)) return false;

  /* A key takes one slot, and its value the next one. */
  const thr_json *at = *iter ? (const thr_json *)*iter + 2 : key_at(object, 0);
  if (at == key_at(object, count_of(object))) return false;
  *iter = (void *)(size_t)at;
  *key = key_text(at);
  *value = at + 1;
  return true;
}

const char *thr_json_unknown(const thr_json *object, const char *const *known)
{
  void *iter = NULL;
  const char *key;
  const thr_json *value;

  /* Each key must be among those known. */
  while (thr_json_next(object, &iter, &key, &value)) {
    int i = 0;
    while (known[i] && strcmp(known[i], key) != 0)
      i++;
    if (!known[i]) return key;
  }

  return NULL;
}

/* ---- parsing ---- */

/* A growing array of slots. */
typedef struct {
  thr_json *slot;
  size_t n, capacity;
} slots;

/* The state of one parsing. */
typedef struct {
  const char *text, *at, *end, *name;
  thr_err *err;
  slots done; /* the document: slot 0 is its root */
  slots open; /* values of lists and objects that are not closed; what is pointing there says the
                 slot in done itself */
  int depth;
  bool python; /* NaN and Infinity are values */
} json_parsing;

/* Makes room for `more` slots; capacities double, so that appending takes constant time on
 * average. */
static thr_status reserve(slots *list, size_t more, thr_err *err)
{
  /* Nothing to do, most often. */
  if (list->n + more <= list->capacity) return THR_OK;
  size_t wanted = list->capacity ? 2 * list->capacity : 64;
  while (wanted < list->n + more)
    wanted *= 2;

  thr_json *slot = thr_realloc(list->slot, wanted, sizeof *slot);
  if (!slot) return thr_nomem(err);
  list->slot = slot;
  list->capacity = wanted;

  return THR_OK;
}

/* Appends a value to the open ones. */
static inline thr_status push(json_parsing *parsing, uint64_t bits)
{
  if (parsing->open.n == parsing->open.capacity) {
    thr_status st = reserve(&parsing->open, 1, parsing->err);
    if (st) return st;
  }
  parsing->open.slot[parsing->open.n++].bits = bits;
  return THR_OK;
}

/* Records THR_EINPUT with line and column of the place, both from 1; columns count letters, not
 * bytes. */
static thr_status fail_at(const json_parsing *parsing, const char *place, const char *what)
{
  int line = 1, column = 1;
  for (const char *c = parsing->text; c < place; c++) {
    column = *c == '\n' ? 1 : column + !thr_text_is_inside(*c);
    line += *c == '\n';
  }
  return thr_fail(parsing->err, THR_EINPUT, "%s:%d:%d: not valid JSON: %s", parsing->name, line,
                  column, what);
}

/* Records THR_EINPUT with what was expected, and the beginning of what is there instead. */
static thr_status expected(const json_parsing *parsing, const char *what)
{
  enum { SHOWN = 20 };
  size_t n = 0, left = (size_t)(parsing->end - parsing->at);
  char near[120];

  /* Show one word or sign, and no part of a letter. */
  while (n < left && n < SHOWN && parsing->at[n] &&
         (n == 0 || !strchr(" \t\r\n,:[]{}\"", parsing->at[n])))
    n++;

  while (n > 0 && n < left && thr_text_is_inside(parsing->at[n]))
    n--;

  /* The document may end here. */
  if (left == 0)
    snprintf(near, sizeof near, "%s expected near end of file", what);
  else
    snprintf(near, sizeof near, "%s expected near '%.*s'", what, (int)n, parsing->at);

  return fail_at(parsing, parsing->at, near);
}

/* Moves past blanks. */
static inline void skip_blanks(json_parsing *parsing)
{
  const char *c = parsing->at;
  while (c < parsing->end && (*c == ' ' || *c == '\n' || *c == '\r' || *c == '\t'))
    c++;
  parsing->at = c;
}

/* Takes the letter c, after blanks, if it comes next; returns whether it did. */
static inline bool take(json_parsing *parsing, char c)
{
  skip_blanks(parsing);
  if (parsing->at == parsing->end || *parsing->at != c) return false;
  parsing->at++;
  return true;
}

/* ---- text ---- */

/* Returns the value of a hexadecimal digit, or -1. */
static int hex_digit(char c)
{
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Takes the four digits after \u, which p->at has passed; returns -1 if they are not there. */
static int take_unit(json_parsing *parsing)
{
  int code = 0;

  if (parsing->end - parsing->at < 4) return -1;

  /* All four must be digits. */
  for (int i = 0; i < 4; i++) {
    int digit = hex_digit(parsing->at[i]);
    if (digit < 0) return -1;
    code = 16 * code + digit;
  }

  parsing->at += 4;
  return code;
}

/* Appends a letter as UTF-8, of one to four bytes. */
static char *put_letter(char *out, int code)
{
  /* The first byte has as many leading ones as the letter has bytes; each further byte has six
   * bits. */
  int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  *out++ = (char)(more == 0 ? code : (0xff00 >> (more + 1) & 0xff) | code >> 6 * more);
  while (more-- > 0)
    *out++ = (char)(0x80 | (code >> 6 * more & 0x3f));
  return out;
}

/* Takes a letter as \uXXXX or, beyond 16 bits, as a pair of surrogates. */
static thr_status take_coded(json_parsing *parsing, const char *place, char **out)
{
  /* A high surrogate must be followed by a low one; each holds ten bits. */
  int code = take_unit(parsing);
  if (code >= 0xd800 && code < 0xdc00 && parsing->end - parsing->at >= 2 &&
      parsing->at[0] == '\\' && parsing->at[1] == 'u') {
    parsing->at += 2;
    int low = take_unit(parsing);
    code = low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : -1;
  }

  /* Half of a pair is no letter, and NUL would end the text. */
  if (code < 0 || (code >= 0xd800 && code < 0xe000))
    return fail_at(parsing, place, "invalid \\u escape");

  if (code == 0) return fail_at(parsing, place, "\\u0000 is not allowed");
  *out = put_letter(*out, code);
  return THR_OK;
}

/* Takes what follows a backslash, which p->at is at. */
static thr_status take_escape(json_parsing *parsing, char **out)
{
  /* One letter that stands for another. */
  static const char letter[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
  const char *place = parsing->at++, *found = parsing->at < parsing->end && *parsing->at
                                                  ? strchr(letter, *parsing->at)
                                                  : NULL;

  /* A short escape. */
  if (found) {
    *(*out)++ = meant[found - letter];
    parsing->at++;
    return THR_OK;
  }

  /* Or \u with four digits. */
  if (parsing->at == parsing->end || *parsing->at != 'u')
    return fail_at(parsing, place, "invalid escape");

  parsing->at++;
  return take_coded(parsing, place, out);
}

/* Returns the closing quote of the text that begins here, or the end of the document. */
static const char *end_of_text(const json_parsing *parsing)
{
  const char *c = parsing->at;
  while (c < parsing->end && *c != '"')
    c += *c == '\\' && c + 1 < parsing->end ? 2 : 1;
  return c;
}

/* Takes the text after an opening quote into a new block, which begins with the place of the text
 * if it is a key. Unescaped text is never longer than it was, so the space between the quotes is
 * enough. */
static thr_status take_text(json_parsing *parsing, bool key, uint64_t *bits)
{
  const char *begin = parsing->at, *end = end_of_text(parsing);
  size_t block = parsing->done.n;
  thr_status st =
      reserve(&parsing->done, (size_t)(end - begin) / sizeof(thr_json) + 1 + key, parsing->err);
  if (st) return st;

  if (key) parsing->done.slot[block].bits = (uint64_t)(begin - parsing->text);
  char *start = (char *)(parsing->done.slot + block + key), *out = start;

  /* Copy byte by byte. Control characters must be escaped, as the standard demands. */
  while (parsing->at < end && !st) {
    if (*parsing->at == '\\')
      st = take_escape(parsing, &out);
    else if ((unsigned char)*parsing->at < 0x20)
      st = fail_at(parsing, parsing->at,
                   "control character in text; write it as \\u and four digits");
    else
      *out++ = *parsing->at++;
  }
  if (st) return st;

  /* The end of the document came first. */
  if (parsing->at == parsing->end)
    return fail_at(parsing, begin - 1, "this text has no closing quote");
  *out++ = '\0';
  if (!thr_text_is_utf8(start, (size_t)(out - start - 1)))
    return fail_at(parsing, begin, "this text is not UTF-8");

  /* The block is whole slots; the distance is relative to the document until close_block. */
  parsing->at = end + 1;
  parsing->done.n +=
      (size_t)key + ((size_t)(out - start) + sizeof(thr_json) - 1) / sizeof(thr_json);
  *bits = pointing(TAG_TEXT, (int64_t)block, 0);

  return THR_OK;
}

/* ---- numbers and words ---- */

/* Returns whether c is a digit, and not the end. */
static bool is_digit(const json_parsing *parsing, const char *c)
{
  return c < parsing->end && *c >= '0' && *c <= '9';
}

/* Returns the first place from c on that is no digit. */
static const char *after_digits(const json_parsing *parsing, const char *c)
{
  while (is_digit(parsing, c))
    c++;
  return c;
}

/* Returns the end of the number that begins here, such as -0.5e+3; NULL if none does. *real becomes
 * whether it has a point or an exponent. */
static const char *end_of_number(const json_parsing *parsing, bool *real)
{
  /* Digits before the point: 0, or digits that do not begin with 0. */
  const char *at = parsing->at + (*parsing->at == '-');
  *real = false;
  if (!is_digit(parsing, at)) return NULL;
  at = *at == '0' ? at + 1 : after_digits(parsing, at);

  /* A point needs digits after it. */
  if (at < parsing->end && *at == '.') {
    *real = true;
    if (!is_digit(parsing, ++at)) return NULL;
    at = after_digits(parsing, at);
  }

  /* So does an exponent, after its sign. */
  if (at < parsing->end && (*at == 'e' || *at == 'E')) {
    *real = true;
    if (++at < parsing->end && (*at == '+' || *at == '-')) at++;
    if (!is_digit(parsing, at)) return NULL;
    at = after_digits(parsing, at);
  }

  return is_digit(parsing, at) ? NULL : at; /* no zeros in front */
}

/* Reads the digits before end, with their sign; returns false if the number is no int64_t. The
 * number is counted downwards, because there is one negative int64_t more. */
static bool read_whole(const char *c, const char *end, int64_t *whole)
{
  bool negative = *c == '-';
  *whole = 0;

  /* *whole - digit must not pass INT64_MIN. */
  for (c += negative; c < end; c++) {
    int digit = *c - '0';
    if (*whole < (INT64_MIN + digit) / 10) return false;
    *whole = 10 * *whole - digit;
  }

  /* The negative end has one number more. */
  if (!negative && *whole == INT64_MIN) return false;
  if (!negative) *whole = -*whole;
  return true;
}

/* Makes a whole number that needs a block. */
static thr_status put_long(json_parsing *parsing, int64_t whole, uint64_t *bits)
{
  thr_status st = reserve(&parsing->done, 1, parsing->err);
  if (st) return st;
  *bits = pointing(TAG_LONG, (int64_t)parsing->done.n, 0);
  parsing->done.slot[parsing->done.n++].bits = (uint64_t)whole;
  return THR_OK;
}

/* Makes a whole number, in a slot of its own if 48 bits are enough. */
static inline thr_status put_whole(json_parsing *parsing, int64_t whole, uint64_t *bits)
{
  if (whole < -INT_LIMIT || whole >= INT_LIMIT) return put_long(parsing, whole, bits);
  *bits = tagged(TAG_INT, whole);
  return THR_OK;
}

/* Returns how many of eight letters, in the order of memory with the first one lowest, are digits
 * at the beginning, and their value, without a branch. Bytes that are no digits are found together;
 * then digits become pairs, pairs fours, and fours the number, each by one multiplication. */
static int digits_of_eight(uint64_t letters, uint64_t *value)
{
  /* The top bit of a byte gets set by adding 0x46 to a byte above '9', or by subtracting '0' from a
   * byte below '0'. */
  const uint64_t others =
      ((letters + 0x4646464646464646u) | (letters - 0x3030303030303030u)) & 0x8080808080808080u;

  /* Shift the digits up so that zeros take the place of what is missing in front. */
  const int n = others ? __builtin_ctzll(others) / 8 : 8;
  uint64_t digits = n ? (letters & 0x0f0f0f0f0f0f0f0fu) << (64 - 8 * n) : 0; /* zeros in front */

  /* Least significant digits are in the highest bytes: in each step the lower half counts 10, 100,
   * 10000 times as much. */
  digits = (digits * 10 + (digits >> 8)) & 0x00ff00ff00ff00ffu;
  digits = (digits * 100 + (digits >> 16)) & 0x0000ffff0000ffffu;
  *value = (digits * 10000 + (digits >> 32)) & 0xffffffffu;
  return n;
}

/* Takes a whole number of at most eight digits, which most numbers of a framework are; returns
 * false, with nothing taken, if the number may be another one. */
static inline bool take_few_digits(json_parsing *parsing, uint64_t *bits)
{
  uint64_t letters, value;

  /* Eight bytes are read at once, so they must be there. */
  if (parsing->end - parsing->at <= 1 + (ptrdiff_t)sizeof letters) return false;
  const bool negative = *parsing->at == '-';
  const char *first = parsing->at + negative;
  memcpy(&letters, first, sizeof letters);
  const int n = digits_of_eight(letters, &value);

  /* A ninth digit, a point or an exponent makes it another number. */
  const char next = first[n];
  if (n == 0 || (*first == '0' && n > 1) || (next >= '0' && next <= '9') || next == '.' ||
      next == 'e' || next == 'E')
    return false;
  *bits = tagged(TAG_INT, negative ? -(int64_t)value : (int64_t)value);

  parsing->at = first + n;
  return true;
}

/* Takes any number: a whole one as int64_t, any other one as a double. */
static thr_status take_number(json_parsing *parsing, uint64_t *bits)
{
  bool real;
  double value;
  int64_t whole;
  const char *begin = parsing->at, *end = end_of_number(parsing, &real);

  /* Whole numbers are kept as such. */
  if (!end) return expected(parsing, "a number");
  parsing->at = end;
  if (!real)
    return read_whole(begin, end, &whole) ? put_whole(parsing, whole, bits)
                                          : fail_at(parsing, begin, "too big integer");

  /* Reals are read exactly (graph/number.h), and may be beyond a double. */
  if (!thr_number_parse(begin, (size_t)(end - begin), &value))
    return fail_at(parsing, begin, "real number overflow");

  memcpy(bits, &value, sizeof *bits);
  return THR_OK;
}

/* Takes the word if it comes next. */
static bool take_word(json_parsing *parsing, const char *word)
{
  size_t n = strlen(word);
  if ((size_t)(parsing->end - parsing->at) < n || memcmp(parsing->at, word, n) != 0) return false;
  parsing->at += n;
  return true;
}

/* ---- lists and objects ---- */

/* Moves the values from `first` on from the open ones to the document. What they point to becomes
 * relative to where they are now. */
static void close_block(json_parsing *parsing, size_t first)
{
  slots *done = &parsing->done;

  for (size_t i = first; i < parsing->open.n; i++, done->n++) {
    /* Distances are counted from slot 0 so far. */
    uint64_t bits = parsing->open.slot[i].bits;
    if (is_pointing(bits))
      bits = tagged((unsigned)(bits >> 48),
                    payload_of(&parsing->open.slot[i]) - 16 * (int64_t)done->n);
    done->slot[done->n].bits = bits;
  }

  parsing->open.n = first;
}

static thr_status parse_value(json_parsing *parsing, uint64_t *bits);

/* Takes a list after its opening bracket. */
static thr_status take_array(json_parsing *parsing, uint64_t *bits)
{
  size_t first = parsing->open.n;
  thr_status st = THR_OK;
  uint64_t value;

  /* The values, which stay among the open ones until the list is complete. */
  if (!take(parsing, ']')) {
    do {
      skip_blanks(parsing);
      st = take_few_digits(parsing, &value) ? THR_OK : parse_value(parsing, &value);
      if (!st) st = push(parsing, value);
    } while (!st && take(parsing, ','));
    if (!st && !take(parsing, ']')) st = expected(parsing, "']'");
  }

  /* The block: the size of a long list, and the values in one piece. */
  size_t n = parsing->open.n - first;
  if (!st) st = reserve(&parsing->done, n + 1, parsing->err);
  if (st) return st;
  *bits = pointing(TAG_ARRAY, (int64_t)parsing->done.n, n < MANY ? (unsigned)n : MANY);
  if (n >= MANY) parsing->done.slot[parsing->done.n++].bits = n;
  close_block(parsing, first);

  return THR_OK;
}

/* A key and the number of its member, for sorting. */
typedef struct {
  const char *key;
  size_t member;
} sorted_key;

/* Compares two keys as bytes, then by their place. */
static int by_key(const void *pa, const void *pb)
{
  const sorted_key *a = pa, *b = pb;
  int order = strcmp(a->key, b->key);
  return order ? order : (a->member > b->member) - (a->member < b->member);
}

/* Records THR_EINPUT at a key that is there a second time; the key's block says where. */
static thr_status repeated(const json_parsing *parsing, const sorted_key *second,
                           const thr_json *keys)
{
  char what[120];
  snprintf(what, sizeof what, "duplicate object key \"%s\"", second->key);
  return fail_at(parsing, parsing->text + block_of(keys + 2 * second->member)->bits, what);
}

/* Checks that no key of the object that ends the document is there twice, and appends the members'
 * order if there are many members. */
static thr_status sort_members(json_parsing *parsing, size_t block, size_t n)
{
  sorted_key *list = thr_calloc(n, sizeof *list);
  thr_status st = list ? reserve(&parsing->done, n, parsing->err) : thr_nomem(parsing->err);

  /* reserve may have moved the document: the keys are found only now. */
  const thr_json *key = parsing->done.slot + block + 1;
  for (size_t i = 0; i < n && !st; i++)
    list[i] = (sorted_key){key_text(key + 2 * i), i};

  if (!st) qsort(list, n, sizeof *list, by_key);

  /* Equal keys are neighbours. */
  for (size_t i = 1; i < n && !st; i++)
    if (strcmp(list[i - 1].key, list[i].key) == 0) st = repeated(parsing, &list[i], key);

  /* The order, for the binary search of thr_json_get. */
  for (size_t i = 0; i < n && !st && n > FEW_MEMBERS; i++)
    parsing->done.slot[parsing->done.n++].bits = list[i].member;

  free(list);
  return st;
}

/* Takes a key, a colon and a value. */
static thr_status take_member(json_parsing *parsing)
{
  uint64_t bits = 0;

  /* Only a text can be a key. */
  skip_blanks(parsing);
  if (parsing->at == parsing->end || *parsing->at != '"') return expected(parsing, "string or '}'");
  parsing->at++;
  thr_status st = take_text(parsing, true, &bits);
  if (!st) st = push(parsing, bits);

  if (!st && !take(parsing, ':')) st = expected(parsing, "':'");
  if (!st) st = parse_value(parsing, &bits);
  return st ? st : push(parsing, bits);
}

/* Takes an object after its opening brace. */
static thr_status take_object(json_parsing *parsing, uint64_t *bits)
{
  size_t first = parsing->open.n;
  thr_status st = THR_OK;

  /* Members, which stay among the open values until the object is complete. */
  if (!take(parsing, '}')) {
    do
      st = take_member(parsing);
    while (!st && take(parsing, ','));
    if (!st && !take(parsing, '}')) st = expected(parsing, "'}'");
  }

  /* The block: the number of members, the members, and their order. */
  size_t n = parsing->open.n - first, block = parsing->done.n;
  if (!st) st = reserve(&parsing->done, n + 1, parsing->err);
  if (st) return st;
  *bits = pointing(TAG_OBJECT, (int64_t)block, 0);
  parsing->done.slot[parsing->done.n++].bits = n / 2;
  close_block(parsing, first);

  return sort_members(parsing, block, n / 2);
}

/* Takes a list or an object, if it is not too deep. */
static thr_status parse_nested(json_parsing *parsing, uint64_t *bits)
{
  if (++parsing->depth > DEEPEST) return fail_at(parsing, parsing->at, "depth over 2048");
  thr_status st = *parsing->at++ == '[' ? take_array(parsing, bits) : take_object(parsing, bits);
  parsing->depth--;
  return st;
}

/* Takes any value. */
static thr_status parse_value(json_parsing *parsing, uint64_t *bits)
{
  skip_blanks(parsing);
  if (parsing->at == parsing->end) return expected(parsing, "a value");

  /* The first letter says which value comes. */
  switch (*parsing->at) {
  case '[':
  case '{': return parse_nested(parsing, bits);
  case '"': parsing->at++; return take_text(parsing, false, bits);
  case 'n':
    *bits = tagged(TAG_WORD, WORD_NULL);
    return take_word(parsing, "null") ? THR_OK : expected(parsing, "a value");
  case 'f':
    *bits = tagged(TAG_WORD, WORD_FALSE);
    return take_word(parsing, "false") ? THR_OK : expected(parsing, "a value");
  case 't':
    *bits = tagged(TAG_WORD, WORD_TRUE);
    return take_word(parsing, "true") ? THR_OK : expected(parsing, "a value");
  default: break;
  }

  /* What Python's json module writes for numbers that JSON has not. */
  const char *begin = parsing->at;
  if (take_word(parsing, "NaN") || take_word(parsing, "Infinity") ||
      take_word(parsing, "-Infinity")) {
    *bits = tagged(TAG_WORD, WORD_NAN);
    return parsing->python ? THR_OK
                           : fail_at(parsing, begin, "Python wrote NaN or Infinity; write null");
  }

  /* What is left is a number. */
  return *parsing->at == '-' || is_digit(parsing, parsing->at) ? take_number(parsing, bits)
                                                               : expected(parsing, "a value");
}

/* Takes the whole document: one list or object with nothing after it. */
static thr_status parse_document(json_parsing *parsing)
{
  uint64_t root = 0;

  /* Only blanks may come before and after. */
  skip_blanks(parsing);
  if (parsing->at == parsing->end)
    return thr_fail(parsing->err, THR_EINPUT, "%s:1: the file is empty", parsing->name);

  if (*parsing->at != '[' && *parsing->at != '{') return expected(parsing, "'[' or '{'");

  /* Slot 0 is the root, which is known last. */
  thr_status st = reserve(&parsing->done, 1, parsing->err);
  parsing->done.n = 1;
  if (!st) st = parse_value(parsing, &root);
  if (st) return st;
  skip_blanks(parsing);

  if (parsing->at < parsing->end) return expected(parsing, "end of file");
  parsing->done.slot[0].bits = root;
  return THR_OK;
}

/* Parses a text of n bytes; *doc is NULL after a failure. python: NaN and Infinity are values. */
static thr_status parse(thr_json **doc, const char *text, size_t n, const char *name, bool python,
                        thr_err *err)
{
  /* Windows editors leave a byte-order mark. */
  bool marked = n >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0;
  const char *begin = n == 0 ? "" : marked ? text + 3 : text;
  json_parsing parsing = {.text = begin,
                          .at = begin,
                          .end = n == 0 ? begin : text + n,
                          .name = name,
                          .python = python,
                          .err = err};

  thr_status st = parse_document(&parsing);
  free(parsing.open.slot);
  if (st) free(parsing.done.slot);
  *doc = st ? NULL : parsing.done.slot;

  return st;
}

thr_status thr_json_parse(thr_json **doc, const char *text, size_t n, const char *name,
                          thr_err *err)
{
  return parse(doc, text, n, name, false, err);
}

thr_status thr_json_parse_python(thr_json **doc, const char *text, size_t n, const char *name,
                                 thr_err *err)
{
  return parse(doc, text, n, name, true, err);
}

void thr_json_destroy(thr_json *doc)
{
  free(doc);
}
