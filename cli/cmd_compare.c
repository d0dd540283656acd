/* thread compare: plans side by side, the best of each row marked. */
#include "cli/pull.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] = "thread compare PLAN.. [options]: plans side by side; * marks the best of each row\n\n"
                           "Examples:\n"
                           "  thread compare closed.json feet.json --mu 0.3\n\n"
                           "Options:\n" PULL_HELP "      --json           as JSON\n"
                           "  -h, --help\n";

static const struct option table[] = {CLI_COMMON_OPTIONS, PULL_OPTIONS, {NULL, 0, NULL, 0}};

typedef struct {
  const char *path;
  thr_plan plan;
  thr_capstan pull;
} entry;

/* The rows: a value per plan, less is better. Rows that say what a plan is, not how good, mark nothing. */
static double cords(const entry *e)
{
  return e->plan.n_cords;
}
static double passes(const entry *e)
{
  return e->plan.metrics.passes;
}
static double length(const entry *e)
{
  return e->plan.metrics.length;
}
static double overlap(const entry *e)
{
  return e->plan.metrics.overlap;
}
static double overlap_percent(const entry *e)
{
  return 100 * e->plan.metrics.overlap / e->plan.metrics.base_length;
}
static double gap_percent(const entry *e)
{
  return e->plan.proof.present ? 100 * e->plan.proof.gap : NAN;
}
static double turning(const entry *e)
{
  return cli_degrees(e->plan.metrics.turning);
}
static double max_turning(const entry *e)
{
  return cli_degrees(e->plan.metrics.max_turning);
}
static double worst_turn(const entry *e)
{
  return cli_degrees(e->plan.metrics.worst_turn);
}
static double u_turns(const entry *e)
{
  return e->plan.metrics.u_turns;
}
static double largest(const entry *e)
{
  return e->pull.largest;
}
static double total(const entry *e)
{
  return e->pull.total;
}

static const struct {
  const char *label, *key;
  double (*value)(const entry *);
  bool rate;
  int decimals; /* -1: whole number, -2: six significant digits */
} row[] = {
    {"cords", "cords", cords, false, -1},
    {"passes", "passes", passes, true, -1},
    {"length", "length", length, true, 3},
    {"overlap", "overlap", overlap, true, 3},
    {"overlap %", "overlap_percent", overlap_percent, true, 2},
    {"gap to the proven bound %", "gap_percent", gap_percent, false, -2},
    {"turning with closing turns, deg", "turning_deg", turning, true, 1},
    {"the same, largest cord, deg", "max_turning_deg", max_turning, true, 1},
    {"sharpest turn, deg", "worst_turn_deg", worst_turn, true, 1},
    {"U-turns", "u_turns", u_turns, true, -1},
    {"largest pull, N", "largest_pull", largest, true, -2},
    {"all pulls together, N", "total_pull", total, true, -2},
};
enum { N_ROWS = sizeof row / sizeof *row };

/* Within a millionth is a tie: both are marked. */
static bool is_best(const entry *e, int n, int r, int i)
{
  double mine = row[r].value(&e[i]);
  if (!row[r].rate || n < 2 || isnan(mine)) return false;
  for (int k = 0; k < n; k++)
    if (row[r].value(&e[k]) < mine - 1e-6 * fabs(mine)) return false;
  return true;
}

static void put_cell(thr_text *t, int r, double value, bool best)
{
  char cell[40];
  if (isnan(value))
    snprintf(cell, sizeof cell, "-");
  else if (row[r].decimals == -1)
    snprintf(cell, sizeof cell, "%.0f", value);
  else if (row[r].decimals == -2)
    snprintf(cell, sizeof cell, "%.6g", value);
  else
    snprintf(cell, sizeof cell, "%.*f", row[r].decimals, value);
  thr_text_printf(t, " %16s%s", cell, best ? "*" : " ");
}

static void put_text(thr_text *t, const entry *e, int n, const pull_args *a)
{
  thr_text_printf(t, "%-31s", "");
  for (int i = 0; i < n; i++) {
    size_t letters = strlen(e[i].path);
    thr_text_printf(t, letters > 16 ? " ..%s " : " %16s ", letters > 16 ? e[i].path + letters - 14 : e[i].path);
  }
  thr_text_printf(t, "\n%-31s", "ends");
  for (int i = 0; i < n; i++)
    thr_text_printf(t, " %16s ", thr_ends_name(e[i].plan.options.ends));
  for (int r = 0; r < N_ROWS; r++) {
    thr_text_printf(t, "\n%-31s", row[r].label);
    for (int i = 0; i < n; i++)
      put_cell(t, r, row[r].value(&e[i]), is_best(e, n, r, i));
  }
  thr_text_printf(t, "\n\n* best of the row. Pull: capstan law, seating tension %g N, pulled at: %s, mu = ", a->capstan.seating,
                  pull_name(a->capstan.pull));
  if (a->mu_given)
    thr_text_printf(t, "%g\n", a->capstan.mu);
  else
    thr_text_append(t, "each plan's own\n");
}

static void put_json(thr_text *t, const entry *e, int n)
{
  thr_text_append(t, "[");
  for (int i = 0; i < n; i++) {
    thr_text_append(t, i ? ",\n {\"plan\": " : "\n {\"plan\": ");
    thr_text_json_string(t, e[i].path);
    thr_text_printf(t, ", \"framework\": \"%016" PRIx64 "\", \"ends\": \"%s\"", thr_frame_hash(&e[i].plan.frame),
                    thr_ends_name(e[i].plan.options.ends));
    for (int r = 0; r < N_ROWS; r++) {
      double value = row[r].value(&e[i]);
      thr_text_printf(t, ", \"%s\": ", row[r].key);
      if (isnan(value))
        thr_text_append(t, "null");
      else
        thr_text_double(t, value);
    }
    thr_text_append(t, ", \"best\": [");
    for (int r = 0, some = 0; r < N_ROWS; r++)
      if (is_best(e, n, r, i)) thr_text_printf(t, "%s\"%s\"", some++ ? ", " : "", row[r].key);
    thr_text_append(t, "]}");
  }
  thr_text_append(t, "\n]\n");
}

static int read_entries(const pull_args *a, char **path, int n, entry *e)
{
  for (int i = 0; i < n; i++) {
    e[i].path = path[i];
    int code = cli_read_plan(path[i], &e[i].plan);
    if (!code) code = pull_eval(a, path[i], &e[i].plan, &e[i].pull);
    if (code) return code;
    if (i > 0 && thr_frame_hash(&e[i].plan.frame) != thr_frame_hash(&e[0].plan.frame))
      cli_note("note: %s is for another framework than %s", path[i], path[0]);
  }
  return EXIT_OK;
}

int cmd_compare(int argc, char **argv)
{
  int done, option;
  bool ok;
  pull_args a = pull_args_default();
  while ((option = cli_next_option(argc, argv, "compare", ":" CLI_COMMON_LETTERS, table, help, &done)) != -1)
    if (pull_option(&a, "compare", option, optarg, &ok) && !ok) return EXIT_USAGE;
  if (done >= 0) return done;
  int n = argc - optind;
  if (n < 1) return cli_usage("compare", "which plans?");
  entry *e = thr_calloc((size_t)n, sizeof *e);
  if (!e) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }
  int code = read_entries(&a, argv + optind, n, e);
  if (!code) {
    thr_text t = {0};
    if (a.json)
      put_json(&t, e, n);
    else
      put_text(&t, e, n, &a);
    code = cli_write(&t, "-");
  }
  for (int i = 0; i < n; i++) {
    thr_plan_destroy(&e[i].plan);
    thr_capstan_destroy(&e[i].pull);
  }
  free(e);
  return code;
}
