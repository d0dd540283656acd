/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread info --turn: how far two pieces that follow each other on a cord can turn, against the
 * cord that is free between them, in closed form and in simulation (eval/rise/turn.h). */
#include "cli/commands/info_parts.h"

#include "diagram/overview/charts.h"
#include "graph/io/json.h"
#include "graph/number.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <string.h>

enum { DOTS = 14, LINE = 600 };
static const double RADIUS = 10, WALL = 0.2, TIP = 60; /* mm, of the radius, degrees */
static const double BEYOND = 1.1; /* of the cord that lets pieces fold, is where plots end */

/* Takes the shape of both pieces. */
static bool take_turn(void *into, const cli_option *option, const char *value)
{
  turn_arguments *args = into;
  for (int i = 0; i < THR_TURN_N_SHAPES; i++) {
    if (strcmp(value, thr_turn_shape_name(i)) != 0) continue;
    args->piece.shape = (thr_turn_shape)i;
    args->wanted = true;
    return true;
  }
  cli_usage("info", "--%s %s: expected cylinder, tube or cone", option->name, value);
  return false;
}

#define AT(member) .offset = offsetof(turn_arguments, member)
const cli_option turn_options[] = {
    {"turn", .value = "cylinder|tube|cone", .kind = CLI_OTHER, .take = take_turn,
     .help = "the largest angle between two such pieces, which follow each other, against the cord "
             "that is free between them: in closed form, and in simulation"},
    {"radius", .value = "MM", .kind = CLI_AMOUNT, AT(piece.radius), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "outer radius (default: 10)"},
    {"wall", .value = "MM", .kind = CLI_AMOUNT, AT(piece.wall), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "of tubes (default: a fifth of the radius)"},
    {"tip", .value = "DEG", .kind = CLI_AMOUNT, AT(piece.tip), .low = 10, .high = 89,
     .help = "of cones, between axis and side (default: 60)"},
    {"plot", .value = "FILE.svg", .kind = CLI_OUTPUT, AT(plot),
     .help = "draw it: the closed form as a line, the simulation as dots"},
    {0}};
#undef AT

/* Names the pieces. */
static void describe(const thr_turn_piece *piece, char words[96])
{
  const int n =
      snprintf(words, 96, "%s, radius %g mm", thr_turn_shape_name(piece->shape), piece->radius);
  if (piece->shape == THR_TURN_TUBE)
    snprintf(words + n, 96 - (size_t)n, ", wall %g mm", piece->wall);
  if (piece->shape == THR_TURN_CONE)
    snprintf(words + n, 96 - (size_t)n, ", tip %g\xc2\xb0", thr_degrees(piece->tip));
}

static void put_text(const thr_turn_piece *piece, const thr_turn_mark *dot, thr_text *text)
{
  char words[96];
  describe(piece, words);
  thr_text_printf(text, "%s\nfree cord   closed form   simulated\n", words);
  for (int i = 0; i < DOTS; i++)
    thr_text_printf(text, "%6.4g mm   %7.1f\xc2\xb0      %6.1f\xc2\xb0\n", dot[i].cord,
                    thr_degrees(thr_turn_largest(piece, dot[i].cord)), thr_degrees(dot[i].angle));
}

static void put_json(const thr_turn_piece *piece, const thr_turn_mark *dot, thr_text *text)
{
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "turn", thr_turn_shape_name(piece->shape));
  thr_write_number(&writer, "radius", piece->radius);
  if (piece->shape == THR_TURN_TUBE) thr_write_number(&writer, "wall", piece->wall);
  if (piece->shape == THR_TURN_CONE) thr_write_number(&writer, "tip", thr_degrees(piece->tip));
  thr_write_array(&writer, "angles"); /* free cord in mm, closed form and simulation in degrees */
  for (int i = 0; i < DOTS; i++) {
    thr_write_row(&writer, NULL);
    thr_write_printf(&writer, NULL, "%.6g", dot[i].cord);
    thr_write_printf(&writer, NULL, "%.6g", thr_degrees(thr_turn_largest(piece, dot[i].cord)));
    thr_write_printf(&writer, NULL, "%.6g", thr_degrees(dot[i].angle));
    thr_write_close(&writer);
  }
  thr_write_close(&writer);
  answer_put_files(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* Draws the plot, which ends at `most` mm of cord. */
static int write_plot(const thr_turn_piece *piece, double most, const thr_turn_mark *dot,
                      const char *path)
{
  thr_turn_mark line[LINE + 1];
  thr_text svg = {0};
  thr_err err = {0};
  char words[96];
  describe(piece, words);
  for (int i = 0; i <= LINE; i++) {
    const double cord = most * i / LINE;
    line[i] = (thr_turn_mark){cord, thr_turn_largest(piece, cord)};
  }
  const thr_turn_chart chart = {words, LINE + 1, DOTS, line, dot};
  const thr_status st = thr_turn_svg(&chart, &svg, &err);
  return cli_write_drawn(st, &svg, path, &err);
}

int turn_print(const turn_arguments *args)
{
  thr_turn_piece piece = args->piece;
  thr_turn_mark dot[DOTS];
  thr_err err = {0};
  if (!(piece.radius > 0)) piece.radius = RADIUS;
  if (!(piece.wall > 0)) piece.wall = WALL * piece.radius;
  piece.tip = (piece.tip > 0 ? piece.tip : TIP) * THR_PI / 180;
  if (piece.wall > piece.radius)
    return cli_usage("info", "--wall %g: thicker than the radius, %g mm", piece.wall, piece.radius);

  const double most = BEYOND * thr_turn_cord(&piece, THR_PI);
  for (int i = 0; i < DOTS; i++) {
    dot[i].cord = most * (i + 0.5) / DOTS;
    if (thr_turn_simulate(&piece, dot[i].cord, &dot[i].angle, &err)) return cli_fail(&err);
  }
  if (args->plot) {
    const int code = write_plot(&piece, most, dot, args->plot);
    if (code) return code;
    answer_file(args->plot, "the plot");
  }
  thr_text text = {0};
  (cli_json ? put_json : put_text)(&piece, dot, &text);
  return print_text(&text);
}
