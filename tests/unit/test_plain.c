/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plain words: no bound is promised that does not hold, and no force is far from the number that it
 * stands for. */
#include "cli/print/plain.c"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

static void says(double newton, const char *words)
{
  char out[64];
  ck_assert_str_eq(plain_force(newton, out), words);
}

START_TEST(forces_have_their_weight)
{
  says(1, "1 N (0.1 kg)");
  says(225.121, "225 N (23 kg)");
  says(999.6, "1,000 N (102 kg)");
  says(12345.6, "12,300 N (1,260 kg)");
  says(4.5e6, "4.5 million N");
  says(INFINITY, "over a trillion N");
  says(NAN, "-");
}
END_TEST

START_TEST(numbers_have_no_exponents)
{
  static const struct {
    double value;
    int digits;
    const char *words;
  } row[] = {{0, 3, "0"},
             {2e-7, 3, "under 0.0001"},
             {0.035, 3, "0.035"},
             {999.4, 3, "999"},
             {2290.4, 3, "2,290"},
             {2004, 4, "2,004"},
             {999600, 3, "1 million"},
             {1.6e7, 2, "16 million"},
             {2.34e11, 3, "234 billion"},
             {9.999e11, 3, "over a trillion"}};
  char out[64];

  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    ck_assert_str_eq(thr_plain_number(row[i].value, row[i].digits, out), row[i].words);
  ck_assert_str_eq(plain_volume(62000, out), "62 cm3");
  ck_assert_str_eq(plain_volume(1.6e10, out), "16 m3");
  ck_assert_str_eq(plain_mass(25.3, out), "25.3 g");
  ck_assert_str_eq(plain_mass(12400, out), "12.4 kg");
  ck_assert_str_eq(plain_mass(2e7, out), "20 t");
}
END_TEST

/* Reads a number that a reader gets, commas and all; *rest: what follows it. */
static double read_plain(const char *text, char **rest)
{
  char digits[64];
  size_t n = strspn(text, "0123456789.,"), kept = 0;
  for (size_t i = 0; i < n; i++)
    if (text[i] != ',') digits[kept++] = text[i];
  digits[kept] = '\0';
  *rest = (char *)text + n;
  return strtod(digits, NULL);
}

/* Three digits: read back, a force is within half a percent, and its weight within a twentieth. */
START_TEST(forces_read_back)
{
  rng r = rng_make((uint64_t)_i);
  char out[64], *rest;
  double newton = exp(-4 + 16 * rng_unit(&r));
  plain_force(newton, out);
  double read = read_plain(out, &rest);
  ck_assert_double_eq_tol(read, newton, 0.0051 * newton);
  ck_assert_double_eq_tol(read_plain(strchr(rest, '(') + 1, &rest), newton / 9.80665,
                          0.052 * newton / 9.80665);
}
END_TEST

/* What is promised is at least the truth, and not much more. */
START_TEST(proofs_round_up)
{
  rng r = rng_make((uint64_t)_i);
  thr_text text = {0};
  thr_err err = {0};
  double bound = exp(8 * rng_unit(&r)), value = bound * (1 + exp(-9 + 11 * rng_unit(&r)));
  plain_put_proof(&text, false, value, bound, "nothing shorter exists", "shortest possible");
  ck_assert_ptr_nonnull(text.data);
  ck_assert_ptr_nonnull(strstr(text.data, " % above the shortest possible (proved)"));
  double percent = strtod(text.data + strlen("at most "), NULL),
         true_percent = 100 * (value / bound - 1);
  ck_assert_double_ge(percent, true_percent * (1 - 1e-6));
  ck_assert_double_le(percent, true_percent * 1.1 + 0.0101);
  ck_assert_int_eq(thr_not_proved(&err, "the length", value, bound), THR_ELIMIT);
  ck_assert_double_eq(strtod(strstr(err.text, "at most ") + strlen("at most "), NULL), percent);
  thr_text_destroy(&text);
}
END_TEST

START_TEST(what_is_not_known_is_not_promised)
{
  thr_text text = {0};
  plain_put_proof(&text, true, 3, 3, "nothing shorter exists", "shortest possible");
  thr_text_append(&text, "; ");
  plain_put_proof(&text, false, 3, 0, "nothing shorter exists", "shortest possible");
  ck_assert_str_eq(
      text.data,
      "proved: nothing shorter exists; how near that is to the shortest possible is not known");
  thr_text_destroy(&text);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("plain");
  ADD_TEST(s, 10, forces_have_their_weight);
  ADD_TEST(s, 10, numbers_have_no_exponents);
  ADD_EXAMPLES(s, 10, forces_read_back, 200);
  ADD_EXAMPLES(s, 10, proofs_round_up, 200);
  ADD_TEST(s, 10, what_is_not_known_is_not_promised);
  return run_suite(s);
}
