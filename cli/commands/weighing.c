/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes frictions from weights and slides at the bench, and writes the file that --physics takes
 * (thread eval --calibrate).
 *
 * A weight HANG hangs from a cord that goes round 90 degrees through a piece; IN at the other end
 * just draws it up, OUT just lets it slip down. By the capstan law IN / OUT = exp(2 mu theta), so
 * that mu = ln(IN / OUT) / (2 theta) whatever HANG weighs (eval/cord/profile.h). A piece that
 * slides on a board tilted by alpha has mu = tan(alpha).
 *
 * Example: `--calibrate "1,1.4,0.7; bead=17,18,16"` gives mu = 0.221 (band 0.189 to 0.253) and
 * mu_bead = 0.306. */

#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "graph/io/read.h"
#include "diagram/export/paper.h"
#include "eval/cord/profile.h"
#include "graph/number.h"
#include "graph/io/json.h"

#include <stdio.h>
#include <string.h>

enum { MOST_WEIGHINGS = 64, N_TILTS = 2 };

/* Errors of what was read at the bench: relative, of weights that are cups of water or a spring
 * balance; rad, of angles by a protractor or a telephone. */
static const double WEIGHT_ERROR = 0.02;
static const double TILT_ERROR = THR_PI / 180;

/* Frictions that slides measure: bead on bead, foot on ground. */
static const char *const tilt_name[N_TILTS] = {"bead", "ground"};
static const char *const tilt_key[N_TILTS] = {"mu_bead", "mu_ground"};

/* Draws the test piece to drill or to print. bore: mm. Returns an exit code. */
static int draw_piece(double bore, const char *output)
{
  thr_text text = {0};
  const char *ending = thr_path_ending(output ? output : "");
  const bool stl = strcmp(ending, "stl") == 0;

  /* The ending of the name says which. */
  if (*ending && !stl && strcmp(ending, "svg") != 0)
    return cli_usage("eval", "%s: the test piece is drawn as .svg, or as .stl to print it", output);

  if (stl)
    thr_test_piece_stl(bore, &text);
  else
    thr_test_piece_svg(bore, &text);

  return cli_write(&text, output ? output : "-");
}

/* What was found at the bench, for each kind of friction. */
typedef struct {
  thr_weighing weighing[MOST_WEIGHINGS];
  int n_weighings;
  double tilt[N_TILTS][MOST_WEIGHINGS]; /* rad */
  int n_tilts[N_TILTS];
} bench_results;

/* Parses one item of the list: HANG,IN,OUT, or bead=ANGLE,.. or ground=ANGLE,.. in degrees. Returns
 * false if it is none of them, or if there are too many. */
static bool parse_item(const char *item, bench_results *results)
{
  int read = 0;

  /* Angles of one kind, with commas between. */
  for (int kind = 0; kind < N_TILTS; kind++) {
    const size_t n = strlen(tilt_name[kind]);
    if (strncmp(item, tilt_name[kind], n) != 0 || item[n] != '=') continue;
    for (const char *at = item + n;; at += 1 + read) {
      double degrees;

      /* Every angle is followed by a comma or by the end of the item. */
      if (results->n_tilts[kind] == MOST_WEIGHINGS ||
          sscanf(at + 1, "%lf %n", &degrees, &read) != 1)
        return false;
      results->tilt[kind][results->n_tilts[kind]++] = degrees * THR_PI / 180;
      if (at[1 + read] != ',') return at[1 + read] == '\0';
    }
  }

  /* A weighing. */
  if (results->n_weighings == MOST_WEIGHINGS) return false;
  thr_weighing *w = &results->weighing[results->n_weighings++];

  return sscanf(item, "%lf , %lf , %lf %n", &w->hang, &w->in, &w->out, &read) == 3 &&
         item[read] == '\0';
}

/* Parses the items between semicolons. Returns false if one is bad, or if there are none. */
static bool parse(const char *value, bench_results *results)
{
  while (*value) {
    char item[1024];
    const size_t n = strcspn(value, ";"), blank = strspn(value, " ");
    if (n >= sizeof item || blank >= n) return false;

    /* Blanks before an item mean nothing. */
    snprintf(item, sizeof item, "%.*s", (int)(n - blank), value + blank);
    if (!parse_item(item, results)) return false;
    value += n + (value[n] == ';');
  }

  return results->n_weighings + results->n_tilts[0] + results->n_tilts[1] > 0;
}

/* Computes the frictions, and fills `file` with what --physics takes and `said` with what is
 * printed. */
static thr_status fit_frictions(const bench_results *results, thr_text *file, thr_text *said,
                                thr_err *err)
{
  thr_fitted_friction found;
  thr_writer writer = {.out = file};
  char note[160];
  thr_status st = THR_OK;

  /* A note in the file says where its numbers come from. */
  if (results->n_weighings > 0)
    snprintf(note, sizeof note, "weighed at the bench, %d %s over 90 degrees", results->n_weighings,
             cli_plural(results->n_weighings, "weighing", "weighings"));
  else
    snprintf(note, sizeof note, "slid on a tilted board at the bench, %d %s",
             results->n_tilts[0] + results->n_tilts[1],
             cli_plural(results->n_tilts[0] + results->n_tilts[1], "slide", "slides"));

  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "note", note);

  /* Cord on bead, from weighings round a right angle. */
  if (results->n_weighings > 0) {
    st = thr_calibrate(results->weighing, results->n_weighings, THR_PI / 2, WEIGHT_ERROR, &found,
                       err);
    thr_write_number(&writer, "mu", found.mu);
    thr_write_number(&writer, "mu_low", found.low);
    thr_write_number(&writer, "mu_high", found.high);
    thr_text_printf(
        said,
        "friction mu = %.3f (band %.3f to %.3f), from %d %s over 90 degrees by the capstan law\n",
        found.mu, found.low, found.high, results->n_weighings,
        cli_plural(results->n_weighings, "weighing", "weighings"));
    thr_text_printf(said,
                    "the band is what single weights say, and weights that are off by %g %%\n",
                    100 * WEIGHT_ERROR);
  }

  /* Bead on bead and foot on ground, from slides. */
  for (int kind = 0; kind < N_TILTS && !st; kind++) {
    if (results->n_tilts[kind] == 0) continue;
    st = thr_calibrate_tilt(results->tilt[kind], results->n_tilts[kind], TILT_ERROR, &found, err);
    thr_write_number(&writer, tilt_key[kind], found.mu);
    thr_text_printf(said,
                    "%s = %.3f (single slides, angles off by a degree: %.3f to %.3f), from %d %s "
                    "of a piece on a tilted board\n",
                    tilt_key[kind], found.mu, found.low, found.high, results->n_tilts[kind],
                    cli_plural(results->n_tilts[kind], "slide", "slides"));
  }

  thr_write_close(&writer);
  thr_text_append(file, "\n");

  return st;
}

/* Parses the results of the bench and writes the file, or to stdout what was found. Returns an exit
 * code. */
static int weigh(const char *value, const char *output)
{
  bench_results results = {0};
  thr_err err = {0};
  thr_text file = {0}, said = {0};

  if (!parse(value, &results))
    return cli_usage("eval",
                     "--calibrate %s: expected piece, HANG,IN,OUT (weights of one kind), "
                     "bead=DEGREES,.. or ground=DEGREES,.., at "
                     "most %d of each, with semicolons between",
                     value, MOST_WEIGHINGS);

  /* Weights that contradict each other are refused. */
  if (fit_frictions(&results, &file, &said, &err)) {
    thr_text_destroy(&file);
    thr_text_destroy(&said);
    return cli_fail(&err);
  }

  /* On stdout there is either the file or what is said of it. */
  const bool to_stdout = output && strcmp(output, "-") == 0;
  if (cli_json || to_stdout) {
    thr_text_destroy(&said);
    return cli_write(&file, "-");
  }

  int code = output ? cli_write(&file, output) : EXIT_OK;

  if (output) thr_text_printf(&said, "use it: --physics %s\n", output);
  if (!output) thr_text_destroy(&file);
  if (code) thr_text_destroy(&said);

  return code ? code : print_text(&said);
}

int calibrate_run(const char *value, double bore, const char *output)
{
  return strcmp(value, "piece") == 0 ? draw_piece(bore, output) : weigh(value, output);
}
