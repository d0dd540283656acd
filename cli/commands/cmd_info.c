/* thread info: what a framework is made of. */
#include "cli/cli.h"
#include "cli/guard.h"
#include "eval/structure/rigidity.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/junction.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "thread info FRAME [options]: nodes, edges, odd nodes, components, feet, rigidity\n\n"
    "Examples:\n"
    "  thread info dome.obj --feet lowest\n"
    "  thread info nodes.csv --edges edges.csv --json\n"
    "  thread info plan.json                         the framework inside a plan, and the joints that its cords do not tie\n\n"
    "The line `hinged` takes every node for a ball joint: can nodes move without an edge getting longer?\n"
    "What can move must be held by joints that lock. A joint is tied if the cord alone holds its edges\n"
    "together (--joint tube); joints of solid beads need not be.\n\n"
    "Options:\n" CLI_FRAME_HELP "      --json           as JSON\n" GUARD_HELP
    "  -q, --quiet          no notes on what was merged or dropped       -h, --help\n";

enum { OPTION_JSON = OPTION_FREE, MOST_DEGREES = 64, MOST_NAMES = 20, MOST_BARS = 50000 };
static const struct option table[] = {
    CLI_COMMON_OPTIONS, CLI_FRAME_OPTIONS, GUARD_OPTIONS, {"json", no_argument, NULL, OPTION_JSON}, {NULL, 0, NULL, 0}};

typedef struct {
  int degree[MOST_DEGREES + 1]; /* nodes of each degree; the last counts all higher ones too */
  int odd, components, bridges, feet;
  double shortest, longest;
  bool analysed;
  thr_rigidity rigidity;
  bool planned; /* the framework came in a plan */
  int n_untied;
  bool *untied; /* [n_nodes] planned: owned */
} facts;

/* Is the rank of the rigidity matrix worked out within a second or so? It is sparse unless edges are many for their nodes. */
static bool can_analyse(const thr_frame *f)
{
  const double most_work = 2e9, columns = 3.0 * f->n_nodes;
  return f->n_edges <= MOST_BARS && (f->n_edges <= 20 * f->n_nodes || f->n_edges * columns * columns <= most_work);
}

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
  a->analysed = can_analyse(f);
  return st || !a->analysed ? st : thr_rigidity_find(f, &a->rigidity, err);
}

/* Joints that the cords of a plan do not tie; nothing if the file is no valid plan. stdin has been read already. */
static thr_status find_untied(const char *path, facts *a, thr_err *err)
{
  thr_plan p;
  thr_err not_a_plan = {0};
  if (strcmp(path, "-") == 0) return THR_OK;
  thr_status st = thr_plan_read(&p, path, &not_a_plan);
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
  if (!(a->untied = thr_calloc((size_t)p.frame.n_nodes, sizeof *a->untied))) st = thr_nomem(err);
  if (!st) st = thr_junction_tied(&p.frame, p.cord, p.n_cords, p.options.ends == THR_ENDS_CLOSED, a->untied, err);
  for (int v = 0; v < p.frame.n_nodes && !st; v++)
    a->n_untied += a->untied[v] = !a->untied[v];
  a->planned = !st;
  thr_plan_destroy(&p);
  return st;
}

static void put_motions(thr_text *t, const facts *a)
{
  const thr_rigidity *r = &a->rigidity;
  if (r->motions == 0)
    thr_text_printf(t, "hinged      rigid, %d %s more than it needs", r->self_stresses, r->self_stresses == 1 ? "edge" : "edges");
  else
    thr_text_printf(t, "hinged      %d %s to move without stretching an edge", r->motions, r->motions == 1 ? "way" : "ways");
  if (r->flat) thr_text_printf(t, "; %d within its plane", r->plane_motions);
  if (a->feet) thr_text_printf(t, "; %d with its feet held", r->pinned);
  thr_text_printf(t, "%s\n", r->unclear ? " (a close call: rounding decides)" : "");
}

static void put_rigidity(thr_text *t, const thr_frame *f, const facts *a)
{
  if (a->analysed)
    put_motions(t, a);
  else
    thr_text_append(t, "hinged      not worked out for so many edges\n");
  if (!a->planned) return;
  thr_text_printf(t, "untied      %d of %d joints", a->n_untied, f->n_nodes);
  int shown = 0;
  for (int v = 0; v < f->n_nodes && shown < MOST_NAMES; v++)
    if (a->untied[v]) thr_text_printf(t, "%s%s", shown++ ? " " : ": ", f->name[v]);
  thr_text_append(t, shown < a->n_untied ? " ..\n" : "\n");
}

/* Covers or capacities; 0 = none. */
static void put_range(thr_text *t, const char *what, const int *value, int n)
{
  int low = INT_MAX, high = 0;
  for (int e = 0; e < n; e++) {
    low = value[e] > 0 && value[e] < low ? value[e] : low;
    high = value[e] > high ? value[e] : high;
  }
  thr_text_printf(t, "%-12s%d to %d passes an edge, given by the file\n", what, low, high);
}

static void put_text(thr_text *t, const thr_frame *f, const facts *a)
{
  thr_text_printf(t, "nodes       %d\nedges       %d\n", f->n_nodes, f->n_edges);
  thr_text_append(t, "degrees    ");
  for (int d = 0; d <= MOST_DEGREES; d++)
    if (a->degree[d]) thr_text_printf(t, " %d x %d%s", a->degree[d], d, d == MOST_DEGREES ? " or more" : "");
  thr_text_printf(t, "\nodd nodes   %d%s\n", a->odd, a->odd ? "" : " (one closed cord needs no overlap)");
  thr_text_printf(t, "components  %d\nbridges     %d%s\nfeet        %d\n", a->components, a->bridges,
                  a->bridges ? " (a closed cord passes each twice)" : "", a->feet);
  thr_text_printf(t, "length      %.6f %s in all, edges from %.6g to %.6g%s\n", thr_frame_total_length(f), f->units, a->shortest,
                  a->longest, f->own_lengths ? " (given by the file)" : "");
  if (f->cover) put_range(t, "covers", f->cover, f->n_edges);
  if (f->capacity) put_range(t, "capacities", f->capacity, f->n_edges);
  thr_text_printf(t, "size        %.6g %s (diagonal of the bounding box)\n", thr_frame_diagonal(f), f->units);
  put_rigidity(t, f, a);
  thr_text_printf(t, "hash        %016" PRIx64 "\n", thr_frame_hash(f));
}

static void put_rigidity_json(thr_writer *w, const facts *a)
{
  const thr_rigidity *r = &a->rigidity;
  thr_write_object(w, "rigidity");
  thr_write_int(w, "rank", r->rank);
  thr_write_int(w, "rigid_motions", r->rigid_motions);
  thr_write_int(w, "motions", r->motions);
  thr_write_int(w, "self_stresses", r->self_stresses);
  thr_write_number(w, "motions_within_plane", r->flat ? (double)r->plane_motions : NAN);
  thr_write_number(w, "motions_with_feet_held", a->feet > 0 ? (double)r->pinned : NAN);
  thr_write_bool(w, "unclear", r->unclear);
  thr_write_close(w);
}

static void put_untied_json(thr_writer *w, const thr_frame *f, const facts *a)
{
  thr_write_array(w, "untied");
  for (int v = 0; v < f->n_nodes; v++)
    if (a->untied[v]) thr_write_string(w, NULL, f->name[v]);
  thr_write_close(w);
}

static void put_degrees_json(thr_writer *w, const facts *a)
{
  thr_write_object(w, "degrees");
  for (int d = 0; d <= MOST_DEGREES; d++) {
    char degree[16];
    snprintf(degree, sizeof degree, "%d", d);
    if (a->degree[d]) thr_write_int(w, degree, a->degree[d]);
  }
  thr_write_close(w);
}

static void put_json(thr_text *t, const thr_frame *f, const facts *a)
{
  thr_writer w = {.out = t};
  thr_write_object(&w, NULL);
  thr_write_int(&w, "nodes", f->n_nodes);
  thr_write_int(&w, "edges", f->n_edges);
  put_degrees_json(&w, a);
  thr_write_int(&w, "odd_nodes", a->odd);
  thr_write_int(&w, "components", a->components);
  thr_write_int(&w, "bridges", a->bridges);
  thr_write_int(&w, "feet", a->feet);
  thr_write_string(&w, "units", f->units);
  thr_write_number(&w, "length", thr_frame_total_length(f));
  thr_write_number(&w, "shortest_edge", a->shortest);
  thr_write_number(&w, "longest_edge", a->longest);
  thr_write_number(&w, "diagonal", thr_frame_diagonal(f));
  if (a->analysed) put_rigidity_json(&w, a);
  if (a->planned) put_untied_json(&w, f, a);
  thr_write_hash(&w, "hash", thr_frame_hash(f));
  thr_write_close(&w);
  thr_text_append(t, "\n");
}

static int tell(const char *path, const cli_frame_args *args, bool json)
{
  thr_frame f;
  int code = cli_read_frame(path, args, &f);
  if (code) return code;
  facts a;
  thr_text t = {0};
  thr_err err = {0};
  if (find_facts(&f, &a, &err) || find_untied(path, &a, &err)) {
    code = cli_fail(&err);
  } else {
    (json ? put_json : put_text)(&t, &f, &a);
    code = cli_write(&t, "-");
  }
  free(a.untied);
  thr_frame_destroy(&f);
  return code;
}

int cmd_info(int argc, char **argv)
{
  int done, o;
  bool json = false, ok;
  cli_frame_args args = cli_frame_args_default();
  guard_limits guard = guard_limits_default();
  guard_end end;
  while ((o = cli_next_option(argc, argv, "info", ":" CLI_COMMON_LETTERS, table, help, &done)) != -1) {
    if (cli_frame_option(&args, "info", o, optarg, &ok) || guard_option(&guard, "info", o, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
    } else if (o == OPTION_JSON) {
      json = true;
    }
  }
  if (done >= 0) return done;
  if (optind + 1 != argc) return cli_usage("info", optind == argc ? "which framework?" : "one framework at a time");
  if (guard_fork(&guard, &end)) return guard_conclude(&end, "nothing is known");
  return tell(argv[optind], &args, json);
}
