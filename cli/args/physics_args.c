/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the options that describe cord and beads, for eval, compare and plan. The options are made
 * from the table of quantities in graph/plan/physics.h.
 *
 * A value is checked when it is read, but laid over the quantities of a plan only when the plan is
 * known: presets and files first, then single quantities, whatever their order in the command line.
 *
 * Example: `--mu 0.3 --preset NAME` sets mu = 0.3, and takes all else from the preset, which has a
 * mu as well. */
#include "cli/args/args.h"
#include "graph/io/json.h"
#include "graph/status.h"

#include <assert.h>
#include <stdio.h>

enum { NAME_SIZE = 24, MOST_QUANTITIES = 40 };

/* Writes the name of an option: the key of the quantity with dashes for underscores. */
static void option_name(int field, char name[NAME_SIZE])
{
  snprintf(name, NAME_SIZE, "%s", thr_physics_fields[field].key);
  for (char *c = name; *c; c++) {
    if (*c == '_') *c = '-';
  }
}

/* Appends every preset as JSON: its quantities as plan.json calls them, and its source. */
static void put_presets_json(thr_text *text)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);
  thr_write_array(&writer, "presets");
  for (int i = 0; i < thr_physics_n_presets; i++) {
    const thr_physics_preset *preset = &thr_physics_presets[i];

    thr_write_line(&writer, 1);
    thr_write_object(&writer, NULL);
    thr_write_string(&writer, "name", preset->name);
    for (int k = 0; k < thr_physics_n_fields; k++) {
      const double quantity = thr_physics_get(&preset->physics, &thr_physics_fields[k]);
      if (quantity > 0) thr_write_number(&writer, thr_physics_fields[k].key, quantity);
    }
    thr_write_string(&writer, "source", preset->source);
    thr_write_close(&writer);
  }
  thr_write_close(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* Prints every preset with its quantities and its sources. */
static bool show_presets(void *into, const cli_option *option, const char *value)
{
  enum { INDENT = 2, WIDTH = 98 };
  thr_text text = {0};
  (void)into, (void)option, (void)value;

  if (cli_json) put_presets_json(&text);
  for (int i = 0; i < thr_physics_n_presets && !cli_json; i++) {
    const thr_physics_preset *preset = &thr_physics_presets[i];
    thr_text_printf(&text, "%s%s\n", i ? "\n" : "", preset->name);

    /* Quantities that are 0 are not part of the preset. */
    for (int k = 0; k < thr_physics_n_fields; k++) {
      char name[NAME_SIZE];
      const double quantity = thr_physics_get(&preset->physics, &thr_physics_fields[k]);
      option_name(k, name);
      if (!(quantity > 0)) continue;
      thr_text_printf(&text, "  %-14s %g%s%s\n", name, quantity,
                      *thr_physics_fields[k].unit ? " " : "", thr_physics_fields[k].unit);
    }

    thr_text_printf(&text, "%*s", INDENT, "");
    cli_put_wrapped(&text, preset->source, INDENT, INDENT, WIDTH);
  }

  /* The end of the program says if stdout takes nothing. */
  if (text.data) fputs(text.data, stdout);
  thr_text_destroy(&text);

  return true;
}

/* Notes an option, to be laid over what a plan says later. */
static bool keep(cli_physics *args, const cli_option *option, const char *value)
{
  if (args->n == CLI_PHYSICS_MOST) {
    cli_usage(cli_command_name(), "more than %d options about cord and beads", CLI_PHYSICS_MOST);
    return false;
  }
  args->given[args->n].option = option;
  args->given[args->n++].value = value;
  return true;
}

/* Notes the name of a file of quantities. */
static bool take_file(void *into, const cli_option *option, const char *value)
{
  return keep(into, option, value);
}

/* Notes the name of a preset, if there is one of this name. */
static bool take_preset(void *into, const cli_option *option, const char *value)
{
  thr_err err = {0};
  thr_physics trial = thr_physics_default();
  if (!thr_physics_set_preset(&trial, value, &err)) return keep(into, option, value);
  cli_usage(cli_command_name(), "--%s", err.text);
  return false;
}

/* Returns the quantity of a row, whose number is the row's offset. */
static const thr_physics_field *field_of(const cli_option *option)
{
  return &thr_physics_fields[(int)option->offset];
}

/* Notes the value of a quantity after checking the value as far as one can without a framework. */
static bool take_quantity(void *into, const cli_option *option, const char *value)
{
  const thr_physics_field *field = field_of(option);
  thr_err err = {0};
  thr_physics trial = thr_physics_default();
  char name[NAME_SIZE + 2];
  double quantity;

  snprintf(name, sizeof name, "--%s", option->name);
  if (!cli_quantity(cli_command_name(), name, value, field->unit, field->low, field->high,
                    &quantity))
    return false;

  /* Setting a trial finds values that must be above 0. */
  if (!thr_physics_set(&trial, field, quantity, &err)) return keep(into, option, value);
  cli_usage(cli_command_name(), "%s %s: must be more than 0", name, value);

  return false;
}

/* Returns the name of preset i. */
static const char *preset_name(int i)
{
  return thr_physics_presets[i].name;
}

/* Returns what help says of preset i. The text lives until the next call. */
static const char *preset_meaning(int i)
{
  static char text[80];
  const thr_physics *physics = &thr_physics_presets[i].physics;
  snprintf(text, sizeof text, "mu %g (%g to %g), density %g", physics->mu, physics->mu_low,
           physics->mu_high, physics->density);
  return text;
}

const cli_option *cli_physics_options(void)
{
  static cli_option row[MOST_QUANTITIES + 4];
  static char name[MOST_QUANTITIES][NAME_SIZE], help[MOST_QUANTITIES][160];
  const thr_physics usual = thr_physics_default();
  int n = 0;
  assert(thr_physics_n_fields <= MOST_QUANTITIES); /* known when it is compiled */

  /* One row for each quantity; the help ends with the default. */
  for (int i = 0; i < thr_physics_n_fields; i++) {
    const thr_physics_field *field = &thr_physics_fields[i];
    const double value = thr_physics_get(&usual, field);
    option_name(i, name[i]);
    if (value > 0)
      snprintf(help[i], sizeof help[i], "%s (%g)", field->help, value);
    else
      snprintf(help[i], sizeof help[i], "%s", field->help);
    row[n++] = (cli_option){name[i],
                            .value = *field->unit ? field->unit : "X",
                            .help = help[i],
                            .kind = CLI_OTHER,
                            .offset = (size_t)i,
                            .take = take_quantity};
  }

  /* Files and presets set several quantities. */
  row[n++] = (cli_option){"physics", .value = "FILE", .kind = CLI_OTHER, .take = take_file,
                          .help = "these as JSON: {\"mu\": 0.25, \"bore\": 3}, with _ for -"};
  row[n++] = (cli_option){"preset",
                          .value = "NAME",
                          .kind = CLI_OTHER,
                          .take = take_preset,
                          .word = preset_name,
                          .meaning = preset_meaning,
                          .n_words = thr_physics_n_presets,
                          .help = "a set of values; presets and files count before single "
                                  "quantities, whatever the order:"};
  row[n++] = (cli_option){"presets", .kind = CLI_SHOWS, .take = show_presets,
                          .help = "what each of them rests on"};

  /* A row without a name ends the table. */
  row[n] = (cli_option){0};

  return row;
}

int cli_physics_apply(const cli_physics *args, thr_physics *physics)
{
  thr_err err = {0};
  thr_status st = THR_OK;

  /* Presets and files, in the order given. */
  for (int i = 0; i < args->n && !st; i++) {
    const char *value = args->given[i].value;
    if (args->given[i].option->take == take_preset) {
      st = thr_physics_set_preset(physics, value, &err);
    } else if (args->given[i].option->take == take_file) {
      st = thr_physics_read(physics, value, &err);
    }
  }

  /* Single quantities, which count more. */
  for (int i = 0; i < args->n && !st; i++) {
    const cli_option *option = args->given[i].option;
    if (option->take == take_quantity) {
      double quantity;
      st = thr_quantity_read(args->given[i].value, field_of(option)->unit, &quantity, &err);
      if (!st) st = thr_physics_set(physics, field_of(option), quantity, &err);
    }
  }

  return st ? cli_fail(&err) : EXIT_OK;
}
