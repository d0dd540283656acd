/* --config FILE: options from a file, as if they stood before those of the command line. */
#ifndef THR_CLI_CONFIG_H
#define THR_CLI_CONFIG_H

/* A file of lines: "name = value" or "name", an option as on the command line without its dashes; "[command]": what follows is
 * for this command only; "# comment". What stands before any [command] is for every command.
 *
 * Puts the file's options for the command argv[1] behind it, as --name=value, in place of --config FILE; what else stands there
 * comes after, and so wins. *argc and *argv are the new ones, which live as long as the program. Returns EXIT_OK, or prints and
 * returns the code. */
int cli_config(int *argc, char ***argv);

/* The name of the file that the word argv[i] of the command came from; NULL: the user typed it. */
const char *cli_config_of(int i);

#endif
