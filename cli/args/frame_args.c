/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the options that say how a framework is read (graph/io/read.h), for every command that
 * takes one.
 *
 * Example: `--scale 1000 --up y` reads a model in metres whose y axis points up as one in mm whose
 * z axis does. */
#include "cli/args/args.h"
#include "graph/number.h"
#include "graph/io/read.h"
#include "graph/status.h"

#include <string.h>

#define AT(member) .offset = offsetof(cli_frame_args, member)

cli_frame_args cli_frame_args_default(void)
{
  return (cli_frame_args){thr_read_options_default(), NULL};
}

/* Reads the value of --units. */
static bool take_units(void *into, const cli_option *option, const char *value)
{
  cli_frame_args *args = into;
  thr_err why = {0};
  (void)option;
  if (!thr_units_find(value, &args->read.units, &why)) return true;
  cli_usage(cli_command_name(), "--units: %s", why.text);
  return false;
}

/* Reads the value of --flat; degrees become rad. */
static bool take_flat(void *into, const cli_option *option, const char *value)
{
  cli_frame_args *args = into;
  const double least = 1e-6, most = 179; /* degrees */
  (void)option;
  if (!cli_quantity(cli_command_name(), "--flat", value, "deg", least, most, &args->read.flat))
    return false;
  args->read.flat *= THR_PI / 180;
  return true;
}

/* Reads the value of --columns: two names or numbers with a comma between them. */
static bool take_columns(void *into, const cli_option *option, const char *value)
{
  cli_frame_args *args = into;
  const char *comma = strchr(value, ',');
  (void)option;

  /* There must be one comma, and something on both sides. */
  args->read.columns = value;
  if (comma && comma != value && comma[1] && !strchr(comma + 1, ',')) return true;

  cli_usage(cli_command_name(),
            "--columns %s: expected two columns with a comma between them, like start,end or 2,3",
            value);

  return false;
}

/* Returns the words of --parallel, a choice between two. */
static const char *parallel_name(int choice)
{
  return choice ? "keep" : "shortest";
}

/* Returns the words of --layers, a choice between two. */
static const char *layers_name(int all)
{
  return all ? "all" : "shown";
}

/* Reads the value of --layers or --parallel: the second word sets the flag. */
static bool take_choice(void *into, const cli_option *option, const char *value)
{
  cli_frame_args *args = into;
  bool *yes = option->word == layers_name ? &args->read.all_layers : &args->read.parallel;
  int i;

  /* Both options share this parser; their words tell which one is read. */
  if (!cli_choose(cli_command_name(), option->word == layers_name ? "--layers" : "--parallel",
                  value, option->word, option->n_words, &i))
    return false;

  *yes = i == 1;

  return true;
}

const cli_option cli_frame_options[] = {
    {"feet", .value = "lowest|rim|below=Z|FILE|NAME,..", .kind = CLI_TEXT, AT(feet),
     .help =
         "where cord ends may come out: at the lowest nodes, all along the borders of a shell, "
         "arches in the air too, up to the height Z (200mm), or at these nodes (default: as the "
         "file says)"},
    {"edges", .value = "FILE", .kind = CLI_TEXT, AT(read.edges_path),
     .help = "tables in two files: FRAME holds the nodes, FILE the edges"},
    {"weld", .value = "TOL", .kind = CLI_AMOUNT, AT(read.weld), .high = 1e300,
     .help = "merge nodes closer than TOL (default: 1e-6 of the bounding box)"},
    {"units", .value = "NAME", .kind = CLI_OTHER, .take = take_units,
     .help = "what one unit of the coordinates is called (default: as the file says, or mm)"},
    {"scale", .value = "X", .kind = CLI_AMOUNT, AT(read.scale), .low = 1e-9, .high = 1e9,
     .help = "coordinates times X: 1000 for a file in metres whose dome is built in mm"},
    {"up", .value = "y|z", .kind = CLI_WORD, AT(read.up), .word = thr_up_name,
     .n_words = THR_UP_Z + 1,
     .help = "which coordinate points up (default: z, but y in OBJ files by Blender)"},
    {"flat", .value = "DEG", .kind = CLI_OTHER, .take = take_flat,
     .help = "meshes: no edge between triangles that meet at less than DEG degrees"},
    {"columns", .value = "A,B", .kind = CLI_OTHER, .take = take_columns,
     .help = "tables: the two columns of the ends of an edge, by name or number (default: found)"},
    {"parallel", .kind = CLI_OTHER, .take = take_choice, .word = parallel_name, .n_words = 2,
     .help = "of edges between the same nodes: the shortest (default), or all, each but the "
             "shortest with a node of its own in the middle"},
    {"split", .kind = CLI_FLAG, AT(read.split), .help = "cut an edge where a node lies on it"},
    {"pick", .value = "NAME|N", .kind = CLI_TEXT, AT(read.pick),
     .help = "of a file of several frameworks, objects, groups or layers: this one, or the Nth "
             "(default: all)"},
    {"layers", .kind = CLI_OTHER, .take = take_choice, .word = layers_name, .n_words = 2,
     .help = "DXF: only layers that are shown (default), or also those that are off or frozen"},
    {0}};
