/* thread draw: diagrams of a plan. */
#include "cli/cli.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char help[] = "thread draw PLAN [options]: the overview picture, or the steps in words\n\n"
                           "Examples:\n"
                           "  thread draw plan.json -o overview.svg\n"
                           "  thread draw plan.json -o diagrams/            overview.svg in that folder\n"
                           "  thread draw plan.json -T steps                steps.txt: row by row, to be ticked off\n"
                           "  thread draw plan.json --color tension         after `thread eval plan.json -o plan.json`\n"
                           "  thread draw plan.json --color turning         the sharper a turn the darker\n\n"
                           "Options:\n"
                           "  -T, --type svg|steps   the overview (default), or text: each path to learn once, then its copies\n"
                           "      --color cord|tension|turning   what colours tell apart: cords (default), how tight each\n"
                           "                       pass is, or how sharply the cord turns between two beads\n"
                           "      --pitch MM       millimetres on paper per bead (default: 24, less for large frameworks)\n"
                           "  -o, --output FILE|DIR   (default: overview.svg or steps.txt; - = stdout)   -h, --help\n";

enum { OPTION_PITCH = OPTION_FREE, OPTION_COLOR };
static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      {"type", required_argument, NULL, 'T'},
                                      {"pitch", required_argument, NULL, OPTION_PITCH},
                                      {"color", required_argument, NULL, OPTION_COLOR},
                                      {"output", required_argument, NULL, 'o'},
                                      {NULL, 0, NULL, 0}};

static bool is_folder(const char *path)
{
  struct stat s;
  size_t n = strlen(path);
  return (n && path[n - 1] == '/') || (stat(path, &s) == 0 && S_ISDIR(s.st_mode));
}

static const char *color_name(int c)
{
  return thr_overview_colour_name((thr_overview_colour)c);
}

typedef enum { TYPE_SVG, TYPE_STEPS, N_TYPES } diagram_type;

static const char *type_name(int t)
{
  static const char *const name[] = {"svg", "steps"};
  return name[t];
}

int cmd_draw(int argc, char **argv)
{
  int done, option;
  double pitch = 0;
  int color = THR_COLOUR_CORD, type = TYPE_SVG;
  const char *output = NULL;
  char inside[1200];
  while ((option = cli_next_option(argc, argv, "draw", ":" CLI_COMMON_LETTERS "T:o:", table, help, &done)) != -1) {
    if (option == 'T' && !cli_choose("draw", "--type", optarg, type_name, N_TYPES, &type)) return EXIT_USAGE;
    if (option == OPTION_PITCH && !cli_double("draw", "--pitch", optarg, 2, 200, &pitch)) return EXIT_USAGE;
    if (option == OPTION_COLOR && !cli_choose("draw", "--color", optarg, color_name, THR_N_COLOURS, &color)) return EXIT_USAGE;
    if (option == 'o') output = optarg;
  }
  if (done >= 0) return done;
  const char *usual = type == TYPE_STEPS ? "steps.txt" : "overview.svg";
  if (!output) output = usual;
  const char *dot = strrchr(output, '.');
  if (dot && (strcmp(dot, ".pdf") == 0 || strcmp(dot, ".png") == 0 || strcmp(dot, ".html") == 0))
    return cli_usage("draw", "%s: this version draws svg and text only", output);
  if (optind + 1 != argc) return cli_usage("draw", optind == argc ? "which plan?" : "one plan at a time");
  thr_plan p;
  int code = cli_read_plan(argv[optind], &p);
  if (code) return code;
  if (is_folder(output)) {
    code = cli_in_folder(output, usual, inside, sizeof inside);
    output = inside;
  }
  if (!code)
    code = type == TYPE_STEPS ? cli_draw_steps(&p, output) : cli_draw_overview(&p, output, pitch, (thr_overview_colour)color);
  thr_plan_destroy(&p);
  return code;
}
