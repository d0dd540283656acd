/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares out the least length with tube joints among one cord or several, of limited or even
 * lengths.
 *
 * The shortest tied passes (tortuosity/tie/tube.c) are cut into cords at no cost where cords may
 * end; exchanges that leave every node tied then even the cords out. Closed cords are split from
 * one (lp/length/decomposition_tied.c). For a limit on the length, more and more cords are tried.
 *
 * Example: for cords of at most 5 m and 12 m of tied passes, three cords are tried first. */
#include "tortuosity/tie/tie.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <string.h>

/* The walks, and what searches for shorter ones may still take. */
typedef struct {
  thr_decomposition decomposition;
  const thr_tube *shortest; /* of any number of cords that the options allow; closed: one */
  double work; /* that searches for short cords may still do: about a second of linear programmes */
} tied_cords;

static bool closed_cords(const tied_cords *cords)
{
  return cords->decomposition.o->ends == THR_ENDS_CLOSED;
}

/* ---- a number of cords ---- */

/* Makes the cords the walks, and counts their passes. */
static thr_status take_cords(tied_cords *cords, const thr_tube *tube, thr_err *err)
{
  thr_status st = THR_OK;
  thr_walks_destroy(&cords->decomposition.walks);
  for (int i = 0; i < tube->n_cords && !st; i++)
    st = thr_walks_copy(&cords->decomposition.walks, cords->decomposition.f, tube->cord[i].half,
                        tube->cord[i].n_passes, closed_cords(cords), err);

  memset(cords->decomposition.passes, 0,
         (size_t)cords->decomposition.f->n_edges * sizeof *cords->decomposition.passes);
  thr_walks_count(&cords->decomposition.walks, cords->decomposition.passes);
  return st;
}

/* Makes short walks: exactly n open ones, or as many as the counts say; of closed ones, one. */
static thr_status short_walks(tied_cords *cords, int n, thr_err *err)
{
  thr_request options = *cords->decomposition.o;
  const thr_limits some = thr_limits_counted(cords->decomposition.limits, &cords->work);
  thr_tube tube = {0};
  thr_err why = {0};

  if (closed_cords(cords) || options.ends == THR_ENDS_COUNTS || cords->shortest->n_cords == n)
    return take_cords(cords, cords->shortest, err);

  /* While work is left the shortest cords of this number are searched; then any are taken. */
  options.cords = options.cords_least = n;
  thr_status st = cords->work > 0
                      ? thr_tube_shortest(cords->decomposition.f, &options, &some, &tube, &why)
                      : thr_tube_some(cords->decomposition.f, &options, cords->decomposition.limits,
                                      &tube, &why);

  if (st == THR_OK || st == THR_ELIMIT)
    st = take_cords(cords, &tube, err);
  else
    st = thr_fail(err, st, "%s", why.text);
  thr_tube_destroy(&tube);
  return st;
}

/* Makes n closed walks from few. *found false: not so many; certain: there are none. */
static thr_status split(tied_cords *cords, int n, bool even, bool *found, bool *certain,
                        thr_err *err)
{
  double least = cords->shortest->length * (1 + 1e-12);
  *certain = false;

  /* A search first; the table where the search found too few walks, or longer ones. */
  thr_status st = thr_decomposition_tied(&cords->decomposition, n, even, found, err);
  if (st || (*found && (even || thr_walks_length(&cords->decomposition.walks) <= least))) return st;

  st = thr_decomposition_table(&cords->decomposition,
                               &(thr_decomposition_ask){n, n, false, INFINITY}, certain, err);
  *found = cords->decomposition.walks.n_walks >= n;
  if (!even) cords->decomposition.least &= *certain;
  return st;
}

/* Makes n walks from short ones, and evens them out if asked to. */
static thr_status make_walks(tied_cords *cords, int n, bool even, double goal, bool *found,
                             bool *certain, thr_err *err)
{
  thr_status st = THR_OK;
  *found = true;
  *certain = false;

  if (closed_cords(cords)) st = split(cords, n, even, found, certain, err);
  return !st && even && *found ? thr_decomposition_even(&cords->decomposition, goal, err) : st;
}

/* Makes n walks, or says why there are none. */
static thr_status make_number(tied_cords *cords, int n, bool even, thr_err *err)
{
  bool found = false, certain = false;
  thr_status st = short_walks(cords, n, err);
  if (!st) st = make_walks(cords, n, even, 0, &found, &certain, err);

  if (st || found) return st;
  return thr_fail(err, certain ? THR_EINFEASIBLE : THR_ELIMIT,
                  "the component with node %s: %s %d closed cords that tie its joints",
                  cords->decomposition.f->name[0], certain ? "there are no" : "did not find", n);
}

/* Evens out as many cords as the shortest are, which is a number that can be tied. */
static thr_status even_shortest(tied_cords *cords, thr_err *err)
{
  bool found, certain;
  thr_status st = take_cords(cords, cords->shortest, err);
  return st ? st
            : make_walks(cords, cords->decomposition.walks.n_walks, true, 0, &found, &certain, err);
}

/* Makes cords of even lengths: as many as can be tied, from the largest number down, which is
 * halved while it is large. */
static thr_status make_even(tied_cords *cords, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int least = cords->decomposition.o->cords_least;
  thr_err why = {0};
  bool none = true;
  thr_status st = THR_OK;

  /* From the largest number of cords down. */
  for (int n = cords->decomposition.o->cords; n >= least && none;
       n = n > 2 * least && n > IN_SINGLE_STEPS ? n / 2 : n - 1) {
    why = (thr_err){0};
    cords->decomposition.least = cords->decomposition.certain = true;
    st = make_number(cords, n, true, &why);
    none = st == THR_EINFEASIBLE || st == THR_ELIMIT;
  }

  /* At last the number of the shortest cords, which is known to be possible. */
  if (none && !closed_cords(cords)) st = even_shortest(cords, &why);
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- no cord longer than a limit ---- */

/* Tries n cords, unless even the shortest are too long together. Where there are none the walks
 * stay as they were. */
static thr_status try_number(thr_decomposition *decomposition, void *of, int n, bool *done,
                             thr_err *err)
{
  tied_cords *cords = of;
  bool found = false, certain;
  thr_err why = {0};

  /* Keep the walks at hand, in case that no better ones are found. */
  thr_walks before = decomposition->walks;
  decomposition->walks = (thr_walks){0};

  thr_status st = short_walks(cords, n, &why);
  bool none = st == THR_EINFEASIBLE;
  if (!st && thr_walks_length(&decomposition->walks) <=
                 fmax(n, decomposition->walks.n_walks) * decomposition->o->max_length * (1 + 1e-9))
    st = make_walks(cords, n, true, decomposition->o->max_length, &found, &certain, &why);

  /* Put them back. */
  if (st || !found) {
    thr_walks new = decomposition->walks;
    decomposition->walks = before;
    before = new;
  } else
    *done = thr_decomposition_within(thr_walks_most(&decomposition->walks),
                                     decomposition->o->max_length);

  thr_walks_destroy(&before);
  return st && !none ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Says why no cords within the limit were found, from the strongest reason to the weakest. */
static thr_status none_found(const tied_cords *cords, thr_err *err)
{
  const char *units = cords->decomposition.f->units, *name = cords->decomposition.f->name[0];
  double limit = cords->decomposition.o->max_length;

  bool proved = cords->shortest->bound > cords->decomposition.o->cords * limit * (1 + 1e-9) ||
                cords->decomposition.none;

  if (proved)
    return thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s: of up to %d cords that tie its joints one is "
                    "longer than %g %s; together they need %g %s",
                    name, cords->decomposition.o->cords, limit, units, cords->shortest->bound,
                    units);

  if (cords->decomposition.walks.n_walks == 0)

    return thr_fail(err, THR_ELIMIT,
                    "the component with node %s: did not find up to %d cords that tie its joints, "
                    "none longer than %g %s; together "
                    "they need %g %s",
                    name, cords->decomposition.o->cords, limit, units, cords->shortest->length,
                    units);
  return thr_fail(err, THR_ELIMIT,
                  "the component with node %s: did not find up to %d cords that tie its joints, "
                  "none longer than %g %s, but one of %g "
                  "%s",
                  name, cords->decomposition.o->cords, limit, units,
                  thr_walks_most(&cords->decomposition.walks), units);
}

/* Searches the fewest cords within the limit, from the number that the shortest length leaves
 * possible on. */
static thr_status grow(tied_cords *cords, thr_err *err)
{
  bool done = false;
  thr_status st =
      thr_cords_grow(&cords->decomposition, cords->shortest->bound, try_number, cords, &done, err);
  return !st && !done ? none_found(cords, err) : st;
}

/* ---- the plan ---- */

/* Returns whether more is asked for than the shortest length. */
static bool lengths_asked(const thr_request *options)
{
  return thr_wants_balance(options) || options->max_length > 0;
}

bool thr_tube_shares(const thr_request *options)
{
  return lengths_asked(options) || (options->ends == THR_ENDS_CLOSED && options->cords_least > 1);
}

/* Moves the shortest cords into the plan. */
static void move_cords(thr_tube *tube, thr_plan *plan)
{
  plan->cord = tube->cord;
  plan->n_cords = tube->n_cords;
  tube->cord = NULL;
  tube->n_cords = 0;
}

/* Makes the cords that the options ask for. */
static thr_status make_some(tied_cords *cords, thr_plan *plan, thr_err *err)
{
  const thr_request *options = cords->decomposition.o;
  thr_status st = options->max_length > 0 ? grow(cords, err)
                  : thr_wants_balance(options)
                      ? make_even(cords, err)
                      : make_number(cords, options->cords_least, false, err);
  return st ? st
            : thr_walks_cords(&cords->decomposition.walks, &plan->frame, options, &plan->cord,
                              &plan->n_cords, err);
}

thr_status thr_tube_cords(thr_tube *tube, const thr_limits *limits, thr_plan *plan,
                          thr_cords_word *word, thr_err *err)
{
  const thr_request *options = &plan->options;
  tied_cords cords = {.shortest = tube, .work = 1};
  *word = (thr_cords_word){0};

  /* The shortest cords are what is asked for. */
  if (!thr_tube_shares(options)) {
    move_cords(tube, plan);
    return THR_OK;
  }

  /* Otherwise the lengths are shared out anew. */
  thr_status st = thr_decomposition_init(&cords.decomposition, &plan->frame, options, limits, err);
  if (!st) st = make_some(&cords, plan, err);
  if (!st)
    *word = (thr_cords_word){cords.decomposition.least && !lengths_asked(options),
                             cords.decomposition.certain && thr_wants_balance(options)};

  thr_decomposition_destroy(&cords.decomposition);
  return st;
}
