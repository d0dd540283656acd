#include "cli/print/terms.h"
#include "cli/cli.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/request.h"

#include <ctype.h>
#include <string.h>

static int components_of(const thr_plan *p)
{
  int last = 0;
  for (int i = 0; i < p->n_cords; i++)
    if (p->cord[i].component > last) last = p->cord[i].component;
  return last + 1;
}

/* Nodes where cords may end. */
static int end_nodes(const thr_plan *p)
{
  int n = 0;
  for (int v = 0; v < p->frame.n_nodes; v++)
    n += thr_plan_end_allowed(&p->frame, &p->options, v);
  return n;
}

static void put_ends(thr_text *t, const thr_plan *p)
{
  int n = end_nodes(p);
  switch (p->options.ends) {
  case THR_ENDS_CLOSED: thr_text_append(t, "closed cords"); break;
  case THR_ENDS_ANY: thr_text_append(t, "cord ends at any node"); break;
  case THR_ENDS_FEET: thr_text_printf(t, "cord ends at the %d %s", n, cli_plural(n, "foot", "feet")); break;
  case THR_ENDS_NODES: thr_text_printf(t, "cord ends at %d given %s", n, cli_plural(n, "node", "nodes")); break;
  default: thr_text_printf(t, "given numbers of cord ends at %d %s", n, cli_plural(n, "node", "nodes"));
  }
}

static void put_passes(thr_text *t, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  thr_text_printf(t, "; %d %s of every edge or more", o->cover, cli_plural(o->cover, "pass", "passes"));
  if (p->frame.cover) thr_text_append(t, ", as the framework says");
  if (o->capacity) thr_text_printf(t, ", at most %d", o->capacity);
  if (p->frame.capacity)
    thr_text_append(t, o->capacity ? " or what the framework allows" : ", at most what the framework allows");
}

static void put_number(thr_text *t, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  int components = components_of(p), least = thr_plan_cords_least(o);
  if (o->ends == THR_ENDS_COUNTS)
    thr_text_printf(t, "; %d %s", p->n_cords, cli_plural(p->n_cords, "cord", "cords"));
  else if (least < o->cords)
    thr_text_printf(t, "; %d to %d cords", least, o->cords);
  else
    thr_text_printf(t, "; %d %s", o->cords, cli_plural(o->cords, "cord", "cords"));
  if (components > 1 && o->ends != THR_ENDS_COUNTS) thr_text_printf(t, " in each of %d components", components);
  if (o->max_length > 0) thr_text_printf(t, ", none longer than %.12g %s", o->max_length, p->frame.units);
}

/* Of what turning is proved. */
static void put_kind(thr_text *t, const thr_plan *p)
{
  if (!p->turning.present) return;
  thr_text_printf(t, "; for the turning: at most %d passes of an edge, back only at nodes with one edge", p->turning.most_passes);
  if (p->turning.length_limit >= 0) thr_text_printf(t, ", at most %.6f %s", p->turning.length_limit, p->frame.units);
}

static void put_plans(thr_text *t, const thr_plan *p)
{
  put_ends(t, p);
  put_passes(t, p);
  put_number(t, p);
  thr_text_append(t, p->options.joint == THR_JOINT_TUBE ? "; tube joints" : "; solid joints");
  if (p->frame.own_lengths) thr_text_append(t, "; lengths of edges as given, not from their nodes");
  put_kind(t, p);
}

static bool slack_asked(const thr_plan *p)
{
  return thr_wants_turning(&p->options) && p->options.turning.length_slack >= 0;
}

static bool slack_proved(const thr_plan *p)
{
  return p->proof.present && !p->proof.slack_open;
}

static bool measured(const thr_plan *p)
{
  return p->evaluation.present && p->evaluation.method != THR_CAPSTAN;
}

/* Was a row of a table asked for, which says nothing without the table? */
static bool row_asked(const thr_plan *p)
{
  return thr_wants_symmetry(&p->options) && isdigit((unsigned char)p->options.symmetry.group[0]);
}

void terms_put(thr_text *t, const thr_plan *p)
{
  thr_text_append(t, "  terms: ");
  put_plans(t, p);
  thr_text_append(t, "\n");
  if (slack_asked(p))
    thr_text_printf(t, "  cord at most %g %% above the least length: %s\n", 100 * p->options.turning.length_slack,
                    slack_proved(p) ? "verified" : "not verified");
  if (row_asked(p))
    thr_text_printf(t, "  not verified: that the group is row %s of a table of symmetries\n", p->options.symmetry.group);
  if (measured(p))
    thr_text_printf(t, "  not verified: the tensions, which method %s measured; what follows from them is\n",
                    thr_method_name(p->evaluation.method));
}

void terms_put_json(thr_writer *w, const thr_plan *p)
{
  thr_text words = {0};
  put_plans(&words, p);
  thr_write_words(w, "terms", &words);
  if (slack_asked(p)) {
    thr_write_printf(w, "length_slack", "%.12g", p->options.turning.length_slack);
    thr_write_bool(w, "slack_verified", slack_proved(p));
  }
  if (p->evaluation.present) thr_write_bool(w, "tensions_verified", !measured(p));
}
