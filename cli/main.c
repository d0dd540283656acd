/* thread: plans how cord is threaded through bead structures. This file only finds the subcommand. */
#include "cli/cli.h"
#include "cli/guard.h"
#include "eval/joint/world.h"
#include "graph/framework/cuttree.h"
#include "lp/solver/lp.h"
#include "symmetry/group/automorphisms.h"

#include <stdio.h>
#include <string.h>

static const struct {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} command[] = {
    {"plan", "find the best threading of a framework, prove it, draw it", cmd_plan},
    {"advise", "how many cords, and from where, so that a hand can pull them", cmd_advise},
    {"symmetries", "groups of symmetries, and the best symmetric threading under each", cmd_symmetries},
    {"check", "verify every claim of a plan, without any solver", cmd_check},
    {"eval", "how hard to pull: closed form, simulated joints, whole structure", cmd_eval},
    {"compare", "plans side by side, ranked by pull", cmd_compare},
    {"draw", "diagrams for the hand", cmd_draw},
    {"info", "what a framework is made of", cmd_info},
    {"convert", "a framework in another format", cmd_convert},
    {"make", "example frameworks", cmd_make},
};
enum { N_COMMANDS = sizeof command / sizeof *command };

static void help(FILE *to)
{
  fputs("thread plans how cord is threaded through bead structures.\n\n"
        "Examples:\n"
        "  thread make dome --size 7 -o dome.json        a 7 x 7 dome to try things on\n"
        "  thread plan dome.json                         shortest cord: plan and diagrams in dome/\n"
        "  thread check dome/plan.json                   verify the plan and its proof\n"
        "  thread eval dome/plan.json --method joint     how hard to pull, measured in simulation\n\n"
        "Commands:\n",
        to);
  for (int i = 0; i < N_COMMANDS; i++)
    fprintf(to, "  %-10s %s\n", command[i].name, command[i].summary);
  fputs("\n`thread COMMAND --help` says more; `man thread` says all.\n", to);
}

static int version(void)
{
  int bullet = thr_bullet_version();
  printf("thread %s (GLPK %s, igraph %s, nauty %s, Bullet %d.%d)\n", THR_VERSION, thr_glpk_version(), thr_igraph_version(),
         thr_nauty_version(), bullet / 100, bullet % 100);
  return EXIT_OK;
}

static int dispatch(int argc, char **argv)
{
  if (argc < 2) {
    help(stderr);
    return EXIT_USAGE;
  }
  const char *name = argv[1];
  if (strcmp(name, "--version") == 0) return version();
  if (strcmp(name, "help") == 0 && argc > 2) { /* `thread help plan` */
    argv[1] = argv[2];
    argv[2] = (char[]){"--help"};
    argc = 3;
    name = argv[1];
  }
  if (strcmp(name, "-h") == 0 || strcmp(name, "--help") == 0 || strcmp(name, "help") == 0) {
    help(stdout);
    return EXIT_OK;
  }
  for (int i = 0; i < N_COMMANDS; i++)
    if (strcmp(name, command[i].name) == 0) return command[i].run(argc - 1, argv + 1);
  cli_error("there is no command %s; `thread --help` lists them", name);
  return EXIT_USAGE;
}

int main(int argc, char **argv)
{
  int code = dispatch(argc, argv);
  bool written = fflush(stdout) == 0 && !ferror(stdout);
  if (!code && !written) {
    cli_error("cannot write to stdout");
    code = EXIT_INPUT;
  }
  guard_ending(code);
  return code;
}
