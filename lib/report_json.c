/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes what advice (planner/advise.c) and a search for symmetries (symmetry/symmetry.c) found of
 * a framework as JSON, for `thread advise --json`, `thread symmetries --json` and libthread.
 *
 * Example: {"framework": "..", "nodes": 49, .., "rows": [{"cords": 1, "ends": "closed", ..}],
 * "recommended": 3}. */
#include "lib/lib.h"
#include "symmetry/group/group.h"

#include <math.h>

/* ---- advice ---- */

void thr_advice_put_row(thr_writer *writer, const thr_advice_row *row)
{
  thr_write_int(writer, "cords", row->cords);
  if (row->all > row->cords) thr_write_int(writer, "cords_in_all", row->all);

  /* As for --ends. */
  thr_write_string(writer, "ends", thr_ends_name((int)row->ends));
  thr_write_number(writer, "length", row->length);
  thr_write_number(writer, "longest", row->longest);

  /* The cord that turns most, and what is proved of it. */
  thr_write_number(writer, "max_turning", row->turning);
  thr_write_number(writer, "max_turning_bound", row->bound > 0 ? row->bound : NAN);
  thr_write_string(writer, "max_turning_status",
                   row->optimal     ? "optimal"
                   : row->bound > 0 ? "bound"
                                    : "unknown");

  /* Pulls at the harder and the other end at mu, and at the harder one over the band. */
  thr_write_number(writer, "pull", row->pull[THR_ADVICE_MU]);
  thr_write_number(writer, "other_pull", row->other);
  thr_write_number(writer, "pull_low", row->pull[THR_ADVICE_LOW]);
  thr_write_number(writer, "pull_high", row->pull[THR_ADVICE_HIGH]);

  /* What is to be threaded and learned. */
  thr_write_int(writer, "passes", row->passes);
  thr_write_int(writer, "steps", row->steps);
}

/* Writes which framework it is about. */
static void put_framework(thr_writer *writer, const thr_frame *frame)
{
  thr_write_hash(writer, "framework", thr_frame_hash(frame));
  thr_write_int(writer, "nodes", frame->n_nodes);
  thr_write_int(writer, "edges", frame->n_edges);
  thr_write_string(writer, "units", frame->units);
}

/* Writes the command that makes the plan of a row. */
static void put_command(thr_writer *writer, thr_advice_command *command, const void *user,
                        const thr_advice_row *row)
{
  thr_text text = {0};
  if (!command) return;

  command(user, row, &text);
  thr_write_string(writer, "command", text.failed ? "" : text.data);
  writer->out->failed |= text.failed;
  thr_text_destroy(&text);
}

void thr_advice_put_json(thr_writer *writer, const thr_frame *frame, const thr_advice *advice,
                         thr_advice_command *command, const void *user)
{
  put_framework(writer, frame);

  /* What all rows have in common. */
  thr_write_number(writer, "base_length", advice->base_length);
  thr_write_number(writer, "mu", advice->physics.mu);
  thr_write_number(writer, "mu_low", advice->physics.mu_low);
  thr_write_number(writer, "mu_high", advice->physics.mu_high);
  thr_write_number(writer, "seating", advice->physics.seating);
  thr_write_number(writer, "hand", advice->hand);
  thr_write_bool(writer, "complete", advice->complete);
  thr_write_int(writer, "left_out", advice->left_out);

  thr_write_array(writer, "rows");
  for (int i = 0; i < advice->n; i++) {
    thr_write_object(writer, NULL);
    thr_advice_put_row(writer, &advice->row[i]);
    thr_write_bool(writer, "frontier", advice->row[i].frontier);
    put_command(writer, command, user, &advice->row[i]);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  /* The recommended row, counted from 0. */
  if (advice->chosen < 0) {
    thr_write_null(writer, "recommended");
    if (command) thr_write_null(writer, "command");
  } else {
    thr_write_int(writer, "recommended", advice->chosen);
    put_command(writer, command, user, &advice->row[advice->chosen]);
  }
}

/* ---- symmetries ---- */

void thr_order_put(thr_text *text, double mantissa, int exponent)
{
  double digits = floor(log10(mantissa));
  if (exponent == 0 && mantissa < 1e15)
    thr_text_printf(text, "%.0f", mantissa);
  else
    thr_text_printf(text, "%.3ge+%d", mantissa / pow(10, digits), exponent + (int)digits);
}

double thr_capstan(double mu, double turning)
{
  const double factor = exp(mu * turning);
  return factor > 1e300 ? INFINITY : factor;
}

double thr_symmetry_row_pull(const thr_request *options, const thr_symmetry_row *row)
{
  return options->physics.seating * thr_capstan(options->physics.mu, row->pulled);
}

/* Writes the order of a group as a number of any size. */
static void put_order_json(thr_writer *writer, const char *key, double mantissa, int exponent)
{
  thr_text digits = {0};
  thr_order_put(&digits, mantissa, exponent);
  thr_write_printf(writer, key, "%s", digits.data ? digits.data : "0");
  writer->out->failed |= digits.failed;
  thr_text_destroy(&digits);
}

/* Writes the name of a group, or null if it has none. */
static void put_name_json(thr_writer *writer, const char *name)
{
  if (*name)
    thr_write_string(writer, "name", name);
  else
    thr_write_null(writer, "name");
}

/* Returns the JSON word for what is known of a row. */
static const char *row_status(const thr_symmetry_row *row)
{
  switch (row->why.code) {
  /* A row without cords was left out, or was not asked for. */
  case THR_OK: return row->n_cords > 0 ? "optimal" : row->behind ? "not chosen" : "not asked for";
  case THR_ELIMIT: return row->n_cords > 0 ? "bound" : "stopped";
  case THR_EINFEASIBLE: return "infeasible";
  default: return "failed";
  }
}

/* Writes the threading of a row: cord, paths, turning (rad), the largest pull (N), and the bound on
 * each aim. */
static void put_threading_json(thr_writer *writer, const thr_request *options,
                               const thr_symmetry_row *row)
{
  const thr_metrics *metrics = &row->metrics;

  thr_write_number(writer, "overlap", metrics->overlap);
  thr_write_number(writer, "overlap_percent", 100 * metrics->overlap / metrics->base_length);
  thr_write_number(writer, "length", metrics->length);

  /* What is to be learned. */
  thr_write_int(writer, "unique_paths", row->record.unique_paths);
  thr_write_int(writer, "least_copies", row->least_copies);
  thr_write_int(writer, "most_copies", row->most_copies);
  thr_write_int(writer, "cords", row->n_cords);
  thr_write_number(writer, "steps", row->record.steps);
  thr_write_int(writer, "instructions", row->instructions);

  /* How hard the cords are to pull. */
  thr_write_number(writer, "turning", metrics->turning);
  thr_write_number(writer, "max_turning", metrics->max_turning);
  thr_write_number(writer, "max_capstan", thr_capstan(options->physics.mu, metrics->max_turning));
  thr_write_number(writer, "pull", thr_symmetry_row_pull(options, row));

  thr_write_object(writer, "bound");
  for (int a = 0; a < THR_N_AIMS; a++)
    thr_write_number(writer, thr_aim_name(a), row->bound[a]);
  thr_write_close(writer);
}

/* Writes row i as an object; members of a threading only if there is one. */
static void put_group_json(thr_writer *writer, const thr_request *options,
                           const thr_symmetries *symmetries, int i)
{
  static const char *const kind[] = {[THR_ISO_IDENTITY] = "identity",
                                     [THR_ISO_ROTATION] = "rotation",
                                     [THR_ISO_MIRROR] = "mirror",
                                     [THR_ISO_INVERSION] = "inversion",
                                     [THR_ISO_ROTOREFLECTION] = "rotoreflection",
                                     [THR_ISO_NONE] = "none"};
  const thr_symmetry_row *row = &symmetries->row[i];

  thr_write_line(writer, 1);
  thr_write_object(writer, NULL);
  thr_write_int(writer, "number", i + 1);
  thr_write_int(writer, "order", row->order);
  put_name_json(writer, row->name);

  /* 0: the number of groups in its class is not known. */
  thr_write_number(writer, "conjugates", row->conjugates > 0 ? (double)row->conjugates : NAN);
  thr_write_number(writer, "residual", row->residual);

  /* Elements by kind, the identity among them. */
  thr_write_object(writer, "elements");
  for (int k = 0; k <= THR_ISO_NONE; k++)
    thr_write_int(writer, kind[k], row->kinds[k]);
  thr_write_close(writer);

  /* The best threading, or why there is none. */
  thr_write_string(writer, "status", row_status(row));
  if (row->n_cords > 0 && !row->why.code)
    thr_write_string(writer, "proof", "the search ruled out every better one (not verified)");
  if (row->why.code) thr_write_string(writer, "why", row->why.text);
  if (row->behind) thr_write_int(writer, "behind", row->behind);
  if (row->n_cords > 0) put_threading_json(writer, options, row);
  thr_write_close(writer);
}

void thr_symmetries_put_table(thr_writer *writer, const thr_request *options,
                              const thr_symmetries *symmetries)
{
  const bool geometric = options->symmetry.geometric >= 0;

  /* The group that all rows are subgroups of. */
  put_order_json(writer, "order", symmetries->mantissa, symmetries->exponent);
  thr_write_int(writer, "node_orbits", symmetries->node_orbits);
  thr_write_int(writer, "edge_orbits", symmetries->edge_orbits);
  thr_write_bool(writer, "listed", symmetries->listed);
  thr_write_string(writer, "note", symmetries->note);
  thr_write_number(writer, "geometric", geometric ? options->symmetry.geometric : NAN);
  if (geometric)
    put_order_json(writer, "length_keeping", symmetries->keep_lengths[0],
                   (int)symmetries->keep_lengths[1]);

  /* What rows are compared by, and which one is chosen, counted from 1. */
  thr_write_number(writer, "mu", options->physics.mu);
  thr_write_number(writer, "shortest", symmetries->shortest);
  thr_write_string(writer, "shortest_status", symmetries->shortest_optimal ? "optimal" : "bound");
  thr_write_number(writer, "chosen",
                   symmetries->chosen >= 0 ? (double)symmetries->chosen + 1 : NAN);
  thr_write_bool(writer, "within_slack", symmetries->within);

  thr_write_array(writer, "groups");
  for (int i = 0; i < symmetries->n; i++)
    put_group_json(writer, options, symmetries, i);
  thr_write_close(writer);
}

void thr_symmetries_put_json(thr_writer *writer, const thr_frame *frame, const thr_request *options,
                             const thr_symmetries *symmetries)
{
  put_framework(writer, frame);

  /* What was asked for. */
  thr_write_string(writer, "ends", thr_ends_name(options->ends));
  thr_write_int(writer, "cover", options->cover);
  thr_write_string(writer, "joint", thr_joint_name(options->joint));
  thr_symmetries_put_table(writer, options, symmetries);
}
