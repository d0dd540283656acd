/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the options of what acts on the structure beside weight and cords: loads on nodes, the
 * pulls at which loads are tried, a tilted ground, held feet.
 *
 * Loads name nodes, and so are only read when the framework is known (load_apply).
 *
 * Example: `--load "D4=10;E5=0,1,-2"` hangs 10 N on D4, and on E5 the force (0, 1, -2) N. */
#include "cli/args/args.h"
#include "graph/number.h"
#include "graph/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads numbers with commas between them. Returns how many there are, or -1 if the text is no such
 * list or one of more than `most` numbers. */
static int parse_numbers(const char *text, size_t length, double *out, int most)
{
  char word[400], *at = word, *end;
  int n = 0;
  if (length >= sizeof word) return -1;

  snprintf(word, sizeof word, "%.*s", (int)length, text);

  /* Every number is followed by a comma or the end. */
  for (;; at = end + 1) {
    if (n == most) return -1;
    out[n] = strtod(at, &end);
    if (end == at || !isfinite(out[n++])) return -1;
    if (*end == '\0') return n;
    if (*end != ',') return -1;
  }
}

/* Reads the value of --load-pulls, newtons above 0. */
static bool take_pulls(void *into, const cli_option *option, const char *value)
{
  load_args *args = into;
  const double most = 1e12; /* N */
  (void)option;
  args->n_pulls = parse_numbers(value, strlen(value), args->pulls, LOAD_MOST_PULLS);

  bool ok = args->n_pulls > 0;
  for (int i = 0; i < args->n_pulls; i++) {
    ok &= args->pulls[i] > 0 && args->pulls[i] <= most;
  }

  if (!ok)
    cli_usage(cli_command_name(),
              "--load-pulls %s: expected up to %d newtons above 0 with commas, as 1,5,50", value,
              LOAD_MOST_PULLS);

  return ok;
}

/* Reads the value of --tilt, DEG or DEG,AZIMUTH; degrees become rad. */
static bool take_tilt(void *into, const cli_option *option, const char *value)
{
  load_args *args = into;
  double number[2] = {0};
  const int n = parse_numbers(value, strlen(value), number, 2);
  const bool ok = n > 0 && number[0] >= 0 && number[0] < 90 && fabs(number[1]) <= 360;
  (void)option;

  if (!ok)
    cli_usage(cli_command_name(), "--tilt %s: expected degrees from 0 to below 90, or DEG,AZIMUTH",
              value);

  /* Without an azimuth the ground goes down towards x. */
  args->tilt = number[0] * THR_PI / 180;
  args->azimuth = number[1] * THR_PI / 180;

  return ok;
}

/* Notes the value of --load, which may be given once. */
static bool take_load(void *into, const cli_option *option, const char *value)
{
  load_args *args = into;
  (void)option;
  if (args->load) {
    cli_usage(cli_command_name(),
              "--load is there twice; several nodes go into one, with semicolons");
    return false;
  }
  args->load = value;

  return true;
}

#define AT(member) .offset = offsetof(load_args, member)

const cli_option cli_load_options[] = {
    {"load", .value = "NODE=N", .kind = CLI_OTHER, .take = take_load,
     .help = "structure: newtons that hang on a node, or NODE=FX,FY,FZ; several with semicolons: "
             "what pull they need, how many times so much is carried at some pulls, and what moves "
             "first; NODE=0,0,N lifts, like a hand or a counterweight: the pull that is then "
             "needed"},
    {"load-pulls", .value = "LIST", .kind = CLI_OTHER, .take = take_pulls,
     .help = "at these pulls of all ends, newtons with commas (default: 1,2,5,10,20,50; above 100 "
             "pieces 10,50; compare: one, 10)"},
    {"tilt", .value = "DEG", .kind = CLI_OTHER, .take = take_tilt,
     .help = "structure: the ground leans by so many degrees towards x, or DEG,AZIMUTH (from x to "
             "y)"},
    {"clamp-feet", .kind = CLI_FLAG, AT(clamped),
     .help = "structure: feet are held in place; else they stand on the ground"},
    {"taut", .kind = CLI_FLAG, AT(taut),
     .help = "structure: turns are those of the tight cord in its bores, as --method joint finds "
             "them, not those of the middles of the bores: it needs less while it is drawn in, and "
             "keeps less"},
    {0}};

/* Rays of the pyramids that stand for friction cones: with 24 the bounds are ten times closer, and
 * take some three times as long. */
const cli_option cli_load_tuned[] = {
    {"rays", .kind = CLI_COUNT, AT(rays), .low = THR_USUAL_RAYS, .high = THR_MOST_RAYS}, {0}};

bool load_any(const load_args *args)
{
  return args->load || args->tilt > 0 || args->clamped;
}

/* Adds one load to load[n_nodes]: "D4=10", which hangs on the node, or "D4=0,1,-10", a force.
 * Returns an exit code. */
static int add_load(const thr_frame *frame, const char *text, size_t length, double (*load)[3])
{
  char name[256];
  double force[3];

  /* Names may hold an equals sign: the last one counts. */
  size_t equals = length;
  while (equals > 0 && text[equals - 1] != '=')
    equals--;

  /* One number or three behind the sign. */
  const int n = equals > 1 ? parse_numbers(text + equals, length - equals, force, 3) : -1;
  if ((n != 1 && n != 3) || equals - 1 >= sizeof name)
    return cli_usage(cli_command_name(),
                     "--load %.*s: expected NODE=N, newtons that hang there, or NODE=FX,FY,FZ",
                     (int)length, text);

  /* The node is named before the sign. Weights point down. */
  snprintf(name, sizeof name, "%.*s", (int)(equals - 1), text);
  const int v = thr_frame_find(frame, name);
  if (v < 0) return cli_no_node(frame, "--load", "node", name);
  for (int k = 0; k < 3; k++)
    load[v][k] += n == 3 ? force[k] : k == 2 ? -force[0] : 0;

  return EXIT_OK;
}

/* Adds all loads of a list with semicolons to load[n_nodes]. Returns an exit code. */
static int read_loads(const char *list, const thr_frame *frame, double (*load)[3])
{
  bool some = false;
  for (const char *at = list; *at;) {
    const size_t length = strcspn(at, ";");
    const int code = add_load(frame, at, length, load);
    if (code) return code;
    at += length + (at[length] == ';');
  }

  /* Loads that add up to nothing are a mistake. */
  for (int v = 0; v < frame->n_nodes; v++)
    some |= load[v][0] != 0 || load[v][1] != 0 || load[v][2] != 0;

  return some ? EXIT_OK : cli_usage(cli_command_name(), "--load %s: no force at all", list);
}

int load_apply(const load_args *args, const thr_frame *frame, thr_eval_options *options,
               double (**load)[3])
{
  int code = EXIT_OK;

  *load = NULL;
  options->tilt = args->tilt;
  options->azimuth = args->azimuth;
  options->clamped = args->clamped;
  options->taut = args->taut;
  options->rays = args->rays;
  options->load_pull = args->pulls;
  options->n_load_pulls = args->n_pulls;

  /* Loads at nodes, which the caller frees. */
  if (!args->load) return EXIT_OK;
  if (!(*load = thr_calloc((size_t)frame->n_nodes, sizeof **load))) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }

  code = read_loads(args->load, frame, *load);
  options->load = (const double(*)[3]) * load;

  return code;
}
