/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread kit: makes the pieces of a plan as solids to print, with channels where the cords go
 * (kit/kit.h).
 *
 * All files go into one folder: kit.3mf with every piece on the bed of a printer (kit-1.3mf, .. if
 * it takes several), kit.csv with what they measure, README.txt, and what else was asked for.
 *
 * Example: `thread kit plan.json -o kit/ --stl` also writes one file for each kind of piece. */
#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "graph/io/json.h"
#include "graph/os.h"
#include "kit/files.h"
#include "kit/kit.h"
#include "lib/lib.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char intro[] =
    "thread kit PLAN [options]: the pieces themselves, to print\n\n"
    "Examples:\n"
    "  thread kit plan.json                          kit/kit.3mf, README.txt, kit.csv, kit.png ..\n"
    "  thread kit plan.json --names none             pieces that are alike are one print\n"
    "  thread kit plan.json --stl -o parts/          one STL file for each kind, too\n"
    "  thread kit plan.json --width 12 --key cone    thicker arms, which centre each other\n";
static const char outro[] =
    "Exit codes: 0 made, 2 usage, 3 pieces that cannot be made, or not a plan, 5 not done in the "
    "time or memory";

/* What was asked. */
typedef struct {
  thr_kit_options kit;
  guard_limits guard;
  double key_angle; /* degrees */
  int jobs;
  bool stl, scad, no_picture, progress;
  const char *output;
} kit_arguments;

#define AT(member) .offset = offsetof(kit_arguments, member)

/* Triangles of the viewer are larger by this factor than those to print. */
static const double COARSE = 2.2;

/* Takes "220x220". */
static bool take_bed(void *into, const cli_option *option, const char *value)
{
  double *bed = ((kit_arguments *)into)->kit.bed;
  int end = 0;
  (void)option;
  if (sscanf(value, "%lfx%lf%n", &bed[0], &bed[1], &end) == 2 && !value[end] && bed[0] >= 20 &&
      bed[1] >= 20 && bed[0] <= 10000 && bed[1] <= 10000)
    return true;
  cli_usage("kit", "--bed %s: expected width x depth in mm, 20 to 10000, as 220x220", value);
  return false;
}

static const cli_option own_options[] = {
    {"output", 'o', "DIR", "folder of the files (default: kit)", .kind = CLI_OUTPUT, AT(output)},
    {"stl", .kind = CLI_FLAG, AT(stl), .help = "also one STL file for each kind of piece"},
    {"scad", .kind = CLI_FLAG, AT(scad),
     .help = "also kit.scad, the pieces in OpenSCAD's language, to be changed"},
    {"no-picture", .kind = CLI_FLAG, AT(no_picture), .help = "without kit.png and kit.html"},
    {"progress", .kind = CLI_FLAG, AT(progress),
     .help = "a line of JSON on stderr each time more of the pieces are made"},
    {"processes", 'j', "N",
     "so many things at a time (default: one per processor); changes no result", .kind = CLI_COUNT,
     AT(jobs), .low = 1, .high = 1024},
    {0}};

static const cli_option shape_options[] = {
    {"width", .value = "MM", .kind = CLI_AMOUNT, AT(kit.width), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "of arms and tubes (default: the plan's bead diameter)"},
    {"profile", .kind = CLI_WORD, AT(kit.profile), .word = thr_kit_profile_name,
     .n_words = THR_KIT_N_PROFILES, .help = "section of arms (default: round)"},
    {"taper", .value = "X", .kind = CLI_AMOUNT, AT(kit.taper), .low = 0.3, .high = 2,
     .help = "width at the node as a part of that at the face (default: 1)"},
    {"fillet", .value = "MM", .kind = CLI_AMOUNT, AT(kit.fillet), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "radius between arms (default: 0.15 of the width)"},
    {"gap", .value = "MM", .kind = CLI_AMOUNT, AT(kit.gap), .high = 1e6,
     .help = "between the faces of neighbours (default: 0)"},
    {"wall", .value = "MM", .kind = CLI_AMOUNT, AT(kit.wall), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "least thickness beside a channel (default: 1.2, or what there is room for)"},
    {"channels", .kind = CLI_WORD, AT(kit.channels), .word = thr_kit_channels_name,
     .n_words = THR_KIT_N_CHANNELS,
     .help = "one bore for all passes of an interface (default), or a lane for each: two lanes "
             "keep faces from turning on each other"},
    {"crossings", .kind = CLI_WORD, AT(kit.crossings), .word = thr_kit_crossings_name,
     .n_words = THR_KIT_N_CROSSINGS,
     .help = "channels that the plan crosses in a piece: they meet (default), or one is led above "
             "the other where walls allow; all others are led apart anyway"},
    {"key", .kind = CLI_WORD, AT(kit.key), .word = thr_kit_key_name, .n_words = THR_KIT_N_KEYS,
     .help = "what faces have to centre each other (default: none)"},
    {"key-angle", .value = "DEG", .kind = CLI_AMOUNT, AT(key_angle), .low = 2, .high = 75,
     .help = "between a key's flank and its axis: small ones hold firmly and are hard to fit "
             "(default: 45; pin: 5)"},
    {"knot-pockets", .kind = CLI_FLAG, AT(kit.knot_pockets),
     .help = "a hollow for the knot where a cord ends"},
    {"foot", .kind = CLI_WORD, AT(kit.foot), .word = thr_kit_foot_name, .n_words = THR_KIT_N_FEET,
     .help = "where a cord ends at a foot: a hole in its base (default), or a hook beside it"},
    {"names", .kind = CLI_WORD, AT(kit.names), .word = thr_kit_names_name,
     .n_words = THR_KIT_N_NAMES,
     .help = "engraved: each piece's own and, on every arm, the neighbour's (default), those of "
             "kinds, or none: then pieces that are alike are one print"},
    {"letters", .value = "MM", .kind = CLI_AMOUNT, AT(kit.letters), .low = 1, .high = 100,
     .help = "height of engraved letters (default: 4; smaller where there is no room)"},
    {"tube-ends", .kind = CLI_WORD, AT(kit.tube_ends), .word = thr_kit_tube_ends_name,
     .n_words = THR_KIT_N_TUBE_ENDS, .help = "of plans with --joint tube (default: mitred)"},
    {0}};

static const cli_option print_options[] = {
    {"bed", .value = "WxD", .kind = CLI_OTHER, .take = take_bed,
     .help = "size of the printer's bed in mm (default: 220x220)"},
    {"density", .value = "G", .kind = CLI_AMOUNT, AT(kit.density), .low = CLI_ABOVE_0, .high = 100,
     .help = "of the material in g/cm3 (default: as the plan says)"},
    {"kind-tolerance", .value = "X", .kind = CLI_AMOUNT, AT(kit.kind_tolerance), .low = 1e-9,
     .high = 1e9,
     .help = "pieces whose points differ by no more are of one kind, in units of the framework "
             "(default: a hundredth of the median edge)"},
    {0}};

/* Writes a text into the folder under a name, or the reason why there is none. what: the file is,
 * for programs. */
static int write_file(thr_status st, thr_text *text, const char *folder, const char *name,
                      const char *what, const thr_err *err)
{
  char path[1200];
  if (!st) {
    int code = cli_in_folder(folder, name, path, sizeof path);
    if (code) {
      thr_text_destroy(text);
      return code;
    }
  }
  const int code = cli_write_drawn(st, text, path, err);
  if (!code) answer_file(path, what);

  return code;
}

/* Prints what the kit is: pieces, kinds, volume, what a maker should know. */
static void say(const thr_kit *kit, const thr_kit_plates *plates, const char *folder)
{
  char volume[64], mass[64], width[THR_PLAIN_NUMBER];
  thr_text kinds = {0};

  thr_kit_kinds(kit, &kinds);
  cli_note("%d %s, %s, %s, %s at %.3g g/cm3, on %d %s", kit->n_pieces,
           thr_pieces_word(kit->plan, kit->n_pieces), kinds.failed ? "" : kinds.data,
           plain_volume(kit->volume, volume), plain_mass(kit->mass, mass), kit->options.density,
           plates->n_plates, cli_plural(plates->n_plates, "plate", "plates"));
  thr_text_destroy(&kinds);
  cli_note("arms %s mm wide, cord %.3g mm, walls %.3g mm or more",
           thr_plain_number(kit->options.width, 3, width), kit->cord, kit->options.wall);

  /* Notes are lines. */
  const char *line = kit->notes.data ? kit->notes.data : "";
  while (*line) {
    int n = (int)strcspn(line, "\n");
    cli_note("%.*s", n, line);
    line += n + (line[n] != '\0');
  }
  cli_note("written to %s", folder);
}

/* Answers programs with the same. Returns an exit code. */
static int answer(const thr_kit *kit, const thr_kit_plates *plates)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  double thinnest = INFINITY;
  for (int p = 0; p < kit->n_pieces; p++)
    thinnest = fmin(thinnest, kit->piece[p].thinnest);

  thr_write_object(&writer, NULL);
  answer_put_files(&writer);
  thr_write_int(&writer, "pieces", kit->n_pieces);
  thr_write_int(&writer, "kinds", kit->n_shapes);
  thr_write_int(&writer, "kinds_with_channels", kit->n_kinds);
  thr_write_int(&writer, "plates", plates->n_plates);
  thr_write_number(&writer, "volume_cm3", kit->volume / 1000);
  thr_write_number(&writer, "mass_g", kit->mass);
  thr_write_number(&writer, "width_mm", kit->options.width);
  thr_write_number(&writer, "cord_mm", kit->cord);
  thr_write_number(&writer, "wall_mm", kit->options.wall);
  if (isfinite(thinnest)) thr_write_number(&writer, "thinnest_mm", thinnest);
  thr_write_array(&writer, "notes");
  for (const char *line = kit->notes.data ? kit->notes.data : ""; *line;) {
    const int n = (int)strcspn(line, "\n");
    thr_text note = {0};
    thr_text_append_bytes(&note, line, (size_t)n);
    thr_write_words(&writer, NULL, &note);
    line += n + (line[n] != '\0');
  }
  thr_write_close(&writer);
  return answer_close(&writer);
}

/* Writes the viewer with the pieces as they are, but coarser and without names. */
static int write_viewer(const thr_kit *kit, const kit_arguments *args, const char *folder)
{
  thr_err err = {0};
  thr_text meshes = {0}, page = {0};
  thr_kit shown;
  thr_kit_options options = args->kit;
  options.names = THR_KIT_NO_NAMES;
  options.coarse = COARSE;
  options.to_print = false;
  thr_limits limits = cli_limits(0);
  limits.threads = args->jobs ? args->jobs : thr_os_processors();

  thr_status st = thr_kit_make(&shown, kit->plan, &options, NULL, true, &limits, &err);
  if (!st) thr_kit_viewer(&shown, NULL, &meshes);
  const thr_document_options how = {.kit = &meshes, .kind_tolerance = options.kind_tolerance};
  if (!st && meshes.failed) st = thr_fail(&err, THR_ENOMEM, "out of memory");
  if (!st) st = thr_document_make(kit->plan, thr_document_find("html"), &how, &limits, &page, &err);
  cli_progress_end();
  thr_kit_destroy(&shown);
  thr_text_destroy(&meshes);

  return write_file(st, &page, folder, "kit.html",
                    "the pieces and the cords, step by step in any browser", &err);
}

/* Writes the plates: one as kit.3mf, several as kit-1.3mf, kit-2.3mf, .., as a slicer knows one
 * bed. Returns an exit code. */
static int write_plates(const thr_kit_plates *plates, const char *folder)
{
  int code = EXIT_OK;
  for (int i = 0; i < plates->n_plates && !code; i++) {
    thr_err err = {0};
    thr_text text = {0};
    char name[32] = "kit.3mf";
    if (plates->n_plates > 1) snprintf(name, sizeof name, "kit-%d.3mf", i + 1);
    const thr_status st = thr_kit_3mf(plates, i, &text, &err);
    code = write_file(st, &text, folder, name, "the pieces on the bed of a printer", &err);
  }
  return code;
}

/* Writes everything that was asked for. Returns an exit code. */
static int write_all(const thr_kit *kit, const kit_arguments *args, const char *folder)
{
  thr_err err = {0};
  thr_text text = {0};
  thr_kit_plates plates;
  cli_step("writing the pieces", "");
  thr_status st = thr_kit_plates_make(&plates, kit, &err);
  if (st) {
    thr_kit_plates_destroy(&plates);
    return cli_fail(&err);
  }

  int code = write_plates(&plates, folder);
  if (!code) {
    const thr_kit_written written = {args->stl, args->scad, !args->no_picture};
    thr_kit_read_me(&plates, &written, &text);
    code = write_file(THR_OK, &text, folder, "README.txt", "what to print, and how", &err);
  }
  if (!code) {
    st = thr_kit_table(&plates, NULL, &text, &err);
    code = write_file(st, &text, folder, "kit.csv", "what the pieces measure", &err);
  }
  if (!code && kit->plan->options.joint != THR_JOINT_SOLID) {
    st = thr_kit_tubes_table(kit, &text, &err);
    code = write_file(st, &text, folder, "tubes.csv", "what to cut tubes to", &err);
  }
  if (!code && args->scad) {
    thr_kit_scad(kit, &text);
    code = write_file(THR_OK, &text, folder, "kit.scad", "the pieces in the language of OpenSCAD",
                      &err);
  }
  for (int p = 0; p < kit->n_pieces && !code && args->stl; p++) {
    char name[64];
    if (kit->piece[p].like != p) continue;
    thr_kit_stl_name(kit, p, name);
    thr_kit_stl(&plates, p, &text);
    code = write_file(THR_OK, &text, folder, name, "a piece of each kind", &err);
  }
  if (!code && !args->no_picture) {
    const thr_kit_view view = {0};
    st = thr_kit_picture(kit, &view, &text, &err);
    code = write_file(st, &text, folder, "kit.png",
                      "the pieces in their places, with the cords in them", &err);
  }
  if (!code && !args->no_picture) code = write_viewer(kit, args, folder);
  if (!code) say(kit, &plates, folder);
  if (!code && cli_json) code = answer(kit, &plates);
  thr_kit_plates_destroy(&plates);

  return code;
}

/* Runs `thread kit` and returns the exit code. */
int cmd_kit(int argc, char **argv)
{
  static const cli_syntax syntax = {"kit", intro, outro};
  kit_arguments asked = {.guard = guard_limits_default(), .kit.to_print = true};
  guard_end end;
  const cli_group groups[] = {{"Options", own_options, &asked},
                              {"Shape", shape_options, &asked},
                              {"Printing", print_options, &asked},
                              {NULL, guard_options, &asked.guard},
                              {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  asked.kit.key_angle = asked.key_angle * THR_PI / 180;
  const char *folder = asked.output ? asked.output : "kit";
  if (optind + 1 != argc)
    return cli_usage("kit", optind == argc ? "which plan?" : "one plan at a time");
  if (cli_given("key-angle") && asked.kit.key == THR_KIT_NO_KEY)
    return cli_usage("kit", "--key-angle: of which key? --key cone or pin");
  if (cli_given("letters") && asked.kit.names == THR_KIT_NO_NAMES)
    return cli_usage("kit", "--letters goes not with --names none");

  if (asked.progress) progress_begin();

  /* The child does all of the work. */
  if (guard_fork(&asked.guard, &end))
    return guard_conclude(&end, end.reason == GUARD_MEMORY && asked.kit.names != THR_KIT_NO_NAMES
                                    ? "no kit is made; with --names none pieces that "
                                      "are alike share a mesh"
                                    : "no kit is made");

  thr_plan plan;
  code = cli_read_plan(argv[optind], &plan);
  if (code) return code;

  thr_err err = {0};
  thr_kit kit;
  thr_limits limits = cli_limits(0);
  limits.threads = asked.jobs ? asked.jobs : thr_os_processors();
  cli_step("making the pieces", "");
  thr_status st = thr_kit_make(&kit, &plan, &asked.kit, NULL, true, &limits, &err);
  cli_progress_end();
  code = st ? cli_fail(&err) : write_all(&kit, &asked, folder);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&plan);

  return code;
}
