/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The floor: status and error text, checked allocation, growing text, JSON reading. */
#define _POSIX_C_SOURCE 200809L
#include "tests/support.h"
#include "graph/io/json.h"
#include "graph/number.h"
#include "graph/arrays.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- numbers ---- */

START_TEST(numbers_are_sorted)
{
  int whole[] = {3, INT_MIN, 7, 3, INT_MAX, -1}, in_order[] = {INT_MIN, -1, 3, 3, 7, INT_MAX};
  double real[] = {0.5, -INFINITY, 1e300, -0.25, 0.5},
         real_in_order[] = {-INFINITY, -0.25, 0.5, 0.5, 1e300};
  thr_sort_ints(whole, 6);
  thr_sort_doubles(real, 5);
  thr_sort_ints(NULL, 0);
  ck_assert_mem_eq(whole, in_order, sizeof whole);
  ck_assert_mem_eq(real, real_in_order, sizeof real);
}
END_TEST

START_TEST(angles_keep_their_digits)
{
  const double east[3] = {3, 0, 0}, nearly[3] = {1, 1e-12, 0}, west[3] = {-2, 0, 0}, none[3] = {0};
  ck_assert_double_eq_tol(thr_angle_between(east, nearly), 1e-12, 1e-25);
  ck_assert_double_eq(thr_angle_between(east, west), THR_PI);
  ck_assert_double_eq(thr_angle_between(east, none), 0);
  ck_assert_double_eq(thr_degrees(THR_PI), 180);
}
END_TEST

/* ---- status ---- */

START_TEST(first_failure_wins)
{
  thr_err err = {0};
  ck_assert_int_eq(thr_fail(&err, THR_EINPUT, "line %d", 7), THR_EINPUT);
  ck_assert_int_eq(thr_fail(&err, THR_EIO, "later"), THR_EIO);
  ck_assert_int_eq(err.code, THR_EINPUT);
  ck_assert_str_eq(err.text, "line 7");
  ck_assert_int_eq(thr_fail(NULL, THR_ESOLVER, "nobody listens"), THR_ESOLVER);
}
END_TEST

START_TEST(error_text_is_one_bounded_line)
{
  thr_err err = {0};
  char *name = calloc(2000, 1);
  ck_assert(name != NULL);
  memset(name, 'x', 1999);
  name[3] = '\n', name[4] = '\t';
  ck_assert_int_eq(thr_fail(&err, THR_EINPUT, "%s", name), THR_EINPUT);
  ck_assert_uint_eq(strlen(err.text), sizeof err.text - 1);
  assert_one_line(&err, "xxx  x");
  free(name);
}
END_TEST

START_TEST(allocation_fails_where_told)
{
  thr_alloc_fail_at(2);
  void *a = thr_calloc(3, 4), *b = thr_calloc(3, 4), *c = thr_realloc(a, 5, 4);
  thr_alloc_fail_at(0);
  ck_assert(a && !b && !c); /* realloc left a valid */
  ck_assert_int_eq(((char *)a)[11], 0);
  free(a);
  void *none = thr_calloc(0, 8);
  ck_assert(none != NULL);
  free(none);
  ck_assert(thr_calloc(SIZE_MAX / 4, 8) == NULL); /* no overflow of the product */
}
END_TEST

START_TEST(grow_doubles_and_keeps_on_failure)
{
  int *list = NULL, capacity = 0;
  for (int i = 0; i < 1000; i++) {
    ck_assert_int_eq(thr_grow(&list, i, &capacity, sizeof *list, NULL), THR_OK);
    list[i] = i;
  }
  ck_assert_int_eq(capacity, 1024);
  thr_err err = {0};
  thr_alloc_fail_at(1);
  ck_assert_int_eq(thr_grow(&list, 1024, &capacity, sizeof *list, &err), THR_ENOMEM);
  thr_alloc_fail_at(0);
  ck_assert(list[999] == 999 && capacity == 1024);
  assert_one_line(&err, "memory");
  free(list);
}
END_TEST

/* ---- text ---- */

/* With the k-th allocation failing: an array that is missing, all after it missing too, and said
 * once. */
START_TEST(scratch_is_checked_once)
{
  for (int k = 1; k <= 4; k++) {
    thr_scratch own = {0};
    thr_err err = {0};
    thr_alloc_fail_once(k);
    int *some = thr_scratch_array(&own, 10, sizeof *some);
    double *none = thr_scratch_array(&own, 0, sizeof *none),
           *more = thr_scratch_array(&own, 1000, sizeof *more);
    thr_alloc_fail_at(0);
    ck_assert(!some == (k == 1) && !none == (k <= 2) && !more == (k <= 3));
    ck_assert_int_eq(thr_scratch_check(&own, &err), k <= 3 ? THR_ENOMEM : THR_OK);
    for (int i = 0; more && i < 1000; i++)
      ck_assert(more[i] == 0);
    thr_scratch_free(&own);
    ck_assert_int_eq(thr_scratch_check(&own, NULL), THR_OK);
  }
}
END_TEST

START_TEST(scratch_is_never_too_large)
{
  thr_scratch own = {0};
  ck_assert_ptr_null(thr_scratch_array(&own, SIZE_MAX / 8 + 1, 8));
  ck_assert_ptr_null(thr_scratch_array(&own, SIZE_MAX - 4, 1));
  ck_assert_int_eq(thr_scratch_check(&own, NULL), THR_ENOMEM);
  thr_scratch_free(&own);
}
END_TEST

START_TEST(doubles_are_short_and_read_back)
{
  static const struct {
    double value;
    const char *digits;
  } known[] = {{0.1, "0.1"},       {-0.0, "0"}, {1e21, "1e+21"}, {1.0 / 3, "0.3333333333333333"},
               {5e-324, "5e-324"}, {12, "12"}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    thr_text t = {0};
    thr_text_double(&t, known[i].value);
    ck_assert_str_eq(t.data, known[i].digits);
    thr_text_destroy(&t);
  }
  rng r = rng_make(1);
  for (int i = 0; i < 20000; i++) {
    double x = ldexp(rng_unit(&r) - 0.5, rng_between(&r, -1000, 1000));
    thr_text t = {0};
    thr_text_double(&t, x);
    ck_assert(strtod(t.data, NULL) == x);
    thr_text_destroy(&t);
  }
}
END_TEST

/* Oracle: the C library's %g with as few digits from 15 on as read back. Powers of two are left
 * out: the doubles below are nearer than those above, and a number of fewer digits that reads back
 * need not be the nearest of as many. */
START_TEST(doubles_are_written_as_by_percent_g)
{
  rng r = rng_make(2);
  for (int i = 0; i < 20000; i++) {
    char digits[40];
    double unit = rng_unit(&r) - 0.5, x = i % 2 ? ldexp(unit, rng_between(&r, -60, 80))
                                                : rng_between(&r, -100000, 100000) / 1e3;
    int precision = 15;
    while (snprintf(digits, sizeof digits, "%.*g", precision, x), strtod(digits, NULL) != x)
      precision++;
    thr_text t = {0};
    thr_text_double(&t, x);
    ck_assert_str_eq(t.data, digits);
    t.length = 0;
    thr_text_int(&t, (int64_t)x);
    ck_assert(strtoll(t.data, NULL, 10) == (int64_t)x && t.length == strlen(t.data));
    thr_text_destroy(&t);
  }
}
END_TEST

START_TEST(numbers_beyond_doubles)
{
  static const char *const none[] = {"1e400", "-1e400", "1e99999999999999999999", "1234e306",
                                     "12e9223372036854775807"};
  static const char *const nothing[] = {"1e-400",
                                        "0.000e999",
                                        "-0",
                                        "0e99999999999999999999",
                                        "1e-99999999999999999999",
                                        "0.01e-9223372036854775807"};
  double x;
  for (size_t i = 0; i < sizeof none / sizeof *none; i++)
    ck_assert_msg(!thr_number_parse(none[i], strlen(none[i]), &x), "%s", none[i]);
  for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++)
    ck_assert_msg(thr_number_parse(nothing[i], strlen(nothing[i]), &x) && x == 0, "%s", nothing[i]);
  ck_assert(thr_number_parse("0.1x", 3, &x) && x == 0.1);
}
END_TEST

START_TEST(strings_are_escaped)
{
  thr_text t = {0};
  thr_text_json_string(&t, "a\"b\\c\n\x7f\xc3\xa4");
  ck_assert_str_eq(t.data, "\"a\\\"b\\\\c\\u000a\\u007f\xc3\xa4\"");
  thr_text_destroy(&t);
  thr_text_xml(&t, "<a & 'b' \"c\">\x01");
  ck_assert_str_eq(t.data, "&lt;a &amp; &apos;b&apos; &quot;c&quot;&gt; ");
  thr_text_destroy(&t);
}
END_TEST

/* UTF-8 of a code point, as RFC 3629 has it; returns its length. */
static int encode(uint32_t code, char out[5])
{
  int n = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  static const unsigned char lead[] = {0, 0, 0xc0, 0xe0, 0xf0};
  memset(out, 0, 5);
  for (int i = n - 1; i > 0; i--, code >>= 6)
    out[i] = (char)(0x80 | (code & 0x3f));
  out[0] = (char)(lead[n] | code);
  return n;
}

START_TEST(every_letter_is_kept_or_a_blank)
{
  static const uint32_t control[][2] = {{1, 0x1f},        {0x7f, 0x9f},     {0x61c, 0x61c},
                                        {0x200e, 0x200f}, {0x2028, 0x202e}, {0x2066, 0x2069},
                                        {0xfffe, 0xffff}};
  for (uint32_t code = 1; code < 0x110000; code++) {
    char letter[5], text[8];
    if (code >= 0xd800 && code < 0xe000) continue;
    bool harmful = false;
    for (size_t i = 0; i < sizeof control / sizeof *control; i++)
      harmful |= code >= control[i][0] && code <= control[i][1];
    encode(code, letter);
    snprintf(text, sizeof text, "a%sb", letter);
    ck_assert(thr_text_is_utf8(letter, strlen(letter)));
    thr_text_clean(text);
    ck_assert_msg(memcmp(text + 1, harmful ? " " : letter, harmful ? 1 : strlen(letter)) == 0 &&
                      text[strlen(text) - 1] == 'b',
                  "U+%04X", (unsigned)code);
  }
}
END_TEST

START_TEST(broken_letters_are_question_marks)
{
  static const char *const known[][2] = {{"\xff", "?"},
                                         {"a\x80z", "a?z"},
                                         {"\xc0\xaf!", "?!"},
                                         {"\xc3", "?"},
                                         {"\xe2\x82", "?"},
                                         {"\xe2\x82z", "?z"},
                                         {"\xed\xa0\x80.", "?."},
                                         {"\xf4\x90\x80\x80.", "?."},
                                         {"\xc6o a", "?o a"},
                                         {"\xc3\xa4\xc3", "\xc3\xa4?"},
                                         {"\xff\xfe\xc3", "???"},
                                         {"", ""},
                                         {"\x1b[31m\x07", " [31m "}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    char text[16];
    snprintf(text, sizeof text, "%s", known[i][0]);
    thr_text_clean(text);
    ck_assert_str_eq(text, known[i][1]);
    thr_text t = {0};
    thr_text_append(&t, "\xff");
    thr_text_append_clean(&t, known[i][0]);
    ck_assert_str_eq(t.data + 1, known[i][1]);
    ck_assert_uint_eq(t.length, strlen(t.data));
    thr_text_destroy(&t);
  }
}
END_TEST

START_TEST(letters_are_not_cut)
{
  static const char *const known[][2] = {{"abcdef", "abcd"},
                                         {"abc\xc3\xa4", "abc"},
                                         {"ab\xc3\xa4z", "ab\xc3\xa4"},
                                         {"abc\xf0\x9f\xa7\xb5", "abc"},
                                         {"abcd", "abcd"},
                                         {"", ""},
                                         {"\xf0\x9f\xa7\xb5y", "\xf0\x9f\xa7\xb5"},
                                         {"a\n\xffz!", "a ?z"}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    char out[5];
    thr_text_copy_clean(out, sizeof out, known[i][0]);
    ck_assert_str_eq(out, known[i][1]);
  }
}
END_TEST

START_TEST(columns_are_letters)
{
  const char *text = "a\xc3\xa4\xf0\x9f\xa7\xb5z"; /* 1, 2, 4 and 1 byte */
  ck_assert_int_eq(thr_text_columns(text, SIZE_MAX), 4);
  ck_assert_int_eq(thr_text_columns(text, 3), 2);
  ck_assert_int_eq(thr_text_columns(text, 0), 0);
  ck_assert_int_eq(thr_text_columns("", SIZE_MAX), 0);
}
END_TEST

/* The reader takes no string that is not UTF-8 or holds a control character. */
START_TEST(any_bytes_make_json)
{
  rng r = rng_make(5);
  static const char *const piece[] = {"\xe2\x80\xae", "\xe2\x80\xa8",     "\xc2\x85", "\"",
                                      "\\",           "\xf0\x9f\xa7\xb5", "\x7f",     "\n"};
  for (int i = 0; i < 20000; i++) {
    char raw[64] = "";
    for (int n = rng_between(&r, 0, 12); n > 0; n--) {
      char byte[2] = {(char)rng_between(&r, 1, 255), 0};
      strcat(raw, rng_between(&r, 0, 1) ? byte : piece[rng_between(&r, 0, 7)]);
    }
    thr_text t = {0};
    thr_json *doc;
    thr_err err = {0};
    thr_text_append(&t, "[");
    thr_text_json_string(&t, raw);
    thr_text_append(&t, "]");
    ck_assert_msg(thr_json_parse(&doc, t.data, t.length, "t", &err) == THR_OK, "%s: %s", err.text,
                  t.data);
    if (thr_text_is_utf8(raw, strlen(raw)))
      ck_assert_str_eq(thr_json_string(thr_json_at(doc, 0)), raw);
    thr_json_destroy(doc);
    char once[64], twice[64];
    strcpy(once, raw);
    thr_text_clean(once);
    strcpy(twice, once);
    thr_text_clean(twice);
    ck_assert_str_eq(once, twice);
    ck_assert(thr_text_is_utf8(once, strlen(once)));
    thr_text_destroy(&t);
  }
}
END_TEST

START_TEST(messages_are_clean)
{
  thr_err err = {0};
  thr_fail(&err, THR_EINPUT, "%s: no\nnode '%s'", "a\x1b]0;x\x07",
           "\xe2\x80\xae"
           "b\xff");
  ck_assert_str_eq(err.text, "a ]0;x : no node ' b?'");
}
END_TEST

START_TEST(failed_append_is_remembered)
{
  thr_text t = {0};
  thr_err err = {0};
  thr_text_append(&t, "kept");
  thr_alloc_fail_at(1);
  for (int i = 0; i < 100; i++)
    thr_text_printf(&t, "%d and more text than fits", i);
  thr_alloc_fail_at(0);
  ck_assert(t.failed);
  thr_text_append(&t, "too late");
  ck_assert(!strstr(t.data, "too late"));
  ck_assert_int_eq(thr_text_write(&t, "-", &err), THR_ENOMEM);
  thr_text_destroy(&t);
}
END_TEST

START_TEST(files_are_replaced_whole)
{
  char folder[] = "/tmp/thread-test-XXXXXX", path[64];
  ck_assert(mkdtemp(folder) != NULL);
  snprintf(path, sizeof path, "%s/a.txt", folder);
  thr_text t = {0}, back = {0};
  thr_err err = {0};
  thr_text_append_bytes(&t, "one\0two", 7);
  ck_assert_int_eq(thr_text_write(&t, path, NULL), THR_OK);
  thr_text_append(&t, " three");
  ck_assert_int_eq(thr_text_write(&t, path, NULL), THR_OK);
  ck_assert_int_eq(thr_text_read(&back, path, NULL), THR_OK);
  ck_assert_uint_eq(back.length, 13);
  ck_assert(memcmp(back.data, "one\0two three", 13) == 0);
  thr_text_destroy(&back);
  unlink(path);
  assert_status(thr_text_write(&t, folder, &err), THR_EIO, &err, folder);
  ck_assert_int_eq(rmdir(folder), 0); /* nothing temporary was left */
  assert_status(thr_text_write(&t, path, &err), THR_EIO, &err, path);
  assert_status(thr_text_read(&back, path, &err), THR_EIO, &err, path);
  ck_assert(back.data == NULL);
  thr_text_destroy(&t);
}
END_TEST

/* ---- JSON ---- */

static thr_json *parse(const char *text)
{
  thr_json *doc;
  thr_err err = {0};
  assert_ok(thr_json_parse(&doc, text, strlen(text), "file", &err), &err);
  return doc;
}

static void put_document(thr_writer *w)
{
  thr_text words = {0};
  thr_text_append(&words, "a \"b\"");
  thr_write_object(w, NULL);
  thr_write_line(w, 2);
  thr_write_ints(w, "list", (const int[]){1, -2}, 2);
  thr_write_number(w, "half", 0.5);
  thr_write_number(w, "none", INFINITY);
  thr_write_line(w, 2);
  thr_write_array(w, "rows");
  for (int i = 0; i < 2; i++) {
    thr_write_row(w, NULL);
    thr_write_bool(w, NULL, i == 0);
    thr_write_null(w, NULL);
    thr_write_close(w);
  }
  thr_write_object(w, NULL);
  thr_write_close(w);
  thr_write_close(w);
  thr_write_words(w, "a\nkey", &words);
  thr_write_hash(w, "hash", 0xabcu);
  thr_write_printf(w, "three", "%.2f", 3.0);
  thr_write_line(w, 0);
  thr_write_close(w);
}

START_TEST(json_is_written)
{
  thr_text loose = {0}, compact = {0};
  put_document(&(thr_writer){.out = &loose});
  put_document(&(thr_writer){.out = &compact, .compact = true});
  ck_assert_str_eq(
      loose.data,
      "{\n  \"list\": [1,-2], \"half\": 0.5, \"none\": null,\n  \"rows\": [[true,null], "
      "[false,null], {}], "
      "\"a\\u000akey\": \"a \\\"b\\\"\", \"hash\": \"0000000000000abc\", \"three\": 3.00\n}");
  ck_assert_str_eq(
      compact.data,
      "{\n  \"list\":[1,-2],\"half\":0.5,\"none\":null,\n  \"rows\":[[true,null],[false,null],{}],"
      "\"a\\u000akey\":\"a \\\"b\\\"\",\"hash\":\"0000000000000abc\",\"three\":3.00\n}");
  thr_text_destroy(&loose);
  thr_text_destroy(&compact);
}
END_TEST

/* Whichever allocation fails, the text knows; without a failure it is whole. */
START_TEST(json_writing_remembers_failures)
{
  bool failed = true;
  int k = 0;
  while (failed) {
    thr_text text = {0};
    thr_alloc_fail_once(++k);
    put_document(&(thr_writer){.out = &text});
    thr_alloc_fail_at(0);
    failed = text.failed;
    if (!failed) ck_assert_int_eq(text.data[text.length - 1], '}');
    thr_text_destroy(&text);
  }
  ck_assert_int_gt(k, 2);
}
END_TEST

START_TEST(json_values_are_read)
{
  thr_json *doc =
      parse("\xef\xbb\xbf{\"z\": [1, 2.0, 2.5, \"x\", true, null], \"a\": 9223372036854775807}");
  const thr_json *list = thr_json_get(doc, "z"), *value;
  int64_t whole;
  double x;
  ck_assert_int_eq(thr_json_size(list), 6);
  ck_assert(thr_json_int(thr_json_at(list, 1), &whole) && whole == 2);
  ck_assert(!thr_json_int(thr_json_at(list, 2), &whole));
  ck_assert(thr_json_number(thr_json_at(list, 2), &x) && x == 2.5);
  ck_assert_str_eq(thr_json_string(thr_json_at(list, 3)), "x");
  ck_assert(thr_json_true(thr_json_at(list, 4)) && !thr_json_true(thr_json_at(list, 5)));
  ck_assert(thr_json_int(thr_json_get(doc, "a"), &whole) && whole == INT64_MAX);
  void *iter = NULL;
  const char *key;
  ck_assert(thr_json_next(doc, &iter, &key, &value) && strcmp(key, "z") == 0); /* file order */
  ck_assert(thr_json_next(doc, &iter, &key, &value) && strcmp(key, "a") == 0);
  ck_assert(!thr_json_next(doc, &iter, &key, &value));
  thr_json_destroy(doc);
}
END_TEST

START_TEST(json_absent_is_harmless)
{
  int64_t whole;
  double x;
  ck_assert(thr_json_get(NULL, "a") == NULL && thr_json_at(NULL, 0) == NULL &&
            thr_json_string(NULL) == NULL);
  ck_assert(!thr_json_int(NULL, &whole) && !thr_json_number(NULL, &x) && !thr_json_true(NULL));
  ck_assert(thr_json_typeof(NULL) == THR_JSON_NULL && thr_json_size(NULL) == 0);
  thr_json *doc = parse("[1]");
  ck_assert(thr_json_get(doc, "a") == NULL && thr_json_at(doc, 1) == NULL &&
            thr_json_at(doc, -1) == NULL);
  thr_json_destroy(doc);
  thr_json_destroy(NULL);
}
END_TEST

static thr_status verdict(const char *text)
{
  thr_json *doc;
  char bytes[64]; /* without a NUL behind them */
  size_t n = strlen(text);
  memcpy(bytes, text, n);
  memset(bytes + n, '1', sizeof bytes - n);
  thr_status st = thr_json_parse(&doc, bytes, n, "file", NULL);
  thr_json_destroy(doc);
  return st;
}

START_TEST(json_grammar)
{
  static const char *const right[] = {"[]",
                                      "{}",
                                      " [ ] ",
                                      "[0]",
                                      "[-0.5e+3, 1E2,10e-1]",
                                      "[[[]],{}]",
                                      "{\"\": null}",
                                      "[\"\\\"\\/\\b\\u00e4\"]",
                                      "[true ]",
                                      "[false]",
                                      "{\"a\":{\"a\":1}}",
                                      "[1]\n",
                                      "[\"\\ud83e\\uddf5\"]",
                                      "[1e-999]",
                                      "[-9223372036854775808]"};
  static const char *const wrong[] = {"1",
                                      "[1,]",
                                      "[,1]",
                                      "[1 2]",
                                      "[01]",
                                      "[.5]",
                                      "[1.]",
                                      "[1e]",
                                      "[+1]",
                                      "[-]",
                                      "[1e+]",
                                      "[0x1]",
                                      "[nul]",
                                      "[True]",
                                      "[nulll]",
                                      "{\"a\"}",
                                      "{\"a\":}",
                                      "{\"a\":1,}",
                                      "{a:1}",
                                      "{1:1}",
                                      "[1}",
                                      "{\"a\":1]",
                                      "[\"a]",
                                      "[\"a\nb\"]",
                                      "[\"\\x\"]",
                                      "[\"\\u12\"]",
                                      "[\"\\",
                                      "[\"\\u",
                                      "[\"\\u0000\"]",
                                      "[\"\\ud83e\"]",
                                      "[\"\\ud83e\\u0041\"]",
                                      "[\"\\uddf5\"]",
                                      "[\"\xc0\x80\"]",
                                      "[\"\xff\"]",
                                      "[9223372036854775808]",
                                      "[-9223372036854775809]",
                                      "[",
                                      "{",
                                      "[1",
                                      "{\"a\":",
                                      "[\v1]",
                                      "[] []",
                                      "[NaN]",
                                      "[\"\x1f\"]"};
  for (size_t i = 0; i < sizeof right / sizeof *right; i++)
    ck_assert_msg(verdict(right[i]) == THR_OK, "%s", right[i]);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    ck_assert_msg(verdict(wrong[i]) == THR_EINPUT, "%s", wrong[i]);
}
END_TEST

/* Whole numbers in a slot and beyond it, lists of few and many values, letters of one to four bytes
 * as escapes. */
START_TEST(json_values_of_every_size)
{
  static const int64_t bounds[] = {(INT64_C(1) << 47) - 1, INT64_C(1) << 47,
                                   -(INT64_C(1) << 47) - 1, INT64_MIN, INT64_MAX};
  thr_json *doc = parse("[[140737488355327, 140737488355328, -140737488355329, "
                        "-9223372036854775808, 9223372036854775807],"
                        " [0,1,2,3,4,5,6,7,8,9,10,11,12,13], [0,1,2,3,4,5,6,7,8,9,10,11,12,13,14], "
                        "\"\\u0041\\u00e4\\u20AC\\ud83e\\uddf5\"]");
  int64_t whole;
  for (int i = 0; i < 5; i++)
    ck_assert(thr_json_int(thr_json_at(thr_json_at(doc, 0), i), &whole) && whole == bounds[i]);
  for (int k = 1; k < 3; k++) {
    const thr_json *list = thr_json_at(doc, k);
    ck_assert_int_eq(thr_json_size(list), 13 + k);
    for (int i = 0; i < 13 + k; i++)
      ck_assert(thr_json_int(thr_json_at(list, i), &whole) && whole == i);
    ck_assert(thr_json_at(list, 13 + k) == NULL);
  }
  ck_assert_str_eq(thr_json_string(thr_json_at(doc, 3)), "A\xc3\xa4\xe2\x82\xac\xf0\x9f\xa7\xb5");
  thr_json_destroy(doc);
}
END_TEST

/* Members by name whatever their number, in the file's order, and never one twice. */
START_TEST(json_objects_of_many_members)
{
  for (int n = 0; n < 40; n++) {
    thr_text text = {0};
    thr_json *doc;
    thr_err err = {0};
    thr_text_append(&text, "{");
    for (int i = 0; i < n; i++)
      thr_text_printf(&text, "%s\n\"k%d\": {\"number\": %d}", i ? "," : "", 17 * i % 41, i);
    thr_text_append(&text, "}");
    doc = parse(text.data);
    ck_assert_int_eq(thr_json_size(doc), n);
    void *iter = NULL;
    const char *key;
    const thr_json *value;
    int64_t number;
    for (int i = 0; i < n; i++) {
      ck_assert(thr_json_next(doc, &iter, &key, &value) && atoi(key + 1) == 17 * i % 41 &&
                thr_json_get(doc, key) == value);
      ck_assert(thr_json_int(thr_json_get(value, "number"), &number) && number == i);
    }
    ck_assert(!thr_json_next(doc, &iter, &key, &value) && !thr_json_get(doc, "k") &&
              !thr_json_get(doc, "z"));
    thr_json_destroy(doc);
    text.data[--text.length] = '\0';
    thr_text_printf(&text, "%s\n\"k0\": 0}", n ? "," : "");
    ck_assert_int_eq(thr_json_parse(&doc, text.data, text.length, "file", &err),
                     n ? THR_EINPUT : THR_OK);
    char place[24];
    snprintf(place, sizeof place, "file:%d:2: ", n + 2);
    if (n) assert_one_line(&err, place);
    thr_json_destroy(doc);
    thr_text_destroy(&text);
  }
}
END_TEST

START_TEST(json_errors_name_the_place)
{
  static const char *const wrong[] = {
      "{\"a\": 1,\n \"a\": 2}", "[1,\n2", "[1] x", "", "{\"a\": 1e999}", "\xff",
      "[99999999999999999999]"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_json *doc;
    thr_err err = {0};
    assert_status(thr_json_parse(&doc, wrong[i], strlen(wrong[i]), "file.json", &err), THR_EINPUT,
                  &err, i < 2 ? "file.json:2:" : "file.json:1:");
    ck_assert(doc == NULL);
  }
  char *deep = calloc(10001, 1);
  thr_json *doc;
  ck_assert(deep != NULL);
  memset(deep, '[', 10000);
  ck_assert_int_eq(thr_json_parse(&doc, deep, 10000, "deep", NULL), THR_EINPUT);
  free(deep);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("floor");
  ADD_TEST(s, 10, numbers_are_sorted);
  ADD_TEST(s, 10, angles_keep_their_digits);
  ADD_TEST(s, 10, first_failure_wins);
  ADD_TEST(s, 10, error_text_is_one_bounded_line);
  ADD_TEST(s, 10, allocation_fails_where_told);
  ADD_TEST(s, 10, grow_doubles_and_keeps_on_failure);
  ADD_TEST(s, 10, scratch_is_checked_once);
  ADD_TEST(s, 10, scratch_is_never_too_large);
  ADD_TEST(s, 10, doubles_are_short_and_read_back);
  ADD_TEST(s, 10, doubles_are_written_as_by_percent_g);
  ADD_TEST(s, 10, numbers_beyond_doubles);
  ADD_TEST(s, 10, strings_are_escaped);
  ADD_TEST(s, 60, every_letter_is_kept_or_a_blank);
  ADD_TEST(s, 10, broken_letters_are_question_marks);
  ADD_TEST(s, 10, letters_are_not_cut);
  ADD_TEST(s, 10, columns_are_letters);
  ADD_TEST(s, 60, any_bytes_make_json);
  ADD_TEST(s, 10, messages_are_clean);
  ADD_TEST(s, 10, failed_append_is_remembered);
  ADD_TEST(s, 10, files_are_replaced_whole);
  ADD_TEST(s, 10, json_is_written);
  ADD_TEST(s, 10, json_writing_remembers_failures);
  ADD_TEST(s, 10, json_values_are_read);
  ADD_TEST(s, 10, json_absent_is_harmless);
  ADD_TEST(s, 10, json_errors_name_the_place);
  ADD_TEST(s, 10, json_grammar);
  ADD_TEST(s, 10, json_values_of_every_size);
  ADD_TEST(s, 10, json_objects_of_many_members);
  return run_suite(s);
}
