/* The files that a command reads and writes: no file is asked for twice, and every output is tried before anything is computed.
 *
 * cli_next_option tells every option and operand to this list, so a command needs no code of its own: options that name an output
 * are known here, every other value that is the name of a file is taken for an input. Files are compared by what they are, not by
 * their names (thr_os_is_same_file). Only `thread eval PLAN -o PLAN` writes what it has read: the plan with its evaluation. */
#ifndef THR_CLI_FILES_H
#define THR_CLI_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* Takes down an option with its value, or an operand (option NULL). The strings stay the caller's, and where they are. */
void files_heard(const char *option, const char *value);

/* Compares all that was heard, makes the folders of outputs and tries to write there. Returns EXIT_OK, or prints and returns the
 * code: EXIT_USAGE for a file that is asked for twice, EXIT_INPUT for an output that cannot be written. */
int files_settle(const char *command);

/* Makes a folder and tries to write there. Returns EXIT_OK, or prints and returns the code. */
int files_try_folder(const char *folder);

/* Takes down a file that is read unasked. Returns EXIT_OK, or prints and returns the code if it is an output. */
int files_also_read(const char *path);

/* Is path a file that was heard of, but not with this option (NULL: with any)? */
bool files_is_taken(const char *path, const char *option);

/* Prints which file would be lost and returns EXIT_USAGE if path, to be written by this option, is taken; else EXIT_OK. */
int files_claim(const char *command, const char *option, const char *path);

/* The same at the last moment, for inputs only: nothing that was read is ever written over. */
int files_may_write(const char *path);

/* Finds a name in the current folder that no file has, like that of path: "plan.json", "plan-2.json", .. */
void files_name_beside(const char *path, char *name, size_t size);

/* Takes down that a folder was made; at the end those that are still empty are removed. */
void files_made(const char *folder);
void files_tidy(void);

#endif
