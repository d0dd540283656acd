/* From weights to the file that --physics takes. */
#include "cli/calibrate.h"
#include "cli/cli.h"
#include "diagram/export/test_piece.h"
#include "eval/cord/calibrate.h"
#include "graph/angle.h"
#include "graph/io/writer.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <string.h>

enum { MOST_WEIGHINGS = 64 };
static const double WEIGHT_ERROR = 0.02; /* relative: of weights that are cups of water or a spring balance */

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

/* Number of weighings; 0: the list is none. */
static int parse(const char *value, thr_weighing *weighing)
{
  int n = 0;
  for (const char *at = value; *at;) {
    int read = 0;
    if (n == MOST_WEIGHINGS) return 0;
    thr_weighing *w = &weighing[n++];
    if (sscanf(at, " %lf , %lf , %lf %n", &w->hang, &w->in, &w->out, &read) != 3) return 0;
    at += read;
    if (*at && *at != ';') return 0;
    at += *at == ';';
  }
  return n;
}

/* As a file of --physics. */
static void put_file(thr_text *text, const thr_friction *found, int n)
{
  char note[96];
  thr_writer writer = {.out = text};
  snprintf(note, sizeof note, "weighed at the bench, %d %s over 90 degrees", n, cli_plural(n, "weighing", "weighings"));
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "note", note);
  thr_write_number(&writer, "mu", found->mu);
  thr_write_number(&writer, "mu_low", found->low);
  thr_write_number(&writer, "mu_high", found->high);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

static int weigh(const char *value, const char *output, bool json)
{
  thr_weighing weighing[MOST_WEIGHINGS];
  thr_friction found;
  thr_err err = {0};
  thr_text file = {0}, said = {0};
  const int n = parse(value, weighing);
  if (n == 0)
    return cli_usage("eval", "--calibrate %s: expected piece, or HANG,IN,OUT (weights of one kind), at most %d with semicolons",
                     value, MOST_WEIGHINGS);
  if (thr_calibrate(weighing, n, THR_PI / 2, WEIGHT_ERROR, &found, &err)) return cli_fail(&err);
  put_file(&file, &found, n);
  if (json) return cli_write(&file, "-");
  int code = output ? cli_write(&file, output) : EXIT_OK;
  thr_text_printf(&said, "friction mu = %.3f (band %.3f to %.3f), from %d %s over 90 degrees by the capstan law\n", found.mu,
                  found.low, found.high, n, cli_plural(n, "weighing", "weighings"));
  thr_text_printf(&said, "the band is what single weights say, and weights that are off by %g %%\n", 100 * WEIGHT_ERROR);
  if (output && strcmp(output, "-") != 0) thr_text_printf(&said, "use it: --physics %s\n", output);
  if (!output) thr_text_destroy(&file);
  if (output && strcmp(output, "-") == 0) {
    thr_text_destroy(&said);
    return code;
  }
  return code ? code : cli_write(&said, "-");
}

int calibrate_run(const char *value, double bore, const char *output, bool json)
{
  return strcmp(value, "piece") == 0 ? draw_piece(bore, output) : weigh(value, output, json);
}
