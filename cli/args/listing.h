/* The options of a command as its help lists them: what completions and man pages are made from. */
#ifndef THR_CLI_LISTING_H
#define THR_CLI_LISTING_H

#include <getopt.h>
#include <stdbool.h>

typedef struct {
  char name[32];     /* without dashes */
  char letter;       /* '\0' = none */
  char value[64];    /* "FILE", "solid|tube"; "" = takes none */
  const char *text;  /* what the help says of it in this line; not ended .. */
  int length;        /* .. after so many bytes */
  const char *below; /* the line after this one; in it may stand what the values mean */
} cli_listed;

/* The next option of the table that the help lists from *at on, and moves *at behind it; false: there is none. An option is
 * listed where "-x, --name" or "--name" stands at the beginning of a line, indented, or after two blanks or more. */
bool cli_listed_next(const char **at, const struct option *table, cli_listed *out);

/* Hands over the words that the option's value may be: "a|b|FILE" has a and b; of others, those that lines below begin with. */
void cli_listed_values(const cli_listed *option, void (*take)(void *user, const char *word), void *user);

#endif
