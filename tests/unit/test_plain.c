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
  says(999.6, "1000 N (102 kg)");
  says(12345.6, "12346 N (1259 kg)");
  says(4.5e6, "4.5e+06 N");
  says(INFINITY, "> 1e300 N");
  says(NAN, "-");
}
END_TEST

/* Three digits: read back, a force is within half a percent, and its weight within a twentieth. */
START_TEST(forces_read_back)
{
  rng r = rng_make((uint64_t)_i);
  char out[64], *rest;
  double newton = exp(-4 + 16 * rng_unit(&r));
  plain_force(newton, out);
  double read = strtod(out, &rest);
  ck_assert_double_eq_tol(read, newton, newton >= 1e5 ? 0.05 * newton : 0.005 * newton);
  if (newton < 1e6)
    ck_assert_double_eq_tol(strtod(strchr(rest, '(') + 1, NULL), newton / 9.80665,
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
  ADD_EXAMPLES(s, 10, forces_read_back, 200);
  ADD_EXAMPLES(s, 10, proofs_round_up, 200);
  ADD_TEST(s, 10, what_is_not_known_is_not_promised);
  return run_suite(s);
}
