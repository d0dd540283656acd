/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A JSON document as one array of slots of eight bytes. A number is its own double or a whole
 * number of 48 bits; text, lists and objects are the distance in slots from the slot that names
 * them to a block of slots further on or back. Nothing is allocated for a value by itself: [0.5, 2]
 * takes three slots, a node's coordinates four.
 *
 * Blocks:  text    its bytes and a NUL
 *          key     where it begins in the document, then as text
 *          list    its size unless that is below MANY, then the values
 *          object  its size, then a key and a value for each member, then if they are many the
 * members' numbers by their keys
 */
#include "graph/io/json.h"
#include "graph/number.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Either a finite double's bits, or a tag that only a NaN could have, above 48 bits. */
struct thr_json {
  uint64_t bits;
};

enum {
  TAG_WORD = 0xfff9,
  TAG_INT,
  TAG_LONG,
  TAG_TEXT,
  TAG_ARRAY,
  TAG_OBJECT
}; /* LONG: its block is an int64_t */
enum { WORD_NULL, WORD_FALSE, WORD_TRUE, WORD_NAN };
enum { MANY = 15, FEW_MEMBERS = 8, DEEPEST = 2048 };

static const int64_t INT_LIMIT = (int64_t)1 << 47; /* of what fits into a slot */

static unsigned tag_of(const thr_json *value)
{
  return (unsigned)(value->bits >> 48);
}

static bool is_pointing(uint64_t bits)
{
  return bits >> 48 >= TAG_LONG;
}

/* The 48 bits with their sign. */
static int64_t payload_of(const thr_json *value)
{
  return (int64_t)(value->bits << 16) / 65536;
}

static uint64_t tagged(unsigned tag, int64_t payload)
{
  return (uint64_t)tag << 48 | ((uint64_t)payload & 0xffffffffffffu);
}

/* What a pointing slot says: the distance, and of a short list its size. */
static const thr_json *block_of(const thr_json *value)
{
  return value + (payload_of(value) - (payload_of(value) & 15)) / 16;
}

static uint64_t pointing(unsigned tag, int64_t distance, unsigned size)
{
  return tagged(tag, distance * 16 + size);
}

/* ---- what is in a document ---- */

thr_json_type thr_json_typeof(const thr_json *value)
{
  if (!value) return THR_JSON_NULL;
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

static bool is(const thr_json *value, unsigned tag)
{
  return value && tag_of(value) == tag;
}

/* Values of a list, or members of an object. */
static size_t count_of(const thr_json *value)
{
  unsigned size = (unsigned)(value->bits & 15);
  return tag_of(value) == TAG_ARRAY && size < MANY ? size : (size_t)block_of(value)->bits;
}

static const char *text_of(const thr_json *block)
{
  return (const char *)block;
}

static const thr_json *key_at(const thr_json *object, size_t i)
{
  return block_of(object) + 1 + 2 * i;
}

static const char *key_text(const thr_json *key)
{
  return text_of(block_of(key) + 1);
}

/* The member with the key among many, by halving. */
static const thr_json *find(const thr_json *object, size_t n, const char *key)
{
  const thr_json *order = key_at(object, n);
  size_t low = 0, high = n;
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

/* A whole number in full. */
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
  double x;
  if (whole_of(value, out)) return true;
  if (!thr_json_number(value, &x) || x != floor(x) || fabs(x) > 9007199254740992.0) return false;
  *out = (int64_t)x;
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
  for (int i = 0; i < n; i++) {
    if (!value || !thr_json_int(value + i, &whole) || whole < 0 || whole >= limit) return false;
    out[i] = (int)whole;
  }
  return true;
}

bool thr_json_true(const thr_json *value)
{
  double x;
  return value &&
         (value->bits == tagged(TAG_WORD, WORD_TRUE) || (thr_json_number(value, &x) && x != 0));
}

bool thr_json_next(const thr_json *object, void **iter, const char **key, const thr_json **value)
{
  if (!is(object, TAG_OBJECT)) return false;
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
  while (thr_json_next(object, &iter, &key, &value)) {
    int i = 0;
    while (known[i] && strcmp(known[i], key) != 0)
      i++;
    if (!known[i]) return key;
  }
  return NULL;
}

/* ---- parsing ---- */

/* Slots that grow. */
typedef struct {
  thr_json *slot;
  size_t n, capacity;
} slots;

typedef struct {
  const char *text, *at, *end, *name;
  thr_err *err;
  slots done; /* the document: slot 0 is its root */
  slots open; /* values of lists and objects that are not closed; what is pointing there says the
                 slot in done itself */
  int depth;
  bool python; /* NaN and Infinity are values */
} parser;

static thr_status reserve(slots *list, size_t more, thr_err *err)
{
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

static inline thr_status push(parser *p, uint64_t bits)
{
  if (p->open.n == p->open.capacity) {
    thr_status st = reserve(&p->open, 1, p->err);
    if (st) return st;
  }
  p->open.slot[p->open.n++].bits = bits;
  return THR_OK;
}

/* The message says line and column of the place, both from 1. */
static thr_status fail_at(const parser *p, const char *place, const char *what)
{
  int line = 1, column = 1;
  for (const char *c = p->text; c < place; c++) {
    column = *c == '\n' ? 1 : column + !thr_text_is_inside(*c);
    line += *c == '\n';
  }
  return thr_fail(p->err, THR_EINPUT, "%s:%d:%d: not valid JSON: %s", p->name, line, column, what);
}

/* What was expected, and the beginning of what is there instead. */
static thr_status expected(const parser *p, const char *what)
{
  enum { SHOWN = 20 };
  size_t n = 0, left = (size_t)(p->end - p->at);
  char near[120];
  while (n < left && n < SHOWN && p->at[n] && (n == 0 || !strchr(" \t\r\n,:[]{}\"", p->at[n])))
    n++;
  while (n > 0 && n < left && thr_text_is_inside(p->at[n]))
    n--;
  if (left == 0)
    snprintf(near, sizeof near, "%s expected near end of file", what);
  else
    snprintf(near, sizeof near, "%s expected near '%.*s'", what, (int)n, p->at);
  return fail_at(p, p->at, near);
}

static inline void skip_blanks(parser *p)
{
  const char *c = p->at;
  while (c < p->end && (*c == ' ' || *c == '\n' || *c == '\r' || *c == '\t'))
    c++;
  p->at = c;
}

/* Is this what comes next? Then it is taken. */
static inline bool take(parser *p, char c)
{
  skip_blanks(p);
  if (p->at == p->end || *p->at != c) return false;
  p->at++;
  return true;
}

/* ---- text ---- */

static int hex_digit(char c)
{
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The four digits after \u, which p->at has passed; -1 if they are not there. */
static int take_unit(parser *p)
{
  int code = 0;
  if (p->end - p->at < 4) return -1;
  for (int i = 0; i < 4; i++) {
    int digit = hex_digit(p->at[i]);
    if (digit < 0) return -1;
    code = 16 * code + digit;
  }
  p->at += 4;
  return code;
}

static char *put_letter(char *out, int code)
{
  int more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  *out++ = (char)(more == 0 ? code : (0xff00 >> (more + 1) & 0xff) | code >> 6 * more);
  while (more-- > 0)
    *out++ = (char)(0x80 | (code >> 6 * more & 0x3f));
  return out;
}

/* A letter as \uXXXX or, beyond 16 bits, as two of these. */
static thr_status take_coded(parser *p, const char *place, char **out)
{
  int code = take_unit(p);
  if (code >= 0xd800 && code < 0xdc00 && p->end - p->at >= 2 && p->at[0] == '\\' &&
      p->at[1] == 'u') {
    p->at += 2;
    int low = take_unit(p);
    code = low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : -1;
  }
  if (code < 0 || (code >= 0xd800 && code < 0xe000)) return fail_at(p, place, "invalid \\u escape");
  if (code == 0) return fail_at(p, place, "\\u0000 is not allowed");
  *out = put_letter(*out, code);
  return THR_OK;
}

static thr_status take_escape(parser *p, char **out)
{
  static const char letter[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
  const char *place = p->at++, *found = p->at < p->end && *p->at ? strchr(letter, *p->at) : NULL;
  if (found) {
    *(*out)++ = meant[found - letter];
    p->at++;
    return THR_OK;
  }
  if (p->at == p->end || *p->at != 'u') return fail_at(p, place, "invalid escape");
  p->at++;
  return take_coded(p, place, out);
}

/* The closing quote of the text that begins here, or the end. */
static const char *end_of_text(const parser *p)
{
  const char *c = p->at;
  while (c < p->end && *c != '"')
    c += *c == '\\' && c + 1 < p->end ? 2 : 1;
  return c;
}

/* After the opening quote: the text into a new block, which begins with where it stands if it is a
 * key. Escaped text never gets longer than it was. */
static thr_status take_text(parser *p, bool key, uint64_t *bits)
{
  const char *begin = p->at, *end = end_of_text(p);
  size_t block = p->done.n;
  thr_status st = reserve(&p->done, (size_t)(end - begin) / sizeof(thr_json) + 1 + key, p->err);
  if (st) return st;
  if (key) p->done.slot[block].bits = (uint64_t)(begin - p->text);
  char *start = (char *)(p->done.slot + block + key), *out = start;
  while (p->at < end && !st) {
    if (*p->at == '\\')
      st = take_escape(p, &out);
    else if ((unsigned char)*p->at < 0x20)
      st = fail_at(p, p->at, "control character in text; write it as \\u and four digits");
    else
      *out++ = *p->at++;
  }
  if (st) return st;
  if (p->at == p->end) return fail_at(p, begin - 1, "this text has no closing quote");
  *out++ = '\0';
  if (!thr_text_is_utf8(start, (size_t)(out - start - 1)))
    return fail_at(p, begin, "this text is not UTF-8");
  p->at = end + 1;
  p->done.n += (size_t)key + ((size_t)(out - start) + sizeof(thr_json) - 1) / sizeof(thr_json);
  *bits = pointing(TAG_TEXT, (int64_t)block, 0);
  return THR_OK;
}

/* ---- numbers and words ---- */

static bool is_digit(const parser *p, const char *c)
{
  return c < p->end && *c >= '0' && *c <= '9';
}

static const char *after_digits(const parser *p, const char *c)
{
  while (is_digit(p, c))
    c++;
  return c;
}

/* What follows the number that begins here; NULL if none does: -0.5e+3. *real: it has a point or an
 * exponent. */
static const char *end_of_number(const parser *p, bool *real)
{
  const char *c = p->at + (*p->at == '-');
  *real = false;
  if (!is_digit(p, c)) return NULL;
  c = *c == '0' ? c + 1 : after_digits(p, c);
  if (c < p->end && *c == '.') {
    *real = true;
    if (!is_digit(p, ++c)) return NULL;
    c = after_digits(p, c);
  }
  if (c < p->end && (*c == 'e' || *c == 'E')) {
    *real = true;
    if (++c < p->end && (*c == '+' || *c == '-')) c++;
    if (!is_digit(p, c)) return NULL;
    c = after_digits(p, c);
  }
  return is_digit(p, c) ? NULL : c; /* no zeros in front */
}

/* The digits before end, with their sign; false if that is no int64_t. Counted downwards, where
 * there is one more. */
static bool read_whole(const char *c, const char *end, int64_t *whole)
{
  bool negative = *c == '-';
  *whole = 0;
  for (c += negative; c < end; c++) {
    int digit = *c - '0';
    if (*whole < (INT64_MIN + digit) / 10) return false;
    *whole = 10 * *whole - digit;
  }
  if (!negative && *whole == INT64_MIN) return false;
  if (!negative) *whole = -*whole;
  return true;
}

static thr_status put_long(parser *p, int64_t whole, uint64_t *bits)
{
  thr_status st = reserve(&p->done, 1, p->err);
  if (st) return st;
  *bits = pointing(TAG_LONG, (int64_t)p->done.n, 0);
  p->done.slot[p->done.n++].bits = (uint64_t)whole;
  return THR_OK;
}

static inline thr_status put_whole(parser *p, int64_t whole, uint64_t *bits)
{
  if (whole < -INT_LIMIT || whole >= INT_LIMIT) return put_long(p, whole, bits);
  *bits = tagged(TAG_INT, whole);
  return THR_OK;
}

/* The digits at the beginning of eight letters, which are in memory's order with the first one
 * lowest, and what they mean, without a branch: bytes that are no digits are found all at once,
 * then digits become pairs, these fours, and these the number.
 */
static int digits_of_eight(uint64_t letters, uint64_t *value)
{
  const uint64_t others =
      ((letters + 0x4646464646464646u) | (letters - 0x3030303030303030u)) & 0x8080808080808080u;
  const int n = others ? __builtin_ctzll(others) / 8 : 8;
  uint64_t digits = n ? (letters & 0x0f0f0f0f0f0f0f0fu) << (64 - 8 * n) : 0; /* zeros in front */
  digits = (digits * 10 + (digits >> 8)) & 0x00ff00ff00ff00ffu;
  digits = (digits * 100 + (digits >> 16)) & 0x0000ffff0000ffffu;
  *value = (digits * 10000 + (digits >> 32)) & 0xffffffffu;
  return n;
}

/* A whole number of few digits, which most numbers of a framework are, in one go; false: it may be
 * another. */
static inline bool take_few_digits(parser *p, uint64_t *bits)
{
  uint64_t letters, value;
  if (p->end - p->at <= 1 + (ptrdiff_t)sizeof letters) return false;
  const bool negative = *p->at == '-';
  const char *first = p->at + negative;
  memcpy(&letters, first, sizeof letters);
  const int n = digits_of_eight(letters, &value);
  const char next = first[n];
  if (n == 0 || (*first == '0' && n > 1) || (next >= '0' && next <= '9') || next == '.' ||
      next == 'e' || next == 'E')
    return false;
  *bits = tagged(TAG_INT, negative ? -(int64_t)value : (int64_t)value);
  p->at = first + n;
  return true;
}

static thr_status take_number(parser *p, uint64_t *bits)
{
  bool real;
  double value;
  int64_t whole;
  const char *begin = p->at, *end = end_of_number(p, &real);
  if (!end) return expected(p, "a number");
  p->at = end;
  if (!real)
    return read_whole(begin, end, &whole) ? put_whole(p, whole, bits)
                                          : fail_at(p, begin, "too big integer");
  if (!thr_number_parse(begin, (size_t)(end - begin), &value))
    return fail_at(p, begin, "real number overflow");
  memcpy(bits, &value, sizeof *bits);
  return THR_OK;
}

static bool take_word(parser *p, const char *word)
{
  size_t n = strlen(word);
  if ((size_t)(p->end - p->at) < n || memcmp(p->at, word, n) != 0) return false;
  p->at += n;
  return true;
}

/* ---- lists and objects ---- */

/* The values from first on leave the open ones for a block of the document, where what they point
 * to is at a distance. */
static void close_block(parser *p, size_t first)
{
  slots *done = &p->done;
  for (size_t i = first; i < p->open.n; i++, done->n++) {
    uint64_t bits = p->open.slot[i].bits;
    if (is_pointing(bits))
      bits = tagged((unsigned)(bits >> 48), payload_of(&p->open.slot[i]) - 16 * (int64_t)done->n);
    done->slot[done->n].bits = bits;
  }
  p->open.n = first;
}

static thr_status parse_value(parser *p, uint64_t *bits);

static thr_status take_array(parser *p, uint64_t *bits)
{
  size_t first = p->open.n;
  thr_status st = THR_OK;
  uint64_t value;
  if (!take(p, ']')) {
    do {
      skip_blanks(p);
      st = take_few_digits(p, &value) ? THR_OK : parse_value(p, &value);
      if (!st) st = push(p, value);
    } while (!st && take(p, ','));
    if (!st && !take(p, ']')) st = expected(p, "']'");
  }
  size_t n = p->open.n - first;
  if (!st) st = reserve(&p->done, n + 1, p->err);
  if (st) return st;
  *bits = pointing(TAG_ARRAY, (int64_t)p->done.n, n < MANY ? (unsigned)n : MANY);
  if (n >= MANY) p->done.slot[p->done.n++].bits = n;
  close_block(p, first);
  return THR_OK;
}

typedef struct {
  const char *key;
  size_t member;
} sorted_key;

static int by_key(const void *pa, const void *pb)
{
  const sorted_key *a = pa, *b = pb;
  int way = strcmp(a->key, b->key);
  return way ? way : (a->member > b->member) - (a->member < b->member);
}

/* A key that is there a second time. */
static thr_status repeated(const parser *p, const sorted_key *second, const thr_json *keys)
{
  char what[120];
  snprintf(what, sizeof what, "duplicate object key \"%s\"", second->key);
  return fail_at(p, p->text + block_of(keys + 2 * second->member)->bits, what);
}

/* The members of the object that ends the document, by their keys; no key is there twice. */
static thr_status sort_members(parser *p, size_t block, size_t n)
{
  sorted_key *list = thr_calloc(n, sizeof *list);
  thr_status st = list ? reserve(&p->done, n, p->err) : thr_nomem(p->err);
  const thr_json *key = p->done.slot + block + 1;
  for (size_t i = 0; i < n && !st; i++)
    list[i] = (sorted_key){key_text(key + 2 * i), i};
  if (!st) qsort(list, n, sizeof *list, by_key);
  for (size_t i = 1; i < n && !st; i++)
    if (strcmp(list[i - 1].key, list[i].key) == 0) st = repeated(p, &list[i], key);
  for (size_t i = 0; i < n && !st && n > FEW_MEMBERS; i++)
    p->done.slot[p->done.n++].bits = list[i].member;
  free(list);
  return st;
}

static thr_status take_member(parser *p)
{
  uint64_t bits = 0;
  skip_blanks(p);
  if (p->at == p->end || *p->at != '"') return expected(p, "string or '}'");
  p->at++;
  thr_status st = take_text(p, true, &bits);
  if (!st) st = push(p, bits);
  if (!st && !take(p, ':')) st = expected(p, "':'");
  if (!st) st = parse_value(p, &bits);
  return st ? st : push(p, bits);
}

static thr_status take_object(parser *p, uint64_t *bits)
{
  size_t first = p->open.n;
  thr_status st = THR_OK;
  if (!take(p, '}')) {
    do
      st = take_member(p);
    while (!st && take(p, ','));
    if (!st && !take(p, '}')) st = expected(p, "'}'");
  }
  size_t n = p->open.n - first, block = p->done.n;
  if (!st) st = reserve(&p->done, n + 1, p->err);
  if (st) return st;
  *bits = pointing(TAG_OBJECT, (int64_t)block, 0);
  p->done.slot[p->done.n++].bits = n / 2;
  close_block(p, first);
  return sort_members(p, block, n / 2);
}

static thr_status parse_nested(parser *p, uint64_t *bits)
{
  if (++p->depth > DEEPEST) return fail_at(p, p->at, "depth over 2048");
  thr_status st = *p->at++ == '[' ? take_array(p, bits) : take_object(p, bits);
  p->depth--;
  return st;
}

static thr_status parse_value(parser *p, uint64_t *bits)
{
  skip_blanks(p);
  if (p->at == p->end) return expected(p, "a value");
  switch (*p->at) {
  case '[':
  case '{': return parse_nested(p, bits);
  case '"': p->at++; return take_text(p, false, bits);
  case 'n':
    *bits = tagged(TAG_WORD, WORD_NULL);
    return take_word(p, "null") ? THR_OK : expected(p, "a value");
  case 'f':
    *bits = tagged(TAG_WORD, WORD_FALSE);
    return take_word(p, "false") ? THR_OK : expected(p, "a value");
  case 't':
    *bits = tagged(TAG_WORD, WORD_TRUE);
    return take_word(p, "true") ? THR_OK : expected(p, "a value");
  default: break;
  }
  const char *begin = p->at;
  if (take_word(p, "NaN") || take_word(p, "Infinity") || take_word(p, "-Infinity")) {
    *bits = tagged(TAG_WORD, WORD_NAN);
    return p->python ? THR_OK : fail_at(p, begin, "Python wrote NaN or Infinity; write null");
  }
  return *p->at == '-' || is_digit(p, p->at) ? take_number(p, bits) : expected(p, "a value");
}

static thr_status parse_document(parser *p)
{
  uint64_t root = 0;
  skip_blanks(p);
  if (p->at == p->end) return thr_fail(p->err, THR_EINPUT, "%s:1: the file is empty", p->name);
  if (*p->at != '[' && *p->at != '{') return expected(p, "'[' or '{'");
  thr_status st = reserve(&p->done, 1, p->err);
  p->done.n = 1;
  if (!st) st = parse_value(p, &root);
  if (st) return st;
  skip_blanks(p);
  if (p->at < p->end) return expected(p, "end of file");
  p->done.slot[0].bits = root;
  return THR_OK;
}

static thr_status parse(thr_json **doc, const char *text, size_t n, const char *name, bool python,
                        thr_err *err)
{
  bool marked = n >= 3 && memcmp(text, "\xef\xbb\xbf", 3) ==
                              0; /* byte-order mark, as Windows editors leave it */
  const char *begin = n == 0 ? "" : marked ? text + 3 : text;
  parser p = {.text = begin,
              .at = begin,
              .end = n == 0 ? begin : text + n,
              .name = name,
              .python = python,
              .err = err};
  thr_status st = parse_document(&p);
  free(p.open.slot);
  if (st) free(p.done.slot);
  *doc = st ? NULL : p.done.slot;
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
