/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From weights to the file that --physics takes. */
#include "cli/calibrate.h"
#include "cli/cli.h"
#include "diagram/export/paper.h"
#include "eval/cord/calibrate.h"
#include "graph/angle.h"
#include "graph/io/writer.h"

#include <stdio.h>
#include <string.h>

enum { MOST_WEIGHINGS = 64, N_TILTS = 2 };
static const double WEIGHT_ERROR =
    0.02; /* relative: of weights that are cups of water or a spring balance */
static const double TILT_ERROR =
    THR_PI / 180; /* of an angle that is read from a protractor or a telephone */
static const char *const tilt_name[N_TILTS] = {"bead", "ground"};
static const char *const tilt_key[N_TILTS] = {"mu_bead", "mu_ground"};

static int draw_piece(double bore, const char *output)
{
  thr_text text = {0};
  const char *ending = thr_path_ending(output ? output : "");
  const bool stl = strcmp(ending, "stl") == 0;
  if (*ending && !stl && strcmp(ending, "svg") != 0)
    return cli_usage("eval", "%s: the test piece is drawn as .svg, or as .stl to print it", output);
  if (stl)
    thr_test_piece_stl(bore, &text);
  else
    thr_test_piece_svg(bore, &text);
  return cli_write(&text, output ? output : "-");
}

/* What was found at the bench, of each kind of friction. */
typedef struct {
  thr_weighing weighing[MOST_WEIGHINGS];
  int n_weighings;
  double tilt[N_TILTS][MOST_WEIGHINGS]; /* rad */
  int n_tilts[N_TILTS];
} bench;

/* Reads one item of the list, HANG,IN,OUT or bead=ANGLE,.. or ground=ANGLE,..; false if it is none,
 * or there are too many. */
static bool parse_item(const char *item, bench *b)
{
  int read = 0;
  for (int t = 0; t < N_TILTS; t++) {
    const size_t n = strlen(tilt_name[t]);
    if (strncmp(item, tilt_name[t], n) != 0 || item[n] != '=') continue;
    for (const char *at = item + n;; at += 1 + read) {
      double degrees;
      if (b->n_tilts[t] == MOST_WEIGHINGS || sscanf(at + 1, "%lf %n", &degrees, &read) != 1)
        return false;
      b->tilt[t][b->n_tilts[t]++] = degrees * THR_PI / 180;
      if (at[1 + read] != ',') return at[1 + read] == '\0';
    }
  }
  if (b->n_weighings == MOST_WEIGHINGS) return false;
  thr_weighing *w = &b->weighing[b->n_weighings++];
  return sscanf(item, "%lf , %lf , %lf %n", &w->hang, &w->in, &w->out, &read) == 3 &&
         item[read] == '\0';
}

/* Reads the items between semicolons. */
static bool parse(const char *value, bench *b)
{
  while (*value) {
    char item[1024];
    const size_t n = strcspn(value, ";"), blank = strspn(value, " ");
    if (n >= sizeof item || blank >= n) return false;
    snprintf(item, sizeof item, "%.*s", (int)(n - blank), value + blank);
    if (!parse_item(item, b)) return false;
    value += n + (value[n] == ';');
  }
  return b->n_weighings + b->n_tilts[0] + b->n_tilts[1] > 0;
}

/* Writes the file that --physics takes, and what is said of it. */
static thr_status put_found(const bench *b, thr_text *file, thr_text *said, thr_err *err)
{
  thr_fitted_friction found;
  thr_writer writer = {.out = file};
  char note[160];
  thr_status st = THR_OK;
  if (b->n_weighings > 0)
    snprintf(note, sizeof note, "weighed at the bench, %d %s over 90 degrees", b->n_weighings,
             cli_plural(b->n_weighings, "weighing", "weighings"));
  else
    snprintf(note, sizeof note, "slid on a tilted board at the bench, %d %s",
             b->n_tilts[0] + b->n_tilts[1],
             cli_plural(b->n_tilts[0] + b->n_tilts[1], "slide", "slides"));
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "note", note);
  if (b->n_weighings > 0) {
    st = thr_calibrate(b->weighing, b->n_weighings, THR_PI / 2, WEIGHT_ERROR, &found, err);
    thr_write_number(&writer, "mu", found.mu);
    thr_write_number(&writer, "mu_low", found.low);
    thr_write_number(&writer, "mu_high", found.high);
    thr_text_printf(
        said,
        "friction mu = %.3f (band %.3f to %.3f), from %d %s over 90 degrees by the capstan law\n",
        found.mu, found.low, found.high, b->n_weighings,
        cli_plural(b->n_weighings, "weighing", "weighings"));
    thr_text_printf(said,
                    "the band is what single weights say, and weights that are off by %g %%\n",
                    100 * WEIGHT_ERROR);
  }
  for (int t = 0; t < N_TILTS && !st; t++) {
    if (b->n_tilts[t] == 0) continue;
    st = thr_calibrate_tilt(b->tilt[t], b->n_tilts[t], TILT_ERROR, &found, err);
    thr_write_number(&writer, tilt_key[t], found.mu);
    thr_text_printf(said,
                    "%s = %.3f (single slides, angles off by a degree: %.3f to %.3f), from %d %s "
                    "of a piece on a tilted board\n",
                    tilt_key[t], found.mu, found.low, found.high, b->n_tilts[t],
                    cli_plural(b->n_tilts[t], "slide", "slides"));
  }
  thr_write_close(&writer);
  thr_text_append(file, "\n");
  return st;
}

static int weigh(const char *value, const char *output, bool json)
{
  bench b = {0};
  thr_err err = {0};
  thr_text file = {0}, said = {0};
  if (!parse(value, &b))
    return cli_usage("eval",
                     "--calibrate %s: expected piece, HANG,IN,OUT (weights of one kind), "
                     "bead=DEGREES,.. or ground=DEGREES,.., at "
                     "most %d of each, with semicolons between",
                     value, MOST_WEIGHINGS);
  if (put_found(&b, &file, &said, &err)) {
    thr_text_destroy(&file);
    thr_text_destroy(&said);
    return cli_fail(&err);
  }
  const bool to_stdout = output && strcmp(output, "-") == 0;
  if (json || to_stdout) {
    thr_text_destroy(&said);
    return cli_write(&file, "-");
  }
  int code = output ? cli_write(&file, output) : EXIT_OK;
  if (output) thr_text_printf(&said, "use it: --physics %s\n", output);
  if (!output) thr_text_destroy(&file);
  if (code) thr_text_destroy(&said);
  return code ? code : cli_write(&said, "-");
}

int calibrate_run(const char *value, double bore, const char *output, bool json)
{
  return strcmp(value, "piece") == 0 ? draw_piece(bore, output) : weigh(value, output, json);
}
