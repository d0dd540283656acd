/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread: plans how cord is threaded through bead structures.
 *
 * This file finds the subcommand, which does everything else (cli/commands/), and makes sure at the
 * end that all of stdout was written. */
#include "cli/args/args.h"
#include "cli/cli.h"
#include "eval/joint/world.h"
#include "lp/solver/solver.h"
#include "symmetry/group/group.h"

#include <stdio.h>
#include <string.h>

/* The table of commands, from which help and completions are made. */
const cli_command cli_commands[] = {
    {"plan", "find the best threading of a framework, prove it, draw it", cmd_plan},
    {"advise", "how many cords, and from where, so that a hand can pull them", cmd_advise},
    {"symmetries", "groups of symmetries, and the best symmetric threading under each",
     cmd_symmetries},
    {"check", "verify every claim of a plan, without any solver", cmd_check},
    {"eval", "how hard to pull: closed form, simulated joints, whole structure", cmd_eval},
    {"compare", "plans side by side, ranked by pull", cmd_compare},
    {"draw", "diagrams for the hand", cmd_draw},
    {"kit", "the pieces themselves, to print", cmd_kit},
    {"rise", "watch it rise: loose pieces, pulled cords, in simulation", cmd_rise},
    {"info", "what a framework is made of", cmd_info},
    {"convert", "a framework in another format", cmd_convert},
    {"make", "example frameworks", cmd_make},
};
const int cli_n_commands = sizeof cli_commands / sizeof *cli_commands;

/* Prints the help of the program. */
static void help(FILE *to)
{
  fputs(
      "thread plans how cord is threaded through bead structures.\n\n"
      "Examples:\n"
      "  thread make dome --size 7 -o dome.json        a 7 x 7 dome to try things on\n"
      "  thread plan dome.json                         as few cords as a hand can pull: plan, "
      "pictures\n"
      "  thread check dome/plan.json                   verify the plan and its proof\n"
      "  thread eval dome/plan.json --method joint     how hard to pull, measured in simulation\n\n"
      "Commands:\n",
      to);

  /* Commands with their summaries. */
  for (int i = 0; i < cli_n_commands; i++)
    fprintf(to, "  %-10s %s\n", cli_commands[i].name, cli_commands[i].summary);
  fputs("\nOptions of every command: -h, --help; -q, --quiet; -v, --verbose; --json: for programs; "
        "--config FILE: options from a file.\n"
        "`thread help COMMAND` and `man thread-COMMAND` say more, `thread help exit-codes` what "
        "exit codes mean; `man thread` says all.\n",
        to);
}

/* Prints the help of the program, or for programs what commands there are. Returns the exit code.
 */
static int answer_help(void)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  if (!cli_json) {
    help(stdout);
    return EXIT_OK;
  }

  thr_write_object(&writer, NULL);
  for (int i = 0; i < cli_n_commands; i++)
    thr_write_string(&writer, cli_commands[i].name, cli_commands[i].summary);
  return answer_close(&writer);
}

/* Prints the version, the licence and the versions of the libraries. */
static int version(void)
{
  int bullet = thr_bullet_version();
  char simulation[24];
  snprintf(simulation, sizeof simulation, "%d.%d", bullet / 100, bullet % 100);

  if (cli_json) {
    thr_text text = {0};
    thr_writer writer = {.out = &text};
    thr_write_object(&writer, NULL);
    thr_write_string(&writer, "thread", THR_VERSION);
    thr_write_string(&writer, "glpk", thr_glpk_version());
    thr_write_string(&writer, "igraph", thr_igraph_version());
    thr_write_string(&writer, "nauty", thr_nauty_version());
    thr_write_string(&writer, "bullet", simulation);
    return answer_close(&writer);
  }

  /* Results may depend on the versions of these libraries. */
  printf("thread %s\n"
         "License GPLv3+: GNU GPL version 3 or later <https://gnu.org/licenses/gpl.html>\n"
         "This is free software: you are free to change and redistribute it. There is NO WARRANTY, "
         "to the extent permitted by law.\n"
         "With GLPK %s, igraph %s, nauty %s, Bullet %s.\n",
         THR_VERSION, thr_glpk_version(), thr_igraph_version(), thr_nauty_version(), simulation);

  return EXIT_OK;
}

/* Runs a command, with the options of --config before those of the command line. */
static int run_command(const cli_command *command, int argc, char **argv)
{
  int code = cli_config(&argc, &argv);
  return code ? code : command->run(argc - 1, argv + 1);
}

/* Prints that there is no such command, and which one may be meant. Returns the exit code. */
static int report_unknown(const char *name)
{
  char question[THR_SUGGESTION_TEXT];
  thr_suggestion suggestion = {.word = name};

  for (int i = 0; i < cli_n_commands; i++)
    thr_suggestion_try(&suggestion, cli_commands[i].name);

  /* The name that comes nearest is asked for. */
  thr_suggestion_ask(&suggestion, question);

  cli_error("there is no command %s%s%s `thread --help` lists them", name, question,
            *question ? "" : ";");

  return EXIT_USAGE;
}

/* Returns whether a word is in a list that ends with NULL. */
static bool is_one_of(const char *word, const char *const *list)
{
  while (*list && strcmp(word, *list) != 0)
    list++;
  return *list != NULL;
}

/* Finds the command and runs it. Returns its exit code. */
static int dispatch(int argc, char **argv)
{
  static char show[] = "--help";

  if (argc < 2) {
    help(stderr);
    return EXIT_USAGE;
  }

  /* What is no command in the list: version, completions, help. */
  const char *name = argv[1];
  if (strcmp(name, "complete") == 0) return cmd_complete(argc - 1, argv + 1);
  for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
    cli_json = cli_json || strcmp(argv[i], "--json") == 0; /* for errors before it is parsed */
  if (is_one_of(name, (const char *const[]){"version", "--version", "-V", "-v", NULL}))
    return version();

  if (strcmp(name, "help") == 0 && argc > 2 && strcmp(argv[2], "exit-codes") == 0)
    return answer_exit_codes();

  /* `thread help plan` is `thread plan --help`. */
  if (strcmp(name, "help") == 0 && argc > 2 && *argv[2] != '-') {
    argv[1] = argv[2];
    argv[2] = show;
    argc = 3;
    name = argv[1];
  }

  if (is_one_of(name, (const char *const[]){"help", "--help", "-h", NULL})) return answer_help();

  /* A command of the list. */
  for (int i = 0; i < cli_n_commands; i++)
    if (strcmp(name, cli_commands[i].name) == 0) return run_command(&cli_commands[i], argc, argv);

  return report_unknown(name);
}

int main(int argc, char **argv)
{
  int code = dispatch(argc, argv);
  cli_progress_end();

  /* A full disk shows only now. */
  bool written = fflush(stdout) == 0 && !ferror(stdout);

  if (!code && !written) {
    cli_error("cannot write to stdout");
    code = EXIT_INPUT;
  }

  /* Folders that stayed empty go, and the parent hears that this is the end. Whoever has no parent
   * answers programs. */
  files_tidy();
  answer_tidy();
  if (!guard_ending(code, answer_error())) answer_failure(code);

  return code;
}
