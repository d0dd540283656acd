/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the motions of `thread info --motions`: how many there are, what pulling the cords moves
 * or what proves that it moves nothing, and how far a motion was followed. In JSON every motion has
 * its vectors, and the proof every force. */
#include "cli/print/print.h"

#include "graph/number.h"

#include <math.h>

/* Smaller errors differ between machines, and are not told. */
static const double EXACT = 1e-12;

/* Appends what a cord is called: the letter of a plan's, or the edge. */
static void put_cord(thr_text *text, const motion_facts *facts, int c)
{
  const thr_frame *frame = facts->bars.frame;
  const thr_cord *cord = &facts->cord[c];
  if (facts->planned)
    thr_text_append(text, cord->id);
  else
    thr_text_printf(text, "%s-%s", frame->name[thr_tail(frame, cord->half[0])],
                    frame->name[thr_head(frame, cord->half[0])]);
}

/* Returns the cord that gets shorter fastest. */
static int shortens_most(const thr_pulling *pulling)
{
  int best = 0;
  for (int c = 1; c < pulling->n_cords; c++)
    if (pulling->rate[c] < pulling->rate[best]) best = c;
  return best;
}

/* Appends what pulling the cords does. */
static void put_pulling(thr_text *text, const motion_facts *facts)
{
  const thr_pulling *pulling = &facts->pulling;
  const thr_frame *frame = facts->bars.frame;
  double most = 0;

  thr_text_append(text, "pulling     ");
  if (pulling->moves) {
    thr_text_append(text, "moves it: all bars are kept, no cord gets longer, and ");
    put_cord(text, facts, shortens_most(pulling));
    thr_text_printf(
        text, " shorter; fastest at %s\n",
        frame->name[thr_motion_fastest((const double(*)[3])pulling->velocity, frame->n_nodes)]);
    return;
  }

  for (int c = 0; c < pulling->n_cords; c++)
    most = fmax(most, pulling->tension[c]);
  thr_text_printf(text,
                  "moves nothing: all cords can be tight at once (proved: tensions from 1 to %.3g "
                  "in balance with the bars to %.0e)\n",
                  most, fmax(pulling->residual, EXACT));
  if (facts->n_left == 0)
    thr_text_append(text,
                    "            held by its cords: nothing moves without making one longer\n");
  else
    thr_text_printf(text, "            %d %s %s no cord longer or shorter\n", facts->n_left,
                    cli_plural(facts->n_left, "motion", "motions"),
                    facts->n_left == 1 ? "makes" : "make");
}

void motions_put(thr_text *text, const motion_facts *facts)
{
  const thr_frame *frame = facts->bars.frame;

  thr_text_printf(text, "motions     %d", facts->basis.count);
  if (facts->n_held)
    thr_text_printf(text, " with %d %s held", facts->n_held,
                    cli_plural(facts->n_held, "node", "nodes"));
  else
    thr_text_append(text, " beside the rigid ones");
  if (facts->basis.count)
    thr_text_printf(
        text, "; the first one fastest at %s",
        frame->name[thr_motion_fastest((const double(*)[3])facts->basis.velocity, frame->n_nodes)]);
  thr_text_printf(text, "%s\n", facts->basis.unclear ? " (a close call: rounding decides)" : "");

  if (facts->n_cords) put_pulling(text, facts);
  if (!facts->path.n_frames) return;

  /* How far the motion went. */
  static const char *const end[] = {"", ", where a bar would have to change",
                                    ", where it is no motion any more",
                                    ", where a cord would get longer"};
  if (facts->path.n_frames == 1)
    thr_text_append(text, "followed    nowhere: a motion to first order only\n");
  else
    thr_text_printf(text, "followed    %d %s%s; bars keep their lengths to %.0e\n",
                    facts->path.n_frames - 1, cli_plural(facts->path.n_frames - 1, "step", "steps"),
                    end[facts->path.end], fmax(facts->path.change, EXACT));
}

/* Writes the vectors of a motion, but for nodes that do not move. */
static void put_vectors(thr_writer *writer, const thr_frame *frame, const double (*velocity)[3])
{
  thr_write_string(writer, "fastest", frame->name[thr_motion_fastest(velocity, frame->n_nodes)]);
  thr_write_array(writer, "vectors");
  for (int v = 0; v < frame->n_nodes; v++) {
    if (!(thr_dot(velocity[v], velocity[v]) > 0)) continue;
    thr_write_object(writer, NULL);
    thr_write_string(writer, "node", frame->name[v]);
    for (int i = 0; i < 3; i++)
      thr_write_printf(writer, i == 0 ? "dx" : i == 1 ? "dy" : "dz", "%.9g", velocity[v][i]);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

/* Writes what pulling does: the motion with the rates of the cords, or the proof, with the tensions
 * of the cords and the forces of the bars. */
static void put_pulling_json(thr_writer *writer, const motion_facts *facts)
{
  const thr_pulling *pulling = &facts->pulling;
  const thr_frame *frame = facts->bars.frame;

  thr_write_object(writer, "pulling");
  thr_write_bool(writer, "moves", pulling->moves);
  thr_write_int(writer, "motions_that_keep_the_cords", facts->n_left);
  thr_write_printf(writer, "residual", "%.1g", pulling->residual);
  if (pulling->moves) put_vectors(writer, frame, (const double(*)[3])pulling->velocity);

  thr_write_array(writer, "cords");
  for (int c = 0; c < pulling->n_cords; c++) {
    thr_text name = {0};
    put_cord(&name, facts, c);
    thr_write_object(writer, NULL);
    thr_write_words(writer, "id", &name);
    thr_write_printf(writer, pulling->moves ? "rate" : "tension", "%.9g",
                     pulling->moves ? pulling->rate[c] : pulling->tension[c]);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  if (!pulling->moves) {
    thr_write_array(writer, "bars");
    for (int e = 0; e < frame->n_edges; e++) {
      if (facts->bars.cable && facts->bars.cable[e]) continue;
      thr_write_object(writer, NULL);
      thr_write_array(writer, "edge");
      for (int end = 0; end < 2; end++)
        thr_write_string(writer, NULL, frame->name[frame->edge[e][end]]);
      thr_write_close(writer);
      thr_write_printf(writer, "force", "%.9g", pulling->force[e]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

/* Writes the positions along the motion that was followed. */
static void put_path_json(thr_writer *writer, const motion_facts *facts)
{
  static const char *const end[] = {"whole", "stiff", "turned", "taut"};
  const thr_path *path = &facts->path;

  thr_write_object(writer, "followed");
  thr_write_int(writer, "motion", facts->which);
  thr_write_string(writer, "end", end[path->end]);
  thr_write_printf(writer, "change", "%.1g", path->change);
  thr_write_array(writer, "frames");
  for (int k = 0; k < path->n_frames; k++) {
    thr_write_array(writer, NULL);
    for (int v = 0; v < path->n_nodes; v++) {
      thr_write_array(writer, NULL);
      for (int i = 0; i < 3; i++)
        thr_write_printf(writer, NULL, "%.9g", path->at[k * path->n_nodes + v][i]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);
  thr_write_close(writer);
}

void motions_put_json(thr_writer *writer, const motion_facts *facts)
{
  const size_t n = (size_t)facts->basis.n_nodes;

  thr_write_object(writer, "motions");
  thr_write_int(writer, "count", facts->basis.count);
  thr_write_bool(writer, "unclear", facts->basis.unclear);
  thr_write_array(writer, "held");
  for (int v = 0; v < (int)n; v++)
    if (facts->held[v]) thr_write_string(writer, NULL, facts->bars.frame->name[v]);
  thr_write_close(writer);

  thr_write_array(writer, "basis");
  for (int k = 0; k < facts->basis.count; k++) {
    thr_write_object(writer, NULL);
    put_vectors(writer, facts->bars.frame,
                (const double(*)[3])facts->basis.velocity + (size_t)k * n);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  if (facts->n_cords) put_pulling_json(writer, facts);
  if (facts->path.n_frames) put_path_json(writer, facts);
  thr_write_close(writer);
}
