/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options that describe cord and beads, made from the table in graph/plan/physics.h. Shared by
 * eval, compare and plan. */
#include "cli/args/args.h"
#include "graph/status.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_PRESET = 1024, OPTION_PRESETS, OPTION_FILE, OPTION_QUANTITY };
enum { MOST_OPTIONS = 128, MOST_LETTERS = 24 };

static void option_name(int field, char name[MOST_LETTERS])
{
  snprintf(name, MOST_LETTERS, "%s", thr_physics_fields[field].key);
  for (char *c = name; *c; c++)
    if (*c == '_') *c = '-';
}

/* The command's own table and then ours; name holds the names made here. */
static void join_tables(const struct option *own, struct option *table, char (*name)[MOST_LETTERS])
{
  static const struct option extra[] = {{"preset", required_argument, NULL, OPTION_PRESET},
                                        {"presets", no_argument, NULL, OPTION_PRESETS},
                                        {"physics", required_argument, NULL, OPTION_FILE}};
  enum { N_EXTRA = sizeof extra / sizeof *extra };
  int n = 0;
  for (; own->name; own++)
    table[n++] = *own;
  assert(n + N_EXTRA + thr_physics_n_fields <
         MOST_OPTIONS); /* a command's options are known when it is compiled */
  for (int i = 0; i < N_EXTRA; i++)
    table[n++] = extra[i];
  for (int i = 0; i < thr_physics_n_fields; i++) {
    option_name(i, name[i]);
    table[n++] = (struct option){name[i], required_argument, NULL, OPTION_QUANTITY + i};
  }
  table[n] = (struct option){NULL, 0, NULL, 0};
}

static size_t THR_PRINTF(3, 4) put(char *to, size_t room, const char *format, ...)
{
  va_list args;
  va_start(args, format);
  int n = vsnprintf(to, room, format, args);
  va_end(args);
  return n < 0 ? 0 : (size_t)n < room ? (size_t)n : room - 1;
}

/* The command's help and then ours. */
static const char *join_help(const char *own)
{
  static char whole[16384]; /* a help text has at most 8,190 bytes, two literals */
  const thr_physics usual = thr_physics_default();
  size_t n = 0;
  n += put(whole + n, sizeof whole - n,
           "%s\nCord and beads (default: what the plan says, else what stands here):\n", own);
  for (int i = 0; i < thr_physics_n_fields; i++) {
    const thr_physics_field *field = &thr_physics_fields[i];
    char name[MOST_LETTERS], both[40];
    double value = thr_physics_get(&usual, field);
    option_name(i, name);
    snprintf(both, sizeof both, "--%s %s", name, *field->unit ? field->unit : "X");
    n += put(whole + n, sizeof whole - n, "      %-22s %s", both, field->help);
    n += put(whole + n, sizeof whole - n, value > 0 ? " (%g)\n" : "\n", value);
  }
  n += put(whole + n, sizeof whole - n, "%s",
           "      --physics FILE         these as JSON: {\"mu\": 0.25, \"bore\": 3}, with _ for -\n"
           "      --preset NAME          a set of values:\n");
  for (int i = 0; i < thr_physics_n_presets; i++) {
    const thr_physics *physics = &thr_physics_presets[i].physics;
    n += put(whole + n, sizeof whole - n,
             "                               %-14s mu %g (%g to %g), density %g\n",
             thr_physics_presets[i].name, physics->mu, physics->mu_low, physics->mu_high,
             physics->density);
  }
  n += put(whole + n, sizeof whole - n, "%s",
           "      --presets              what each of them rests on\n"
           "  Presets and files count before single quantities, whatever the order.\n");
  return whole;
}

/* Indented, in lines that fit a terminal. */
static void print_wrapped(const char *words)
{
  enum { WIDE = 96 };
  while (*words) {
    size_t n = strlen(words);
    if (n > WIDE)
      for (n = WIDE; n > 1 && words[n] != ' ';)
        n--;
    printf("  %.*s\n", (int)n, words);
    words += n + (words[n] == ' ');
  }
}

static void print_presets(void)
{
  for (int i = 0; i < thr_physics_n_presets; i++) {
    const thr_physics_preset *preset = &thr_physics_presets[i];
    printf("%s%s\n", i ? "\n" : "", preset->name);
    for (int k = 0; k < thr_physics_n_fields; k++) {
      char name[MOST_LETTERS];
      double value = thr_physics_get(&preset->physics, &thr_physics_fields[k]);
      option_name(k, name);
      if (!(value > 0)) continue;
      printf("  %-14s %g%s%s\n", name, value, *thr_physics_fields[k].unit ? " " : "",
             thr_physics_fields[k].unit);
    }
    print_wrapped(preset->source);
  }
}

/* Is the value good, as far as one can say without a framework? Prints why not. */
static bool fits(const char *command, int option, const char *value)
{
  thr_err err = {0};
  thr_physics trial = thr_physics_default();
  double x;
  if (option == OPTION_FILE) return true;
  if (option == OPTION_PRESET) {
    if (!thr_physics_set_preset(&trial, value, &err)) return true;
    cli_usage(command, "--%s", err.text);
    return false;
  }
  const thr_physics_field *field = &thr_physics_fields[option - OPTION_QUANTITY];
  char name[MOST_LETTERS + 2] = "--";
  option_name(option - OPTION_QUANTITY, name + 2);
  if (!cli_double(command, name, value, field->low, field->high, &x)) return false;
  if (!thr_physics_set(&trial, field, x, &err)) return true;
  cli_usage(command, "%s %s: must be more than 0", name, value);
  return false;
}

int cli_physics_option(cli_physics *a, int argc, char **argv, const char *command,
                       const char *letters, const struct option *own, const char *help, int *done)
{
  struct option table[MOST_OPTIONS];
  char name[MOST_OPTIONS][MOST_LETTERS];
  const char *whole = join_help(help);
  join_tables(own, table, name);
  for (;;) {
    int o = cli_next_option(argc, argv, command, letters, table, whole, done);
    if (o < OPTION_PRESET) return o;
    if (o == OPTION_PRESETS) {
      print_presets();
      *done = EXIT_OK;
      return -1;
    }
    if (a->n == CLI_PHYSICS_MOST) {
      *done = cli_usage(command, "more than %d options about cord and beads", CLI_PHYSICS_MOST);
      return -1;
    }
    if (!fits(command, o, optarg)) {
      *done = EXIT_USAGE;
      return -1;
    }
    a->given[a->n].option = o;
    a->given[a->n++].value = optarg;
  }
}

int cli_physics_apply(const cli_physics *a, thr_physics *physics)
{
  thr_err err = {0};
  thr_status st = THR_OK;
  for (int i = 0; i < a->n && !st; i++) {
    if (a->given[i].option == OPTION_PRESET)
      st = thr_physics_set_preset(physics, a->given[i].value, &err);
    if (a->given[i].option == OPTION_FILE) st = thr_physics_read(physics, a->given[i].value, &err);
  }
  for (int i = 0; i < a->n && !st; i++)
    if (a->given[i].option >= OPTION_QUANTITY)
      st = thr_physics_set(physics, &thr_physics_fields[a->given[i].option - OPTION_QUANTITY],
                           strtod(a->given[i].value, NULL), &err);
  return st ? cli_fail(&err) : EXIT_OK;
}

void cli_physics_spell(const cli_physics *a, int i, char name[MOST_LETTERS])
{
  int option = a->given[i].option;
  if (option >= OPTION_QUANTITY)
    option_name(option - OPTION_QUANTITY, name);
  else
    snprintf(name, MOST_LETTERS, "%s", option == OPTION_PRESET ? "preset" : "physics");
}
