/* thread plan: framework in, plan and diagrams out. */
#include "cli/pull.h"
#include "graph/cuttree.h"
#include "lp/lp.h"
#include "lp/postman.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "thread plan FRAME [options]: the shortest cord that passes every interface, proved\n\n"
    "Examples:\n"
    "  thread plan dome.obj                          plan.json and overview.svg in the folder dome/\n"
    "  thread plan dome.obj --ends feet --feet lowest   an open cord with its ends at the lowest nodes\n"
    "  thread plan dome.obj --cover 2 -o plan.json   two passes per interface; the plan only\n"
    "  thread make dome | thread plan - -o - | thread check -\n\n"
    "Options:\n"
    "      --objective length   what to minimize (default: length)\n"
    "      --compare-objectives   pull force of this plan beside those of the other objectives, joints measured in simulation\n"
    "      --ends closed    both cord ends at one node (default)\n"
    "      --ends any       an open cord, its ends wherever that makes it shortest\n"
    "      --ends feet      ends only at feet;  --ends FILE|NAME,..: only at these nodes\n"
    "      --cover N        at least N passes over every interface (default: 1)\n"
    "      --joint solid    node beads are rigid pieces with channels (default, and the only one yet)\n" CLI_FRAME_HELP
        PULL_RUN_HELP "      --time-limit S   stop after S seconds with the best plan so far and its gap (default: none)\n"
    "  -o, --output FILE    write the plan here (- = stdout), and no diagrams unless --draw\n"
    "      --draw DIR       write the diagrams into this folder, and without -o the plan too\n"
    "      --json           summary as JSON on stdout\n"
    "  -q, --quiet          no notes and no summary       -v, --verbose  what the solver does       -h, --help\n\n"
    "Exit codes: 0 proved shortest, 2 usage, 3 bad input, 4 infeasible, 5 stopped by a limit (plan written), 70 internal\n\n"
    "What is said of cord and beads is stored in the plan; thread eval begins with it.\n";

enum {
  OPTION_OBJECTIVE = OPTION_PULL_FREE,
  OPTION_COMPARE,
  OPTION_ENDS,
  OPTION_COVER,
  OPTION_JOINT,
  OPTION_TIME,
  OPTION_DRAW,
  OPTION_JSON
};

static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      CLI_FRAME_OPTIONS,
                                      PULL_RUN_OPTIONS,
                                      {"compare-objectives", no_argument, NULL, OPTION_COMPARE},
                                      {"objective", required_argument, NULL, OPTION_OBJECTIVE},
                                      {"ends", required_argument, NULL, OPTION_ENDS},
                                      {"cover", required_argument, NULL, OPTION_COVER},
                                      {"joint", required_argument, NULL, OPTION_JOINT},
                                      {"time-limit", required_argument, NULL, OPTION_TIME},
                                      {"output", required_argument, NULL, 'o'},
                                      {"draw", required_argument, NULL, OPTION_DRAW},
                                      {"json", no_argument, NULL, OPTION_JSON},
                                      {NULL, 0, NULL, 0}};

/* What can be minimized: a further objective adds its function here. */
static const struct objective {
  const char *name;
  thr_status (*plan)(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *out, thr_err *err);
} objectives[] = {{"length", thr_postman_plan}, {"symmetry", NULL}, {"tortuosity", NULL}};
enum { N_OBJECTIVES = sizeof objectives / sizeof *objectives };

typedef struct {
  cli_frame_args frame;
  pull_args pull;
  thr_plan_options plan;
  const struct objective *objective;
  const char *path, *ends, *output, *draw;
  bool json, compare;
} arguments;

static int find_objective(const char *name, const struct objective **out)
{
  char known[80] = "";
  for (int i = 0; i < N_OBJECTIVES; i++) {
    size_t n = strlen(known);
    if (!objectives[i].plan) continue;
    snprintf(known + n, sizeof known - n, "%s%s", n ? ", " : "", objectives[i].name);
    if (strcmp(name, objectives[i].name) != 0) continue;
    *out = &objectives[i];
    return -1;
  }
  return cli_usage("plan", "--objective %s: this version knows %s only", name, known);
}

static int only_word(const char *option, const char *value, const char *word)
{
  if (strcmp(value, word) == 0) return -1;
  return cli_usage("plan", "%s %s: this version knows %s only", option, value, word);
}

static int parse(int argc, char **argv, arguments *a)
{
  int done, o;
  bool ok = true;
  *a = (arguments){
      .frame = cli_frame_args_default(), .plan = thr_plan_options_default(), .objective = &objectives[0], .ends = "closed"};
  pull_args_init(&a->pull, THR_JOINT);
  while ((o = cli_physics_option(&a->pull.physics, argc, argv, "plan", ":" CLI_COMMON_LETTERS PULL_LETTERS "o:", table, help,
                                 &done)) != -1) {
    if (cli_frame_option(&a->frame, "plan", o, optarg, &ok) || pull_option(&a->pull, "plan", o, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
      continue;
    }
    switch (o) {
    case OPTION_OBJECTIVE: done = find_objective(optarg, &a->objective); break;
    case OPTION_COMPARE: a->compare = true; break;
    case OPTION_JOINT: done = only_word("--joint", optarg, "solid"); break;
    case OPTION_ENDS: a->ends = optarg; break;
    case OPTION_COVER: ok = cli_int("plan", "--cover", optarg, 1, 100, &a->plan.cover); break;
    case OPTION_TIME: ok = cli_double("plan", "--time-limit", optarg, 0, 1e9, &a->plan.time_limit); break;
    case OPTION_DRAW: a->draw = optarg; break;
    case OPTION_JSON: a->json = true; break;
    case 'o': a->output = optarg; break;
    }
    if (!ok) return EXIT_USAGE;
    if (done >= 0) return done;
  }
  if (done >= 0) return done;
  if (optind + 1 != argc) return cli_usage("plan", optind == argc ? "which framework?" : "one framework at a time");
  a->path = argv[optind];
  if ((a->output && !*a->output) || (a->draw && !*a->draw)) return cli_usage("plan", "an empty name is no place to write to");
  if ((a->json || a->compare) && a->output && strcmp(a->output, "-") == 0)
    return cli_usage("plan", "%s and -o - both want stdout", a->json ? "--json" : "--compare-objectives");
  return -1;
}

static int resolve_ends(const arguments *a, const thr_frame *f, thr_plan_options *o)
{
  for (int kind = THR_ENDS_CLOSED; kind < THR_ENDS_NODES; kind++)
    if (strcmp(a->ends, thr_ends_name((thr_ends)kind)) == 0) {
      o->ends = (thr_ends)kind;
      return EXIT_OK;
    }
  o->ends = THR_ENDS_NODES;
  if (!(o->end_node = thr_calloc((size_t)f->n_nodes, sizeof *o->end_node))) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }
  return cli_mark_nodes(f, a->ends, "--ends", o->end_node) ? EXIT_OK : EXIT_INPUT;
}

/* What was said of cord and beads must fit the framework; if nothing was, a framework of any size will do. */
static int apply_physics(const arguments *a, const thr_frame *f, thr_plan_options *o)
{
  thr_err err = {0};
  thr_physics resolved;
  int code = cli_physics_apply(&a->pull.physics, &o->physics);
  if (code || a->pull.physics.n == 0) return code;
  return thr_physics_resolve(&o->physics, f, &resolved, &err) ? cli_fail(&err) : EXIT_OK;
}

/* ---- summary ---- */

static void put_status(thr_text *t, const thr_plan *p)
{
  int cuts = thr_length_proof_cuts(&p->proof);
  if (p->proof.optimal)
    thr_text_printf(t, "optimal: no threading with these options uses less cord (certificate: %d %s, verified)\n", cuts,
                    cli_plural(cuts, "odd cut", "odd cuts"));
  else
    thr_text_printf(t, "not proved optimal: at least %.6f %s is needed, gap %.3g %%\n", p->proof.lower_bound, p->frame.units,
                    100 * p->proof.gap);
}

static void put_pull(thr_text *t, double force)
{
  thr_text_printf(t, force < 1e6 ? "%10.1f x" : "%10.1e x", force);
}

/* Is that why the pull is not known? */
static bool overflows(const thr_plan *p, const thr_cord *c)
{
  return p->options.physics.mu * thr_cord_turning(&p->frame, c, false) > 2 * 690;
}

static void put_cords(thr_text *t, const thr_plan *p, const thr_evaluation *pull)
{
  enum { MOST = 12 };
  thr_text_printf(t, "%-5s %7s %14s %10s %8s %12s  %s\n", "cord", "passes", "length", "turning", "U-turns", "pull", "ends");
  for (int i = 0; i < p->n_cords && i < MOST; i++) {
    const thr_cord *c = &p->cord[i];
    int u_turns = 0;
    for (int k = 0; k + 1 < c->n_passes; k++)
      u_turns += c->half[k + 1] == (c->half[k] ^ 1);
    thr_text_printf(t, "%-5s %7d %14.3f %6.0f deg %8d ", c->id, c->n_passes, thr_cord_length(&p->frame, c),
                    cli_degrees(pull ? pull->cord[i].turning : thr_cord_turning(&p->frame, c, false)), u_turns);
    if (pull)
      put_pull(t, pull->cord[i].force);
    else
      thr_text_printf(t, "%12s", overflows(p, c) ? "> 1e300 x" : "-");
    const char *from = p->frame.name[thr_cord_start(&p->frame, c)], *to = p->frame.name[thr_cord_end(&p->frame, c)];
    thr_text_printf(t, c->closed ? "  both at %s\n" : "  %s and %s\n", from, to);
  }
  if (p->n_cords > MOST) thr_text_printf(t, "..    and %d more\n", p->n_cords - MOST);
}

static void put_summary(thr_text *t, const thr_plan *p, const thr_evaluation *pull)
{
  const thr_metrics *m = &p->metrics;
  thr_text_printf(t, "%d nodes, %d %s, %d %s; %d %s per edge; ends: %s\n\n", p->frame.n_nodes, p->frame.n_edges,
                  cli_plural(p->frame.n_edges, "edge", "edges"), p->n_cords, cli_plural(p->n_cords, "piece", "pieces"),
                  p->options.cover, cli_plural(p->options.cover, "pass", "passes"), thr_ends_name(p->options.ends));
  put_cords(t, p, pull);
  thr_text_printf(t, "\nlength   %.6f %s = %.6f for %d %s over every edge + %.6f overlap (%.1f %%)\n", m->length, p->frame.units,
                  m->base_length, p->options.cover, cli_plural(p->options.cover, "pass", "passes"), m->overlap,
                  100 * m->overlap / m->base_length);
  thr_text_append(t, "         ");
  put_status(t, p);
  thr_text_printf(t, "pull     with both ends pulled, times the tension that must reach the slackest point (mu = %g)\n",
                  p->options.physics.mu);
}

static void put_json_summary(thr_text *t, const thr_plan *p, const thr_evaluation *pull)
{
  const thr_metrics *m = &p->metrics;
  thr_text_printf(t, "{\"framework\": \"%016" PRIx64 "\", \"nodes\": %d, \"edges\": %d, \"cords\": %d, ",
                  thr_frame_hash(&p->frame), p->frame.n_nodes, p->frame.n_edges, p->n_cords);
  thr_text_append(t, "\"units\": ");
  thr_text_json_string(t, p->frame.units);
  const struct {
    const char *key;
    double value;
  } number[] = {{"length", m->length},           {"base_length", m->base_length},
                {"overlap", m->overlap},         {"lower_bound", p->proof.lower_bound},
                {"gap", p->proof.gap},           {"turning", m->turning},
                {"max_turning", m->max_turning}, {"mu", p->options.physics.mu}};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
    thr_text_printf(t, ", \"%s\": ", number[i].key);
    thr_text_double(t, number[i].value);
  }
  thr_text_printf(t, ", \"status\": \"%s\", \"pull_factor\": ", p->proof.optimal ? "optimal" : "bound");
  if (pull)
    thr_text_double(t, pull->largest);
  else
    thr_text_append(t, "null");
}

/* ---- the other objectives ---- */

static int put_objective(thr_text *t, const arguments *a, const struct objective *objective, const thr_plan *p)
{
  thr_eval e;
  const char *closing = objective == a->objective ? "   this plan" : "";
  int code = pull_eval(&a->pull, objective->name, p, THR_JOINT, &e);
  if (a->json)
    thr_text_printf(t, "{\"objective\": \"%s\", \"pull\": ", objective->name);
  else
    thr_text_printf(t, "  %-12s", objective->name);
  if (code == EXIT_OK && a->json) {
    thr_text_double(t, e.record.largest);
    thr_text_append(t, ", \"error\": ");
    thr_text_double(t, e.error);
    thr_text_printf(t, ", \"refused\": %d", e.refused);
  } else if (code == EXIT_OK) {
    thr_text_printf(t, e.refused ? "%12.4g N (error at least %.3g %%" : "%12.4g N (+-%.3g %%", e.record.largest,
                    pull_percent(e.error));
    if (e.refused) thr_text_printf(t, ": %d %s by closed form", e.refused, cli_plural(e.refused, "turn", "turns"));
    thr_text_printf(t, ")%s", closing);
  } else {
    thr_text_printf(t, a->json ? "null" : "%14s", "not known");
  }
  thr_text_append(t, a->json ? "}" : "\n");
  thr_eval_destroy(&e);
  return code;
}

static int plan_and_put(thr_text *t, const arguments *a, const struct objective *objective, const thr_plan *p)
{
  thr_err err = {0};
  thr_plan other = {0};
  if (objective == a->objective) return put_objective(t, a, objective, p);
  thr_limits limits = cli_limits(p->options.time_limit);
  thr_status st = objective->plan(&p->frame, &p->options, &limits, &other, &err);
  cli_progress_end();
  int code = st && st != THR_ELIMIT ? cli_fail(&err) : put_objective(t, a, objective, &other);
  thr_plan_destroy(&other);
  return code;
}

/* Pull of this plan beside that of the plans for the other objectives. */
static int put_comparison(thr_text *t, const arguments *a, const thr_plan *p)
{
  int code = EXIT_OK;
  thr_text_append(t, a->json ? ", \"objectives\": [" : "\nlargest pull by objective, joints measured in simulation\n");
  for (int i = 0; i < N_OBJECTIVES; i++) {
    const struct objective *objective = &objectives[i];
    if (i && a->json) thr_text_append(t, ", ");
    if (objective->plan) {
      int done = plan_and_put(t, a, objective, p);
      if (!code) code = done;
    } else {
      thr_text_printf(t, a->json ? "{\"objective\": \"%s\", \"pull\": null}" : "  %-12s  not in this version\n", objective->name);
    }
  }
  if (a->json) thr_text_append(t, "]");
  return code;
}

static int print_summary(const arguments *a, const thr_plan *p)
{
  thr_text t = {0};
  int code = EXIT_OK;
  thr_eval pull;
  thr_limits none = {0};
  thr_eval_options o = thr_eval_options_default();
  o.physics = p->options.physics;
  o.physics.seating = 1;
  bool known = thr_eval_plan(&p->frame, p->cord, p->n_cords, THR_CAPSTAN, &o, &none, &pull, NULL) == THR_OK;
  if (a->json)
    put_json_summary(&t, p, known ? &pull.record : NULL);
  else
    put_summary(&t, p, known ? &pull.record : NULL);
  thr_eval_destroy(&pull);
  if (a->compare) code = put_comparison(&t, a, p);
  if (a->json) thr_text_append(&t, "}\n");
  int written = cli_write(&t, "-");
  return code ? code : written;
}

/* ---- outputs ---- */

static int write_plan(const thr_plan *p, const char *path)
{
  thr_text t = {0};
  thr_plan_write(p, &t);
  return cli_write(&t, path);
}

/* Plan and diagrams where the options say; where they say nothing, in a folder named after the framework. */
static int write_outputs(const arguments *a, const thr_plan *p)
{
  char stem[256], in_folder[1200], svg_path[1200];
  const char *plan_path = a->output ? a->output : in_folder;
  cli_stem(a->path, stem, sizeof stem);
  const char *folder = a->draw ? a->draw : stem;
  bool draw = a->draw || !a->output;
  int code = a->output ? EXIT_OK : cli_in_folder(folder, "plan.json", in_folder, sizeof in_folder);
  if (!code && draw) code = cli_in_folder(folder, "overview.svg", svg_path, sizeof svg_path);
  if (!code) code = write_plan(p, plan_path);
  if (!code && draw) code = cli_draw_overview(p, svg_path, 0, false);
  bool to_stdout = strcmp(plan_path, "-") == 0;
  if (code || to_stdout || (cli_quiet && !a->json)) return code;
  code = print_summary(a, p);
  if (a->json) return code;
  printf("%splan     %s\n", a->compare ? "\n" : "", plan_path);
  if (draw) printf("drawing  %s\n", svg_path);
  return code;
}

static int plan_frame(const arguments *a, const thr_frame *f)
{
  thr_err err = {0};
  thr_plan plan = {0};
  thr_plan_options o = a->plan;
  int code = apply_physics(a, f, &o);
  if (!code) code = resolve_ends(a, f, &o);
  if (code == EXIT_OK) {
    thr_limits limits = cli_limits(o.time_limit);
    thr_status st = a->objective->plan(f, &o, &limits, &plan, &err);
    cli_progress_end();
    if (st && st != THR_ELIMIT) {
      code = cli_fail(&err);
    } else {
      char versions[160];
      snprintf(versions, sizeof versions, "thread %s, GLPK %s, igraph %s", THR_VERSION, thr_glpk_version(), thr_igraph_version());
      plan.generator = thr_strdup(versions);
      code = write_outputs(a, &plan);
      if (code == EXIT_OK && st == THR_ELIMIT) code = cli_fail(&err);
    }
  }
  free(o.end_node);
  thr_plan_destroy(&plan);
  return code;
}

int cmd_plan(int argc, char **argv)
{
  arguments a;
  thr_frame f;
  int code = parse(argc, argv, &a);
  if (code >= 0) return code;
  if ((code = cli_read_frame(a.path, &a.frame, &f))) return code;
  code = plan_frame(&a, &f);
  thr_frame_destroy(&f);
  return code;
}
