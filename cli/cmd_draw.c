/* thread draw: diagrams of a plan. */
#include "cli/cli.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char help[] = "thread draw PLAN [options]: the overview picture\n\n"
                           "Examples:\n"
                           "  thread draw plan.json -o overview.svg\n"
                           "  thread draw plan.json -o diagrams/            overview.svg in that folder\n"
                           "  thread draw plan.json --color tension         after `thread eval plan.json -o plan.json`\n\n"
                           "Options:\n"
                           "  -T, --type svg       kind of diagram (default, and the only one yet)\n"
                           "      --color cord|tension what colours tell apart: cords (default), or how tight each pass is\n"
                           "      --pitch MM       millimetres on paper per bead (default: 24, less for large frameworks)\n"
                           "  -o, --output FILE|DIR   (default: overview.svg; - = stdout)       -h, --help\n";

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

int cmd_draw(int argc, char **argv)
{
  int done, option;
  double pitch = 0;
  bool tension = false;
  const char *output = "overview.svg";
  char inside[1200];
  while ((option = cli_next_option(argc, argv, "draw", ":" CLI_COMMON_LETTERS "T:o:", table, help, &done)) != -1) {
    if (option == 'T' && strcmp(optarg, "svg") != 0) return cli_usage("draw", "-T %s: this version draws svg only", optarg);
    if (option == OPTION_PITCH && !cli_double("draw", "--pitch", optarg, 2, 200, &pitch)) return EXIT_USAGE;
    if (option == OPTION_COLOR) {
      tension = strcmp(optarg, "tension") == 0;
      if (!tension && strcmp(optarg, "cord") != 0) return cli_usage("draw", "--color %s: expected cord or tension", optarg);
    }
    if (option == 'o') output = optarg;
  }
  if (done >= 0) return done;
  const char *dot = strrchr(output, '.');
  if (dot && (strcmp(dot, ".pdf") == 0 || strcmp(dot, ".png") == 0 || strcmp(dot, ".html") == 0))
    return cli_usage("draw", "%s: this version draws svg only", output);
  if (optind + 1 != argc) return cli_usage("draw", optind == argc ? "which plan?" : "one plan at a time");
  thr_plan p;
  int code = cli_read_plan(argv[optind], &p);
  if (code) return code;
  if (is_folder(output)) {
    code = cli_in_folder(output, "overview.svg", inside, sizeof inside);
    output = inside;
  }
  if (!code) code = cli_draw_overview(&p, output, pitch, tension);
  thr_plan_destroy(&p);
  return code;
}
