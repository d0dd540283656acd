/* The table of `thread advise`, as text and as JSON, and the command that makes the recommended plan. */
#ifndef THR_CLI_ADVICE_TABLE_H
#define THR_CLI_ADVICE_TABLE_H

#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/advice.h"
#include "graph/plan/plan.h"
#include "graph/plan/physics.h"
#include "graph/text.h"

/* Its head: what is counted and what the columns are; and a row of it. mark: "*> ", three columns. */
void advice_put_head(thr_text *text, const thr_frame *frame, const thr_physics *physics);
void advice_put_row(thr_text *text, const thr_advice_row *row, double base_length, const char *mark);

/* Appends a line that says what holding the pieces of the recommended plan takes, where that is more than what seats its cords.
 * The plan needs no proof. */
void advice_put_holding(thr_text *text, const thr_plan *plan);

/* All rows and, below, the recommended one with its command. */
void advice_put_table(thr_text *text, const thr_frame *frame, const thr_advice *advice, const char *command);
/* chosen: a plan with the recommended cords, or NULL. */
void advice_put_json(thr_writer *writer, const thr_frame *frame, const thr_advice *advice, const char *command,
                     const thr_plan *chosen);

/* "thread plan PATH --cords 4 --ends feet --objective tortuosity --minimize pull", with the options that FRAME was read
 * with (each with a blank before it), for a shell. */
void advice_put_command(thr_text *text, const char *path, const char *options, const thr_advice_row *row);

/* A word as a shell reads it: in quotes where it needs them. */
void advice_put_word(thr_text *text, const char *word);

/* "4 cords to the feet", "1 closed cord", "12 cords with ends anywhere". */
void advice_put_cords(thr_text *text, const thr_advice_row *row);

/* The last lines of `thread plan` where a hand cannot pull it: what it can, held against a plan of that length, and the command.
 */
void advice_put_line(thr_text *text, const thr_advice_row *row, double length, const char *command);

#endif
