/* thread check: is everything that a plan says true? */
#include "cli/cli.h"
#include "cli/guard.h"
#include "cli/print/terms.h"
#include "graph/angle.h"
#include "graph/check/check.h"
#include "graph/io/writer.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <string.h>

static const char help[] =
    "thread check PLAN.. [--json]: verify coverage, ends, metrics and the proof of optimality; no solver is used\n\n"
    "Examples:\n"
    "  thread check plan.json\n"
    "  thread plan dome.obj -o - | thread check -\n\n"
    "Options:\n"
    "      --json           one JSON line per plan\n" GUARD_HELP
    "  -q, --quiet          print nothing for plans that hold       -h, --help\n\n"
    "Exit codes: 0 all plans hold, 1 a violation (printed with its place), 2 usage, 3 not a plan,\n"
    "5 not verified in the time or memory\n";

enum { OPTION_JSON = OPTION_FREE };
static const struct option table[] = {
    CLI_COMMON_OPTIONS, GUARD_OPTIONS, {"json", no_argument, NULL, OPTION_JSON}, {NULL, 0, NULL, 0}};

/* Of a plan for the least turning, whether its length is the shortest or not: that is another claim. */
static void put_turning(thr_text *t, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  int branchings = c->tree.n_nodes / 2;
  const char *cost = thr_turn_cost_name(p->options.turning.cost);
  bool angles = p->options.turning.cost == THR_TURN_ANGLE;
  if (!thr_wants_turning(&p->options)) return;
  thr_text_printf(t, "; turning %.3f deg: ", thr_degrees(p->metrics.turning));
  if (!c->present) {
    thr_text_append(t, "no claim of optimality");
    return;
  }
  if (!angles) thr_text_printf(t, "price %.9g (%s), ", c->price, cost);
  if (c->optimal)
    thr_text_append(t, "optimal, proof verified");
  else
    thr_text_printf(t, "lower bound %.*f verified, gap %.3g %%", angles ? 3 : 6,
                    angles ? thr_degrees(c->lower_bound) : c->lower_bound, 100 * c->gap);
  thr_text_printf(t, " (%d %s", branchings, cli_plural(branchings, "branching", "branchings"));
  thr_text_append(t, ")");
  if (c->largest_optimal && p->n_cords > 1) thr_text_append(t, "; largest cord: bound attained");
}

static void put_symmetry(thr_text *t, const thr_plan *p)
{
  const thr_symmetry_record *s = &p->symmetry;
  if (!s->present) return;
  thr_text_printf(t, "; group %s%sof order %d, %d unique %s, %g learned steps, verified", s->name, s->name[0] ? " " : "",
                  s->order, s->unique_paths, cli_plural(s->unique_paths, "path", "paths"), s->steps);
}

/* What was verified of several cords, where the plan asked for it. */
static void put_cords(thr_text *t, const thr_plan *p)
{
  const thr_cords_claim *c = &p->cords_claim;
  if (c->present && thr_wants_balance(&p->options)) {
    thr_text_printf(t, "; longest cord %.6f %s: ", c->longest, p->frame.units);
    if (c->longest_optimal)
      thr_text_append(t, "optimal, verified");
    else
      thr_text_printf(t, "lower bound %.6f verified, gap %.3g %%", c->longest_bound,
                      100 * (c->longest - c->longest_bound) / c->longest);
  }
  if (c->present && c->fewest > 0)
    thr_text_printf(t, c->fewest_optimal ? "; no fewer than %d cords, verified" : "; at least %d cords, verified", c->fewest);
  if (p->options.joint == THR_JOINT_TUBE) thr_text_append(t, "; every joint tied");
}

static void put_verdict(thr_text *t, const char *path, const thr_plan *p)
{
  const thr_metrics *m = &p->metrics;
  const char *units = p->frame.units;
  int cuts = thr_length_proof_cuts(&p->proof);
  thr_text_append_clean(t, path);
  thr_text_printf(t, ": %d %s, %d passes, every edge covered, length %.6f %s: ", p->n_cords,
                  cli_plural(p->n_cords, "cord", "cords"), m->passes, m->length, units);
  if (!p->proof.present)
    thr_text_append(t, "no claim of optimality");
  else if (p->proof.optimal)
    thr_text_printf(t, "optimal, certificate verified (%d %s)", cuts, cli_cuts_word(p, cuts));
  else
    thr_text_printf(t, "lower bound %.6f verified, gap %.3g %%", p->proof.lower_bound, 100 * p->proof.gap);
  put_cords(t, p);
  put_turning(t, p);
  put_symmetry(t, p);
  thr_text_append(t, "\n");
  terms_put(t, p);
}

static void put_turning_json(thr_writer *w, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  thr_write_number(w, "turning", p->metrics.turning);
  if (!c->present) return;
  thr_write_string(w, "turning_status", c->optimal ? "optimal" : "bound");
  thr_write_number(w, "price", c->price);
  thr_write_number(w, "price_lower_bound", c->lower_bound);
  thr_write_number(w, "turning_gap", c->gap);
  if (c->length_limit >= 0) thr_write_number(w, "length_limit", c->length_limit);
}

static void put_cords_json(thr_writer *w, const thr_cords_claim *c)
{
  thr_write_number(w, "longest", c->longest);
  thr_write_number(w, "longest_lower_bound", c->longest_bound);
  if (c->fewest > 0) thr_write_int(w, "fewest_cords", c->fewest);
}

static void put_symmetry_json(thr_writer *w, const thr_symmetry_record *s)
{
  thr_write_int(w, "group_order", s->order);
  thr_write_int(w, "unique_paths", s->unique_paths);
  thr_write_number(w, "learned_steps", s->steps);
}

static void put_claims_json(thr_writer *w, const thr_plan *p)
{
  thr_write_number(w, "length", p->metrics.length);
  if (p->proof.present) {
    thr_write_string(w, "status", p->proof.optimal ? "optimal" : "bound");
    thr_write_number(w, "lower_bound", p->proof.lower_bound);
    thr_write_number(w, "gap", p->proof.gap);
  }
  if (p->cords_claim.present) put_cords_json(w, &p->cords_claim);
  if (thr_wants_turning(&p->options)) put_turning_json(w, p);
  if (p->symmetry.present) put_symmetry_json(w, &p->symmetry);
  terms_put_json(w, p);
}

static void put_json(thr_text *t, const char *path, const thr_plan *p, const thr_err *err)
{
  thr_writer w = {.out = t};
  thr_write_object(&w, NULL);
  thr_write_string(&w, "plan", path);
  thr_write_bool(&w, "ok", !err->code);
  if (err->code)
    thr_write_string(&w, err->code == THR_EVIOLATED ? "violation" : "error", err->text);
  else
    put_claims_json(&w, p);
  thr_write_close(&w);
  thr_text_append(t, "\n");
}

static int check_one(const char *path, bool json)
{
  thr_plan p;
  thr_text t = {0};
  thr_err err = {0}, found = {0};
  const char *name = strcmp(path, "-") == 0 ? "stdin" : path;
  thr_status st = thr_plan_read(&p, path, &err);
  if (!st && (st = thr_check_plan(&p, &found))) thr_fail(&err, st, "%s: %s", name, found.text);
  int code = st == THR_OK ? EXIT_OK : EXIT_VIOLATION;
  if (st && st != THR_EVIOLATED) code = cli_fail(&err);
  if (json)
    put_json(&t, name, &p, &err);
  else if (code > EXIT_VIOLATION)
    ; /* said already */
  else if (st)
    cli_error("%s", err.text);
  else if (!cli_quiet)
    put_verdict(&t, name, &p);
  thr_plan_destroy(&p);
  int written = cli_write(&t, "-");
  return code ? code : written;
}

static int check_all(char **path, int n, bool json)
{
  int code = EXIT_OK;
  for (int i = 0; i < n; i++) {
    int one = check_one(path[i], json);
    if (one > code) code = one;
  }
  return code;
}

int cmd_check(int argc, char **argv)
{
  int done, o;
  bool json = false, ok = true;
  guard_limits guard = guard_limits_default();
  guard_end end;
  while ((o = cli_next_option(argc, argv, "check", ":" CLI_COMMON_LETTERS, table, help, &done)) != -1) {
    if (o == OPTION_JSON) json = true;
    if (guard_option(&guard, "check", o, optarg, &ok) && !ok) return EXIT_USAGE;
  }
  if (done >= 0) return done;
  if (optind == argc) return cli_usage("check", "which plan?");
  if (guard_fork(&guard, &end)) return guard_conclude(&end, "not verified");
  return check_all(argv + optind, argc - optind, json);
}
