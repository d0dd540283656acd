/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options of what acts on the structure beside weight and cords: loads, a tilted ground, held feet.
 */
#ifndef THR_LOAD_ARGS_H
#define THR_LOAD_ARGS_H

#include "cli/cli.h"
#include "eval/eval.h"
#include "graph/framework/frame.h"

enum {
  OPTION_LOAD = 950,
  OPTION_LOAD_PULLS,
  OPTION_TILT,
  OPTION_CLAMP,
  OPTION_RAYS,
  OPTION_TAUT
}; /* beyond the options that commands number on */
#define LOAD_OPTIONS                                                                               \
  {"load", required_argument, NULL, OPTION_LOAD},                                                  \
      {"load-pulls", required_argument, NULL, OPTION_LOAD_PULLS},                                  \
      {"tilt", required_argument, NULL, OPTION_TILT},                                              \
      {"rays", required_argument, NULL, OPTION_RAYS}, {"taut", no_argument, NULL, OPTION_TAUT},    \
  {                                                                                                \
    "clamp-feet", no_argument, NULL, OPTION_CLAMP                                                  \
  }
#define LOAD_HELP                                                                                  \
  "      --load NODE=N    structure: newtons that hang on a node, or NODE=FX,FY,FZ; several with " \
  "semicolons: what pull\n"                                                                        \
  "                       they need, how many times so much is carried at some pulls, and what "   \
  "moves first;\n"                                                                                 \
  "                       NODE=0,0,N lifts, like a hand or a counterweight: the pull that is "     \
  "then needed\n"                                                                                  \
  "      --load-pulls LIST   at these pulls of all ends, newtons with commas (default: "           \
  "1,2,5,10,20,50; above 100 pieces "                                                              \
  "10,50)\n"                                                                                       \
  "      --tilt DEG       structure: the ground leans by so many degrees towards x, or "           \
  "DEG,AZIMUTH (from x to y)\n"                                                                    \
  "      --clamp-feet     structure: feet are held in place; else they stand on the ground\n"      \
  "      --taut           structure: turns are those of the tight cord in its bores, as --method " \
  "joint finds them, not those\n"                                                                  \
  "                       of the middles of the bores: it needs less while it is drawn in, and "   \
  "keeps less\n"                                                                                   \
  "      --rays N         structure: rays of the pyramids that stand for friction cones, 8 to 48 " \
  "(default: 8, and\n"                                                                             \
  "                       beyond 1,000 pieces the cones themselves; 24: the bounds are ten times " \
  "closer, and take\n"                                                                             \
  "                       some three times as long)\n"

enum { LOAD_MOST_PULLS = 32 };

typedef struct {
  const char *command; /* for messages */
  const char *load;    /* as given; NULL = none */
  double pulls[LOAD_MOST_PULLS], tilt, azimuth;
  int n_pulls, rays;
  bool clamped, taut;
} load_args;

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad
 * (printed). */
bool load_option(load_args *a, const char *command, int option, const char *value, bool *ok);
/* Does anything act on the structure beside weight and cords? */
bool load_any(const load_args *a);
/* Sets options; *load receives [n_nodes] that the caller frees. EXIT_OK, or prints and returns the
 * code. */
int load_apply(const load_args *a, const thr_frame *frame, thr_eval_options *options,
               double (**load)[3]);

#endif
