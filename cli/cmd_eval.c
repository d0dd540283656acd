/* thread eval: how hard must one pull? */
#include "cli/pull.h"

#include <inttypes.h>
#include <stdio.h>

static const char help[] =
    "thread eval PLAN [options]: pull force, friction loss and tension along each cord\n\n"
    "Examples:\n"
    "  thread eval plan.json --mu 0.3 --seating 5    newtons at the pulled ends so that 5 N reaches every bead\n"
    "  thread eval plan.json --pull start --tension  tension in every pass\n\n"
    "Options:\n" PULL_HELP "      --tension        print the tension in every pass\n"
    "      --json           as JSON, tension included\n"
    "  -h, --help\n\n"
    "The closed form takes the cord through the middle of every bead. A cord thinner than the bore cuts corners and needs "
    "less.\n";

enum { OPTION_TENSION = OPTION_PULL_FREE };
static const struct option table[] = {
    CLI_COMMON_OPTIONS, PULL_OPTIONS, {"tension", no_argument, NULL, OPTION_TENSION}, {NULL, 0, NULL, 0}};

static void put_tension(thr_text *t, const thr_plan *p, const thr_capstan *r)
{
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    thr_text_printf(t, "\n%-5s %6s  %-12s %-12s %12s\n", "cord", "pass", "from", "to", "tension (N)");
    for (int k = 0; k < c->n_passes; k++)
      thr_text_printf(t, "%-5s %6d  %-12s %-12s %12.6g\n", c->id, k + 1, p->frame.name[thr_tail(&p->frame, c->half[k])],
                      p->frame.name[thr_head(&p->frame, c->half[k])], r->cord[i].tension[k]);
  }
}

static void put_text(thr_text *t, const thr_plan *p, const pull_args *a, double mu, const thr_capstan *r, bool tension)
{
  thr_text_printf(t, "capstan law, mu = %g, seating tension %g N, pulled at: %s\n\n", mu, a->capstan.seating,
                  pull_name(a->capstan.pull));
  thr_text_printf(t, "%-5s %12s %14s %14s %10s  %s\n", "cord", "turning", "pull (N)", "other end (N)", "loss",
                  "slackest at pass");
  for (int i = 0; i < r->n_cords; i++) {
    const thr_capstan_cord *c = &r->cord[i];
    thr_text_printf(t, "%-5s %8.1f deg %14.6g ", p->cord[i].id, cli_degrees(c->turning), c->force);
    if (c->other_force > 0)
      thr_text_printf(t, "%14.6g", c->other_force);
    else
      thr_text_printf(t, "%14s", "-");
    thr_text_printf(t, " %8.2f %%  %d of %d\n", 100 * c->loss, c->slackest + 1, p->cord[i].n_passes);
  }
  thr_text_printf(t, "\nlargest pull %.6g N, all pulls together %.6g N\n", r->largest, r->total);
  if (tension) put_tension(t, p, r);
}

static void put_number(thr_text *t, const char *before, double value)
{
  thr_text_append(t, before);
  thr_text_double(t, value);
}

static void put_json(thr_text *t, const thr_plan *p, const pull_args *a, double mu, const thr_capstan *r)
{
  thr_text_printf(t, "{\"framework\": \"%016" PRIx64 "\", \"method\": \"capstan\"", thr_frame_hash(&p->frame));
  put_number(t, ", \"mu\": ", mu);
  put_number(t, ", \"seating\": ", a->capstan.seating);
  thr_text_printf(t, ", \"pull\": \"%s\"", pull_name(a->capstan.pull));
  put_number(t, ", \"largest\": ", r->largest);
  put_number(t, ", \"total\": ", r->total);
  thr_text_append(t, ", \"cords\": [");
  for (int i = 0; i < r->n_cords; i++) {
    const thr_capstan_cord *c = &r->cord[i];
    thr_text_append(t, i ? ",\n  {\"id\": " : "\n  {\"id\": ");
    thr_text_json_string(t, p->cord[i].id);
    put_number(t, ", \"turning\": ", c->turning);
    put_number(t, ", \"force\": ", c->force);
    put_number(t, ", \"other_force\": ", c->other_force);
    put_number(t, ", \"loss\": ", c->loss);
    thr_text_printf(t, ", \"slackest_pass\": %d, \"tension\": [", c->slackest + 1);
    for (int k = 0; k < p->cord[i].n_passes; k++)
      put_number(t, k ? ", " : "", c->tension[k]);
    thr_text_append(t, "]}");
  }
  thr_text_append(t, "\n]}\n");
}

int cmd_eval(int argc, char **argv)
{
  int done, option;
  bool tension = false, ok;
  pull_args a = pull_args_default();
  while ((option = cli_next_option(argc, argv, "eval", ":" CLI_COMMON_LETTERS, table, help, &done)) != -1) {
    if (pull_option(&a, "eval", option, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
    } else if (option == OPTION_TENSION) {
      tension = true;
    }
  }
  if (done >= 0) return done;
  if (optind + 1 != argc)
    return cli_usage("eval", optind == argc ? "which plan?" : "one plan at a time; `thread compare` takes several");
  thr_plan p;
  thr_capstan r;
  int code = cli_read_plan(argv[optind], &p);
  if (code) return code;
  if ((code = pull_eval(&a, argv[optind], &p, &r)) == EXIT_OK) {
    thr_text t = {0};
    double mu = a.mu_given ? a.capstan.mu : p.options.mu;
    if (a.json)
      put_json(&t, &p, &a, mu, &r);
    else
      put_text(&t, &p, &a, mu, &r, tension);
    code = cli_write(&t, "-");
    thr_capstan_destroy(&r);
  }
  thr_plan_destroy(&p);
  return code;
}
