/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of a command as its help lists them: what completions and man pages are made from. */
#include "cli/args/args.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { BELOW = 20 }; /* blanks before a line that goes on with the option above it */

/* Is text[at] the dash of an option that is listed, not of one that is only spoken of? *letter: its
 * short name. */
static bool is_listed(const char *text, const char *at, char *letter)
{
  const char *before = at;
  *letter = '\0';
  if (before - text >= 4 && before[-1] == ' ' && before[-2] == ',' && before[-4] == '-') {
    *letter = before[-3];
    before -= 4;
  }
  return before - text >= 2 && before[-1] == ' ' && before[-2] == ' ';
}

static const struct option *find(const struct option *table, const char *name, size_t n)
{
  for (; table->name; table++)
    if (strlen(table->name) == n && strncmp(table->name, name, n) == 0) return table;
  return NULL;
}

/* Up to the end of the line, or to another option in it. */
static int length_of_text(const char *text)
{
  int n = 0;
  while (text[n] && text[n] != '\n' && strncmp(text + n, "   -", 4) != 0)
    n++;
  while (n > 0 && text[n - 1] == ' ')
    n--;
  return n;
}

static void describe(const char *rest, const struct option *option, cli_listed *out)
{
  size_t n = option->has_arg == no_argument ? 0 : strcspn(rest + 1, " ]\n");
  snprintf(out->value, sizeof out->value, "%.*s", (int)n, *rest == '[' ? rest + 2 : rest + 1);
  if (*rest == '[') out->value[n > 0 ? n - 1 : 0] = '\0';
  rest += n > 0 ? n + 1 : 0;
  rest += strspn(rest, "] ");
  out->text = rest;
  out->length = length_of_text(rest);
  const char *end = strchr(rest, '\n');
  out->below = end ? end + 1 : rest + strlen(rest);
}

bool cli_listed_next(const char **at, const struct option *table, cli_listed *out)
{
  const char *text = *at;
  for (const char *dash = strstr(text, "--"); dash; dash = strstr(dash + 2, "--")) {
    size_t n = strspn(dash + 2, "abcdefghijklmnopqrstuvwxyz0123456789-");
    const struct option *option = find(table, dash + 2, n);
    if (!option || !is_listed(text, dash, &out->letter)) continue;
    snprintf(out->name, sizeof out->name, "%s", option->name);
    describe(dash + 2 + n, option, out);
    *at = dash + 2 + n;
    return true;
  }
  return false;
}

/* Words with commas between them, followed by two blanks: "obj, gltf   cords for CAD". */
static void take_below(const char *line, void (*take)(void *user, const char *word), void *user)
{
  for (; (int)strspn(line, " ") >= BELOW; line = strchr(line, '\n') + 1) {
    const char *word = line + strspn(line, " "), *end = strstr(word, "  "),
               *stop = strchr(word, '\n');
    for (; end && stop && end < stop && islower((unsigned char)*word) && word < end;
         word += strspn(word, ", ")) {
      char text[32];
      size_t n = strcspn(word, ", ");
      snprintf(text, sizeof text, "%.*s", (int)n, word);
      take(user, text);
      word += n;
    }
    if (!stop) return;
  }
}

void cli_listed_values(const cli_listed *option, void (*take)(void *user, const char *word),
                       void *user)
{
  const char *word = option->value;
  bool some = false;
  for (bool more = *word; more; word++) {
    char text[32];
    size_t n = strcspn(word, "|");
    more = word[n] == '|';
    snprintf(text, sizeof text, "%.*s", (int)n, word);
    if (islower((unsigned char)*text) && strchr(option->value, '|') && !strpbrk(text, ",.")) {
      take(user, text);
      some = true;
    }
    word += n;
  }
  if (!some) take_below(option->below, take, user);
}
