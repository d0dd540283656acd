/* thread info: what a framework is made of. */
#include "cli/cli.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static const char help[] = "thread info FRAME [options]: nodes, edges, degrees, odd nodes, pieces, bridges, feet\n\n"
                           "Examples:\n"
                           "  thread info dome.obj --feet lowest\n"
                           "  thread info nodes.csv --edges edges.csv --json\n"
                           "  thread info plan.json                         the framework inside a plan\n\n"
                           "Options:\n" CLI_FRAME_HELP "      --json           as JSON\n"
                           "  -q, --quiet          no notes on what was merged or dropped       -h, --help\n";

enum { OPTION_JSON = OPTION_FREE, MOST_DEGREES = 64 };
static const struct option table[] = {
    CLI_COMMON_OPTIONS, CLI_FRAME_OPTIONS, {"json", no_argument, NULL, OPTION_JSON}, {NULL, 0, NULL, 0}};

typedef struct {
  int degree[MOST_DEGREES + 1]; /* nodes of each degree; the last counts all higher ones too */
  int odd, components, bridges, feet;
  double shortest, longest;
} facts;

static thr_status find_facts(const thr_frame *f, facts *a, thr_err *err)
{
  *a = (facts){.shortest = f->length[0]};
  int *component = thr_calloc((size_t)f->n_nodes, sizeof *component);
  bool *bridge = thr_calloc((size_t)f->n_edges, sizeof *bridge);
  thr_status st = component && bridge ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(f, component, &a->components, err);
  if (!st) st = thr_frame_bridges(f, bridge, err);
  for (int v = 0; v < f->n_nodes && !st; v++) {
    int d = thr_degree(f, v);
    a->degree[d < MOST_DEGREES ? d : MOST_DEGREES]++;
    a->odd += d % 2;
    a->feet += f->foot[v];
  }
  for (int e = 0; e < f->n_edges && !st; e++) {
    a->bridges += bridge[e];
    if (f->length[e] < a->shortest) a->shortest = f->length[e];
    if (f->length[e] > a->longest) a->longest = f->length[e];
  }
  free(component);
  free(bridge);
  return st;
}

static void put_text(thr_text *t, const thr_frame *f, const facts *a)
{
  thr_text_printf(t, "nodes       %d\nedges       %d\n", f->n_nodes, f->n_edges);
  thr_text_append(t, "degrees    ");
  for (int d = 0; d <= MOST_DEGREES; d++)
    if (a->degree[d]) thr_text_printf(t, " %d x %d%s", a->degree[d], d, d == MOST_DEGREES ? " or more" : "");
  thr_text_printf(t, "\nodd nodes   %d%s\n", a->odd, a->odd ? "" : " (one closed cord needs no overlap)");
  thr_text_printf(t, "pieces      %d\nbridges     %d%s\nfeet        %d\n", a->components, a->bridges,
                  a->bridges ? " (a closed cord passes each twice)" : "", a->feet);
  thr_text_printf(t, "length      %.6f %s in all, edges from %.6g to %.6g%s\n", thr_frame_total_length(f), f->units, a->shortest,
                  a->longest, f->own_lengths ? " (given by the file)" : "");
  thr_text_printf(t, "size        %.6g %s (diagonal of the bounding box)\n", thr_frame_diagonal(f), f->units);
  thr_text_printf(t, "hash        %016" PRIx64 "\n", thr_frame_hash(f));
}

static void put_json(thr_text *t, const thr_frame *f, const facts *a)
{
  bool some = false;
  thr_text_printf(t, "{\"nodes\": %d, \"edges\": %d, \"degrees\": {", f->n_nodes, f->n_edges);
  for (int d = 0; d <= MOST_DEGREES; d++)
    if (a->degree[d]) {
      thr_text_printf(t, "%s\"%d\": %d", some ? ", " : "", d, a->degree[d]);
      some = true;
    }
  thr_text_printf(t, "}, \"odd_nodes\": %d, \"components\": %d, \"bridges\": %d, \"feet\": %d, \"units\": ", a->odd,
                  a->components, a->bridges, a->feet);
  thr_text_json_string(t, f->units);
  const struct {
    const char *key;
    double value;
  } number[] = {{"length", thr_frame_total_length(f)},
                {"shortest_edge", a->shortest},
                {"longest_edge", a->longest},
                {"diagonal", thr_frame_diagonal(f)}};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
    thr_text_printf(t, ", \"%s\": ", number[i].key);
    thr_text_double(t, number[i].value);
  }
  thr_text_printf(t, ", \"hash\": \"%016" PRIx64 "\"}\n", thr_frame_hash(f));
}

int cmd_info(int argc, char **argv)
{
  int done, o;
  bool json = false, ok;
  cli_frame_args args = cli_frame_args_default();
  while ((o = cli_next_option(argc, argv, "info", ":" CLI_COMMON_LETTERS, table, help, &done)) != -1) {
    if (cli_frame_option(&args, "info", o, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
    } else if (o == OPTION_JSON) {
      json = true;
    }
  }
  if (done >= 0) return done;
  if (optind + 1 != argc) return cli_usage("info", optind == argc ? "which framework?" : "one framework at a time");
  thr_frame f;
  int code = cli_read_frame(argv[optind], &args, &f);
  if (code) return code;
  facts a;
  thr_text t = {0};
  thr_err err = {0};
  if (find_facts(&f, &a, &err)) {
    code = cli_fail(&err);
  } else {
    (json ? put_json : put_text)(&t, &f, &a);
    code = cli_write(&t, "-");
  }
  thr_frame_destroy(&f);
  return code;
}
